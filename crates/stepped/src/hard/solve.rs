//! One island in hard rows: its velocities, and where they lead.

use carom_impact::{Friction, HeldFace, HeldFaces, HeldPoint, ImpactBody, held_faces, swept_faces};
use carom_math::{Vec2, perp};

use super::conditions::{answers, justified, rest};
use super::islands::Found;
use crate::bodies::Bodies;
use crate::rows::{Graph, Law, OPEN, Quad};
use crate::{ContactIx, LineIx};

/// Gap or overlap that counts as 0, as a part of how far pull moves a body in a sub-step: closing what rounding left open, a column
/// at rest would be solved for in every sub-step.
const TOUCHES: f64 = 1e-6;

/// Solves with given limits of friction where Coulomb's law is not solved.
const LIMITS: usize = 4;

/// A contact of the island.
#[derive(Clone, Debug)]
pub(super) struct HardContact {
    pub(super) id: ContactIx,
    pub(super) belt: f64,
    /// Places of its bodies in the island.
    pub(super) ends: [usize; 2],
    /// Gaps at the beginning of the sub-step, in m: of the points that are there.
    pub(super) gaps: [f64; 2],
    pub(super) points: usize,
}

/// Bodies and contacts of an island in a sub-step.
#[derive(Clone, Debug)]
pub(super) struct Island {
    pub(super) lines: Vec<LineIx>,
    /// With centres at 0: arms are told from there. Pulled, before contacts act.
    pub(super) bodies: Vec<ImpactBody>,
    /// Velocities and spins as the sub-step begins.
    pub(super) came: Vec<(Vec2, f64)>,
    pub(super) contacts: Vec<HardContact>,
    /// The most that pull adds to a speed in the sub-step, in m/s.
    pub(super) pulled: f64,
    /// Faces and centres as the sub-step begins, if all pairs are free.
    pub(super) begun: Option<(Vec<HeldFace>, Vec<Vec2>)>,
    /// It has free pairs: these give back what they are parted by.
    pub(super) gives_back: bool,
    /// Sweeps come near enough: it bears no load that these cannot carry.
    pub(super) is_swept: bool,
    /// Energy as the sub-step begins, in J, with potentials from where the bodies are then, if no driver can add to it.
    pub(super) energy: Option<f64>,
    /// Where they are then, from their bases.
    pub(super) ways: Vec<Quad>,
}

impl Island {
    pub(super) fn of(law: &Law, graph: &Graph, bodies: &Bodies, found: &Found) -> Self {
        let mut island = Self {
            lines: Vec::new(),
            bodies: Vec::new(),
            came: Vec::new(),
            contacts: Vec::with_capacity(found.contacts.len()),
            pulled: 0.0,
            begun: None,
            gives_back: false,
            is_swept: found.is_swept,
            energy: None,
            ways: Vec::new(),
        };
        let mut are_free = true;
        for &id in &found.contacts {
            let (block, cold, lane) = graph.lane(id);
            let gaps = graph.gaps(bodies, id);
            // Hidden ones push nothing.
            let points = if gaps[0] < 0.5 * OPEN {
                block.points(lane)
            } else {
                0
            };
            let lines = block.lines(lane);
            let is_free = lines.iter().all(|line| bodies.is_free(*line));
            are_free &= is_free;
            island.gives_back |= is_free;
            let ends = lines.map(|line| island.place(law, bodies, line));
            island.contacts.push(HardContact {
                id,
                belt: cold.belt[lane],
                ends,
                gaps,
                points,
            });
        }
        let ways = island
            .lines
            .iter()
            .map(|line| bodies.lines[*line].displacement());
        island.ways = ways.collect();
        island.energy = island.energy_before(graph);
        let pulls = island
            .lines
            .iter()
            .map(|line| bodies.pull[*line].v().length());
        island.pulled = law.h * pulls.fold(0.0, f64::max);
        if are_free {
            let centres = island.lines.iter().map(|line| bodies.centre_at(*line));
            island.begun = Some((island.smooth_faces(graph), centres.collect()));
        }
        island
    }

    /// The place of a line, which is new to the island or not.
    fn place(&mut self, law: &Law, bodies: &Bodies, line: LineIx) -> usize {
        if let Some(known) = self.lines.iter().position(|known| *known == line) {
            return known;
        }
        let (body, start) = (&bodies.lines[line], &bodies.start[line]);
        self.came.push(bodies.velocity_before(line, law.h));
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

    /// Lines and states before contacts act of the bodies that these can move.
    pub(super) fn moved(&self) -> impl Iterator<Item = (LineIx, &ImpactBody)> {
        let lines = self.lines.iter().copied().zip(&self.bodies);
        lines.filter(|(_, body)| body.inverse_mass > 0.0)
    }

    /// Gives bodies and rows what holds all contacts; false if nothing was found that does: then rows have no impulses.
    pub(super) fn solve(&mut self, law: &Law, bodies: &mut Bodies, graph: &mut Graph) -> bool {
        self.push(bodies, graph);
        let rest = rest(self, law, graph);
        let mut answered = answers(self, law, bodies, graph, rest) && justified(self, bodies);
        if !answered && let Some(impulses) = self.hold(law, graph) {
            self.set_impulses(graph, impulses);
            self.push(bodies, graph);
            answered = justified(self, bodies);
        }
        if answered {
            self.settle(bodies, rest);
        } else {
            // What is squeezed pushes by any impulses: sweeps would begin with these.
            self.set_impulses(graph, vec![[0.0; 3]; self.contacts.len()]);
            self.push(bodies, graph);
        }
        answered
    }

    fn set_impulses(&self, graph: &mut Graph, impulses: Vec<[f64; 3]>) {
        for (contact, impulses) in self.contacts.iter().zip(impulses) {
            let (block, lane) = graph.block_mut(contact.id);
            block.set_impulses(lane, impulses);
        }
    }

    /// Takes out what rounding left of the velocities of bodies at rest: with it each sub-step would need other impulses.
    fn settle(&self, bodies: &mut Bodies, rest: f64) {
        for &line in &self.lines {
            let body = &mut bodies.lines[line];
            let (v, w) = (body.v(), body.w());
            let turns = w.abs() * bodies.limits[line].reach;
            if body.inverse_mass() > 0.0 && v.x.abs().max(v.y.abs()) + turns <= rest {
                body.set_velocity(Vec2::ZERO, 0.0);
                // The warm start stays.
                bodies.start[line].add(&Quad::new(-v, -w));
            }
        }
    }

    /// Gives bodies what their rows do.
    fn push(&self, bodies: &mut Bodies, graph: &Graph) {
        for (&line, body) in self.lines.iter().zip(&self.bodies) {
            bodies.lines[line].set_velocity(body.velocity, body.spin);
        }
        for contact in &self.contacts {
            let (block, _, lane) = graph.lane(contact.id);
            let pushes = block.push(lane, &bodies.lines);
            for (end, push) in contact.ends.into_iter().zip(&pushes) {
                bodies.lines[self.lines[end]].add(push);
            }
        }
    }

    /// Impulses of all faces that hold them. Where no pivots end at such, limits of friction are given: none, then what the impulses
    /// found allow, and so on. No point closes, but what rubs may do so by a little more or less than Coulomb says.
    fn hold(&self, law: &Law, graph: &Graph) -> Option<Vec<[f64; 3]>> {
        let mu = |contact: &HardContact| {
            let (block, _, lane) = graph.lane(contact.id);
            block.mu[lane]
        };
        let opens = |gap: f64| self.closes(law, gap);
        let coulomb = |_: usize, contact: &HardContact| Friction::Coulomb(mu(contact));
        let held = self.held(&self.bodies, &self.faces(graph, opens, coulomb));
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

    /// What holds these faces of the island's bodies.
    pub(super) fn held(&self, bodies: &[ImpactBody], faces: &[HeldFace]) -> HeldFaces {
        if self.is_swept {
            swept_faces(bodies, faces)
        } else {
            held_faces(bodies, faces)
        }
    }

    /// What is asked of each face, from its gaps.
    pub(super) fn faces(
        &self,
        graph: &Graph,
        opens: impl Fn(f64) -> f64,
        rubs: impl Fn(usize, &HardContact) -> Friction,
    ) -> Vec<HeldFace> {
        let face = |(k, contact): (usize, &HardContact)| {
            let (block, _, lane) = graph.lane(contact.id);
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

    /// The least gap where the bodies are now, in m; gaps are those there.
    pub(super) fn least_gap(&mut self, bodies: &Bodies, graph: &Graph) -> f64 {
        let mut least = OPEN;
        for contact in &mut self.contacts {
            contact.gaps = graph.gaps(bodies, contact.id);
            for gap in &contact.gaps[..contact.points] {
                least = least.min(*gap);
            }
        }
        least
    }

    /// Gap or overlap that counts as 0, in m.
    pub(super) fn touches(&self, law: &Law) -> f64 {
        TOUCHES * self.pulled * law.h
    }

    /// Speed at which a point opens at least, in m/s: what is apart may close in the sub-step.
    pub(super) fn closes(&self, law: &Law, gap: f64) -> f64 {
        if gap > self.touches(law) {
            -gap * law.inverse_h
        } else {
            0.0
        }
    }

    /// What friction turned to heat, in J: by the mean slip of the sub-step, as far as friction opposes it. What only pull or other
    /// contacts would have made slip makes none.
    pub(super) fn heat(&self, bodies: &Bodies, graph: &Graph) -> f64 {
        let of = |contact: &HardContact| {
            let (block, _, lane) = graph.lane(contact.id);
            let [a, b] = contact.ends.map(|end| self.came[end]);
            let slips = [block.across(lane, a, b), block.slip(lane, &bodies.lines)];
            let rubbed = slips.map(|slip| (block.jt[lane] * (slip - contact.belt)).min(0.0));
            -0.5 * (rubbed[0] + rubbed[1])
        };
        self.contacts.iter().map(of).sum()
    }
}
