//! The soft law over blocks, a register at a time. [`super::plain`] says the same lane by lane.
//!
//! Dispatched once a pass; everything below is inlined into the dispatched function, and no closure sees a register: both
//! would lose the wide instructions. No fused multiply-add, so that every width gives the same bits; min and max give their
//! second number where both are equal, or zeros of either sign.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Level, Select, Simd, SimdMask};

use super::block::{Block, LANES, OPEN};
use super::colour::Colour;
use super::law::Law;
use super::line::Line;
use super::transpose::{Wide, any};
use super::widest::widest;

/// What is left of k₁₂: where no body can turn, or there is but one point, both are one, and may share the load as they like.
/// As its determinant the matrix has 2e-12 of the product of its diagonal then.
pub(super) const REGULAR: f64 = 1.0 - 1e-12;

/// What a sweep does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Overlaps are pushed out, softly; gaps may close.
    Solve,
    /// Normals without bias, then friction.
    Relax,
}

/// What a pass saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    /// What friction turned to heat, in J: of a sub-step if its impulses are those of the whole sub-step.
    pub(crate) heat: f64,
    /// The least gap of a point, in m.
    pub(crate) least_gap: f64,
}

/// The same, lane by lane.
struct SeenBy {
    heat: [f64; LANES],
    least_gap: [f64; LANES],
}

/// One pass over all rows, colour by colour.
pub(crate) fn sweep(
    level: Level,
    pass: Pass,
    law: &Law,
    lines: &mut [Line],
    colours: &mut [Colour],
) -> Seen {
    let mut seen = SeenBy {
        heat: [0.0; LANES],
        least_gap: [OPEN; LANES],
    };
    widest!(level => all(pass, law, lines, colours, &mut seen));
    let least = |least: f64, gap: &f64| if *gap < least { *gap } else { least };
    Seen {
        heat: seen.heat.iter().fold(0.0, |sum, heat| sum + heat),
        least_gap: seen.least_gap.iter().fold(OPEN, least),
    }
}

#[inline(always)]
fn all<S: Simd, V: Wide<S>>(
    simd: S,
    pass: Pass,
    law: &Law,
    lines: &mut [Line],
    colours: &mut [Colour],
    seen: &mut SeenBy,
) {
    match pass {
        Pass::Solve => blocks::<S, V, true>(simd, law, lines, colours, seen),
        Pass::Relax => blocks::<S, V, false>(simd, law, lines, colours, seen),
    }
}

#[inline(always)]
fn blocks<S: Simd, V: Wide<S>, const BIAS: bool>(
    simd: S,
    law: &Law,
    lines: &mut [Line],
    colours: &mut [Colour],
    seen: &mut SeenBy,
) {
    let still = V::splat(simd, 0.0);
    for colour in colours {
        let belts = !BIAS && colour.belts > 0;
        let pushes = colour.pushes.iter_mut();
        for ((block, cold), pushes) in colour.blocks.iter_mut().zip(&colour.cold).zip(pushes) {
            let mut at = 0;
            *pushes = 0;
            while at < LANES {
                let belt = if belts {
                    V::from_slice(simd, &cold.belt[at..at + V::LANES])
                } else {
                    still
                };
                *pushes |= part::<S, V, BIAS>(simd, law, lines, block, at, belt, seen) << at;
                at += V::LANES;
            }
        }
    }
}

/// The lanes of a block from `at` on that fill a register; a bit for each that pushes.
#[inline(always)]
fn part<S: Simd, V: Wide<S>, const BIAS: bool>(
    simd: S,
    law: &Law,
    lines: &mut [Line],
    block: &mut Block,
    at: usize,
    belt: V,
    seen: &mut SeenBy,
) -> u8 {
    let end = at + V::LANES;
    let zero = V::splat(simd, 0.0);
    let one = V::splat(simd, 1.0);
    let [mut avx, mut avy, mut aw, ma] = V::columns(simd, lines, &block.a[at..end], 0);
    let [adx, ady, aturn, ia] = V::columns(simd, lines, &block.a[at..end], 4);
    let [mut bvx, mut bvy, mut bw, mb] = V::columns(simd, lines, &block.b[at..end], 0);
    let [bdx, bdy, bturn, ib] = V::columns(simd, lines, &block.b[at..end], 4);
    let nx = V::from_slice(simd, &block.nx[at..end]);
    let ny = V::from_slice(simd, &block.ny[at..end]);
    let a1 = V::from_slice(simd, &block.a1[at..end]);
    let b1 = V::from_slice(simd, &block.b1[at..end]);
    let l = V::from_slice(simd, &block.l[at..end]);
    let j1 = V::from_slice(simd, &block.j1[at..end]);
    let j2 = V::from_slice(simd, &block.j2[at..end]);

    let v1 = nx * (bvx - avx) + ny * (bvy - avy) + b1 * bw - a1 * aw;
    let v2 = v1 + l * (bw - aw);
    let moved1 = nx * (bdx - adx) + ny * (bdy - ady) + b1 * bturn - a1 * aturn;
    let moved2 = moved1 + l * (bturn - aturn);
    let gap1 = V::from_slice(simd, &block.s1[at..end]) + moved1;
    let gap2 = V::from_slice(simd, &block.s2[at..end]) + moved2;

    if !BIAS {
        let least = V::from_slice(simd, &seen.least_gap[at..end]);
        let least = gap1.min(gap2).min(least);
        least.store_slice(&mut seen.least_gap[at..end]);
    }
    let reach = V::splat(simd, law.inverse_h);
    // Where nothing pushes, and no gap closes in this sub-step, nothing will: the impulses that solve for it are 0.
    let (counts1, counts2) = if BIAS {
        (gap1, gap2)
    } else {
        (gap1.max(zero), gap2.max(zero))
    };
    let closes = (v1 + counts1 * reach)
        .min(v2 + counts2 * reach)
        .simd_lt(zero);
    let mut pushes = j1 + j2;
    if !BIAS {
        pushes += V::from_slice(simd, &block.jt[at..end]).abs();
    }
    if !any(closes | pushes.simd_gt(zero)) {
        return 0;
    }

    // The matrix of the points: computed where it is needed, since a large pile would wait for it longer.
    let m = ma + mb;
    let turns = ia * a1 + ib * b1;
    let k11 = m + (ia * a1 * a1 + ib * b1 * b1);
    let k12 = k11 + turns * l;
    let k22 = k12 + (turns + (ia + ib) * l) * l;
    let k12 = k12 * V::splat(simd, REGULAR);
    let (open1, open2) = (gap1.simd_gt(zero), gap2.simd_gt(zero));
    let (u1, u2, s11, s22, softened);
    if BIAS {
        let ground = ma.min(mb).simd_eq(zero);
        let rate = ground.select(V::splat(simd, law.soft[1].0), V::splat(simd, law.soft[0].0));
        softened = ground.select(V::splat(simd, law.soft[1].1), V::splat(simd, law.soft[0].1));
        let fastest = V::splat(simd, -law.push_out);
        (s11, s22) = (k11 * softened, k22 * softened);
        // Softened whether open or not, so that no division waits for a gap; but what an open point pushes
        // already counts as on a stiff one, and its first impulse is taken as much larger as that is softer.
        let (stiff1, stiff2) = (open1.select(j1, zero), open2.select(j2, zero));
        u1 = v1 + (gap1 * open1.select(reach, rate)).max(fastest) - (s11 - k11) * stiff1;
        u2 = v2 + (gap2 * open2.select(reach, rate)).max(fastest) - (s22 - k22) * stiff2;
    } else {
        softened = one;
        u1 = v1 + counts1 * reach;
        u2 = v2 + counts2 * reach;
        (s11, s22) = (k11, k22);
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

    let (new1, new2) = if BIAS {
        // An impulse that more than doubles stops a blow, and has no error to damp: over-relaxed it would throw the
        // struck body off faster than the one that strikes. Nor has one of which less than half is left after a blow, or
        // that lets an open gap close: over-relaxed it would let go too much.
        let (j, x) = (j1 + j2, x1 + x2);
        let rests = j.simd_gt(zero) & (j + j).simd_ge(x) & (x + x).simd_ge(j);
        let omega = rests.select(V::splat(simd, law.over_relaxation), softened);
        let (omega1, omega2) = (open1.select(softened, omega), open2.select(softened, omega));
        (
            (j1 + omega1 * (x1 - j1)).max(zero),
            (j2 + omega2 * (x2 - j2)).max(zero),
        )
    } else {
        (x1, x2)
    };
    new1.store_slice(&mut block.j1[at..end]);
    new2.store_slice(&mut block.j2[at..end]);
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

    if !BIAS {
        let at_ = V::from_slice(simd, &block.at[at..end]);
        let bt = V::from_slice(simd, &block.bt[at..end]);
        let jt = V::from_slice(simd, &block.jt[at..end]);
        let (eases_a, eases_b) = (ia * at_, ib * bt);
        let k = m + (eases_a * at_ + eases_b * bt);
        let vt = nx * (bvy - avy) - ny * (bvx - avx) + (bt * bw - at_ * aw) - belt;
        let limit = V::from_slice(simd, &block.mu[at..end]) * (new1 + new2);
        let wanted = limit.min(jt - vt * (one / k));
        let new = (-limit).max(wanted);
        let dt = new - jt;
        new.store_slice(&mut block.jt[at..end]);
        // The mean of the slips at both ends of the sub-step, as far as the row knows: before it was k jt less. What sticks
        // makes no heat.
        let slip = vt + k * dt;
        let most = slip.abs();
        let half = (-most).max(most.min(V::splat(simd, 0.5) * (k * new)));
        let sum = V::from_slice(simd, &seen.heat[at..end]) - new * (slip - half);
        sum.store_slice(&mut seen.heat[at..end]);
        let (px, py) = (-ny * dt, nx * dt);
        avx -= px * ma;
        avy -= py * ma;
        bvx += px * mb;
        bvy += py * mb;
        aw -= eases_a * dt;
        bw += eases_b * dt;
    }
    V::write(lines, &block.a[at..end], [avx, avy, aw, ma]);
    V::write(lines, &block.b[at..end], [bvx, bvy, bw, mb]);
    #[expect(clippy::cast_possible_truncation, reason = "eight lanes")]
    let pushes = (new1 + new2).simd_gt(zero).to_bitmask() as u8;
    pushes
}
