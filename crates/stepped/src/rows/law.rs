//! Constants of a sub-step.

use crate::Settings;

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
    /// (rate, 1 + γ) between moving bodies, and against what cannot be moved, at twice the frequency.
    pub(crate) soft: [(f64, f64); 2],
}

impl Law {
    pub(crate) fn new(settings: &Settings) -> Self {
        let h = settings.substep();
        let softness = &settings.softness;
        // Above an eighth of the sub-step's rate the implicit spring is under-resolved, and hums.
        let frequency = softness.frequency.min(0.125 / h);
        let soft = |f: f64| {
            let omega = 2.0 * core::f64::consts::PI * f;
            let c = 2.0 * softness.damping_ratio + h * omega;
            (omega / c, 1.0 + softness.compliance / (h * omega * c))
        };
        Self {
            h,
            inverse_h: h.recip(),
            over_relaxation: softness.over_relaxation,
            gravity: settings.gravity.length(),
            push_out: softness.push_out,
            soft: [soft(frequency), soft(2.0 * frequency)],
        }
    }
}
