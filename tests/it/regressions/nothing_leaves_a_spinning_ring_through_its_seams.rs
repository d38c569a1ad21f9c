//! What lies in a ring that spins is pressed outwards by turning, and a corner of it sinks into the seam of two of the ring's
//! pieces by 1/256 of a size before it is struck. Struck so, nothing held the pair any more, and a search from there took
//! the corner for one that had come in through the cut, and so had touched the other piece before: in both pieces. Bodies
//! went out through the wall by up to 0.3 of their size.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::vec2;
use carom_tests::scenes::{octagon, put, surface};

#[test]
fn nothing_leaves_a_spinning_ring_through_its_seams() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for (spin, e) in [(-14.7, 0.3), (14.0, 0.7), (13.0, 0.5)] {
            for at in [vec2(0.0, -0.9), vec2(0.5, 0.4), vec2(-0.3, 1.0)] {
                let settings = Settings {
                    mode,
                    ..Settings::default()
                };
                let mut world = World::new(settings).expect("valid settings");
                let material = surface(e, 0.0);
                let ring = BodyDef::kinematic().spinning(spin);
                put(&mut world, ring, octagon(), material);
                let pentagon = ConvexPolygon::regular(5, 0.4).expect("a pentagon");
                let inside = BodyDef::dynamic().at(at).moving(vec2(-3.0, -1.0));
                let inside = put(&mut world, inside, pentagon.clone(), material);
                for _ in 0..180 {
                    world.step(1.0 / 60.0);
                    let pose = world.body(inside).expect("it stays").pose();
                    let corners = pentagon.vertices().iter();
                    let out = corners.map(|corner| pose.point(*corner).length() - 2.0);
                    let out = out.fold(0.0, f64::max);
                    let what = (mode, spin, e, at, world.time());
                    assert!(out < 0.01, "{out} m out of the ring: {what:?}");
                }
            }
        }
    }
}
