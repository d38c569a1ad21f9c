//! A disc in a ring that spins without gravity is pressed to its wall by turning alone. What counts as rest knew nothing of
//! that: bounces outran their budget, the soft solver took a disc that was still 3 mm deep a sub-step later, and the two
//! gained 1.4e-4 of their energy in 1/240 s. In an obtuse corner the disc went from wall to wall for ever, and one that was
//! struck out of its corner went on by the parabola of the path that it had left.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::Shape;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{disc, hollow, octagon, put, surface};

/// What bodies that turn about each other show more of their energy within a sub-step than at its ends, at most: they go straight there,
/// and on a chord both are nearer to their centre, (ωh)²/8 of the way, and so are faster with the angular momentum that they keep.
const CHORD: f64 = (20.0 / 360.0) * (20.0 / 360.0) / 8.0;

#[test]
fn a_ring_that_spins_adds_nothing_to_what_it_carries() {
    for (ring, mode) in [
        (Shape::from(hollow()), Mode::Hybrid),
        (octagon(), Mode::Hybrid),
        (hollow().into(), Mode::Exact),
        (octagon(), Mode::Exact),
    ] {
        for e in [0.0, 0.3, 0.5, 0.8] {
            for friction in [0.0, 0.3] {
                let mut world = World::new(Settings {
                    gravity: Vec2::ZERO,
                    sleep: None,
                    mode,
                    ..Settings::default()
                })
                .expect("valid settings");
                let material = surface(e, friction);
                let spins = BodyDef::dynamic().spinning(20.0);
                put(&mut world, spins, ring.clone(), material);
                let def = BodyDef::dynamic().at(vec2(1.0, 0.3)).moving(vec2(3.0, 0.5));
                put(&mut world, def, disc(0.4), material);
                let (start, turns) = (world.energy().mechanical(), world.momentum().angular);
                let mut before = start;
                for look in 1..=960 {
                    // Four looks a sub-step: the last one is where it ends.
                    world.step(1.0 / 1440.0);
                    let now = world.energy().mechanical();
                    let what = || format!("{mode:?}, e = {e}, µ = {friction}, {:?}", world.time());
                    let off = world.momentum().angular / turns - 1.0;
                    assert!(off.abs() < 1e-12, "{off:e} of the turning, {}", what());
                    let gain = (now - before) / start;
                    if look % 4 == 0 {
                        assert!(gain < 1e-12, "{gain:e} gained, {}", what());
                        before = now;
                    } else {
                        assert!(gain < CHORD, "{gain:e} more within, {}", what());
                    }
                }
            }
        }
    }
}
