//! The soft sub-step law, row by row: the plain twin of any wider one.
//!
//! Each sub-step solves twice over the same rows. First with bias: an overlap is pushed out by a
//! damped spring, solved implicitly, and the bodies move. Then without: what the push added to the
//! velocities is taken back, and friction acts. Both normals of a face are solved at once by cases
//! (2 × 2 complementarity); that keeps tall stacks standing.

use super::row::{Row, SolverBody};
use crate::Softness;

/// Constants of one sub-step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law {
    pub(super) h: f64,
    pub(super) inverse_h: f64,
    /// Over-relaxation, milder than for rows that last: these are rebuilt in every sub-step.
    pub(super) milder: f64,
    pub(super) push_out: f64,
    /// (rate, γ) between moving bodies, and against the ground at twice the frequency.
    pub(super) soft: [(f64, f64); 2],
}

impl Law {
    /// Length of a sub-step, in s.
    pub(crate) const fn h(&self) -> f64 {
        self.h
    }

    /// Fastest push-out of an overlap, in m/s.
    pub(crate) const fn push_out(&self) -> f64 {
        self.push_out
    }

    /// What a contact may close by, in m/s: up to its gap, or, below 0, what is to push its overlap out.
    pub(crate) fn bias(&self, gap: f64, ground: bool) -> f64 {
        let rate = self.soft[usize::from(ground)].0;
        gap.max(0.0) / self.h + (rate * gap.min(0.0)).max(-self.push_out)
    }

    /// 1/h.
    pub(crate) const fn inverse_h(&self) -> f64 {
        self.inverse_h
    }

    /// ```text
    /// ω = 2π f,  c = 2ζ + hω,  rate = ω/c,  γ = κ/(hωc)
    /// ```
    /// so that at rest `gap = −κ load (1/m)/ω²`: softness, not lack of sweeps, is what a resting
    /// contact sinks in by.
    pub(crate) fn new(softness: &Softness, h: f64) -> Self {
        let kappa = softness.compliance;
        let frequency = softness.frequency.min(0.125 / h);
        let soft = |f: f64| {
            let omega = 2.0 * core::f64::consts::PI * f;
            let c = 2.0 * softness.damping_ratio + h * omega;
            (omega / c, kappa / (h * omega * c))
        };
        Self {
            h,
            inverse_h: h.recip(),
            milder: 1.0 + 0.6 * (softness.over_relaxation - 1.0),
            push_out: softness.push_out,
            soft: [soft(frequency), soft(2.0 * frequency)],
        }
    }
}

/// A sub-step of all rows from the impulses that they carry: velocities, and displacements of the bodies that these join.
pub(crate) fn sweep(law: &Law, bodies: &mut [SolverBody], rows: &mut [Row], relaxes: usize) {
    warm_start(bodies, rows);
    solve(law, bodies, rows);
    for row in &*rows {
        for index in [row.bodies.0, row.bodies.1] {
            let body = &mut bodies[index as usize];
            (body.d, body.turn) = (body.v * law.h, body.w * law.h);
        }
    }
    for _ in 0..relaxes {
        relax(law, bodies, rows);
    }
}

/// Velocities that the impulses of rows make.
pub(crate) fn warm_start(bodies: &mut [SolverBody], rows: &[Row]) {
    for row in rows {
        let (i, j) = (row.bodies.0 as usize, row.bodies.1 as usize);
        let (mut a, mut b) = (bodies[i], bodies[j]);
        row.push(&mut a, &mut b, row.j, row.jt);
        (bodies[i], bodies[j]) = (a, b);
    }
}

/// One sweep with bias over all rows, from the impulses that they carry.
pub(super) fn solve(law: &Law, bodies: &mut [SolverBody], rows: &mut [Row]) {
    for row in rows {
        let (mut a, mut b) = (bodies[row.bodies.0 as usize], bodies[row.bodies.1 as usize]);
        let gamma = law.soft[usize::from(row.ground)].1;
        let v = row.normal_velocity(&a, &b);
        let bias = |gap: f64| law.bias(gap, row.ground);
        let soften = |gap: f64| if gap <= 0.0 { 1.0 + gamma } else { 1.0 };
        let u = [v[0] + bias(row.gap[0]), v[1] + bias(row.gap[1])];
        let softened = [soften(row.gap[0]), soften(row.gap[1])];
        normals(law.milder, row, &mut a, &mut b, u, softened);
        store(row, bodies, a, b);
    }
}

/// One sweep without bias over all rows, then friction.
pub(super) fn relax(law: &Law, bodies: &mut [SolverBody], rows: &mut [Row]) {
    for row in rows {
        let (mut a, mut b) = (bodies[row.bodies.0 as usize], bodies[row.bodies.1 as usize]);
        let gap = row.moved_gap(&a, &b);
        let v = row.normal_velocity(&a, &b);
        let u = [
            v[0] + gap[0].max(0.0) / law.h,
            v[1] + gap[1].max(0.0) / law.h,
        ];
        normals(law.milder, row, &mut a, &mut b, u, [1.0, 1.0]);
        if row.mu > 0.0 {
            let k = a.inverse_mass
                + b.inverse_mass
                + row.at * row.at * a.inverse_inertia
                + row.bt * row.bt * b.inverse_inertia;
            let limit = row.mu * (row.j[0] + row.j[1]);
            let jt = (row.jt - (row.slip(&a, &b) - row.belt) / k).clamp(-limit, limit);
            row.push(&mut a, &mut b, [0.0, 0.0], jt - row.jt);
            row.jt = jt;
        }
        store(row, bodies, a, b);
    }
}

/// Both normal impulses at once: the case of the 2 × 2 complementarity problem that holds.
///
/// `u` is the velocity that the row wants to be zero, taken with the present impulses; the rest of
/// it, with the softened diagonal, is `K x = k j − u`.
fn normals(
    omega: f64,
    row: &mut Row,
    a: &mut SolverBody,
    b: &mut SolverBody,
    u: [f64; 2],
    softened: [f64; 2],
) {
    let m = a.inverse_mass + b.inverse_mass;
    let (ia, ib) = (a.inverse_inertia, b.inverse_inertia);
    let k11 = m + ia * row.a[0] * row.a[0] + ib * row.b[0] * row.b[0];
    let k12 = m + ia * row.a[0] * row.a[1] + ib * row.b[0] * row.b[1];
    let k22 = m + ia * row.a[1] * row.a[1] + ib * row.b[1] * row.b[1];
    let r1 = k11 * row.j[0] + k12 * row.j[1] - u[0];
    let r2 = k12 * row.j[0] + k22 * row.j[1] - u[1];
    let (s11, s22) = (k11 * softened[0], k22 * softened[1]);
    let determinant = s11 * s22 - k12 * k12;
    // Locked rotations make both points one: then one of them pushes alone.
    let both = [
        (s22 * r1 - k12 * r2) / determinant,
        (s11 * r2 - k12 * r1) / determinant,
    ];
    let regular = determinant > 1e-12 * s11 * s22;
    let first = r1 / s11;
    let x = if regular && both[0] >= 0.0 && both[1] >= 0.0 {
        both
    } else if first >= 0.0 && k12 * first >= r2 {
        [first, 0.0]
    } else {
        [0.0, (r2 / s22).max(0.0)]
    };
    let step = |j: f64, x: f64| (j + omega * (x - j)).max(0.0);
    let j = [step(row.j[0], x[0]), step(row.j[1], x[1])];
    row.push(a, b, [j[0] - row.j[0], j[1] - row.j[1]], 0.0);
    row.j = j;
}

fn store(row: &Row, bodies: &mut [SolverBody], mut a: SolverBody, mut b: SolverBody) {
    if row.acts() {
        a.acted = true;
        b.acted = true;
    }
    bodies[row.bodies.0 as usize] = a;
    bodies[row.bodies.1 as usize] = b;
}
