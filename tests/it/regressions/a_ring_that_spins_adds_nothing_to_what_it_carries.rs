//! A disc in a ring that spins without gravity is pressed to its wall by turning alone. What counts as rest knew nothing of
//! that: bounces outran their budget, the soft solver took a disc that was still 3 mm deep a sub-step later, and the two
//! gained 1.4e-4 of their energy in 1/240 s. In an obtuse corner the disc went from wall to wall for ever, and one that was
//! struck out of its corner went on by the parabola of the path that it had left.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::{Compound, ConvexPolygon, Shape};
use carom_math::{Pose, Vec2, trig, vec2};
use carom_tests::scenes::{disc, hollow, put, surface};

/// A ring of eight pieces, 0.5 m thick.
fn octagon() -> Shape {
    let corner = |k: u32, radius: f64| {
        let (sin, cos) = trig::sin_cos(core::f64::consts::TAU * f64::from(k % 8) / 8.0);
        vec2(cos, sin) * radius
    };
    let piece = |k: u32| {
        let corners = [(k, 2.0), (k, 2.5), (k + 1, 2.5), (k + 1, 2.0)];
        let corners = corners.map(|(k, radius)| corner(k, radius)).to_vec();
        let piece = ConvexPolygon::new(corners).expect("a piece of a ring");
        (Shape::from(piece), Pose::IDENTITY)
    };
    Compound::new((0..8).map(piece)).expect("a ring").into()
}

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
                for _ in 0..480 {
                    world.step(1.0 / 240.0);
                    let now = world.energy().mechanical();
                    let what = || format!("{mode:?}, e = {e}, µ = {friction}, {:?}", world.time());
                    let gain = (now - before) / start;
                    assert!(gain < 1e-12, "{gain:e} gained, {}", what());
                    let off = world.momentum().angular / turns - 1.0;
                    assert!(off.abs() < 1e-12, "{off:e} of the turning, {}", what());
                    before = now;
                }
            }
        }
    }
}
