//! The wide sweeps' slow twin: the same law row by row, in plain numbers, in the same order of
//! operations, so that the bits are the same.

use super::kernel::{HEAVY, MET, Pass};
use super::wide::{LANES, Line, REGULAR, Wide};
use super::{Law, Row};

/// What [`super::kernel::sweep`] does.
pub(crate) fn sweep(pass: Pass, law: &Law, lines: &mut [Line], colours: &mut [Vec<Wide>]) -> f64 {
    let mut heat = [0.0; LANES];
    for wide in colours.iter_mut().flatten() {
        if is_idle(pass, law, lines, wide) {
            continue;
        }
        for (lane, heat) in heat.iter_mut().enumerate() {
            row(pass, law, lines, wide, lane, heat);
        }
    }
    heat.iter().fold(0.0, |sum, heat| sum + heat)
}

/// Every row, of blocks in which nothing pushes, too: changes nothing there but signs of zeros.
pub(crate) fn sweep_all(pass: Pass, law: &Law, lines: &mut [Line], colours: &mut [Vec<Wide>]) {
    for wide in colours.iter_mut().flatten() {
        for lane in 0..LANES {
            row(pass, law, lines, wide, lane, &mut 0.0);
        }
    }
}

/// Whether no row of a block pushes, and none closes in this sub-step.
fn is_idle(pass: Pass, law: &Law, lines: &[Line], wide: &Wide) -> bool {
    let relax = pass != Pass::Solve;
    (0..LANES).all(|lane| {
        let (a, b) = (wide.a[lane], wide.b[lane]);
        let row = wide.row(lane, (a, b), lines);
        let (a, b) = (&lines[a as usize], &lines[b as usize]);
        let v1 = row.n.x * (b.v().x - a.v().x) + row.n.y * (b.v().y - a.v().y) + row.b[0] * b.w()
            - row.a[0] * a.w();
        let v2 = v1 + wide.l[lane] * (b.w() - a.w());
        let moved1 =
            row.n.x * (b.d().x - a.d().x) + row.n.y * (b.d().y - a.d().y) + row.b[0] * b.turn()
                - row.a[0] * a.turn();
        let moved2 = moved1 + wide.l[lane] * (b.turn() - a.turn());
        let closes = |v: f64, gap: f64| {
            let counts = if relax { positive(gap) } else { gap };
            v + counts * law.inverse_h < 0.0
        };
        let pushes = row.j[0] + row.j[1] + if relax { row.jt.abs() } else { 0.0 } > 0.0;
        !pushes && !closes(v1, wide.s1[lane] + moved1) && !closes(v2, wide.s2[lane] + moved2)
    })
}

/// The second where both are equal, or zeros of either sign.
fn larger(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// The second where both are equal, or zeros of either sign.
fn smaller(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

fn positive(x: f64) -> f64 {
    larger(x, 0.0)
}

/// One lane; bodies that no lane of the block shares may be written at once.
fn row(pass: Pass, law: &Law, lines: &mut [Line], wide: &mut Wide, lane: usize, heat: &mut f64) {
    let relax = pass != Pass::Solve;
    let (ia, ib) = (wide.a[lane] as usize, wide.b[lane] as usize);
    let Line([mut avx, mut avy, mut aw, ma, adx, ady, aturn, i_a]) = lines[ia];
    let Line([mut bvx, mut bvy, mut bw, mb, bdx, bdy, bturn, i_b]) = lines[ib];
    let (nx, ny) = (wide.nx[lane], wide.ny[lane]);
    let (a1, b1, l) = (wide.a1[lane], wide.b1[lane], wide.l[lane]);
    let (j1, j2) = (wide.j1[lane], wide.j2[lane]);

    let v1 = nx * (bvx - avx) + ny * (bvy - avy) + b1 * bw - a1 * aw;
    let v2 = v1 + l * (bw - aw);
    let moved1 = nx * (bdx - adx) + ny * (bdy - ady) + b1 * bturn - a1 * aturn;
    let moved2 = moved1 + l * (bturn - aturn);
    let (gap1, gap2) = (wide.s1[lane] + moved1, wide.s2[lane] + moved2);
    let m = ma + mb;
    let turns = i_a * a1 + i_b * b1;
    let k11 = m + (i_a * a1 * a1 + i_b * b1 * b1);
    let k12 = k11 + turns * l;
    let k22 = k12 + (turns + (i_a + i_b) * l) * l;
    let k12 = k12 * REGULAR;
    let (u1, u2, s11, s22, omega);
    if relax {
        u1 = v1 + positive(gap1) * law.inverse_h;
        u2 = v2 + positive(gap2) * law.inverse_h;
        (s11, s22) = (k11, k22);
        omega = 1.0;
    } else {
        let ground = ma == 0.0 || mb == 0.0;
        let (rate, gamma) = law.soft[usize::from(ground)];
        let softened = 1.0 + gamma;
        (s11, s22) = (k11 * softened, k22 * softened);
        let bias = |gap: f64| {
            let factor = if gap > 0.0 { law.inverse_h } else { rate };
            larger(gap * factor, -law.push_out)
        };
        let stiff = |gap: f64, j: f64| if gap > 0.0 { j } else { 0.0 };
        u1 = v1 + bias(gap1) - (s11 - k11) * stiff(gap1, j1);
        u2 = v2 + bias(gap2) - (s22 - k22) * stiff(gap2, j2);
        let struck = |v: f64, gap: f64| v < -MET && gap < 0.5 * Row::OPEN;
        let struck = struck(v1, gap1) || struck(v2, gap2);
        let loaded = larger(ma, mb) > smaller(ma, mb) * HEAVY;
        omega = if j1 + j2 > 0.0 && (loaded || !struck) {
            law.over_relaxation
        } else {
            softened
        };
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
    let (x1, x2) = if x1 >= 0.0 && x2 >= 0.0 {
        (x1, x2)
    } else if k12 * y1 >= r2 {
        (y1, 0.0)
    } else {
        (0.0, y2)
    };

    let (new1, new2) = if relax {
        (x1, x2)
    } else {
        (
            positive(j1 + omega * (x1 - j1)),
            positive(j2 + omega * (x2 - j2)),
        )
    };
    (wide.j1[lane], wide.j2[lane]) = (new1, new2);
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

    if relax {
        let (at, bt, jt) = (wide.at[lane], wide.bt[lane], wide.jt[lane]);
        let belt = if pass != Pass::Relax {
            wide.belt[lane]
        } else {
            0.0
        };
        let (eases_a, eases_b) = (i_a * at, i_b * bt);
        let k = m + (eases_a * at + eases_b * bt);
        let vt = nx * (bvy - avy) - ny * (bvx - avx) + (bt * bw - at * aw) - belt;
        let limit = wide.mu[lane] * (new1 + new2);
        let wanted = smaller(limit, jt - vt * (1.0 / k));
        let new = larger(-limit, wanted);
        let dt = new - jt;
        wide.jt[lane] = new;
        let (px, py) = (-ny * dt, nx * dt);
        avx -= px * ma;
        avy -= py * ma;
        bvx += px * mb;
        bvy += py * mb;
        aw -= eases_a * dt;
        bw += eases_b * dt;
        let slip = vt + k * dt;
        let most = slip.abs();
        let half = larger(-most, smaller(most, 0.5 * k * new));
        *heat -= new * (slip - half);
    }
    lines[ia].0[..3].copy_from_slice(&[avx, avy, aw]);
    lines[ib].0[..3].copy_from_slice(&[bvx, bvy, bw]);
}
