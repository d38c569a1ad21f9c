//! A sub-step: zone by zone, and over all lines what crosses from one to another.
//!
//! ```text
//! in zones        warm, solve ─┐           ┌─ displace, relax ─┐         ┌─ second order
//! over all lines               └─ solve ───┘                   └─ relax ─┘
//! ```
//! Where no row crosses from zone to zone and nobody bounces, all of it is one piece, zone by zone. What a zone does depends on nothing but itself, so neither threads nor their number change a bit.

use fearless_simd::Level;

use super::Rig;
use crate::solver::Law;
use crate::solver::coast::{self, Bodies};
use crate::solver::kernel::{Pass, sweep};
use crate::solver::zone::Zone;

/// Nobody bounces.
#[cfg(test)]
pub(crate) const NOBODY: Option<fn(&mut Rig)> = None;

/// Some bodies in one stretch, and the rows among them.
pub(super) struct Work<'a> {
    pub(super) bodies: Bodies<'a>,
    pub(super) zone: &'a mut Zone,
}

impl Work<'_> {
    pub(super) fn solve(&mut self, level: Level, law: &Law) {
        let Zone { colours, met, .. } = &mut *self.zone;
        *met = false;
        sweep(level, Pass::Solve, law, self.bodies.lines, colours, met);
    }

    pub(super) fn displace(&mut self, level: Level, law: &Law) {
        coast::displace(level, &mut self.bodies, law.h);
    }

    pub(super) fn relax(&mut self, level: Level, law: &Law, pass: Pass) {
        let Zone { colours, met, .. } = &mut *self.zone;
        self.zone.heat += sweep(level, pass, law, self.bodies.lines, colours, met);
    }
}

/// Calls `f` with each of them: in parallel within a thread pool, else one after the other.
#[cfg(feature = "parallel")]
fn each<T: Send>(items: &mut [T], f: impl Fn(&mut T) + Send + Sync) {
    use rayon::prelude::*;
    if items.len() > 1 && rayon::current_thread_index().is_some() {
        items.par_iter_mut().with_max_len(1).for_each(f);
    } else {
        items.iter_mut().for_each(f);
    }
}

#[cfg(not(feature = "parallel"))]
fn each<T>(items: &mut [T], f: impl Fn(&mut T)) {
    items.iter_mut().for_each(f);
}

impl Rig {
    /// One sub-step. Displacements grow by it; rows are read where they are.
    ///
    /// `bounce` may change velocities before displacements are made of second order.
    pub(crate) fn step(&mut self, law: &Law, bounce: Option<impl FnOnce(&mut Self)>) {
        let (level, h, pass) = (self.level, law.h, self.relaxing());
        self.forget_bounces();
        self.follow();
        // Where no row crosses from zone to zone nothing has to wait for anything.
        let alone = self.lanes.loose() == 0;
        let in_one = alone && bounce.is_none();
        self.in_zones(|work| {
            coast::pull_and_warm(level, &mut work.bodies, h);
            work.solve(level, law);
            if alone {
                work.displace(level, law);
                work.relax(level, law, pass);
            }
            if in_one {
                coast::second_order(level, &mut work.bodies, h);
            }
        });
        self.outside(|bodies| coast::pull_and_warm(level, bodies, h));
        self.over_all(|work| work.solve(level, law));
        self.outside(|bodies| coast::displace(level, bodies, h));
        if !alone {
            self.in_zones(|work| work.displace(level, law));
            self.in_zones(|work| work.relax(level, law, pass));
            self.over_all(|work| work.relax(level, law, pass));
        }
        self.collect();
        if let Some(bounce) = bounce {
            bounce(self);
        }
        if !in_one {
            self.in_zones(|work| coast::second_order(level, &mut work.bodies, h));
        }
        self.outside(|bodies| coast::second_order(level, bodies, h));
    }

    /// How rows relax.
    pub(super) const fn relaxing(&self) -> Pass {
        if self.lanes.has_belts() {
            Pass::RelaxBelts
        } else {
            Pass::Relax
        }
    }

    /// Doubles are where their masters are.
    pub(super) fn follow(&mut self) {
        for zone in &self.lanes.zones {
            for &(master, double) in &zone.doubles {
                let (from, to) = (master as usize, double as usize);
                self.lines[to] = self.lines[from];
                self.start[to] = self.start[from];
                self.pull[to] = self.pull[from];
            }
        }
    }

    /// What zones tell of a sub-step, in their order.
    fn collect(&mut self) {
        let (over_all, zones) = self.lanes.zones.split_at_mut(1);
        self.met = false;
        for zone in zones.iter_mut().chain(over_all) {
            self.heat += core::mem::take(&mut zone.heat);
            self.met |= zone.met;
        }
    }

    /// For every zone, with the bodies in it.
    pub(super) fn in_zones(&mut self, f: impl Fn(&mut Work<'_>) + Send + Sync) {
        let (first, last) = self.lanes.zoned();
        let (bodies, _) = bodies_of(&mut self.lines, &mut self.start, &self.pull).split_at(last);
        let (_, mut rest) = bodies.split_at(first);
        let zones = &mut self.lanes.zones[1..];
        let mut works = Vec::with_capacity(zones.len());
        for zone in zones {
            let (bodies, others) = rest.split_at(zone.count as usize);
            rest = others;
            works.push(Work { bodies, zone });
        }
        // Zones that were swept last are in the cache yet.
        self.back = !self.back;
        if self.back {
            works.reverse();
        }
        each(&mut works, f);
    }

    /// With all lines, for the rows that know them.
    fn over_all(&mut self, f: impl Fn(&mut Work<'_>)) {
        let bodies = bodies_of(&mut self.lines, &mut self.start, &self.pull);
        let zone = &mut self.lanes.zones[0];
        f(&mut Work { bodies, zone });
    }

    /// For bodies in no zone.
    fn outside(&mut self, f: impl Fn(&mut Bodies<'_>)) {
        let (first, last) = self.lanes.zoned();
        let bodies = bodies_of(&mut self.lines, &mut self.start, &self.pull);
        let (bodies, mut tail) = bodies.split_at(last);
        let (mut head, _) = bodies.split_at(first);
        f(&mut head);
        f(&mut tail);
    }
}

fn bodies_of<'a>(
    lines: &'a mut [super::Line],
    start: &'a mut [super::Quad],
    pull: &'a [super::Quad],
) -> Bodies<'a> {
    Bodies { lines, start, pull }
}
