//! Nine bodies in a box, three of them 1e3 or 1e6 times as heavy as the others: they struck each other so often that they
//! joined the solver of large islands in hybrid mode, and light ones were pushed out through the walls by up to 0.34 m: sweeps do
//! not converge for such mass ratios, and the impulses that bore a heavy body were taken for speeds of arrival. They are solved for
//! directly now.

use carom_dynamics::{BodyDef, Mode};
use carom_geometry::{ConvexPolygon, Shape};
use carom_math::{trig, vec2};
use carom_tests::scenes::{block, outside, put, surface, walled};

#[test]
fn a_few_heavy_bodies_push_no_light_ones_out() {
    let half = vec2(1.0, 1.5);
    for (e, heavy) in [(0.3, 1e3), (0.3, 1e6), (0.7, 1e3), (0.7, 1e6)] {
        for seed in [0.0, 1.0, 2.0] {
            let material = surface(e, 0.5);
            let mut world = walled(Mode::Hybrid, half, material);
            for k in 0..9 {
                let n = f64::from(k);
                let wave = |phase: f64| trig::sin_cos(phase * n + seed).0;
                let (row, column) = (f64::from(k / 3), f64::from(k % 3));
                let at = vec2(0.62 * column - 0.62 + 0.03 * wave(1.7), 0.62 * row - 1.0);
                let mass = if [3, 7, 8].contains(&k) { heavy } else { 1.0 };
                let def = BodyDef::dynamic().at(at).turned(0.4 * n + seed);
                let def = def.moving(vec2(4.0 * wave(2.3), -2.0)).with_mass(mass);
                let pentagon = || ConvexPolygon::regular(5, 0.27).expect("a pentagon");
                let shape = if k % 2 == 0 {
                    block(0.4, 0.2)
                } else {
                    pentagon()
                };
                put(&mut world, def, Shape::from(shape), material);
            }
            for _ in 0..60 {
                world.step(1.0 / 60.0);
                let deep = outside(&world, half);
                let what = (e, heavy, seed, world.time());
                assert!(deep < 0.01, "{deep} m outside: {what:?}");
            }
        }
    }
}
