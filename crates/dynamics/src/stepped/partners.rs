//! Partners of bodies that got new boxes: whom they may meet on their courses, and whom no more.

use carom_math::SimTime;

use super::courses::Goer;
use super::throng::Member;
use crate::broad::misses;
use crate::trees::Leaf;
use crate::{PairSearch, World};

/// Up to so many pairs of a body are held against all who are near; of more the other body knows better.
const FEW: usize = 16;

/// From so many new boxes on those on their courses are laid out side by side, and not searched in their tree.
const MANY: usize = 32;

impl World {
    /// Whether the boxes that a pair was found with still overlap.
    pub(super) fn keeps(&self, place: u32) -> bool {
        let pair = self.pairs.get(place);
        let ends = [pair.colliders.0, pair.colliders.1].map(|at| &self.colliders[at as usize]);
        self.broad.keeps(&self.colliders, pair) && !misses(ends[0], ends[1])
    }

    /// Partners of all who got new boxes at `time`.
    pub(super) fn meet_all(&mut self, reboxed: &[(u32, u32)], time: SimTime) {
        let at_once = reboxed.len() >= MANY && self.broad.search == PairSearch::Indexed;
        if at_once {
            self.lay_out_throng(time);
        } else {
            self.pool.throng.clear();
        }
        for &(index, slot) in reboxed {
            self.seek_partners(index, slot, time, at_once);
        }
    }

    /// Boxes of all bodies that are on their courses side by side.
    fn lay_out_throng(&mut self, time: SimTime) {
        let mut throng = core::mem::take(&mut self.pool.throng);
        let moving = self.pool.seats.moving();
        let shapes = moving
            .filter(|(_, seat)| seat.is_on_course())
            .flat_map(|(slot, seat)| {
                let shapes = &self.bodies.get(seat.body).colliders;
                shapes.iter().map(move |at| (slot, *at))
            });
        let large = throng.lay_out(shapes.filter_map(|(slot, at)| {
            let collider = &self.colliders[at as usize];
            let goer = self.goer(slot, at, time)?;
            let fat = collider.fat;
            matches!(collider.node, Some(Leaf::OnCourse(_))).then_some(Member { fat, goer })
        }));
        self.pool.throng = throng;
        for at in large {
            let fat = self.colliders[at as usize].fat;
            self.broad.put(&mut self.colliders, at, fat, time, false);
        }
        let mut throng = core::mem::take(&mut self.pool.throng);
        throng.seek(|mine, other| self.may_meet(mine, other));
        self.pool.throng = throng;
    }

    /// Parts the pairs of a body that cannot meet as both go now, and finds new ones; `at_once`: all who are on their
    /// courses lie in the throng, and seek their partners in order of bodies.
    pub(super) fn seek_partners(&mut self, index: u32, slot: u32, time: SimTime, at_once: bool) {
        if self.broad.search == PairSearch::Indexed {
            let mut known = core::mem::take(&mut self.pool.known);
            known.clear();
            self.part_off_course(index, slot, time, at_once, &mut known);
            for k in 0..self.bodies.get(index).colliders.len() {
                let at = self.bodies.get(index).colliders[k];
                self.meet_on_course(slot, at, time, at_once, &known);
            }
            self.pool.known = known;
        } else {
            for k in 0..self.bodies.get(index).colliders.len() {
                let at = self.bodies.get(index).colliders[k];
                let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
                self.broad.meet(bodies, &self.colliders, pairs, at, None);
            }
        }
    }

    /// Lets the pairs of a body go whose shapes cannot meet while both keep their courses; the others are `known`, its
    /// own shape first.
    fn part_off_course(
        &mut self,
        index: u32,
        slot: u32,
        time: SimTime,
        at_once: bool,
        known: &mut Vec<(u32, u32)>,
    ) {
        let first = self.bodies.get(index).colliders.first();
        let own = first.and_then(|at| self.goer(slot, *at, time));
        let mut i = 0;
        while i < self.bodies.get(index).pairs.len() {
            let place = self.bodies.get(index).pairs[i];
            let pair = self.pairs.get(place);
            let (a, b) = pair.colliders;
            let (mine, other, partner) = if pair.bodies.0 == index {
                (a, b, pair.bodies.1)
            } else {
                (b, a, pair.bodies.0)
            };
            if self.broad.keeps(&self.colliders, pair)
                && self.may_go_on((mine, other), (own.as_ref(), slot), partner, time, at_once)
            {
                known.push((mine, other));
                i += 1;
            } else {
                self.part(place, time);
            }
        }
    }

    /// Whether the shapes of a pair may meet while both bodies keep their courses.
    fn may_go_on(
        &self,
        (mine, other): (u32, u32),
        (own, slot): (Option<&Goer>, u32),
        partner: u32,
        time: SimTime,
        at_once: bool,
    ) -> bool {
        let of_mine;
        let own = if own.is_some_and(|own| own.at == mine) {
            own
        } else {
            of_mine = self.goer(slot, mine, time);
            of_mine.as_ref()
        };
        let (Some(own), Some(partner_slot)) = (own, self.pool.seats.slot(partner)) else {
            return true;
        };
        if at_once
            && let Some(partners) = self.pool.throng.partners(mine)
            && let Some(theirs) = self.pool.throng.goer(other)
        {
            // Of two who set out together the first one saw to it.
            return !own.looks_for(theirs) || partners.contains(&other);
        }
        let other = self.goer(partner_slot, other, time);
        other.is_none_or(|other| self.may_meet(own, &other))
    }

    /// New pairs of a shape whose box is new.
    fn meet_on_course(
        &mut self,
        slot: u32,
        at: u32,
        time: SimTime,
        at_once: bool,
        known: &[(u32, u32)],
    ) {
        let mut near = core::mem::take(&mut self.pool.near);
        let fat = self.colliders[at as usize].fat;
        let mine = self.goer(slot, at, time);
        let few = if known.len() > FEW { &[] } else { known };
        let is_known = |other: u32| few.contains(&(at, other));
        let comes = |other: &Goer| mine.as_ref().is_none_or(|mine| self.may_meet(mine, other));
        let may_come = |other: u32| {
            !is_known(other) && self.goer_of(other, time).is_none_or(|other| comes(&other))
        };
        if at_once {
            near.clear();
            self.broad.search_still(&self.colliders, fat, &mut near);
            near.retain(|other| may_come(*other));
            if let Some(partners) = self.pool.throng.partners(at) {
                near.extend(partners.iter().filter(|other| !is_known(**other)));
            } else {
                let owner = self.colliders[at as usize].body;
                let sets_out = mine.as_ref().filter(|mine| mine.sets_out);
                self.pool.throng.query(fat, |other| {
                    let is_asked = sets_out.is_some_and(|mine| other.looks_for(mine));
                    if other.body != owner && !is_asked && !is_known(other.at) && comes(other) {
                        near.push(other.at);
                    }
                });
            }
            near.sort_unstable();
        } else {
            self.broad.search_tree(&self.colliders, fat, &mut near);
            near.retain(|other| may_come(*other));
        }
        for &other in &near {
            let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
            self.broad
                .pair_up(bodies, &self.colliders, pairs, at, other);
        }
        self.pool.near = near;
    }
}
