//! Partners of bodies that got new boxes: whom they may meet on their courses, and whom no more.

use carom_math::SimTime;

use super::courses::Goer;
use super::throng::Member;
use crate::broad::misses;
use crate::trees::Leaf;
use crate::{PairSearch, World};

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
    }

    /// Parts the pairs of a body that cannot meet as both go now, and finds new ones; `at_once`: all who are on their
    /// courses lie in the throng.
    pub(super) fn seek_partners(&mut self, index: u32, slot: u32, time: SimTime, at_once: bool) {
        if self.broad.search == PairSearch::Indexed {
            self.part_off_course(index, slot, time);
        }
        for k in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[k];
            if self.broad.search == PairSearch::Indexed {
                self.meet_on_course(slot, at, time, at_once);
            } else {
                let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
                self.broad.meet(bodies, &self.colliders, pairs, at, None);
            }
        }
    }

    /// Lets the pairs of a body go whose shapes cannot meet while both keep their courses.
    fn part_off_course(&mut self, index: u32, slot: u32, time: SimTime) {
        let first = self.bodies.get(index).colliders.first();
        let own = first.and_then(|at| self.goer(slot, *at, time));
        let mut i = 0;
        while i < self.bodies.get(index).pairs.len() {
            let place = self.bodies.get(index).pairs[i];
            let pair = self.pairs.get(place);
            let (a, b) = pair.colliders;
            let (mine, other) = if pair.bodies.0 == index {
                (a, b)
            } else {
                (b, a)
            };
            let meet = || {
                let own = own
                    .filter(|own| own.at == mine)
                    .or_else(|| self.goer(slot, mine, time));
                let Some((own, other)) = own.zip(self.goer_of(other, time)) else {
                    return true;
                };
                self.may_meet(&own, &other)
            };
            if self.broad.keeps(&self.colliders, pair) && meet() {
                i += 1;
            } else {
                self.part(place, time);
            }
        }
    }

    /// New pairs of a shape whose box is new.
    fn meet_on_course(&mut self, slot: u32, at: u32, time: SimTime, at_once: bool) {
        let mut near = core::mem::take(&mut self.pool.near);
        let fat = self.colliders[at as usize].fat;
        let mine = self.goer(slot, at, time);
        let comes = |other: &Goer| mine.as_ref().is_none_or(|mine| self.may_meet(mine, other));
        if at_once {
            near.clear();
            self.broad.search_still(&self.colliders, fat, &mut near);
            near.retain(|other| self.goer_of(*other, time).is_none_or(|other| comes(&other)));
            let owner = self.colliders[at as usize].body;
            self.pool.throng.query(fat, |member| {
                let other = &member.goer;
                // Of two who set out together the first looks for the other.
                let looks =
                    mine.is_some_and(|mine| mine.sets_out) && other.sets_out && other.body < owner;
                if other.body != owner && !looks && comes(other) {
                    near.push(other.at);
                }
            });
            near.sort_unstable();
            near.dedup();
        } else {
            self.broad.search_tree(&self.colliders, fat, &mut near);
            near.retain(|other| self.goer_of(*other, time).is_none_or(|other| comes(&other)));
        }
        for &other in &near {
            let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
            self.broad
                .pair_up(bodies, &self.colliders, pairs, at, other);
        }
        self.pool.near = near;
    }
}
