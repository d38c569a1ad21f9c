//! The soft sub-step law, eight rows at a time. [`super::plain`] says the same row by row.
//!
//! Dispatched once a sub-step; everything below is inlined into the dispatched function, and no
//! closure sees a register: both would lose the wide instructions. No fused multiply-add, so that every width
//! gives the same bits; min and max give their second number where both are equal, or zeros of either sign.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Level, Select, Simd, SimdBase, SimdMask, dispatch, f64x8};

use super::transpose::{columns, rows};
use super::wide::{LANES, Line, REGULAR, Wide};
use super::{Law, Row};

/// What closes faster than this is met, not at rest, in m/s: what pushes then is no guess for what will.
pub(super) const MET: f64 = 0.25;

/// A body so many times as heavy as another, or that cannot be moved, counts as a load: one sweep a sub-step does not carry
/// it.
pub(super) const HEAVY: f64 = 64.0;

/// One pass over all rows, colour by colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Normals with bias: overlaps are pushed out, gaps may close.
    Solve,
    /// Normals without bias, then friction.
    Relax,
    /// The same where some surface runs along.
    RelaxBelts,
}

/// Sweeps over all blocks; what friction turned to heat in a relaxing sweep, in J. A solving sweep sets `met` if a
/// contact closes with a speed at its turn.
pub(crate) fn sweep(
    level: Level,
    pass: Pass,
    law: &Law,
    lines: &mut [Line],
    colours: &mut [Vec<Wide>],
    met: &mut bool,
) -> f64 {
    match pass {
        Pass::Solve => {
            dispatch!(level, simd => all::<_, false, false>(simd, law, lines, colours, met))
        }
        Pass::Relax => {
            dispatch!(level, simd => all::<_, true, false>(simd, law, lines, colours, met))
        }
        Pass::RelaxBelts => {
            dispatch!(level, simd => all::<_, true, true>(simd, law, lines, colours, met))
        }
    }
}

#[inline(always)]
fn all<S: Simd, const RELAX: bool, const BELTS: bool>(
    simd: S,
    law: &Law,
    lines: &mut [Line],
    colours: &mut [Vec<Wide>],
    met: &mut bool,
) -> f64 {
    let mut heat = f64x8::splat(simd, 0.0);
    for wide in colours.iter_mut().flatten() {
        *met |= block::<S, RELAX, BELTS>(simd, law, lines, wide, &mut heat);
    }
    let mut sum = 0.0;
    for lane in 0..LANES {
        sum += heat[lane];
    }
    sum
}

/// Eight bodies: vx vy ω m⁻¹ dx dy dθ I⁻¹, a register each.
type Eight<S> = [f64x8<S>; 8];

#[inline(always)]
fn block<S: Simd, const RELAX: bool, const BELTS: bool>(
    simd: S,
    law: &Law,
    lines: &mut [Line],
    wide: &mut Wide,
    heat: &mut f64x8<S>,
) -> bool {
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let [mut avx, mut avy, mut aw, ma, adx, ady, aturn, ia] = gather(simd, lines, &wide.a);
    let [mut bvx, mut bvy, mut bw, mb, bdx, bdy, bturn, ib] = gather(simd, lines, &wide.b);
    let nx = f64x8::from_slice(simd, &wide.nx);
    let ny = f64x8::from_slice(simd, &wide.ny);
    let a1 = f64x8::from_slice(simd, &wide.a1);
    let b1 = f64x8::from_slice(simd, &wide.b1);
    let l = f64x8::from_slice(simd, &wide.l);
    let j1 = f64x8::from_slice(simd, &wide.j1);
    let j2 = f64x8::from_slice(simd, &wide.j2);

    let v1 = nx * (bvx - avx) + ny * (bvy - avy) + b1 * bw - a1 * aw;
    let v2 = v1 + l * (bw - aw);
    let moved1 = nx * (bdx - adx) + ny * (bdy - ady) + b1 * bturn - a1 * aturn;
    let moved2 = moved1 + l * (bturn - aturn);
    let gap1 = f64x8::from_slice(simd, &wide.s1) + moved1;
    let gap2 = f64x8::from_slice(simd, &wide.s2) + moved2;

    let reach = f64x8::splat(simd, law.inverse_h);
    let mut met = false;
    let mut struck = zero.simd_lt(zero);
    if !RELAX {
        let (fast, near) = (
            f64x8::splat(simd, -MET),
            f64x8::splat(simd, 0.5 * Row::OPEN),
        );
        let met1 = v1.simd_lt(fast) & gap1.simd_lt(near);
        let met2 = v2.simd_lt(fast) & gap2.simd_lt(near);
        struck = met1 | met2;
        met = struck.to_bitmask() != 0;
    }
    // Where nothing pushes, and no gap closes in this sub-step, nothing will: u ≥ 0, and the impulses that solve for it are 0.
    let (counts1, counts2) = if RELAX {
        (gap1.max(zero), gap2.max(zero))
    } else {
        (gap1, gap2)
    };
    let closes = (v1 + counts1 * reach)
        .min(v2 + counts2 * reach)
        .simd_lt(zero);
    let mut pushes = j1 + j2;
    if RELAX {
        pushes += f64x8::from_slice(simd, &wide.jt).abs();
    }
    if (closes | pushes.simd_gt(zero)).to_bitmask() == 0 {
        return met;
    }

    // The matrix of the points, which a large pile would wait for longer: see `Wide`.
    let m = ma + mb;
    let turns = ia * a1 + ib * b1;
    let k11 = m + (ia * a1 * a1 + ib * b1 * b1);
    let k12 = k11 + turns * l;
    let k22 = k12 + (turns + (ia + ib) * l) * l;
    let k12 = k12 * f64x8::splat(simd, REGULAR);
    let (u1, u2, s11, s22, omega);
    if RELAX {
        u1 = v1 + counts1 * reach;
        u2 = v2 + counts2 * reach;
        (s11, s22) = (k11, k22);
        omega = one;
    } else {
        let (open1, open2) = (gap1.simd_gt(zero), gap2.simd_gt(zero));
        let ground = ma.min(mb).simd_eq(zero);
        let rate = ground.select(
            f64x8::splat(simd, law.soft[1].0),
            f64x8::splat(simd, law.soft[0].0),
        );
        let softened = ground.select(
            f64x8::splat(simd, 1.0 + law.soft[1].1),
            f64x8::splat(simd, 1.0 + law.soft[0].1),
        );
        let fastest = f64x8::splat(simd, -law.push_out);
        (s11, s22) = (k11 * softened, k22 * softened);
        // Softened whether open or not, so that no division waits for a gap; but what an open point pushes
        // already counts as on a stiff one, and its first impulse is taken as much larger as that is softer.
        let (stiff1, stiff2) = (open1.select(j1, zero), open2.select(j2, zero));
        u1 = v1 + (gap1 * open1.select(reach, rate)).max(fastest) - (s11 - k11) * stiff1;
        u2 = v2 + (gap2 * open2.select(reach, rate)).max(fastest) - (s22 - k22) * stiff2;
        // A face that did not push yet, or is struck, has no error to damp: that impulse is taken as it is. Hurried on
        // it would throw a body that is struck from below into what lies on it, faster than what strikes it. But what
        // stops a heavy body comes through a light one and from the ground in many sweeps.
        let loaded = ma.max(mb).simd_gt(ma.min(mb) * f64x8::splat(simd, HEAVY));
        let rests = (j1 + j2).simd_gt(zero) & (loaded | !struck);
        omega = rests.select(f64x8::splat(simd, law.over_relaxation), softened);
    }

    // The case of the 2 × 2 complementarity problem that holds.
    let product = s11 * s22;
    let det = product - k12 * k12;
    let q = one / (product * det);
    let inverse = q * product;
    let alone = q * det;
    let r1 = k11 * j1 + k12 * j2 - u1;
    let r2 = k12 * j1 + k22 * j2 - u2;
    let y1 = (r1 * (alone * s22)).max(zero);
    let y2 = (r2 * (alone * s11)).max(zero);
    let x1 = (s22 * r1 - k12 * r2) * inverse;
    let x2 = (s11 * r2 - k12 * r1) * inverse;
    let both = x1.min(x2).simd_ge(zero);
    // The first alone, if that keeps the second from closing; else the second, if it closes.
    let first = (k12 * y1).simd_ge(r2);
    let x1 = both.select(x1, first.select(y1, zero));
    let x2 = both.select(x2, first.select(zero, y2));

    let (new1, new2) = if RELAX {
        // What relaxes is not hurried on: friction acts at once by what pushes, and jammed columns would hum.
        (x1, x2)
    } else {
        (
            (j1 + omega * (x1 - j1)).max(zero),
            (j2 + omega * (x2 - j2)).max(zero),
        )
    };
    new1.store_slice(&mut wide.j1);
    new2.store_slice(&mut wide.j2);
    let d2 = new2 - j2;
    let sum = new1 - j1 + d2;
    let (px, py) = (nx * sum, ny * sum);
    let bend = l * d2;
    avx -= px * ma;
    avy -= py * ma;
    bvx += px * mb;
    bvy += py * mb;
    aw -= (a1 * sum + bend) * ia;
    bw += (b1 * sum + bend) * ib;

    if RELAX {
        let at = f64x8::from_slice(simd, &wide.at);
        let bt = f64x8::from_slice(simd, &wide.bt);
        let jt = f64x8::from_slice(simd, &wide.jt);
        let (eases_a, eases_b) = (ia * at, ib * bt);
        let k = m + (eases_a * at + eases_b * bt);
        let inverse = one / k;
        let mut vt = nx * (bvy - avy) - ny * (bvx - avx) + (bt * bw - at * aw);
        if BELTS {
            vt -= f64x8::from_slice(simd, &wide.belt);
        }
        let limit = f64x8::from_slice(simd, &wide.mu) * (new1 + new2);
        let wanted = limit.min(jt - vt * inverse);
        let new = (-limit).max(wanted);
        let dt = new - jt;
        new.store_slice(&mut wide.jt);
        let (px, py) = (-ny * dt, nx * dt);
        avx -= px * ma;
        avy -= py * ma;
        bvx += px * mb;
        bvy += py * mb;
        aw -= eases_a * dt;
        bw += eases_b * dt;
        // Slip at the end of the sub-step, and half of what friction changed it by: the mean, as
        // far as the row knows. What sticks makes no heat.
        let slip = vt + k * dt;
        let most = slip.abs();
        let half = most.min(f64x8::splat(simd, 0.5) * k * new);
        let half = (-most).max(half);
        *heat -= new * (slip - half);
    }
    scatter(lines, &wide.a, [avx, avy, aw, ma]);
    scatter(lines, &wide.b, [bvx, bvy, bw, mb]);
    met
}

/// Reads eight lines as columns.
#[inline(always)]
fn gather<S: Simd>(simd: S, lines: &[Line], at: &[u32; LANES]) -> Eight<S> {
    let (l0, l1) = (&lines[at[0] as usize].0, &lines[at[1] as usize].0);
    let (l2, l3) = (&lines[at[2] as usize].0, &lines[at[3] as usize].0);
    let (l4, l5) = (&lines[at[4] as usize].0, &lines[at[5] as usize].0);
    let (l6, l7) = (&lines[at[6] as usize].0, &lines[at[7] as usize].0);
    let low = [
        &l0[..4],
        &l1[..4],
        &l2[..4],
        &l3[..4],
        &l4[..4],
        &l5[..4],
        &l6[..4],
        &l7[..4],
    ];
    let high = [
        &l0[4..],
        &l1[4..],
        &l2[4..],
        &l3[4..],
        &l4[4..],
        &l5[4..],
        &l6[4..],
        &l7[4..],
    ];
    let [vx, vy, w, m] = columns(simd, low);
    let [dx, dy, turn, i] = columns(simd, high);
    [vx, vy, w, m, dx, dy, turn, i]
}

/// Writes velocities back: the first half of each line.
#[inline(always)]
fn scatter<S: Simd>(lines: &mut [Line], at: &[u32; LANES], columns: [f64x8<S>; 4]) {
    let [l0, l1, l2, l3, l4, l5, l6, l7] = rows(columns);
    l0.store_slice(&mut lines[at[0] as usize].0[..4]);
    l1.store_slice(&mut lines[at[1] as usize].0[..4]);
    l2.store_slice(&mut lines[at[2] as usize].0[..4]);
    l3.store_slice(&mut lines[at[3] as usize].0[..4]);
    l4.store_slice(&mut lines[at[4] as usize].0[..4]);
    l5.store_slice(&mut lines[at[5] as usize].0[..4]);
    l6.store_slice(&mut lines[at[6] as usize].0[..4]);
    l7.store_slice(&mut lines[at[7] as usize].0[..4]);
}
