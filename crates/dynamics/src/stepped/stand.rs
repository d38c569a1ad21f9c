//! Where bodies are and how they move, as all who ask about their pairs at one instant see them: worked out once a body.

use carom_math::{Pose, Rot, Vec2};

use super::seats::{Seat, Seats};
use crate::solver::{Line, Pull};

/// A body at the instant at which its pairs are asked: two cache lines, which most are read from out of order.
#[derive(Clone, Copy, Debug)]
#[repr(align(128))]
pub(super) struct Stand {
    pub(super) centre: Vec2,
    /// In rad, with whole turns.
    pub(super) angle: f64,
    /// In m/s.
    pub(super) v: Vec2,
    /// In rad/s; 0 for a disc, which turns into itself.
    pub(super) spin: f64,
    /// What pulls on it, in m/s².
    pub(super) pull: Vec2,
    /// Farthest point of its shapes, and farthest that a turn moves, in m.
    pub(super) reach: f64,
    pub(super) rim: f64,
    /// Reach of the smallest that it was near to, as [`super::sent`] has it, in m.
    finest: f64,
    /// Worked out for the first look.
    rotation: Option<Rot>,
    /// The asking that it is of; 0: none.
    of: u32,
}

impl Stand {
    const NONE: Self = Self {
        centre: Vec2::ZERO,
        angle: 0.0,
        v: Vec2::ZERO,
        spin: 0.0,
        pull: Vec2::ZERO,
        reach: 0.0,
        rim: 0.0,
        finest: 0.0,
        rotation: None,
        of: 0,
    };

    #[inline]
    fn new(seat: &Seat, line: &Line, pull: Pull, finest: f64) -> Self {
        Self {
            centre: seat.base.position + line.d(),
            angle: seat.base_angle + line.turn(),
            v: line.v(),
            spin: if seat.rim > 0.0 { line.w() } else { 0.0 },
            pull: pull.acceleration,
            reach: seat.reach,
            rim: seat.rim,
            finest,
            rotation: None,
            of: 0,
        }
    }
}

/// Stands of one asking, by slot.
#[derive(Clone, Debug, Default)]
pub(super) struct Stands {
    list: Vec<Stand>,
    /// Number of the asking.
    of: u32,
}

impl Stands {
    /// Bodies may have moved.
    pub(super) fn renew(&mut self) {
        self.of = self.of.wrapping_add(1).max(1);
        if self.of == 1 {
            self.list.clear();
        }
    }

    /// Whoever takes this slot stands elsewhere.
    pub(super) fn forget(&mut self, slot: u32) {
        if let Some(stand) = self.list.get_mut(slot as usize) {
            stand.of = 0;
        }
    }
}

impl Seats {
    /// A body as it is now.
    fn stand_of(&self, slot: u32) -> Stand {
        Stand::new(
            self.get(slot),
            &self.rig.lines[slot as usize],
            self.rig.pull(slot),
            self.sent(slot).finest(),
        )
    }

    /// Makes sure that the stands of two bodies are those of this asking.
    #[inline]
    pub(super) fn take_stand(&mut self, slots: [u32; 2]) {
        for slot in slots {
            let of = self.stands.of;
            if self
                .stands
                .list
                .get(slot as usize)
                .is_none_or(|stand| stand.of != of)
            {
                self.take_stand_anew(slot);
            }
        }
    }

    /// Stands of all, one after the other as they lie.
    pub(super) fn take_all_stands(&mut self) {
        for slot in 0..self.places() {
            self.take_stand_anew(slot);
        }
    }

    fn take_stand_anew(&mut self, slot: u32) {
        let mut stand = self.stand_of(slot);
        stand.of = self.stands.of;
        let at = slot as usize;
        if self.stands.list.len() <= at {
            self.stands.list.resize(self.rig.lines.len(), Stand::NONE);
        }
        self.stands.list[at] = stand;
    }

    /// A body is near one of this reach: what is little to it must be little to that one, too.
    #[inline]
    pub(super) fn minds(&mut self, slot: u32, size: f64) {
        let stand = &mut self.stands.list[slot as usize];
        if size < stand.finest {
            stand.finest = size;
            self.sent[slot as usize].minds(size);
        }
    }

    /// A body as it stood when [`Self::take_stand`] was last asked.
    #[inline]
    pub(super) fn stand(&self, slot: u32) -> &Stand {
        &self.stands.list[slot as usize]
    }

    /// [`Seats::pose`] of a body whose stand was taken.
    #[inline]
    pub(super) fn stand_pose(&mut self, slot: u32) -> Pose {
        let stand = &mut self.stands.list[slot as usize];
        let rotation = if let Some(known) = stand.rotation {
            known
        } else {
            let (seat, line) = (&self.list[slot as usize], &self.rig.lines[slot as usize]);
            let rotation = seat.base.rotation.turned_slightly(line.turn());
            stand.rotation = Some(rotation);
            rotation
        };
        Pose::new(stand.centre, rotation)
    }
}
