//! Gives bodies their motions by the laws that they fly by: whole parabolas, pieces of a law, paths of an island that turns.

use std::sync::Arc;

use carom_collision::Motion;
use carom_math::{SimTime, Vec2};

use crate::law::flight::{Flight, Turn};
use crate::law::kepler::Conic;
use crate::store::bodies::Bodies;
use crate::store::state::BodyState;
use crate::store::uncommon::Lag;

/// Longest stretch of the integrator, in s.
const LONGEST: f64 = 1024.0;

/// Largest `|∇f| h²`, and damping times h, of a stretch: about a quarter of a turn about a centre. Eight points must see what the field is like.
const BENT: f64 = 2.0;

/// How far the parabola of a free body may be from its law, as a part of its reach: larger, and bodies that are not near
/// count as near; smaller, and pieces are shorter.
const APART: f64 = 1.0 / 32.0;

/// Gives a flying body its motion from `time` to `time + h`.
///
/// Under uniform gravity and a constant force that is the parabola itself, and a body that is on
/// it already is not touched. In a field and with damping its law is kept beside the motion from the
/// instant on at which the flight began, and says where the body is; the motion is the parabola through
/// both ends of the piece, for prediction.
#[expect(
    clippy::float_cmp,
    reason = "a body that is on its parabola has these very numbers"
)]
pub(crate) fn fly(bodies: &mut Bodies, index: u32, time: SimTime, h: f64) {
    let state = bodies.get(index);
    let free = if state.inverse_mass > 0.0 {
        state.gravity_scale() * bodies.pull.gravity + state.force() * state.inverse_mass
    } else {
        Vec2::ZERO
    };
    let turning = state.torque() * state.inverse_inertia;
    if !state.is_dynamic() || !bodies.bends(index) {
        let motion = &state.motion;
        let curves = state.flight.is_some();
        if curves || motion.acceleration != free || motion.angular_acceleration != turning {
            bodies.change(index, time, |motion| {
                motion.acceleration = free;
                motion.angular_acceleration = turning;
            });
        }
        let state = bodies.get_mut(index);
        state.member = false;
        state.set_lag(Lag::NONE);
        return;
    }
    let known = bodies.get(index).flight.clone();
    let flight = match known {
        Some(flight) if flight.holds(time, h) => flight,
        _ => Arc::new(new_law(bodies, index, time, h, h)),
    };
    follow(bodies, index, flight, time, h, 0.0);
}

/// Gives a free body in a field or with damping the next piece of its flight: the parabola that touches its law at `time`, for as
/// long as that stays near. When it ends.
///
/// `h` is what counts as short, in s: where a field has an edge, or a centre is near.
pub(crate) fn begin_piece(bodies: &mut Bodies, index: u32, time: SimTime, h: f64) -> SimTime {
    let known = bodies.get(index).flight.clone();
    let shortest = SHORTEST * h;
    let flight = match known {
        Some(flight) if flight.is_free() && flight.lasts(time, h) > shortest => flight,
        _ => Arc::new(new_law(bodies, index, time, h, 0.0)),
    };
    let end = lay_piece(bodies, index, &flight, time, shortest);
    let state = bodies.get_mut(index);
    state.member = false;
    state.flight = Some(flight);
    end
}

/// Gives a member of a group that turns the next piece of its path. When it ends: never, if the group changes before.
pub(crate) fn begin_held_piece(
    bodies: &mut Bodies,
    index: u32,
    flight: Arc<Flight>,
    time: SimTime,
    h: f64,
) -> SimTime {
    let left = flight.lasts(time, LONGEST);
    let end = lay_piece(bodies, index, &flight, time, SHORTEST * h);
    let state = bodies.get_mut(index);
    state.member = true;
    state.set_lag(Lag::NONE);
    state.flight = Some(flight);
    if end - time < left {
        end
    } else {
        SimTime::NEVER
    }
}

/// The parabola that touches a flight at `time`, for as long as it stays near: when that ends.
fn lay_piece(
    bodies: &mut Bodies,
    index: u32,
    flight: &Flight,
    time: SimTime,
    shortest: f64,
) -> SimTime {
    let reach = bodies.get(index).reach;
    let touching = flight.osculating(time, reach);
    let mut span = flight.lasts(time, LONGEST);
    let stays = |span: f64| touching.left_out(span) <= APART * reach;
    while span > shortest && !stays(span) {
        span *= 0.5;
    }
    // They must come to an end, whatever the field says.
    let span = if span > shortest { span } else { shortest };
    bodies.change(index, time, |motion| *motion = touching.for_seconds(span));
    time + span
}

/// Shortest piece of a flight, and shortest stretch of the integrator, as a part of a sub-step.
const SHORTEST: f64 = 1.0 / 1_048_576.0;

/// [`law_of`] a body, counted where it is not as near as the world asks for.
fn new_law(bodies: &mut Bodies, index: u32, time: SimTime, h: f64, cover: f64) -> Flight {
    let flight = law_of(bodies, index, time, h, cover);
    bodies.inaccurate += u64::from(flight.misses());
    flight
}

/// The law that a body flies by from `time` on, for `cover` seconds or more; `h` is what counts as short.
fn law_of(bodies: &Bodies, index: u32, time: SimTime, h: f64, cover: f64) -> Flight {
    let (state, pull) = (bodies.get(index), &bodies.pull);
    let (x, v) = (state.centre_at(time), state.velocity_at(time));
    let (linear, angular) = state.damping();
    let turn = Turn {
        rotation: state.rotation_at(time),
        spin: state.spin_at(time),
        pull: state.torque() * state.inverse_inertia,
        damping: angular,
    };
    let scale = state.gravity_scale();
    let push = state.force() * state.inverse_mass;
    let uniform = scale * pull.gravity + push;
    if pull.fields.is_empty() {
        return Flight::damped(time, (x, v), uniform, linear, turn);
    }
    if let [field] = pull.fields.as_slice()
        && let Some(centre) = field.newtonian()
        && uniform == Vec2::ZERO
        && linear == 0.0
        && let Some(conic) = Conic::through(centre.centre, scale * centre.strength, x, v)
        && let Some(flight) = Flight::conic(time, conic, centre.core, cover.max(h / 64.0), turn)
    {
        return flight;
    }
    let law = |x: Vec2, v: Vec2| scale * pull.at(x) + push - v * linear;
    let lengths = (SHORTEST * h, longest(bodies, index, (x, v), h));
    let centres = pull.fields.iter().filter_map(|field| field.newtonian());
    let rims: Vec<_> = centres.map(|c| (c.centre, c.core)).collect();
    let errors = (pull.error, rims.as_slice());
    Flight::integrated(time, (x, v), &law, cover, lengths, errors, turn)
}

/// How far a stretch of the integrator may go, by what the fields say of themselves, in s.
fn longest(bodies: &Bodies, index: u32, (x, v): (Vec2, Vec2), h: f64) -> f64 {
    let (state, pull) = (bodies.get(index), &bodies.pull);
    let scale = state.gravity_scale().abs();
    let push = state.gravity_scale() * pull.at(x) + state.force() * state.inverse_mass;
    let (speed, push) = (v.length(), (push - v * state.damping().0).length());
    let mut span = LONGEST;
    while span > h {
        let way = (speed + push * span) * span;
        let bent = scale * pull.gradient_bound(x, way) * span * span;
        if bent <= BENT && state.damping().0 * span <= BENT {
            return span;
        }
        span *= 0.5;
    }
    h
}

/// Gives a body the piece of its flight from `time` to `time + h`: the parabola through both ends for
/// prediction, and what its velocity lacks. `jerk` bounds what contacts add to the third derivative, in m/s³.
pub(crate) fn follow(
    bodies: &mut Bodies,
    index: u32,
    flight: Arc<Flight>,
    time: SimTime,
    h: f64,
    jerk: f64,
) {
    let ((x, v), (rotation, spin)) = (flight.at(time), flight.turn_at(time));
    let ((x_end, v_end), (_, spin_end)) = (flight.at(time + h), flight.turn_at(time + h));
    let acceleration = (x_end - x - v * h) * (2.0 / (h * h));
    let state = bodies.get(index);
    let (linear, angular) = state.damping();
    let angle = flight.angle_over(time, h);
    let angular_acceleration = (angle - spin * h) * (2.0 / (h * h));
    let lag = Lag {
        rate: (v_end - (v + acceleration * h)) / h,
        angular: (spin_end - (spin + angular_acceleration * h)) / h,
        length: h,
        ..Lag::NONE
    };
    // Path and parabola share both ends and the first velocity, so they part by at most 2/81 h³ times the
    // largest third derivative: |∇f| |v| + c |a|. A turn parts by the same, times the reach.
    let reach = (v.length() + acceleration.length() * h) * h;
    let gradient = state.gravity_scale().abs() * bodies.pull.gradient_bound(x, reach);
    let bend = gradient * reach / h + linear * (acceleration.length() + linear * v.length() * h);
    let twist = angular * (angular_acceleration.abs() + angular * spin.abs() * h) * state.reach;
    let left_out = 2.0 / 81.0 * (bend + twist + jerk) * h * h * h;
    bodies.change(index, time, |motion| {
        motion.centre = x;
        motion.velocity = v;
        motion.acceleration = acceleration;
        motion.rotation = rotation;
        motion.spin = spin;
        motion.angular_acceleration = angular_acceleration;
        motion.left_out = left_out;
    });
    let state = bodies.get_mut(index);
    state.member = false;
    state.set_lag(lag);
    state.flight = Some(flight);
}

/// The parabola through both ends of `h` seconds of a body's flight from `time` on.
pub(crate) fn motion_along(state: &BodyState, time: SimTime, h: f64) -> Motion {
    let Some(flight) = &state.flight else {
        return state.motion.rebased(time);
    };
    let ((x, v), (rotation, spin)) = (flight.at(time), flight.turn_at(time));
    let per = 2.0 / (h * h);
    Motion {
        start: time,
        centre: x,
        velocity: v,
        acceleration: (flight.at(time + h).0 - x - v * h) * per,
        rotation,
        spin,
        angular_acceleration: (flight.angle_over(time, h) - spin * h) * per,
        left_out: 0.0,
    }
}
