//! Motions of bodies, written at the end of a step, and of each sub-step for a log.

use carom_collision::Motion;
use carom_math::{Pose, SimTime, Vec2};
use carom_stepped::State;

use super::{Stepping, place};
use crate::store::bodies::Bodies;
use crate::store::clock::Clock;
use crate::store::uncommon::Lag;

/// Places that differ by less, as a part of the reach and the way, are one but for rounding.
const SAME: f64 = 1e-12;

impl Stepping {
    /// Notes all poses before a sub-step within which a pose may be read, and forgets them before any other.
    pub(crate) fn note_places(&mut self, asked: bool) {
        self.places.clear();
        self.asked = asked;
        self.engine.note_ways(asked);
        if asked {
            let states = self.engine.awake();
            self.places
                .extend(states.map(|state| (place(&state), state.pose, state.turned)));
            self.places.sort_unstable_by_key(|noted| noted.0);
        }
    }

    /// Motions of the last sub-step for all that moved in it.
    pub(crate) fn write_all(&self, bodies: &mut Bodies, clock: &Clock) {
        let span = (clock.last(), clock.h);
        for state in self.engine.awake() {
            self.write_one(bodies, &state, span);
        }
    }

    /// Writes the end of a sub-step within which poses were read: with the bits that it has if none was.
    pub(crate) fn end_motions(&mut self, bodies: &mut Bodies, clock: &Clock) {
        if !self.asked || bodies.history.is_kept() {
            return;
        }
        self.note_places(false);
        // Bodies that were changed meanwhile go on from there.
        let mut changed = bodies.touched.clone();
        changed.sort_unstable();
        let span = (clock.last(), clock.h);
        for state in self.engine.awake() {
            if changed.binary_search(&place(&state)).is_err() {
                self.write_one(bodies, &state, span);
            }
        }
    }

    /// A body's motion of the sub-step from `start` on, `h` seconds long: from the velocity before to the one after, to where it is.
    ///
    /// That is where it came from, too, unless a contact stopped it or pushed it out within the sub-step. Such a body goes
    /// evenly from place to place: a path between two that are free, and no faster than it was.
    pub(super) fn write_one(&self, bodies: &mut Bodies, state: &State, (start, h): (SimTime, f64)) {
        let index = place(state);
        if bodies.get(index).is_guest {
            // Another method moves it, and what that predicted stands.
            return;
        }
        let ((v, w), (u, s)) = (state.velocity, state.before);
        let mut motion = Motion {
            start,
            centre: state.pose.position,
            velocity: u,
            acceleration: (v - u) / h,
            rotation: state.pose.rotation,
            spin: s,
            angular_acceleration: (w - s) / h,
            left_out: 0.0,
        };
        let (way, turn) = (motion.travel(h), motion.turn(h));
        motion.centre -= way;
        motion.rotation = motion.rotation.turned_slightly(-turn);
        let noted = self
            .places
            .binary_search_by_key(&index, |noted| noted.0)
            .map(|k| self.places[k]);
        // What slept as the sub-step began, and was met in it, is where it lay.
        let lay = |_| {
            let body = bodies.get(index);
            let lies = |_| (index, body.centre_pose(start), body.turned_at(start));
            state.lack.map(lies)
        };
        if let Some((_, from, turned)) = noted.map_or_else(lay, Some) {
            let reach = bodies.get(index).reach;
            let left = state.turned - turned;
            let off = (motion.centre - from.position).length() + (left - turn).abs() * reach;
            // What contacts push on a parabola may have more energy on the way than at both ends.
            let (pull, _) = bodies.pull_on(index, from.position);
            let pushed = (v - u - pull * h).length() > SAME * (v.length() + u.length());
            if state.lack.is_some() || pushed || off > SAME * (reach + way.length()) {
                let shown = match state.lack {
                    Some(lack) => lack.map(|lack| (v - lack.0, w - lack.1)),
                    None => [(u, s), (v, w)],
                };
                go_evenly(bodies, start, (from, turned), shown, state, h);
                return;
            }
        }
        bodies.go_on_as(index, &motion, state.turned - turn);
        bodies.renew(index);
    }
}

/// A body goes evenly from a pose and an angle to those of the engine within `span` seconds, while its velocity and spin are shown to
/// change evenly between two.
pub(super) fn go_evenly(
    bodies: &mut Bodies,
    start: SimTime,
    (from, turned): (Pose, f64),
    [before, after]: [(Vec2, f64); 2],
    to: &State,
    span: f64,
) {
    let index = place(to);
    let even = (
        (to.pose.position - from.position) / span,
        (to.turned - turned) / span,
    );
    let motion = Motion {
        start,
        velocity: even.0,
        rotation: from.rotation,
        spin: even.1,
        ..Motion::resting(from.position)
    };
    bodies.go_on_as(index, &motion, turned);
    let lag = Lag::of_even(even, before, after, span);
    bodies.get_mut(index).set_lag(lag);
    bodies.renew(index);
}

/// A body that fell asleep lies where the engine has it.
pub(super) fn write_rest(bodies: &mut Bodies, state: &State, time: SimTime) {
    let index = place(state);
    let turned = bodies.get(index).turned_at(time);
    let motion = Motion {
        start: time,
        rotation: state.pose.rotation,
        ..Motion::resting(state.pose.position)
    };
    bodies.go_on_as(index, &motion, turned);
    bodies.renew(index);
}
