//! What happens to bodies between the sweeps, four numbers at a time.
//!
//! A [`Quad`] is a velocity with the inverse mass behind it, as in a line: sums and differences of two of
//! them leave that alone, since what stands behind a pull is 0.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_math::{Vec2, vec2};
use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x4};

use super::wide::Line;

/// vx vy ω m⁻¹, or ax ay α 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Quad([f64; 4]);

impl Quad {
    /// Behind [`Line::EMPTY`].
    pub(crate) const EMPTY: Self = Self([0.0, 0.0, 0.0, 1.0]);

    pub(crate) const fn of(v: Vec2, w: f64, behind: f64) -> Self {
        Self([v.x, v.y, w, behind])
    }

    pub(crate) const fn v(&self) -> Vec2 {
        vec2(self.0[0], self.0[1])
    }

    pub(crate) const fn w(&self) -> f64 {
        self.0[2]
    }

    pub(crate) const fn set(&mut self, v: Vec2, w: f64) {
        (self.0[0], self.0[1], self.0[2]) = (v.x, v.y, w);
    }

    pub(crate) fn add(&mut self, v: Vec2, w: f64) {
        self.0[0] += v.x;
        self.0[1] += v.y;
        self.0[2] += w;
    }
}

/// Bodies of a range of slots, as the sweeps leave and find them.
pub(crate) struct Bodies<'a> {
    pub(crate) lines: &'a mut [Line],
    /// Velocities just before contacts acted.
    pub(crate) start: &'a mut [Quad],
    pub(crate) pull: &'a [Quad],
}

impl<'a> Bodies<'a> {
    /// The first `count` of them, and the others.
    pub(crate) fn split_at(self, count: usize) -> (Self, Self) {
        let (lines, start) = (
            self.lines.split_at_mut(count),
            self.start.split_at_mut(count),
        );
        let pull = self.pull.split_at(count);
        let bodies =
            |lines: &'a mut [Line], start: &'a mut [Quad], pull| Self { lines, start, pull };
        (
            bodies(lines.0, start.0, pull.0),
            bodies(lines.1, start.1, pull.1),
        )
    }
}

/// `p = v − start; start = v + h a; v = start + p`
pub(crate) fn pull_and_warm(level: Level, bodies: &mut Bodies<'_>, h: f64) {
    dispatch!(level, simd => warm_all(simd, bodies, h));
}

/// `d += h v`
pub(crate) fn displace(level: Level, bodies: &mut Bodies<'_>, h: f64) {
    dispatch!(level, simd => displace_all(simd, bodies, h));
}

/// Makes displacements of second order where velocities change smoothly.
///
/// `h v` with the velocity at the end overshoots the trapezoid by h/2 Δv: g h²/2 in free flight,
/// and likewise where friction brakes. Where a contact stopped the body at its surface there is
/// nothing to take back; a stop is what changes the velocity by more than four times the pull.
pub(crate) fn second_order(level: Level, bodies: &mut Bodies<'_>, h: f64) {
    dispatch!(level, simd => bend_all(simd, bodies, h));
}

#[inline(always)]
fn warm_all<S: Simd>(simd: S, bodies: &mut Bodies<'_>, h: f64) {
    let h = f64x4::splat(simd, h);
    let pulls = bodies.pull;
    for ((line, start), pull) in bodies.lines.iter_mut().zip(&mut *bodies.start).zip(pulls) {
        let v = f64x4::from_slice(simd, &line.0[..4]);
        let p = v - f64x4::from_slice(simd, &start.0);
        let pulled = v + f64x4::from_slice(simd, &pull.0) * h;
        pulled.store_slice(&mut start.0);
        (pulled + p).store_slice(&mut line.0[..4]);
    }
}

#[inline(always)]
fn displace_all<S: Simd>(simd: S, bodies: &mut Bodies<'_>, h: f64) {
    let hs = [h, h, h, 0.0];
    let hs = f64x4::from_slice(simd, &hs);
    for line in &mut *bodies.lines {
        let v = f64x4::from_slice(simd, &line.0[..4]);
        let d = f64x4::from_slice(simd, &line.0[4..]);
        (d + hs * v).store_slice(&mut line.0[4..]);
    }
}

#[inline(always)]
fn bend_all<S: Simd>(simd: S, bodies: &mut Bodies<'_>, h: f64) {
    let hs = f64x4::splat(simd, h);
    let most = 16.0 * h * h;
    let starts = &*bodies.start;
    for ((line, start), pull) in bodies.lines.iter_mut().zip(starts).zip(bodies.pull) {
        let v = f64x4::from_slice(simd, &line.0[..4]);
        let a = f64x4::from_slice(simd, &pull.0);
        let dv = v - f64x4::from_slice(simd, &start.0) + a * hs;
        if dv[0] * dv[0] + dv[1] * dv[1] <= most * pull.v().length_squared() {
            let d = f64x4::from_slice(simd, &line.0[4..]);
            (d - f64x4::splat(simd, 0.5 * h) * dv).store_slice(&mut line.0[4..]);
        }
    }
}
