//! Analytic islands: when their contact modes are solved for, and what follows.
//!
//! A group's modes are solved for where its contacts begin to last, where one of its members changes its motion, and
//! at the instant of its own next change. Between these it is left alone: its motions are right for
//! as long as its mode lasts. What does not qualify is the engine's.

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use crate::analytic::islands::jam::jam;
use crate::analytic::islands::mode_budget::changes_motion;
use crate::analytic::islands::store::{Group, Kept};
use crate::analytic::islands::{give_motions, kept};
use crate::analytic::modes::{BodyMove, GroupMove, NotMine, land};
use crate::analytic::touching::{Gathered, gather};
use crate::events::resolve::PairImpact;
use crate::model::narrow::{TOUCH, look, opening_speed};
use crate::{BodyIx, BodyKind, ContactMode, IslandIx, Mode, PairIx, World};

impl World {
    /// Closed forms for bodies that wait for their method.
    pub(crate) fn close_groups_within(&mut self, waiting: &[BodyIx], time: SimTime) {
        let of = |index: &BodyIx| self.bodies.get(*index).pairs.iter().copied();
        let places = self.pairs.by_colliders(waiting.iter().flat_map(of));
        for place in places {
            self.close_group_of(place, time);
        }
    }

    /// A closed form for the group of a pair that touches.
    fn close_group_of(&mut self, place: PairIx, time: SimTime) {
        if !self.bodies.pull.fields.is_empty() {
            return;
        }
        let Some(pair) = self.pairs.find(place).filter(|pair| pair.touching) else {
            return;
        };
        let ends = [pair.bodies.0, pair.bodies.1];
        let joins = ends.map(|index| self.bodies.get(index).membership.is_closed());
        for index in ends {
            let state = self.bodies.get(index);
            // A touch with a group is the group's alone.
            if state.is_outside()
                && !state.membership.is_closed()
                && (joins.contains(&true) || !state.membership.has_failed(time))
            {
                self.solve_modes_around(index, time, 0.0);
            }
        }
    }

    /// The change of a group that is due.
    pub(crate) fn change_group(&mut self) {
        let Some((time, place)) = self.closed.pop() else {
            return;
        };
        let Some(group) = self.closed.get(place) else {
            return;
        };
        if group.until.is_none_or(|until| time < until) {
            return self.tell_opened(place, time);
        }
        if group.sleeps {
            return self.fall_asleep(place, time);
        }
        let (speed, moves_analytically, landing) = (
            group.speed,
            group.moves_analytically(&self.bodies),
            group.landing(),
        );
        if self.continue_path(place, time) {
            return;
        }
        let members = self.dissolve(place, time);
        // A corner of a group that turned comes down on an edge that it touched already.
        let landing = landing.filter(|at| self.pairs.find(at.0).is_some());
        if let Some(impact) = landing.and_then(|landing| self.landing_impact(landing, time)) {
            self.strike_pair(&impact);
        }
        self.solve_modes_of(&members, time, speed);
        if moves_analytically {
            if members.len() == 1 {
                self.drop_unheld(&members, time);
            }
            // Within an instant that others come from, too, it goes on at once.
            self.begin_analytic_rest(time);
            self.begin_analytic_motion(time);
        }
    }

    /// The impact of a corner that comes down at `at`. The corner may belong to another shape of its body, or be beyond the edge's end,
    /// where its side meets the end instead: the point that two bodies close at is the next one that any of their pairs touches at.
    fn landing_impact(
        &mut self,
        (pair, normal, at): (PairIx, Vec2, Vec2),
        time: SimTime,
    ) -> Option<PairImpact> {
        let ends = self.pairs.get(pair).bodies;
        let (one, two) = self.bodies.both(ends);
        let fewest = if one.pairs.len() < two.pairs.len() {
            one
        } else {
            two
        };
        let mut next: Option<(f64, PairImpact)> = None;
        for &place in &fewest.pairs {
            let known = self.pairs.get_mut(place);
            if known.bodies != ends && known.bodies != (ends.1, ends.0) {
                continue;
            }
            look(&self.bodies, known, time);
            let (a, b) = self.bodies.both(known.bodies);
            let near = TOUCH * a.reach.min(b.reach);
            let all = known.contacts.iter();
            let touches =
                all.flat_map(|contact| contact.points.iter().map(|point| (contact.normal, point)));
            for (facing, point) in touches.filter(|(_, point)| point.separation <= near) {
                let point = point.position;
                let far = (point - at).length();
                let closes = opening_speed(a, b, time, point, facing) < 0.0;
                if closes && next.as_ref().is_none_or(|(least, _)| far < *least) {
                    let is_corner = place == pair && far <= near;
                    let (normal, at) = if is_corner {
                        (normal, at)
                    } else {
                        (facing, point)
                    };
                    let points = ArrayVec::from_iter([at]);
                    let impact = PairImpact {
                        time,
                        pair: place,
                        normal,
                        points,
                    };
                    next = Some((far, impact));
                }
            }
        }
        next.map(|(_, impact)| impact)
    }

    /// A member of a group has another motion: the group's modes are solved for anew, with the contacts that it has now.
    pub(crate) fn regroup(&mut self, index: BodyIx, time: SimTime) {
        if self.settings.mode == Mode::Stepped || !self.bodies.pull.fields.is_empty() {
            return;
        }
        let state = self.bodies.get(index);
        if let Some(group) = self.closed.group_of(&self.bodies, index) {
            if !group.members.contains(&(index, self.bodies.version(index))) {
                self.solve_modes_anew(index, time, None);
            }
        } else if state.is_outside() && self.may_last(index) {
            self.bodies.get_mut(index).membership.forget();
            self.solve_modes_of(&[index], time, 0.0);
        }
    }

    /// Solves for the modes of a body's group anew, whether its members have other motions or not, but for one that `leaves`.
    pub(crate) fn solve_modes_anew(
        &mut self,
        index: BodyIx,
        time: SimTime,
        leaves: Option<BodyIx>,
    ) {
        let place = self.bodies.get(index).membership.group;
        if let Some(group) = self.closed.get(place) {
            let speed = group.speed;
            let mut members = self.dissolve(place, time);
            members.retain(|member| Some(*member) != leaves);
            self.solve_modes_of(&members, time, speed);
        }
    }

    /// A body that goes on as before has one contact more: the modes of its island are solved for anew.
    pub(crate) fn gain_contact(&mut self, index: BodyIx, time: SimTime) {
        if self.bodies.get(index).membership.is_closed() {
            self.solve_modes_anew(index, time, None);
        } else {
            self.regroup(index, time);
        }
    }

    /// Whether two bodies belong to one analytic island.
    pub(crate) fn share_group(&self, a: BodyIx, b: BodyIx) -> bool {
        let [one, other] = [a, b].map(|index| self.bodies.get(index).membership);
        one.is_closed() && one.group == other.group
    }

    /// Whether something may hold a body that just changed its motion: what bounces off does not.
    fn may_last(&self, index: BodyIx) -> bool {
        let pairs = self.bodies.get(index).pairs.iter();
        pairs
            .map(|place| self.pairs.get(*place))
            .any(|pair| pair.lasting || (pair.touching && pair.material.restitution == 0.0))
    }

    pub(crate) fn solve_modes_of(&mut self, members: &[BodyIx], time: SimTime, speed: f64) {
        if self.stalls(members, time) {
            // Solved for again at this instant it would go on in circles.
            self.fail(members, time);
        } else {
            for &index in members {
                if !self.bodies.get(index).membership.is_closed() {
                    self.solve_modes_around(index, time, speed);
                }
            }
        }
    }

    /// Counts a mode solve of an island: every one counts for some body that has not used up its number of them, so they come to an
    /// end.
    pub(crate) fn stalls(&mut self, members: &[BodyIx], time: SimTime) -> bool {
        let limits = (self.clock.h, self.settings.mode);
        let bodies = u32::try_from(members.len()).unwrap_or(u32::MAX);
        let stalls = |index: &&BodyIx| self.closed.stalls(**index, bodies, time, limits);
        members.iter().filter(stalls).count() > 0
    }

    /// Solves for the modes of the island around a body.
    fn solve_modes_around(&mut self, index: BodyIx, time: SimTime, speed: f64) {
        self.report.modes_solved += 1;
        let mut found = gather(&self.bodies, &mut self.pairs, index, time);
        while let Err(seen) = &found {
            let leaves = |index: &BodyIx| {
                let state = self.bodies.get(*index);
                state.rests_analytically() || state.moves_analytically()
            };
            let Some(index) = seen.iter().copied().find(leaves) else {
                break;
            };
            if !self.hand_back_of(index, time) {
                self.wake(index, time);
            }
            found = gather(&self.bodies, &mut self.pairs, index, time);
        }
        let mut gathered = match found {
            Ok(gathered) => gathered,
            Err(seen) => {
                for &index in &seen {
                    self.dissolve(self.bodies.get(index).membership.group, time);
                }
                return self.fail(&seen, time);
            }
        };
        let mut speed = speed;
        let groups = gathered.places.iter();
        let groups: Vec<IslandIx> = groups
            .map(|index| self.bodies.get(*index).membership.group)
            .collect();
        for place in groups {
            if let Some(group) = self.closed.get(place) {
                speed = speed.max(group.speed);
            }
            self.dissolve(place, time);
        }
        if gathered.touches.is_empty() {
            return;
        }
        if gathered.closing > gathered.rest {
            return self.fail(&gathered.dynamic(), time);
        }
        let arrived = (gathered.closing > 0.0).then(|| gathered.clone());
        if gathered.closing > 0.0 {
            match land(&gathered.bodies, &gathered.touches) {
                Ok(landed) => gathered.landed(&landed),
                Err(_) => return self.fail(&gathered.dynamic(), time),
            }
        }
        // What is slower than rest by all digits is still.
        let speed = speed.max(gathered.rest);
        match gathered.solve_modes(speed) {
            Ok(moves) => {
                self.land_touching(&gathered, time);
                self.close(&gathered, &moves, time, speed);
            }
            Err(why) => {
                let known = match why {
                    NotMine::Turns | NotMine::Curved => {
                        self.tip_over(&gathered, time, speed, arrived.is_some())
                    }
                    why => Err(why),
                };
                match known {
                    Ok(()) => {}
                    Err(NotMine::Returns) => self.end_rocking(arrived, &gathered, time, speed),
                    Err(NotMine::Painleve) if self.jams(&gathered, time) => {}
                    // No path leads on from a landing that opens nothing faster than rest.
                    Err(NotMine::Unsolved)
                        if arrived
                            .as_ref()
                            .is_some_and(|before| before.opens_slowly(&gathered)) =>
                    {
                        self.end_rocking(arrived, &gathered, time, speed);
                    }
                    Err(_) => self.fail(&gathered.dynamic(), time),
                }
            }
        }
    }

    /// What flies, and touches what belongs to an island, is the island's from now on.
    pub(crate) fn land_touching(&mut self, gathered: &Gathered, time: SimTime) {
        for &index in &gathered.places {
            if self.bodies.get(index).is_free() {
                self.land_first(index, time);
            }
        }
    }

    /// Gives a group of one point the impulse of a jam; whether it jams.
    fn jams(&mut self, gathered: &Gathered, time: SimTime) -> bool {
        let law = self.settings.impact_law;
        let jam = jam(&mut self.bodies, &self.pairs, gathered, law, time);
        let Some((ends, told)) = jam else {
            return false;
        };
        self.report.impacts += 1;
        self.events.push(time, told);
        for index in ends {
            if self.bodies.get(index).inverse_mass > 0.0 {
                self.deflected(index, time);
            }
        }
        true
    }

    /// Charges each body of an island for a mode solve.
    fn charge(&mut self, members: &[BodyIx], time: SimTime) {
        if self.settings.mode != Mode::Hybrid {
            return;
        }
        let was_substepping = self.is_substepping();
        self.closed.charge(members, time, self.settings.tick);
        if !was_substepping && self.closed.has_exhausted() {
            self.clock.catch_up(time);
        }
    }

    /// Analytic islands with exhausted budgets join the engine, unless they rest.
    pub(crate) fn join_exhausted(&mut self, time: SimTime) {
        let exhausted = self.closed.take_exhausted();
        if exhausted.is_empty() {
            return;
        }
        for index in exhausted {
            if !self.bodies.is_alive(index) || self.bodies.get(index).is_asleep() {
                continue;
            }
            let group = self.closed.group_of(&self.bodies, index);
            for index in group
                .filter(|group| !group.sleeps)
                .map_or_else(Vec::new, Group::indices)
            {
                self.join(index, time);
            }
        }
        self.lower_free_boxes_later();
    }

    /// The last landing of a series: every touch that it opened comes back at once, and stays closed.
    fn end_rocking(
        &mut self,
        arrived: Option<Gathered>,
        landed: &Gathered,
        time: SimTime,
        speed: f64,
    ) {
        let Some(mut gathered) = arrived else {
            return;
        };
        gathered.stand(landed);
        match gathered.solve_modes(speed) {
            Ok(moves) => self.close(&gathered, &moves, time, speed),
            Err(_) => self.fail(&gathered.dynamic(), time),
        }
    }

    /// A mode solve failed: none is made again at this instant, unless something happens.
    fn fail(&mut self, members: &[BodyIx], time: SimTime) {
        self.charge(members, time);
        for &index in members {
            let membership = &mut self.bodies.get_mut(index).membership;
            if !membership.is_closed() {
                membership.fail(time);
            }
        }
    }

    /// The group of a mode, and when it changes next.
    fn close(&mut self, gathered: &Gathered, moves: &GroupMove, time: SimTime, speed: f64) {
        let still = moves.bodies.iter().all(|body| *body == BodyMove::default());
        let may_sleep = |index: &BodyIx| self.bodies.get(*index).sleep_allowed();
        let sleeps = still && gathered.dynamic().iter().all(may_sleep);
        let sleep = self.settings.sleep.filter(|_| sleeps);
        let change = match (moves.change, sleep) {
            (Some(change), _) => Some(time + change),
            (None, Some(sleep)) => Some(time + sleep.time),
            (None, None) => None,
        };
        let group = Group {
            since: time,
            touches: kept(gathered, &moves.bodies, &moves.touches),
            members: Vec::new(),
            speed,
            sleeps: sleep.is_some(),
            until: change,
            tip: None,
        };
        self.begin_group(gathered, &moves.bodies, group);
    }

    /// Gives all members of a group their motions, and enters its next change.
    pub(crate) fn begin_group(&mut self, gathered: &Gathered, moves: &[BodyMove], group: Group) {
        let (time, mut group) = (group.since, group);
        // A new mode is charged for, unless the motion is as before.
        if self.settings.mode == Mode::Hybrid && changes_motion(&self.bodies, gathered, moves, time)
        {
            self.charge(&gathered.dynamic(), time);
        }
        let (now, turns) = ((time, group.speed), group.tip.is_some());
        (group.members, group.speed) = give_motions(&mut self.bodies, gathered, moves, now, !turns);
        self.tell_modes(&group.touches, time);
        let members = group.indices();
        let place = self.closed.insert(&mut self.bodies, group);
        // What is driven begins to move without a touch.
        let drives = |index: &BodyIx| self.bodies.get(*index).kind == BodyKind::Kinematic;
        let still = !turns && moves.iter().all(|body| *body == BodyMove::default());
        let rests = still && !gathered.places.iter().any(drives);
        self.closed.begins(place, rests);
        for index in members {
            self.redirect(index, time);
        }
    }

    /// A mode that is new is an event.
    fn tell_modes(&mut self, touches: &[Kept], time: SimTime) {
        for touch in touches {
            let (pair, mode) = (self.pairs.get_mut(touch.pair), touch.moved.mode);
            pair.lasting = mode != ContactMode::Open;
            // A pair of several contacts moves as its first.
            let first = touches.iter().find(|other| other.pair == touch.pair);
            if first.is_some_and(|first| first.contact == touch.contact) {
                self.events.tell_mode(&self.bodies, pair, mode, time);
            }
        }
    }
}
