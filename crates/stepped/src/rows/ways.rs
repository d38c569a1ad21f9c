//! How free bodies go through a sub-step: what a caller sees of them within it.

use carom_math::Vec2;

use super::bounce_budget::quotient;
use super::line::{Line, Quad};
use crate::bodies::Bodies;

/// Velocities with which free bodies went through the last sub-step: all impulses acted as it began, and what displaced the bodies and
/// does not last counts. With them momentum and angular momentum are those of before and afterwards.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ways {
    noted: bool,
    /// By slot, in order: velocities with which bodies came to it. What `start` tells of them lacks impulses of impacts.
    came: Vec<(u32, Quad)>,
    /// By line: velocities that displaced the bodies, and where these brought them.
    displaced: Vec<(Quad, Quad)>,
    /// By slot, in order: what these velocities lack of those at the end.
    lack: Vec<(u32, Quad)>,
}

impl Ways {
    /// Notes them from now on, or forgets them.
    pub(crate) fn note(&mut self, noted: bool) {
        self.noted = noted;
        self.came.clear();
        self.lack.clear();
    }

    /// A sub-step begins.
    pub(crate) fn start(&mut self, bodies: &Bodies) {
        self.came.clear();
        if self.noted {
            let came = |(line, slot): (&Line, &u32)| (*slot, Quad::new(line.v(), line.w()));
            let lines = bodies.lines.iter().zip(&bodies.slot_of).skip(2);
            self.came.extend(lines.map(came));
            self.came.sort_unstable_by_key(|came| came.0);
        }
    }

    /// Bodies were displaced by their velocities.
    pub(crate) fn begin(&mut self, bodies: &Bodies) {
        self.displaced.clear();
        self.lack.clear();
        if self.noted && bodies.any_is_free() {
            let displaced = |line: &Line| (Quad::new(line.v(), line.w()), line.displacement());
            self.displaced.extend(bodies.lines.iter().map(displaced));
        }
    }

    /// Bodies have their velocities and displacements of the end of the sub-step, which lasts `h` seconds.
    pub(crate) fn end(&mut self, bodies: &Bodies, h: f64) {
        for ((line, (v, to)), at) in bodies.lines.iter().zip(&self.displaced).zip(0..) {
            if bodies.is_free(at) {
                let (way, turn) = (line.d() - to.v(), line.turn() - to.w());
                let lack = Quad::new(line.v() - v.v() - way / h, line.w() - v.w() - turn / h);
                self.lack.push((bodies.slot_of[at as usize], lack));
            }
        }
        self.lack.sort_unstable_by_key(|lack| lack.0);
    }

    /// Forgets how bodies went through the last sub-step.
    pub(crate) fn forget(&mut self) {
        self.note(self.noted);
    }

    /// A body that goes, or that a caller moves, leaves what its velocity lacks to those that it is in contact with, as a push at its
    /// centre and a turn: all keep the momentum and angular momentum that a caller sees. Each partner gets as large a part as its own
    /// velocity lacks of momentum: what both exchanged is in that.
    pub(crate) fn leave(&mut self, bodies: &mut Bodies, slot: u32, partners: &[u32]) {
        let Ok(known) = self.lack.binary_search_by_key(&slot, |lack| lack.0) else {
            return;
        };
        let lacks = |slot: &u32| {
            let mass = quotient(1.0, bodies.lines[bodies.line_of(*slot)].inverse_mass());
            self.lack(*slot).map_or(0.0, |(v, _)| v.length() * mass)
        };
        let parts: Vec<f64> = partners.iter().map(lacks).collect();
        let sum: f64 = parts.iter().sum();
        if sum <= 0.0 {
            return;
        }
        let lack = core::mem::take(&mut self.lack[known].1);
        let own = &bodies.lines[bodies.line_of(slot)];
        let mass = quotient(1.0, own.inverse_mass());
        let inertia = quotient(1.0, own.inverse_inertia());
        let from = bodies.pose_of(slot).position;
        for (&partner, part) in partners.iter().zip(parts) {
            let part = part / sum;
            let (push, turn) = (lack.v() * (part * mass), lack.w() * (part * inertia));
            let arm = from - bodies.pose_of(partner).position;
            let at = bodies.line_of(partner);
            let line = &mut bodies.lines[at];
            let change = Quad::new(
                push * line.inverse_mass(),
                (turn + arm.perp_dot(push)) * line.inverse_inertia(),
            );
            line.add(&change);
            bodies.start[at].add(&change);
            if let Ok(known) = self.lack.binary_search_by_key(&partner, |lack| lack.0) {
                self.lack[known].1.add(&change);
            }
        }
    }

    pub(crate) fn came(&self, slot: u32) -> Option<(Vec2, f64)> {
        of_slot(&self.came, slot)
    }

    pub(crate) fn lack(&self, slot: u32) -> Option<(Vec2, f64)> {
        of_slot(&self.lack, slot)
    }
}

fn of_slot(all: &[(u32, Quad)], slot: u32) -> Option<(Vec2, f64)> {
    let known = all.binary_search_by_key(&slot, |one| one.0).ok()?;
    let (_, one) = &all[known];
    Some((one.v(), one.w()))
}
