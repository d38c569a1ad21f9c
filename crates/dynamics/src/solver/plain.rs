//! The wide sweeps' slow twin: the same law row by row, in plain numbers, in the same order of
//! operations, so that the bits are the same.

use super::Law;
use super::kernel::Pass;
use super::wide::{LANES, Line, Wide};

/// What [`super::kernel::sweep`] does.
pub(crate) fn sweep(pass: Pass, law: &Law, lines: &mut [Line], colours: &mut [Vec<Wide>]) -> f64 {
    let mut heat = [0.0; LANES];
    for wide in colours.iter_mut().flatten() {
        for (lane, heat) in heat.iter_mut().enumerate() {
            row(pass, law, lines, wide, lane, heat);
        }
    }
    heat.iter().fold(0.0, |sum, heat| sum + heat)
}

fn positive(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

/// One lane; bodies that no lane of the block shares may be written at once.
fn row(pass: Pass, law: &Law, lines: &mut [Line], wide: &mut Wide, lane: usize, heat: &mut f64) {
    let relax = pass != Pass::Solve;
    let (ia, ib) = (wide.a[lane] as usize, wide.b[lane] as usize);
    let Line([mut avx, mut avy, mut aw, ma, adx, ady, aturn, i_a]) = lines[ia];
    let Line([mut bvx, mut bvy, mut bw, mb, bdx, bdy, bturn, i_b]) = lines[ib];
    let (nx, ny) = (wide.nx[lane], wide.ny[lane]);
    let (a1, a2) = (wide.a1[lane], wide.a2[lane]);
    let (b1, b2) = (wide.b1[lane], wide.b2[lane]);
    let (j1, j2) = (wide.j1[lane], wide.j2[lane]);

    let vn = nx * (bvx - avx) + ny * (bvy - avy);
    let dn = nx * (bdx - adx) + ny * (bdy - ady);
    let gap1 = wide.s1[lane] + dn + b1 * bturn - a1 * aturn;
    let gap2 = wide.s2[lane] + dn + b2 * bturn - a2 * aturn;
    let mut u1 = vn + b1 * bw - a1 * aw + positive(gap1) * law.inverse_h;
    let mut u2 = vn + b2 * bw - a2 * aw + positive(gap2) * law.inverse_h;

    let m = ma + mb;
    let k11 = m + i_a * a1 * a1 + i_b * b1 * b1;
    let k12 = m + i_a * a1 * a2 + i_b * b1 * b2;
    let k22 = m + i_a * a2 * a2 + i_b * b2 * b2;
    let (mut s11, mut s22) = (k11, k22);
    if !relax {
        let ground = ma == 0.0 || mb == 0.0;
        let (rate, gamma) = law.soft[usize::from(ground)];
        let push = |gap: f64| {
            if rate * gap > -law.push_out {
                rate * gap
            } else {
                -law.push_out
            }
        };
        u1 += if gap1 > 0.0 { 0.0 } else { push(gap1) };
        u2 += if gap2 > 0.0 { 0.0 } else { push(gap2) };
        s11 *= if gap1 > 0.0 { 1.0 } else { 1.0 + gamma };
        s22 *= if gap2 > 0.0 { 1.0 } else { 1.0 + gamma };
    }

    let r1 = k11 * j1 + k12 * j2 - u1;
    let r2 = k12 * j1 + k22 * j2 - u2;
    let product = s11 * s22;
    let det = product - k12 * k12;
    let regular = det > product * 1e-12;
    let det = if regular { det } else { 1.0 };
    let q = 1.0 / (product * det);
    let (y1, y2) = (r1 * (q * s22 * det), r2 * (q * s11 * det));
    let inverse = q * product;
    let x1 = (s22 * r1 - k12 * r2) * inverse;
    let x2 = (s11 * r2 - k12 * r1) * inverse;
    let (x1, x2) = if regular && x1 >= 0.0 && x2 >= 0.0 {
        (x1, x2)
    } else if y1 >= 0.0 && k12 * y1 >= r2 {
        (y1, 0.0)
    } else {
        (0.0, positive(y2))
    };

    let omega = if j1 + j2 > 0.0 {
        law.over_relaxation
    } else {
        1.0
    };
    let (new1, new2) = (
        positive(j1 + omega * (x1 - j1)),
        positive(j2 + omega * (x2 - j2)),
    );
    let (d1, d2) = (new1 - j1, new2 - j2);
    (wide.j1[lane], wide.j2[lane]) = (new1, new2);
    let (px, py) = (nx * (d1 + d2), ny * (d1 + d2));
    avx -= px * ma;
    avy -= py * ma;
    bvx += px * mb;
    bvy += py * mb;
    aw -= (a1 * d1 + a2 * d2) * i_a;
    bw += (b1 * d1 + b2 * d2) * i_b;

    if relax {
        let (at, bt, jt) = (wide.at[lane], wide.bt[lane], wide.jt[lane]);
        let belt = if pass == Pass::RelaxBelts {
            wide.belt[lane]
        } else {
            0.0
        };
        let vt = nx * (bvy - avy) - ny * (bvx - avx) + bt * bw - at * aw - belt;
        let k = m + i_a * at * at + i_b * bt * bt;
        let limit = wide.mu[lane] * (new1 + new2);
        let wanted = jt - vt / k;
        let wanted = if wanted > limit { limit } else { wanted };
        let new = if wanted < -limit { -limit } else { wanted };
        let dt = new - jt;
        wide.jt[lane] = new;
        let (px, py) = (-ny * dt, nx * dt);
        avx -= px * ma;
        avy -= py * ma;
        bvx += px * mb;
        bvy += py * mb;
        aw -= at * dt * i_a;
        bw += bt * dt * i_b;
        let slip = vt + k * dt;
        let half = 0.5 * k * new;
        let most = slip.abs();
        let half = if half > most { most } else { half };
        let half = if half < -most { -most } else { half };
        *heat -= new * (slip - half);
    }
    lines[ia].0[..3].copy_from_slice(&[avx, avy, aw]);
    lines[ib].0[..3].copy_from_slice(&[bvx, bvy, bw]);
}
