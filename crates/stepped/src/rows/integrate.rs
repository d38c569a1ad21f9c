//! What happens to bodies between the sweeps, four numbers or four bodies at a time.
//!
//! Behind three velocities stands the inverse mass in a line and in a start, and 0 in a pull: so that it stays what it is.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_math::{Vec2, vec2};
use fearless_simd::{
    ExtractToken, Level, Select, Simd, SimdBase, SimdMask, dispatch, f64x4, mask64x4,
};

use super::line::{Line, Quad};
use super::transpose::{Numbers, Wide, rows_of};
use crate::bodies::{BEND, Bodies, FAST, Limit, number};
use crate::{LineIx, Settings};

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
pub(crate) fn displace(level: Level, bodies: &mut Bodies, h: f64, far: &mut Vec<(LineIx, Quad)>) {
    far.clear();
    dispatch!(level, simd => displace_all(simd, bodies, h, far));
}

#[inline(always)]
fn displace_all<S: Simd>(simd: S, bodies: &mut Bodies, h: f64, far: &mut Vec<(LineIx, Quad)>) {
    let steps = f64x4::from_slice(simd, &[h, h, h, 0.0]);
    let (limits, last_limits) = bodies.limits.as_chunks::<4>();
    let (lines, last) = bodies.lines.as_chunks_mut::<4>();
    let mut at = 0;
    for (lines, limits) in lines.iter_mut().zip(limits) {
        let [vx, vy, w, _] = columns(simd, lines, 0);
        let mut bits = goes_far([vx * h, vy * h, w * h], &Limits::of(simd, limits)).to_bitmask();
        while bits != 0 {
            let k = bits.trailing_zeros();
            bits &= bits - 1;
            let line = &lines[k as usize];
            far.push((LineIx(at + k), Quad::new(line.d(), line.turn())));
        }
        for line in lines {
            let d = f64x4::from_slice(simd, &line.0[4..]);
            let step = steps * f64x4::from_slice(simd, &line.0[..4]);
            (d + step).store_slice(&mut line.0[4..]);
        }
        at += 4;
    }
    for ((line, limit), at) in last.iter_mut().zip(last_limits).zip(at..) {
        let d = f64x4::from_slice(simd, &line.0[4..]);
        let step = steps * f64x4::from_slice(simd, &line.0[..4]);
        if limit.is_far(step[0] * step[0] + step[1] * step[1], step[2]) {
            far.push((LineIx(at), Quad::new(line.d(), line.turn())));
        }
        (d + step).store_slice(&mut line.0[4..]);
    }
}

/// Four columns of four rows, from number `from` of each on.
#[inline(always)]
fn columns<S: Simd, L: Numbers>(simd: S, [p, q, r, s]: &[L; 4], from: usize) -> [f64x4<S>; 4] {
    f64x4::columns_of(simd, &[p, q, r, s], from)
}

/// [`Limit`] of four bodies.
struct Limits<S: Simd> {
    reach: f64x4<S>,
    extent: f64x4<S>,
}

impl<S: Simd> Limits<S> {
    #[inline(always)]
    fn of(simd: S, [p, q, r, s]: &[Limit; 4]) -> Self {
        Self {
            reach: f64x4::from_slice(simd, &[p.reach, q.reach, r.reach, s.reach]),
            extent: f64x4::from_slice(simd, &[p.extent, q.extent, r.extent, s.extent]),
        }
    }
}

/// [`Limit::is_far`] of four bodies.
#[inline(always)]
fn goes_far<S: Simd>([x, y, turn]: [f64x4<S>; 3], limits: &Limits<S>) -> mask64x4<S> {
    let least = limits.extent * (FAST * 0.5);
    (x * x + y * y).simd_gt(least * least) | (turn.abs() * limits.reach).simd_gt(least)
}

/// Makes displacements of second order where velocities change smoothly: `d −= ½ h Δv`. Notes which bodies may
/// deviate from their predicted motions in the `rest` of the tick, and which go far in the next sub-step.
///
/// `h v` with the velocity at the end overshoots the trapezoid by h/2 Δv: g h²/2 in free flight,
/// and likewise where friction brakes. Where a contact stopped the body at its surface there is
/// nothing to take back; a stop is what changes the velocity by more than four times the pull.
pub(crate) fn correct(level: Level, bodies: &mut Bodies, settings: &Settings, h: f64, rest: f64) {
    bodies.deviating.clear();
    if bodies.damped > 0 {
        dispatch!(level, simd => correct_all::<_, true>(simd, bodies, settings, h, rest));
    } else {
        dispatch!(level, simd => correct_all::<_, false>(simd, bodies, settings, h, rest));
    }
    bodies.may_deviate = false;
}

#[inline(always)]
fn correct_all<S: Simd, const DAMPED: bool>(
    simd: S,
    bodies: &mut Bodies,
    settings: &Settings,
    h: f64,
    rest: f64,
) {
    let span = Span {
        h,
        rest,
        margin: settings.margin,
    };
    let mut seen = Seen {
        deviating: core::mem::take(&mut bodies.deviating),
        speedy: bodies.speedy.take().unwrap_or_default(),
        beyond: f64x4::splat(simd, 0.0),
    };
    seen.speedy.clear();
    let (lines, last) = bodies.lines.as_chunks_mut::<4>();
    let first_of_last = 4 * lines.len();
    let more = bodies
        .start
        .as_chunks()
        .0
        .iter()
        .zip(bodies.pull.as_chunks().0);
    let foreseen = bodies.foreseen.as_chunks().0.iter();
    let more = more.zip(foreseen.zip(bodies.limits.as_chunks().0));
    let more = more.zip(bodies.drag.as_chunks().0);
    for ((lines, (((start, pull), (foreseen, limits)), drag)), k) in
        lines.iter_mut().zip(more).zip(0u32..)
    {
        let four = Four {
            start,
            pull,
            foreseen,
            drag,
            limits,
        };
        correct_four::<_, DAMPED>(simd, (lines, &four), 4 * k, &span, &mut seen);
    }
    if !last.is_empty() {
        // Filled up with what empty lanes name.
        let mut lines = [Line::EMPTY; 4];
        lines[..last.len()].copy_from_slice(last);
        let four = Four {
            start: &filled(&bodies.start, first_of_last),
            pull: &filled(&bodies.pull, first_of_last),
            foreseen: &filled(&bodies.foreseen, first_of_last),
            drag: &filled(&bodies.drag, first_of_last),
            limits: &filled(&bodies.limits, first_of_last),
        };
        let first = number(first_of_last);
        correct_four::<_, DAMPED>(simd, (&mut lines, &four), first, &span, &mut seen);
        last.copy_from_slice(&lines[..last.len()]);
    }
    let beyond = seen.beyond;
    bodies.beyond_boxes = [0, 1, 2, 3]
        .map(|lane| beyond[lane])
        .into_iter()
        .fold(0.0, f64::max);
    (bodies.deviating, bodies.speedy) = (seen.deviating, Some(seen.speedy));
}

/// The last of a list, and its first, which is that of empty lanes.
fn filled<T: Copy>(list: &[T], from: usize) -> [T; 4] {
    [0, 1, 2, 3].map(|k| list.get(from + k).copied().unwrap_or(list[0]))
}

/// What belongs to four lines.
struct Four<'b> {
    start: &'b [Quad; 4],
    pull: &'b [Quad; 4],
    foreseen: &'b [Quad; 4],
    drag: &'b [[Quad; 2]; 4],
    limits: &'b [Limit; 4],
}

/// A sub-step, and what is left of its tick, in s; the margin of contacts.
struct Span {
    h: f64,
    rest: f64,
    margin: f64,
}

/// Lines of bodies that may deviate, and that go far; how far beyond their boxes they may be.
struct Seen<S: Simd> {
    deviating: Vec<LineIx>,
    speedy: Vec<LineIx>,
    beyond: f64x4<S>,
}

/// Four lines from `first` on.
#[inline(always)]
fn correct_four<S: Simd, const DAMPED: bool>(
    simd: S,
    (lines, four): (&mut [Line; 4], &Four<'_>),
    first: u32,
    span: &Span,
    seen: &mut Seen<S>,
) {
    let h = span.h;
    let [vx, vy, w, _] = columns(simd, lines, 0);
    let [dx, dy, turn, inertia] = columns(simd, lines, 4);
    let [x, y, spin, _] = columns(simd, four.start, 0);
    let [pull_x, pull_y, twist, _] = columns(simd, four.pull, 0);
    // What pull and damping did: `start − v` with the v before, and exactly `h g` without damping (f = φ = 1), so that no
    // body depends on whether another one is damped: `start − (start − φ h g)/f = (φ h g − (1 − f) start)/f`.
    let pulled = [pull_x * h, pull_y * h, twist * h];
    let (own, change) = if DAMPED {
        let [p, q, r, s] = four.drag;
        let [f, _, f_spin, _] = columns(simd, &[p[0], q[0], r[0], s[0]], 0);
        let [part, _, part_spin, _] = columns(simd, &[p[1], q[1], r[1], s[1]], 0);
        let [own_x, change_x] = damped([f, part], [x, vx, pulled[0]]);
        let [own_y, change_y] = damped([f, part], [y, vy, pulled[1]]);
        let [_, change_w] = damped([f_spin, part_spin], [spin, w, pulled[2]]);
        ([own_x, own_y], [change_x, change_y, change_w])
    } else {
        let change = [vx - x + pulled[0], vy - y + pulled[1], w - spin + pulled[2]];
        ([pulled[0], pulled[1]], change)
    };
    let square = change[0] * change[0] + change[1] * change[1];
    let smooth = square.simd_le((own[0] * own[0] + own[1] * own[1]) * 16.0);
    let half = f64x4::splat(simd, 0.5 * h);
    let turn = smooth.select(turn - half * change[2], turn);
    let d = [
        smooth.select(dx - half * change[0], dx),
        smooth.select(dy - half * change[1], dy),
        turn,
        inertia,
    ];
    for (line, d) in lines.iter_mut().zip(rows_of(d)) {
        d.store_slice(&mut line.0[4..]);
    }
    let [then_x, then_y, then_w, _] = columns(simd, four.foreseen, 0);
    let limits = Limits::of(simd, four.limits);
    let off = (vx - then_x).abs().max((vy - then_y).abs()) + (w - then_w).abs() * limits.reach;
    // [`Limit::deviates`].
    let most = limits.extent * span.margin;
    let bends = (turn * 0.5 * turn * limits.reach).simd_gt(most * BEND);
    note(
        (off * span.rest).simd_gt(most) | bends,
        first,
        &mut seen.deviating,
    );
    let far = goes_far([vx * h, vy * h, w * h], &limits);
    note(far, first, &mut seen.speedy);
    // Before, a body deviated by a margin at most, and its box has half of one to spare. 0 of empty lanes.
    let moves = limits.extent.simd_lt(f64x4::splat(simd, f64::INFINITY));
    let out = off * h + limits.extent * (0.5 * span.margin);
    let out = moves.select(out, f64x4::splat(simd, 0.0));
    seen.beyond = out.max(seen.beyond);
}

/// Of one component: what damping by f and φ and the pull did to a velocity, and by how much contacts changed it.
#[inline(always)]
fn damped<S: Simd>([f, part]: [f64x4<S>; 2], [start, v, pulled]: [f64x4<S>; 3]) -> [f64x4<S>; 2] {
    let simd = f.token();
    let none = f64x4::splat(simd, 0.0);
    let own = (part * pulled - (1.0 - f) * start) / f;
    let smooth = f.simd_gt(f64x4::splat(simd, LEFT));
    [
        smooth.select(own, none),
        smooth.select(v - start + own, none),
    ]
}

/// Adds those of the lines from `first` on that have a bit.
#[inline(always)]
fn note<S: Simd>(lanes: mask64x4<S>, first: u32, to: &mut Vec<LineIx>) {
    let mut bits = lanes.to_bitmask();
    while bits != 0 {
        to.push(LineIx(first + bits.trailing_zeros()));
        bits &= bits - 1;
    }
}

/// The velocity at the beginning of a sub-step, which `start` comes from by pull and damping; where damping left nearly nothing of it
/// that is unknown, and `start` stands for it.
#[inline]
pub(crate) fn velocity_before(
    start: &Quad,
    pull: &Quad,
    [left, added]: &[Quad; 2],
    h: f64,
) -> (Vec2, f64) {
    let [x, y, w] = [0, 1, 2].map(|k| {
        if left.0[k] > LEFT {
            (start.0[k] - added.0[k] * (h * pull.0[k])) / left.0[k]
        } else {
            start.0[k]
        }
    });
    (vec2(x, y), w)
}
