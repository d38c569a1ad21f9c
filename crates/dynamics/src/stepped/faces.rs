//! A look at a pair: its contacts, and their rows.

use carom_collision::contacts;
use carom_math::{Pose, SimTime, Vec2, perp};

use super::Stepped;
use super::near::is_quick;
use super::seats::{Seat, pull_of};
use crate::narrow::{BURIED, carried};
use crate::pairs::{Glance, Pair, PairContact};
use crate::solver::{Line, Row, RowId};
use crate::{BodyKind, Mode, World};

/// Two bodies that moved less than this against each other since their contacts were found, as a
/// fraction of the smaller reach, are not looked at again: 20 mm for boxes of 1 m.
const KEPT: f64 = 0.028;

/// The same for two that do not push each other.
const KEPT_APART: f64 = 0.014;

/// Contacts are looked for this far beyond a tick's travel, as a fraction of the smaller reach.
const MARGIN: f64 = 0.028;

/// Normals are kept in the world: a pair that turned by more, in rad, is looked at again.
const TURNED: f64 = 0.1;

/// A light body gives way to a heavy one when they lie this deep in each other, or close by as much in a tick, as a
/// fraction of the smaller reach: 2.8 mm for boxes of 1 m.
const GIVES: f64 = 1.0 / 256.0;

impl World {
    /// Whether a pair need not be looked at: it moved so little since its contacts were found that they are
    /// still its contacts.
    pub(super) fn is_still(&self, place: u32) -> bool {
        let glance = self.pairs.glance(place);
        let seats = &self.pool.seats;
        let slots = [glance.bodies.0, glance.bodies.1].map(|index| seats.slot(index));
        let (true, [Some(a), Some(b)]) = (glance.holds, slots) else {
            return false;
        };
        let slots = [a, b];
        let [a, b] = slots.map(|slot| seats.get(slot));
        let lines = slots.map(|slot| &seats.rig.lines[slot as usize]);
        let size = a.reach.min(b.reach);
        let (apart, angles) = lie_of([a, b], lines);
        let went = stirred(glance, apart, angles, size, [a.rim > 0.0, b.rim > 0.0]);
        if went <= KEPT_APART * size + glance.slack {
            return true;
        }
        // Asked of the rows: what callers were told last depends on when they looked.
        let contacts = &self.pairs.get(place).contacts;
        let mut rows = contacts.iter().filter_map(|contact| contact.row);
        went <= KEPT * size && rows.any(|id| seats.rig.pushes(id))
    }

    /// Finds the contacts of a pair anew, and gives them rows. Whoever wakes goes to `moved`.
    pub(super) fn look_at(&mut self, place: u32, time: SimTime, moved: &mut Vec<u32>) {
        let pair = self.pairs.get(place);
        let bodies = pair.bodies;
        let active = [bodies.0, bodies.1].map(|i| self.bodies.get(i).is_active());
        if active == [false, false] || !self.moves_all() && !self.is_inside(place) {
            return;
        }
        for index in [bodies.0, bodies.1] {
            if self.bodies.get(index).asleep {
                if !self.meets_sleeper(place, time) {
                    return;
                }
                self.call_up(index, time, moved);
            }
        }
        let slots = [bodies.0, bodies.1].map(|i| self.sit(i, time));
        let seats = &self.pool.seats;
        let [a, b] = slots.map(|slot| seats.get(slot));
        let lines = slots.map(|slot| &seats.rig.lines[slot as usize]);
        let size = a.reach.min(b.reach);
        let (apart, angles) = lie_of([a, b], lines);
        let pair = self.pairs.get_mut(place);
        pair.fresh = false;
        let pair_was_touching = pair.touching;
        let tick = self.settings.tick;
        let closing = closing_of([a, b], lines);
        let pull = seats.rig.pull(slots[0]).acceleration - seats.rig.pull(slots[1]).acceleration;
        // Who is swift is stopped where it touches, and looked at there.
        let h = self.clock.h;
        let stepped = self.settings.mode == Mode::Stepped;
        let stops = |slot: &u32| {
            let line = &seats.rig.lines[*slot as usize];
            seats.rig.is_swift(*slot, h) && is_quick(seats.get(*slot), line, tick, stepped)
        };
        let ahead = if stepped && slots.iter().any(stops) {
            0.0
        } else {
            closing * tick
        };
        let margin = MARGIN * size + ahead + pull.length() * tick * tick;
        let near = a.reach + b.reach + margin;
        let found = &mut self.pool.found;
        found.clear();
        let centres_apart = apart.length();
        let slack = if centres_apart <= near {
            let poses = slots.map(|slot| self.pool.seats.pose(slot));
            contacts(
                &self.colliders[pair.colliders.0 as usize].solid,
                &self.colliders[pair.colliders.1 as usize].solid,
                poses[1].seen_from(poses[0]),
                margin,
                found,
            );
            self.report.pairs += 1;
            let colliders = pair.colliders;
            self.drop_grazes(colliders, slots, size);
            self.face(place, slots, poses);
            0.0
        } else {
            self.pool.release(pair);
            pair.contacts.clear();
            pair.fresh = false;
            // Circles that are apart stay so until half of what parts them is gone, at this pace.
            0.5 * (centres_apart - near)
        };
        *self.pairs.glance_mut(place) = Glance {
            holds: true,
            bodies,
            apart,
            angles,
            slack,
        };
        if pair_was_touching {
            self.judge(place, time);
        }
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
            closing * self.settings.tick + KEPT_APART * size
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
        let slot = self.pool.seats.admit(state, pull, time);
        if !self.moves_all() {
            if state.kind == BodyKind::Kinematic {
                self.pool.crowd.drivers.push(index);
            }
            self.bodies.get_mut(index).has_line = true;
        }
        slot
    }

    /// Gives the contacts that were found their rows: lanes go over by parts, impulses by feature.
    fn face(&mut self, place: u32, slots: [u32; 2], poses: [Pose; 2]) {
        let (all, tick) = (self.moves_all(), self.settings.tick);
        let pair = self.pairs.get_mut(place);
        let masses =
            [pair.bodies.0, pair.bodies.1].map(|index| self.bodies.get(index).inverse_mass);
        let stepped = &mut self.pool;
        for contact in &mut pair.contacts {
            if let Some(id) = contact.row {
                let row = stepped.seats.rig.row(id);
                for (point, j) in contact.points.iter_mut().zip(row.j) {
                    point.impulse = j;
                }
                contact.tangent_impulse = row.jt;
            }
        }
        let mut old = core::mem::take(&mut pair.contacts);
        let found = core::mem::take(&mut stepped.found);
        let size = {
            let of = |slot: u32| stepped.seats.get(slot).reach;
            of(slots[0]).min(of(slots[1]))
        };
        if all {
            // What was put there is deep at its first contact; what sinks in later is left to go on, but
            // for a load that one sweep does not carry.
            let depths = found.iter().filter_map(|new| new.manifold.deepest());
            let deepest = depths.fold(0.0, f64::min);
            let deep = deepest < -BURIED * size;
            let [light, heavy] = [masses[0].max(masses[1]), masses[0].min(masses[1])];
            pair.buried = deep && (pair.buried || old.is_empty());
            let closing = {
                let seats = &stepped.seats;
                let of = |slot: u32| (seats.get(slot), &seats.rig.lines[slot as usize]);
                let ((a, line_a), (b, line_b)) = (of(slots[0]), of(slots[1]));
                closing_of([a, b], [line_a, line_b])
            };
            let gives = deepest.min(-closing * tick) < -GIVES * size;
            let ratio = if heavy > 0.0 && gives && !found.is_empty() {
                light / heavy
            } else {
                1.0
            };
            stepped.depths.note(pair, ratio);
        }
        pair.contacts.reserve_exact(found.len());
        for new in &found {
            let mut contact = carried(new, poses[0], &old);
            let row = row_of(&contact, slots, poses, pair);
            if let Some(id) = contact.row {
                for before in &mut old {
                    if before.row == contact.row {
                        before.row = None;
                    }
                }
                stepped.seats.rig.rewrite(id, &row);
            } else {
                let id = stepped.seats.rig.insert(&row);
                contact.row = Some(id);
                stepped.bounces.note(id, pair.material.restitution);
                stepped.owns(id, place);
            }
            pair.contacts.push(contact);
        }
        stepped.found = found;
        // Stepped mode keeps no account of them.
        if !all && pair.material.tangent_speed != 0.0 && !pair.contacts.is_empty() {
            stepped.crowd.belts.push(place);
        }
        for gone in old {
            if let Some(id) = gone.row {
                stepped.seats.rig.remove(id);
                stepped.bounces.forget(id);
            }
        }
    }
}

impl Stepped {
    fn owns(&mut self, id: RowId, place: u32) {
        let at = id.0 as usize;
        if self.pair_of.len() <= at {
            self.pair_of.resize(at + 1, place);
        }
        self.pair_of[at] = place;
    }
}

/// The row of a contact.
fn row_of(contact: &PairContact, slots: [u32; 2], poses: [Pose; 2], pair: &Pair) -> Row {
    let arms = contact.points.iter().map(|p| {
        (
            p.position - poses[0].position,
            p.position - poses[1].position,
        )
    });
    let arms: arrayvec::ArrayVec<(Vec2, Vec2), 2> = arms.collect();
    let mut row = Row::new(
        (slots[0], slots[1]),
        contact.normal,
        &arms,
        pair.material.friction,
    );
    row.belt = pair.material.tangent_speed;
    for (i, point) in contact.points.iter().enumerate() {
        row.gap[i] = point.separation;
        row.j[i] = point.impulse;
    }
    let limit = row.mu * (row.j[0] + row.j[1]);
    row.jt = contact.tangent_impulse.clamp(-limit, limit);
    row
}

/// From the centre of A to that of B, in m, and the angles of both.
fn lie_of([a, b]: [&Seat; 2], lines: [&Line; 2]) -> (Vec2, (f64, f64)) {
    let centres = [
        a.base.position + lines[0].d(),
        b.base.position + lines[1].d(),
    ];
    let angles = (
        a.base_angle + lines[0].turn(),
        b.base_angle + lines[1].turn(),
    );
    (centres[1] - centres[0], angles)
}

/// Fastest that any two points of the bodies can approach, in m/s.
fn closing_of([a, b]: [&Seat; 2], lines: [&Line; 2]) -> f64 {
    let rim = |w: f64, reach: f64| if w == 0.0 { 0.0 } else { w.abs() * reach };
    (lines[1].v() - lines[0].v()).length() + rim(lines[0].w(), a.rim) + rim(lines[1].w(), b.rim)
}

/// How far two bodies moved against each other where they meet, in m; infinite if their normals are stale.
///
/// A disc that turns about its centre stays where it is.
fn stirred(built: &Glance, apart: Vec2, angles: (f64, f64), size: f64, turns: [bool; 2]) -> f64 {
    let turn = |turns: bool, now: f64, built: f64| if turns { now - built } else { 0.0 };
    let turns = (
        turn(turns[0], angles.0, built.angles.0),
        turn(turns[1], angles.1, built.angles.1),
    );
    if turns.0.abs() > TURNED || turns.1.abs() > TURNED {
        return f64::INFINITY;
    }
    // B's centre as A sees it, and what the gap's linear form leaves out for a far centre.
    let slid = (apart - built.apart - perp(built.apart) * turns.0).length();
    let bent = 0.5 * built.apart.length() * turns.0 * turns.0;
    slid + bent + size * (turns.1 - turns.0).abs()
}
