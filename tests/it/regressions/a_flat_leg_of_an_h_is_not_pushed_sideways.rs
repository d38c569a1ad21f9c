//! An H lies on its leg, turned by a little: the triangle at the leg's higher corner may not be
//! touched along the floor's normal, and once took the floor's far side, 10 m away, instead.

use carom_collision::contacts;
use carom_geometry::{ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Rot, vec2};

#[test]
fn a_flat_leg_of_an_h_is_not_pushed_sideways() {
    let floor = Shape::from(ConvexPolygon::rectangle(16.0, 0.5).expect("a floor"));
    let corners = [
        (-1.0, -1.2),
        (-0.4, -1.2),
        (-0.4, -0.3),
        (0.4, -0.3),
        (0.4, -1.2),
        (1.0, -1.2),
        (1.0, 1.2),
        (0.4, 1.2),
        (0.4, 0.3),
        (-0.4, 0.3),
        (-0.4, 1.2),
        (-1.0, 1.2),
    ];
    let h = Shape::from(Polygon::new(corners.map(|(x, y)| vec2(x, y))).expect("an H"));
    for k in -40..=40_i32 {
        let tilt = 1e-4 * f64::from(k);
        for sunk in [1e-5, 1e-4, 1e-3] {
            let rotation = Rot::from_degrees(-90.0) * Rot::from_angle(tilt);
            let lowest = h.aabb(Pose::new(vec2(0.0, 0.0), rotation)).min.y;
            let pose = Pose::new(vec2(1.3, 0.25 - lowest - sunk), rotation);
            let mut found = Vec::new();
            contacts(&floor, &h, pose, 1e-3, &mut found);
            assert!(!found.is_empty(), "nothing at {tilt} rad, {sunk} m deep");
            for part in found {
                assert!(
                    part.manifold.normal.y > 0.99,
                    "{tilt} rad: {:?}",
                    part.manifold
                );
                for point in &part.manifold.points {
                    assert!(
                        point.separation > -2.0 * sunk,
                        "{tilt} rad: {:?}",
                        part.manifold
                    );
                }
            }
        }
    }
}
