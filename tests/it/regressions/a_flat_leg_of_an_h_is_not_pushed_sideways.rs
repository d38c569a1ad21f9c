//! An H lies on its leg, turned by 1e-4: the triangle at the leg's higher corner may not be touched
//! along the floor's normal, and once took the floor's far side, 10 m away, instead.

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
    let h = Polygon::new(corners.map(|(x, y)| vec2(x, y))).expect("an H");
    let rotation = Rot::from_direction(vec2(1.030_613_460_910_333e-4, -0.999_999_994_689_179_4));
    let pose = Pose::new(
        vec2(1.341_854_661_127_905_2, 0.999_910_985_787_012_3 + 0.25),
        rotation.expect("a direction"),
    );
    let mut found = Vec::new();
    contacts(&floor, &Shape::from(h), pose, 1e-3, &mut found);
    assert!(!found.is_empty());
    for part in found {
        assert!(part.manifold.normal.y > 0.999, "{:?}", part.manifold);
        for point in &part.manifold.points {
            assert!(point.separation > -1e-2, "{:?}", part.manifold);
        }
    }
}
