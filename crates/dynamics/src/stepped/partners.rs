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
        let (one, two) = self.pairs.shapes(place);
        self.broad.keeps(&self.colliders, (one, two))
            && !misses(&self.colliders[one as usize], &self.colliders[two as usize])
    }

    /// Partners of all who got new boxes at `time`.
    pub(super) fn meet_all(&mut self, reboxed: &[(u32, u32)], time: SimTime) {
        if reboxed.len() < MANY || self.broad.search != PairSearch::Indexed {
            self.pool.throng.clear();
            for &(index, slot) in reboxed {
                self.seek_partners(index, slot, time);
            }
            return;
        }
        self.lay_out_throng(time);
        self.part_off_courses(reboxed, time);
        for &(index, slot) in reboxed {
            for k in 0..self.bodies.get(index).colliders.len() {
                let at = self.bodies.get(index).colliders[k];
                self.meet_in_throng(slot, at, time);
            }
        }
    }

    /// Boxes of all bodies that are on their courses side by side.
    fn lay_out_throng(&mut self, time: SimTime) {
        let mut throng = core::mem::take(&mut self.pool.throng);
        let moving = self.pool.seats.moving();
        let shapes = moving
            .filter(|(slot, _)| self.pool.seats.is_on_course(*slot))
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

    /// Lets the pairs of all who got new boxes go whose shapes cannot meet while both keep their courses; the throng
    /// knows the others.
    fn part_off_courses(&mut self, reboxed: &[(u32, u32)], time: SimTime) {
        let mut round = core::mem::take(&mut self.pool.round);
        let mut throng = core::mem::take(&mut self.pool.throng);
        let mut gone = core::mem::take(&mut self.pool.near);
        round.begin();
        self.note_pairs(&mut round, reboxed.iter().map(|(index, _)| *index));
        gone.clear();
        gone.extend(round.by_ref().filter(|&place| {
            let recognised = throng.recognises(self.pairs.shapes(place));
            !recognised.unwrap_or_else(|| self.may_go_on(place, time))
        }));
        for &place in &gone {
            self.part(place, time);
        }
        self.pool.near = gone;
        self.pool.throng = throng;
        self.pool.round = round;
    }

    /// Parts the pairs of a body that cannot meet as both go now, and finds new ones.
    pub(super) fn seek_partners(&mut self, index: u32, slot: u32, time: SimTime) {
        if self.broad.search == PairSearch::Indexed {
            let mut i = 0;
            while let Some(&place) = self.bodies.get(index).pairs.get(i) {
                if self.may_go_on(place, time) {
                    i += 1;
                } else {
                    self.part(place, time);
                }
            }
        }
        for k in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[k];
            if self.broad.search == PairSearch::Indexed {
                self.meet_on_course(slot, at, time);
            } else {
                let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
                self.broad.meet(bodies, &self.colliders, pairs, at, None);
            }
        }
    }

    /// Whether the shapes of a pair may meet while both bodies keep their courses.
    fn may_go_on(&self, place: u32, time: SimTime) -> bool {
        let (one, two) = self.pairs.shapes(place);
        if !self.broad.keeps(&self.colliders, (one, two)) {
            return false;
        }
        let [one, two] = [one, two].map(|at| self.goer_of(at, time));
        one.zip(two)
            .is_none_or(|(one, two)| self.may_meet(&one, &two))
    }

    /// New pairs of a shape whose box is new.
    fn meet_on_course(&mut self, slot: u32, at: u32, time: SimTime) {
        let mut near = core::mem::take(&mut self.pool.near);
        let fat = self.colliders[at as usize].fat;
        let mine = self.goer(slot, at, time);
        self.broad.search_tree(&self.colliders, fat, &mut near);
        near.retain(|other| self.comes(at, mine.as_ref(), *other, time));
        self.pair_up_with(at, near);
    }

    /// The same where all who are on their courses lie in the throng, and those of them who set out know their partners.
    fn meet_in_throng(&mut self, slot: u32, at: u32, time: SimTime) {
        let mut near = core::mem::take(&mut self.pool.near);
        let collider = &self.colliders[at as usize];
        let (fat, owner) = (collider.fat, collider.body);
        let mine = self.goer(slot, at, time);
        near.clear();
        self.broad.search_still(&self.colliders, fat, &mut near);
        near.retain(|other| self.comes(at, mine.as_ref(), *other, time));
        if let Some(strangers) = self.pool.throng.strangers(at) {
            near.extend(strangers);
        } else {
            let sets_out = mine.as_ref().filter(|mine| mine.sets_out);
            self.pool.throng.query(fat, |other| {
                let is_asked = sets_out.is_some_and(|mine| other.looks_for(mine));
                let is_new = other.body != owner && !is_asked && !self.is_pair(at, other.at);
                if is_new && mine.as_ref().is_none_or(|mine| self.may_meet(mine, other)) {
                    near.push(other.at);
                }
            });
        }
        near.sort_unstable();
        self.pair_up_with(at, near);
    }

    /// Whether a shape that is near may meet this one, and is no pair with it yet.
    fn comes(&self, at: u32, mine: Option<&Goer>, other: u32, time: SimTime) -> bool {
        let met = mine.zip(self.goer_of(other, time));
        met.is_none_or(|(mine, other)| self.may_meet(mine, &other)) && !self.is_pair(at, other)
    }

    /// Whether two shapes are known to be a pair already; of a body that has many the other one is asked later.
    fn is_pair(&self, at: u32, other: u32) -> bool {
        let known = &self.bodies.get(self.colliders[at as usize].body).pairs;
        let (low, high) = (at.min(other), at.max(other));
        known.len() <= FEW
            && known.iter().any(|place| {
                let (a, b) = self.pairs.shapes(*place);
                (a.min(b), a.max(b)) == (low, high)
            })
    }

    fn pair_up_with(&mut self, at: u32, near: Vec<u32>) {
        for &other in &near {
            let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
            self.broad
                .pair_up(bodies, &self.colliders, pairs, at, other);
        }
        self.pool.near = near;
    }
}
