//! Bodies as the sweeps see them.

use carom_math::{Vec2, vec2};

use super::transpose::{Numbers, NumbersMut};

/// A body in the solver, in one cache line:
///
/// ```text
/// vx vy ω m⁻¹ | dx dy dθ I⁻¹
/// ```
/// d and θ are what it moved and turned by since its base pose. What cannot be moved has m⁻¹ = I⁻¹ = 0, so
/// that writing its line back changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Line(pub(crate) [f64; 8]);

impl Line {
    /// The line that empty lanes name for both bodies: its matrix is regular, its velocity stays 0.
    pub(crate) const EMPTY: Self = Self([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    /// The line of all fixed bodies.
    pub(crate) const GROUND: Self = Self([0.0; 8]);

    pub(crate) const fn new(v: Vec2, w: f64, inverse_mass: f64, inverse_inertia: f64) -> Self {
        Self([v.x, v.y, w, inverse_mass, 0.0, 0.0, 0.0, inverse_inertia])
    }

    pub(crate) const fn v(&self) -> Vec2 {
        vec2(self.0[0], self.0[1])
    }

    pub(crate) const fn w(&self) -> f64 {
        self.0[2]
    }

    pub(crate) const fn d(&self) -> Vec2 {
        vec2(self.0[4], self.0[5])
    }

    pub(crate) const fn turn(&self) -> f64 {
        self.0[6]
    }

    /// Displacement and turn since the base pose.
    pub(crate) const fn displacement(&self) -> Quad {
        Quad::new(self.d(), self.turn())
    }

    /// Whether velocity and displacement are: what is not times 0 is no number.
    pub(crate) fn is_finite(&self) -> bool {
        let [vx, vy, w, _, dx, dy, turn, _] = self.0;
        (vx + vy + w + dx + dy + turn) * 0.0 == 0.0
    }

    pub(crate) const fn inverse_mass(&self) -> f64 {
        self.0[3]
    }

    pub(crate) const fn inverse_inertia(&self) -> f64 {
        self.0[7]
    }

    /// In kg m², if contacts turn it; else 0.
    pub(crate) fn inertia(&self) -> f64 {
        quotient(1.0, self.inverse_inertia())
    }

    pub(crate) const fn set_velocity(&mut self, v: Vec2, w: f64) {
        (self.0[0], self.0[1], self.0[2]) = (v.x, v.y, w);
    }

    /// Adds to its velocity.
    pub(crate) fn add(&mut self, push: &Quad) {
        for (v, push) in self.0[..3].iter_mut().zip(push.0) {
            *v += push;
        }
    }

    pub(crate) const fn set_displacement(&mut self, d: Vec2, turn: f64) {
        (self.0[4], self.0[5], self.0[6]) = (d.x, d.y, turn);
    }

    pub(crate) fn displace(&mut self, way: Vec2) {
        self.0[4] += way.x;
        self.0[5] += way.y;
    }

    /// It counts from where it is now.
    pub(crate) const fn clear_displacement(&mut self) {
        (self.0[4], self.0[5], self.0[6]) = (0.0, 0.0, 0.0);
    }
}

/// x times a mass or inertia, given its inverse; 0 of what cannot be moved.
pub(crate) fn quotient(x: f64, inverse: f64) -> f64 {
    if inverse > 0.0 { x / inverse } else { 0.0 }
}

/// A velocity or acceleration: vx vy ω and a fourth number that stays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Quad(pub(crate) [f64; 4]);

impl Quad {
    pub(crate) const fn new(v: Vec2, w: f64) -> Self {
        Self([v.x, v.y, w, 0.0])
    }

    pub(crate) const fn v(&self) -> Vec2 {
        vec2(self.0[0], self.0[1])
    }

    pub(crate) const fn w(&self) -> f64 {
        self.0[2]
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.0[0] += other.0[0];
        self.0[1] += other.0[1];
        self.0[2] += other.0[2];
    }
}

impl Numbers for Line {
    fn numbers(&self) -> &[f64] {
        &self.0
    }
}

impl NumbersMut for Line {
    fn first(&mut self) -> &mut [f64; 4] {
        self.0.first_chunk_mut().expect("eight numbers")
    }
}

impl Numbers for Quad {
    fn numbers(&self) -> &[f64] {
        &self.0
    }
}

impl NumbersMut for Quad {
    fn first(&mut self) -> &mut [f64; 4] {
        &mut self.0
    }
}
