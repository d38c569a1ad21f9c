//! Who may meet whom: changes from outside, and the look around at the start of a tick.

use carom_math::SimTime;

use super::{REFRESH, Stepped};
use crate::broad::PADDING;
use crate::pairs::Pair;
use crate::{BodyKind, World};

impl World {
    /// Takes a body out of the solver: its rows leave their impulses with the pairs.
    pub(crate) fn leave(&mut self, index: u32, slot: u32) {
        for k in 0..self.bodies.get(index).pairs.len() {
            let place = self.bodies.get(index).pairs[k];
            self.pairs.glance_mut(place).forget();
            self.pool.release(self.pairs.get_mut(place));
        }
        self.pool.seats.dismiss(slot);
        let state = self.bodies.get_mut(index);
        state.has_line = false;
        for at in &state.colliders {
            self.colliders[*at as usize].tight = None;
        }
    }

    /// The look at the start of a tick: whoever moved gets new boxes, and its pairs are looked at.
    pub(super) fn look_around(&mut self, time: SimTime) {
        self.pool.cores.age();
        self.look_at_fresh(time);
        self.pool.looks = (self.pool.looks + 1) % REFRESH;
        if self.pool.looks == 0 {
            self.pool.seats.rig.refresh();
        }
        self.pool.seats.rig.lanes.part_idle();
        self.forget_watched();
        self.pool.stirred = false;
        let tick = self.settings.tick;
        let mut moved = core::mem::take(&mut self.pool.moved);
        let seats = &self.pool.seats;
        for (slot, sent, line) in seats.bound() {
            let leash = sent.leash();
            if sent.speed(line) * tick > leash
                || sent.wandered(line) > leash
                // Courses end, and others count on them.
                || seats.is_on_course(slot)
            {
                moved.push(sent.body);
            }
        }
        moved.sort_unstable();
        moved.dedup();
        let left = self.pool.until_look;
        let mut reboxed = core::mem::take(&mut self.pool.reboxed);
        self.broad.trees.gather();
        for &index in &moved {
            let Some(slot) = self.pool.seats.slot(index) else {
                continue;
            };
            if self.pool.seats.strayed(slot) {
                let places = self.bodies.get(index).pairs.iter();
                let rows = places.flat_map(|place| self.pairs.rows_of(*place));
                self.pool.seats.rebase(slot, rows);
            }
            let boxed = !self.lacks_boxes(index);
            let seats = &mut self.pool.seats;
            seats.send(slot, left);
            let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
            if seat.kind == BodyKind::Kinematic {
                // A flyer: its boxes are its own.
                continue;
            }
            let padding = PADDING * seat.reach;
            let sent = seats.sent(slot);
            let (ahead, leash) = (sent.speed(line) * tick, sent.leash());
            if 2.0 * ahead + leash > padding {
                // The boxes of who would be out of its padding within two ticks are stretched along its way, and asked
                // every time.
                if self.rebox(index, slot, time, tick) {
                    reboxed.push((index, slot));
                }
            } else if !boxed || seat.roamed + ahead + leash > padding {
                // Those of a slow one hold what stays within their padding.
                self.rebox_slow(index, slot, time);
                reboxed.push((index, slot));
            }
        }
        self.broad.trees.settle();
        self.meet_all(&reboxed, time);
        reboxed.clear();
        self.pool.reboxed = reboxed;
        self.stopwatch.lap(|p| &mut p.pairs);
        self.look_at_pairs(&moved, time, true);
        moved.clear();
        self.pool.moved = moved;
        self.stopwatch.lap(|p| &mut p.contacts);
    }

    /// The look between ticks: at the pairs of bodies that are not where they were bound for, and at those whose time
    /// has come.
    pub(super) fn look_between(&mut self, time: SimTime) {
        let mut moved = core::mem::take(&mut self.pool.moved);
        let (left, h) = (self.pool.until_look, self.clock.h);
        if self.pool.stirred {
            self.pool.seats.strays(left, h, &mut moved);
        }
        for &index in &moved {
            let Some(slot) = self.pool.seats.slot(index) else {
                continue;
            };
            self.pool.seats.send(slot, left);
            let kind = self.pool.seats.get(slot).kind;
            if kind == BodyKind::Dynamic && self.rebox(index, slot, time, f64::from(left) * h) {
                self.seek_partners(index, slot, time);
            }
        }
        self.look_at_pairs(&moved, time, false);
        let mut due = self.pairs_due().into_iter();
        self.attend(&mut due, time, false);
        // Once more, now that all pairs that were due are updated.
        self.look_at_pairs(&moved, time, false);
        moved.clear();
        self.pool.moved = moved;
        self.stopwatch.lap(|p| &mut p.contacts);
    }

    /// Whether somebody is to be looked at between ticks.
    pub(super) fn is_restless(&self) -> bool {
        self.pool.stirred || !(self.pool.watched.is_empty() && self.pool.moved.is_empty())
    }

    /// Updates all pairs of these bodies; `parts`: pairs whose boxes parted are dropped.
    pub(super) fn look_at_pairs(&mut self, moved: &[u32], time: SimTime, parts: bool) {
        self.pool.seats.stands.renew();
        // Where most are asked about they are read as they lie, and not in the order in which pairs name them.
        if 2 * moved.len() > self.pool.seats.len() {
            self.pool.seats.take_all_stands();
        }
        let mut round = core::mem::take(&mut self.pool.round);
        round.begin();
        self.note_pairs(&mut round, moved.iter().copied());
        self.attend(&mut round, time, parts);
        self.pool.round = round;
    }
}

impl Stepped {
    /// Takes a pair's rows out of the solver; their impulses stay with the pair.
    pub(crate) fn release(&mut self, pair: &mut Pair) {
        for contact in &mut pair.contacts {
            let Some(id) = contact.row.take() else {
                continue;
            };
            let (j, jt) = self.seats.rig.impulses(id);
            contact.takes(j, jt);
            self.seats.rig.remove(id);
            self.bounces.forget(id);
            pair.fresh = true;
        }
    }
}
