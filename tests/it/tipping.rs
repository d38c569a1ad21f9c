//! Bodies that turn about what they stand on: against fine integrations and the textbook.

use carom_dynamics::{BodyDef, BodyId, EventKind, Settings, World};
use carom_geometry::{Circle, Compound, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Pose, Rot, Vec2, trig, vec2};
use carom_tests::run;
use carom_tests::scenes::surface;

const G: f64 = 9.81;

fn on_floor(friction: f64) -> World {
    let mut world = World::new(Settings {
        sleep: None,
        ..Settings::default()
    })
    .expect("valid");
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
    world
        .insert(BodyDef::fixed(), Shape::from(floor), surface(0.0, friction))
        .expect("valid");
    world
}

/// A box of 1 m × 2 m with its lower right corner at the origin, turned by `angle` about it.
fn tilted(world: &mut World, angle: f64, spin: f64, friction: f64) -> BodyId {
    let arm = Rot::from_angle(angle) * vec2(-0.5, 1.0);
    let def = BodyDef::dynamic()
        .at(arm)
        .turned(angle)
        .moving(vec2(-arm.y, arm.x) * spin)
        .spinning(spin);
    let shape = ConvexPolygon::rectangle(1.0, 2.0).expect("a box");
    world
        .insert(def, shape, surface(0.0, friction))
        .expect("valid")
}

/// θ″ of a body on its corner by the classic method of order 4 in many small steps; θ: of the arm, from the vertical.
fn pendulum(mut angle: f64, mut spin: f64, seconds: f64) -> (f64, f64) {
    let (steps, arm) = (400_000, 1.25_f64.sqrt());
    // I about the corner: m (1² + 2²)/12 + m arm².
    let rate = G * arm / (5.0 / 12.0 + 1.25);
    let h = seconds / f64::from(steps);
    let f = |angle: f64| rate * trig::sin_cos(angle).0;
    for _ in 0..steps {
        let (a1, w1) = (spin, f(angle));
        let (a2, w2) = (spin + 0.5 * h * w1, f(angle + 0.5 * h * a1));
        let (a3, w3) = (spin + 0.5 * h * w2, f(angle + 0.5 * h * a2));
        let (a4, w4) = (spin + h * w3, f(angle + h * a3));
        angle += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
        spin += h / 6.0 * (w1 + 2.0 * (w2 + w3) + w4);
    }
    (angle, spin)
}

#[test]
fn a_box_on_its_corner_is_a_pendulum() {
    // Its arm leans by atan(1/2) when it stands: from rest it falls back or over, thrown it passes the top.
    let lean = 0.463_647_609_000_806_1;
    for (angle, spin, seconds) in [(-0.3, 0.0, 0.6), (-0.7, 1.2, 0.4), (-0.45, -0.2, 0.8)] {
        let mut world = on_floor(5.0);
        let id = tilted(&mut world, angle, spin, 5.0);
        let start = world.energy().mechanical();
        let mut worst = 0.0_f64;
        run(&mut world, seconds, |world| {
            worst = worst.max((world.energy().mechanical() / start - 1.0).abs());
        });
        let body = world.body(id).expect("it is there");
        let (wanted, speed) = pendulum(lean + angle, spin, world.time().as_secs());
        let arm = Rot::from_angle(wanted - lean) * vec2(-0.5, 1.0);
        let off = (body.centre() - arm).length();
        println!("{angle}: off by {off:e} m, energy {worst:e}");
        assert!(off < 1e-10, "{off:e} m off after {seconds} s from {angle}");
        assert!((body.angular_velocity() - speed).abs() < 1e-10);
        assert!(worst < 1e-12, "energy {worst:e}");
        assert!(world.energy().residual().abs() < 1e-11);
    }
}

#[test]
fn a_box_that_tips_over_comes_to_rest_on_its_side() {
    // Near the end the floor carries little and pulls much: with µ = 5 it would slip.
    let mut world = on_floor(100.0);
    let id = tilted(&mut world, -0.7, 0.0, 100.0);
    let mut before = world.energy().mechanical();
    let mut landed = None;
    while world.time().as_secs() < 3.0 {
        world.step_to_next_event(0.01);
        let now = world.energy().mechanical();
        assert!(now <= before + 1e-12 * before, "{:e}", now - before);
        before = now;
        for event in world.events() {
            if let EventKind::Impact { .. } = event.kind {
                landed.get_or_insert(event.time.as_secs());
            }
        }
    }
    // The instant at which the box has turned by a right angle from where it stands.
    let lean = 0.463_647_609_000_806_1;
    let landed = landed.expect("it lands");
    let (angle, _) = pendulum(lean - 0.7, 0.0, landed);
    assert!((angle - lean + core::f64::consts::FRAC_PI_2).abs() < 1e-10);
    let body = world.body(id).expect("it is there");
    assert_eq!(
        (body.velocity(), body.angular_velocity()),
        (Vec2::ZERO, 0.0)
    );
    assert!((body.centre().y - 0.5).abs() < 1e-10, "{}", body.centre());
}

#[test]
fn a_disc_leaves_a_disc_at_two_thirds_of_its_height() {
    let mut world = World::new(Settings::default()).expect("valid");
    let dome = Circle::new(1.0).expect("a dome");
    world
        .insert(BodyDef::fixed(), dome, surface(0.0, 0.0))
        .expect("valid");
    let from = Rot::from_angle(-0.05) * vec2(0.0, 1.5);
    let disc = Circle::new(0.5).expect("a disc");
    let id = world
        .insert(BodyDef::dynamic().at(from), disc, surface(0.0, 0.0))
        .expect("valid");
    let start = world.energy().mechanical();
    let mut left = None;
    run(&mut world, 1.4, |world| {
        let off = (world.energy().mechanical() / start - 1.0).abs();
        assert!(off < 1e-12, "{off:e} at {:?}", world.time());
        let centre = world.body(id).expect("it is there").centre();
        if centre.length() > 1.5 + 1e-9 {
            left.get_or_insert(centre.y);
        } else {
            assert!(centre.length() > 1.5 - 1e-12);
        }
    });
    let left = left.expect("it leaves");
    assert!((left / from.y - 2.0 / 3.0).abs() < 0.03, "{left}");
}

#[test]
fn what_a_tipping_box_hits_it_hits_at_the_instant() {
    // A post stands where the upper corner passes: the gap is 0 where they strike.
    let mut world = on_floor(5.0);
    let id = tilted(&mut world, -0.7, 0.0, 5.0);
    let post = ConvexPolygon::rectangle(0.2, 1.0).expect("a post");
    world
        .insert(BodyDef::fixed().at(vec2(1.9, 0.5)), post, surface(0.0, 0.0))
        .expect("valid");
    let lean = 0.463_647_609_000_806_1;
    let mut struck = false;
    for _ in 0..1000 {
        world.step_to_next_event(0.01);
        for event in world.events() {
            if let EventKind::Impact { point, .. } = event.kind {
                let (angle, _) = pendulum(lean - 0.7, 0.0, event.time.as_secs());
                let rotation = Rot::from_angle(angle - lean);
                let corner = rotation * vec2(0.0, 2.0);
                assert!((corner.x - 1.8).abs() < 1e-10, "{corner}");
                assert!((point - corner).length() < 1e-9, "{point}");
                struck = true;
            }
        }
        if struck {
            break;
        }
    }
    assert!(struck, "{}", world.body(id).expect("there").centre());
}

/// A convex polygon in triangles that share a corner lands on it and tips as it does in one piece, while closed forms move both.
#[test]
fn a_corner_that_parts_share_is_one_corner() {
    let corners = [
        vec2(-1.0, -0.5),
        vec2(0.8, -0.6),
        vec2(1.2, 0.1),
        vec2(0.7, 0.6),
        vec2(-0.9, 0.7),
    ];
    let whole = ConvexPolygon::new(corners).expect("a polygon");
    let aside = vec2(10.0, 0.0);
    for (angle, spin, friction) in [(0.3, 0.0, 0.6), (-0.5, 1.0, 0.2), (2.0, -1.5, 1.0)] {
        for first in 0..5 {
            let fan = |k: usize| [0, k, k + 1].map(|i| corners[(i + first) % 5]);
            let triangle = |k| Shape::from(ConvexPolygon::new(fan(k)).expect("a triangle"));
            let parts = Compound::new((1..4).map(|k| (triangle(k), Pose::IDENTITY)));
            let parts = Shape::from(parts.expect("triangles"));
            let mut world = on_floor(friction);
            let mut insert = |shape: Shape, at: Vec2| {
                let def = BodyDef::dynamic().at(at).turned(angle);
                let def = def.moving(vec2(0.5, 0.0)).spinning(spin);
                let surface = surface(0.0, friction);
                world.insert(def, shape, surface).expect("valid")
            };
            let start = vec2(0.0, 1.6);
            let ids = [
                insert(whole.clone().into(), start),
                insert(parts, start + aside),
            ];
            let mut steps = 0;
            for _ in 0..120 {
                let report = world.step(1.0 / 60.0);
                assert_eq!(report.unresolved, 0, "first corner {first}");
                if !report.is_exact() {
                    break;
                }
                let [one, other] = ids.map(|id| world.body(id).expect("it is there"));
                let off = (other.centre() - one.centre() - aside).length();
                let turned = (other.angle() - one.angle()).abs();
                assert!(off + turned < 1e-9, "{off:e} m, {turned:e}, step {steps}");
                steps += 1;
            }
            // It touches after 20 to 25.
            assert!(steps >= 30, "{steps}");
        }
    }
}
