//! Pairs of pieces to their manifolds: what rows store, and nothing else.
//!
//! All lengths are relative to the two centres of mass, so that nothing is lost far from the origin.

mod eight;
mod faces;
mod hulls;
#[cfg(test)]
pub(crate) mod naive;
mod scene;
mod wide;

use carom_math::{Vec2, cross};

pub(crate) use eight::{Eight, Found};
pub(crate) use hulls::collide_any;
use scene::HYSTERESIS;
pub(crate) use scene::{Scene, arc};
pub(crate) use wide::collide_eight;

/// Where two pieces meet, in the letters of [`crate::rows::Block`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Manifold {
    /// Unit normal from A to B.
    pub(crate) normal: Vec2,
    /// `r_A × n` and `r_B × n` of point 1, the one farther along the normal turned by +90°.
    pub(crate) arm_a: f64,
    pub(crate) arm_b: f64,
    /// From point 2 to point 1: both arms of point 2 are larger by it.
    pub(crate) length: f64,
    /// 1 or 2.
    pub(crate) points: u8,
    /// `r_A · n` and `r_B · n` where friction acts, at the nearer point: on either surface, as midway between what touches later
    /// would be far off where a small body is fast; midway between surfaces that overlap.
    pub(crate) tangent_a: f64,
    pub(crate) tangent_b: f64,
    /// Gaps at the poses given, in m; below zero the pieces overlap.
    pub(crate) gaps: [f64; 2],
}

impl Manifold {
    /// The lesser gap.
    pub(crate) const fn gap(&self) -> f64 {
        if self.points == 2 && self.gaps[1] < self.gaps[0] {
            self.gaps[1]
        } else {
            self.gaps[0]
        }
    }

    pub(crate) fn single(normal: Vec2, arms: [Vec2; 2], gap: f64) -> Self {
        Self {
            normal,
            arm_a: cross(arms[0], normal),
            arm_b: cross(arms[1], normal),
            length: 0.0,
            points: 1,
            tangent_a: arms[0].dot(normal) - 0.5 * gap.max(0.0),
            tangent_b: arms[1].dot(normal) + 0.5 * gap.max(0.0),
            gaps: [gap; 2],
        }
    }
}
