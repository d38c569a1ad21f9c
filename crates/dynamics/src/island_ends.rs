//! Analytic islands that end, or come to rest: their members go on as they are, without the forces of the island, or rest
//! at once and fall asleep after a while.

use std::collections::BTreeSet;

use carom_math::SimTime;

use crate::model::narrow::look;
use crate::{BodyIx, EventKind, IslandIx, PairIx, Two, World};

impl World {
    /// Takes a group apart; its members keep their motions until they are given others.
    pub(crate) fn dissolve(&mut self, place: IslandIx, time: SimTime) -> Vec<BodyIx> {
        let landed = self.land_group(place, time);
        let Some(group) = self.closed.remove(place) else {
            return Vec::new();
        };
        let (heat, driven) = group.works(time - group.since);
        self.bodies.book.friction.add(heat);
        self.bodies.book.external.add(driven);
        self.bodies.book.scheme.add(heat - driven);
        let members = group.indices();
        for &index in &members {
            self.bodies.get_mut(index).leave_island();
        }
        for index in landed {
            self.redirect(index, time);
        }
        members
    }

    /// Ends the touches of what the mode of a group opened: it goes on in the group, and is searched for
    /// impacts there, until this changes.
    ///
    /// What opens with t³ is looked at again, after twice the time.
    pub(crate) fn tell_opened(&mut self, place: IslandIx, time: SimTime) {
        let Some(group) = self.closed.get(place) else {
            return;
        };
        let again = time + (time - group.since).max(self.clock.h);
        let mut stays = false;
        for place in group.opened() {
            let Some(pair) = self.pairs.find(place).filter(|pair| pair.told) else {
                continue;
            };
            // Contacts stay as they are: the group knows them by their numbers.
            let mut now = pair.clone();
            look(&self.bodies, &mut now, time);
            stays |= now.touching;
            if !now.touching {
                let pair = self.pairs.get_mut(place);
                pair.touching = false;
                self.events.tell_touch(&self.bodies, pair, time);
            }
        }
        if stays {
            self.closed.looks_at(place, again);
        }
    }

    /// A pair is no more: a group that it held together is taken apart.
    pub(crate) fn loosen(&mut self, pair: PairIx, bodies: Two<BodyIx>, time: SimTime) {
        for index in [bodies.0, bodies.1] {
            let place = self.bodies.get(index).membership.group;
            if (self.closed.get(place)).is_some_and(|group| group.touches_by(pair)) {
                if self.bodies.get(index).is_asleep() {
                    self.wake(index, time);
                }
                self.dissolve(place, time);
            }
        }
    }

    /// Islands that came to rest since the last time: a body that meets one wakes it, as if it slept.
    pub(crate) fn begin_analytic_rest(&mut self, time: SimTime) {
        let still = self.closed.take_begun(true);
        if still.is_empty() {
            return;
        }
        let mut lying = BTreeSet::new();
        for place in still {
            let Some(group) = self.closed.get(place) else {
                continue;
            };
            for &(index, _) in &group.members {
                self.bodies.get_mut(index).begin_analytic_rest();
                lying.insert(index);
            }
        }
        self.unsettled.retain(|index| !lying.contains(index));
        for index in lying {
            self.lie_down(index, time);
        }
        self.lower_free_boxes_later();
    }

    /// An analytic island that has been at rest for long enough falls asleep.
    pub(crate) fn fall_asleep(&mut self, place: IslandIx, time: SimTime) {
        // Forces of sleepers are read of their pairs alone.
        if let Some(group) = self.closed.get(place) {
            group.carry(&self.bodies, &mut self.pairs);
        }
        let members = self.dissolve(place, time);
        let mut lying = Vec::new();
        for &index in &members {
            if self.bodies.fall_asleep(index) {
                lying.push(index);
            }
            let id = self.bodies.get(index).id;
            self.events.push(time, EventKind::Asleep(id));
        }
        for index in lying {
            self.lie_down(index, time);
        }
    }
}
