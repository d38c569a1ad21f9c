//! The search for pairs in even motion against the general one, which is its slow twin.

use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Rot, Vec2, trig, vec2};
use fearless_simd::{Level, dispatch};
use proptest::prelude::*;

use super::approach::{Approach, Axis};
use super::even::Found;
use super::turns::sines_and_cosines;
use super::{Impact, TimeOfImpact, even, search};
use crate::{Convex, Motion};

/// All widths that this machine has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let all = [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let all = [Some(best)];
    all.into_iter().flatten().collect()
}

fn polygon() -> impl Strategy<Value = ConvexPolygon> {
    let corner = (0.0..6.2_f64, 0.3..1.0_f64);
    prop::collection::vec(corner, 3..9).prop_filter_map("a polygon", |corners| {
        let points: Vec<Vec2> = corners
            .iter()
            .map(|(angle, radius)| Rot::from_angle(*angle) * vec2(*radius, 0.0))
            .collect();
        ConvexPolygon::hull(points).ok()
    })
}

fn motion() -> impl Strategy<Value = Motion> {
    let (place, speed) = (-3.0..3.0_f64, -8.0..8.0_f64);
    (
        place.clone(),
        place,
        speed.clone(),
        speed,
        0.0..6.0_f64,
        -20.0..20.0_f64,
    )
        .prop_map(|(x, y, vx, vy, angle, spin)| Motion {
            velocity: vec2(vx, vy),
            rotation: Rot::from_angle(angle),
            spin,
            ..Motion::resting(vec2(x, y))
        })
}

/// Both searches say the same; whether the fast one said anything.
fn agree(
    (a, b): (&impl Convex, &impl Convex),
    (one, two): (&Motion, &Motion),
    horizon: f64,
    last: Option<Axis>,
) -> (bool, TimeOfImpact) {
    let (a, b) = (a.hull(), b.hull());
    let at = one.start.max(two.start);
    let approach = Approach::new(a, one, b, two);
    let slow = search::first_contact(&approach, horizon, last);
    let all: Vec<Option<Found>> = levels()
        .into_iter()
        .map(|level| even::first_contact(level, (&a, &b), (one, two), (at, horizon), last))
        .collect();
    assert!(all.windows(2).all(|pair| pair[0] == pair[1]), "{all:?}");
    let Some(fast) = all[0] else {
        return (false, slow);
    };
    match (TimeOfImpact::from(fast), &slow) {
        (TimeOfImpact::Clear, TimeOfImpact::Clear) => {}
        (TimeOfImpact::Hit(fast), TimeOfImpact::Hit(slow)) => {
            // What both may be off: roundings of lengths over the speed of the approach.
            let lengths = 1e-14 * (10.0 + 50.0 * slow.time);
            let off = (fast.time - slow.time).abs() * slow.gap_rate.abs();
            assert!(off <= lengths, "{fast:?} and {slow:?}");
            assert_eq!(fast.features, slow.features);
            let near = lengths * (1.0 + 50.0 / slow.gap_rate.abs());
            assert_eq!((fast.points.len(), slow.points.len()), (1, 1));
            assert!((fast.normal - slow.normal).length() <= near);
            assert!((fast.points[0] - slow.points[0]).length() <= near);
            assert!((fast.gap_rate - slow.gap_rate).abs() <= 100.0 * near);
        }
        (fast, slow) => panic!("{fast:?} and {slow:?}"),
    }
    (true, slow)
}

/// Both at an impact, and parting from there.
fn bounced((one, two): (&Motion, &Motion), hit: &Impact) -> (Motion, Motion) {
    let at = one.start.max(two.start) + hit.time;
    let (mut one, mut two) = (one.rebased(at), two.rebased(at));
    let push = hit.normal * (-1.2 * hit.gap_rate);
    one.velocity -= push;
    two.velocity += push;
    (one, two)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn even_motion_is_searched_as_any_other(
        a in polygon(), b in polygon(), one in motion(), two in motion(), horizon in 0.05..1.0_f64,
    ) {
        // The one has been on its way for a while.
        let two = two.rebased(two.start + 0.5 * horizon);
        let (_, first) = agree((&a, &b), (&one, &two), horizon, None);
        // They bounce there and part, and may meet again.
        let TimeOfImpact::Hit(hit) = first else { return Ok(()) };
        let (one, two) = bounced((&one, &two), &hit);
        agree((&a, &b), (&one, &two), horizon, Axis::of(hit.features[0].feature));
    }

    #[test]
    fn discs_meet_polygons_as_anything_does(
        a in polygon(), radius in 0.1..1.0_f64, first: bool, one in motion(), two in motion(), horizon in 0.05..1.0_f64,
    ) {
        let disc = Circle::new(radius).unwrap();
        let look = |one: &Motion, two: &Motion, last: Option<Axis>| if first {
            agree((&disc, &a), (one, two), horizon, last)
        } else {
            agree((&a, &disc), (one, two), horizon, last)
        };
        let (_, hit) = look(&one, &two, None);
        let TimeOfImpact::Hit(hit) = hit else { return Ok(()) };
        let (one, two) = bounced((&one, &two), &hit);
        look(&one, &two, Axis::of(hit.features[0].feature));
    }

    #[test]
    fn discs_meet_discs_as_anything_does(
        radii in (0.1..1.0_f64, 0.1..1.0_f64), one in motion(), two in motion(), horizon in 0.05..1.0_f64,
    ) {
        let (a, b) = (Circle::new(radii.0).unwrap(), Circle::new(radii.1).unwrap());
        // The one has been on its way for a while.
        let two = two.rebased(two.start + 0.5 * horizon);
        let (_, hit) = agree((&a, &b), (&one, &two), horizon, None);
        let TimeOfImpact::Hit(hit) = hit else { return Ok(()) };
        let (one, two) = bounced((&one, &two), &hit);
        let (fast, next) = agree((&a, &b), (&one, &two), horizon, Axis::of(hit.features[0].feature));
        prop_assert!(fast && next == TimeOfImpact::Clear);
    }

    #[test]
    fn turns_are_right_to_two_units_of_one(x in -1e5..1e5_f64, y in -9.0..9.0_f64, shrink in 0..40_u32) {
        let angles = [x / (1_u64 << shrink) as f64, y];
        let all: Vec<[f64; 4]> = levels()
            .into_iter()
            .map(|level| dispatch!(level, simd => sines_and_cosines(simd, angles)))
            .collect();
        prop_assert!(all.windows(2).all(|pair| pair[0] == pair[1]));
        for k in [0, 1] {
            let (sine, cosine) = trig::sin_cos(angles[k]);
            let (off_sine, off_cosine) = ((all[0][k] - sine).abs(), (all[0][k + 2] - cosine).abs());
            prop_assert!(off_sine <= 2e-16 && off_cosine <= 2e-16, "{:e}", angles[k]);
            prop_assert!(off_sine <= 4e-16 * sine.abs(), "{:e}", angles[k]);
        }
    }
}

/// Most pairs of a gas are for the fast search: else nothing is won.
#[test]
fn the_general_search_is_rarely_asked() {
    let polygon = ConvexPolygon::regular(5, 0.5).expect("a polygon");
    let disc = Circle::new(0.5).expect("a disc");
    let (mut asked, mut hits) = (0, 0);
    for i in 0..1000 {
        let angle = 0.618 * f64::from(i);
        let one = Motion {
            spin: 3.0,
            ..Motion::resting(Vec2::ZERO)
        };
        let two = Motion {
            velocity: vec2(-5.0, 0.3),
            rotation: Rot::from_angle(angle),
            spin: -11.0,
            ..Motion::resting(vec2(2.0, 0.2))
        };
        for (fast, found) in [
            agree((&polygon, &polygon), (&one, &two), 1.0, None),
            agree((&polygon, &disc), (&one, &two), 1.0, None),
        ] {
            asked += i32::from(!fast);
            hits += i32::from(matches!(found, TimeOfImpact::Hit(_)));
        }
    }
    assert!(asked <= 20 && hits > 1800, "{asked} of {hits}");
}

/// A disc on a face that turns: it opens at 1 µm/s and comes back as slowly 0.2 µs later, deeper than now by rounding. The last
/// Newton step led to before the search began.
#[test]
fn what_comes_back_slowly_is_not_met_before_the_search_begins() {
    let (square, disc) = (
        ConvexPolygon::square(2.0).unwrap(),
        Circle::new(0.5).unwrap(),
    );
    let one = Motion {
        spin: 10.0,
        ..Motion::resting(Vec2::ZERO)
    };
    let mut met = 0;
    for sunk in [1e-14, 1e-13, 3e-13, 4.5e-13] {
        for opening in [1e-7, 1e-6, 1e-5] {
            let two = Motion {
                velocity: vec2(opening, -1.0),
                ..Motion::resting(vec2(1.5 - sunk, 0.0))
            };
            let face = Axis::Edge { owner: 0, edge: 1 };
            let hulls = (&square.hull(), &disc.hull());
            let span = (one.start, 1.0);
            for level in levels() {
                let found = even::first_contact(level, hulls, (&one, &two), span, Some(face));
                if let Some(Found::Hit { time, .. }) = found {
                    assert!(time > 0.0, "{time:e} s, sunk by {sunk:e} m");
                    met += 1;
                }
            }
        }
    }
    assert!(met > 0, "no case of it");
}
