//! Two outlines to their manifold, one pair at a time: the slow twin of [`super::wide`].

use carom_math::{Vec2, perp};

use super::{HYSTERESIS, Manifold, Scene};
use crate::PieceIx;
use crate::outline::Outline;

/// Where B is from A, and what they do until the next tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Going {
    /// From the centre of mass of A to that of B, and how far it goes against it, in m.
    pub(crate) d: Vec2,
    pub(crate) way: Vec2,
    /// Angles that A and B turn by.
    pub(crate) turns: [f64; 2],
}

impl Going {
    /// The same from B.
    fn back(self) -> Self {
        let [a, b] = self.turns;
        Self {
            d: -self.d,
            way: -self.way,
            turns: [b, a],
        }
    }
}

/// [`Scene::contact_on`] of two pieces with outlines.
pub(crate) fn contact_on(
    scene: &Scene<'_>,
    side: Vec2,
    pair: [PieceIx; 2],
    factor: f64,
) -> Option<Manifold> {
    let meeting = scene.meeting(pair);
    let [slot_a, slot_b] = pair.map(|piece| scene.pieces.list[piece].body);
    let turns = [slot_a, slot_b].map(|slot| scene.bodies.velocity_of(slot).1 * scene.settings.tick);
    let [base_a, base_b] = [slot_a, slot_b].map(|slot| scene.bodies.base_of(slot).position);
    let going = Going {
        d: base_b - base_a + meeting.gone,
        way: meeting.way,
        turns,
    };
    let margin = factor * meeting.margin;
    let limits = [margin + meeting.beside, margin, HYSTERESIS * meeting.margin];
    let [a, b] = pair.map(|piece| scene.pieces.outline(piece));
    let mut found = collide(a, b, going, side, limits)?;
    let gone = found.normal.dot(meeting.gone);
    found.gaps = found.gaps.map(|gap| gap - gone);
    (found.gap() < margin + scene.closes(pair, &found)).then_some(found)
}

/// Two outlines, both turned; `None` if they stay farther apart than `limit` until the next tick.
///
/// A's face is preferred unless B's separates by `hysteresis` more. Beyond a cut they may be by `past` less. All in m. Faces
/// that separate them against `side`, if that is not zero, are none.
pub(crate) fn collide(
    a: &Outline,
    b: &Outline,
    going: Going,
    side: Vec2,
    [limit, past, hysteresis]: [f64; 3],
) -> Option<Manifold> {
    let Going { d, way, .. } = going;
    let radii = a.radius() + b.radius();
    let limits = [limit + radii, limit + radii - past];
    let (sa, ia, cut_a) = best_face(a, b, [d, way, side], limits)?;
    let (sb, ib, cut_b) = best_face(b, a, [-d, -way, -side], limits)?;
    if a.corners() == 1 && b.corners() == 1 {
        let ends = [a.corner(0), b.corner(0)];
        let goes = way.length();
        return corners(a, b, d, ends).filter(|found| found.gap() <= limit + goes);
    }
    if sa.max(sb) == f64::NEG_INFINITY {
        return None;
    }
    let mut found = if sb > sa + hysteresis {
        face([b, a], going.back(), ib, hysteresis, true)
    } else {
        face([a, b], going, ia, hysteresis, false)
    };
    // B overlaps a piece by no more than across its cuts: the rest lies in other pieces, and leaves this one without a jump.
    let crossed = cut_a.max(cut_b) - radii;
    // Far behind the face it came across the cut, as the tip of a wedge does through a valley: other pieces have faces there.
    let behind = sa.max(sb) - radii;
    if behind < -past && behind < crossed {
        return None;
    }
    found.gaps = found.gaps.map(|gap| gap.max(crossed));
    Some(found)
}

/// The edge of `a` that separates best and is no cut, how far the nearest corner of `b` is in front of it, and at most in front
/// of a cut; `None` if that of some edge stays beyond `limit` on the way, of a cut beyond `past_cut`: there `b` meets another
/// piece.
fn best_face(
    a: &Outline,
    b: &Outline,
    [d, way, side]: [Vec2; 3],
    [limit, past_cut]: [f64; 2],
) -> Option<(f64, usize, f64)> {
    let mut best = (f64::NEG_INFINITY, 0, f64::NEG_INFINITY);
    if a.corners() == 1 {
        return Some(best);
    }
    for i in 0..a.corners() {
        let n = a.normal(i);
        let mut least = n.dot(b.corner(0));
        for k in 1..b.corners() {
            let along = n.dot(b.corner(k));
            least = if along < least { along } else { least };
        }
        let separation = least + n.dot(d) - a.off(i);
        let nears = n.dot(way);
        let limit = if a.is_cut(i) { past_cut } else { limit };
        if separation + if nears < 0.0 { nears } else { 0.0 } > limit {
            return None;
        }
        if a.is_cut(i) {
            best.2 = separation.max(best.2);
        } else if separation > best.0 && n.dot(side) >= 0.0 {
            (best.0, best.1) = (separation, i);
        }
    }
    Some(best)
}

/// Clips the edge of `other` that faces edge `i` of `owner` to it. What is apart by no more than `hysteresis` is at one place.
fn face(
    [owner, other]: [&Outline; 2],
    Going { d, way, turns }: Going,
    i: usize,
    hysteresis: f64,
    flipped: bool,
) -> Manifold {
    let n = owner.normal(i);
    let t = perp(n);
    let i_next = owner.next(i);
    let (face_low, face_high) = (t.dot(owner.corner(i)), t.dot(owner.corner(i_next)));
    let (j, j_next) = facing(other, n);
    // Edges run against each other, so the end of the other's edge is the lower one.
    let (low, high) = (other.corner(j_next) + d, other.corner(j) + d);
    let (x_low, x_high) = (t.dot(low), t.dot(high));
    let (z_low, z_high) = (n.dot(low) - owner.off(i), n.dot(high) - owner.off(i));
    let radii = owner.radius() + other.radius();
    let start = if x_low > face_low { x_low } else { face_low };
    let end = if x_high < face_high {
        x_high
    } else {
        face_high
    };
    // Beyond the end of the face an edge has no point, but for its nearer corner if that comes onto the face by the next tick:
    // what is at the end now closes slower.
    let spin = turns[1] - turns[0];
    let comes = |out: f64, onto: f64, [x, z, other]: [f64; 3]| {
        let along = t.dot(way) + (spin * (z + owner.off(i)) - turns[1] * n.dot(d));
        let up = n.dot(way) - (spin * x - turns[1] * t.dot(d));
        let (goes, over) = (onto * along, z + hysteresis);
        let there = out > 0.0 && goes >= out && over * goes + out * up >= 0.0;
        there && z < other && start <= end
    };
    let (start, end) = (
        if comes(face_low - x_low, 1.0, [x_low, z_low, z_high]) {
            x_low
        } else {
            start
        },
        if comes(x_high - face_high, -1.0, [x_high, z_high, z_low]) {
            x_high
        } else {
            end
        },
    );
    let flat = owner.corners() > 2 && other.corners() > 2 && z_low.min(z_high) <= 0.0;
    // Beyond one end of the face: corner on corner.
    let meet = |mine: usize, theirs: usize| {
        let (mine, theirs) = (owner.corner(mine), other.corner(theirs));
        if flipped {
            corners(other, owner, -d, [theirs, mine])
        } else {
            corners(owner, other, d, [mine, theirs])
        }
    };
    if start > end && !flat {
        let found = if x_low > face_high {
            meet(i_next, j_next)
        } else {
            meet(i, j)
        };
        if let Some(found) = found {
            return found;
        }
    }
    let run = x_high - x_low;
    let slope = if run > 0.0 {
        (z_high - z_low) / run
    } else {
        0.0
    };
    let (start, end) = if start > end {
        (end, end)
    } else {
        (start, end)
    };
    let gap = |x: f64| z_low + (x - x_low) * slope - radii;
    let (gap_low, gap_high) = (gap(start), gap(end));
    // Points closer than rounding of their places are one.
    let single = end - start <= 1e-9 * (face_high - face_low);
    let nearest = if single || gap_low < gap_high {
        gap_low
    } else {
        gap_high
    };
    // The nearer corner of the other's edge overhangs, and rounded corners meet before the faces do.
    if radii > 0.0 && nearest + radii > 0.0 {
        let overhang = if z_low <= z_high {
            (x_low < face_low).then(|| meet(i, j_next))
        } else {
            (x_high > face_high).then(|| meet(i_next, j))
        };
        if let Some(Some(found)) = overhang
            && found.gap() < nearest
        {
            return found;
        }
    }
    let height = owner.off(i) + owner.radius() + 0.5 * nearest.min(0.0);
    let mine = |x: f64| -x;
    let theirs = |x: f64| t.dot(d) - x;
    let beyond = height + nearest.max(0.0) - n.dot(d);
    let points = if single { 1 } else { 2 };
    if flipped {
        // The owner is B: the normal from A to B is −n, and the lower end is farther along it turned by +90°.
        Manifold {
            normal: -n,
            arm_a: -theirs(start),
            arm_b: -mine(start),
            length: end - start,
            points,
            tangent_a: -beyond,
            tangent_b: -height,
            gaps: [gap_low, gap_high],
        }
    } else {
        Manifold {
            normal: n,
            arm_a: mine(end),
            arm_b: theirs(end),
            length: end - start,
            points,
            tangent_a: height,
            tangent_b: beyond,
            gaps: [gap_high, gap_low],
        }
    }
}

/// The edge with the normal most opposed to `n`, by its two corners; of a disc its one.
fn facing(outline: &Outline, n: Vec2) -> (usize, usize) {
    if outline.corners() == 1 {
        return (0, 0);
    }
    let mut best = (f64::INFINITY, 0);
    for i in 0..outline.corners() {
        let along = n.dot(outline.normal(i));
        if along < best.0 {
            best = (along, i);
        }
    }
    (best.1, outline.next(best.1))
}

/// Two corners, or centres of discs; where they coincide there is no normal.
fn corners(a: &Outline, b: &Outline, d: Vec2, [of_a, of_b]: [Vec2; 2]) -> Option<Manifold> {
    let way = of_b + d - of_a;
    let distance = way.length();
    let normal = if distance > 0.0 {
        way / distance
    } else if a.corners() == 1 && b.corners() == 1 {
        // Discs in one place part upwards.
        Vec2::Y
    } else {
        return None;
    };
    let gap = distance - a.radius() - b.radius();
    let arm = of_a + normal * (a.radius() + 0.5 * gap);
    Some(Manifold::single(normal, [arm, arm - d], gap))
}
