//! Bent rows: contacts whose face turns while something slides along it.
//!
//! Normals are those of the tick. A corner that slides at 5 m/s along a face that turns at 4 rad/s would sink into it by
//! v ω T²/2 = 3 mm a tick, tick after tick. So such a row turns with its face before every sub-step, as if its features were
//! looked at anew: the corner stays where it is on its own body, and the face is where its body has turned it.

use carom_math::{Rot, Vec2, perp, vec2};

use super::block::{Block, OPEN};
use super::graph::Graph;
use crate::bodies::Bodies;

/// What a row bends by in a tick, as a part of the smaller extent, if it is worth a look a sub-step.
const BENDS: f64 = 3e-3;

/// Contacts whose rows bend.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bent {
    rows: Vec<Row>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    contact: u32,
    pieces: [u32; 2],
    side: Side,
    seen: Seen,
}

/// A row at the base poses: normal, gaps, and the arms of its first point along normal and tangent, in m.
#[derive(Clone, Copy, Debug)]
struct Seen {
    n: Vec2,
    gaps: [f64; 2],
    a: Vec2,
    b: Vec2,
}

/// Whose face it is, and how far what lies on it is from its core, in m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    pub(crate) of_b: bool,
    pub(crate) radius: f64,
}

impl Bent {
    /// Keeps the rows that are not computed anew.
    pub(crate) fn retain(&mut self, graph: &Graph, moved: &[bool]) {
        self.rows.retain(|row| {
            graph.has(row.contact, row.pieces) && {
                let (block, _, lane) = graph.lane(row.contact);
                !(moved[block.a[lane] as usize] || moved[block.b[lane] as usize])
            }
        });
    }

    /// Takes a row of two pieces in, if it bends within a tick of `tick` seconds and may push in it; `extent`: that of the
    /// smaller piece, in m.
    pub(crate) fn consider(
        &mut self,
        (block, lane): (&Block, usize),
        (contact, pieces): (u32, [u32; 2]),
        (bodies, side): (&Bodies, Side),
        (tick, extent): (f64, f64),
    ) {
        let [a, b] = [block.a[lane], block.b[lane]].map(|line| &bodies.lines[line as usize]);
        let seen = Seen::of(block, lane);
        let closes = block
            .opening(lane, a, b)
            .map(|rate| (-rate * tick).max(0.0));
        let bends = seen.bends(side, [a, b].map(|line| (line.v() * tick, line.w() * tick)));
        let pushes = |k: usize| seen.gaps[k] < closes[k] + 2.0 * bends;
        if bends > BENDS * extent && (pushes(0) || pushes(1)) {
            self.rows.push(Row {
                contact,
                pieces,
                side,
                seen,
            });
        }
    }

    /// Turns all rows to where their bodies are, before a sub-step.
    pub(crate) fn turn_rows(&self, graph: &mut Graph, bodies: &mut Bodies) {
        for row in &self.rows {
            if !graph.has(row.contact, row.pieces) {
                continue;
            }
            let (block, lane) = graph.block_mut(row.contact);
            let ends = [block.a[lane], block.b[lane]].map(|line| line as usize);
            let [a, b] = ends.map(|line| bodies.lines[line]);
            let before = block.push(lane, &a, &b);
            let went = [a, b].map(|line| (line.d(), line.turn()));
            let turned = row.seen.turned(row.side, went);
            turned.write(block, lane, went, row.seen.gaps);
            // v − start is what the impulses of all rows give: these push along another normal now.
            let after = block.push(lane, &a, &b);
            for (line, (before, after)) in ends.into_iter().zip(before.into_iter().zip(after)) {
                let start = &mut bodies.start[line];
                for k in 0..3 {
                    start.0[k] += before.0[k] - after.0[k];
                }
            }
        }
    }
}

/// A row where its bodies are.
struct Turned {
    n: Vec2,
    /// Of the first point, in m.
    gap: f64,
    a: Vec2,
    b: Vec2,
}

impl Seen {
    fn of(block: &Block, lane: usize) -> Self {
        Self {
            n: block.normal(lane),
            gaps: [block.s1[lane], block.s2[lane]],
            // r × n = −r · t.
            a: vec2(block.at[lane], -block.a1[lane]),
            b: vec2(block.bt[lane], -block.b1[lane]),
        }
    }

    /// What its gap changes by to second order, at most, if its bodies go and turn so far, in m.
    fn bends(&self, side: Side, [a, b]: [(Vec2, f64); 2]) -> f64 {
        let slid = perp(self.n).dot(b.0 - a.0);
        let (face, corner, arm) = if side.of_b {
            (b.1, a.1, self.a.x.abs() + side.radius)
        } else {
            (a.1, b.1, self.b.x.abs() + side.radius)
        };
        (face * slid).abs() + 0.5 * arm * (face - corner) * (face - corner)
    }

    fn turned(&self, side: Side, [a, b]: [(Vec2, f64); 2]) -> Turned {
        // Arms end midway in the smaller gap.
        let [gap, second] = self.gaps;
        let nearest = gap.min(second);
        let (of_face, of_corner, outwards) = if side.of_b {
            (b.1, a.1, 1.0)
        } else {
            (a.1, b.1, -1.0)
        };
        let (own, other) = if side.of_b {
            (self.b, self.a)
        } else {
            (self.a, self.b)
        };
        let face = own.x + outwards * 0.5 * nearest;
        let corner = vec2(other.x + outwards * (0.5 * nearest - gap), other.y);
        // In the frame of the face, from the face's body to the corner's.
        let went = vec2(self.n.dot(b.0 - a.0), perp(self.n).dot(b.0 - a.0));
        let turned = Rot::from_angle(of_face);
        let apart = turned.inverse() * ((self.a - self.b + went) * -outwards);
        let core = vec2(outwards * -side.radius, 0.0);
        let corner = Rot::from_angle(of_corner - of_face) * (corner + core) - core;
        let gap_now = outwards * (face - apart.x - corner.x);
        let nearest = nearest + gap_now - gap;
        let own = vec2(face - outwards * 0.5 * nearest, (apart + corner).y);
        let other = vec2(corner.x + outwards * (gap_now - 0.5 * nearest), corner.y);
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
    /// Writes the row: its gaps are those of bodies that went and turned so far.
    fn write(&self, block: &mut Block, lane: usize, [a, b]: [(Vec2, f64); 2], gaps: [f64; 2]) {
        (block.nx[lane], block.ny[lane]) = (self.n.x, self.n.y);
        (block.at[lane], block.a1[lane]) = (self.a.x, -self.a.y);
        (block.bt[lane], block.b1[lane]) = (self.b.x, -self.b.y);
        let shown = self.gap - (self.n.dot(b.0 - a.0) - self.b.y * b.1 + self.a.y * a.1);
        // The other point is as far along the face, and level with the first one but for what it was at the tick and what the
        // bodies turned against each other since.
        if gaps[1] < OPEN {
            block.s2[lane] = shown + gaps[1] - gaps[0];
        }
        block.s1[lane] = shown;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rows::Quad;

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
            // Midway between the face and a point as near as the nearest one.
            let own = vec2(
                self.face + 0.5 * nearest,
                (self.between + self.corner).dot(along),
            );
            let other = vec2(tip - gap + 0.5 * nearest, self.corner.dot(along));
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
            let seen = Seen::of(&block, 0);
            let row = seen.turned(Side { of_b, radius }, went);
            row.write(&mut block, 0, went, seen.gaps);
            let exact = |t: f64| {
                let d = corner.0 - face.0 + (speeds[1].0 - speeds[0].0) * t;
                plain.gap(d, [face.1 + speeds[0].1 * t, corner.1 + speeds[1].1 * t])
            };
            let [a, b] = went.map(|(d, turn)| Quad::new(d, turn));
            let shown = block.s1[0] + block.response(0, 0, &a, &b);
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
}
