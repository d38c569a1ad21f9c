//! What is near: a pair's margin, and how far it closes until the next tick.

use carom_collision::{part_count, shape_push};
use carom_geometry::Shape;
use carom_math::Vec2;
use fearless_simd::Level;

use super::hulls::overlaps_across_cuts;
use super::{Eight, Found, Manifold, collide_any, collide_eight};
use crate::bodies::Bodies;
use crate::pieces::Pieces;
use crate::rows::LANES;
use crate::{LineIx, PieceIx, Settings};

/// Part of a margin by which B's face must separate better than A's: flush faces keep one owner.
pub(super) const HYSTERESIS: f64 = 0.1;

/// What the narrow phase reads.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) level: Level,
    pub(crate) bodies: &'a Bodies,
    pub(crate) pieces: &'a Pieces,
    pub(crate) settings: &'a Settings,
}

/// What two pieces are to each other within a tick.
pub(super) struct Meeting {
    /// Gaps below it make a contact, in m.
    pub(super) margin: f64,
    /// What they may close by until the next tick beside the way that B goes against A, in m.
    pub(super) beside: f64,
    pub(super) way: Vec2,
    /// How far B went from A since their base poses, in m: within a tick one may have gone, and the other, rebased, not.
    pub(super) gone: Vec2,
}

impl Scene<'_> {
    /// The contact of two pieces if their gap is below `factor` margins, or may be until the next tick.
    pub(crate) fn contact(&self, pair: [PieceIx; 2], factor: f64) -> Option<Manifold> {
        self.contact_on(Vec2::ZERO, pair, factor)
    }

    /// The same with B on that `side` of A, as a normal from A to B. On any if it is zero, or a piece has no outline.
    pub(crate) fn contact_on(
        &self,
        side: Vec2,
        pair: [PieceIx; 2],
        factor: f64,
    ) -> Option<Manifold> {
        let mut eight = Eight::new(self.pieces, pair.map(|piece| [self.line_of(piece); LANES]));
        if eight.set(self.pieces, 0, pair) {
            eight.least[0] = self.seen(pair.map(|piece| self.line_of(piece)));
            eight.side = (side != Vec2::ZERO).then_some(side);
            let mut found = Found::NONE;
            collide_eight(self, factor, &eight, &mut found);
            return (found.near & 1 == 1).then(|| found.manifold(0));
        }
        let meeting = self.meeting(pair);
        let margin = factor * meeting.margin;
        let [a, b] = pair.map(|piece| &self.pieces.list[piece]);
        let [pose_a, mut pose_b] = [a.body, b.body].map(|slot| self.bodies.base_of(slot));
        pose_b.position += meeting.gone;
        let limit = margin + meeting.beside + meeting.way.length();
        let mut found = collide_any((a, pose_a), (b, pose_b), limit)?;
        // Rows count from the base poses.
        let gone = found.normal.dot(meeting.gone);
        found.gaps = found.gaps.map(|gap| gap - gone);
        (found.gap() < margin + self.closes(pair, &found)).then_some(found)
    }

    /// Whether two pieces without a contact are in each other by more than a margin: across cuts.
    pub(crate) fn overlaps_across_cuts(&self, pair: [PieceIx; 2]) -> bool {
        let margin = self.margin(pair);
        let [a, b] = pair.map(|piece| &self.pieces.list[piece]);
        let [pose_a, mut pose_b] = [a.body, b.body].map(|slot| self.bodies.base_of(slot));
        pose_b.position += self.meeting(pair).gone;
        overlaps_across_cuts((a, pose_a), (b, pose_b), margin)
    }

    /// Whether a piece of a concave shape is in another one by more than a margin. Out of a half-plane all go one way.
    pub(crate) fn is_entangled(&self, pair: [PieceIx; 2], gap: f64) -> bool {
        let shapes = pair.map(|piece| self.pieces.list[piece].shape());
        gap < -self.margin(pair)
            && shapes.iter().any(|shape| part_count(shape) > 1)
            && !shapes
                .iter()
                .any(|shape| matches!(shape, Shape::HalfPlane(_)))
    }

    /// The shortest way out of the whole shapes of two pieces, as a contact in the middle of what both boxes hold of these; `None` if they
    /// are apart.
    pub(crate) fn way_out(&self, pair: [PieceIx; 2]) -> Option<Manifold> {
        let [a, b] = pair.map(|piece| &self.pieces.list[piece]);
        let [pose_a, mut pose_b] = [a.body, b.body].map(|slot| self.bodies.base_of(slot));
        let gone = self.meeting(pair).gone;
        pose_b.position += gone;
        let way = shape_push(a.shape(), b.shape(), pose_b.seen_from(pose_a))?;
        let depth = way.length();
        let normal = pose_a.vector(way / depth);
        let [of_a, of_b] = [(a, pose_a), (b, pose_b)].map(|(piece, pose)| piece.hull().aabb(pose));
        let middle = 0.5 * (of_a.min.max(of_b.min) + of_a.max.min(of_b.max));
        // Rows count from the base poses.
        let gap = -(depth + a.rounding + b.rounding) - normal.dot(gone);
        let arms = [pose_a, pose_b].map(|pose| middle - pose.position);
        Some(Manifold::single(normal, arms, gap))
    }

    /// The line of a piece's body; that of fixed ones if it sleeps.
    fn line_of(&self, piece: PieceIx) -> LineIx {
        self.bodies.line_of(self.pieces.list[piece].body)
    }

    /// What the bodies of two lines may close by unseen, in m: each may be a tolerance off its base pose, and go as far again.
    pub(crate) fn seen(&self, lines: [LineIx; 2]) -> f64 {
        let [a, b] = lines.map(|line| {
            let tolerance = self.bodies.limits[line].tolerance;
            // What is fixed has no tolerance yet.
            if tolerance < f64::INFINITY {
                tolerance
            } else {
                0.0
            }
        });
        2.0 * (a + b)
    }

    /// Gaps of two pieces below it make a contact, in m.
    pub(crate) fn margin(&self, pair: [PieceIx; 2]) -> f64 {
        let [a, b] = pair.map(|piece| self.pieces.list[piece].extent);
        let seen = self.seen(pair.map(|piece| self.line_of(piece)));
        seen.max(self.settings.margin * a.min(b))
    }

    pub(super) fn meeting(&self, pair: [PieceIx; 2]) -> Meeting {
        let [a, b] = pair.map(|piece| self.pieces.list[piece].reach);
        let [line_a, line_b] = pair.map(|piece| &self.bodies.lines[self.line_of(piece)]);
        let turning = arc(line_a.w(), a) + arc(line_b.w(), b);
        let turned = arc(line_a.turn(), a) + arc(line_b.turn(), b);
        let tick = self.settings.tick;
        let pull = self.settings.gravity.length() * tick;
        let gone = line_b.d() - line_a.d();
        Meeting {
            margin: self.margin(pair),
            beside: (turning + pull) * tick + gone.length() + turned,
            way: (line_b.v() - line_a.v()) * tick,
            gone,
        }
    }

    /// How far the nearer point closes from the base poses until the next tick, in m, if velocities stay but for gravity.
    pub(crate) fn closes(&self, pair: [PieceIx; 2], found: &Manifold) -> f64 {
        let lines = pair.map(|piece| self.line_of(piece));
        let [a, b] = lines.map(|line| &self.bodies.lines[line]);
        let pull: Vec2 = self.bodies.pull[lines[1]].v() - self.bodies.pull[lines[0]].v();
        let n = found.normal;
        let first = n.dot(b.v() - a.v()) + found.arm_b * b.w() - found.arm_a * a.w();
        let second = first + found.length * (b.w() - a.w());
        let least = if second < first { second } else { first };
        let least = least + n.dot(pull).min(0.0) * self.settings.tick;
        let went = n.dot(b.d() - a.d()) + found.arm_b * b.turn() - found.arm_a * a.turn();
        let second = went + found.length * (b.turn() - a.turn());
        let went = if second < went { second } else { went };
        (-least).max(0.0) * self.settings.tick - went
    }

    /// The least gap at the next tick, in m, if velocities stay but, if it `falls`, for gravity: each point goes its own way.
    pub(crate) fn gap_ahead(&self, pair: [PieceIx; 2], found: &Manifold, falls: bool) -> f64 {
        let lines = pair.map(|piece| self.line_of(piece));
        let [a, b] = lines.map(|line| &self.bodies.lines[line]);
        let pull = if falls {
            self.bodies.pull[lines[1]].v() - self.bodies.pull[lines[0]].v()
        } else {
            Vec2::ZERO
        };
        let tick = self.settings.tick;
        let ahead = |k: usize| {
            let along = if k == 0 { 0.0 } else { found.length };
            let (arm_a, arm_b) = (found.arm_a + along, found.arm_b + along);
            let way = |d: Vec2, turn_a: f64, turn_b: f64| {
                found.normal.dot(d) + arm_b * turn_b - arm_a * turn_a
            };
            let went = way(b.d() - a.d(), a.turn(), b.turn());
            let speed = way(b.v() - a.v() + pull * tick, a.w(), b.w());
            found.gaps[k] + went + speed.min(0.0) * tick
        };
        (1..usize::from(found.points))
            .map(ahead)
            .fold(ahead(0), f64::min)
    }
}

/// How far a point goes that turns by an angle, in m. Half-planes reach without end, and do not turn.
pub(crate) fn arc(angle: f64, reach: f64) -> f64 {
    if angle == 0.0 {
        0.0
    } else {
        angle.abs() * reach
    }
}
