//! Fast bodies while their touches within a sub-step are searched for.

use carom_collision::Motion;
use carom_geometry::Aabb;
use carom_math::{SimTime, Vec2};

use super::{FastBody, way_box};
use crate::rows::Shifted;
use crate::{BodyIx, Engine};

/// A body that touches so often within a sub-step is stopped there.
const MOST: u8 = 3;

/// The motion of a fast body during the search.
#[derive(Clone, Copy)]
pub(super) struct Moving {
    pub(super) slot: BodyIx,
    pub(super) birth: u64,
    pub(super) motion: Motion,
    pub(super) carried: bool,
    /// How often it touched so far, and the slot of the body that it touched first.
    pub(super) touches: u8,
    pub(super) touched: Option<BodyIx>,
}

impl Moving {
    pub(super) const fn is_stopped(&self) -> bool {
        self.touches >= MOST
    }

    /// It goes on `wait` seconds on, without this part of its velocity, or without any if it touches too often, and without
    /// turning; the part that it lost.
    pub(super) fn deflect(&mut self, wait: f64, part: Vec2) -> Vec2 {
        self.touches += 1;
        let there = self.motion.rebased(self.motion.start + wait);
        let part = if self.is_stopped() {
            there.velocity
        } else {
            part
        };
        let velocity = there.velocity - part;
        self.motion = Motion {
            start: SimTime::ZERO,
            centre: there.centre - velocity * wait,
            velocity,
            spin: 0.0,
            ..there
        };
        part
    }
}

/// All of them. Most meet nothing: motions are made where one is asked for.
#[derive(Default)]
pub(super) struct Fast {
    /// By slot, in order.
    pub(super) noted: Vec<FastBody>,
    pub(super) moving: Vec<Option<Moving>>,
    /// Whether they are searched for among bodies that stand, and among moving ones.
    pub(super) sought: Vec<[bool; 2]>,
    /// Those that leave their boxes.
    pub(super) leaving: Vec<usize>,
    /// Those that may be where no box of the tick is: they leave theirs, deviate, or touched something.
    pub(super) unboxed: Vec<usize>,
    /// Seconds that the motions last.
    pub(super) left: f64,
    /// How many of them were noted: those after them were touched, and are in no order.
    pub(super) in_order: usize,
    pub(super) shifted: Vec<Shifted>,
}

impl Fast {
    pub(super) fn of(&mut self, engine: &Engine, k: usize) -> &mut Moving {
        self.moving[k].get_or_insert_with(|| engine.moving(&self.noted[k], self.left))
    }

    pub(super) fn find(&self, slot: BodyIx) -> Option<usize> {
        let (noted, touched) = self.noted.split_at(self.in_order);
        let is_it = |body: &FastBody| body.slot == slot;
        let known = noted.binary_search_by_key(&slot, |body| body.slot).ok();
        known.or_else(|| Some(self.in_order + touched.iter().position(is_it)?))
    }

    /// A body that is not fast goes elsewhere from here on.
    pub(super) fn push(&mut self, body: FastBody) -> usize {
        self.noted.push(body);
        self.moving.push(None);
        self.noted.len() - 1
    }

    pub(super) fn is_stopped(&self, k: usize) -> bool {
        self.moving[k].as_ref().is_some_and(Moving::is_stopped)
    }

    /// How often it touched so far.
    pub(super) fn touches(&self, k: usize) -> u8 {
        self.moving[k].as_ref().map_or(0, |body| body.touches)
    }

    /// The box that it stays in for so long.
    pub(super) fn bounds(&self, engine: &Engine, k: usize, time: f64) -> Aabb {
        let body = &self.noted[k];
        let (from, velocity) = self.moving[k].as_ref().map_or_else(
            || engine.way(body, self.left),
            |body| (body.motion.centre, body.motion.velocity),
        );
        way_box(from, velocity, time).grown(engine.bodies.records[body.slot].reach)
    }
}
