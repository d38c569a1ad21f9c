//! Groups that turn about their contacts, in a world: which shapes touch, and which bodies the path moves.

use std::sync::Arc;

use arrayvec::ArrayVec;
use carom_collision::part;
use carom_math::SimTime;

use super::joints::{Held, joint};
use super::store::{Group, Kept};
use crate::analytic::modes::{NotMine, TouchMove};
use crate::analytic::tipping::{Contact, Ends, Joint, Place, Tip, tip};
use crate::analytic::touching::Gathered;
use crate::model::approach::{Approach, approach_at};
use crate::model::narrow::{TOUCH, rest_speed};
use crate::motion::flight::{fly, follow};
use crate::motion::law::Flight;
use crate::store::membership::Membership;
use crate::{Mode, World};

/// A corner this near to a point of contact is what touches there, as a part of the smaller reach.
const NEAR: f64 = 1e-6;

/// Bodies that move in a group that turns: more are the solver's.
const MOST: usize = 4;

/// The same where the engine takes what has no path: a path of several bodies takes 120 µs for a 30th of a second, the engine 7 µs
/// (1,000 seesaws: 15.8 and 4.5 ms a step, and 255 and 8 the worst one).
const MOST_BESIDE_ENGINE: usize = 1;

/// Shortest piece that a parabola is laid through, in s.
const PIECE: f64 = 1e-4;

/// Sub-steps within which what a landing opens comes back, if it counts as closed. With 1 boxes that rock take 1.2 of the time.
const BACK: f64 = 4.0;

/// A group that turns.
#[derive(Clone, Debug)]
pub(super) struct Tipping {
    pub(super) tip: Arc<Tip>,
    /// Place of each member in the group's list of bodies.
    pub(super) slots: Vec<usize>,
}

impl World {
    /// Moves a group along the path that its contacts leave it; `landed`: a corner came down just now.
    ///
    /// A corner that is back within [`BACK`] sub-steps rests, as a bounce does that is over in these (`rest_speed`): with e = 0
    /// a box rocks in a series without end. In [`Mode::Exact`] the series goes on.
    pub(super) fn tip_over(
        &mut self,
        gathered: &Gathered,
        time: SimTime,
        speed: f64,
        landed: bool,
    ) -> Result<(), NotMine> {
        if self.is_too_large(gathered) {
            return Err(NotMine::TooLarge);
        }
        // Free bodies land first.
        let is_free = |index: &u32| self.bodies.get(*index).is_free();
        if gathered.places.iter().any(is_free) {
            return Err(NotMine::Turns);
        }
        let contacts = self.joints(gathered, time).ok_or(NotMine::Curved)?;
        let both = gathered.places.iter().zip(&gathered.bodies);
        let (mut places, mut reaches) = (Vec::new(), Vec::new());
        for (&index, body) in both {
            let state = self.bodies.get(index);
            places.push(Place {
                centre: body.centre,
                rotation: state.rotation_at(time),
                velocity: body.velocity,
                spin: body.spin,
            });
            reaches.push(if body.inverse_mass > 0.0 {
                state.reach
            } else {
                0.0
            });
        }
        let tip = tip(&gathered.bodies, &places, &reaches, contacts, time, speed)?;
        let lands = matches!(tip.ends, Ends::Lands { .. });
        if landed && lands && tip.after < BACK * self.clock.h && self.settings.mode == Mode::Hybrid
        {
            return Err(NotMine::Returns);
        }
        let (moves, touches) = tip.starts().ok_or(NotMine::Unsolved)?;
        self.charge_change(gathered, &moves, time);
        let lost = gathered.kinetic(&self.bodies, time) - super::kinetic(gathered, &moves);
        self.bodies.book.impacts.add(lost);
        let (mut members, mut slots) = (Vec::new(), Vec::new());
        let mut fastest = speed;
        for (slot, (&index, moved)) in gathered.places.iter().zip(&moves).enumerate() {
            if self.bodies.get(index).inverse_mass == 0.0 {
                continue;
            }
            self.bodies.change(index, time, |motion| {
                motion.velocity = moved.velocity;
                motion.spin = moved.spin;
            });
            let state = self.bodies.get_mut(index);
            state.member = true;
            let reach = state.reach;
            members.push((index, self.bodies.version(index)));
            slots.push(slot);
            for fast in [moved.velocity.length(), moved.spin.abs() * reach] {
                fastest = if fast > fastest { fast } else { fastest };
            }
        }
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
        let place = self.closed.insert(group, Some(change));
        for &(index, _) in &members {
            let state = self.bodies.get_mut(index);
            state.enter_island(Membership::of(place));
        }
        self.lay_pieces(place, time, self.clock.next() - time);
        if self.settings.mode == Mode::Hybrid {
            self.closed.moves(place);
        }
        self.tell_modes(&gathered.pairs, &touches, time);
        for (index, _) in members {
            self.redirect(index, time);
        }
        Ok(())
    }

    /// Whether so many bodies turn that they have no path. Touches that are new are in `gathered` alone.
    fn is_too_large(&self, gathered: &Gathered) -> bool {
        let moving = gathered.dynamic();
        let is_borne = moving.len() < gathered.places.len();
        moving.len() > MOST
            || moving.len() > MOST_BESIDE_ENGINE && self.settings.mode == Mode::Hybrid && is_borne
    }

    /// A group that turns goes on with the next stretch of its path; whether it does.
    pub(super) fn continue_path(&mut self, place: u32, time: SimTime) -> bool {
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
        let members: Vec<u32> = group.members.iter().map(|(index, _)| *index).collect();
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
            self.lay_pieces(place, time, self.clock.next() - time);
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
                Some(group) if stands(group) => self.lay_pieces(place, time, h),
                Some(group) => {
                    let first = group.members[0].0;
                    self.solve_modes_anew(first, time);
                }
                None => {}
            }
        }
    }

    /// The members of a group that turned go on by the parabola that their path has at `time`.
    pub(super) fn leave_path(&mut self, group: &Group, time: SimTime) {
        let Some(Tipping { tip, slots }) = &group.tipping else {
            return;
        };
        let accelerations = tip.accelerations_after(time - tip.path.start);
        for (&(index, _), &slot) in group.members.iter().zip(slots) {
            // A body that was given another velocity has left the path already, and still has the parabola of its last piece.
            if self.bodies.get(index).flight.is_some() {
                let (acceleration, angular) = accelerations[slot];
                self.bodies.change(index, time, |motion| {
                    motion.acceleration = acceleration;
                    motion.angular_acceleration = angular;
                });
            }
            self.bodies.leave_path(index, time);
            self.redirect(index, time);
        }
    }

    /// Bodies of `members` that left a path fly from here on if all their contacts open, unless they joined the engine.
    pub(super) fn set_free(&mut self, members: &[u32], time: SimTime) {
        let left = self.clock.next() - time;
        for &index in members {
            if left <= 0.0
                || self.bodies.get(index).in_engine()
                || !self.bodies.left_paths.moves(index, self.bodies.get(index))
                || self.is_touched(index, time)
            {
                continue;
            }
            fly(&mut self.bodies, index, time, left);
            self.redirect(index, time);
        }
    }

    /// Whether a body touches something that it does not part from, nor would if nothing pushed it.
    fn is_touched(&mut self, index: u32, time: SimTime) -> bool {
        let h = self.clock.h;
        self.bodies.get(index).pairs.clone().iter().any(|&place| {
            let pair = self.pairs.get(place);
            if !pair.touching && !pair.lasting {
                return false;
            }
            let pair = self.narrow.look_at(
                &self.bodies,
                &self.colliders,
                &mut self.pairs,
                place,
                time,
                h,
            );
            let (a, b) = (
                self.bodies.get(pair.bodies.0),
                self.bodies.get(pair.bodies.1),
            );
            let touch = TOUCH * a.reach.min(b.reach);
            let rest = rest_speed(&self.bodies, pair, h);
            let bodies = &self.bodies;
            pair.contacts.iter().any(|contact| {
                contact.points.iter().any(|point| {
                    let at = (point.position, contact.normal);
                    point.separation <= touch
                        && match approach_at((a, b), at, time, rest) {
                            Approach::Leaves(_) => false,
                            Approach::Closes(_) => true,
                            Approach::Stays => {
                                let spot = pair.spot(bodies, &self.colliders, contact, at.0);
                                spot.free_press(bodies, pair.bodies, time) > 0.0
                            }
                        }
                })
            })
        })
    }

    /// Reports bodies that left a path and went on by its parabola, which pushes along the arms of that instant, until a group
    /// that took them in, or their own flight, gave them another one.
    pub(crate) fn report_left_paths(&mut self, now: SimTime) {
        self.report.handed_over += self.bodies.tell_left_paths(now);
    }

    /// Gives every member of a group that turns the parabola through both ends of its path's next piece.
    pub(super) fn lay_pieces(&mut self, place: u32, time: SimTime, left: f64) {
        let Some(group) = self.closed.get(place) else {
            return;
        };
        let Some(Tipping { tip, slots }) = group.tipping.clone() else {
            return;
        };
        let members = group.members.clone();
        let passed = time - tip.path.start;
        let h = if left > 0.0 { left } else { self.clock.h };
        let known = tip.path.length - passed;
        let h = h.min(known).max(PIECE.min(tip.path.length));
        let mut renewed = Vec::with_capacity(members.len());
        for (&(index, _), &slot) in members.iter().zip(&slots) {
            let flight = Arc::new(Flight::held(tip.clone(), slot));
            let (bend, twist) = tip.path.jerk(slot);
            let jerk = bend + twist * self.bodies.get(index).reach;
            follow(&mut self.bodies, index, flight, time, h, jerk);
            self.bodies.get_mut(index).member = true;
            renewed.push((index, self.bodies.version(index)));
        }
        if let Some(group) = self.closed.get_mut(place) {
            group.members = renewed;
            group.touches = group.touches_at(time);
        }
    }

    /// What touches what in every contact of a group; `None` where two corners meet.
    fn joints(&self, gathered: &Gathered, time: SimTime) -> Option<Vec<Contact>> {
        let all = gathered.pairs.iter().zip(&gathered.touches);
        all.map(|(&(place, number), touch)| {
            let pair = self.pairs.get(place);
            let (a, b) = (
                self.bodies.get(pair.bodies.0),
                self.bodies.get(pair.bodies.1),
            );
            let parts = pair.contacts.get(number)?.parts;
            let hull = |collider: u32, at: u32| {
                part(&self.colliders[collider as usize].solid, at as usize)
            };
            let side = |k: usize, hull, pose| {
                let body = &gathered.bodies[k];
                Held {
                    hull,
                    pose,
                    velocity: body.velocity,
                    spin: body.spin,
                }
            };
            let ends = (
                side(
                    touch.bodies.0,
                    hull(pair.colliders.0, parts.0),
                    a.centre_pose(time),
                ),
                side(
                    touch.bodies.1,
                    hull(pair.colliders.1, parts.1),
                    b.centre_pose(time),
                ),
            );
            let near = NEAR * a.reach.min(b.reach);
            let joints: Option<ArrayVec<Joint, 2>> = touch
                .points
                .iter()
                .map(|point| {
                    joint(
                        &ends.0,
                        &ends.1,
                        touch.normal,
                        *point,
                        touch.points.len(),
                        near,
                    )
                })
                .collect();
            Some(Contact {
                bodies: touch.bodies,
                joints: joints?,
                friction: touch.friction,
            })
        })
        .collect()
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
