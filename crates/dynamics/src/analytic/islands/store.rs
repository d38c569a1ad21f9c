//! The groups of a world that move in closed form, and when they change.

use core::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use carom_math::{SimTime, Vec2};

use super::mode_budget::ModeBudget;
use crate::analytic::modes::TouchMove;
use crate::analytic::tipping::{Limit, Tip};
use crate::model::narrow::TOUCH;
use crate::store::bodies::Bodies;
use crate::store::membership::Membership;
use crate::store::pairs::{Pair, Pairs};
use crate::store::slots::{List, Slots};
use crate::{BodyIx, ContactMode, IslandIx, Mode, PairIx};

/// What is no longer than this is one instant, in s.
const INSTANT: f64 = 1e-12;

/// Mode solves that a body's motion makes necessary at one instant: more, and rounding moves it to and fro.
const STALLED: u32 = 16;

/// Work that a body's island may spend on changes of contact mode in the time of a sub-step, in solves of one body's modes: a solve
/// costs as the cube of its bodies, 0.3 ms for a stack of three, which is twenty of its sub-steps.
///
/// With 4,096 solves of whatever size one nudge of such a stack took 28 ms, and one of each of 30 stacks 870 ms; with this (two
/// solves of three bodies, eight of two) 1.1 to 1.7 ms and 47 ms. With four of two bodies a ball in a ring that spins gains 1e-5 of its energy.
const OFTEN: u32 = 64;

/// The same in [`Mode::Exact`], whatever their size: as many as its losses of a body in a tick. A light body that rocked on
/// two corners under a heavy one changed its mode every 8 ps.
const OFTEN_EXACT: u32 = 4096;

/// The groups of a world, and when they change.
#[derive(Clone, Debug, Default)]
pub(crate) struct Closed {
    /// With the stamp that tells a group from those that had its place before.
    groups: Slots<IslandIx, (u64, Group)>,
    /// Stale entries are dropped when they come up: a group's stamp tells. Before a group changes they are looks at what it opened.
    changes: BinaryHeap<Reverse<(SimTime, IslandIx, u64)>>,
    stamp: u64,
    /// Groups that are to begin their rest (`true`) or their motion at this instant, with their stamps.
    begun: Vec<(bool, IslandIx, u64)>,
    /// By place of a body: when its mode solves of one instant began, and how many they were; the same of those
    /// in the time of a sub-step.
    stalls: List<BodyIx, [(SimTime, u32); 2]>,
    /// By place of a body.
    pub(super) budgets: List<BodyIx, ModeBudget>,
    /// Bodies with an exhausted budget: their islands join with the next sub-step.
    pub(super) exhausted: Vec<BodyIx>,
}

#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub(crate) since: SimTime,
    /// Dynamic members, and the version that their motion has since then.
    pub(crate) members: Vec<(BodyIx, u32)>,
    pub(crate) touches: Vec<Kept>,
    /// Largest speed of the mode: what its roundings are measured by, in m/s.
    pub(crate) speed: f64,
    pub(crate) sleeps: bool,
    /// When it changes by itself.
    pub(crate) until: Option<SimTime>,
    /// The path of one that turns.
    pub(crate) tip: Option<Arc<Tip>>,
}

impl Group {
    /// Its members move along their parabolas until its mode changes.
    pub(crate) fn moves_analytically(&self, bodies: &Bodies) -> bool {
        let first = self.members.first();
        first.is_some_and(|(index, _)| bodies.get(*index).moves_analytically())
    }

    /// Its dynamic members.
    pub(crate) fn indices(&self) -> Vec<BodyIx> {
        self.members.iter().map(|(index, _)| *index).collect()
    }

    /// Heat by friction, and the work of driven partners, in the first `elapsed` seconds, in J.
    pub(crate) fn works(&self, elapsed: f64) -> (f64, f64) {
        if let Some(tip) = &self.tip {
            return (tip.heat(elapsed), 0.0);
        }
        let touches = self.touches.iter();
        touches.fold((0.0, 0.0), |(heat, driven), touch| {
            (heat + touch.heat(elapsed), driven + touch.driven * elapsed)
        })
    }

    /// Pairs of which its mode holds no contact.
    pub(crate) fn opened(&self) -> Vec<PairIx> {
        let is_open = |touch: &&Kept| touch.moved.mode == ContactMode::Open;
        let holds = |pair: PairIx| {
            self.touches
                .iter()
                .any(|touch| touch.pair == pair && !is_open(&touch))
        };
        let mut pairs: Vec<PairIx> = self
            .touches
            .iter()
            .filter(is_open)
            .map(|touch| touch.pair)
            .collect();
        pairs.dedup();
        pairs.retain(|pair| !holds(*pair));
        pairs
    }

    /// Contacts of pairs carry what its touches say.
    pub(crate) fn carry(&self, bodies: &Bodies, pairs: &mut Pairs) {
        for touch in &self.touches {
            touch.carry(bodies, pairs.get_mut(touch.pair));
        }
    }

    /// Whether a pair is among its touches.
    pub(crate) fn touches_by(&self, pair: PairIx) -> bool {
        self.touches.iter().any(|touch| touch.pair == pair)
    }

    /// Its touches, with what they do at `time` where it turns.
    pub(crate) fn touches_at(&self, time: SimTime) -> Vec<Kept> {
        let mut touches = self.touches.clone();
        let tip = self.tip.as_ref();
        let now = tip.and_then(|tip| tip.moves_after(time - tip.path.start()));
        for (kept, moved) in touches
            .iter_mut()
            .zip(now.into_iter().flat_map(|now| now.1))
        {
            kept.moved = moved;
        }
        touches
    }

    /// The pair with a corner that lands at the next change, the normal from A to B, and the point.
    pub(crate) fn landing(&self) -> Option<(PairIx, Vec2, Vec2)> {
        let Some(Limit::Corner {
            contact,
            normal,
            at,
        }) = self.tip.as_ref()?.ends
        else {
            return None;
        };
        Some((self.touches.get(contact)?.pair, normal, at))
    }
}

/// A touch of a group while its mode lasts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept {
    pub(crate) pair: PairIx,
    pub(crate) contact: usize,
    pub(crate) moved: TouchMove,
    /// How fast the slip grows, in m/s².
    pub(crate) slip_rate: f64,
    /// Power that a driven partner puts in, in W.
    pub(crate) driven: f64,
}

impl Kept {
    /// The contact of a pair carries what the touch says, in impulses of a sub-step.
    pub(crate) fn carry(&self, bodies: &Bodies, pair: &mut Pair) {
        let reach = |index| bodies.get(index).reach;
        let gap = TOUCH * reach(pair.bodies.0).min(reach(pair.bodies.1));
        if let Some(contact) = pair.contacts.get_mut(self.contact) {
            contact.tangent_impulse = self.moved.tangential * bodies.h;
            let mut forces = self.moved.normal.iter();
            for point in &mut contact.points {
                let mut force = 0.0;
                if point.separation <= gap {
                    force = *forces.next().unwrap_or(&0.0);
                }
                point.impulse = force * bodies.h;
            }
        }
    }

    /// Heat by friction in the first `elapsed` seconds, in J.
    pub(crate) fn heat(&self, elapsed: f64) -> f64 {
        -self.moved.tangential * (self.moved.slip + 0.5 * self.slip_rate * elapsed) * elapsed
    }
}

impl Closed {
    /// When the next change is due.
    pub(crate) fn next(&mut self) -> Option<SimTime> {
        loop {
            let &Reverse((time, group, stamp)) = self.changes.peek()?;
            let held = self.groups.get(group);
            if held.is_some_and(|(held, _)| *held == stamp) {
                return Some(time);
            }
            self.changes.pop();
        }
    }

    /// Takes out the change that is due next: its instant, and the place of its group.
    pub(crate) fn pop(&mut self) -> Option<(SimTime, IslandIx)> {
        self.next()?;
        let Reverse((time, place, _)) = self.changes.pop()?;
        Some((time, place))
    }

    pub(crate) fn get(&self, place: IslandIx) -> Option<&Group> {
        self.groups.get(place).map(|(_, group)| group)
    }

    /// The group of a body, if it has one.
    pub(crate) fn group_of(&self, bodies: &Bodies, index: BodyIx) -> Option<&Group> {
        self.get(bodies.get(index).membership.group)
    }

    /// Enters a group, and its members into it; its place.
    pub(crate) fn insert(&mut self, bodies: &mut Bodies, group: Group) -> IslandIx {
        self.stamp += 1;
        let (members, since, until) = (group.indices(), group.since, group.until);
        let opens = !group.opened().is_empty();
        let place = self.groups.insert((self.stamp, group));
        for index in members {
            bodies.get_mut(index).enter_island(Membership::of(place));
        }
        if let Some(time) = until {
            self.changes_at(place, time);
        }
        if opens {
            self.looks_at(place, since + bodies.h);
        }
        place
    }

    /// When a group has a look at what its mode opened, unless it changes before.
    pub(crate) fn looks_at(&mut self, place: IslandIx, time: SimTime) {
        if let Some((stamp, group)) = self.groups.get(place)
            && group.until.is_none_or(|until| time < until)
        {
            self.changes.push(Reverse((time, place, *stamp)));
        }
    }

    /// When a group changes next.
    pub(crate) fn changes_at(&mut self, place: IslandIx, change: SimTime) {
        if let Some((stamp, group)) = self.groups.get_mut(place) {
            group.until = Some(change);
            self.changes.push(Reverse((change, place, *stamp)));
        }
    }

    /// A group rests, or begins its motion, before time goes on.
    pub(crate) fn begins(&mut self, place: IslandIx, rests: bool) {
        if let Some((stamp, _)) = self.groups.get(place) {
            self.begun.push((rests, place, *stamp));
        }
    }

    /// Places of the groups that are to begin their rest, or their motion, and are still there.
    pub(crate) fn to_begin(&self, rest: bool) -> Vec<IslandIx> {
        let stands = |&(rests, place, stamp): &(bool, IslandIx, u64)| {
            let (held, _) = self.groups.get(place)?;
            (rests == rest && *held == stamp).then_some(place)
        };
        self.begun.iter().filter_map(stands).collect()
    }

    /// The same, once.
    pub(crate) fn take_begun(&mut self, rest: bool) -> Vec<IslandIx> {
        let places = self.to_begin(rest);
        self.begun.retain(|(rests, ..)| *rests != rest);
        places
    }

    pub(crate) fn get_mut(&mut self, place: IslandIx) -> Option<&mut Group> {
        self.groups.get_mut(place).map(|(_, group)| group)
    }

    pub(crate) fn remove(&mut self, place: IslandIx) -> Option<Group> {
        self.groups.remove(place).map(|(_, group)| group)
    }

    /// Friction's heat, and the work of driven partners, not booked yet, in J.
    pub(crate) fn unbooked(&self, now: SimTime) -> (f64, f64) {
        let groups = self.groups.iter();
        let works = groups.map(|(_, (_, group))| group.works(now - group.since));
        works.fold((0.0, 0.0), |(heat, driven), (more, work)| {
            (heat + more, driven + work)
        })
    }

    /// Counts a change of mode of a body in an island of `bodies`; whether such changes go round in circles here, or cost too
    /// much for a sub-step of `h` seconds.
    pub(crate) fn stalls(
        &mut self,
        index: BodyIx,
        bodies: u32,
        time: SimTime,
        (h, mode): (f64, Mode),
    ) -> bool {
        let (often, cost) = match mode {
            Mode::Exact => (OFTEN_EXACT, 1),
            Mode::Hybrid | Mode::Stepped => (OFTEN, bodies.saturating_pow(3)),
        };
        let known = self.stalls.grown(index, [(SimTime::ZERO, 0); 2]);
        let mut stalls = false;
        let limits = [(INSTANT, STALLED, 1), (h, often, cost)];
        for ((since, count), (span, most, cost)) in known.iter_mut().zip(limits) {
            if time - *since < span {
                *count = count.saturating_add(cost);
            } else {
                (*since, *count) = (time, 0);
            }
            stalls |= *count > most;
        }
        stalls
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ix;

    #[test]
    fn mode_solves_that_only_rounding_moves_on_come_to_an_end() {
        // A slip that ended after 4.6e-17 s, again and again, was solved for without end.
        let mut closed = Closed::default();
        let mut time = SimTime::ZERO + 0.25;
        let solves = (0..1000).take_while(|_| {
            time += 4.6e-17;
            !closed.stalls(BodyIx::new(3), 1, time, (1e-3, Mode::Exact))
        });
        assert!(solves.count() <= 17);
        assert!(
            !closed.stalls(BodyIx::new(2), 1, time, (1e-3, Mode::Exact)),
            "another body is another matter"
        );
        assert!(
            !closed.stalls(BodyIx::new(3), 1, time + 1e-9, (1e-3, Mode::Exact)),
            "the next instant is another"
        );
    }

    #[test]
    fn mode_solves_without_end_leave_a_group_to_the_next_sub_step() {
        // Changes 8 ps apart took 27 s of a sub-step.
        let h = 1.0 / 360.0;
        for (mode, bodies, most) in [
            (Mode::Exact, 3, 4097),
            (Mode::Hybrid, 1, 65),
            (Mode::Hybrid, 2, 9),
            (Mode::Hybrid, 3, 3),
        ] {
            let mut closed = Closed::default();
            let mut time = SimTime::ZERO + 0.25;
            let solved = (0..100_000).take_while(|_| {
                time += 8e-12;
                !closed.stalls(BodyIx::new(3), bodies, time, (h, mode))
            });
            assert_eq!(solved.count(), most, "{mode:?}");
            assert!(
                !closed.stalls(BodyIx::new(3), bodies, time + h, (h, mode)),
                "the next sub-step is another"
            );
        }
    }
}
