//! What happens to bodies between the sweeps, four numbers at a time.
//!
//! Behind three velocities stands the inverse mass in a line and in a start, and 0 in a pull: so that it stays what it is.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Level, Select, Simd, SimdBase, dispatch, f64x4};

use super::line::Quad;
use crate::Settings;
use crate::bodies::Bodies;

/// Damping that leaves less than this of a velocity in a sub-step makes its change no smooth one. From 1/32 on the velocity at the end
/// tells the way better than the trapezoid: of `v h` it tells f, the trapezoid `(1 + f)/2`, and the truth is `(1 − f)/(−ln f)`.
const LEFT: f64 = 1.0 / 32.0;

/// `p = v − start; start = v + h g; v = start + p`: p is the warm start, what contacts did in the last sub-step. Of damped
/// bodies `start = f v + φ h g`.
pub(crate) fn warm_start(level: Level, bodies: &mut Bodies, h: f64) {
    if bodies.damped > 0 {
        dispatch!(level, simd => warm_start_all::<_, true>(simd, bodies, h));
    } else {
        dispatch!(level, simd => warm_start_all::<_, false>(simd, bodies, h));
    }
}

#[inline(always)]
fn warm_start_all<S: Simd, const DAMPED: bool>(simd: S, bodies: &mut Bodies, h: f64) {
    let h = f64x4::splat(simd, h);
    let (start, pull) = (&mut bodies.start, &bodies.pull);
    let lines = bodies.lines.iter_mut().zip(start).zip(pull);
    for (((line, start), pull), [left, added]) in lines.zip(&bodies.drag) {
        let v = f64x4::from_slice(simd, &line.0[..4]);
        let p = v - f64x4::from_slice(simd, &start.0);
        let own = h * f64x4::from_slice(simd, &pull.0);
        let pulled = if DAMPED {
            f64x4::from_slice(simd, &left.0) * v + f64x4::from_slice(simd, &added.0) * own
        } else {
            v + own
        };
        pulled.store_slice(&mut start.0);
        (pulled + p).store_slice(&mut line.0[..4]);
    }
}

/// `d += h v`; which bodies go far by that, and where they were.
pub(crate) fn displace(level: Level, bodies: &mut Bodies, h: f64, far: &mut Vec<(u32, Quad)>) {
    far.clear();
    dispatch!(level, simd => displace_all(simd, bodies, h, far));
}

#[inline(always)]
fn displace_all<S: Simd>(simd: S, bodies: &mut Bodies, h: f64, far: &mut Vec<(u32, Quad)>) {
    let h = f64x4::from_slice(simd, &[h, h, h, 0.0]);
    for ((line, limit), at) in bodies.lines.iter_mut().zip(&bodies.limits).zip(0..) {
        let d = f64x4::from_slice(simd, &line.0[4..]);
        let step = h * f64x4::from_slice(simd, &line.0[..4]);
        if limit.is_far(step[0] * step[0] + step[1] * step[1], step[2]) {
            far.push((at, Quad([line.0[4], line.0[5], line.0[6], 0.0])));
        }
        (d + step).store_slice(&mut line.0[4..]);
    }
}

/// Makes displacements of second order where velocities change smoothly: `d −= ½ h Δv`. Notes whether a body may
/// deviate from its predicted motion in the `rest` of the tick.
///
/// `h v` with the velocity at the end overshoots the trapezoid by h/2 Δv: g h²/2 in free flight,
/// and likewise where friction brakes. Where a contact stopped the body at its surface there is
/// nothing to take back; a stop is what changes the velocity by more than four times the pull.
pub(crate) fn correct(level: Level, bodies: &mut Bodies, settings: &Settings, h: f64, rest: f64) {
    if bodies.damped > 0 {
        dispatch!(level, simd => correct_all::<_, true>(simd, bodies, settings, h, rest));
    } else {
        dispatch!(level, simd => correct_all::<_, false>(simd, bodies, settings, h, rest));
    }
}

#[inline(always)]
fn correct_all<S: Simd, const DAMPED: bool>(
    simd: S,
    bodies: &mut Bodies,
    settings: &Settings,
    h: f64,
    rest: f64,
) {
    let (h, half) = (f64x4::splat(simd, h), f64x4::splat(simd, 0.5 * h));
    let (mut deviates, mut beyond) = (false, 0.0_f64);
    let lines = bodies.lines.iter_mut().zip(&bodies.start).zip(&bodies.pull);
    let more = bodies.drag.iter().zip(&bodies.foreseen).zip(&bodies.limits);
    for (((line, start), pull), (([left, added], foreseen), limit)) in lines.zip(more) {
        let v = f64x4::from_slice(simd, &line.0[..4]);
        let start = f64x4::from_slice(simd, &start.0);
        // What pull and damping did: `start − v` with the v before, and exactly `h g` without damping (f = φ = 1), so that no
        // body depends on whether another one is damped: `start − (start − φ h g)/f = (φ h g − (1 − f) start)/f`.
        let pulled = h * f64x4::from_slice(simd, &pull.0);
        let (own, change) = if DAMPED {
            let added = f64x4::from_slice(simd, &added.0) * pulled;
            let left = f64x4::from_slice(simd, &left.0);
            let own = (added - (1.0 - left) * start) / left;
            let smooth = left.simd_gt(f64x4::splat(simd, LEFT));
            let none = f64x4::splat(simd, 0.0);
            (
                smooth.select(own, none),
                smooth.select(v - start + own, none),
            )
        } else {
            (pulled, v - start + pulled)
        };
        let square = change[0] * change[0] + change[1] * change[1];
        if square <= 16.0 * (own[0] * own[0] + own[1] * own[1]) {
            let d = f64x4::from_slice(simd, &line.0[4..]);
            (d - half * change).store_slice(&mut line.0[4..]);
        }
        let off = (v - f64x4::from_slice(simd, &foreseen.0)).abs();
        let off = off[0].max(off[1]) + off[2] * limit.reach;
        deviates |= limit.deviates(settings.margin, off * rest, line.turn());
        beyond = beyond.max(limit.beyond_box(settings.margin, off * h[0]));
    }
    bodies.may_deviate = deviates;
    bodies.beyond_boxes = beyond;
}

/// The velocity at the beginning of a sub-step, which `start` comes from by pull and damping; where damping left nearly nothing of it
/// that is unknown, and `start` stands for it.
pub(crate) fn velocity_before(
    start: &Quad,
    pull: &Quad,
    [left, added]: &[Quad; 2],
    h: f64,
) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        if left.0[k] > LEFT {
            (start.0[k] - added.0[k] * (h * pull.0[k])) / left.0[k]
        } else {
            start.0[k]
        }
    })
}
