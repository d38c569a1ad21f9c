//! Gives bodies their motions by the laws that they fly by: whole parabolas, pieces of a law, paths of an island that turns.

use std::sync::Arc;

use carom_math::{SimTime, Vec2};

use crate::BodyIx;
use crate::law::damped::decays;
use crate::law::flight::{Flight, Turn};
use crate::law::integrate::Stretch;
use crate::law::kepler::Conic;
use crate::store::bodies::Bodies;
use crate::store::uncommon::Lag;

/// Longest stretch of the integrator, in s.
const LONGEST: f64 = 1024.0;

/// Largest `|∇f| h²` of a stretch, with damping `2 φ₂ |∇f| h²`: about a quarter of a turn about a centre. Eight points must see what the field is like.
const BENT: f64 = 2.0;

/// How far the parabola of a free body may be from its law, as a part of its reach: larger, and bodies that are not near
/// count as near; smaller, and pieces are shorter.
const APART: f64 = 1.0 / 32.0;

/// Gives a body that nothing holds any more its motion from `time` on.
///
/// Under uniform gravity and a constant force that is the parabola itself, and a body that is on it already is not touched. In a
/// field and with damping its pieces are laid when it takes off.
#[expect(
    clippy::float_cmp,
    reason = "a body that is on its parabola has these very numbers"
)]
pub(crate) fn fly(bodies: &mut Bodies, index: BodyIx, time: SimTime) {
    let state = bodies.get(index);
    if !state.is_dynamic() || !bodies.bends(index) {
        let motion = &state.motion;
        let (free, turning) = bodies.pull_on(index, motion.centre);
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
    }
}

/// Gives a free body in a field or with damping the next piece of its flight: the parabola that touches its law at `time`, for as
/// long as that stays near. When it ends.
///
/// A sub-step is what counts as short: where a field has an edge, or a centre is near.
pub(crate) fn begin_piece(bodies: &mut Bodies, index: BodyIx, time: SimTime) -> SimTime {
    let h = bodies.h;
    let known = bodies.get(index).flight.clone();
    let flight = match known {
        Some(flight) if flight.is_free() && flight.lasts(time, h) > SHORTEST * h => flight,
        _ => {
            let flight = law_of(bodies, index, time);
            bodies.inaccurate += u64::from(flight.misses());
            Arc::new(flight)
        }
    };
    let end = lay_piece(bodies, index, &flight, time);
    let state = bodies.get_mut(index);
    state.member = false;
    state.flight = Some(flight);
    end
}

/// Gives a member of a group that turns the next piece of its path. When it ends: never, if the group changes before.
pub(crate) fn begin_held_piece(
    bodies: &mut Bodies,
    index: BodyIx,
    flight: Arc<Flight>,
    time: SimTime,
) -> SimTime {
    let left = flight.lasts(time, LONGEST);
    let end = lay_piece(bodies, index, &flight, time);
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
fn lay_piece(bodies: &mut Bodies, index: BodyIx, flight: &Flight, time: SimTime) -> SimTime {
    let shortest = SHORTEST * bodies.h;
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

/// The law that a body flies by from `time` on.
fn law_of(bodies: &Bodies, index: BodyIx, time: SimTime) -> Flight {
    let (state, pull, h) = (bodies.get(index), &bodies.pull, bodies.h);
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
        && let Some(flight) = Flight::conic(time, conic, centre.core, h / 64.0, turn)
    {
        return flight;
    }
    let law = |x: Vec2| scale * pull.at(x) + push;
    let lengths = (SHORTEST * h, longest(bodies, index, (x, v)));
    let centres = pull.fields.iter().filter_map(|field| field.newtonian());
    let rims: Vec<_> = centres.map(|c| (c.centre, c.core)).collect();
    let stretch = Stretch::follow(&law, linear, (x, v), lengths, pull.error, &rims);
    Flight::integrated(time, stretch, turn)
}

/// How far a stretch of the integrator may go, by what the fields say of themselves, in s.
fn longest(bodies: &Bodies, index: BodyIx, (x, v): (Vec2, Vec2)) -> f64 {
    let (state, pull, h) = (bodies.get(index), &bodies.pull, bodies.h);
    let scale = state.gravity_scale().abs();
    let push = state.gravity_scale() * pull.at(x) + state.force() * state.inverse_mass;
    let (speed, push, damping) = (v.length(), push.length(), state.damping().0);
    let mut span = LONGEST;
    while span > h {
        // Of a velocity damping leaves φ₁, of what an acceleration does 2 φ₂.
        let (_, first, second) = decays(damping * span);
        let way = (speed * first + push * span * (2.0 * second)) * span;
        let bent = scale * pull.gradient_bound(x, way) * span * span * (2.0 * second);
        if bent <= BENT {
            return span;
        }
        span *= 0.5;
    }
    h
}
