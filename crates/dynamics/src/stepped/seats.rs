//! Which body sits in which line of the solver, and where its line counts from.

use carom_math::{Pose, SimTime, Vec2};

use super::courses::Courses;
use super::sent::Sent;
use super::stand::Stands;
use crate::bodies::Bodies;
use crate::solver::{Member, Pull, Rig, RowId};
use crate::state::{BodyState, Collider};
use crate::{BodyId, BodyKind};

/// No seat.
pub(super) const NONE: u32 = u32::MAX;

/// Beyond this turn against the base, in rad, the base moves up: the series of
/// a slight turn is short because angles are small.
const TURN: f64 = 0.25;

/// Beyond this displacement against the base, as a multiple of the reach, the base moves up: sums of
/// small steps keep their digits.
const AWAY: f64 = 4.0;

/// The solver's bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seats {
    pub(crate) rig: Rig,
    /// By slot; slot 0 is the solver's own.
    pub(super) list: Vec<Seat>,
    /// By slot, too: what all are asked within a tick.
    pub(super) sent: Vec<Sent>,
    pub(super) stands: Stands,
    /// What boxes were stretched along.
    pub(super) courses: Courses,
    /// Slot of each body.
    slots: Vec<u32>,
    count: usize,
}

/// A body's seat.
#[derive(Clone, Debug)]
pub(crate) struct Seat {
    /// The body; `u32::MAX`: nobody.
    pub(crate) body: u32,
    id: BodyId,
    pub(crate) kind: BodyKind,
    /// Largest distance of a point of its shapes from the centre, in m; may be infinite.
    pub(crate) reach: f64,
    /// The same for what a turn moves: 0 for a disc about its centre.
    pub(crate) rim: f64,
    /// Where displacement and turn count from.
    pub(crate) base: Pose,
    /// Angle of the base with whole turns.
    pub(crate) base_angle: f64,
    /// How far it went since its boxes were made, at most, in m; infinite if they are those of a course.
    pub(crate) roamed: f64,
}

impl Seat {
    const EMPTY: Self = Self {
        body: NONE,
        id: BodyId {
            index: NONE,
            generation: 0,
        },
        kind: BodyKind::Fixed,
        reach: 0.0,
        rim: 0.0,
        base: Pose::IDENTITY,
        base_angle: 0.0,
        roamed: 0.0,
    };
}

impl Seats {
    /// Bodies that move.
    pub(crate) const fn len(&self) -> usize {
        self.count
    }

    /// Slot of a body that sits.
    pub(crate) fn slot(&self, body: u32) -> Option<u32> {
        let slot = self.slots.get(body as usize).copied();
        slot.filter(|slot| *slot != NONE)
    }

    /// Whether the boxes of a body are those of a course.
    pub(super) fn is_on_course(&self, slot: u32) -> bool {
        self.courses.of(slot).is_some()
    }

    /// How many slots there are, taken or not.
    pub(crate) fn places(&self) -> u32 {
        #[expect(clippy::cast_possible_truncation, reason = "slots are u32")]
        let count = self.list.len() as u32;
        count
    }

    pub(crate) fn get(&self, slot: u32) -> &Seat {
        &self.list[slot as usize]
    }

    pub(crate) fn get_mut(&mut self, slot: u32) -> &mut Seat {
        &mut self.list[slot as usize]
    }

    /// All slots with somebody in them that moves.
    pub(crate) fn moving(&self) -> impl Iterator<Item = (u32, &Seat)> {
        let all = (0u32..).zip(&self.list);
        all.filter(|(_, seat)| seat.kind != BodyKind::Fixed)
    }

    /// Gives a body with these shapes among all a seat, where it is at `time`.
    pub(crate) fn admit(
        &mut self,
        state: &BodyState,
        colliders: &[Collider],
        pull: Pull,
        time: SimTime,
    ) -> u32 {
        let in_place = state.turns_in_place(colliders);
        let slot = self.rig.admit(&Member {
            velocity: state.velocity_at(time),
            spin: state.spin_at(time),
            inverse_mass: state.inverse_mass,
            inverse_inertia: state.inverse_inertia,
            pull,
        });
        self.stands.forget(slot);
        let (at, body) = (slot as usize, state.id.index as usize);
        if self.list.len() <= at {
            self.list.resize(at + 1, Seat::EMPTY);
            self.sent.resize(at + 1, Sent::NOBODY);
        }
        let motion = &state.motion;
        let rim = if in_place { 0.0 } else { state.reach };
        let moves = state.kind != BodyKind::Fixed;
        let body_sent = if moves { state.id.index } else { NONE };
        self.sent[at] = Sent::new(body_sent, rim, state.reach);
        self.list[at] = Seat {
            body: state.id.index,
            id: state.id,
            kind: state.kind,
            reach: state.reach,
            rim,
            base: motion.pose_at(time),
            base_angle: state.turned + motion.turn(time - motion.start),
            roamed: f64::INFINITY,
        };
        self.courses.end(slot);
        if self.slots.len() <= body {
            self.slots.resize(body + 1, NONE);
        }
        self.slots[body] = slot;
        self.count += usize::from(moves);
        slot
    }

    /// Takes a body's seat away; its rows must be gone.
    pub(crate) fn dismiss(&mut self, slot: u32) {
        let seat = &mut self.list[slot as usize];
        if seat.kind != BodyKind::Fixed {
            self.count -= 1;
        }
        if self.slots[seat.body as usize] == slot {
            self.slots[seat.body as usize] = NONE;
        }
        *seat = Seat::EMPTY;
        self.courses.end(slot);
        self.sent[slot as usize] = Sent::NOBODY;
        self.rig.dismiss(slot);
    }

    /// Moves everybody together once half of the lines are empty.
    pub(crate) fn close_up(&mut self) {
        if self.rig.holes() * 2 >= self.list.len() {
            self.resettle();
        }
    }

    /// Makes zones where they are due. At ticks: how the caller cuts time must change no bit.
    pub(crate) fn zone(&mut self) {
        if self.rig.wants_zones() {
            self.resettle();
        }
    }

    fn resettle(&mut self) {
        let new = self.rig.compact();
        self.courses.renumber(&new);
        let old = core::mem::take(&mut self.list);
        let sent = core::mem::take(&mut self.sent);
        self.list.resize(self.rig.lines.len(), Seat::EMPTY);
        self.sent.resize(self.rig.lines.len(), Sent::NOBODY);
        for ((seat, sent), slot) in old.into_iter().zip(sent).zip(new) {
            if slot != NONE {
                if seat.body != NONE {
                    self.slots[seat.body as usize] = slot;
                }
                self.list[slot as usize] = seat;
                self.sent[slot as usize] = sent;
            }
        }
    }

    /// Whether the seat is still that of this very body, of this kind.
    pub(crate) fn fits(&self, slot: u32, state: &BodyState) -> bool {
        let seat = self.get(slot);
        let line = &self.rig.lines[slot as usize];
        #[expect(clippy::float_cmp, reason = "a copy of these very numbers")]
        let same = line.inverse_mass() == state.inverse_mass
            && line.inverse_inertia() == state.inverse_inertia;
        seat.id == state.id && seat.kind == state.kind && same
    }

    /// Takes over what a caller changed: velocity and place at `time`.
    pub(crate) fn follow(&mut self, slot: u32, state: &BodyState, time: SimTime) {
        let (v, w) = (state.velocity_at(time), state.spin_at(time));
        self.rig.set_velocity(slot, v, w);
        let pose = state.motion.pose_at(time);
        let seat = &mut self.list[slot as usize];
        let d = pose.position - seat.base.position;
        let turn = (pose.rotation * seat.base.rotation.inverse()).angle();
        seat.base_angle = state.turned + state.motion.turn(time - state.motion.start) - turn;
        self.courses.end(slot);
        self.rig.set_displacement(slot, d, turn);
    }

    pub(crate) fn centre(&self, slot: u32) -> Vec2 {
        self.list[slot as usize].base.position + self.rig.lines[slot as usize].d()
    }

    /// Where a body is now.
    pub(crate) fn pose(&self, slot: u32) -> Pose {
        let (seat, line) = (&self.list[slot as usize], &self.rig.lines[slot as usize]);
        Pose::new(
            seat.base.position + line.d(),
            seat.base.rotation.turned_slightly(line.turn()),
        )
    }

    /// Whether a body is far from its base.
    pub(crate) fn strayed(&self, slot: u32) -> bool {
        let (seat, line) = (&self.list[slot as usize], &self.rig.lines[slot as usize]);
        line.turn().abs() > TURN
            || line.d().length_squared() > (AWAY * seat.reach) * (AWAY * seat.reach)
    }

    /// Moves the base up to where the body is; the gaps of its rows stay.
    pub(crate) fn rebase(&mut self, slot: u32, rows: impl Iterator<Item = RowId>) {
        let pose = self.pose(slot);
        let turn = self.rig.lines[slot as usize].turn();
        let seat = &mut self.list[slot as usize];
        seat.base = Pose::new(pose.position, pose.rotation.renormalized());
        seat.base_angle += turn;
        self.sent[slot as usize].rebase();
        self.rig.rebase(slot, rows);
    }
}

/// What pulls on a body at a place.
pub(crate) fn pull_of(bodies: &Bodies, state: &BodyState, centre: Vec2) -> Pull {
    if state.inverse_mass == 0.0 {
        return Pull::default();
    }
    Pull {
        acceleration: state.gravity_scale() * bodies.pull.at(centre)
            + state.force() * state.inverse_mass,
        angular: state.torque() * state.inverse_inertia,
    }
}
