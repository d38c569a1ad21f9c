//! A body that a caller kicks within a sub-step goes on to its end without rows, up to half a hundredth of itself into what it
//! touches, and the solver parts what overlaps in the next one.
//! Reports told how deep bodies are where a sub-step ends: a thin plate was seen 8 mm in its floor, and the report said 0 (scripts
//! 4850, 4973 and 19697).

use carom_dynamics::{BodyDef, BodyId, Impulse, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::checks::overlapping;
use carom_tests::scenes::{block, disc, put, surface};

/// Length of a sub-step, in s.
const H: f64 = 1.0 / 360.0;

/// A thin plate on a floor, and a disc on the plate, a quarter of a sub-step after one began.
fn plate(mode: Mode, restitution: f64) -> (World, [BodyId; 2]) {
    let settings = Settings {
        mode,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let rough = surface(restitution, 0.5);
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    put(&mut world, floor, block(20.0, 2.0), rough);
    let def = BodyDef::dynamic().at(vec2(0.0, 1e-3));
    let plate = put(&mut world, def, block(1.9, 2e-3), rough);
    let on_it = BodyDef::dynamic().at(vec2(0.3, 0.252));
    let on_it = put(&mut world, on_it, disc(0.25), rough);
    world.step(20.25 * H);
    (world, [plate, on_it])
}

fn deepest(world: &World) -> f64 {
    let depths = overlapping(world).into_iter().map(|(_, _, depth)| depth);
    depths.fold(0.0, f64::max)
}

#[test]
fn an_overlap_within_a_sub_step_is_told() {
    let mut seen = 0.0_f64;
    for mode in [Mode::Stepped, Mode::Hybrid, Mode::Exact] {
        for (restitution, number, x, speed) in [
            (0.0, 0, -0.5, 1.5),
            (0.5, 0, -0.5, 1.5),
            (0.0, 1, 0.3, 0.55),
            (0.5, 1, 0.3, 0.55),
        ] {
            let (mut world, bodies) = plate(mode, restitution);
            let mass = world.body(bodies[number]).expect("it is there").mass();
            let kick = Impulse::at(vec2(x, 0.0), vec2(0.0, -speed * mass));
            world.apply(bodies[number], kick).expect("a kick");
            for part in 0..8 {
                let report = world.step(0.2 * H);
                let depth = deepest(&world);
                seen = seen.max(depth);
                assert!(
                    report.deepest_overlap > depth - 1e-12,
                    "{mode:?}, restitution {restitution}, part {part}: {depth} m deep, {report:?}"
                );
            }
        }
    }
    // It is about overlaps, and there are some.
    assert!(seen > 1e-3, "{seen} m");
}

/// Only the centre's velocity was asked whether a caller drives a body into what it touches: 0.6 mm of 2 in stepped mode.
#[test]
fn a_plate_that_is_spun_within_a_sub_step_stays_on_its_floor() {
    for mode in [Mode::Stepped, Mode::Hybrid] {
        let (mut world, [plate, _]) = plate(mode, 0.5);
        world.set_velocity(plate, Vec2::ZERO, 60.0).expect("a spin");
        world.step(0.7 * H);
        let depth = deepest(&world);
        assert!(depth < 1e-4, "{mode:?}: {depth} m deep");
    }
}
