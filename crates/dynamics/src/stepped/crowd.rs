//! Crowds: in [`Mode::Hybrid`], groups too large for impacts one by one are moved by a solver of their own.
//!
//! Everybody else flies, or is sub-stepped pair by pair. A body joins when it touches a large group, or when it
//! would meet a crowd before the next sub-step; it leaves when nothing has been near for three ticks.

use carom_collision::contacts;
use carom_geometry::Aabb;
use carom_math::{SimTime, Sum};

use super::seats::pull_of;
use crate::pairs::Near;
use crate::sleep::Tree;
use crate::state::BodyState;
use crate::{BodyKind, EnergyLedger, Mode, World};

/// Groups of more bodies in touch than this are a crowd.
pub(crate) const FEW: usize = 16;

/// Groups of more bodies in touch than this have more than [`crate::modes::ROWS`] rows: no closed form is tried.
pub(crate) const MANY: usize = 64;

/// A body flies after more ticks than these without a contact near.
const IDLE: u8 = 2;

/// What nears a crowd joins this far beyond a sub-step's travel, as a fraction of the smaller reach.
const MARGIN: f64 = 1.0 / 128.0;

/// What hybrid mode keeps of its crowds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Crowd {
    /// How many bodies belong.
    pub(crate) members: usize,
    /// Who joined since the last look.
    pub(super) newcomers: Vec<u32>,
    /// Kinematic bodies that have a line.
    pub(super) drivers: Vec<u32>,
    /// Pairs whose surfaces run along, and some that were: their places.
    pub(super) belts: Vec<u32>,
    /// Members that had no contact near at the last look, and for how many ticks; in order of bodies.
    idle: Vec<(u32, u8)>,
    /// Bodies that took to flight, and some that landed since.
    pub(crate) aloft: Vec<u32>,
    /// Motions are older than the lines.
    pub(super) unwritten: bool,
    /// Energy of those who left less that of those who came, in J.
    pub(crate) balance: Sum,
    /// Work of kinematic bodies, and of the caller's forces, in J.
    pub(super) driven: Sum,
    pub(super) forced: Sum,
}

impl World {
    /// Whether somebody needs sub-steps.
    pub(crate) const fn is_substepping(&self) -> bool {
        !self.stepped.is_empty() || self.pool.crowd.members > 0 || self.pool.rush.is_due()
    }

    /// Whether this world may have crowds at all.
    pub(super) const fn may_crowd(&self) -> bool {
        matches!(self.settings.mode, Mode::Hybrid) && self.bodies.pull.fields.is_empty()
    }

    /// Every group of more than `most` sub-stepped bodies in touch joins.
    pub(crate) fn gather_crowds(&mut self, most: usize, time: SimTime) {
        if !self.may_crowd() || self.stepped.len() <= most {
            return;
        }
        let mut tree = Tree::new(self.bodies.places());
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            i += 1;
            let Some(pair) = self.pairs.find(place) else {
                continue;
            };
            let (a, b) = pair.bodies;
            let held = |index| self.bodies.get(index).is_held();
            if pair.touching && held(a) && held(b) {
                tree.join(a, b);
            }
        }
        let mut count = vec![0usize; self.bodies.places()];
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            i += 1;
            // What was put deep into each other is pushed apart pair by pair first.
            if let Some(pair) = self.pairs.find(place).filter(|pair| pair.buried) {
                for index in [pair.bodies.0, pair.bodies.1] {
                    count[tree.root(index) as usize] = usize::MAX;
                }
            }
        }
        for &index in &self.stepped {
            let state = self.bodies.get(index);
            let at = tree.root(index) as usize;
            if !state.is_held() || state.is_damped() || state.membership.is_closed() {
                // Whose group keeps its method.
                count[at] = usize::MAX;
            }
            count[at] = count[at].saturating_add(1);
        }
        let joins = |index: &u32| {
            let size = count[tree.root(*index) as usize];
            size > most && size != usize::MAX
        };
        let stepped = core::mem::take(&mut self.stepped);
        let (joining, others): (Vec<u32>, _) = stepped.into_iter().partition(joins);
        self.stepped = others;
        for index in joining {
            self.join(index, time);
        }
        self.pairs.sort(&self.bodies, &self.stepped);
    }

    /// All who woke together join if they are many; whether they did.
    pub(crate) fn crowd_wakes(&mut self, woken: &[u32], time: SimTime) -> bool {
        let many = woken.len() > FEW && self.may_crowd();
        let fit = |index: &u32| !self.bodies.get(*index).is_damped();
        if !many || !woken.iter().all(fit) {
            return false;
        }
        self.join_awake(woken, time);
        self.admit_near(time, self.clock.next() - time);
        true
    }

    /// Bodies that woke beside a member, or together: those whom no law of their own slows down join.
    pub(super) fn join_awake(&mut self, woken: &[u32], time: SimTime) {
        let (damped, fit): (Vec<u32>, Vec<u32>) = woken
            .iter()
            .partition(|index| self.bodies.get(**index).is_damped());
        for index in fit {
            self.join(index, time);
        }
        if !damped.is_empty() {
            self.rouse(&damped, time);
        }
    }

    /// From now on the wide solver moves this body. In the middle of a sub-step it waits where it is for the next.
    pub(crate) fn join(&mut self, index: u32, time: SimTime) {
        let state = self.bodies.get(index);
        if !state.is_dynamic() || state.asleep || state.in_crowd {
            return;
        }
        let group = state.membership.group;
        self.dissolve(group, time);
        // What leaves a path looks for whom it meets, and may have met the crowd.
        if self.bodies.get(index).in_crowd {
            return;
        }
        if !self.is_substepping() {
            self.begin_substeps(time);
        }
        if self.pool.crowd.members == 0 {
            self.pool.until_look = 0;
        }
        if self.bodies.get(index).course.flies {
            self.bodies.get_mut(index).course.land();
            self.flyers.vanish(&mut self.bodies, index);
        } else if let Ok(at) = self.stepped.binary_search(&index) {
            self.stepped.remove(at);
        }
        self.pool.crowd.members += 1;
        self.bodies.change(index, time, |_| {});
        let (kinetic, potential) = self.bodies.energy_of(index, time);
        self.pool.crowd.balance.add(-(kinetic + potential));
        let state = self.bodies.get_mut(index);
        state.in_crowd = true;
        state.idle = 0;
        let state = self.bodies.get(index);
        let pull = pull_of(&self.bodies, state, state.motion.centre_at(time));
        let slot = self.pool.seats.admit(state, &self.colliders, pull, time);
        self.pool.crowd.newcomers.push(index);
        for &at in &self.bodies.get(index).colliders {
            self.colliders[at as usize].fat = Aabb::EMPTY;
        }
        self.refit(index, time, 0.25 * self.settings.tick);
        self.pool.seats.get_mut(slot).roamed = 0.0;
        self.mark_pairs(index);
    }

    /// The pairs of a body that joined or left are no longer those that they were.
    fn mark_pairs(&mut self, index: u32) {
        self.pairs.reorder();
        for &place in &self.bodies.get(index).pairs {
            if self
                .pairs
                .get(place)
                .contacts
                .iter()
                .all(|c| c.row.is_none())
            {
                self.pairs.get_mut(place).fresh = true;
                self.pairs.glance_mut(place).holds = false;
            }
            self.pairs.fringe.push(place);
        }
    }

    /// A member leaves, with the motion that it has at `time`: who moves it next is for the caller to say.
    pub(crate) fn quit(&mut self, index: u32, time: SimTime) {
        if !self.bodies.get(index).in_crowd {
            return;
        }
        if let Some(slot) = self.pool.seats.slot(index) {
            self.leave(index, slot);
        }
        self.pool.crowd.members -= 1;
        self.bodies.change(index, time, |_| {});
        let (kinetic, potential) = self.bodies.energy_of(index, time);
        self.pool.crowd.balance.add(kinetic + potential);
        let state = self.bodies.get_mut(index);
        state.in_crowd = false;
        state.member = false;
        state.idle = 0;
        self.bodies.renew(index);
        self.mark_pairs(index);
    }

    /// Notes that a body flies.
    pub(crate) fn note_flight(&mut self, index: u32) {
        let most = 2 * self.bodies.places() + 64;
        let aloft = &mut self.pool.crowd.aloft;
        if self.settings.mode == Mode::Hybrid {
            aloft.push(index);
            if aloft.len() > most {
                aloft.sort_unstable();
                aloft.dedup();
            }
        }
    }

    /// Members that nothing neared for a while fly from here on. At the start of a tick.
    pub(super) fn disperse(&mut self, time: SimTime) {
        // A caller's changes bring looks forward, and ticks have their length.
        if self.pool.since_idle < self.settings.substeps_per_tick() {
            return;
        }
        self.pool.since_idle = 0;
        let seats = &self.pool.seats;
        let before = core::mem::take(&mut self.pool.crowd.idle);
        let mut gone = Vec::new();
        let mut idle = Vec::new();
        for (slot, seat) in seats.moving() {
            if seat.kind != BodyKind::Dynamic || seats.rig.lanes.degree(slot) > 0 {
                continue;
            }
            let last = before.binary_search_by_key(&seat.body, |(body, _)| *body);
            let ticks = last.map_or(0, |at| before[at].1) + 1;
            if ticks > IDLE {
                gone.push((seat.body, slot));
            } else {
                idle.push((seat.body, ticks));
            }
        }
        idle.sort_unstable();
        self.pool.crowd.idle = idle;
        gone.sort_unstable();
        for (index, slot) in gone {
            self.sync(index, slot, time);
            self.quit(index, time);
            self.take_off(index, time);
        }
    }

    /// Flyers that may meet a member within a tick; the members' boxes hold them that long.
    pub(super) fn scout(&mut self, time: SimTime) {
        // A blow that has many join leaves a long list behind.
        let used = self.pairs.near.len();
        self.pairs.near.clear();
        self.pairs.near.shrink_to(4 * used);
        let aloft = &mut self.pool.crowd.aloft;
        aloft.sort_unstable();
        aloft.dedup();
        let bodies = &self.bodies;
        aloft.retain(|&index| bodies.is_alive(index) && bodies.get(index).is_flying());
        if aloft.is_empty() {
            return;
        }
        let mut bounds = Aabb::EMPTY;
        for (_, seat) in self.pool.seats.moving() {
            if seat.kind == BodyKind::Dynamic {
                for &at in &self.bodies.get(seat.body).colliders {
                    bounds = bounds.union(self.colliders[at as usize].fat);
                }
            }
        }
        let tick = self.settings.tick;
        let mut flying = Vec::new();
        for &index in &self.pool.crowd.aloft {
            let ahead = disc_swept(self.bodies.get(index), time, tick);
            if ahead.overlaps(bounds) {
                flying.push((index, ahead));
            }
        }
        for (index, ahead) in flying {
            for at in self.broad.in_tree(&self.colliders, ahead) {
                if self.bodies.get(self.colliders[at as usize].body).in_crowd {
                    self.pair_flyer(index, at);
                }
            }
        }
    }

    /// Who would meet a member before the next sub-step joins, and whoever would meet those.
    pub(super) fn admit_fringe(&mut self, time: SimTime, h: f64) {
        self.admit_near(time, h);
        let mut checked = Vec::new();
        loop {
            let mut fringe = core::mem::take(&mut self.pairs.fringe);
            fringe.sort_unstable();
            fringe.dedup();
            let before = self.pool.crowd.members;
            for place in fringe {
                let Some(pair) = self.pairs.find(place) else {
                    continue;
                };
                let near = pair.near();
                let Some((_, outsider)) = self.ends(near.bodies) else {
                    continue;
                };
                let flies = self.bodies.get(outsider).course.flies;
                if flies || !self.broad.keeps(&self.colliders, self.pairs.shapes(place)) {
                    self.part(place, time);
                    if flies {
                        self.pairs.near.push(near);
                    }
                    continue;
                }
                self.knock(near, time, h);
                checked.push(place);
            }
            if self.pool.crowd.members == before {
                break;
            }
        }
        self.pairs.fringe.append(&mut checked);
    }

    /// Flyers that would meet a member within `left` seconds join, and whoever would meet those.
    fn admit_near(&mut self, time: SimTime, left: f64) {
        let mut k = 0;
        while k < self.pairs.near.len() {
            let near = self.pairs.near[k];
            k += 1;
            self.knock(near, time, left);
        }
    }

    /// Slot of the one that is a member, and the other one, if that is a dynamic body awake that is none.
    ///
    /// Most are asked in vain, and by their slots: those of all bodies are in few cache lines.
    fn ends(&self, (a, b): (u32, u32)) -> Option<(u32, u32)> {
        let seats = &self.pool.seats;
        let (slot, outsider) = match (seats.slot(a), seats.slot(b)) {
            (Some(slot), None) => (slot, b),
            (None, Some(slot)) => (slot, a),
            _ => return None,
        };
        let is_member = seats.get(slot).kind == BodyKind::Dynamic;
        let state = self.bodies.get(outsider);
        let alive = self.bodies.is_alive(outsider);
        (is_member && alive && state.is_dynamic() && !state.asleep).then_some((slot, outsider))
    }

    /// Whether a member belongs to a pair.
    pub(crate) fn is_crowds(&self, place: u32) -> bool {
        let (a, b) = self.pairs.get(place).bodies;
        self.bodies.get(a).in_crowd || self.bodies.get(b).in_crowd
    }

    /// Whether a pair is for the wide solver to look at: of a member, and of nobody else's.
    pub(super) fn is_inside(&self, place: u32) -> bool {
        self.is_crowds(place) && self.ends(self.pairs.get(place).bodies).is_none()
    }

    /// Takes the line of a fixed or kinematic body away.
    pub(crate) fn take_line(&mut self, index: u32) {
        if let Some(slot) = self.pool.seats.slot(index) {
            self.leave(index, slot);
        }
    }

    /// A pair of a member and somebody with a new motion, in the middle of a sub-step.
    pub(crate) fn knock_between(&mut self, place: u32, time: SimTime) {
        let near = self.pairs.get(place).near();
        self.knock(near, time, self.clock.next() - time);
    }

    /// A flyer with a new motion, and a shape of a member.
    pub(crate) fn knock_at(&mut self, index: u32, at: u32, time: SimTime) {
        for slot in 0..self.bodies.get(index).colliders.len() {
            let mine = self.bodies.get(index).colliders[slot];
            let near = Near {
                colliders: (mine, at),
                bodies: (index, self.colliders[at as usize].body),
            };
            self.knock(near, time, self.clock.next() - time);
        }
    }

    /// Has the one of two shapes that is no member's join if it would meet the other within `left` seconds.
    fn knock(&mut self, near: Near, time: SimTime, left: f64) {
        let Some((slot, outsider)) = self.ends(near.bodies) else {
            return;
        };
        if left > 0.0 && self.nears(near.colliders, slot, outsider, time, left) {
            if self.bodies.get(outsider).is_damped() {
                // Its own law goes on, in sub-steps pair by pair.
                self.land(outsider, time);
            } else {
                self.join(outsider, time);
            }
        }
    }

    /// Whether the shape of a body may meet that of a member within `left` seconds.
    fn nears(
        &self,
        (first, second): (u32, u32),
        slot: u32,
        outsider: u32,
        time: SimTime,
        left: f64,
    ) -> bool {
        let state = self.bodies.get(outsider);
        let other = self.pool.seats.get(slot);
        let line = self.pool.seats.rig.lines[slot as usize];
        let rim = |w: f64, reach: f64| if w == 0.0 { 0.0 } else { w.abs() * reach };
        let motion = &state.motion;
        let closing = (motion.velocity_at(time) - line.v()).length()
            + rim(motion.spin_at(time), state.reach)
            + rim(line.w(), other.reach);
        let pull = motion.acceleration - self.pool.seats.rig.pull(slot).acceleration;
        let margin =
            MARGIN * state.reach.min(other.reach) + (closing + pull.length() * left) * left;
        let margin = margin + motion.left_out;
        let near = state.reach + other.reach + margin;
        let apart = motion.centre_at(time) - self.pool.seats.centre(slot);
        if apart.length_squared() > near * near {
            return false;
        }
        let (mine, theirs) = (motion.pose_at(time), self.pool.seats.pose(slot));
        let (pose_a, pose_b) = if self.colliders[first as usize].body == outsider {
            (mine, theirs)
        } else {
            (theirs, mine)
        };
        let mut found = Vec::new();
        contacts(
            &self.colliders[first as usize].solid,
            &self.colliders[second as usize].solid,
            pose_b.seen_from(pose_a),
            margin,
            &mut found,
        );
        !found.is_empty()
    }

    /// The columns of the ledger that crowds have.
    pub(crate) fn book_crowd(&self, ledger: &mut EnergyLedger) {
        let crowd = &self.pool.crowd;
        let mut gained = crowd.balance;
        for state in self.bodies.iter().filter(|state| state.in_crowd) {
            let (kinetic, potential) = self.bodies.energy_of(state.id.index, self.clock.now);
            gained.add(kinetic);
            gained.add(potential);
        }
        gained.add(-self.bodies.book.struck.value());
        let (heat, cost) = (self.pool.seats.rig.heat, self.pool.bounces.cost());
        let (driven, forced) = (crowd.driven.value(), crowd.forced.value());
        ledger.friction += heat;
        ledger.impacts += cost;
        ledger.external += driven;
        ledger.forces += forced;
        // What rows and push-outs did is what the energies tell beside that.
        ledger.scheme += gained.value() + heat + cost - driven - forced;
    }
}

/// Box of a body's bounding circle over `seconds` from `time` on.
fn disc_swept(state: &BodyState, time: SimTime, seconds: f64) -> Aabb {
    let motion = &state.motion;
    let ends = [time, time + seconds].map(|at| motion.centre_at(at));
    let bulge = 0.125 * motion.acceleration.length() * seconds * seconds;
    Aabb::from_points(ends).grown(state.reach + bulge)
}
