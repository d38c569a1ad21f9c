//! A look at a pair: its contacts, and their rows.

use carom_collision::{PartManifold, contacts, contacts_and_gap};
use carom_math::{Pose, SimTime};

use super::Stepped;
use super::relative::{Against, fall};
use super::seats::pull_of;
use super::watch::{KEPT_APART, MARGIN, Moving, RESERVE, farther};
use crate::narrow::carried;
use crate::pairs::{Glance, Pair, PairContact, PairPoint, Rows};
use crate::solver::{Row, RowId};
use crate::{BodyKind, World};

impl World {
    /// Finds the contacts of a pair anew, and gives them rows, unless it is nothing to the solver; `moving`: both
    /// are in it, and move so. Gives how they move if they are so quick that they may want another look before the next
    /// tick; of others the margin is wide enough.
    pub(super) fn look_at(
        &mut self,
        place: u32,
        time: SimTime,
        moving: Option<Moving>,
    ) -> Option<Moving> {
        let moving = moving.or_else(|| self.bring_in(place, time))?;
        let Moving { slots, against } = moving;
        debug_assert!(self.is_inside(place), "a pair of the solver");
        let both = slots.map(|slot| self.pool.seats.stand(slot));
        let reaches = both.map(|stand| stand.reach);
        let apart = both[1].centre - both[0].centre;
        let angles = (both[0].angle, both[1].angle);
        let size = reaches[0].min(reaches[1]);
        for slot in slots {
            self.pool.seats.minds(slot, size);
        }
        let (tick, h) = (self.settings.tick, self.clock.h);
        let ahead = f64::from(self.pool.until_look) * h;
        let quick = against.is_quick(tick);
        let travel = if quick {
            against.speed() * h
        } else {
            against.speed() * ahead + farther(against.speed() * tick, size)
        };
        let margin = MARGIN * size + travel + fall(against.pull(), 2.0 * tick);
        let pair = self.pairs.get_mut(place);
        pair.fresh = false;
        let may_have_touched = pair.touching || pair.told;
        let circles = apart.length() - (reaches[0] + reaches[1]);
        let (gap, normal) = if circles <= margin {
            let seats = &mut self.pool.seats;
            let poses = [seats.stand_pose(slots[0]), seats.stand_pose(slots[1])];
            let found = &mut self.pool.found;
            found.clear();
            let gap = contacts_and_gap(
                &self.colliders[pair.colliders.0 as usize].solid,
                &self.colliders[pair.colliders.1 as usize].solid,
                poses[1].seen_from(poses[0]),
                margin,
                found,
            );
            self.report.pairs += 1;
            let colliders = pair.colliders;
            self.drop_grazes(colliders, slots, poses, size);
            self.face(place, slots, poses);
            (gap.separation, poses[0].vector(gap.normal))
        } else {
            self.pool.release(pair);
            pair.contacts = Vec::new();
            pair.fresh = false;
            (circles, apart / apart.length())
        };
        let pair = self.pairs.get(place);
        let bodies = pair.bodies;
        let rows = Rows::of(&pair.contacts);
        let due = self.pairs.glance(place).due;
        *self.pairs.glance_mut(place) = Glance {
            holds: true,
            bodies,
            apart,
            angles,
            normal,
            gap,
            sought: margin,
            rows,
            due,
        };
        if may_have_touched {
            self.judge(place, time);
        }
        quick.then_some(moving)
    }

    /// Gives the bodies of a pair seats, and wakes who is met; `None`: the pair is nothing to the solver.
    fn bring_in(&mut self, place: u32, time: SimTime) -> Option<Moving> {
        let bodies = self.pairs.get(place).bodies;
        let active = [bodies.0, bodies.1].map(|i| self.bodies.get(i).is_active());
        if active == [false, false] || !self.is_inside(place) {
            return None;
        }
        for index in [bodies.0, bodies.1] {
            if self.bodies.get(index).asleep {
                if !self.meets_sleeper(place, time) {
                    return None;
                }
                let woken = self.woken_with(index, time);
                self.join_awake(&woken, time);
            }
        }
        let slots = [bodies.0, bodies.1].map(|i| self.sit(i, time));
        let seats = &mut self.pool.seats;
        seats.take_stand(slots);
        let against = Against::new(slots.map(|slot| seats.stand(slot)));
        Some(Moving { slots, against })
    }

    /// Whether an active body is about to touch a sleeper of its pair: then that one wakes.
    fn meets_sleeper(&mut self, place: u32, time: SimTime) -> bool {
        let pair = self.pairs.get(place);
        let (a, b) = (
            self.bodies.get(pair.bodies.0),
            self.bodies.get(pair.bodies.1),
        );
        let (asleep, awake) = if a.asleep { (a, b) } else { (b, a) };
        let slot = self.pool.seats.slot(awake.id.index);
        let Some(slot) = slot.filter(|_| asleep.asleep) else {
            return false;
        };
        let line = self.pool.seats.rig.lines[slot as usize];
        let size = a.reach.min(b.reach);
        let rim = if line.w() == 0.0 {
            0.0
        } else {
            line.w().abs() * awake.reach
        };
        let closing = line.v().length() + rim;
        let resting = self.settings.sleep.map_or(0.0, |sleep| sleep.speed);
        let margin = if closing > resting {
            closing * self.settings.tick + (KEPT_APART + RESERVE) * size
        } else {
            0.0
        };
        let moving = self.pool.seats.pose(slot);
        let still = asleep.motion.pose_at(time);
        let near = a.reach + b.reach + margin;
        if (moving.position - still.position).length_squared() > near * near {
            return false;
        }
        let (pose_a, pose_b) = if a.asleep {
            (still, moving)
        } else {
            (moving, still)
        };
        let found = &mut self.pool.found;
        found.clear();
        contacts(
            &self.colliders[pair.colliders.0 as usize].solid,
            &self.colliders[pair.colliders.1 as usize].solid,
            pose_b.seen_from(pose_a),
            margin,
            found,
        );
        self.report.pairs += 1;
        !found.is_empty()
    }

    /// The slot of a body of a pair that is stepped; a fixed one gets it when it is first met.
    pub(super) fn sit(&mut self, index: u32, time: SimTime) -> u32 {
        if let Some(slot) = self.pool.seats.slot(index) {
            return slot;
        }
        let state = self.bodies.get(index);
        let pull = pull_of(&self.bodies, state, state.motion.centre_at(time));
        let slot = self.pool.seats.admit(state, &self.colliders, pull, time);
        if state.kind == BodyKind::Kinematic {
            self.pool.crowd.drivers.push(index);
        }
        self.bodies.get_mut(index).has_line = true;
        slot
    }

    /// Gives the contacts that were found their rows: lanes go over by parts, impulses by feature.
    fn face(&mut self, place: u32, slots: [u32; 2], poses: [Pose; 2]) {
        let pair = self.pairs.get_mut(place);
        let stepped = &mut self.pool;
        let found = core::mem::take(&mut stepped.found);
        if let ([new], [before]) = (found.as_slice(), pair.contacts.as_mut_slice())
            && before.parts == (new.part_a, new.part_b)
            && let Some(id) = before.row
        {
            // Most looks find the parts in touch that were, and their row stays where it is.
            let (friction, belt) = (pair.material.friction, pair.material.tangent_speed);
            stepped.seats.rig.replace(id, |j, jt| {
                before.takes(j, jt);
                *before = carried(new, poses[0], core::slice::from_ref(before));
                row_of(before, slots, poses, friction, belt)
            });
        } else {
            stepped.face_anew(place, pair, &found, slots, poses);
        }
        stepped.found = found;
        if pair.material.tangent_speed != 0.0 && !pair.contacts.is_empty() {
            stepped.crowd.belts.push(place);
        }
    }
}

impl Stepped {
    /// Gives a pair the contacts that were found; rows go over by parts.
    fn face_anew(
        &mut self,
        place: u32,
        pair: &mut Pair,
        found: &[PartManifold],
        slots: [u32; 2],
        poses: [Pose; 2],
    ) {
        let (friction, belt) = (pair.material.friction, pair.material.tangent_speed);
        for contact in &mut pair.contacts {
            if let Some(id) = contact.row {
                let (j, jt) = self.seats.rig.impulses(id);
                contact.takes(j, jt);
            }
        }
        if core::mem::take(&mut pair.at_once) {
            // What bore a heavy body is too much to begin with once that has gone.
            for contact in &mut pair.contacts {
                contact.takes([0.0; 2], 0.0);
            }
        }
        let mut old = core::mem::take(&mut self.before);
        old.append(&mut pair.contacts);
        // No more room than they fill: most pairs have one.
        pair.contacts.shrink_to(found.len());
        pair.contacts.reserve_exact(found.len());
        for new in found {
            let mut contact = carried(new, poses[0], &old);
            let row = row_of(&contact, slots, poses, friction, belt);
            if let Some(id) = contact.row {
                for before in &mut old {
                    if before.row == contact.row {
                        before.row = None;
                    }
                }
                self.seats.rig.rewrite(id, &row);
            } else {
                let id = self.seats.rig.insert(&row);
                contact.row = Some(id);
                self.bounces.note(id, pair.material.restitution);
                self.owns(id, place);
            }
            pair.contacts.push(contact);
        }
        for gone in old.drain(..) {
            if let Some(id) = gone.row {
                self.seats.rig.remove(id);
                self.bounces.forget(id);
            }
        }
        self.before = old;
    }

    fn owns(&mut self, id: RowId, place: u32) {
        let at = id.0 as usize;
        if self.pair_of.len() <= at {
            self.pair_of.resize(at + 1, place);
        }
        self.pair_of[at] = place;
    }
}

/// The row of a contact.
fn row_of(
    contact: &PairContact,
    slots: [u32; 2],
    poses: [Pose; 2],
    friction: f64,
    belt: f64,
) -> Row {
    let points = &contact.points;
    let arms_of = |p: &PairPoint| {
        (
            p.position - poses[0].position,
            p.position - poses[1].position,
        )
    };
    let (first, last) = (&points[0], &points[points.len() - 1]);
    let arms = [arms_of(first), arms_of(last)];
    let bodies = (slots[0], slots[1]);
    let mut row = Row::new(bodies, contact.normal, &arms[..points.len()], friction);
    row.belt = belt;
    for (i, point) in points.iter().enumerate() {
        row.gap[i] = point.separation;
        row.j[i] = point.impulse;
    }
    let limit = row.mu * (row.j[0] + row.j[1]);
    row.jt = contact.tangent_impulse.clamp(-limit, limit);
    row
}
