//! Analytic islands that turn about their contacts: they begin a path, go on along it, and leave it.

use std::sync::Arc;

use carom_math::SimTime;

use crate::analytic::islands::give_motions;
use crate::analytic::islands::store::{Group, Kept};
use crate::analytic::islands::tips::{Tipping, is_touched, path_of};
use crate::analytic::modes::{BodyMove, NotMine, TouchMove};
use crate::analytic::tipping::Ends;
use crate::analytic::touching::Gathered;
use crate::motion::flight::fly;
use crate::{Mode, World};

/// Sub-steps within which what a landing opens comes back, if it counts as closed. With 1 boxes that rock take 1.2 of the time.
const BACK: f64 = 4.0;

impl World {
    /// Moves a group along the path that its contacts leave it; `landed`: a corner came down just now.
    ///
    /// A corner that is back within [`BACK`] sub-steps rests, as a bounce does that is over in these (`rest_speed`): with e = 0
    /// a box rocks in a series without end. In [`Mode::Exact`] the series goes on.
    pub(crate) fn tip_over(
        &mut self,
        gathered: &Gathered,
        time: SimTime,
        speed: f64,
        landed: bool,
    ) -> Result<(), NotMine> {
        let tip = path_of(
            &self.bodies,
            &self.pairs,
            &self.colliders,
            gathered,
            (time, speed, self.settings.mode),
        )?;
        let lands = matches!(tip.ends, Ends::Lands { .. });
        if landed && lands && tip.after < BACK * self.clock.h && self.settings.mode == Mode::Hybrid
        {
            return Err(NotMine::Returns);
        }
        let (moves, touches) = tip.moves_after(0.0).ok_or(NotMine::Unsolved)?;
        self.charge_change(gathered, &moves, time);
        let now = (time, speed);
        let (members, fastest) = give_motions(&mut self.bodies, gathered, &moves, now, false);
        let moved = gathered.places.iter().enumerate();
        let moved = moved.filter(|(_, index)| self.bodies.get(**index).inverse_mass != 0.0);
        let slots = moved.map(|(slot, _)| slot).collect();
        let kept = |(&(pair, contact), moved): (&(u32, usize), &TouchMove)| Kept {
            pair,
            contact,
            moved: *moved,
            slip_rate: 0.0,
            driven: 0.0,
        };
        let change = time + tip.after;
        let group = Group {
            since: time,
            touches: gathered.pairs.iter().zip(&touches).map(kept).collect(),
            members: members.clone(),
            speed: fastest,
            sleeps: false,
            until: Some(change),
            tipping: Some(Tipping {
                tip: Arc::new(tip),
                slots,
            }),
        };
        let place = self.closed.insert(&mut self.bodies, group, Some(change));
        self.lay_pieces(place, time);
        self.closed.moves(place);
        self.tell_modes(gathered, &touches, time);
        for (index, _) in members {
            self.redirect(index, time);
        }
        Ok(())
    }

    /// A group that turns goes on with the next stretch of its path; whether it does.
    pub(crate) fn continue_path(&mut self, place: u32, time: SimTime) -> bool {
        let Some(group) = self.closed.get(place) else {
            return false;
        };
        let stands = |&(index, version): &(u32, u32)| self.bodies.version(index) == version;
        let Some(Tipping { tip, slots }) = &group.tipping else {
            return false;
        };
        if !group.members.iter().all(stands) {
            return false;
        }
        let Some(next) = tip.next(group.speed) else {
            return false;
        };
        // The modes take roundings out of the velocities.
        let (mut lost, mut fastest) = (0.0, group.speed);
        for (&(index, _), &slot) in group.members.iter().zip(slots) {
            let (_, velocity, _, spin) = next.path.body_after(slot, 0.0);
            let state = self.bodies.get(index);
            let linear = state.mass.mass * velocity.length_squared();
            let angular = state.turning_inertia() * spin * spin;
            lost += state.kinetic_energy(time) - 0.5 * (linear + angular);
            fastest = fastest.max(velocity.length()).max(spin.abs() * state.reach);
        }
        let (moves_analytically, heat) = (
            group.moves_analytically(&self.bodies),
            group.works(time - group.since).0,
        );
        let members = group.indices();
        if self.stalls(&members, time) {
            return false;
        }
        self.report.modes_solved += 1;
        self.bodies.book.friction.add(heat);
        self.bodies.book.scheme.add(heat);
        self.bodies.book.impacts.add(lost);
        let change = time + next.after;
        if let Some(group) = self.closed.get_mut(place) {
            (group.since, group.speed) = (time, fastest);
            if let Some(tipping) = &mut group.tipping {
                tipping.tip = Arc::new(next);
            }
        }
        self.closed.changes_at(place, change);
        if moves_analytically {
            self.begin_next_pieces(place, time);
        } else {
            self.lay_pieces(place, time);
            self.closed.renew_touches(place, time);
            for index in members {
                self.redirect(index, time);
            }
        }
        true
    }

    /// Pieces of motion for the coming sub-step of all groups that turn.
    pub(crate) fn follow_tips(&mut self, time: SimTime, h: f64) {
        self.report_left_paths(time);
        self.bodies.left_paths.begin_substep(time);
        for place in self.closed.tipping(&self.bodies) {
            let stands = |group: &Group| {
                let mut members = group.members.iter();
                members.all(|&(index, version)| self.bodies.version(index) == version)
            };
            match self.closed.get(place) {
                Some(group) if stands(group) => {
                    self.closed
                        .lay_pieces(&mut self.bodies, place, (time, h, h));
                    self.closed.renew_touches(place, time);
                }
                Some(group) => {
                    let first = group.members[0].0;
                    self.solve_modes_anew(first, time);
                }
                None => {}
            }
        }
    }

    /// The members of a group that is no more go on by their parabolas, and those of one that turned by what their path has at `time`.
    pub(crate) fn leave_path(&mut self, group: &Group, time: SimTime) {
        let Some(tipping) = &group.tipping else {
            for (index, _) in group.members.iter().copied() {
                let motion = self.bodies.get(index).motion;
                let now = (motion.acceleration, motion.angular_acceleration);
                // By its own flight each of them is where it should be.
                if now != self.bodies.freely(index, time) {
                    self.bodies.leave_path(index, time, false);
                }
            }
            return;
        };
        let members = group.indices();
        if members.iter().any(|index| self.is_on_path(*index)) {
            self.leave_curves(tipping, &members, time);
        }
        for index in members {
            self.bodies.leave_path(index, time, true);
            self.redirect(index, time);
        }
    }

    /// The members of a group that turned go on by what their path has at `time`; the modes of its touches there.
    pub(crate) fn leave_curves(
        &mut self,
        Tipping { tip, slots }: &Tipping,
        members: &[u32],
        time: SimTime,
    ) -> Option<Vec<TouchMove>> {
        let there = tip.moves_after(time - tip.path.start());
        for (&index, &slot) in members.iter().zip(slots) {
            if self.is_on_path(index) {
                let body = &tip.equations.bodies[slot];
                let pulled = (body.pull, body.twist);
                let of = |body: &BodyMove| (body.acceleration, body.angular_acceleration);
                let (acceleration, angular) =
                    there.as_ref().map_or(pulled, |(moves, _)| of(&moves[slot]));
                self.bodies.change(index, time, |motion| {
                    motion.acceleration = acceleration;
                    motion.angular_acceleration = angular;
                });
            }
        }
        there.map(|(_, touches)| touches)
    }

    /// A body that was given another velocity has left its path already, and still has the parabola of its last piece.
    fn is_on_path(&self, index: u32) -> bool {
        self.bodies.get(index).flight.is_some()
    }

    /// Bodies of `members` that left a path fly from here on if all their contacts open, unless they joined the engine.
    pub(crate) fn set_free(&mut self, members: &[u32], time: SimTime) {
        let left = self.clock.next() - time;
        for &index in members {
            if left <= 0.0
                || self.bodies.get(index).in_engine()
                || !self.bodies.left_paths.moves(index, self.bodies.get(index))
                || is_touched(
                    &self.bodies,
                    &self.colliders,
                    &mut self.pairs,
                    &mut self.narrow,
                    index,
                    (time, self.clock.h),
                )
            {
                continue;
            }
            fly(&mut self.bodies, index, time, left);
            self.redirect(index, time);
        }
    }

    /// Reports bodies that left a path and went on by its parabola, which pushes along the arms of that instant, until a group
    /// that took them in, or their own flight, gave them another one.
    pub(crate) fn report_left_paths(&mut self, now: SimTime) {
        self.report.handed_over += self.bodies.tell_left_paths(now);
    }

    /// The next pieces of the paths of a group that turns, for what is left of the sub-step.
    pub(crate) fn lay_pieces(&mut self, place: u32, time: SimTime) {
        let (left, h) = (self.clock.next() - time, self.clock.h);
        self.closed
            .lay_pieces(&mut self.bodies, place, (time, left, h));
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::{ConvexPolygon, HalfPlane};
    use carom_math::{Rot, Vec2, vec2};

    use crate::{BodyDef, Material, Settings, StepReport, World};

    #[test]
    fn a_parabola_of_a_path_that_ends_within_a_sub_step_is_reported() {
        let mut world = World::new(Settings {
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        })
        .expect("settings");
        let material = Material {
            restitution: 0.0,
            friction: 2.0,
            ..Material::default()
        };
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
        let put = world.insert(BodyDef::fixed(), floor, material);
        put.expect("valid");
        let tilted = BodyDef::dynamic().at(Rot::from_angle(-0.3) * vec2(-0.5, 1.0));
        let solid = ConvexPolygon::rectangle(1.0, 2.0).expect("a box");
        let id = world
            .insert(tilted.turned(-0.3), solid, material)
            .expect("valid");
        assert!(world.step(0.1).is_exact(), "it turns about its corner");
        let (index, now) = (id.index, world.clock.now);
        let place = world.bodies.get(index).membership.group;
        world.report = StepReport::default();
        world.dissolve(place, now);
        world.report_left_paths(now);
        assert!(world.report.is_exact(), "it has just left its path");
        let later = now + 1e-4;
        world.bodies.change(index, later, |motion| {
            motion.acceleration = vec2(0.0, -10.0);
        });
        world.report_left_paths(now + 2e-4);
        assert_eq!(
            world.report.handed_over, 1,
            "it was off its path for 0.1 ms"
        );
    }
}
