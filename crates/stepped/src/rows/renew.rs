//! Manifolds that are computed anew go into their rows: impulses are carried over, and warm starts corrected.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Level, Select, Simd};

use super::block::{Block, LANES, OPEN};
use super::line::{Line, Quad};
use super::transpose::{Wide, any};
use super::widest::widest;

/// Cosine of 25°: beyond it what pushed along the old normal is no guess for what will along the new one.
const SAME_NORMAL: f64 = 0.9;

/// Puts manifolds into those lanes of a block that have a bit in `lanes`. v stays, and what contacts did to it changes.
pub(crate) fn renew(
    level: Level,
    lines: &[Line],
    start: &mut [Quad],
    block: &mut Block,
    new: &Block,
    lanes: u8,
) {
    // A mask is made of it by comparison.
    let chosen = core::array::from_fn(|lane| f64::from(lanes >> lane & 1));
    widest!(level => parts(lines, start, block, new, &chosen));
}

#[inline(always)]
fn parts<S: Simd, V: Wide<S>>(
    simd: S,
    lines: &[Line],
    start: &mut [Quad],
    block: &mut Block,
    new: &Block,
    chosen: &[f64; LANES],
) {
    for at in (0..LANES).step_by(V::LANES) {
        part::<S, V>(simd, lines, start, block, new, chosen, at);
    }
}

/// The lanes from `at` on that fill a register.
///
/// Impulses go point by point, or summed, or to the nearer one: `j₁ j₂ → j₁ j₂`, `j₁ j₂ → j₁ + j₂`, `j₁ → j₁ 0` or `0 j₁`.
#[inline(always)]
fn part<S: Simd, V: Wide<S>>(
    simd: S,
    lines: &[Line],
    start: &mut [Quad],
    block: &mut Block,
    new: &Block,
    chosen: &[f64; LANES],
    at: usize,
) {
    let end = at + V::LANES;
    let zero = V::splat(simd, 0.0);
    let open = V::splat(simd, OPEN);
    let chosen = V::from_slice(simd, &chosen[at..end]).simd_gt(zero);
    let (old_nx, old_ny) = (
        V::from_slice(simd, &block.nx[at..end]),
        V::from_slice(simd, &block.ny[at..end]),
    );
    let old_a1 = V::from_slice(simd, &block.a1[at..end]);
    let old_b1 = V::from_slice(simd, &block.b1[at..end]);
    let old_l = V::from_slice(simd, &block.l[at..end]);
    let old_s2 = V::from_slice(simd, &block.s2[at..end]);
    let old_at = V::from_slice(simd, &block.at[at..end]);
    let old_bt = V::from_slice(simd, &block.bt[at..end]);
    let nx = chosen.select(V::from_slice(simd, &new.nx[at..end]), old_nx);
    let ny = chosen.select(V::from_slice(simd, &new.ny[at..end]), old_ny);
    let a1 = chosen.select(V::from_slice(simd, &new.a1[at..end]), old_a1);
    let b1 = chosen.select(V::from_slice(simd, &new.b1[at..end]), old_b1);
    let l = chosen.select(V::from_slice(simd, &new.l[at..end]), old_l);
    let s1 = V::from_slice(simd, &block.s1[at..end]);
    let s1 = chosen.select(V::from_slice(simd, &new.s1[at..end]), s1);
    let s2 = chosen.select(V::from_slice(simd, &new.s2[at..end]), old_s2);
    let at_ = chosen.select(V::from_slice(simd, &new.at[at..end]), old_at);
    let bt = chosen.select(V::from_slice(simd, &new.bt[at..end]), old_bt);

    let old1 = V::from_slice(simd, &block.j1[at..end]);
    let old2 = V::from_slice(simd, &block.j2[at..end]);
    let old_t = V::from_slice(simd, &block.jt[at..end]);
    let acts = old1.abs() + old2.abs() + old_t.abs();
    if any(chosen & acts.simd_gt(zero)) {
        let same = (old_nx * nx + old_ny * ny).simd_gt(V::splat(simd, SAME_NORMAL));
        let (were_two, are_two) = (old_s2.simd_lt(open), s2.simd_lt(open));
        let off = old_a1 - a1;
        let first = off.abs().simd_le((off - l).abs());
        let j1 = were_two.select(old1, first.select(old1, zero));
        let j2 = were_two.select(old2, first.select(zero, old1));
        let j1 = same.select(are_two.select(j1, old1 + old2), zero);
        let j2 = same.select(are_two.select(j2, zero), zero);
        let jt = same.select(old_t, zero);
        let j1 = chosen.select(j1, old1);
        let j2 = chosen.select(j2, old2);
        let jt = chosen.select(jt, old_t);
        j1.store_slice(&mut block.j1[at..end]);
        j2.store_slice(&mut block.j2[at..end]);
        jt.store_slice(&mut block.jt[at..end]);

        // Jᵀ j of before less that of now, force and moment of it on both bodies.
        let (old_sum, sum) = (old1 + old2, j1 + j2);
        let px = (old_nx * old_sum - old_ny * old_t) - (nx * sum - ny * jt);
        let py = (old_ny * old_sum + old_nx * old_t) - (ny * sum + nx * jt);
        let (old_bend, bend) = (old_l * old2, l * j2);
        let of_a = (old_a1 * old_sum + old_bend + old_at * old_t) - (a1 * sum + bend + at_ * jt);
        let of_b = (old_b1 * old_sum + old_bend + old_bt * old_t) - (b1 * sum + bend + bt * jt);
        let [_, _, _, ma] = V::columns(simd, lines, &block.a[at..end], 0);
        let [_, _, _, ia] = V::columns(simd, lines, &block.a[at..end], 4);
        let [_, _, _, mb] = V::columns(simd, lines, &block.b[at..end], 0);
        let [_, _, _, ib] = V::columns(simd, lines, &block.b[at..end], 4);
        // One body after the other: an empty lane names one line twice.
        let [x, y, w, m] = V::columns(simd, start, &block.a[at..end], 0);
        V::write(
            start,
            &block.a[at..end],
            [x - px * ma, y - py * ma, w - of_a * ia, m],
        );
        let [x, y, w, m] = V::columns(simd, start, &block.b[at..end], 0);
        V::write(
            start,
            &block.b[at..end],
            [x + px * mb, y + py * mb, w + of_b * ib, m],
        );
    }
    nx.store_slice(&mut block.nx[at..end]);
    ny.store_slice(&mut block.ny[at..end]);
    a1.store_slice(&mut block.a1[at..end]);
    b1.store_slice(&mut block.b1[at..end]);
    l.store_slice(&mut block.l[at..end]);
    s1.store_slice(&mut block.s1[at..end]);
    s2.store_slice(&mut block.s2[at..end]);
    at_.store_slice(&mut block.at[at..end]);
    bt.store_slice(&mut block.bt[at..end]);
}
