//! Boxes of bodies that are stepped: made where a body is, and kept as long as it keeps the course they were made for.

use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, SimTime};

use super::courses::{Course, Goer};
use super::seats::Seats;
use super::throng::Member;
use crate::broad::{PADDING, misses, swept_box};
use crate::trees::Leaf;
use crate::{PairSearch, World};

/// From so many new boxes on those on their courses are laid out side by side, and not searched in their tree.
const MANY: usize = 32;

/// Boxes are stretched over so many ticks of a body's motion.
const TICKS: f64 = 2.0;

impl World {
    /// Whether a change by the caller took the boxes of a body.
    pub(super) fn lacks_boxes(&self, index: u32) -> bool {
        let mut shapes = self.bodies.get(index).colliders.iter();
        shapes.any(|at| self.colliders[*at as usize].node.is_none())
    }

    /// Whether the boxes that a pair was found with still overlap.
    pub(super) fn keeps(&self, place: u32) -> bool {
        let pair = self.pairs.get(place);
        let ends = [pair.colliders.0, pair.colliders.1].map(|at| &self.colliders[at as usize]);
        self.broad.keeps(&self.colliders, pair) && !misses(ends[0], ends[1])
    }

    /// New boxes for a body that went out of its old ones along its motion, `seconds` long.
    pub(super) fn hold_way(&mut self, index: u32, slot: u32, start: SimTime, seconds: f64) {
        let state = self.bodies.get(index);
        let holds = |at: &u32| {
            let collider = &self.colliders[*at as usize];
            let swept = swept_box(collider, &state.motion, start, seconds);
            collider.node.is_some() && collider.fat.contains(swept)
        };
        let seats = &self.pool.seats;
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let pull = seats.rig.pull(slot);
        let keeps = |course: &Course| course.holds(seat, line, &pull, start + seconds, 0.0);
        // Whoever left its course may have left its boxes, or met whom it could not have met on it.
        if !(seat.course.as_ref().is_none_or(keeps) && state.colliders.iter().all(holds)) {
            // The way is not over: the boxes hold what is ahead of it, and what lies behind.
            let behind = state.colliders.iter();
            let behind = behind.map(|at| {
                let collider = &self.colliders[*at as usize];
                swept_box(collider, &state.motion, start, seconds)
            });
            let behind: Vec<Aabb> = behind.collect();
            self.pool.seats.get_mut(slot).course = None;
            self.box_anew(index, slot, start, &behind);
            self.seek_partners(index, slot, start, false);
        }
    }

    /// New boxes for a body that leaves its course within `seconds`; whether it got some.
    pub(super) fn rebox(&mut self, index: u32, slot: u32, time: SimTime, seconds: f64) -> bool {
        let seats = &self.pool.seats;
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let pull = seats.rig.pull(slot);
        let holds = |course: &Course| course.holds(seat, line, &pull, time, seconds);
        if seat.course.as_ref().is_some_and(holds) && !self.lacks_boxes(index) {
            return false;
        }
        let (lasts, line_of) = (TICKS * self.settings.tick, *line);
        let seat = self.pool.seats.get_mut(slot);
        seat.roamed = f64::INFINITY;
        seat.course = Some(Course {
            from: time,
            centre: seat.base.position + line_of.d(),
            velocity: line_of.v(),
            acceleration: pull.acceleration,
            angle: seat.base_angle + line_of.turn(),
            spin: line_of.w(),
            // The last instant counts.
            lasts: lasts * (1.0 + 1e-9),
        });
        self.box_anew(index, slot, time, &[]);
        true
    }

    /// New boxes for a body that stays within its padding for a while.
    pub(super) fn rebox_slow(&mut self, index: u32, slot: u32, time: SimTime) {
        let seat = self.pool.seats.get_mut(slot);
        (seat.roamed, seat.course) = (0.0, None);
        self.box_anew(index, slot, time, &[]);
    }

    /// New boxes, stretched along a body's course; `with`: what else is to be in each.
    fn box_anew(&mut self, index: u32, slot: u32, time: SimTime, with: &[Aabb]) {
        let seat = self.pool.seats.get(slot);
        let on_course = seat.is_on_course();
        let lasts = if on_course || !with.is_empty() {
            TICKS * self.settings.tick
        } else {
            0.0
        };
        let padding = PADDING * seat.reach;
        let way = Stretch::new(&self.pool.seats, slot, lasts);
        for k in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[k];
            let mut fat = way.around(&self.colliders[at as usize].solid);
            fat = with.get(k).map_or(fat, |more| fat.union(*more));
            let fat = fat.grown(padding);
            let in_cells = on_course && self.pool.throng.takes(fat);
            self.broad.put(&mut self.colliders, at, fat, time, in_cells);
        }
        self.look_down_first(time);
    }

    /// Partners of all who got new boxes at `time`.
    pub(super) fn meet_all(&mut self, reboxed: &[(u32, u32)], time: SimTime) {
        let at_once = reboxed.len() >= MANY && self.broad.search == PairSearch::Indexed;
        if at_once {
            self.lay_out_throng(time);
        }
        for &(index, slot) in reboxed {
            self.seek_partners(index, slot, time, at_once);
        }
    }

    /// Boxes of all bodies that are on their courses side by side.
    fn lay_out_throng(&mut self, time: SimTime) {
        let mut throng = core::mem::take(&mut self.pool.throng);
        let moving = self.pool.seats.moving();
        let shapes = moving
            .filter(|(_, seat)| seat.is_on_course())
            .flat_map(|(slot, seat)| {
                let shapes = &self.bodies.get(seat.body).colliders;
                shapes.iter().map(move |at| (slot, *at))
            });
        let large = throng.lay_out(shapes.filter_map(|(slot, at)| {
            let collider = &self.colliders[at as usize];
            let goer = self.goer(slot, at, time)?;
            let fat = collider.fat;
            matches!(collider.node, Some(Leaf::OnCourse(_))).then_some(Member { fat, goer })
        }));
        self.pool.throng = throng;
        for at in large {
            let fat = self.colliders[at as usize].fat;
            self.broad.put(&mut self.colliders, at, fat, time, false);
        }
    }

    /// Parts the pairs of a body that cannot meet as both go now, and finds new ones; `at_once`: all who are on their
    /// courses lie in the throng.
    pub(super) fn seek_partners(&mut self, index: u32, slot: u32, time: SimTime, at_once: bool) {
        if self.broad.search == PairSearch::Indexed {
            self.part_off_course(index, slot, time);
        }
        for k in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[k];
            if self.broad.search == PairSearch::Indexed {
                self.meet_on_course(slot, at, time, at_once);
            } else {
                let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
                self.broad.meet(bodies, &self.colliders, pairs, at, None);
            }
        }
    }

    /// Lets the pairs of a body go whose shapes cannot meet while both keep their courses.
    fn part_off_course(&mut self, index: u32, slot: u32, time: SimTime) {
        let first = self.bodies.get(index).colliders.first();
        let own = first.and_then(|at| self.goer(slot, *at, time));
        let mut i = 0;
        while i < self.bodies.get(index).pairs.len() {
            let place = self.bodies.get(index).pairs[i];
            let pair = self.pairs.get(place);
            let (a, b) = pair.colliders;
            let (mine, other) = if pair.bodies.0 == index {
                (a, b)
            } else {
                (b, a)
            };
            let keeps = self.broad.keeps(&self.colliders, pair);
            let own = own
                .filter(|own| own.at == mine)
                .or_else(|| self.goer(slot, mine, time));
            let meets = |own: Goer| {
                let other = self.goer_of(other, time);
                other.is_none_or(|other| self.may_meet(&own, &other))
            };
            if keeps && own.is_none_or(meets) {
                i += 1;
            } else {
                self.part(place, time);
            }
        }
    }

    /// New pairs of a shape whose box is new.
    fn meet_on_course(&mut self, slot: u32, at: u32, time: SimTime, at_once: bool) {
        let mut near = core::mem::take(&mut self.pool.near);
        let fat = self.colliders[at as usize].fat;
        let mine = self.goer(slot, at, time);
        let comes = |other: &Goer| mine.as_ref().is_none_or(|mine| self.may_meet(mine, other));
        if at_once {
            near.clear();
            self.broad.search_still(&self.colliders, fat, &mut near);
            near.retain(|other| self.goer_of(*other, time).is_none_or(|other| comes(&other)));
            let owner = self.colliders[at as usize].body;
            self.pool.throng.query(fat, |member| {
                let other = &member.goer;
                // Of two who set out together the first looks for the other.
                let looks =
                    mine.is_some_and(|mine| mine.sets_out) && other.sets_out && other.body < owner;
                if other.body != owner && !looks && comes(other) {
                    near.push(other.at);
                }
            });
            near.sort_unstable();
            near.dedup();
        } else {
            self.broad.search_tree(&self.colliders, fat, &mut near);
            near.retain(|other| self.goer_of(*other, time).is_none_or(|other| comes(&other)));
        }
        for &other in &near {
            let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
            self.broad
                .pair_up(bodies, &self.colliders, pairs, at, other);
        }
        self.pool.near = near;
    }
}

/// The way of a body over some seconds, as boxes see it.
struct Stretch {
    from: Pose,
    to: Pose,
    /// What the way leaves its chord by, at most, in m.
    room: f64,
}

impl Stretch {
    fn new(seats: &Seats, slot: u32, seconds: f64) -> Self {
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let (pull, from) = (seats.rig.pull(slot), seats.pose(slot));
        let half = 0.5 * seconds * seconds;
        let to = Pose::new(
            from.position + line.v() * seconds + pull.acceleration * half,
            from.rotation
                .turned_slightly(line.w() * seconds + pull.angular * half),
        );
        // |a| h²/8 beyond the chord, and r (ω² + |α|) h²/8 for a point at distance r, which is never 2 r from it.
        let turn = line.w().abs() * seconds + pull.angular.abs() * (2.0 * half);
        let wound = pull.angular.abs() * (2.0 * half);
        let arc = if seat.rim > 0.0 {
            seat.rim * (0.125 * (turn * turn + wound)).min(2.0)
        } else {
            0.0
        };
        let bulge = 0.25 * half * pull.acceleration.length();
        Self {
            from,
            to,
            room: arc + bulge + 1e-9 * seat.reach,
        }
    }

    fn around(&self, shape: &Shape) -> Aabb {
        let ends = shape.aabb(self.from).union(shape.aabb(self.to));
        ends.grown(self.room)
    }
}
