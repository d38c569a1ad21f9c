//! What a shock loses: never less than nothing.
//!
//! With friction, or different e, Newton's law at many contacts may give back more than was there. A common stop of all never does, and
//! what lies between two outcomes has impulses that push, in their cones, and closes nothing either. So the outcome is then
//! the one between both that loses nothing:
//!
//! ```text
//! j = (1 − s) j_stop + s j_Newton,    s < 1 such that Σ j · ½ (u⁻ + u⁺) = 0
//! ```

use carom_math::perp;

use super::{SWEEPS, Shock, TURN};
use crate::impact::Sweeper;

impl Shock {
    /// Energy lost, and energy put in by driven bodies, in J: impulse × mean velocities, contact by
    /// contact. All impulses act together, so the mean is that of before and after all of them.
    pub(crate) fn works(&self) -> (f64, f64) {
        let (mut loss, mut driven) = (0.0, 0.0);
        for strike in &self.strikes {
            let contact = &strike.contact;
            let impulse = contact.normal * strike.normal_impulse
                + perp(contact.normal) * strike.tangential_impulse;
            let mean = |end: usize| {
                let shaken = &self.bodies[end];
                0.5 * (shaken.before.velocity_of(contact.point)
                    + shaken.after.velocity_of(contact.point))
            };
            let (a, b) = (mean(strike.ends.0), mean(strike.ends.1));
            loss -= impulse.dot(b - a);
            if self.bodies[strike.ends.0].before.inverse_mass == 0.0 {
                driven += impulse.dot(a);
            }
            if self.bodies[strike.ends.1].before.inverse_mass == 0.0 {
                driven -= impulse.dot(b);
            }
        }
        (loss, driven)
    }

    /// Goes back towards a common stop as far as it takes to gain no energy.
    pub(super) fn gain_nothing(&mut self, settled: f64) {
        let newton = self.works().0;
        if newton >= 0.0 {
            return;
        }
        let stop = self.stop(settled);
        self.operations = stop.operations;
        // What is lost is a quadratic in s, and concave: impulses are linear in it, and so are velocities.
        let half = self.between(&stop, 0.5).works().0;
        let lost = stop.works().0.max(0.0);
        let bend = 2.0 * (lost + newton - 2.0 * half);
        let slope = newton - lost - bend;
        let root = (slope * slope - 4.0 * bend * lost).max(0.0).sqrt();
        // lost + slope s + bend s² = 0, without a difference of what is nearly equal.
        let part = if slope > 0.0 {
            (-slope - root) / (2.0 * bend)
        } else {
            2.0 * lost / (root - slope)
        };
        let part = if part.is_finite() {
            part.clamp(0.0, 1.0)
        } else {
            0.0
        };
        *self = self.between(&stop, part);
    }

    /// The same contacts with nothing given back.
    fn stop(&self, settled: f64) -> Self {
        let mut stop = self.clone();
        stop.begin_anew();
        for strike in &mut stop.strikes {
            strike.target = 0.0;
        }
        let mut sweeper = Sweeper::default();
        stop.hand_over(&mut sweeper);
        for _ in 0..SWEEPS {
            stop.operations += TURN * stop.strikes.len() as u64;
            if sweeper.sweep() <= settled {
                break;
            }
        }
        stop.take_over(&sweeper);
        stop
    }

    /// What lies `part` of the way from another outcome of the same contacts to this one.
    fn between(&self, other: &Self, part: f64) -> Self {
        let mix = |from: f64, to: f64| from + (to - from) * part;
        let mut mixed = self.clone();
        for (mine, theirs) in mixed.bodies.iter_mut().zip(&other.bodies) {
            let (to, from) = (&mut mine.after, &theirs.after);
            to.velocity = from.velocity + (to.velocity - from.velocity) * part;
            to.spin = mix(from.spin, to.spin);
        }
        for (to, from) in mixed.strikes.iter_mut().zip(&other.strikes) {
            to.normal_impulse = mix(from.normal_impulse, to.normal_impulse);
            to.tangential_impulse = mix(from.tangential_impulse, to.tangential_impulse);
        }
        mixed
    }
}
