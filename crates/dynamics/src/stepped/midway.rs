//! Who is set moving in the middle of a sub-step stops where it first touches what it would pass through.
//!
//! No row knows of it before the next sub-step begins. So before time goes on what is left of this one is searched, for
//! those who are swift, as after a sub-step ([`super::swift`]): who would pass through something ends its way there, and keeps its speed.
//! Who asks meanwhile sees it go there evenly.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use carom_collision::Motion;
use carom_math::{SimTime, Vec2};

use super::swift::Touch;
use crate::World;
use crate::uncommon::Lag;

/// The way of a swift body through the rest of a sub-step.
#[derive(Clone, Copy, Debug)]
struct Way {
    body: u32,
    motion: Motion,
    /// When it ends before the sub-step does.
    stops: Option<SimTime>,
}

impl World {
    /// Notes that a caller changed a body; whether that was in the middle of a sub-step.
    pub(crate) fn note_midway(&mut self, index: u32, time: SimTime) {
        if !self.clock.is_within(time) {
            return;
        }
        let midway = &mut self.pool.midway;
        midway.push(index);
        // A caller may change a body any number of times.
        if midway.len() > 2 * self.bodies.places() + 64 {
            midway.sort_unstable();
            midway.dedup();
        }
    }

    /// Before time goes on within a sub-step: who was changed there does not pass through others, nor others through it.
    pub(super) fn stop_midway(&mut self) {
        if self.pool.midway.is_empty() {
            return;
        }
        let mut changed = core::mem::take(&mut self.pool.midway);
        changed.sort_unstable();
        changed.dedup();
        changed.retain(|index| self.bodies.is_alive(*index));
        let (now, end) = (self.clock.now, self.clock.next());
        let mut ways = self.swift_ways(&changed, now, end);
        if ways.is_empty() {
            return;
        }
        // Boxes that hold the new way know only whom the old one could meet.
        for &index in &changed {
            self.meet_near(index);
        }
        let mut touches = BinaryHeap::new();
        for k in 0..ways.len() {
            let is_new = |body: u32| changed.binary_search(&body).is_ok();
            let mine = is_new(ways[k].body);
            for i in 0..self.bodies.get(ways[k].body).pairs.len() {
                let place = self.bodies.get(ways[k].body).pairs[i];
                let other = self.pairs.get(place).other(ways[k].body);
                let asked = ways[..k]
                    .binary_search_by_key(&other, |way| way.body)
                    .is_ok();
                if (mine || is_new(other)) && !asked {
                    self.search_midway(&ways, k, (now, end), place, &mut touches);
                }
            }
        }
        while let Some(Reverse(touch)) = touches.pop() {
            let ends = [Some(touch.a), touch.b];
            let mut stopping = ends.into_iter().flatten();
            if stopping.clone().any(|k| ways[k].stops.is_some()) {
                continue;
            }
            for k in stopping.clone() {
                let way = &mut ways[k];
                way.stops = Some(touch.time);
                way.motion = Motion {
                    velocity: Vec2::ZERO,
                    acceleration: Vec2::ZERO,
                    spin: 0.0,
                    angular_acceleration: 0.0,
                    ..way.motion.rebased(touch.time)
                };
            }
            // Who is still under way may meet one that has stopped.
            let stopped = stopping.by_ref().map(|k| ways[k].body);
            for body in stopped.collect::<Vec<_>>() {
                for i in 0..self.bodies.get(body).pairs.len() {
                    let place = self.bodies.get(body).pairs[i];
                    let other = self.pairs.get(place).other(body);
                    if let Ok(k) = ways.binary_search_by_key(&other, |way| way.body)
                        && ways[k].stops.is_none()
                    {
                        self.search_midway(&ways, k, (touch.time, end), place, &mut touches);
                    }
                }
            }
        }
        for way in ways {
            if let Some(time) = way.stops {
                self.go_evenly(way.body, time, (now, end));
            }
        }
    }

    /// The ways of all who are swift, in order of bodies: of those who were changed just now, of those who were before
    /// in this sub-step, and of those whom it found swift.
    fn swift_ways(&self, changed: &[u32], now: SimTime, end: SimTime) -> Vec<Way> {
        let (h, seats) = (self.clock.h, &self.pool.seats);
        let under_way = seats.rig.swift.iter();
        let under_way = under_way.map(|swift| seats.get(swift.slot).body);
        let mut all: Vec<u32> = (under_way.chain(changed.iter().copied()))
            .chain(self.bodies.touched.iter().copied())
            .filter(|&body| (body as usize) < self.bodies.places() && self.bodies.is_alive(body))
            .collect();
        all.sort_unstable();
        all.dedup();
        all.retain(|&body| {
            let state = self.bodies.get(body);
            let limit = seats.limit_of(state, &self.colliders);
            let motion = &state.motion;
            state.is_dynamic()
                && !state.asleep
                && [now, end].into_iter().any(|time| {
                    limit.is_exceeded_at(motion.velocity_at(time), motion.spin_at(time), h)
                })
        });
        let way = |body| Way {
            body,
            motion: self.bodies.get(body).motion.rebased(now),
            stops: None,
        };
        all.into_iter().map(way).collect()
    }

    /// Enters the first touch of way `k` with its partner of a pair.
    fn search_midway(
        &mut self,
        ways: &[Way],
        k: usize,
        (from, end): (SimTime, SimTime),
        place: u32,
        touches: &mut BinaryHeap<Reverse<Touch>>,
    ) {
        let way = &ways[k];
        let pair = self.pairs.get(place);
        let (other, colliders) = (pair.other(way.body), pair.colliders);
        let (mine, theirs) = pair.shapes_from(way.body);
        let partner = ways.binary_search_by_key(&other, |way| way.body).ok();
        let motion = partner.map_or_else(|| &self.bodies.get(other).motion, |k| &ways[k].motion);
        let motion = motion.rebased(from);
        let own = (way.body, way.motion.rebased(from));
        let wait = self.first_touch(own, mine, (other, theirs), &motion, end - from);
        if let Some(wait) = wait {
            touches.push(Reverse(Touch {
                time: from + wait,
                colliders,
                place,
                a: k,
                b: partner.filter(|k| ways[*k].stops.is_none()),
            }));
        }
    }

    /// Has a body be at the end of a sub-step where it is at `stop`, with the velocity that it has there.
    fn go_evenly(&mut self, index: u32, stop: SimTime, (now, end): (SimTime, SimTime)) {
        let state = self.bodies.get(index);
        let left = end - now;
        let way = state.motion.centre_at(stop) - state.motion.centre_at(now);
        let even = (
            way / left,
            (state.turn_by(stop) - state.turn_by(now)) / left,
        );
        let [before, after] =
            [now, stop].map(|time| (state.velocity_at(time), state.spin_at(time)));
        self.bodies.change(index, now, |motion| {
            *motion = Motion {
                velocity: even.0,
                acceleration: Vec2::ZERO,
                spin: even.1,
                angular_acceleration: 0.0,
                ..*motion
            };
        });
        let lag = Lag::of_even(even, before, after, left);
        self.bodies.get_mut(index).set_lag(lag);
    }
}
