//! One island in hard rows: its velocities, and where they lead.

use carom_impact::{Friction, HeldFace, HeldPoint, ImpactBody, held_faces};
use carom_math::{Vec2, perp};

use super::conditions::{answers, rest};
use crate::bodies::Bodies;
use crate::rows::{Block, Graph, Law, Line, OPEN, Quad, velocity_before};

/// Gap or overlap that counts as 0, as a part of what gravity falls in a sub-step: closing what rounding left open, a column at rest
/// would be solved for in every sub-step.
const TOUCHES: f64 = 1e-6;

/// Solves with given limits of friction where Coulomb's law is not solved.
const LIMITS: usize = 4;

/// A body may move evenly where its velocity changes by at most this many times the change by its pull: a stop is no even motion.
const EVEN: f64 = 4.0;

/// A contact of the island.
pub(super) struct HardContact {
    pub(super) id: u32,
    pub(super) belt: f64,
    /// Places of its bodies in the island.
    pub(super) ends: [usize; 2],
    /// Gaps at the beginning of the sub-step, in m: of the points that are there.
    pub(super) gaps: [f64; 2],
    pub(super) points: usize,
}

/// Bodies and contacts of an island in a sub-step.
pub(super) struct Island {
    lines: Vec<u32>,
    /// With centres at 0: arms are told from there.
    bodies: Vec<ImpactBody>,
    pub(super) contacts: Vec<HardContact>,
    /// Velocities that lead to the end of the sub-step.
    ways: Vec<Quad>,
}

/// The lane of a contact.
pub(super) fn lane_of(graph: &Graph, id: u32) -> (&Block, usize) {
    let (block, _, lane) = graph.lane(id);
    (block, lane)
}

impl Island {
    pub(super) fn of(graph: &Graph, bodies: &Bodies, ids: &[u32]) -> Self {
        let mut island = Self {
            lines: Vec::new(),
            bodies: Vec::new(),
            contacts: Vec::with_capacity(ids.len()),
            ways: Vec::new(),
        };
        for &id in ids {
            let (block, cold, lane) = graph.lane(id);
            let lines = [block.a[lane], block.b[lane]];
            let [a, b] = lines.map(|line| &bodies.lines[line as usize]);
            let mut gaps = block.gaps(lane, a, b);
            if cold.is_deep(lane) {
                // Sweeps are shown less.
                let opened = block.opened(lane, a, b);
                gaps =
                    [0, 1].map(|point| gaps[point].min(cold.depths[lane][point] + opened[point]));
            }
            // Hidden ones push nothing.
            let points = if gaps[0] < 0.5 * OPEN {
                block.points(lane)
            } else {
                0
            };
            let ends = lines.map(|line| island.place(bodies, line));
            island.contacts.push(HardContact {
                id,
                belt: cold.belt[lane],
                ends,
                gaps,
                points,
            });
        }
        island
    }

    /// The place of a line, which is new to the island or not.
    fn place(&mut self, bodies: &Bodies, line: u32) -> usize {
        if let Some(known) = self.lines.iter().position(|known| *known == line) {
            return known;
        }
        let (body, start) = (&bodies.lines[line as usize], &bodies.start[line as usize]);
        self.lines.push(line);
        self.bodies.push(ImpactBody {
            inverse_mass: body.inverse_mass(),
            inverse_inertia: body.inverse_inertia(),
            centre: Vec2::ZERO,
            velocity: start.v(),
            spin: start.w(),
        });
        self.lines.len() - 1
    }

    pub(super) fn ends<'b>(&self, bodies: &'b Bodies, contact: &HardContact) -> [&'b Line; 2] {
        contact
            .ends
            .map(|end| &bodies.lines[self.lines[end] as usize])
    }

    /// Velocities before contacts act.
    pub(super) fn free(&self, contact: &HardContact) -> [&ImpactBody; 2] {
        contact.ends.map(|end| &self.bodies[end])
    }

    /// Gives bodies and rows what holds all contacts; false if nothing was found that does: then they have the warm start.
    pub(super) fn solve(&mut self, law: &Law, bodies: &mut Bodies, graph: &mut Graph) -> bool {
        self.push(bodies, graph);
        let rest = rest(self, law, graph);
        if answers(self, law, bodies, graph, rest) {
            self.settle(bodies, rest);
            return true;
        }
        let Some(impulses) = self.hold(law, graph) else {
            return false;
        };
        for (contact, impulses) in self.contacts.iter().zip(impulses) {
            let (block, lane) = graph.block_mut(contact.id);
            block.set_impulses(lane, impulses);
        }
        self.push(bodies, graph);
        self.settle(bodies, rest);
        true
    }

    /// Takes out what rounding left of the velocities of bodies at rest: with it each sub-step would need other impulses.
    fn settle(&self, bodies: &mut Bodies, rest: f64) {
        for &line in &self.lines {
            let at = line as usize;
            let body = &mut bodies.lines[at];
            let (v, w) = (body.v(), body.w());
            let turns = w.abs() * bodies.limits[at].reach;
            if body.inverse_mass() > 0.0 && v.x.abs().max(v.y.abs()) + turns <= rest {
                body.set_velocity(Vec2::ZERO, 0.0);
                // The warm start stays.
                bodies.start[at].add(&Quad::new(-v, -w));
            }
        }
    }

    /// Gives bodies what their rows do.
    fn push(&self, bodies: &mut Bodies, graph: &Graph) {
        for (&line, body) in self.lines.iter().zip(&self.bodies) {
            bodies.lines[line as usize].set_velocity(body.velocity, body.spin);
        }
        for contact in &self.contacts {
            let (block, lane) = lane_of(graph, contact.id);
            let [a, b] = self.ends(bodies, contact);
            let pushes = block.push(lane, a, b);
            for (end, push) in contact.ends.into_iter().zip(&pushes) {
                bodies.lines[self.lines[end] as usize].add(push);
            }
        }
    }

    /// Impulses of all faces that hold them. Where no pivots end at such, limits of friction are given: none, then what the impulses
    /// found allow, and so on. No point closes, but what rubs may do so by a little more or less than Coulomb says.
    fn hold(&self, law: &Law, graph: &Graph) -> Option<Vec<[f64; 3]>> {
        let mu = |contact: &HardContact| {
            let (block, lane) = lane_of(graph, contact.id);
            block.mu[lane]
        };
        let opens = |gap: f64| closes(law, gap);
        let coulomb = |_: usize, contact: &HardContact| Friction::Coulomb(mu(contact));
        let held = held_faces(&self.bodies, &self.faces(graph, opens, coulomb));
        if held.sure {
            return Some(held.impulses);
        }
        let mut found: Option<Vec<[f64; 3]>> = None;
        for _ in 0..LIMITS {
            let given = |k: usize, contact: &HardContact| {
                let pushes = found.as_ref().map_or(0.0, |j| j[k][0] + j[k][1]);
                Friction::Given(mu(contact) * pushes)
            };
            let held = held_faces(&self.bodies, &self.faces(graph, opens, given));
            if !held.sure {
                break;
            }
            found = Some(held.impulses);
        }
        found
    }

    /// What is asked of each face, from its gaps.
    fn faces(
        &self,
        graph: &Graph,
        opens: impl Fn(f64) -> f64,
        rubs: impl Fn(usize, &HardContact) -> Friction,
    ) -> Vec<HeldFace> {
        let face = |(k, contact): (usize, &HardContact)| {
            let (block, lane) = lane_of(graph, contact.id);
            let n = block.normal(lane);
            let point = |point: usize| {
                let back = if point == 1 { block.l[lane] } else { 0.0 };
                let on = |height: f64, arm: f64| n * height - perp(n) * (arm + back);
                HeldPoint {
                    on: (
                        on(block.at[lane], block.a1[lane]),
                        on(block.bt[lane], block.b1[lane]),
                    ),
                    opens: opens(contact.gaps[point]),
                }
            };
            HeldFace {
                bodies: (contact.ends[0], contact.ends[1]),
                normal: n,
                friction: rubs(k, contact),
                slips: contact.belt,
                points: (0..contact.points).map(point).collect(),
                before: block.impulses(lane),
            }
        };
        self.contacts.iter().enumerate().map(face).collect()
    }

    /// Finds where the bodies are at the end of the sub-step, of second order where velocities change smoothly.
    pub(super) fn displace(
        &mut self,
        law: &Law,
        bodies: &Bodies,
        graph: &Graph,
        moves: &mut Vec<(u32, Quad)>,
    ) {
        self.ways = self
            .lines
            .iter()
            .map(|line| even_way(bodies, *line, law.h))
            .collect();
        if self.least_gap(law, graph) < -touches(law) {
            self.part(law, graph);
        }
        for (&line, way) in self.lines.iter().zip(&self.ways) {
            let body = &bodies.lines[line as usize];
            if body.inverse_mass() > 0.0 || body.inverse_inertia() > 0.0 {
                let (d, turn) = (body.d() + way.v() * law.h, body.turn() + way.w() * law.h);
                moves.push((line, Quad::new(d, turn)));
            }
        }
    }

    /// Leaves no gap below 0, or as little as the fastest push-out does.
    fn part(&mut self, law: &Law, graph: &Graph) {
        let faces = self.faces(
            graph,
            |gap| (-gap * law.inverse_h).min(law.push_out),
            |_, _| Friction::Coulomb(0.0),
        );
        let mut moving = self.bodies.clone();
        for (body, way) in moving.iter_mut().zip(&self.ways) {
            (body.velocity, body.spin) = (way.v(), way.w());
        }
        let parted = held_faces(&moving, &faces);
        if !parted.sure {
            return;
        }
        // What is wedged in goes a long way for a little room: no body is pushed faster than any overlap.
        let fastest = parted
            .bodies
            .iter()
            .zip(&moving)
            .map(|(to, from)| (to.velocity - from.velocity).length());
        let fastest = fastest.fold(0.0, f64::max);
        let share = if fastest > law.push_out {
            law.push_out / fastest
        } else {
            1.0
        };
        for (way, (to, from)) in self.ways.iter_mut().zip(parted.bodies.iter().zip(&moving)) {
            let more = (to.velocity - from.velocity) * share;
            way.add(&Quad::new(more, (to.spin - from.spin) * share));
        }
    }

    /// The least gap at the end of the sub-step, in m.
    pub(super) fn least_gap(&self, law: &Law, graph: &Graph) -> f64 {
        let mut least = OPEN;
        for contact in &self.contacts {
            let (block, lane) = lane_of(graph, contact.id);
            let [a, b] = contact
                .ends
                .map(|end| (self.ways[end].v(), self.ways[end].w()));
            let opens = block.along(lane, a, b);
            for (opens, gap) in opens.iter().zip(contact.gaps).take(contact.points) {
                least = least.min(gap + law.h * opens);
            }
        }
        least
    }

    /// What friction turned to heat, in J: by the mean slip of the sub-step.
    pub(super) fn heat(&self, bodies: &Bodies, graph: &Graph) -> f64 {
        let mut heat = 0.0;
        for contact in &self.contacts {
            let (block, lane) = lane_of(graph, contact.id);
            let jt = block.jt[lane];
            if jt.abs() > 0.0 {
                let slip = block.slip(lane, self.ends(bodies, contact)) - contact.belt;
                let before = slip - block.tangent_response(lane, self.ends(bodies, contact)) * jt;
                // What sticks makes no heat, whatever it was pulled by.
                let half = 0.5 * (slip - before);
                heat -= jt * (slip - half.clamp(-slip.abs(), slip.abs()));
            }
        }
        heat
    }
}

/// Speed at which a point opens at least, in m/s: what is apart may close in the sub-step.
pub(super) fn closes(law: &Law, gap: f64) -> f64 {
    if gap > touches(law) {
        -gap * law.inverse_h
    } else {
        0.0
    }
}

fn touches(law: &Law) -> f64 {
    TOUCHES * law.gravity * law.h * law.h
}

/// The mean of the velocities before and after the sub-step, or the latter where that is no smooth change.
fn even_way(bodies: &Bodies, line: u32, h: f64) -> Quad {
    let at = line as usize;
    let (body, start) = (&bodies.lines[at], &bodies.start[at]);
    let before = velocity_before(start, &bodies.pull[at], &bodies.drag[at], h);
    let after = [body.v().x, body.v().y, body.w()];
    let change = [0, 1, 2].map(|k| after[k] - before[k]);
    let own = [0, 1].map(|k| start.0[k] - before[k]);
    let (change_square, own_square) = (
        change[0] * change[0] + change[1] * change[1],
        own[0] * own[0] + own[1] * own[1],
    );
    let part = if change_square <= EVEN * EVEN * own_square {
        0.5
    } else {
        0.0
    };
    let way = [0, 1, 2].map(|k| after[k] - part * change[k]);
    Quad([way[0], way[1], way[2], 0.0])
}
