//! Free flight: closed form in a uniform field, with damping and about a Newtonian centre; an
//! integrator of order 15 in any other field.

mod damped;
mod integrate;
mod kepler;
mod law;
#[cfg(test)]
mod tests;

use carom_collision::Motion;
use carom_math::{SimTime, Vec2};

use crate::bodies::Bodies;
use crate::state::{BodyState, Lag};
use damped::damped;
pub(crate) use integrate::{NODES, ROUNDS, STANDS};
use kepler::Conic;
pub(crate) use law::{Flight, Turn};

/// Sub-steps that one stretch of the integrator may cover.
const LONGEST: f64 = 64.0;

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
        state.gravity_scale * bodies.pull.gravity + state.force * state.inverse_mass
    } else {
        Vec2::ZERO
    };
    let turning = state.torque * state.inverse_inertia;
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
        state.lag = Lag::default();
        return;
    }
    let known = bodies.get(index).flight.clone();
    let flight = match known {
        Some(flight) if flight.holds(time, h) => flight,
        _ => Box::new(law_of(bodies, index, time, h)),
    };
    follow(bodies, index, flight, time, h, 0.0);
}

/// The law that a body flies by from `time` on.
fn law_of(bodies: &Bodies, index: u32, time: SimTime, h: f64) -> Flight {
    let (state, pull) = (bodies.get(index), &bodies.pull);
    let (x, v) = (state.centre_at(time), state.velocity_at(time));
    let (linear, angular) = state.damping;
    let turn = Turn {
        rotation: state.rotation_at(time),
        spin: state.spin_at(time),
        pull: state.torque * state.inverse_inertia,
        damping: angular,
    };
    let scale = state.gravity_scale;
    let push = state.force * state.inverse_mass;
    let uniform = scale * pull.gravity + push;
    if pull.fields.is_empty() {
        return Flight::damped(time, (x, v), uniform, linear, turn);
    }
    if let [field] = pull.fields.as_slice()
        && let Some(centre) = field.newtonian()
        && uniform == Vec2::ZERO
        && linear == 0.0
        && let Some(conic) = Conic::through(centre.centre, scale * centre.strength, x, v)
        && let Some(flight) = Flight::conic(time, conic, centre.core, h, turn)
    {
        return flight;
    }
    let law = |x: Vec2, v: Vec2| scale * pull.at(x) + push - v * linear;
    let lengths = (h, LONGEST * h);
    Flight::integrated(time, (x, v), &law, lengths, pull.error, turn)
}

/// Gives a body the piece of its flight from `time` to `time + h`: the parabola through both ends for
/// prediction, and what its velocity lacks. `jerk` bounds what contacts add to the third derivative, in m/s³.
pub(crate) fn follow(
    bodies: &mut Bodies,
    index: u32,
    flight: Box<Flight>,
    time: SimTime,
    h: f64,
    jerk: f64,
) {
    let ((x, v), (rotation, spin)) = (flight.at(time), flight.turn_at(time));
    let ((x_end, v_end), (_, spin_end)) = (flight.at(time + h), flight.turn_at(time + h));
    let acceleration = (x_end - x - v * h) * (2.0 / (h * h));
    let state = bodies.get(index);
    let (linear, angular) = state.damping;
    let angle = flight.angle_over(time, h);
    let angular_acceleration = (angle - spin * h) * (2.0 / (h * h));
    let lag = Lag {
        rate: (v_end - (v + acceleration * h)) / h,
        angular: (spin_end - (spin + angular_acceleration * h)) / h,
        length: h,
    };
    // Path and parabola share both ends and the first velocity, so they part by at most 2/81 h³ times the
    // largest third derivative: |∇f| |v| + c |a|. A turn parts by the same, times the reach.
    let reach = (v.length() + acceleration.length() * h) * h;
    let gradient = state.gravity_scale.abs() * bodies.pull.gradient_bound(x, reach);
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
    state.lag = lag;
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

/// Velocity in m/s and spin in rad/s that a body has after `h` seconds of a constant pull, in m/s² and rad/s²,
/// and of its damping.
pub(crate) fn driven(
    state: &BodyState,
    (v, w): (Vec2, f64),
    (pull, twist): (Vec2, f64),
    h: f64,
) -> (Vec2, f64) {
    if !state.is_damped() {
        return (v + pull * h, w + twist * h);
    }
    let (linear, angular) = state.damping;
    let along = |v: f64, a: f64| damped(v, a, linear, h).1;
    let velocity = Vec2::new(along(v.x, pull.x), along(v.y, pull.y));
    (velocity, damped(w, twist, angular, h).1)
}
