//! Lines as areas: what a pen of some width covers, with round ends and corners.

use carom_math::{Vec2, vec2};

/// Finds the area of lines; its memory goes from line to line.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outliner {
    /// Unit normals of the sides, to the right of their direction.
    normals: Vec<Vec2>,
    outer: Vec<Vec2>,
    inner: Vec<Vec2>,
    spare: Vec<Vec2>,
}

impl Outliner {
    /// What a round pen covers that is drawn once around a ring: its outer and its inner border, which run opposite ways.
    ///
    /// `None` where a border would cross itself: the ring has features smaller than the pen.
    pub(crate) fn band(&mut self, ring: &[Vec2], half: f64) -> Option<[&[Vec2]; 2]> {
        let doubled = doubled_area(ring);
        if doubled == 0.0 || ring.len() < 3 {
            return None;
        }
        self.normals.clear();
        let sides = ring.iter().zip(ring.iter().cycle().skip(1));
        self.normals.extend(sides.map(|(&a, &b)| {
            let along = (b - a).normalize_or_zero();
            vec2(along.y, -along.x)
        }));
        if self.normals.contains(&Vec2::ZERO) {
            return None;
        }
        // The right of a ring with positive area is its outside.
        let outwards = if doubled > 0.0 { half } else { -half };
        let wide = offset(ring, &self.normals, outwards, &mut self.outer);
        let mut narrow = offset(ring, &self.normals, -outwards, &mut self.inner);
        if wide && !narrow && is_convex(ring) {
            // A convex ring shrinks to the half-planes that its sides leave.
            inset(
                ring,
                &self.normals,
                -outwards,
                &mut self.inner,
                &mut self.spare,
            );
            narrow = true;
        }
        self.inner.reverse();
        (wide && narrow).then_some([&self.outer, &self.inner])
    }
}

/// The ring moved by `by` to the right of its sides: around corners in an arc, into corners to where the sides meet.
/// Whether all sides keep their direction.
fn offset(ring: &[Vec2], normals: &[Vec2], by: f64, out: &mut Vec<Vec2>) -> bool {
    out.clear();
    let count = ring.len();
    let mut end = Vec2::ZERO;
    for i in 0..=count {
        let (corner, before, after) = (
            ring[i % count],
            normals[(i + count - 1) % count],
            normals[i % count],
        );
        let turn = before.perp_dot(after) * by;
        // Where the side before ends and the side after begins.
        let (arrive, leave) = if turn > 0.0 {
            (corner + before * by, corner + after * by)
        } else {
            // The point at distance `by` from both sides.
            let whole = 1.0 + before.dot(after);
            if whole < 1e-3 {
                return false;
            }
            let meet = corner + (before + after) * (by / whole);
            (meet, meet)
        };
        if i > 0 && (arrive - end).dot(vec2(-before.y, before.x)) < 0.0 {
            return false;
        }
        if i < count {
            out.push(arrive);
            if turn > 0.0 {
                bend(
                    out,
                    corner,
                    before * by.signum(),
                    after * by.signum(),
                    by.abs(),
                );
                out.push(leave);
            }
        }
        end = leave;
    }
    true
}

/// A convex ring cut by each of its sides moved inwards.
fn inset(ring: &[Vec2], normals: &[Vec2], by: f64, out: &mut Vec<Vec2>, spare: &mut Vec<Vec2>) {
    out.clear();
    out.extend_from_slice(ring);
    for (&corner, &normal) in ring.iter().zip(normals) {
        core::mem::swap(out, spare);
        out.clear();
        let Some(&last) = spare.last() else {
            return;
        };
        // Depth behind the moved side, positive inside.
        let inwards = normal * by.signum();
        let depth = |p: Vec2| (p - corner).dot(inwards) - by.abs();
        let mut before = (last, depth(last));
        for &point in spare.iter() {
            let here = (point, depth(point));
            if (here.1 >= 0.0) != (before.1 >= 0.0) {
                out.push(before.0 + (here.0 - before.0) * (before.1 / (before.1 - here.1)));
            }
            if here.1 >= 0.0 {
                out.push(point);
            }
            before = here;
        }
    }
}

/// Points of an arc strictly between two directions less than half a turn apart.
fn bend(out: &mut Vec<Vec2>, centre: Vec2, from: Vec2, to: Vec2, half: f64) {
    /// Deepest chord below its arc, in pixels: less than one part in 255 of a pixel is lost.
    const DEPTH: f64 = 0.004;
    // A chord of angle s lies h s² / 8 below its arc, and 1 - cos s = s² / 2.
    if half * (1.0 - from.dot(to)) <= 4.0 * DEPTH {
        return;
    }
    let middle = (from + to).normalize_or_zero();
    if middle == Vec2::ZERO {
        return;
    }
    bend(out, centre, from, middle, half);
    out.push(centre + middle * half);
    bend(out, centre, middle, to, half);
}

/// Twice the signed area.
fn doubled_area(ring: &[Vec2]) -> f64 {
    let Some(&origin) = ring.first() else {
        return 0.0;
    };
    let pairs = ring.windows(2);
    pairs
        .map(|pair| (pair[0] - origin).perp_dot(pair[1] - origin))
        .sum()
}

/// Whether a ring is convex and goes around once.
pub(crate) fn is_convex(ring: &[Vec2]) -> bool {
    let [.., before, last] = *ring else {
        return false;
    };
    if ring.len() < 4 {
        return ring.len() == 3;
    }
    let (mut left, mut right, mut flips) = (false, false, 0);
    let (mut along, mut from) = (last - before, last);
    for &corner in ring {
        let next = corner - from;
        let turn = along.perp_dot(next);
        left |= turn > 0.0;
        right |= turn < 0.0;
        // Once around a convex ring, x turns back twice.
        flips += i32::from((along.x < 0.0) != (next.x < 0.0));
        (along, from) = (next, corner);
    }
    !(left && right) && flips <= 2
}

/// Whether no two sides of a ring cross, for rings of at most 64 points.
pub(crate) fn is_simple(ring: &[Vec2]) -> bool {
    const MOST: usize = 64;
    let count = ring.len();
    if is_convex(ring) {
        return true;
    }
    if count > MOST {
        return false;
    }
    let side = |i: usize| (ring[i], ring[(i + 1) % count]);
    let crosses = |(a, b): (Vec2, Vec2), (c, d): (Vec2, Vec2)| {
        let [at_c, at_d] = [c, d].map(|p| (b - a).perp_dot(p - a));
        let [at_a, at_b] = [a, b].map(|p| (d - c).perp_dot(p - c));
        at_c * at_d < 0.0 && at_a * at_b < 0.0
    };
    (0..count).all(|i| (i + 1..count).all(|j| !crosses(side(i), side(j))))
}
