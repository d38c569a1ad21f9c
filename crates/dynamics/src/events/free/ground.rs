//! Looking down: bodies that a free body may meet outside of the grid, since they are not free, or too large for it.

use carom_geometry::Aabb;
use carom_math::SimTime;

use super::circle::Circle;
use super::foresee::{Cause, at_most};
use super::queue::What;
use crate::broad::free_fall_frame::Track;
use crate::broad::window::{self, swept};
use crate::store::swept::Sides;
use crate::{BodyIx, BodyKind, ColliderIx, World};

/// Longest way, in cells, that a free body looks down for first, and the shortest, as a part of it. Cells are as wide as free bodies
/// are apart: what does not fly may lie far closer.
const SPAN: f64 = 2.0;
const SHORTEST: f64 = 1.0 / 16.0;

/// Shapes found in a look beyond which the next first one goes so much less far, and up to which it goes twice as far.
const MANY: usize = 8;
const FEW: usize = 2;

impl World {
    /// Boxes of a free body in the world for the next `span` seconds; without end while nothing is there.
    pub(super) fn look_down(&mut self, index: BodyIx, time: SimTime, span: f64) {
        if !self.free.grounded {
            let state = self.bodies.get_mut(index);
            state.course.ground = SimTime::NEVER;
            state.course.reached = Sides::NOTHING;
            return self.bodies.set_boxes(index, Aabb::EMPTY);
        }
        let span = at_most(span);
        let state = self.bodies.get_mut(index);
        state.course.span = span;
        state.course.ground = (time + span).min(state.piece());
        let span = state.course.ground - time;
        let way = swept(state, &Track::of(&state.motion, time), span);
        state.course.reached = Sides::around(way);
        self.free.lift(&state.course, index);
        let bounds = state.course.reached.bounds();
        self.bodies.set_boxes(index, bounds);
        self.queue_end(index, What::GROUND);
    }

    /// From the first box in the tree on free bodies look down for what is there.
    pub(crate) fn look_down_first(&mut self, time: SimTime) {
        if self.free.grounded || self.broad.tree.is_empty() {
            return;
        }
        self.free.grounded = true;
        for index in self.free.in_order() {
            self.look_down(index, time, self.first_span(index, time));
            self.meet_shapes(index, time, Cause::Horizon);
        }
    }

    /// How long a free body with a new motion looks down for, in s.
    pub(super) fn first_span(&self, index: BodyIx, time: SimTime) -> f64 {
        let track = Track::of(&self.bodies.get(index).motion, time);
        let way = SPAN * self.bodies.get(index).course.look;
        track.seconds_for(way * self.free.grid.side())
    }

    /// Shapes in the tree that `index` may meet before it looks down again: of bodies that do not fly,
    /// and of free bodies too large for the grid.
    pub(super) fn meet_shapes(&mut self, index: BodyIx, time: SimTime, cause: Cause) {
        let mut near = core::mem::take(&mut self.free.shapes);
        let reached = self.bodies.get(index).course.reached.bounds();
        self.broad.search_tree(&self.bodies, reached, &mut near);
        let overlaps = |at: &ColliderIx| {
            let collider = &self.bodies.colliders[*at];
            collider.body != index && collider.fat.overlaps(reached)
        };
        // The box of a half-plane that leans is all of the plane: it is there however short a free body looks.
        let bounded = |at: &ColliderIx| self.bodies.colliders[*at].solid.is_bounded();
        let found = near.iter().filter(|at| overlaps(at) && bounded(at)).count();
        let course = &mut self.bodies.get_mut(index).course;
        course.alone = found == 0;
        if found > MANY {
            course.look = (course.look * MANY as f64 / found as f64).max(SHORTEST);
        } else if found <= FEW {
            course.look = (2.0 * course.look).min(1.0);
        }
        near.retain(|&at| self.bodies.colliders[at].body != index);
        let mut waiting = Vec::new();
        for &at in &near {
            let owner = self.bodies.colliders[at].body;
            let state = self.bodies.get(owner);
            if state.goes_by_events() {
                let [own, theirs] =
                    [index, owner].map(|body| Circle::of(self.bodies.get(body), time));
                if let Some(window) = own.meets(&theirs) {
                    self.approach(index, owner, window, time, cause);
                }
            } else if state.is_active() {
                waiting.push(at);
            } else {
                self.approach_shape(index, at, time, cause);
            }
        }
        self.pair_free_body(index, &waiting);
        self.free.shapes = near;
    }

    /// A free body and a shape that rests.
    pub(crate) fn approach_shape(
        &mut self,
        index: BodyIx,
        at: ColliderIx,
        time: SimTime,
        cause: Cause,
    ) {
        let body = self.bodies.get(index);
        let owner = self.bodies.get(self.bodies.colliders[at].body);
        if body.kind != BodyKind::Dynamic && owner.kind != BodyKind::Dynamic {
            return;
        }
        if let [one] = *body.colliders
            && let Some(place) = self.moving_pair((index, owner.id.index), (one, at))
            && self.is_held_by_mode(place)
        {
            return;
        }
        let motion = &body.motion;
        let from = window::from_box(
            motion.centre_at(time),
            motion.velocity_at(time),
            motion.acceleration,
            body.reach + motion.left_out,
            self.bodies.colliders[at].fat,
        );
        let left = body.course.ground - time;
        if from > left {
            return;
        }
        if from > 0.0 {
            self.queue_near_shape(index, at, time + from);
            return;
        }
        self.seek_shape(index, at, time, cause);
    }

    /// What does not fly is looked for anew: twice as far ahead where there was nothing.
    pub(super) fn look_down_again(&mut self, index: BodyIx, time: SimTime) {
        let state = self.bodies.get(index);
        let course = &state.course;
        let factor = if course.alone { 2.0 } else { 1.0 };
        if course.cells.is_some() {
            self.look_down(index, time, factor * course.span);
        } else {
            // Those in the grid would have to look at all of its way.
            let lone = course.alone && !state.moves_analytically() && self.free.in_grid.is_empty();
            let least = if lone { factor * course.span } else { 0.0 };
            self.follow(index, time, least);
            self.meet_free_bodies(index, time, Cause::Horizon, None);
        }
        self.meet_shapes(index, time, Cause::Horizon);
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::{Circle, HalfPlane};
    use carom_math::{Vec2, vec2};

    use crate::{BodyDef, Material, Settings, World};

    #[test]
    fn the_first_landing_leaves_free_bodies_narrow_boxes() {
        let settings = Settings {
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("settings");
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
        let material = Material::default();
        let ground = BodyDef::fixed();
        world.insert(ground, floor, material).expect("a floor");
        for i in 0..64 {
            let height = if i == 0 { 0.6 } else { 60.0 };
            let at = vec2(3.0 * f64::from(i), height);
            let disc = Circle::new(0.5).expect("a disc");
            let falls = BodyDef::dynamic().at(at).moving(vec2(0.0, -1.0));
            world.insert(falls, disc, material).expect("a disc");
        }
        world.step_to_next_event(1.0);
        assert!(world.free.is_raised(), "the first disc is on the floor");
        let mut free = 0;
        for index in world.bodies.indices() {
            let state = world.bodies.get(index);
            if state.is_free() {
                free += 1;
                let bounds = state.course.reached.bounds();
                let width = bounds.max.x - bounds.min.x;
                assert!(width < 1.1, "a disc of 1 m falls in a box of {width} m");
            }
        }
        assert_eq!(free, 63);
    }
}
