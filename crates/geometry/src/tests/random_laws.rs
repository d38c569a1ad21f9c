use carom_math::{Vec2, orient2d, vec2};
use proptest::prelude::*;

use crate::{Aabb, ConvexPolygon, Polygon};

/// Numbers from 0 to 1 by SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, 2014).
pub(super) fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn assert_strictly_convex(polygon: &ConvexPolygon, sides: usize) {
    let v = polygon.vertices();
    assert_eq!(v.len(), sides);
    for i in 0..sides {
        assert!(
            orient2d(v[i], v[(i + 1) % sides], v[(i + 2) % sides]) > 0.0,
            "corner {i} of {v:?}"
        );
    }
}

proptest! {
    #[test]
    fn random_polygons_are_what_their_types_say(seed in any::<u64>(), count in 3..=1000_usize) {
        let mut next = numbers(seed);
        let stone = ConvexPolygon::random(count, 2.0, &mut next).expect("convex");
        assert_strictly_convex(&stone, count);
        let stone = ConvexPolygon::random_in_box(count, 3.0, 0.5, &mut next).expect("convex");
        assert_strictly_convex(&stone, count);
        let bounds = Aabb::from_points(stone.vertices().iter().copied());
        prop_assert_eq!(bounds, Aabb::new(vec2(-1.5, -0.25), vec2(1.5, 0.25)), "it fills its box");

        let rock = Polygon::random_star(count, 0.5, 2.0, &mut next).expect("simple");
        prop_assert_eq!(rock.vertices().len(), count);
        prop_assert!(rock.vertices().iter().all(|v| (0.49..2.01).contains(&v.length())));
        let n = rock.vertices().len();
        let seen = |i: usize| orient2d(Vec2::ZERO, rock.vertices()[i], rock.vertices()[(i + 1) % n]);
        prop_assert!((0..n).all(|i| seen(i) > 0.0), "all corners are seen from the origin");

        let outline = Polygon::random(count, 3.0, 0.5, &mut next).expect("simple");
        prop_assert_eq!(outline.vertices().len(), count);
        let bounds = Aabb::from_points(outline.vertices().iter().copied());
        prop_assert!(Aabb::new(vec2(-1.5, -0.25), vec2(1.5, 0.25)).contains(bounds));
    }

    #[test]
    fn the_same_numbers_make_the_same_polygon(seed in any::<u64>(), count in 3..50_usize) {
        let outline = |seed: u64| Polygon::random(count, 1.0, 1.0, &mut numbers(seed)).expect("simple");
        prop_assert_eq!(outline(seed), outline(seed));
        prop_assert_ne!(outline(seed), outline(seed.wrapping_add(1)));
        let stone = |seed: u64| ConvexPolygon::random_in_box(count, 1.0, 1.0, &mut numbers(seed)).expect("convex");
        prop_assert_eq!(stone(seed), stone(seed));
    }

    #[test]
    fn an_ellipse_keeps_its_bound(a in 0.01..100.0_f64, b in 0.01..100.0_f64, digits in 1..7_i32) {
        let sagitta = (0..digits).fold(a.max(b), |bound, _| bound * 0.1);
        let ellipse = ConvexPolygon::ellipse(a, b, sagitta).expect("convex");
        let v = ellipse.vertices();
        prop_assert!(v.len().is_multiple_of(4));
        let mut worst = 0.0_f64;
        for i in 0..v.len() {
            // The ellipse is farthest from a chord half way between its corners' anomalies.
            let middle = (v[i] + v[(i + 1) % v.len()]) * 0.5;
            let on_circle = (middle / vec2(a, b)).normalize();
            worst = worst.max(ellipse.normals()[i].dot(on_circle * vec2(a, b) - middle));
        }
        prop_assert!(worst <= sagitta * (1.0 + 1e-12) + 1e-15 * a.max(b), "{worst} above {sagitta}");
        // Not many more than needed: four corners fewer break the bound.
        let fewer = v.len() - 4;
        if fewer >= 4 {
            let step = core::f64::consts::PI / fewer as f64;
            let (sin, _) = carom_math::trig::sin_cos(0.5 * step);
            prop_assert!(a.max(b) * 2.0 * sin * sin > sagitta);
        }
    }
}

#[test]
fn no_numbers_make_a_bad_polygon() {
    for (name, given) in [
        ("always 0", vec![0.0]),
        ("always 1", vec![1.0]),
        ("nothing", vec![f64::NAN]),
        ("beyond", vec![-3.0, 7.0, f64::INFINITY]),
        ("two numbers", vec![0.25, 0.75]),
        ("three numbers", vec![0.1, 0.9, 0.5]),
    ] {
        for count in [3, 4, 5, 40, 1000] {
            let mut from = given.iter().copied().cycle();
            let mut next = || from.next().unwrap_or(0.0);
            let stone = ConvexPolygon::random_in_box(count, 2.0, 1.0, &mut next).expect(name);
            assert_eq!(stone.vertices().len(), count, "{name}");
            let outline = Polygon::random(count, 2.0, 1.0, &mut next).expect(name);
            assert_eq!(outline.vertices().len(), count, "{name}");
            let rock = Polygon::random_star(count, 1.0, 2.0, &mut next).expect(name);
            assert_eq!(rock.vertices().len(), count, "{name}");
        }
    }
}
