//! Who moves far within a sub-step stops where it first touches what it would pass through.
//!
//! Rows know where bodies are when a sub-step begins. That is enough for whoever moves a part of its
//! width at a time; for the others the way through the sub-step is searched, and they end it at their
//! time of impact. The next sub-step finds them in touch, and its rows do the rest. What is left of the
//! sub-step is lost to them, speed is not.
//!
//! ```text
//! ways of all swift bodies ─► first touches, in order of (time, pair) ─► stop ─► searched again against it
//! ```
//! Whoever slides, rolls or grazes is not stopped: only the core of a body must not pass.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_math::{SimTime, Vec2};

use super::relative::Against;
use crate::{BodyKind, Mode, World};

/// Who is stopped stops short of the surface by this part of its reach: what overlaps is held softly,
/// and what is met at 100 m/s would sink in.
const SHORT: f64 = 1e-7;

/// The way of a swift body through a sub-step.
#[derive(Clone, Copy, Debug)]
struct Way {
    body: u32,
    slot: u32,
    /// Displacement and turn at the start, against the base.
    from: (Vec2, f64),
    motion: Motion,
    stopped: bool,
}

/// A first touch of a swift body. In order of (time, pair); `b` only where that one is swift, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Touch {
    pub(super) time: SimTime,
    pub(super) colliders: (u32, u32),
    pub(super) place: u32,
    pub(super) a: usize,
    pub(super) b: Option<usize>,
}

impl World {
    /// After a sub-step: whoever went through something goes back to where it touched it first.
    pub(super) fn stop_swift(&mut self) {
        // Who is swift leaves a crowd of hybrid mode, or strikes it as a flyer.
        if self.pool.seats.rig.swift.is_empty() || self.settings.mode != Mode::Stepped {
            return;
        }
        let (start, end) = (self.clock.last(), self.clock.next());
        let mut ways = self.ways(start);
        let mut touches = BinaryHeap::new();
        let mut way_of = vec![u32::MAX; self.pool.seats.places() as usize];
        for (number, way) in (0u32..).zip(&ways) {
            way_of[way.slot as usize] = number;
        }
        for k in 0..ways.len() {
            for i in 0..self.bodies.get(ways[k].body).pairs.len() {
                let place = self.bodies.get(ways[k].body).pairs[i];
                if self.is_left_to_rows(&ways, k, place, &way_of) {
                    continue;
                }
                self.search(&ways, k, (start, end), (place, true), &mut touches);
            }
        }
        while let Some(Reverse(touch)) = touches.pop() {
            let ends = [Some(touch.a), touch.b];
            if ends.iter().flatten().any(|k| ways[*k].stopped) {
                continue;
            }
            self.pairs.glance_mut(touch.place).holds = false;
            for k in ends.into_iter().flatten() {
                self.halt(&mut ways[k], touch.time - start);
            }
            for k in ends.into_iter().flatten() {
                self.search_against(&ways, k, (touch.time, end), &mut touches);
            }
        }
    }

    /// The ways of all swift bodies, in order of bodies; their boxes hold them.
    fn ways(&mut self, start: SimTime) -> Vec<Way> {
        let h = self.clock.h;
        let swift = core::mem::take(&mut self.pool.seats.rig.swift);
        let mut ways: Vec<Way> = Vec::with_capacity(swift.len());
        for before in &swift {
            let seats = &self.pool.seats;
            let (seat, line) = (
                seats.get(before.slot),
                seats.rig.lines[before.slot as usize],
            );
            if seat.kind != BodyKind::Dynamic {
                continue;
            }
            let motion = Motion {
                start,
                velocity: (line.d() - before.d) * self.law.inverse_h(),
                rotation: seat.base.rotation.turned_slightly(before.turn),
                spin: (line.turn() - before.turn) * self.law.inverse_h(),
                ..Motion::resting(seat.base.position + before.d)
            };
            let (body, angle) = (seat.body, seat.base_angle + before.turn);
            self.bodies.go_on_as(body, &motion, angle);
            self.hold_way((body, before.slot), (before.d, before.turn), start, h);
            ways.push(Way {
                body,
                slot: before.slot,
                from: (before.d, before.turn),
                motion,
                stopped: false,
            });
        }
        self.pool.seats.rig.swift = swift;
        ways.sort_unstable_by_key(|way| way.body);
        ways
    }

    /// Enters the first touch of way `k` with its partner of a pair; of two swift bodies only the first
    /// one's if both look.
    fn search(
        &mut self,
        ways: &[Way],
        k: usize,
        (from, end): (SimTime, SimTime),
        (place, both): (u32, bool),
        touches: &mut BinaryHeap<Reverse<Touch>>,
    ) {
        let way = ways[k];
        let pair = self.pairs.get(place);
        let (other, colliders) = (pair.other(way.body), pair.colliders);
        let (mine, theirs) = pair.shapes_from(way.body);
        let partner = ways.binary_search_by_key(&other, |way| way.body).ok();
        if both && partner.is_some_and(|other| other < k) {
            return;
        }
        let left = end - from;
        if partner.is_none() && self.stays_off(&way, other, from, left) {
            return;
        }
        let motion = partner.map_or_else(
            || self.way_of(other, (from, left)),
            |other| ways[other].motion.rebased(from),
        );
        let own = (way.body, way.motion.rebased(from));
        let wait = self.first_touch(own, mine, (other, theirs), &motion, left);
        if let Some(wait) = wait {
            touches.push(Reverse(Touch {
                time: from + wait,
                colliders,
                place,
                a: k,
                b: partner.filter(|other| !ways[*other].stopped),
            }));
        }
    }

    /// Who is still under way may meet one that has stopped.
    fn search_against(
        &mut self,
        ways: &[Way],
        stopped: usize,
        span: (SimTime, SimTime),
        touches: &mut BinaryHeap<Reverse<Touch>>,
    ) {
        let body = ways[stopped].body;
        for i in 0..self.bodies.get(body).pairs.len() {
            let place = self.bodies.get(body).pairs[i];
            let other = self.pairs.get(place).other(body);
            if let Ok(k) = ways.binary_search_by_key(&other, |way| way.body)
                && !ways[k].stopped
            {
                self.search(ways, k, span, (place, false), touches);
            }
        }
    }

    /// After how many seconds the core of a body's shape would touch another, or before that the shape itself, as both
    /// move from one instant on; `None` within `left` seconds.
    pub(super) fn first_touch(
        &mut self,
        (body, own): (u32, Motion),
        mine: u32,
        (other, theirs): (u32, u32),
        motion: &Motion,
        left: f64,
    ) -> Option<f64> {
        let size = self.bodies.get(body).reach;
        let near = size + self.bodies.get(other).reach;
        if !comes_within(&own, motion, near, left) {
            return None;
        }
        self.report.pairs += 1;
        let solid = &self.colliders[mine as usize].solid;
        let parts = self.pool.cores.of(mine, solid);
        let target = &self.colliders[theirs as usize].solid;
        let mut first: Option<f64> = None;
        for part in parts.iter() {
            let left = first.unwrap_or(left);
            let wait = match time_of_impact(&part.core, &own, target, motion, left) {
                TimeOfImpact::Hit(hit) => hit.time,
                TimeOfImpact::Unresolved { safe_until } => {
                    self.report.unresolved += 1;
                    safe_until
                }
                // In touch from the start: its rows hold it.
                TimeOfImpact::Clear | TimeOfImpact::Touching(_) => continue,
            };
            let whole = part.whole.as_ref().unwrap_or(solid);
            let wait = match time_of_impact(whole, &own, target, motion, wait) {
                TimeOfImpact::Hit(hit) => (hit.time + SHORT * size / hit.gap_rate).max(0.0),
                _ => wait,
            };
            first = Some(wait);
        }
        first
    }

    /// Whether way `k` and the partner of a pair go so little against each other that their rows know of it,
    /// however fast both are; `way_of`: number of a slot's way.
    fn is_left_to_rows(&self, ways: &[Way], k: usize, place: u32, way_of: &[u32]) -> bool {
        let glance = self.pairs.glance(place);
        let (way, seats) = (&ways[k], &self.pool.seats);
        let other = if glance.bodies.0 == way.body {
            glance.bodies.1
        } else {
            glance.bodies.0
        };
        let Some(slot) = seats.slot(other).filter(|_| glance.holds) else {
            return false;
        };
        let slots = [way.slot, slot];
        let both = slots.map(|slot| {
            let mut stand = seats.stand_of(slot);
            if let Some(way) = ways.get(way_of[slot as usize] as usize) {
                stand.goes(way.motion.velocity, way.motion.spin);
            }
            stand
        });
        let against = Against::new([&both[0], &both[1]]);
        !self.outruns_rows(slots, &against)
    }

    /// Whether a body that is not swift is too far for a way to meet it.
    fn stays_off(&self, way: &Way, other: u32, from: SimTime, left: f64) -> bool {
        let seats = &self.pool.seats;
        let Some(slot) = seats.slot(other) else {
            return false;
        };
        // Where that one is at the end, and the way so far: what both may still go or have gone.
        let line = &seats.rig.lines[slot as usize];
        let here = way.motion.centre + way.motion.velocity * (from - way.motion.start);
        let gone = (way.motion.velocity.length() + line.v().length()) * left;
        let near = self.bodies.get(way.body).reach + seats.get(slot).reach + gone;
        // Rounding is for the search.
        (seats.centre(slot) - here).length_squared() > near * near * (1.0 + 1e-6)
    }

    /// How a body that is not swift goes through the sub-step.
    fn way_of(&self, body: u32, (from, left): (SimTime, f64)) -> Motion {
        let seats = &self.pool.seats;
        let slot = seats.slot(body);
        let Some(slot) = slot.filter(|slot| seats.get(*slot).kind != BodyKind::Fixed) else {
            return self.bodies.get(body).motion.rebased(from);
        };
        let (pose, line) = (seats.pose(slot), &seats.rig.lines[slot as usize]);
        Motion {
            start: from,
            velocity: line.v(),
            rotation: pose.rotation.turned_slightly(-left * line.w()),
            spin: line.w(),
            ..Motion::resting(pose.position - line.v() * left)
        }
    }

    /// Ends a way after `wait` seconds; pull that came later did not act.
    fn halt(&mut self, way: &mut Way, wait: f64) {
        let left = self.clock.h - wait;
        let rig = &mut self.pool.seats.rig;
        let (motion, (d, turn)) = (&way.motion, way.from);
        rig.set_displacement(
            way.slot,
            d + motion.velocity * wait,
            turn + motion.spin * wait,
        );
        let (line, pull) = (rig.lines[way.slot as usize], rig.pull(way.slot));
        rig.set_velocity(
            way.slot,
            line.v() - pull.acceleration * left,
            line.w() - pull.angular * left,
        );
        way.motion = Motion {
            velocity: Vec2::ZERO,
            spin: 0.0,
            start: motion.start + wait,
            centre: motion.centre + motion.velocity * wait,
            rotation: motion.rotation.turned_slightly(motion.spin * wait),
            ..*motion
        };
        way.stopped = true;
        self.pool.moved.push(way.body);
    }
}

/// Whether the centres of two motions come nearer to each other than `near` within `left` seconds.
fn comes_within(a: &Motion, b: &Motion, near: f64, left: f64) -> bool {
    let (apart, closing) = (b.centre - a.centre, b.velocity - a.velocity);
    let square = closing.length_squared();
    let nearest = if square > 0.0 {
        (-apart.dot(closing) / square).clamp(0.0, left)
    } else {
        0.0
    };
    let bent = 0.5 * (b.acceleration - a.acceleration).length() * left * left;
    let near = near * (1.0 + 1e-9) + bent;
    (apart + closing * nearest).length_squared() <= near * near
}
