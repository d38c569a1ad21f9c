//! Several sub-steps at once, zone by zone, where nothing comes up in them.
//!
//! A zone that goes through all of them at once reads its rows from memory once, and not in each sub-step. What comes up in
//! one, as somebody who is met with a speed, the others must know of before the next: then all zones go back to where they
//! were, and nothing has happened.

use carom_math::Vec2;
use fearless_simd::Level;

use super::Rig;
use super::substep::Work;
use crate::solver::Law;
use crate::solver::coast::{self, Quad};
use crate::solver::kernel::Pass;
use crate::solver::wide::{LANES, Line};
use crate::solver::zone::Zone;

/// What a zone was before it went ahead, and what it tells of that.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ahead {
    lines: Vec<Line>,
    start: Vec<Quad>,
    /// Of each block: those of both points, and of friction.
    impulses: Vec<[[f64; LANES]; 3]>,
    /// What friction turned into heat in each sub-step, in J.
    heats: Vec<f64>,
}

impl Rig {
    /// So many sub-steps in which nobody bounces, with the bits of one after the other; `false`: something comes up in them, and
    /// nothing has changed.
    pub(crate) fn step_ahead(&mut self, law: &Law, count: u32) -> bool {
        debug_assert!(self.may_go_ahead(), "zones know all that moves");
        let (level, pass) = (self.level, self.relaxing());
        self.follow();
        self.in_zones(|work| work.go_ahead(level, law, pass, count));
        let zones = &self.lanes.zones[1..];
        if zones.iter().any(|zone| zone.met) {
            self.in_zones(|work| work.go_back());
            return false;
        }
        for k in 0..count as usize {
            for zone in &self.lanes.zones[1..] {
                self.heat += zone.ahead.heats[k];
            }
        }
        true
    }

    /// Whether all that moves is in zones, no row crosses from one to another, and nobody waits for the next sub-step.
    pub(crate) fn may_go_ahead(&self) -> bool {
        let (first, last) = self.lanes.zoned();
        let stands =
            |line: &Line| line.inverse_mass() == 0.0 && line.v() == Vec2::ZERO && line.w() == 0.0;
        first < last
            && self.lanes.loose() == 0
            && !self.met
            && self.bounced.is_empty()
            // The first line serves empty lanes.
            && self.lines[1..first].iter().chain(&self.lines[last..]).all(stands)
    }
}

impl Work<'_> {
    fn go_ahead(&mut self, level: Level, law: &Law, pass: Pass, count: u32) {
        self.keep();
        for _ in 0..count {
            coast::pull_and_warm(level, &mut self.bodies, law.h);
            self.solve(level, law);
            self.displace(level, law);
            if self.zone.met {
                return;
            }
            self.relax(level, law, pass);
            let heat = core::mem::take(&mut self.zone.heat);
            self.zone.ahead.heats.push(heat);
            coast::second_order(level, &mut self.bodies, law.h);
        }
    }

    fn keep(&mut self) {
        let Zone { colours, ahead, .. } = &mut *self.zone;
        ahead.lines.clear();
        ahead.lines.extend_from_slice(self.bodies.lines);
        ahead.start.clear();
        ahead.start.extend_from_slice(self.bodies.start);
        ahead.impulses.clear();
        let blocks = colours.iter().flatten();
        ahead
            .impulses
            .extend(blocks.map(|wide| [wide.j1, wide.j2, wide.jt]));
        ahead.heats.clear();
    }

    fn go_back(&mut self) {
        let Zone {
            colours,
            ahead,
            met,
            ..
        } = &mut *self.zone;
        self.bodies.lines.copy_from_slice(&ahead.lines);
        self.bodies.start.copy_from_slice(&ahead.start);
        for (wide, kept) in colours.iter_mut().flatten().zip(&ahead.impulses) {
            [wide.j1, wide.j2, wide.jt] = *kept;
        }
        *met = false;
    }
}
