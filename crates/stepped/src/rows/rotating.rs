//! Rotating rows: contacts of a corner that slides along a turning face.
//!
//! Normals are those of the tick. A corner that slides at 5 m/s along a face that turns at 4 rad/s would penetrate it by
//! v ω T²/2 = 3 mm a tick, tick after tick. Such a row is rotated with its face once bodies moved, in every sub-step: the features
//! stay, the corner is fixed to its body, and the face to the other one.

use carom_math::{Rot, Vec2, perp, vec2};

use super::block::{Block, OPEN};
use super::graph::Graph;
use super::line::{Line, Quad};
use crate::bodies::Bodies;
use crate::{ContactIx, PieceIx};

/// Change of gap to second order within a tick from which on a row is rotated, as a part of the smaller extent. With 1e-3 the
/// thesis scene has the same deepest overlap (3.5 mm; 15.5 without rotating rows), a smash and a drum no less.
const SECOND_ORDER: f64 = 3e-3;

/// The rows that are rotated within the tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct RotatingRows {
    rows: Vec<Row>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    contact: ContactIx,
    pieces: [PieceIx; 2],
    side: Side,
    seen: Seen,
}

/// A row as it was found, at base poses but for how far B had `gone` from A since these: normal, gaps, and the arms of its first
/// point along normal and tangent, in m.
#[derive(Clone, Copy, Debug)]
struct Seen {
    n: Vec2,
    gone: Vec2,
    gaps: [f64; 2],
    a: Vec2,
    b: Vec2,
}

/// The body that has the face, and the radius of the other one's corner, in m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    pub(crate) of_b: bool,
    pub(crate) radius: f64,
}

impl RotatingRows {
    /// Keeps the rows of contacts that are not recomputed in this update.
    pub(crate) fn retain(&mut self, graph: &Graph, bodies: &Bodies) {
        self.rows.retain(|row| {
            graph.has(row.contact, row.pieces) && {
                let (block, _, lane) = graph.lane(row.contact);
                !(bodies.moved[block.a[lane]] || bodies.moved[block.b[lane]])
            }
        });
    }

    /// Adds a row that may close within a tick of `tick` seconds with a gap that changes to second order in it; `extent` of the smaller
    /// piece, in m.
    pub(crate) fn add(
        &mut self,
        (block, lane): (&Block, usize),
        (contact, pieces): (ContactIx, [PieceIx; 2]),
        (bodies, side): (&Bodies, Side),
        (tick, extent): (f64, f64),
    ) {
        let [a, b] = block.lines(lane).map(|line| &bodies.lines[line]);
        let seen = Seen::of(block, lane, b.d() - a.d());
        let opening = block.opening(lane, &bodies.lines);
        let closes = opening.map(|rate| (-rate * tick).max(0.0));
        let change = seen.second_order(side, [a, b].map(|line| (line.v() * tick, line.w() * tick)));
        let pushes = |k: usize| seen.gaps[k] < closes[k] + 2.0 * change;
        if change > SECOND_ORDER * extent && (pushes(0) || pushes(1)) {
            self.rows.push(Row {
                contact,
                pieces,
                side,
                seen,
            });
        }
    }

    /// Rotates all rows to the present poses.
    pub(crate) fn rotate(&self, graph: &mut Graph, bodies: &mut Bodies) {
        for row in &self.rows {
            if !graph.has(row.contact, row.pieces) {
                continue;
            }
            let (block, lane) = graph.block_mut(row.contact);
            if block.s1[lane] >= OPEN {
                // A ghost collision was hidden.
                continue;
            }
            let ends = block.lines(lane);
            let before = block.push(lane, &bodies.lines);
            let went = ends.map(|line| (bodies.lines[line].d(), bodies.lines[line].turn()));
            let turned = row.seen.turned(row.side, went);
            turned.write(block, lane, &bodies.lines, row.seen.gaps);
            // v − start is what the impulses of all rows give: these push along another normal now.
            let after = block.push(lane, &bodies.lines);
            for (line, (before, after)) in ends.into_iter().zip(before.into_iter().zip(after)) {
                let change = Quad::new(before.v() - after.v(), before.w() - after.w());
                bodies.start[line].add(&change);
            }
        }
    }
}

/// A row at the present poses.
struct Turned {
    n: Vec2,
    /// Of the first point, in m.
    gap: f64,
    a: Vec2,
    b: Vec2,
}

impl Seen {
    fn of(block: &Block, lane: usize, gone: Vec2) -> Self {
        let n = block.normal(lane);
        Self {
            n,
            gone,
            gaps: [block.s1[lane], block.s2[lane]].map(|gap| gap + n.dot(gone)),
            // r × n = −r · t.
            a: vec2(block.at[lane], -block.a1[lane]),
            b: vec2(block.bt[lane], -block.b1[lane]),
        }
    }

    /// Bound of the change of its gap to second order for these displacements and rotations, in m.
    fn second_order(&self, side: Side, [a, b]: [(Vec2, f64); 2]) -> f64 {
        let slid = perp(self.n).dot(b.0 - a.0);
        let (face, corner, arm) = if side.of_b {
            (b.1, a.1, self.a.x.abs() + side.radius)
        } else {
            (a.1, b.1, self.b.x.abs() + side.radius)
        };
        (face * slid).abs() + 0.5 * arm * (face - corner) * (face - corner)
    }

    /// The row at displacements and rotations since the base poses.
    fn turned(&self, side: Side, [a, b]: [(Vec2, f64); 2]) -> Turned {
        // Arms end on the surfaces, in the smaller gap, or midway in an overlap.
        let [gap, second] = self.gaps;
        let nearest = gap.min(second);
        let ((own, of_face), (other, of_corner), outwards) = if side.of_b {
            ((self.b, b.1), (self.a, a.1), 1.0)
        } else {
            ((self.a, a.1), (self.b, b.1), -1.0)
        };
        let overlap = 0.5 * nearest.min(0.0);
        let face = own.x + outwards * overlap;
        let corner = vec2(other.x + outwards * (nearest - overlap - gap), other.y);
        // In the frame of the face, from the face's body to the corner's.
        let went = b.0 - a.0 - self.gone;
        let went = vec2(self.n.dot(went), perp(self.n).dot(went));
        let turned = Rot::IDENTITY.turned_slightly(of_face);
        let between = self.a - self.b + vec2(nearest.max(0.0), 0.0);
        let apart = turned.inverse() * ((between + went) * -outwards);
        let core = vec2(outwards * -side.radius, 0.0);
        let back = Rot::IDENTITY.turned_slightly(of_corner - of_face);
        let corner = back * (corner + core) - core;
        let gap_now = outwards * (face - apart.x - corner.x);
        let nearest = nearest + gap_now - gap;
        let overlap = 0.5 * nearest.min(0.0);
        let own = vec2(face - outwards * overlap, (apart + corner).y);
        let other = vec2(
            corner.x + outwards * (gap_now - nearest + overlap),
            corner.y,
        );
        let (a, b) = if side.of_b {
            (other, own)
        } else {
            (own, other)
        };
        Turned {
            n: turned * self.n,
            gap: gap_now,
            a,
            b,
        }
    }
}

impl Turned {
    /// Writes the row, with what its gaps were when it was found.
    fn write(&self, block: &mut Block, lane: usize, lines: &[Line], gaps: [f64; 2]) {
        (block.nx[lane], block.ny[lane]) = (self.n.x, self.n.y);
        (block.at[lane], block.a1[lane]) = (self.a.x, -self.a.y);
        (block.bt[lane], block.b1[lane]) = (self.b.x, -self.b.y);
        block.s1[lane] = self.gap - block.opened(lane, lines)[0];
        // The second point differs by what it differed then; the relative rotation since is in its arms.
        if gaps[1] < OPEN {
            block.s2[lane] = block.s1[lane] + gaps[1] - gaps[0];
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::ConvexPolygon;

    use super::*;
    use crate::{BodyInput, BodyKind, Engine, Mixed, PieceInput, Settings};

    /// A corner of one body over a face of the other, as plain geometry: gap, and the row of it at the tick.
    struct Plain {
        /// From the face's body to the corner's, and the face's normal, in the world.
        between: Vec2,
        normal: Vec2,
        /// Of the face along its normal, and of the corner's core, in the world.
        face: f64,
        corner: Vec2,
        radius: f64,
    }

    impl Plain {
        /// With the corner's body gone by `d` against the face's, and both turned.
        fn gap(&self, d: Vec2, [face, corner]: [f64; 2]) -> f64 {
            let normal = Rot::from_angle(face) * self.normal;
            let core = self.between + d + Rot::from_angle(corner) * self.corner;
            normal.dot(core) - self.face - self.radius
        }

        /// Lane 0 of a block; the second point is `second` farther off.
        fn block(&self, of_b: bool, second: f64) -> Block {
            let gap = self.gap(Vec2::ZERO, [0.0; 2]);
            let nearest = gap.min(gap + second);
            let along = perp(self.normal);
            let tip = self.corner.dot(self.normal) - self.radius;
            // On the face, and on a point as near as the nearest one; midway in what overlaps.
            let overlap = 0.5 * nearest.min(0.0);
            let own = vec2(self.face + overlap, (self.between + self.corner).dot(along));
            let other = vec2(tip - gap + nearest - overlap, self.corner.dot(along));
            let mut block = Block::EMPTY;
            let n = if of_b { -self.normal } else { self.normal };
            // Against −n and −t both components change their sign.
            let (a, b) = if of_b { (-other, -own) } else { (own, other) };
            (block.nx[0], block.ny[0]) = (n.x, n.y);
            (block.at[0], block.a1[0]) = (a.x, -a.y);
            (block.bt[0], block.b1[0]) = (b.x, -b.y);
            (block.s1[0], block.s2[0]) = (gap, gap + second);
            block
        }
    }

    #[test]
    fn a_row_that_turns_has_the_gap_and_the_gap_rate_of_its_corner() {
        let mut seed = 1u64;
        let mut number = |from: f64, to: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            from + (to - from) * ((seed >> 11) as f64 / (1u64 << 53) as f64)
        };
        for case in 0..2000 {
            let of_b = case % 2 == 0;
            let turned = Rot::from_angle(number(-3.0, 3.0));
            let (height, side) = (number(0.5, 1.0), number(-1.0, 1.0));
            let radius = number(0.0, 0.1);
            let local = vec2(-number(0.3, 0.8), number(-0.5, 0.5));
            let gap = number(-0.02, 0.02);
            let plain = Plain {
                between: turned * vec2(height + radius + gap - local.x, side),
                normal: turned * Vec2::X,
                face: height,
                corner: turned * local,
                radius,
            };
            let mut block = plain.block(of_b, number(-0.01, 0.1));
            let mut way = || {
                (
                    vec2(number(-0.1, 0.1), number(-0.1, 0.1)),
                    number(-0.2, 0.2),
                )
            };
            let (face, corner) = (way(), way());
            let speeds = [way(), way()];
            let (went, rates) = if of_b {
                ([corner, face], [speeds[1], speeds[0]])
            } else {
                ([face, corner], speeds)
            };
            let seen = Seen::of(&block, 0, Vec2::ZERO);
            let row = seen.turned(Side { of_b, radius }, went);
            let lines = went.map(|(d, turn)| {
                let mut line = Line::EMPTY;
                line.set_displacement(d, turn);
                line
            });
            row.write(&mut block, 0, &lines, seen.gaps);
            let exact = |t: f64| {
                let d = corner.0 - face.0 + (speeds[1].0 - speeds[0].0) * t;
                plain.gap(d, [face.1 + speeds[0].1 * t, corner.1 + speeds[1].1 * t])
            };
            let [shown, _] = block.gaps(0, &lines);
            assert!(
                (shown - exact(0.0)).abs() < 1e-12,
                "{case}: {shown} {}",
                exact(0.0)
            );
            let [a, b] = rates.map(|(v, w)| Quad::new(v, w));
            let rate = block.response(0, 0, &a, &b);
            let step = 1e-5;
            let expected = (exact(step) - exact(-step)) / (2.0 * step);
            assert!((rate - expected).abs() < 1e-9, "{case}: {rate} {expected}");
        }
    }

    /// The row of a hidden ghost was turned into one that acts.
    #[test]
    fn a_hidden_row_stays_hidden() {
        let mut engine = Engine::new(Settings::default()).expect("settings");
        let plank = PieceInput::new(ConvexPolygon::rectangle(8.0, 0.2).expect("a plank"));
        let turns = BodyInput::new(BodyKind::Kinematic).moving(Vec2::ZERO, 4.0);
        engine.insert(turns, &[plank]).expect("a plank");
        let block = PieceInput::new(ConvexPolygon::rectangle(1.0, 1.0).expect("a block"));
        let slides = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(1.0, 0.6));
        engine
            .insert(slides.moving(vec2(5.0, 4.0), 0.0), &[block])
            .expect("a block");
        for _ in 0..30 {
            engine.tick();
            engine.find_contacts(&Mixed);
            if !engine.rotating.rows.is_empty() {
                break;
            }
        }
        let contact = engine
            .rotating
            .rows
            .first()
            .expect("a rotating row")
            .contact;
        engine.graph.hide(&mut engine.bodies, contact);
        engine
            .rotating
            .rotate(&mut engine.graph, &mut engine.bodies);
        let (block, _, lane) = engine.graph.lane(contact);
        assert_eq!(block.s1[lane].to_bits(), OPEN.to_bits());
    }
}
