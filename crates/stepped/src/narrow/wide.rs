//! Eight pairs of outlines to their manifolds, a register of pairs at a time. [`super::naive`] says the same pair by pair.
//!
//! All faces against all corners, and no branch but one around corners on corners. As in the sweeps everything is inlined
//! into the dispatched function, and every width gives the same bits.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Select, Simd, SimdMask};

use super::faces::{FACELESS, best, choose, corners, cuts};
use super::{Eight, Found, Scene};
use crate::rows::{LANES, OPEN, Wide, any, widest};

/// Margins that a contact is at most long if it may be one with the side of a flush piece: a quarter of the extent.
const SHORT: f64 = 4.0;

/// Margins that sides are aligned within that may be flush: 30 times what is flush.
const SEAM: f64 = 0.05;

/// Margins that its gap is at most when the tick ends.
const NEAR: f64 = 0.25;

/// Finds manifolds of eight pairs, and which gaps are below `factor` margins, or may be until the next tick.
pub(crate) fn collide_eight(scene: &Scene<'_>, factor: f64, eight: &Eight<'_>, found: &mut Found) {
    (found.near, found.short, found.slants, found.seam) = (0, 0, 0, 0);
    (found.of_a, found.of_b) = (0, 0);
    widest!(scene.level => parts(scene, factor, eight, found));
    found.near &= eight.used;
    found.of_a &= eight.used;
    found.of_b &= eight.used;
}

#[inline(always)]
fn parts<S: Simd, V: Wide<S>>(
    simd: S,
    scene: &Scene<'_>,
    factor: f64,
    eight: &Eight<'_>,
    found: &mut Found,
) {
    for at in (0..LANES).step_by(V::LANES) {
        if eight.boxes {
            part::<S, V, 4, true>(simd, scene, factor, eight, found, at);
        } else if eight.four {
            part::<S, V, 4, false>(simd, scene, factor, eight, found, at);
        } else {
            part::<S, V, 8, false>(simd, scene, factor, eight, found, at);
        }
    }
}

/// The pairs from `at` on that fill a register: of outlines with at most N corners, or of boxes alone.
#[inline(always)]
fn part<S: Simd, V: Wide<S>, const N: usize, const BOXES: bool>(
    simd: S,
    scene: &Scene<'_>,
    factor: f64,
    eight: &Eight<'_>,
    found: &mut Found,
    at: usize,
) {
    let end = at + V::LANES;
    let zero = V::splat(simd, 0.0);
    let one = V::splat(simd, 1.0);
    let half = V::splat(simd, 0.5);
    let tick = V::splat(simd, scene.settings.tick);
    let lines = &scene.bodies.lines[..];
    let pulls = &scene.bodies.pull[..];
    let (out_a, out_b) = (&eight.outlines[0][at..end], &eight.outlines[1][at..end]);
    let (line_a, line_b) = (&eight.lines[0][at..end], &eight.lines[1][at..end]);

    // What the pair does within the tick.
    let [avx, avy, aw, am] = V::columns(simd, lines, line_a, 0);
    let [adx, ady, aturn, _] = V::columns(simd, lines, line_a, 4);
    let [bvx, bvy, bw, bm] = V::columns(simd, lines, line_b, 0);
    let [bdx, bdy, bturn, _] = V::columns(simd, lines, line_b, 4);
    let [agx, agy, _, _] = V::columns(simd, pulls, line_a, 0);
    let [bgx, bgy, _, _] = V::columns(simd, pulls, line_b, 0);
    let [ax, ay, a_reach, a_extent] = V::columns_of(simd, out_a, 0);
    let [bx, by, b_reach, b_extent] = V::columns_of(simd, out_b, 0);
    let [a_radius, a_count, a_l, a_m] = V::columns_of(simd, out_a, 4);
    let [b_radius, b_count, b_l, b_m] = V::columns_of(simd, out_b, 4);
    let (vx, vy) = (bvx - avx, bvy - avy);
    // Within a tick one may have gone from its base pose, and the other, rebased, not.
    let (gone_x, gone_y) = (bdx - adx, bdy - ady);
    let (dx, dy) = (bx - ax + gone_x, by - ay + gone_y);
    let (wx, wy) = (vx * tick, vy * tick);
    let margin = V::splat(simd, scene.settings.margin) * a_extent.min(b_extent);
    let margin = margin.max(V::from_slice(simd, &eight.least[at..end]));
    let pull = V::splat(simd, scene.settings.gravity.length() * scene.settings.tick);
    let turning = aw.abs() * a_reach + bw.abs() * b_reach;
    let turned = aturn.abs() * a_reach + bturn.abs() * b_reach;
    let moved = (gone_x * gone_x + gone_y * gone_y).sqrt() + turned;
    let near = margin * V::splat(simd, factor);
    let limit = near + (turning + pull) * tick + moved;
    let radii = a_radius + b_radius;

    let a = corners::<S, V, N, BOXES>(simd, out_a, [a_l, a_m]);
    let b = corners::<S, V, N, BOXES>(simd, out_b, [b_l, b_m]);
    // Boxes have no cuts.
    let cuts = |lengths| (!BOXES && eight.cuts).then(|| (cuts(simd, lengths), near));
    let (side, back) = if let Some(side) = eight.side {
        let (x, y) = (V::splat(simd, side.x), V::splat(simd, side.y));
        (Some([x, y]), Some([-x, -y]))
    } else {
        (None, None)
    };
    let (cuts_a, cuts_b) = (cuts([a_l, a_m]), cuts([b_l, b_m]));
    let mut of_a = best::<S, V, N, BOXES>(simd, &a, &b, [dx, dy, wx, wy], cuts_a, side);
    let mut of_b = best::<S, V, N, BOXES>(simd, &b, &a, [-dx, -dy, -wx, -wy], cuts_b, back);
    let faceless = V::splat(simd, FACELESS);
    of_a.separation = a_count.simd_gt(one).select(of_a.separation, faceless);
    of_b.separation = b_count.simd_gt(one).select(of_b.separation, faceless);
    let hysteresis = V::splat(simd, super::HYSTERESIS) * margin;
    let flip = of_b.separation.simd_gt(of_a.separation + hysteresis);
    let passes = of_a.stays.max(of_b.stays).simd_gt(limit + radii);
    // Two pieces between cuts alone have no face; discs have none either.
    let cut_off = of_a
        .separation
        .max(of_b.separation)
        .simd_lt(faceless * half);
    let passes = passes | (cut_off & a_count.max(b_count).simd_gt(one));
    if !any(!passes) {
        return;
    }

    // The owner's face, and the edge of the other that faces it most: they run against each other.
    let owner = choose(flip, &of_b, &of_a);
    let (nx, ny) = (owner.nx, owner.ny);
    let (tx, ty) = (-ny, nx);
    let (dx_o, dy_o) = (flip.select(-dx, dx), flip.select(-dy, dy));
    let mut least = V::splat(simd, f64::INFINITY);
    let (mut high_x, mut high_y, mut low_x, mut low_y) = (zero, zero, zero, zero);
    for k in 0..N {
        let next = (k + 1) % N;
        let (kx, ky) = (flip.select(a.nx[k], b.nx[k]), flip.select(a.ny[k], b.ny[k]));
        let along = nx * kx + ny * ky;
        let less = along.simd_lt(least);
        least = less.select(along, least);
        high_x = less.select(flip.select(a.x[k], b.x[k]), high_x);
        high_y = less.select(flip.select(a.y[k], b.y[k]), high_y);
        low_x = less.select(flip.select(a.x[next], b.x[next]), low_x);
        low_y = less.select(flip.select(a.y[next], b.y[next]), low_y);
    }
    let (own_count, other_count) = (flip.select(b_count, a_count), flip.select(a_count, b_count));

    // Clipped to the face, along t.
    let off = nx * owner.x + ny * owner.y;
    let face_low = tx * owner.x + ty * owner.y;
    let face_high = tx * owner.x_next + ty * owner.y_next;
    let (at_low_x, at_low_y) = (low_x + dx_o, low_y + dy_o);
    let (at_high_x, at_high_y) = (high_x + dx_o, high_y + dy_o);
    let x_low = tx * at_low_x + ty * at_low_y;
    let x_high = tx * at_high_x + ty * at_high_y;
    let z_low = nx * at_low_x + ny * at_low_y - off;
    let z_high = nx * at_high_x + ny * at_high_y - off;
    let start = x_low.max(face_low);
    let last = x_high.min(face_high);
    let apart = start.simd_gt(last);
    // Beyond the end of the face an edge has no point, but for its nearer corner if that comes onto the face by the next tick:
    // what is at the end now closes slower.
    let (wx_o, wy_o) = (flip.select(-wx, wx), flip.select(-wy, wy));
    let turns = flip.select(aw, bw) * tick;
    let spin = flip.select(aw - bw, bw - aw) * tick;
    let (n_d, t_d) = (nx * dx_o + ny * dy_o, tx * dx_o + ty * dy_o);
    let (along_w, up_w) = (tx * wx_o + ty * wy_o, nx * wx_o + ny * wy_o);
    let comes = |out: V, onto: V, [x, z, other]: [V; 3]| {
        let along = along_w + (spin * (z + off) - turns * n_d);
        let up = up_w - (spin * x - turns * t_d);
        let (goes, over) = (onto * along, z + hysteresis);
        let there = out.simd_gt(zero) & goes.simd_ge(out);
        there & (over * goes + out * up).simd_ge(zero) & z.simd_lt(other) & !apart
    };
    let start = comes(face_low - x_low, one, [x_low, z_low, z_high]).select(x_low, start);
    let last = comes(x_high - face_high, -one, [x_high, z_high, z_low]).select(x_high, last);
    let two = V::splat(simd, 2.0);
    let polygons = own_count.simd_gt(two) & other_count.simd_gt(two);
    // Of two discs neither has a face.
    let discs = a_count.max(b_count).simd_eq(one);
    let beyond = (apart & !(polygons & z_low.min(z_high).simd_le(zero))) | discs;
    let start = apart.select(last, start);
    let run = x_high - x_low;
    let slope = run.simd_gt(zero).select((z_high - z_low) / run, zero);
    let gap_low = z_low + (start - x_low) * slope - radii;
    let gap_high = z_low + (last - x_low) * slope - radii;
    let length = last - start;
    // Points closer than rounding of their places are one.
    let single = length.simd_le(V::splat(simd, 1e-9) * (face_high - face_low));
    let nearest = (single | gap_low.simd_lt(gap_high)).select(gap_low, gap_high);

    let height = off + flip.select(b_radius, a_radius) + half * nearest.min(zero);
    let beyond_height = height + nearest.max(zero) - n_d;
    // Where B owns the face the normal from A to B is −n, and the lower end is farther along it turned by +90°.
    let mut n_x = flip.select(-nx, nx);
    let mut n_y = flip.select(-ny, ny);
    let mut a1 = flip.select(start - t_d, -last);
    let mut b1 = flip.select(start, t_d - last);
    let mut l = single.select(zero, length);
    let mut at_ = flip.select(-beyond_height, height);
    let mut bt = flip.select(-height, beyond_height);
    let mut s1 = flip.select(gap_low, gap_high);
    let mut s2 = single.select(V::splat(simd, OPEN), flip.select(gap_high, gap_low));

    let mut on_face = one.simd_gt(zero);
    let mut short = length.simd_le(V::splat(simd, SHORT) * margin);
    // Both faces end at one place, and touch there: their other sides may go on into each other.
    let aligned = V::splat(simd, SEAM) * margin;
    let low = (x_low - face_low).abs().max(gap_low).simd_le(aligned);
    let high = (x_high - face_high).abs().max(gap_high).simd_le(aligned);
    let seam = low | high;

    // Corner on corner: beyond one end of the face, or where the nearer corner of the other's edge overhangs, since rounded
    // corners meet before the faces do.
    let lower = z_low.simd_le(z_high);
    let overhangs = (lower & x_low.simd_lt(face_low)) | (!lower & x_high.simd_gt(face_high));
    let overhangs = overhangs & radii.simd_gt(zero) & (nearest + radii).simd_gt(zero) & !beyond;
    if any(beyond | overhangs) {
        let past = x_low.simd_gt(face_high);
        let own_next = (beyond & past) | (!beyond & !lower);
        let other_next = (beyond & past) | (!beyond & lower);
        let own_x = own_next.select(owner.x_next, owner.x);
        let own_y = own_next.select(owner.y_next, owner.y);
        let other_x = other_next.select(low_x, high_x);
        let other_y = other_next.select(low_y, high_y);
        let (corner_x, corner_y) = (flip.select(other_x, own_x), flip.select(other_y, own_y));
        let way_x = flip.select(own_x, other_x) + dx - corner_x;
        let way_y = flip.select(own_y, other_y) + dy - corner_y;
        let distance = (way_x * way_x + way_y * way_y).sqrt();
        let some = distance.simd_gt(zero);
        // Discs in one place part upwards.
        let m_x = some.select(way_x / distance, zero);
        let m_y = some.select(way_y / distance, one);
        let gap = distance - radii;
        let instead = (beyond & (some | discs)) | (overhangs & some & gap.simd_lt(nearest));
        let out = a_radius + half * gap;
        let (arm_x, arm_y) = (corner_x + m_x * out, corner_y + m_y * out);
        let (other_arm_x, other_arm_y) = (arm_x - dx, arm_y - dy);
        n_x = instead.select(m_x, n_x);
        n_y = instead.select(m_y, n_y);
        a1 = instead.select(arm_x * m_y - arm_y * m_x, a1);
        b1 = instead.select(other_arm_x * m_y - other_arm_y * m_x, b1);
        l = instead.select(zero, l);
        let (own, other) = (
            arm_x * m_x + arm_y * m_y,
            other_arm_x * m_x + other_arm_y * m_y,
        );
        let apart = half * gap.max(zero);
        at_ = instead.select(own - apart, at_);
        bt = instead.select(other + apart, bt);
        s1 = instead.select(gap, s1);
        s2 = instead.select(V::splat(simd, OPEN), s2);
        short |= instead;
        on_face = !instead;
    }

    // How far the nearer point closes until the next tick, if velocities stay but for gravity.
    let opens = n_x * vx + n_y * vy + b1 * bw - a1 * aw;
    let opens = (opens + l * (bw - aw)).min(opens);
    let pulled = (n_x * (bgx - agx) + n_y * (bgy - agy)).min(zero) * tick;
    let gone = n_x * gone_x + n_y * gone_y;
    let went = gone + b1 * bturn - a1 * aturn;
    let went = (went + l * (bturn - aturn)).min(went);
    let closes = (-(opens + pulled)).max(zero) * tick - went;
    // B overlaps a piece by no more than across its cuts: the rest lies in other pieces, and leaves this one without a jump.
    let crossed = of_a.cut.max(of_b.cut) - radii;
    // Far behind the face it came across the cut, as the tip of a wedge does through a valley: other pieces have faces there.
    let behind = of_a.separation.max(of_b.separation) - radii;
    let cut = behind.simd_lt(-near) & behind.simd_lt(crossed);
    let passes = passes | cut;
    // Rows count from the base poses.
    let (s1, s2) = (s1.max(crossed) - gone, s2.max(crossed) - gone);
    let gap = s2.min(s1);
    let goes = (wx * wx + wy * wy).sqrt();
    // A ghost that is far, and does not come near, does nothing. How long it is says nothing where a side that lies flush in a
    // floor slants away from a face of what moves.
    let acts = gap.simd_lt(V::splat(simd, NEAR) * margin + closes);
    let stands = flip.select(am, bm).simd_eq(zero);
    let slants = stands & (s1 - s2).abs().simd_gt(aligned) & acts & !short;
    let short = short & acts;
    let kept = gap.simd_lt(near + closes) & !passes & (!discs | gap.simd_le(limit + goes));

    n_x.store_slice(&mut found.rows.nx[at..end]);
    n_y.store_slice(&mut found.rows.ny[at..end]);
    a1.store_slice(&mut found.rows.a1[at..end]);
    b1.store_slice(&mut found.rows.b1[at..end]);
    l.store_slice(&mut found.rows.l[at..end]);
    s1.store_slice(&mut found.rows.s1[at..end]);
    s2.store_slice(&mut found.rows.s2[at..end]);
    at_.store_slice(&mut found.rows.at[at..end]);
    bt.store_slice(&mut found.rows.bt[at..end]);
    #[expect(clippy::cast_possible_truncation, reason = "eight lanes")]
    let (near, short, slants, seam, of_a, of_b) = (
        kept.to_bitmask() as u8,
        (kept & short).to_bitmask() as u8,
        (kept & slants).to_bitmask() as u8,
        (kept & seam).to_bitmask() as u8,
        (kept & on_face & !flip).to_bitmask() as u8,
        (kept & on_face & flip).to_bitmask() as u8,
    );
    found.near |= near << at;
    found.short |= short << at;
    found.slants |= slants << at;
    found.seam |= seam << at;
    found.of_a |= of_a << at;
    found.of_b |= of_b << at;
}
