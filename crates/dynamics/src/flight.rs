//! Free flight: closed form in a uniform field, pieces of fourth order in any other.

use carom_math::{SimTime, Vec2};

use crate::bodies::Bodies;
use crate::body::Lag;

/// Gives a flying body its motion from `time` to `time + h`.
///
/// Under uniform gravity and a constant force that is the parabola itself, and a body that is on
/// it already is not touched. In a field one step of Nyström's method of fourth order finds where
/// the body will be; the piece between is the parabola through both ends for prediction, and a cubic
/// for the velocity.
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
    if bodies.pull.fields.is_empty() || !state.is_dynamic() {
        let motion = &state.motion;
        if motion.acceleration != free || motion.angular_acceleration != turning {
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
    let (x, v) = (state.motion.centre_at(time), state.velocity_at(time));
    let scale = state.gravity_scale;
    let push = state.force * state.inverse_mass;
    let f = |at: Vec2| scale * bodies.pull.at(at) + push;
    // Nyström, order 4 for x'' = f(x): E. Hairer, S. P. Nørsett, G. Wanner, Solving ODEs I, II.14.
    let k1 = f(x);
    let k2 = f(x + v * (0.5 * h) + k1 * (0.125 * h * h));
    let k3 = f(x + v * h + k2 * (0.5 * h * h));
    let acceleration = (k1 + 2.0 * k2) / 3.0;
    let end_velocity = v + (k1 + 4.0 * k2 + k3) * (h / 6.0);
    let lag = Lag {
        rate: (end_velocity - (v + acceleration * h)) / h,
        length: h,
    };
    // Path and parabola part by at most |ȧ| h³/24 at h/2, with |ȧ| ≤ |∇f| |v|.
    let reach = (v.length() + acceleration.length() * h) * h;
    let speed = reach / h;
    let left_out = scale.abs() * bodies.pull.gradient_bound(x, reach) * speed * h * h * h / 24.0;
    bodies.change(index, time, |motion| {
        motion.acceleration = acceleration;
        motion.angular_acceleration = turning;
        motion.left_out = left_out;
    });
    let state = bodies.get_mut(index);
    state.member = false;
    state.lag = lag;
}
