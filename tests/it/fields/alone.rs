//! Single bodies in fields and with damping, against their closed forms.

use carom_dynamics::{BodyDef, EventKind, Field, Material, Settings, World};
use carom_geometry::HalfPlane;
use carom_math::{Vec2, trig, vec2};
use carom_tests::elastic;
use carom_tests::scenes::{block, disc, put, surface};

use super::{Dish, still};

fn first_impact(world: &mut World) -> f64 {
    for _ in 0..1000 {
        world.step_to_next_event(100.0);
        for event in world.events() {
            if let EventKind::Impact { .. } = event.kind {
                return event.time.as_secs();
            }
        }
    }
    panic!("nothing struck");
}

fn wall(world: &mut World, at: Vec2, normal: Vec2, material: Material) {
    let wall = HalfPlane::new(at, normal).expect("a wall");
    put(world, BodyDef::fixed(), wall, material);
}

/// `v/c (1 − e^(−ct)) = d` at `t = −ln(1 − c d/v)/c`.
#[test]
fn a_damped_disc_strikes_a_wall_at_the_instant_of_its_closed_form() {
    for (c, v, d) in [
        (0.1, 3.0, 20.0),
        (0.5, 4.0, 7.5),
        (1.0, 2.0, 1.99),
        (3.0, 40.0, 1.0),
    ] {
        let mut world = still();
        wall(&mut world, vec2(d + 0.25, 0.0), -Vec2::X, elastic());
        let def = BodyDef::dynamic().moving(vec2(v, 0.3)).damped(c, 0.0);
        let ball = put(&mut world, def, disc(0.25), elastic());
        let found = first_impact(&mut world);
        let exact = -trig::ln(1.0 - c * d / v) / c;
        // The disc comes with v − c d.
        let off = (found - exact).abs() * (v - c * d);
        assert!(
            off < 1e-12 * 0.25,
            "{c}, {v}, {d}: {off:e} m, {:e} s",
            found - exact
        );
        let speed = world.body(ball).expect("there").velocity().x;
        assert!((speed + v - c * d).abs() < 1e-13 * v, "{speed}");
    }
}

/// A disc that falls against the air: x(t) by both exponentials, bounce after bounce.
#[test]
fn a_ball_bounces_in_the_air_as_its_closed_form_says() {
    let mut world = World::new(Settings::default()).expect("valid");
    wall(&mut world, Vec2::ZERO, Vec2::Y, surface(0.0, 0.0));
    let (c, g, r, e) = (0.4, 9.81, 0.3, 0.9);
    let def = BodyDef::dynamic().at(vec2(0.0, 5.0 + r)).damped(c, 0.0);
    put(&mut world, def, disc(r), surface(e, 0.0));
    let place = |t: f64, v: f64| (v + g / c) * (-trig::exp_m1(-c * t)) / c - g / c * t;
    let speed = |t: f64, v: f64| (v + g / c) * trig::exp(-c * t) - g / c;
    let (mut start, mut height, mut v) = (0.0, 5.0, 0.0);
    for bounce in 0..20 {
        // The root by bisection, from above the top of the arc.
        let (mut low, mut high) = (if v > 0.0 { v / g } else { 0.0 }, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if height + place(middle, v) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let found = first_impact(&mut world);
        let exact = start + low;
        let off = (found - exact).abs() * speed(low, v).abs();
        assert!(
            off < 1e-12 * r * f64::from(bounce + 1),
            "bounce {bounce}: {off:e} m"
        );
        (start, height, v) = (exact, 0.0, -e * speed(low, v));
    }
}

/// Nothing but a spring of the caller's own, followed to `error`, in m/s.
fn swing(error: f64) -> World {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        field_error: error,
        ..Settings::default()
    })
    .expect("valid");
    world.add_field(Dish { ripple: 0.0 });
    world
}

#[test]
fn a_field_of_the_callers_own_is_followed_to_the_stated_error() {
    for error in [1e-6, 1e-9, 1e-12] {
        let mut world = swing(error);
        let circles = BodyDef::dynamic().at(Vec2::X).moving(vec2(0.0, 2.0));
        let id = put(&mut world, circles, disc(0.25), elastic());
        for _ in 0..100 {
            world.step(0.317);
        }
        let (sin, cos) = trig::sin_cos(2.0 * world.time().as_secs());
        let off = (world.body(id).expect("there").centre() - vec2(cos, sin)).length();
        assert!(
            off < 100.0 * 0.317 * error + 1e-12,
            "{off:e} m at {error:e} m/s"
        );
    }
}

/// A field of the caller's own: a swing that strikes a wall at `cos 2t = d`.
#[test]
fn a_swing_strikes_at_its_cosine_to_the_stated_error() {
    for error in [1e-6, 1e-9, 1e-12] {
        let mut world = swing(error);
        wall(&mut world, vec2(-0.75, 0.0), Vec2::X, elastic());
        put(
            &mut world,
            BodyDef::dynamic().at(Vec2::X),
            disc(0.25),
            elastic(),
        );
        for bounce in 0..10 {
            // From 1 m to −0.5 m: 2π/3 of the phase, and twice that to and fro.
            let phase = core::f64::consts::PI * (2.0 / 3.0) * f64::from(2 * bounce + 1);
            let found = first_impact(&mut world);
            let off = (found - 0.5 * phase).abs();
            assert!(
                off < error * 0.5 * phase + 4e-13 * 0.25,
                "{error:e}: {off:e} s after {found}"
            );
        }
    }
}

/// Up, by 20 m/s².
#[derive(Debug)]
struct Lift;

impl Field for Lift {
    fn acceleration(&self, _: Vec2) -> Vec2 {
        vec2(0.0, 20.0)
    }
    fn potential(&self, at: Vec2) -> f64 {
        -20.0 * at.y
    }
    fn gradient_bound(&self, _: Vec2, _: f64) -> f64 {
        0.0
    }
}

/// Whatever rests, slides or rolls on the ground in closed form.
#[test]
fn a_field_lifts_what_lies_on_the_ground_at_once() {
    for (speed, round) in [(0.0, false), (0.0, true), (2.0, false), (2.0, true)] {
        let mut world = World::new(Settings {
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        })
        .expect("valid settings");
        let stone = surface(0.0, 0.6);
        let floor = HalfPlane::new(Vec2::ZERO, vec2(0.0, 1.0)).expect("a floor");
        put(&mut world, BodyDef::fixed(), floor, stone);
        let def = BodyDef::dynamic().at(vec2(0.0, 0.5));
        let def = def.moving(vec2(speed, 0.0));
        let id = if round {
            put(&mut world, def, disc(0.5), stone)
        } else {
            put(&mut world, def, block(1.0, 1.0), stone)
        };
        for wait in [0.1, 1.0] {
            world.step(wait);
        }
        world.add_field(Lift);
        world.step(0.5);
        let height = world.body(id).expect("it stays").centre().y;
        assert!(
            (height - 1.75).abs() < 1e-9,
            "{speed} m/s, round: {round}: {height} m"
        );
    }
}
