//! The soft sub-step law, eight rows at a time. [`super::plain`] says the same row by row.
//!
//! Dispatched once a sub-step; everything below is inlined into the dispatched function, and no
//! closure sees a register: both would lose the wide instructions. No fused multiply-add and
//! selects instead of min and max, so that every width gives the same bits.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Level, Select, Simd, SimdBase, SimdMask, SimdSplit, dispatch, f64x8};

use super::wide::{LANES, Line, Wide};
use super::{Law, Row};

/// What closes faster than this is met, not at rest, in m/s: what pushes then is no guess for what will.
const MET: f64 = 0.25;

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

/// Rows of a block that are met with a speed when a solving sweep comes to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Met {
    pub(crate) colour: u32,
    pub(crate) block: u32,
    /// A bit for each lane.
    pub(crate) lanes: u64,
}

/// Sweeps over all blocks; what friction turned to heat in a relaxing sweep, in J. A solving sweep adds the
/// rows that are met to `met`.
pub(crate) fn sweep(
    level: Level,
    pass: Pass,
    law: &Law,
    lines: &mut [Line],
    colours: &mut [Vec<Wide>],
    met: &mut Vec<Met>,
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
    met: &mut Vec<Met>,
) -> f64 {
    let mut heat = f64x8::splat(simd, 0.0);
    for (colour, blocks) in (0u32..).zip(colours) {
        for (k, wide) in (0u32..).zip(blocks) {
            let lanes = block::<S, RELAX, BELTS>(simd, law, lines, wide, &mut heat);
            if lanes != 0 {
                let block = k;
                met.push(Met {
                    colour,
                    block,
                    lanes,
                });
            }
        }
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
) -> u64 {
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let [mut avx, mut avy, mut aw, ma, adx, ady, aturn, ia] = gather(simd, lines, &wide.a);
    let [mut bvx, mut bvy, mut bw, mb, bdx, bdy, bturn, ib] = gather(simd, lines, &wide.b);
    let nx = f64x8::from_slice(simd, &wide.nx);
    let ny = f64x8::from_slice(simd, &wide.ny);
    let a1 = f64x8::from_slice(simd, &wide.a1);
    let b1 = f64x8::from_slice(simd, &wide.b1);
    let a2 = f64x8::from_slice(simd, &wide.a2);
    let b2 = f64x8::from_slice(simd, &wide.b2);
    let j1 = f64x8::from_slice(simd, &wide.j1);
    let j2 = f64x8::from_slice(simd, &wide.j2);

    let vn = nx * (bvx - avx) + ny * (bvy - avy);
    let dn = nx * (bdx - adx) + ny * (bdy - ady);
    let gap1 = f64x8::from_slice(simd, &wide.s1) + dn + b1 * bturn - a1 * aturn;
    let gap2 = f64x8::from_slice(simd, &wide.s2) + dn + b2 * bturn - a2 * aturn;
    let (open1, open2) = (gap1.simd_gt(zero), gap2.simd_gt(zero));
    let rate = f64x8::splat(simd, law.inverse_h);
    let (v1, v2) = (vn + b1 * bw - a1 * aw, vn + b2 * bw - a2 * aw);
    let mut met = 0;
    if !RELAX {
        let (fast, near) = (
            f64x8::splat(simd, -MET),
            f64x8::splat(simd, 0.5 * Row::OPEN),
        );
        let met1 = v1.simd_lt(fast) & gap1.simd_lt(near);
        let met2 = v2.simd_lt(fast) & gap2.simd_lt(near);
        met = (met1 | met2).to_bitmask();
    }
    let mut u1 = v1 + open1.select(gap1, zero) * rate;
    let mut u2 = v2 + open2.select(gap2, zero) * rate;

    // K of both points; softened where they overlap.
    let m = ma + mb;
    let (iaa1, ibb1) = (ia * a1, ib * b1);
    let k11 = m + iaa1 * a1 + ibb1 * b1;
    let k12 = m + iaa1 * a2 + ibb1 * b2;
    let k22 = m + ia * a2 * a2 + ib * b2 * b2;
    let (mut s11, mut s22) = (k11, k22);
    if !RELAX {
        let ground = ma.simd_eq(zero) | mb.simd_eq(zero);
        let rate = ground.select(
            f64x8::splat(simd, law.soft[1].0),
            f64x8::splat(simd, law.soft[0].0),
        );
        let softened = ground.select(
            f64x8::splat(simd, 1.0 + law.soft[1].1),
            f64x8::splat(simd, 1.0 + law.soft[0].1),
        );
        let fastest = f64x8::splat(simd, -law.push_out);
        let (push1, push2) = (rate * gap1, rate * gap2);
        let push1 = push1.simd_gt(fastest).select(push1, fastest);
        let push2 = push2.simd_gt(fastest).select(push2, fastest);
        u1 += open1.select(zero, push1);
        u2 += open2.select(zero, push2);
        s11 *= open1.select(one, softened);
        s22 *= open2.select(one, softened);
    }

    // The case of the 2 × 2 complementarity problem that holds.
    let r1 = k11 * j1 + k12 * j2 - u1;
    let r2 = k12 * j1 + k22 * j2 - u2;
    let product = s11 * s22;
    let det = product - k12 * k12;
    // Locked rotations make both points one: then one of them pushes alone.
    let regular = det.simd_gt(product * f64x8::splat(simd, 1e-12));
    let det = regular.select(det, one);
    let q = one / (product * det);
    let (y1, y2) = (r1 * (q * s22 * det), r2 * (q * s11 * det));
    let inverse = q * product;
    let x1 = (s22 * r1 - k12 * r2) * inverse;
    let x2 = (s11 * r2 - k12 * r1) * inverse;
    let both = regular & x1.simd_ge(zero) & x2.simd_ge(zero);
    // The first alone, if that keeps the second from closing; else the second, if it closes.
    let first = y1.simd_ge(zero) & (k12 * y1).simd_ge(r2);
    let y2 = y2.simd_gt(zero).select(y2, zero);
    let x1 = both.select(x1, first.select(y1, zero));
    let x2 = both.select(x2, first.select(zero, y2));

    // A face that did not push yet has no error to damp: its first impulse is taken as it is.
    let acted = (j1 + j2).simd_gt(zero);
    let omega = acted.select(f64x8::splat(simd, law.over_relaxation), one);
    let (new1, new2) = (j1 + omega * (x1 - j1), j2 + omega * (x2 - j2));
    let new1 = new1.simd_gt(zero).select(new1, zero);
    let new2 = new2.simd_gt(zero).select(new2, zero);
    let (d1, d2) = (new1 - j1, new2 - j2);
    new1.store_slice(&mut wide.j1);
    new2.store_slice(&mut wide.j2);
    let sum = d1 + d2;
    let (px, py) = (nx * sum, ny * sum);
    avx -= px * ma;
    avy -= py * ma;
    bvx += px * mb;
    bvy += py * mb;
    aw -= (a1 * d1 + a2 * d2) * ia;
    bw += (b1 * d1 + b2 * d2) * ib;

    if RELAX {
        let at = f64x8::from_slice(simd, &wide.at);
        let bt = f64x8::from_slice(simd, &wide.bt);
        let jt = f64x8::from_slice(simd, &wide.jt);
        let mut vt = nx * (bvy - avy) - ny * (bvx - avx) + bt * bw - at * aw;
        if BELTS {
            vt -= f64x8::from_slice(simd, &wide.belt);
        }
        let k = m + ia * at * at + ib * bt * bt;
        let limit = f64x8::from_slice(simd, &wide.mu) * (new1 + new2);
        let wanted = jt - vt / k;
        let wanted = wanted.simd_gt(limit).select(limit, wanted);
        let new = wanted.simd_lt(-limit).select(-limit, wanted);
        let dt = new - jt;
        new.store_slice(&mut wide.jt);
        let (px, py) = (-ny * dt, nx * dt);
        avx -= px * ma;
        avy -= py * ma;
        bvx += px * mb;
        bvy += py * mb;
        aw -= at * dt * ia;
        bw += bt * dt * ib;
        // Slip at the end of the sub-step, and half of what friction changed it by: the mean, as
        // far as the row knows. What sticks makes no heat.
        let slip = vt + k * dt;
        let half = f64x8::splat(simd, 0.5) * k * new;
        let most = slip.abs();
        let half = half.simd_gt(most).select(most, half);
        let half = half.simd_lt(-most).select(-most, half);
        *heat -= new * (slip - half);
    }
    scatter(simd, lines, &wide.a, [avx, avy, aw, ma]);
    scatter(simd, lines, &wide.b, [bvx, bvy, bw, mb]);
    met
}

/// Reads eight lines and turns them into columns: three rounds of a perfect shuffle.
#[inline(always)]
fn gather<S: Simd>(simd: S, lines: &[Line], at: &[u32; LANES]) -> Eight<S> {
    let r = [
        f64x8::from_slice(simd, &lines[at[0] as usize].0),
        f64x8::from_slice(simd, &lines[at[1] as usize].0),
        f64x8::from_slice(simd, &lines[at[2] as usize].0),
        f64x8::from_slice(simd, &lines[at[3] as usize].0),
        f64x8::from_slice(simd, &lines[at[4] as usize].0),
        f64x8::from_slice(simd, &lines[at[5] as usize].0),
        f64x8::from_slice(simd, &lines[at[6] as usize].0),
        f64x8::from_slice(simd, &lines[at[7] as usize].0),
    ];
    shuffle(shuffle(shuffle(r)))
}

#[inline(always)]
fn shuffle<S: Simd>(r: Eight<S>) -> Eight<S> {
    [
        r[0].zip_low(r[4]),
        r[0].zip_high(r[4]),
        r[1].zip_low(r[5]),
        r[1].zip_high(r[5]),
        r[2].zip_low(r[6]),
        r[2].zip_high(r[6]),
        r[3].zip_low(r[7]),
        r[3].zip_high(r[7]),
    ]
}

/// Writes velocities back: the first half of each line.
#[inline(always)]
fn scatter<S: Simd>(_: S, lines: &mut [Line], at: &[u32; LANES], columns: [f64x8<S>; 4]) {
    let [vx, vy, w, m] = columns;
    let (x_low, x_high) = (vx.zip_low(w), vx.zip_high(w));
    let (y_low, y_high) = (vy.zip_low(m), vy.zip_high(m));
    let pairs = [
        x_low.zip_low(y_low),
        x_low.zip_high(y_low),
        x_high.zip_low(y_high),
        x_high.zip_high(y_high),
    ];
    let (l0, l1) = pairs[0].split();
    let (l2, l3) = pairs[1].split();
    let (l4, l5) = pairs[2].split();
    let (l6, l7) = pairs[3].split();
    l0.store_slice(&mut lines[at[0] as usize].0[..4]);
    l1.store_slice(&mut lines[at[1] as usize].0[..4]);
    l2.store_slice(&mut lines[at[2] as usize].0[..4]);
    l3.store_slice(&mut lines[at[3] as usize].0[..4]);
    l4.store_slice(&mut lines[at[4] as usize].0[..4]);
    l5.store_slice(&mut lines[at[5] as usize].0[..4]);
    l6.store_slice(&mut lines[at[6] as usize].0[..4]);
    l7.store_slice(&mut lines[at[7] as usize].0[..4]);
}
