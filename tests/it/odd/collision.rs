//! Whatever numbers come in with shapes that are legal, an answer comes out: `time_of_impact` panicked where one was NaN or infinite.

use carom_geometry::{Circle, Compound, ConvexPolygon, HalfPlane, Polygon, Segment, Shape};
use carom_math::{Pose, Rot, SimTime, Vec2, vec2};

use carom_collision::{
    Motion, ShapeTree, TimeOfImpact, cast, collide, collide_within, contacts, contacts_and_gap,
    distance, earlier, hulls, intersection, minimum_push, overlap_area, separating_axis,
    shape_distance, shape_push, time_of_impact, time_of_impact_beside, time_of_impact_from,
    vertex_edge_contacts,
};

use super::Odd;

impl Odd {
    fn pose(&mut self) -> Pose {
        Pose::new(self.vector(), Rot::from_angle(self.number()))
    }

    fn motion(&mut self) -> Motion {
        Motion {
            velocity: self.vector(),
            acceleration: self.vector(),
            spin: self.number(),
            angular_acceleration: self.number(),
            rotation: Rot::from_angle(self.number()),
            ..Motion::resting(self.vector())
        }
    }

    fn shape(&mut self) -> Shape {
        let size = [0.5, 1.0, 2.0, 1e-3, 1e4, 1e12, 1e-9][self.below(7)];
        let unit = |shape: Result<ConvexPolygon, _>| -> Shape { shape.expect("convex").into() };
        match self.below(8) {
            0 => Circle::new(size).expect("a disc").into(),
            1 => Circle::at(vec2(0.3, -0.2), 0.7).expect("a disc").into(),
            2 => unit(ConvexPolygon::rectangle(size, 0.3)),
            3 => unit(ConvexPolygon::regular(3 + self.below(9), size)),
            4 => Polygon::star(5, 1.0, 0.4).expect("a star").into(),
            5 => Segment::new(vec2(-1.0, 0.1), vec2(0.8, -size))
                .expect("a segment")
                .into(),
            6 => HalfPlane::new(vec2(0.1, 0.2), Vec2::Y)
                .expect("a half-plane")
                .into(),
            _ => {
                let disc: Shape = Circle::new(0.4).expect("a disc").into();
                let parts = [
                    (disc, Pose::at(vec2(-0.5, 0.0))),
                    (
                        unit(ConvexPolygon::regular(5, 0.5)),
                        Pose::at(vec2(0.5, 0.1)),
                    ),
                ];
                Compound::new(parts).expect("two parts").into()
            }
        }
    }
}

#[test]
fn no_number_makes_a_search_panic() {
    for seed in (1..150_u64).chain([2241, 3921]) {
        let mut odd = Odd::new(seed, 4);
        let (a, b) = (odd.shape(), odd.shape());
        let (one, two, horizon) = (odd.motion(), odd.motion(), odd.number());
        let late = SimTime::ZERO + 0.125;
        let first = time_of_impact(&a, &one, &b, &two, horizon);
        let second = time_of_impact_from(late, None, &a, &one, &b, &two, horizon);
        if let TimeOfImpact::Hit(impact) | TimeOfImpact::Touching(impact) = &first {
            let last = impact.features.first().copied();
            let _ = time_of_impact_from(late, last, &a, &one, &b, &two, horizon);
            let _ = impact.point();
        }
        let _ = earlier(first, second);
        let _ = time_of_impact_beside((late, odd.number()), &a, &one, &b, &two, horizon);
        let _ = one.swept_box(&a, late, odd.number());
    }
}

#[test]
fn no_number_makes_a_query_panic() {
    for seed in 1..3000_u64 {
        let mut odd = Odd::new(seed, 4);
        let (a, b) = (odd.shape(), odd.shape());
        let (pose, margin) = (odd.pose(), odd.number());
        let _ = shape_distance(&a, &b, pose);
        let _ = shape_push(&a, &b, pose);
        let _ = overlap_area(&a, &b, pose);
        let _ = cast(&a, odd.pose(), odd.vector(), &b, pose);
        let mut found = Vec::new();
        contacts(&a, &b, pose, margin, &mut found);
        let _ = contacts_and_gap(&a, &b, pose, margin, &mut found);
        for one in hulls(&a) {
            for two in hulls(&b) {
                if one.is_half_plane() || two.is_half_plane() {
                    continue;
                }
                let _ = (distance(&one, &two, pose), minimum_push(&one, &two, pose));
                let _ = (
                    separating_axis(&one, &two, pose),
                    collide_within(&one, &two, pose, margin),
                );
            }
        }
        let (one, two) = (ConvexPolygon::square(1.0), ConvexPolygon::regular(7, 0.5));
        let (one, two) = (one.expect("a square"), two.expect("regular"));
        let _ = (collide(&one, &two, pose), intersection(&one, &two, pose));
        let star = Polygon::star(5, 1.0, 0.4).expect("a star");
        let _ = vertex_edge_contacts(&star, &star, pose);
        let mut tree = ShapeTree::new();
        tree.insert(a, Pose::at(vec2(0.5, 0.0)));
        let id = tree.insert(b.clone(), odd.pose());
        tree.insert(b.clone(), Pose::IDENTITY);
        let _ = tree.set_pose(id, pose);
        let (origin, way) = (odd.vector(), odd.vector());
        let _ = (
            tree.cast_ray(origin, way, margin),
            tree.cast_shape(&b, pose, way),
        );
        let _ = (
            tree.closest_point(origin, margin),
            tree.closest_shape(&b, pose, margin),
        );
        let _ = (
            tree.shapes_at(origin),
            tree.shapes_touching(&b, pose),
            tree.remove(id),
        );
    }
}
