//! How free bodies go through a sub-step: what a caller sees of them within it.

use carom_math::Vec2;

use super::line::{Line, Quad, quotient};
use super::shifted::Shifted;
use crate::bodies::Bodies;
use crate::{BodyIx, LineIx};

/// Velocities with which free bodies went through the last sub-step: all impulses acted as it began, and what displaced the bodies and
/// does not last counts. With them momentum and angular momentum are those of before and afterwards.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ways {
    noted: bool,
    /// By slot, in order: velocities with which bodies came to it. What `start` tells of them lacks impulses of impacts.
    came: Vec<(BodyIx, Quad)>,
    /// By line: velocities that displaced the bodies, and where these brought them.
    displaced: Vec<(Quad, Quad)>,
    /// By slot, in order.
    lack: Vec<(BodyIx, Lack)>,
    /// Slots of pairs that continuous collision shifted.
    met: Vec<[BodyIx; 2]>,
}

/// What the velocity on the way through a sub-step lacks of that at its end.
#[derive(Clone, Copy, Debug, Default)]
struct Lack {
    /// As the sub-step begins.
    begin: Quad,
    /// By how much more its spin lacks as it ends, in rad/s.
    twist: f64,
    /// Angular momentum that the way adds since it leads elsewhere than the velocity tells, in kg m²/s.
    drift: f64,
}

impl Lack {
    /// Once this part of the sub-step has passed.
    fn at(&self, passed: f64) -> (Vec2, f64) {
        (self.begin.v(), self.begin.w() + self.twist * passed)
    }
}

impl Ways {
    /// Notes them from now on, or forgets them.
    pub(crate) fn note(&mut self, noted: bool) {
        self.noted = noted;
        self.came.clear();
        self.lack.clear();
        self.met.clear();
    }

    /// A sub-step begins.
    pub(crate) fn start(&mut self, bodies: &Bodies) {
        self.came.clear();
        if self.noted {
            let came = |(line, slot): (&Line, &BodyIx)| (*slot, Quad::new(line.v(), line.w()));
            let lines = bodies.lines.iter().zip(&bodies.slot_of).skip(2);
            self.came.extend(lines.map(came));
            self.came.sort_unstable_by_key(|came| came.0);
        }
    }

    /// Bodies were displaced by their velocities.
    pub(crate) fn begin(&mut self, bodies: &Bodies) {
        self.displaced.clear();
        self.lack.clear();
        self.met.clear();
        if self.noted && bodies.any_is_free() {
            let displaced = |line: &Line| (Quad::new(line.v(), line.w()), line.displacement());
            self.displaced.extend(bodies.lines.iter().map(displaced));
        }
    }

    /// Bodies have their velocities and displacements of the end of the sub-step, which lasts `h` seconds.
    pub(crate) fn end(&mut self, bodies: &Bodies, h: f64) {
        for (at, (v, to)) in (0..).map(LineIx).zip(&self.displaced) {
            if bodies.is_free(at) {
                let line = &bodies.lines[at];
                let (way, turn) = (line.d() - to.v(), line.turn() - to.w());
                let lack = Lack {
                    begin: Quad::new(line.v() - v.v() - way / h, line.w() - v.w() - turn / h),
                    ..Lack::default()
                };
                self.lack.push((bodies.slot_of[at], lack));
            }
        }
        self.lack.sort_unstable_by_key(|lack| lack.0);
    }

    /// Continuous collision `shifted` free bodies, and `added` to their velocities what gives their angular momentum back. On the way
    /// they go elsewhere than their velocities tell: the spins of both of a pair change evenly by what that adds.
    pub(crate) fn shift(&mut self, bodies: &Bodies, added: &[(LineIx, Quad)], shifted: &[Shifted]) {
        let slot = |line: LineIx| bodies.slot_of[line];
        for (line, added) in added {
            if let Some(lack) = self.lack_mut(slot(*line)) {
                lack.begin.add(added);
            }
        }
        for (lines, shifts) in shifted {
            let (mut sum, mut inertia) = (0.0, 0.0);
            for (line, shift) in lines.iter().zip(shifts) {
                let known = &bodies.lines[*line];
                inertia += known.inertia();
                if let Some(lack) = self.lack_mut(slot(*line)) {
                    let v = known.v() - lack.begin.v();
                    let adds = quotient(shift.perp_dot(v), known.inverse_mass());
                    lack.drift += adds;
                    sum += adds;
                }
            }
            for line in lines {
                let turns = bodies.lines[*line].inverse_inertia() > 0.0;
                if let Some(lack) = self.lack_mut(slot(*line)).filter(|_| turns) {
                    lack.twist += sum / inertia;
                }
            }
            self.met.push(lines.map(slot));
        }
    }

    /// What continuous collision shifted a body against, by slot.
    pub(crate) fn met(&self, slot: BodyIx) -> impl Iterator<Item = BodyIx> + '_ {
        let other = move |pair: &[BodyIx; 2]| {
            let side = pair.iter().position(|one| *one == slot)?;
            Some(pair[1 - side])
        };
        self.met.iter().filter_map(other)
    }

    /// Forgets how bodies went through the last sub-step.
    pub(crate) fn forget(&mut self) {
        self.note(self.noted);
    }

    /// Some bodies go, or a caller moves them, once a part of the sub-step has passed: the `others` that contacts connect with them go on as
    /// they are seen, with all momentum and angular momentum.
    pub(crate) fn leave(
        &mut self,
        bodies: &mut Bodies,
        (slots, others): (&[BodyIx], &[BodyIx]),
        passed: f64,
    ) {
        for &other in others {
            if let Some(lack) = self.lack_mut(other).map(core::mem::take) {
                let (v, w) = lack.at(1.0);
                push(bodies, other, -v, -w);
            }
        }
        for &slot in slots {
            if let Some(left) = self.lack_mut(slot).map(core::mem::take) {
                self.leave_rest(bodies, slot, &left, 1.0 - passed);
            }
        }
    }

    /// From here on the way of a body leads where its velocity tells: what it was to add yet is not given back by the spins of what it
    /// met.
    fn leave_rest(&self, bodies: &mut Bodies, slot: BodyIx, left: &Lack, part: f64) {
        let inertia = |slot: BodyIx| bodies.lines[bodies.line_of(slot)].inertia();
        let rest = (left.drift - left.twist * inertia(slot)) * part;
        let mut met: Vec<BodyIx> = self.met(slot).collect();
        met.retain(|slot| inertia(*slot) > 0.0);
        let whole: f64 = met.iter().map(|slot| inertia(*slot)).sum();
        if rest != 0.0 {
            for slot in met {
                push(bodies, slot, Vec2::ZERO, rest / whole);
            }
        }
    }

    pub(crate) fn came(&self, slot: BodyIx) -> Option<(Vec2, f64)> {
        let known = self.came.binary_search_by_key(&slot, |came| came.0).ok()?;
        let (_, came) = &self.came[known];
        Some((came.v(), came.w()))
    }

    /// Whether it is known how a body went through the last sub-step.
    pub(crate) fn knows(&self, slot: BodyIx) -> bool {
        self.lack(slot).is_some()
    }

    /// What the velocity of a body on its way lacks of that at the end of the sub-step, as it begins and as it ends.
    pub(crate) fn lack(&self, slot: BodyIx) -> Option<[(Vec2, f64); 2]> {
        let known = self.lack.binary_search_by_key(&slot, |lack| lack.0).ok()?;
        Some([0.0, 1.0].map(|passed| self.lack[known].1.at(passed)))
    }

    fn lack_mut(&mut self, slot: BodyIx) -> Option<&mut Lack> {
        let known = self.lack.binary_search_by_key(&slot, |lack| lack.0).ok()?;
        Some(&mut self.lack[known].1)
    }
}

/// Changes the velocity of a body that is awake.
fn push(bodies: &mut Bodies, slot: BodyIx, v: Vec2, w: f64) {
    let line = bodies.records[slot].line;
    bodies.push(line, &Quad::new(v, w));
    bodies.note_change(line);
}
