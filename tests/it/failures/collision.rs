//! What went wrong in other engines' collision detection, by the number of the list.

use carom_collision::{
    Motion, TimeOfImpact, cast, contacts, overlap_area, shape_distance, time_of_impact,
};
use carom_geometry::{Circle, Compound, ConvexPolygon, Polygon, Segment, Shape};
use carom_math::{Pose, Rot, SimTime, Vec2, vec2};
use carom_tests::scenes::hollow;
use core::f64::consts::PI;

fn ball(radius: f64) -> Shape {
    Circle::new(radius).expect("a disc").into()
}

fn rectangle(width: f64, height: f64) -> Shape {
    ConvexPolygon::rectangle(width, height)
        .expect("above zero")
        .into()
}

fn wall(a: Vec2, b: Vec2) -> Shape {
    Segment::new(a, b).expect("a length").into()
}

fn turning(centre: Vec2, angle: f64, velocity: Vec2, spin: f64) -> Motion {
    Motion {
        velocity,
        spin,
        rotation: Rot::from_angle(angle),
        ..Motion::resting(centre)
    }
}

/// Gap of two convex shapes at `time`, by brute force over the corners of both.
fn gap_at(a: &Shape, motion_a: &Motion, b: &Shape, motion_b: &Motion, time: f64) -> f64 {
    let at = |shape: &Shape, motion: &Motion| -> Vec<Vec2> {
        let pose = motion.pose_at(SimTime::from_secs(time));
        shape.vertices().iter().map(|v| pose.point(*v)).collect()
    };
    let (p, q) = (at(a, motion_a), at(b, motion_b));
    let beyond = |own: &[Vec2], other: &[Vec2]| {
        let edges = own.iter().zip(own.iter().cycle().skip(1));
        edges
            .map(|(from, to)| {
                let along = (*to - *from).normalize();
                let out = vec2(along.y, -along.x);
                let heights = other.iter().map(|v| out.dot(*v - *from));
                heights.fold(f64::INFINITY, f64::min)
            })
            .fold(f64::NEG_INFINITY, f64::max)
    };
    beyond(&p, &q).max(beyond(&q, &p))
}

/// erincatto/box2d#115: a false hit with angles near 513 rad, and an endless loop without wrapping.
#[test]
fn case_08_a_long_box_and_a_box_at_angles_of_513_radians() {
    let (long, small) = (rectangle(50.0, 10.0), rectangle(5.0, 5.0));
    let still = turning(vec2(24.0, -60.0), 2.95, Vec2::ZERO, 0.0);
    let (from, to) = (vec2(53.474_274, -50.252_514), vec2(54.595_478, -51.083_473));
    let (first, last) = (513.366_76, 513.627_81);
    let answers = [0.0, 162.0 * PI].map(|wrapped| {
        let moving = turning(from, first - wrapped, to - from, last - first);
        let sampled = (0..=4000)
            .map(|i| gap_at(&long, &still, &small, &moving, f64::from(i) / 4000.0))
            .fold(f64::INFINITY, f64::min);
        let answer = time_of_impact(&long, &still, &small, &moving, 1.0);
        assert_eq!(
            answer == TimeOfImpact::Clear,
            sampled > 0.0,
            "{answer:?}, gap {sampled}"
        );
        answer
    });
    assert_eq!(answers[0], answers[1]);
    // A little lower it does hit; the wrapped angle, rounded by 1e-13, gives the same instant.
    let instants = [0.0, 162.0 * PI].map(|wrapped| {
        let moving = turning(
            from,
            first - wrapped,
            to - from - vec2(4.0, 8.0),
            last - first,
        );
        match time_of_impact(&long, &still, &small, &moving, 1.0) {
            TimeOfImpact::Hit(hit) => {
                assert!(gap_at(&long, &still, &small, &moving, hit.time).abs() < 1e-12);
                hit.time
            }
            other => panic!("{other:?}"),
        }
    });
    assert!((instants[0] - instants[1]).abs() < 1e-12, "{instants:?}");
}

/// erincatto/box2d#139, rustgd/collision-rs#111: continuous solvers that looped for ever.
///
/// The search has a budget of steps; here it must not be needed: every pair is decided.
#[test]
fn case_09_fast_spins_and_near_misses_end_with_an_answer() {
    let plate = rectangle(1.0, 0.01);
    for k in 0..200 {
        let k = f64::from(k);
        let spin = 5.0 * k;
        // Turns in place, 1e-9 m outside or inside the reach of a resting plate's corner.
        let reach = 0.5 * (1.0_f64 + 1e-4).sqrt();
        for (gap, hits) in [(1e-9, false), (-1e-9, true)] {
            let still = Motion::resting(vec2(0.5 + reach + gap, 0.0));
            let turns = turning(Vec2::ZERO, 1.0, Vec2::ZERO, spin);
            let answer = time_of_impact(&plate, &turns, &plate, &still, 1.0);
            // Slower than 2 rad/s it does not get there.
            let gets_there = spin * 1.0 > 2.2;
            let unresolved = matches!(answer, TimeOfImpact::Unresolved { .. });
            assert!(!unresolved, "spin {spin}, gap {gap:e}");
            if gets_there {
                assert_eq!(
                    matches!(answer, TimeOfImpact::Hit(_)),
                    hits,
                    "spin {spin}, gap {gap:e}: {answer:?}"
                );
            }
        }
    }
}

/// dimforge/rapier#984, liabru/matter-js#5 and #309: bullets that miss each other.
#[test]
fn case_20_two_small_discs_meet_at_800_metres_a_second() {
    let disc = ball(0.01);
    for k in 0..1000 {
        let apart = 16.0 + f64::from(k) / 64.0;
        let left = turning(vec2(-apart, 0.0), 0.0, vec2(800.0, 0.0), 0.0);
        let right = turning(vec2(apart, 0.0), 0.0, vec2(-800.0, 0.0), 0.0);
        let TimeOfImpact::Hit(hit) = time_of_impact(&disc, &left, &disc, &right, 1.0) else {
            panic!("missed from {apart} m");
        };
        assert!((hit.time - (2.0 * apart - 0.02) / 1600.0).abs() < 1e-15);
        assert_eq!(hit.normal, Vec2::X);
    }
    // A box between two that abut it: in touch with both, and free to rise.
    let box_ = rectangle(1.0, 1.0);
    for (velocity, stays) in [(Vec2::Y, true), (-Vec2::Y, true), (Vec2::X, false)] {
        let moving = turning(Vec2::ZERO, 0.0, velocity, 0.0);
        let right = Motion::resting(vec2(1.0, 0.0));
        let answer = time_of_impact(&box_, &moving, &box_, &right, 0.25);
        assert_eq!(
            answer == TimeOfImpact::Clear,
            stays,
            "{velocity}: {answer:?}"
        );
    }
}

/// dimforge/parry#429: a linear cast up to 139 mm short on a box of 500 m.
#[test]
fn case_22_ball_cast_at_large_boxes() {
    for half in [5.0, 50.0, 500.0] {
        let large = rectangle(2.0 * half, 2.0 * half);
        for k in 0..100 {
            let across = half * (f64::from(k) / 64.0 - 0.75) * 0.9;
            let start = Pose::at(vec2(-half - 8.5, across));
            let hit = cast(&ball(0.5), start, vec2(16.0, 0.0), &large, Pose::IDENTITY)
                .expect("in the way");
            assert!((hit.fraction * 16.0 - 8.0).abs() < 1e-12);
            // Turned by any angle with its target.
            let turn = Pose::new(Vec2::ZERO, Rot::from_angle(f64::from(k)));
            let start = Pose::at(turn.point(start.position));
            let way = turn.vector(vec2(16.0, 0.0));
            let hit = cast(&ball(0.5), start, way, &large, turn).expect("in the way");
            assert!((hit.fraction * 16.0 - 8.0).abs() < 1e-12);
        }
    }
}

/// dimforge/parry#180: a square that fell through a segment for some starts.
#[test]
fn case_23_a_square_meets_a_segment_from_every_start() {
    let square = rectangle(2.0, 2.0);
    let floor = wall(vec2(-100.0, 0.0), vec2(100.0, 0.0));
    let velocity = vec2(0.008_138_5, -0.999_966);
    for k in 0..2000 {
        let start = vec2(15.689_465, 54.007_09) + vec2(1e-6, 1e-6) * f64::from(k);
        let way = velocity * 100.0;
        let hit = cast(&square, Pose::at(start), way, &floor, Pose::IDENTITY).expect("in the way");
        assert!((hit.fraction * 99.9966 - (start.y - 1.0)).abs() < 1e-12);
        let falls = turning(start, 0.0, velocity, 0.0);
        let still = Motion::resting(Vec2::ZERO);
        let TimeOfImpact::Hit(hit) = time_of_impact(&square, &falls, &floor, &still, 100.0) else {
            panic!("missed from {start}");
        };
        assert!((hit.time * 0.999_966 - (start.y - 1.0)).abs() < 1e-12);
    }
}

/// dimforge/parry#176, #378: a turning cast where closest points failed; shapes exactly at the
/// distance up to which contacts are asked for.
#[test]
fn case_24_witness_points_at_the_margin_and_in_turning_casts() {
    let (a, b) = (rectangle(2.0, 2.0), rectangle(1.0, 1.0));
    for k in 0..720 {
        let turn = Rot::from_degrees(f64::from(k) * 0.5);
        let low = b.aabb(Pose::new(Vec2::ZERO, turn)).min.y;
        for gap in [0.0, 1e-12, 0.01, 0.25] {
            let pose = Pose::new(vec2(0.125, 1.0 - low + gap), turn);
            let way = shape_distance(&a, &b, pose);
            assert!(
                (way.distance - gap).abs() < 1e-12,
                "{} of {gap}",
                way.distance
            );
            assert!(((way.point_b - way.point_a).length() - way.distance).abs() < 1e-12);
            assert!((way.point_a.y - 1.0).abs() < 1e-12);
            let mut found = Vec::new();
            contacts(&a, &b, pose, gap + 1e-12, &mut found);
            assert!(!found.is_empty(), "nothing within {gap} at {k}");
            for p in &found[0].manifold.points {
                assert!(p.point.is_finite() && p.separation <= gap + 1e-12);
            }
            let spinning = turning(vec2(0.125, 4.0), 0.01 * f64::from(k), vec2(0.0, -2.0), 3.0);
            let still = Motion::resting(Vec2::ZERO);
            let TimeOfImpact::Hit(hit) = time_of_impact(&a, &still, &b, &spinning, 2.0) else {
                panic!("missed at {k}");
            };
            for p in &hit.points {
                assert!((p.y - 1.0).abs() < 1e-12, "{p} at {k}");
            }
        }
    }
}

/// dimforge/parry#19: a cast at a turned polyline took the one that was not turned.
#[test]
fn case_25_a_cast_at_a_turned_wall_is_a_turned_cast() {
    let chain = |walls: usize, turn: Rot, by: Vec2| -> (Shape, Pose) {
        let points = [vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(-1.5, 0.0)];
        let parts = points
            .windows(2)
            .take(walls)
            .map(|ends| (wall(ends[0], ends[1]), Pose::IDENTITY));
        (
            Compound::new(parts).expect("walls").into(),
            Pose::new(by, turn),
        )
    };
    let (walls, turned) = chain(1, Rot::from_degrees(-90.0), Vec2::ZERO);
    let hit = cast(&ball(0.5), Pose::IDENTITY, vec2(1.0, 0.0), &walls, turned).expect("beside it");
    assert_eq!(hit.fraction, 0.5);
    let up = cast(&ball(0.5), Pose::IDENTITY, vec2(0.0, 1.0), &walls, turned);
    assert_eq!(up, None);
    // Turned and moved copies agree.
    for k in 0..200 {
        let by = vec2(f64::from(k), -3.0);
        let turn = Rot::from_angle(0.1 * f64::from(k));
        let (walls, pose) = chain(2, turn, by);
        let start = Pose::new(by + turn * vec2(0.0, -2.0), turn);
        let hit = cast(&ball(0.5), start, turn * vec2(0.0, 4.0), &walls, pose).expect("above it");
        assert!((hit.fraction - 0.625).abs() < 1e-14, "{}", hit.fraction);
        assert!((hit.normal - turn * Vec2::Y).length() < 1e-14);
    }
}

/// dimforge/parry#34, #148: the centre of a ball exactly on a corner or an edge.
#[test]
fn case_26_a_ball_centred_on_a_corner_or_an_edge() {
    let square = rectangle(2.0, 2.0);
    let l: Shape = Polygon::new([
        vec2(-1.0, -1.0),
        vec2(1.0, -1.0),
        vec2(1.0, 0.0),
        vec2(0.0, 0.0),
        vec2(0.0, 1.0),
        vec2(-1.0, 1.0),
    ])
    .expect("an L")
    .into();
    for shape in [&square, &l] {
        let corners = shape.vertices();
        for (i, p) in corners.iter().enumerate() {
            let q = corners[(i + 1) % corners.len()];
            for place in [*p, 0.5 * (*p + q), *p + (q - *p) * 0.25] {
                let mut found = Vec::new();
                contacts(shape, &ball(0.25), Pose::at(place), 0.0, &mut found);
                assert!(!found.is_empty(), "nothing at {place}");
                for contact in &found {
                    assert!((contact.manifold.normal.length() - 1.0).abs() < 1e-15);
                    assert!(contact.manifold.points.iter().all(|p| p.point.is_finite()));
                }
                let depths = found.iter().filter_map(|c| c.manifold.deepest());
                let deepest = depths.fold(f64::INFINITY, f64::min);
                assert!((deepest + 0.25).abs() < 1e-15, "{place}: {found:?}");
                assert_eq!(
                    shape_distance(shape, &ball(0.25), Pose::at(place)).distance,
                    0.0
                );
            }
        }
    }
}

/// dimforge/parry#407, avianphysics/avian#84, appsinacup/godot-rapier-physics#489: answers that
/// depend on where the scene lies.
#[test]
fn case_27_queries_are_the_same_bits_under_exact_shifts() {
    let l: Shape = Polygon::new([
        vec2(-1.0, -1.0),
        vec2(2.0, -1.0),
        vec2(2.0, 0.0),
        vec2(0.0, 0.0),
        vec2(0.0, 2.0),
        vec2(-1.0, 2.0),
    ])
    .expect("an L")
    .into();
    let bodies = [ball(0.375), rectangle(0.5, 0.75), l.clone()];
    for (k, body) in bodies.iter().enumerate() {
        for far in [20, 30] {
            let shift = vec2(f64::from(1 << far), -f64::from(1 << far));
            for i in 0..64 {
                // Places on a grid of 2^-5 m: a shift by 2^30 m rounds nothing.
                let place = vec2(f64::from(i % 8) * 0.5 - 1.75, f64::from(i / 8) * 0.5 - 1.75);
                let turn = Rot::from_angle(f64::from(i) + 0.1);
                let (a, b) = (Pose::IDENTITY, Pose::new(place, turn));
                let there = |pose: Pose| Pose::new(pose.position + shift, pose.rotation);
                let seen = (b.seen_from(a), there(b).seen_from(there(a)));
                assert_eq!(seen.0, seen.1);
                assert_eq!(
                    overlap_area(&l, body, seen.0).to_bits(),
                    overlap_area(&l, body, seen.1).to_bits()
                );
                let way = vec2(3.0, 1.0);
                let here = cast(body, b, way, &l, a);
                let away = cast(body, there(b), way, &l, there(a));
                assert_eq!(
                    here.map(|h| (h.fraction, h.normal)),
                    away.map(|h| (h.fraction, h.normal)),
                    "{k} {i}"
                );
                let moving = |pose: Pose| turning(pose.position, f64::from(i) + 0.1, way, 2.0);
                let (near, off) = (Motion::resting(Vec2::ZERO), Motion::resting(shift));
                let here = time_of_impact(&l, &near, body, &moving(b), 1.0);
                let away = time_of_impact(&l, &off, body, &moving(there(b)), 1.0);
                match (here, away) {
                    (TimeOfImpact::Hit(x), TimeOfImpact::Hit(y)) => {
                        assert_eq!(
                            (x.time, x.normal, x.gap_rate),
                            (y.time, y.normal, y.gap_rate)
                        );
                    }
                    (TimeOfImpact::Touching(x), TimeOfImpact::Touching(y)) => {
                        assert_eq!(x.normal, y.normal);
                    }
                    (x, y) => assert_eq!(x, y),
                }
            }
        }
    }
}

/// liabru/matter-js#1049: a triangle with a repeated vertex did not collide.
#[test]
fn case_31_a_repeated_vertex_changes_no_answer() {
    let corners = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.25, 1.0)];
    let plain: Shape = Polygon::new(corners).expect("a triangle").into();
    let repeated: Shape =
        Polygon::new([corners[0], corners[1], corners[1], corners[2], corners[2]])
            .expect("a triangle")
            .into();
    let floor = rectangle(8.0, 2.0);
    for i in 0..100 {
        let pose = Pose::new(
            vec2(0.02 * f64::from(i), 0.9),
            Rot::from_angle(0.3 * f64::from(i)),
        );
        let of = |shape: &Shape| {
            let mut found = Vec::new();
            contacts(&floor, shape, pose, 0.1, &mut found);
            (found, shape_distance(&floor, shape, pose))
        };
        assert_eq!(of(&plain), of(&repeated));
        let falls = turning(vec2(0.0, 4.0), f64::from(i), vec2(0.0, -3.0), 2.0);
        let still = Motion::resting(Vec2::ZERO);
        let hit = |shape: &Shape| time_of_impact(&floor, &still, shape, &falls, 2.0);
        assert_eq!(hit(&plain), hit(&repeated));
        assert!(matches!(hit(&plain), TimeOfImpact::Hit(_)));
    }
}

/// liabru/matter-js#842, #1299: a body in the hollow of another was pushed, or went through its wall.
#[test]
fn case_32_a_body_in_a_turning_hollow_is_free_until_it_meets_a_wall() {
    let c: Shape = hollow().into();
    let body = ball(0.6);
    for i in 0..360 {
        let turn = Rot::from_degrees(f64::from(i));
        let place = turn * vec2(0.85, 0.0);
        let pose =
            Pose::at(place).seen_from(Pose::new(Vec2::ZERO, Rot::from_degrees(2.0 * f64::from(i))));
        let mut found = Vec::new();
        contacts(&c, &body, pose, 0.0, &mut found);
        let inside = pose.position.abs().max_element() <= 0.9 - 1e-12;
        assert!(!inside || found.is_empty(), "pushed in the hollow at {i}");
        assert!(!inside || shape_distance(&c, &body, pose).distance > 0.0);
    }
    // At 50 rad/s a wall strikes the ball at the instant its inner side, 1.5 m out, is 0.6 m from the
    // ball's centre, 1 m out: when the sine of the angle is 0.9.
    let meets = PI * 0.5 - carom_math::trig::acos(0.9);
    for i in 0..50 {
        let angle = 0.5 + 0.01 * f64::from(i);
        let spins = turning(Vec2::ZERO, angle, Vec2::ZERO, 50.0);
        let still = Motion::resting(vec2(1.0, 0.0));
        let TimeOfImpact::Hit(hit) = time_of_impact(&c, &spins, &body, &still, 0.1) else {
            panic!("went through at {angle}");
        };
        assert!(
            (angle + 50.0 * hit.time - meets).abs() < 1e-13,
            "{} at {angle}",
            hit.time
        );
    }
}

/// Own case: 1e-12 m between parallel edges, both turning slowly.
#[test]
fn case_48_a_picometre_between_parallel_edges_is_neither_missed_nor_invented() {
    let box_ = rectangle(1.0, 1.0);
    let gap = 1e-12;
    let lower = Motion::resting(Vec2::ZERO);
    for k in 1..=40 {
        let spin = 1e-6 * f64::from(k);
        // Both turn alike about the lower one's centre: the gap stays what it is.
        let upper = turning(vec2(0.0, 1.0 + gap), 0.0, Vec2::ZERO, 0.0);
        assert_eq!(
            time_of_impact(&box_, &lower, &box_, &upper, 10.0),
            TimeOfImpact::Clear
        );
        // Only the upper one turns: its corner, half a metre out, comes down by spin/2 a second.
        let turns = Motion { spin, ..upper };
        let TimeOfImpact::Hit(hit) = time_of_impact(&box_, &lower, &box_, &turns, 10.0) else {
            panic!("missed at {spin}");
        };
        let want = 2.0 * gap / spin;
        assert!(
            (hit.time - want).abs() < 1e-3 * want + 4e-15 / spin,
            "{} against {want}",
            hit.time
        );
        // Leaving faster than it turns down: never.
        let leaves = Motion {
            velocity: vec2(0.0, spin),
            ..turns
        };
        assert_eq!(
            time_of_impact(&box_, &lower, &box_, &leaves, 0.5),
            TimeOfImpact::Clear
        );
        // Both turn the same way at the same speed about their own centres: the edges stay parallel
        // and come closer by 1 − cos, below a picometre for 1e-6 s at these speeds.
        let both = [Motion { spin, ..lower }, turns];
        let short = 0.5e-6 / spin.max(1e-6);
        let answer = time_of_impact(&box_, &both[0], &box_, &both[1], short.min(0.5));
        assert!(!matches!(answer, TimeOfImpact::Unresolved { .. }));
    }
}
