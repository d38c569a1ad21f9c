//! Constants of a sub-step.

use crate::Settings;

/// Overlaps deeper than this part of the smaller extent are undone by displacement. A hundred boxes that were put at one place part with
/// 1.5 J of kinetic energy at most (eight seeds); 0.03: 3.3 J.
const DEEP: f64 = 0.02;

/// Unless a load of so many bodies presses them in as deep: displaced from under its load a pile never comes to rest. Without it 800
/// concave bodies of the preset `fast` move at 0.08 m/s after 25 s, for ever; with it at 1e-13 m/s.
const LOADS: f64 = 20.0;

/// The soft law for sub-steps of one length.
///
/// ```text
/// ω = 2π f,  c = 2ζ + hω,  rate = ω/c,  γ = κ/(hωc)
/// ```
/// so that at rest `gap = −κ load (1/m)/ω²`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law {
    /// Length of a sub-step, in s, and its inverse.
    pub(crate) h: f64,
    pub(crate) inverse_h: f64,
    pub(crate) over_relaxation: f64,
    /// In m/s².
    pub(crate) gravity: f64,
    /// Fastest push-out of an overlap, in m/s.
    pub(crate) push_out: f64,
    /// What a contact gives way by under the weight of one body at rest, in m.
    yields: f64,
    /// (rate, 1 + γ) between moving bodies, and against what cannot be moved, at twice the frequency.
    pub(crate) soft: [(f64, f64); 2],
}

impl Law {
    pub(crate) fn new(settings: &Settings) -> Self {
        let h = settings.substep();
        let softness = &settings.softness;
        // Above an eighth of the sub-step's rate the implicit spring is under-resolved, and hums.
        let frequency = softness.frequency.min(0.125 / h);
        let omega = 2.0 * core::f64::consts::PI * frequency;
        let soft = |omega: f64| {
            let c = 2.0 * softness.damping_ratio + h * omega;
            (omega / c, 1.0 + softness.compliance / (h * omega * c))
        };
        let gravity = settings.gravity.length();
        Self {
            h,
            inverse_h: h.recip(),
            over_relaxation: softness.over_relaxation,
            gravity,
            push_out: softness.push_out,
            yields: softness.compliance * gravity / (omega * omega),
            soft: [soft(omega), soft(2.0 * omega)],
        }
    }

    /// The least gap that the sweeps see of a piece of that extent, in m: what is deeper was put so, or is crushed.
    pub(crate) fn deepest(&self, extent: f64) -> f64 {
        -(DEEP * extent).max(LOADS * self.yields)
    }
}
