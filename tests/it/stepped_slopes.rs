//! Stepped mode against closed forms: how the error falls with the sub-step (cases 8, 9, 13, 16, 17).

use carom_dynamics::{BodyDef, BodyId, Material, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::{Rot, Vec2, vec2};
use carom_tests::run;
use carom_tests::scenes::{block, boxed, column, disc, put, stepped};

const G: f64 = 10.0;

/// Sub-steps per second.
const RATES: [f64; 4] = [240.0, 480.0, 960.0, 1920.0];

fn world(rate: f64) -> World {
    stepped(Settings {
        gravity: vec2(0.0, -G),
        tick: 4.0 / rate,
        substep: 1.0 / rate,
        sleep: None,
        ..Settings::default()
    })
}

fn rough(friction: f64) -> Material {
    Material {
        friction,
        ..Material::default()
    }
}

/// Asserts that errors over the rates fall with the square of the sub-step, or are nothing.
fn second_order(what: &str, error: impl Fn(f64) -> f64) {
    let errors = RATES.map(error);
    for (k, pair) in errors.windows(2).enumerate() {
        // A slope of 1.8: each halving of the sub-step leaves 2^-1.8 of the error.
        let ratio = pair[0] / pair[1];
        assert!(
            pair[1] < 1e-10 || ratio >= 3.482,
            "{what}: ratio {ratio:.2} from {} to {} sub-steps a second, {errors:?}",
            RATES[k],
            RATES[k + 1]
        );
    }
}

/// A slope of 20°, and what stands on it at rest; settled for 0.2 s before the clock runs.
fn on_a_slope(
    rate: f64,
    mu: f64,
    body: impl Fn(&mut World, BodyDef, Material) -> BodyId,
) -> (World, BodyId, Rot) {
    let mut world = world(rate);
    let down = Rot::from_degrees(20.0);
    let def = BodyDef::fixed()
        .at(down * vec2(0.0, -1.0))
        .turned(20.0_f64.to_radians());
    put(&mut world, def, block(400.0, 2.0), rough(mu));
    let def = BodyDef::dynamic()
        .at(down * vec2(0.0, 0.5))
        .turned(20.0_f64.to_radians());
    let id = body(&mut world, def, rough(mu));
    (world, id, down)
}

fn along(world: &World, id: BodyId, down: Rot) -> (f64, f64) {
    let body = world.body(id).expect("it stays");
    let to = |v: Vec2| -(down.inverse() * v).x;
    (to(body.centre()), to(body.velocity()))
}

/// Distance slid or rolled in 1.8 s, from the state after 0.2 s, against `a`.
fn run_down(mut scene: (World, BodyId, Rot), a: f64) -> f64 {
    scene.0.step(0.2);
    let (from, v) = along(&scene.0, scene.1, scene.2);
    scene.0.step(1.8);
    let (to, _) = along(&scene.0, scene.1, scene.2);
    ((to - from) - (v * 1.8 + 0.5 * a * 1.8 * 1.8)).abs()
}

#[test]
fn case_08_blocks_slide_and_stop_to_second_order() {
    let slope = Rot::from_degrees(20.0);
    let a = G * (slope.sin() - 0.2 * slope.cos());
    second_order("slide", |rate| {
        let square = |world: &mut World, def, material| put(world, def, block(1.0, 1.0), material);
        run_down(on_a_slope(rate, 0.2, square), a)
    });
    second_order("stop", |rate| {
        let mut world = world(rate);
        put(
            &mut world,
            BodyDef::fixed().at(vec2(0.0, -1.0)),
            block(2000.0, 2.0),
            rough(0.3),
        );
        let id = boxed(&mut world, vec2(0.0, 0.5), rough(0.3));
        world.set_velocity(id, vec2(5.0, 0.0), 0.0).expect("valid");
        world.step(0.2);
        let body = world.body(id).expect("it stays");
        let (from, v) = (body.centre().x, body.velocity().x);
        world.step(4.0);
        let went = world.body(id).expect("it stays").centre().x - from;
        (went - v * v / (2.0 * 0.3 * G)).abs()
    });
}

#[test]
fn case_08_a_block_that_friction_holds_does_not_creep() {
    for (rate, mu) in [(240.0, 0.37), (960.0, 0.37), (240.0, 0.5), (960.0, 0.5)] {
        let square = |world: &mut World, def, material| put(world, def, block(1.0, 1.0), material);
        let (mut world, id, down) = on_a_slope(rate, mu, square);
        world.step(0.2);
        let (from, _) = along(&world, id, down);
        run(&mut world, 20.0, |_| {});
        let (to, _) = along(&world, id, down);
        assert!(
            (to - from).abs() < 1e-5,
            "µ = {mu} at {rate}: crept {:.1e} m",
            to - from
        );
    }
}

#[test]
fn case_09_a_disc_rolls_to_second_order() {
    let slope = Rot::from_degrees(20.0);
    second_order("roll", |rate| {
        let round = |world: &mut World, def, material| put(world, def, disc(0.5), material);
        run_down(on_a_slope(rate, 1.0, round), 2.0 / 3.0 * G * slope.sin())
    });
}

#[test]
fn case_13_a_stack_sinks_in_less_with_shorter_sub_steps() {
    let depths = RATES.map(|rate| {
        let mut world = world(rate);
        put(
            &mut world,
            BodyDef::fixed().at(vec2(0.0, -1.0)),
            block(200.0, 2.0),
            Material::default(),
        );
        let ids = column(&mut world, 20, Material::default());
        run(&mut world, 10.0, |_| {});
        let y = |k: usize| world.body(ids[k]).expect("it stays").centre().y;
        for id in &ids {
            let body = world.body(*id).expect("it stays");
            assert!(
                body.centre().x.abs() < 1e-9 && body.angle().abs() < 1e-9,
                "{}",
                body.centre()
            );
        }
        (0..20)
            .map(|k| {
                if k == 0 {
                    0.5 - y(0)
                } else {
                    1.0 - (y(k) - y(k - 1))
                }
            })
            .fold(0.0, f64::max)
    });
    for pair in depths.windows(2) {
        assert!(pair[1] < 0.3 * pair[0], "depths {depths:?}");
    }
}

#[test]
fn case_16_slivers_come_to_rest_on_the_floor() {
    let needle = [(-0.5, 0.0), (0.5, -0.0005), (0.5, 0.0005)];
    let needle = ConvexPolygon::new(needle.map(|(x, y)| vec2(x, y)).to_vec())
        .expect("a needle")
        .centred();
    for (name, shape) in [("box", block(1.0, 0.001)), ("needle", needle)] {
        for angle in [0.0, 30.0, 89.0_f64] {
            let dense = Material {
                density: 1000.0,
                friction: 0.5,
                ..Material::default()
            };
            let mut world = stepped(Settings {
                gravity: vec2(0.0, -G),
                ..Settings::default()
            });
            put(
                &mut world,
                BodyDef::fixed().at(vec2(0.0, -1.0)),
                block(2000.0, 2.0),
                dense,
            );
            let def = BodyDef::dynamic()
                .at(vec2(0.0, 1.2))
                .turned(angle.to_radians());
            let id = put(&mut world, def, shape.clone(), dense);
            let mut deepest = 0.0_f64;
            run(&mut world, 5.0, |world| {
                let bounds = world.body(id).expect("it stays").aabb();
                deepest = deepest.max(-bounds.min.y);
            });
            let body = world.body(id).expect("it stays");
            let (c, v) = (body.centre(), body.velocity());
            assert!(
                (-0.01..0.02).contains(&c.y) && c.x.abs() < 2.0 && v.length() < 0.05,
                "{name} at {angle}°: {c}, {v}"
            );
            assert!(deepest < 1e-3, "{name} at {angle}°: {deepest:.1e} m deep");
        }
    }
}

#[test]
fn case_17_far_from_the_origin_is_as_at_it() {
    let stop = |x: f64| {
        let mut world = world(240.0);
        put(
            &mut world,
            BodyDef::fixed().at(vec2(x, -1.0)),
            block(200.0, 2.0),
            rough(0.3),
        );
        let id = boxed(&mut world, vec2(x + 0.3, 0.5), rough(0.3));
        let from = world.body(id).expect("it stays").centre();
        world.set_velocity(id, vec2(3.0, 0.0), 0.0).expect("valid");
        run(&mut world, 3.0, |_| {});
        world.body(id).expect("it stays").centre() - from
    };
    let stack = |x: f64| {
        let mut world = world(240.0);
        put(
            &mut world,
            BodyDef::fixed().at(vec2(x, -1.0)),
            block(200.0, 2.0),
            Material::default(),
        );
        let ids: Vec<_> = (0..5)
            .map(|i| {
                boxed(
                    &mut world,
                    vec2(x + 0.3 + 0.03 * f64::from(i), 0.5 + f64::from(i)),
                    Material::default(),
                )
            })
            .collect();
        run(&mut world, 10.0, |_| {});
        world.body(ids[4]).expect("it stays").centre() - vec2(x, 0.0)
    };
    let (near, tower) = (stop(0.0), stack(0.0));
    for x in [1e4, 1e5, 1e6] {
        let off = [(stop(x) - near).length(), (stack(x) - tower).length()];
        assert!(off[0] < 1e-8 && off[1] < 1e-8, "at {x:e} m: {off:?}");
    }
}
