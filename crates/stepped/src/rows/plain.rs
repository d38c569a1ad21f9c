//! The soft law, lane by lane: the scalar twin of the wide kernel, bit for bit, and what sweeps single rows.

use super::block::Block;
#[cfg(test)]
use super::block::LANES;
#[cfg(test)]
use super::colour::Colour;
use super::kernel::{Pass, REGULAR};
use super::law::Law;
use super::line::Line;

/// One pass over all rows, colour by colour; the heat of friction.
#[cfg(test)]
pub(crate) fn sweep(pass: Pass, law: &Law, lines: &mut [Line], colours: &mut [Colour]) -> f64 {
    let mut heat = [0.0; LANES];
    for colour in colours {
        for (block, cold) in colour.blocks.iter_mut().zip(&colour.cold) {
            for (lane, heat) in heat.iter_mut().enumerate() {
                *heat += row(pass, law, lines, block, lane, cold.belt[lane], None);
            }
        }
    }
    heat.iter().fold(0.0, |sum, heat| sum + heat)
}

/// The second where both are equal, or zeros of either sign.
fn larger(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// The second where both are equal, or zeros of either sign.
fn smaller(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

/// The heat of a friction impulse in J, by the mean of the slips at both ends of the sub-step as far as its row knows: before it was
/// `k` times the impulse less than the `slip` it left. What sticks makes none.
pub(super) fn friction_heat(impulse: f64, slip: f64, k: f64) -> f64 {
    let most = slip.abs();
    let half = larger(-most, smaller(most, 0.5 * (k * impulse)));
    -(impulse * (slip - half))
}

fn positive(x: f64) -> f64 {
    larger(x, 0.0)
}

/// A row; in an `extra` sweep it is over-relaxed by so much in all passes. Bodies that no lane of the block shares may be written at
/// once. The heat of its friction, in J.
pub(crate) fn row(
    pass: Pass,
    law: &Law,
    lines: &mut [Line],
    block: &mut Block,
    lane: usize,
    belt: f64,
    extra: Option<f64>,
) -> f64 {
    let mut heat = 0.0;
    let bias = pass == Pass::Solve;
    let (ia, ib) = (block.a[lane].at(), block.b[lane].at());
    let Line([mut avx, mut avy, mut aw, ma, adx, ady, aturn, i_a]) = lines[ia];
    let Line([mut bvx, mut bvy, mut bw, mb, bdx, bdy, bturn, i_b]) = lines[ib];
    let (nx, ny) = (block.nx[lane], block.ny[lane]);
    let (a1, b1, l) = (block.a1[lane], block.b1[lane], block.l[lane]);
    let (j1, j2) = (block.j1[lane], block.j2[lane]);

    let v1 = nx * (bvx - avx) + ny * (bvy - avy) + b1 * bw - a1 * aw;
    let v2 = v1 + l * (bw - aw);
    let moved1 = nx * (bdx - adx) + ny * (bdy - ady) + b1 * bturn - a1 * aturn;
    let moved2 = moved1 + l * (bturn - aturn);
    let (gap1, gap2) = (block.s1[lane] + moved1, block.s2[lane] + moved2);
    let m = ma + mb;
    let turns = i_a * a1 + i_b * b1;
    let k11 = m + (i_a * a1 * a1 + i_b * b1 * b1);
    let k12 = k11 + turns * l;
    let k22 = k12 + (turns + (i_a + i_b) * l) * l;
    let k12 = k12 * REGULAR;
    let (u1, u2, s11, s22, softened);
    if bias {
        let (rate, soft) = law.soft[usize::from(smaller(ma, mb) == 0.0)];
        softened = soft;
        (s11, s22) = (k11 * softened, k22 * softened);
        let push = |gap: f64| {
            let factor = if gap > 0.0 { law.inverse_h } else { rate };
            larger(gap * factor, -law.push_out)
        };
        let stiff = |gap: f64, j: f64| if gap > 0.0 { j } else { 0.0 };
        u1 = v1 + push(gap1) - (s11 - k11) * stiff(gap1, j1);
        u2 = v2 + push(gap2) - (s22 - k22) * stiff(gap2, j2);
    } else {
        softened = 1.0;
        u1 = v1 + positive(gap1) * law.inverse_h;
        u2 = v2 + positive(gap2) * law.inverse_h;
        (s11, s22) = (k11, k22);
    }

    let product = s11 * s22;
    let det = product - k12 * k12;
    let q = 1.0 / (product * det);
    let inverse = q * product;
    let alone = q * det;
    let r1 = k11 * j1 + k12 * j2 - u1;
    let r2 = k12 * j1 + k22 * j2 - u2;
    let (y1, y2) = (positive(r1 * (alone * s22)), positive(r2 * (alone * s11)));
    let x1 = (s22 * r1 - k12 * r2) * inverse;
    let x2 = (s11 * r2 - k12 * r1) * inverse;
    let (x1, x2) = if smaller(x1, x2) >= 0.0 {
        (x1, x2)
    } else if k12 * y1 >= r2 {
        (y1, 0.0)
    } else {
        (0.0, y2)
    };

    let (new1, new2) = if let Some(omega) = extra {
        // Where it would pull the solution itself is taken: cut off point by point, it can be farther from it than before.
        let (h1, h2) = (j1 + omega * (x1 - j1), j2 + omega * (x2 - j2));
        if smaller(h1, h2) >= 0.0 {
            (h1, h2)
        } else {
            (x1, x2)
        }
    } else if bias {
        // An impulse that more than doubles stops a blow, and one that is more than halved, or lets an open gap close, lets go
        // enough.
        let j = j1 + j2;
        let x = x1 + x2;
        let rests = j > 0.0 && j + j >= x && x + x >= j;
        let omega = |gap: f64| {
            if rests && gap <= 0.0 {
                law.over_relaxation
            } else {
                softened
            }
        };
        (
            positive(j1 + omega(gap1) * (x1 - j1)),
            positive(j2 + omega(gap2) * (x2 - j2)),
        )
    } else {
        (x1, x2)
    };
    (block.j1[lane], block.j2[lane]) = (new1, new2);
    let d2 = new2 - j2;
    let sum = new1 - j1 + d2;
    let (px, py) = (nx * sum, ny * sum);
    let bend = l * d2;
    avx -= px * ma;
    avy -= py * ma;
    bvx += px * mb;
    bvy += py * mb;
    aw -= (a1 * sum + bend) * i_a;
    bw += (b1 * sum + bend) * i_b;

    if !bias {
        let (at, bt, jt) = (block.at[lane], block.bt[lane], block.jt[lane]);
        let (eases_a, eases_b) = (i_a * at, i_b * bt);
        let k = m + (eases_a * at + eases_b * bt);
        let vt = nx * (bvy - avy) - ny * (bvx - avx) + (bt * bw - at * aw) - belt;
        let limit = block.mu[lane] * (new1 + new2);
        let wanted = smaller(limit, jt - vt * (1.0 / k));
        let new = larger(-limit, wanted);
        let dt = new - jt;
        block.jt[lane] = new;
        heat = friction_heat(new, vt + k * dt, k);
        let (px, py) = (-ny * dt, nx * dt);
        avx -= px * ma;
        avy -= py * ma;
        bvx += px * mb;
        bvy += py * mb;
        aw -= eases_a * dt;
        bw += eases_b * dt;
    }
    lines[ia].0[..3].copy_from_slice(&[avx, avy, aw]);
    lines[ib].0[..3].copy_from_slice(&[bvx, bvy, bw]);
    heat
}
