//! Two edges in one line that share only an end: rounding made the far end the lowest vertex, and
//! the impact was put there, 1.9 m from where the shapes meet.

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_geometry::{ConvexPolygon, Shape};
use carom_math::vec2;

#[test]
fn tips_that_meet_do_not_spin() {
    // Two right triangles with their long edges in one line, tip to tip; one falls along it.
    let shape = |mirror: f64| {
        let points = [
            vec2(0.0, 0.0),
            vec2(1.7 * mirror, 0.8),
            vec2(1.7 * mirror, -0.8),
        ];
        Shape::from(ConvexPolygon::new(points).expect("an arrowhead"))
    };
    let (left, right) = (shape(-1.0), shape(1.0));
    for k in 0..200_u32 {
        let gap = 0.1 + 0.013 * f64::from(k);
        let coming = Motion {
            velocity: vec2(-1.0, 0.0),
            ..Motion::resting(vec2(gap, -3.0))
        };
        let still = Motion::resting(vec2(0.0, -3.0));
        let TimeOfImpact::Hit(hit) = time_of_impact(&left, &still, &right, &coming, 10.0) else {
            panic!("they meet after {gap} s");
        };
        assert!((hit.time - gap).abs() < 1e-13);
        let off = (hit.point() - vec2(0.0, -3.0)).length();
        assert!(off < 1e-9, "touches {off} m from the tips");
    }
}
