//! The row of a disc on a face was that of the tick's begin, and a face that turns on a disc by an angle a until the next one comes
//! R a² / 2 nearer: a plank sank 47 mm into a disc of 40 m, a thin plate right through one of 1 m (script 4161). Such rows are
//! rotated with their faces now, from the tick on in which they are found.

use carom_dynamics::{BodyDef, BodyId, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::checks::depth;
use carom_tests::scenes::{block, disc, put, surface};

/// A disc that stands, a plate `above` it, `spinning` at the start, and how deep they get into each other in two thirds of a second.
fn deepest(radius: f64, size: Vec2, above: Vec2, spinning: f64) -> f64 {
    let settings = Settings {
        mode: Mode::Stepped,
        sleep: None,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let rough = surface(0.0, 1.0);
    let stands = BodyDef::fixed().at(vec2(0.0, -radius));
    let stands = put(&mut world, stands, disc(radius), rough);
    let rolls = BodyDef::dynamic().at(above).spinning(spinning);
    let rolls = put(&mut world, rolls, block(size.x, size.y), rough);
    let mut deepest = 0.0_f64;
    for _ in 0..40 {
        world.step(1.0 / 60.0);
        let body = |id: BodyId| world.body(id).expect("it is there");
        deepest = deepest.max(depth(&body(stands), &body(rolls)));
    }
    deepest
}

#[test]
fn a_plank_that_rolls_on_a_disc_stays_on_it() {
    for (radius, spin) in [(10.0, 4.0), (40.0, 2.0), (40.0, 3.0), (40.0, 4.0)] {
        let depth = deepest(radius, vec2(3.0, 0.1), vec2(0.0, 0.05), spin);
        assert!(depth < 12e-3, "{depth} m at {spin} rad/s on {radius} m");
    }
}

#[test]
fn a_thin_plate_that_falls_on_a_disc_stays_on_it() {
    for spin in [-3.0, 2.0, 3.0, 4.0, 6.0] {
        for x in [0.0, 0.02, 0.05] {
            let depth = deepest(1.0, vec2(0.27, 4e-4), vec2(x, 0.02), spin);
            assert!(depth < 3e-3, "{depth} m at {spin} rad/s from {x} m");
        }
    }
}
