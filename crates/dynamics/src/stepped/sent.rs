//! Where bodies were bound for when they were last asked about, and whether they are off that way.
//!
//! After a blow all are asked this in every sub-step, so what it takes lies side by side, apart from the seats.

use carom_math::Vec2;

use super::relative::swing;
use super::seats::{NONE, Seats};
use super::watch::{LEASH, STRAY};
use crate::solver::Line;

/// How a body moved when it was last asked about.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sent {
    /// Who moves; `u32::MAX`: nobody, or what is fixed.
    pub(super) body: u32,
    /// Sub-steps to the next tick then.
    left: u32,
    /// Displacement and turn then.
    from: (Vec2, f64),
    velocity: Vec2,
    spin: f64,
    /// As its seat has it.
    rim: f64,
    /// Reach of the smallest of itself and those that it was near to, in m.
    finest: f64,
}

impl Sent {
    pub(super) const NOBODY: Self = Self::new(NONE, 0.0, 0.0);

    /// A body that was not asked about yet.
    pub(super) const fn new(body: u32, rim: f64, reach: f64) -> Self {
        Self {
            body,
            left: 0,
            from: (Vec2::ZERO, 0.0),
            velocity: Vec2::ZERO,
            spin: 0.0,
            rim,
            finest: reach,
        }
    }

    pub(super) const fn finest(&self) -> f64 {
        self.finest
    }

    /// It is near one of this reach.
    pub(super) const fn minds(&mut self, size: f64) {
        self.finest = self.finest.min(size);
    }

    /// How far it may move before it is looked at again, in m.
    pub(super) const fn leash(&self) -> f64 {
        LEASH * self.finest
    }

    /// Fastest that a point of it moves, in m/s.
    pub(super) fn speed(&self, line: &Line) -> f64 {
        line.v().length() + swing(self.rim, line.w())
    }

    /// How far it went since it was last asked about, in m, at most.
    pub(super) fn wandered(&self, line: &Line) -> f64 {
        (line.d() - self.from.0).length() + swing(self.rim, line.turn() - self.from.1)
    }

    /// Its base moved to where it is.
    pub(super) const fn rebase(&mut self) {
        self.from = (Vec2::ZERO, 0.0);
    }

    /// Whether it is not where it was bound for, or will not be after a sub-step.
    fn strays(&self, line: &Line, pull: impl Fn() -> Vec2, left: u32, h: f64) -> bool {
        let passed = f64::from(self.left.saturating_sub(left)) * h;
        let off = line.d() - self.from.0 - self.velocity * passed;
        let drift = (line.v() - self.velocity) * h;
        let turned = line.turn() - self.from.1 - self.spin * passed;
        let turned_then = turned + (line.w() - self.spin) * h;
        let far = STRAY * self.finest - swing(self.rim, turned.abs().max(turned_then.abs()));
        let beyond = |off: Vec2, drift: Vec2| {
            let most = off.length_squared().max((off + drift).length_squared());
            most > far * far
        };
        far < 0.0
            || beyond(off, drift) && {
                // What pull adds or a floor holds back is in every margin.
                let pull = pull();
                let fallen = pull * (0.5 * passed * passed);
                beyond(off - fallen, drift - pull * ((passed + 0.5 * h) * h))
            }
    }
}

impl Seats {
    /// Notes how a body moves, so many sub-steps before the next tick, and how far it went since that was noted last.
    pub(super) fn send(&mut self, slot: u32, left: u32) {
        let at = slot as usize;
        let (sent, line) = (&mut self.sent[at], &self.rig.lines[at]);
        self.list[at].roamed += sent.wandered(line);
        *sent = Sent {
            left,
            from: (line.d(), line.turn()),
            velocity: line.v(),
            spin: line.w(),
            ..*sent
        };
    }

    /// How a body moved when it was last asked about.
    pub(super) fn sent(&self, slot: u32) -> &Sent {
        &self.sent[slot as usize]
    }

    /// Whoever moves, with its line, by slot.
    pub(super) fn bound(&self) -> impl Iterator<Item = (u32, &Sent, &Line)> {
        let all = (0u32..).zip(self.sent.iter().zip(&self.rig.lines));
        let all = all.map(|(slot, (sent, line))| (slot, sent, line));
        all.filter(|(_, sent, _)| sent.body != NONE)
    }

    /// Adds those who are not where they were bound for, or will not be after a sub-step.
    pub(super) fn strays(&self, left: u32, h: f64, strays: &mut Vec<u32>) {
        for (slot, sent, line) in self.bound() {
            let pull = || self.rig.pull(slot).acceleration;
            if sent.strays(line, pull, left, h) {
                strays.push(sent.body);
            }
        }
    }
}
