//! From when to when two things are near enough to meet: bounding circles and boxes along motions.

use carom_geometry::Aabb;
use carom_math::{SimTime, Vec2};

use super::free_fall_frame::Track;
use crate::store::state::BodyState;

/// Reaches are taken this much larger, so that no rounding at a rim loses a pair, and the search for the
/// time of impact begins before it, where the gap is above its tolerance.
const ROOM: f64 = 1.0 + 1.0 / 1024.0;

/// Circles that accelerate against each other count as met this much sooner, as a factor: a bound on when they meet is
/// short of it by a part, again and again, and two that pass each other nearly in touch would be looked at for ever.
const MET: f64 = 1.0 + 1.0 / 1024.0;

/// When circles overlap, in s from now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    /// Not before this; 0 if they overlap now.
    pub(crate) from: f64,
    /// Not after this; infinite where only the beginning is known.
    pub(crate) to: f64,
}

/// When two circles overlap with centres `d` apart (m), which changes by `v` (m/s) and `a`
/// (m/s²); `reach` is the sum of their radii (m). `None`: never.
///
/// Without relative acceleration both times are exact roots; with it `from` is a bound:
/// the centres approach by at most `|v| t + |a| t²/2`.
pub(crate) fn of_circles(d: Vec2, v: Vec2, a: Vec2, reach: f64) -> Option<Window> {
    if a == Vec2::ZERO {
        return of_even_circles(d, v, reach);
    }
    let (reach, apart) = (reach * ROOM, d.length());
    let from = if apart <= reach * MET {
        0.0
    } else {
        let gap = apart - reach;
        let (speed, pull) = (v.length(), a.length());
        2.0 * gap / (speed + (speed * speed + 2.0 * pull * gap).sqrt())
    };
    let to = f64::INFINITY;
    Some(Window { from, to })
}

/// [`of_circles`] without relative acceleration.
fn of_even_circles(d: Vec2, v: Vec2, reach: f64) -> Option<Window> {
    let reach = reach * ROOM;
    let outside = d.length_squared() - reach * reach;
    let (closing, speed) = (-d.dot(v), v.length_squared());
    let discriminant = closing * closing - speed * outside;
    if outside <= 0.0 {
        let to = if speed > 0.0 {
            (closing + discriminant.max(0.0).sqrt()) / speed
        } else {
            f64::INFINITY
        };
        return Some(Window {
            from: 0.0,
            to: to.max(0.0),
        });
    }
    if closing <= 0.0 || discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    Some(Window {
        from: outside / (closing + root),
        to: (closing + root) / speed,
    })
}

/// When a circle of radius `reach` about `at`, which moves by `v` and `a`, may first overlap a box
/// that rests, in s: a lower bound, 0 if it does now, infinite if it never does.
pub(crate) fn from_box(at: Vec2, v: Vec2, a: Vec2, reach: f64, bounds: Aabb) -> f64 {
    let along = |x: f64, v: f64, a: f64, low: f64, high: f64| {
        if x < low {
            first_rise(low - x, v, a)
        } else if x > high {
            first_rise(x - high, -v, -a)
        } else {
            0.0
        }
    };
    let reach = reach * ROOM;
    let (low, high) = (bounds.min - reach, bounds.max + reach);
    let x = along(at.x, v.x, a.x, low.x, high.x);
    let y = along(at.y, v.y, a.y, low.y, high.y);
    if x > y { x } else { y }
}

/// First root of `v t + a t²/2 = way` with `way` > 0.
pub(crate) fn first_rise(way: f64, v: f64, a: f64) -> f64 {
    let square = v * v + 2.0 * a * way;
    if square < 0.0 {
        return f64::INFINITY;
    }
    let root = square.sqrt();
    if v > 0.0 {
        2.0 * way / (v + root)
    } else if a > 0.0 {
        (root - v) / a
    } else {
        f64::INFINITY
    }
}

/// Box of a body's bounding circle along its motion from `time` on for `seconds`.
pub(crate) fn box_ahead(state: &BodyState, time: SimTime, seconds: f64) -> Aabb {
    swept(state, &Track::of(&state.motion, time), seconds)
}

/// [`box_ahead`] of any body, from one instant on.
pub(crate) fn ways_from(time: SimTime) -> impl Fn(&BodyState, f64) -> Aabb {
    move |body, seconds| box_ahead(body, time, seconds)
}

/// Box of a body's bounding circle along a track for `seconds`: both ends, and where it turns.
pub(crate) fn swept(state: &BodyState, track: &Track, seconds: f64) -> Aabb {
    let (from, to) = (track.centre, track.centre_after(seconds));
    let mut bounds = Aabb::from_points([from, to]);
    let turns = (-track.velocity / track.acceleration).to_array();
    for turn in turns {
        if turn > 0.0 && turn < seconds {
            bounds = bounds.union(Aabb::from_points([track.centre_after(turn)]));
        }
    }
    bounds.grown(state.reach * ROOM + room_about(state, bounds))
}

/// Rounding of where a body is within a box, and how far its motion is from its true path, in m.
fn room_about(state: &BodyState, bounds: Aabb) -> f64 {
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    1e-9 * state.reach + 1e-14 * largest + state.motion.left_out
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;
    use proptest::prelude::*;

    fn vector(size: f64) -> impl Strategy<Value = Vec2> {
        (-size..size, -size..size).prop_map(|(x, y)| vec2(x, y))
    }

    /// Each bound was looked at again when it had come: where the gap was a rounding for ever.
    #[test]
    fn circles_that_graze_are_looked_at_a_few_hundred_times() {
        for gap in [-1e-3, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 2e-3] {
            let (mut d, mut v) = (vec2(-3.0, ROOM * (1.0 + gap)), vec2(100.0, 0.0));
            let a = vec2(0.0, 1e-3);
            let mut looks = 0;
            while d.x < 0.0 && looks < 100_000 {
                let window = of_circles(d, v, a, 1.0).expect("a bound");
                if window.from == 0.0 {
                    break;
                }
                d += (v + a * (0.5 * window.from)) * window.from;
                v += a * window.from;
                looks += 1;
            }
            assert!(looks < 300, "{looks} looks, {gap}");
        }
    }

    proptest! {
        #[test]
        fn circles_overlap_only_within_their_window(
            d in vector(10.0), v in vector(5.0), pull in vector(10.0), falls: bool, reach in 0.1..3.0_f64,
        ) {
            let a = if falls { pull } else { Vec2::ZERO };
            let window = of_circles(d, v, a, reach);
            for i in 0..500 {
                let t = 0.01 * f64::from(i);
                let apart = (d + v * t + a * (0.5 * t * t)).length() > reach;
                let within = window.is_some_and(|w| w.from <= t && t <= w.to);
                prop_assert!(apart || within, "at {t} s: {window:?}");
            }
        }

        #[test]
        fn a_circle_reaches_no_box_before_its_bound(
            at in vector(10.0), v in vector(5.0), a in vector(10.0), reach in 0.1..3.0_f64, size in 0.1..4.0_f64,
        ) {
            let bounds = Aabb::new(vec2(-size, -1.0), vec2(size, 2.0));
            let from = from_box(at, v, a, reach, bounds);
            for i in 0..500 {
                let t = 0.01 * f64::from(i);
                let centre = at + v * t + a * (0.5 * t * t);
                let circle = Aabb::new(centre - reach, centre + reach);
                prop_assert!(t >= from || !circle.overlaps(bounds), "at {t} s, before {from}");
            }
        }
    }
}
