//! Islands in analytic motion: which may begin it, and the pieces of their members.

use std::sync::Arc;

use carom_collision::hulls;
use carom_math::SimTime;

use super::store::{Closed, Group};
use crate::law::flight::Flight;
use crate::model::narrow::look;
use crate::motion::flight::begin_held_piece;
use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, Pairs};
use crate::{BodyIx, ContactMode, IslandIx, PairIx};

impl Group {
    /// Whether its members go on as its mode says, and nothing lies deep in one of them.
    pub(crate) fn may_move(&self, bodies: &Bodies, pairs: &Pairs) -> bool {
        self.members.iter().all(|&(index, version)| {
            let state = bodies.get(index);
            let mut places = state.pairs.iter();
            bodies.version(index) == version
                && state.is_held()
                && !places.any(|place| pairs.get(*place).buried)
        })
    }

    /// Parts of a pair in contacts that its mode holds, and those that share a corner which it holds: what is beside that corner is
    /// looked for with it.
    pub(crate) fn held_parts(
        &self,
        bodies: &Bodies,
        place: PairIx,
        pair: &Pair,
    ) -> Vec<(u32, u32)> {
        let mut held = Vec::new();
        for (k, touch) in self.touches.iter().enumerate() {
            if touch.pair != place || touch.moved.mode == ContactMode::Open {
                continue;
            }
            let Some(contact) = pair.contacts.get(touch.contact) else {
                continue;
            };
            let (a, b) = contact.parts;
            held.push((a, b));
            for (owner, corner) in self.tip.iter().flat_map(|tip| tip.held_corners(k)) {
                let collider = owner.first(pair.colliders.0, pair.colliders.1).1;
                let shares = (0..).zip(hulls(&bodies.colliders[collider].solid));
                let shares = shares.filter(|(_, hull)| hull.vertices.contains(&corner));
                held.extend(shares.map(|(part, _)| owner.first((a, part), (part, b)).0));
            }
        }
        held
    }

    /// Whether its mode lets a contact of two parts of a pair open.
    pub(crate) fn opens(&self, place: PairIx, pair: &Pair, (a, b): (usize, usize)) -> bool {
        self.touches.iter().any(|touch| {
            let contact = pair.contacts.get(touch.contact);
            let parts = contact.map(|contact| contact.parts);
            let same = parts.is_some_and(|parts| (parts.0 as usize, parts.1 as usize) == (a, b));
            touch.pair == place && touch.moved.mode == ContactMode::Open && same
        })
    }
}

impl Closed {
    /// The next piece of the path of a member of a group that turns.
    pub(crate) fn begin_next_piece(&mut self, bodies: &mut Bodies, index: BodyIx, time: SimTime) {
        let place = bodies.get(index).membership.group;
        let Some(group) = self.get_mut(place) else {
            return;
        };
        let Some(tip) = &group.tip else {
            return;
        };
        let mut members = group.members.iter_mut().zip(tip.movers());
        let Some((member, slot)) = members.find(|(member, _)| member.0 == index) else {
            return;
        };
        let flight = Arc::new(Flight::held(tip.path.clone(), slot));
        let until = group.until.unwrap_or(SimTime::NEVER);
        let end = begin_held_piece(bodies, index, flight, time);
        member.1 = bodies.version(index);
        bodies.get_mut(index).set_piece(end.min(until));
    }

    /// A pair of an island, with its contacts where they are at `time`, and the forces of the island's mode.
    pub(crate) fn pair_at(
        &self,
        bodies: &Bodies,
        pair: &Pair,
        place: PairIx,
        time: SimTime,
    ) -> Option<Pair> {
        let mut ends = [pair.bodies.0, pair.bodies.1].into_iter();
        let group = ends.find_map(|index| self.group_of(bodies, index))?;
        let mut now = pair.clone();
        if group.moves_analytically(bodies) {
            look(bodies, &mut now, time);
        }
        let touches = group.touches_at(time).into_iter();
        for touch in touches.filter(|touch| touch.pair == place) {
            touch.carry(bodies, &mut now);
        }
        Some(now)
    }

    /// What was predicted for the members of a group is stale, but their motions are the group's.
    pub(crate) fn renew_members(&mut self, bodies: &mut Bodies, place: IslandIx) {
        let Some(group) = self.get_mut(place) else {
            return;
        };
        for (index, version) in &mut group.members {
            bodies.renew(*index);
            *version = bodies.version(*index);
        }
    }
}
