//! What the solver works on: bodies and contact rows, in the letters of the equations.

use carom_math::{Vec2, cross, perp};

/// A body in the solver; one of infinite mass has m⁻¹ = I⁻¹ = 0.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SolverBody {
    pub(crate) v: Vec2,
    pub(crate) w: f64,
    pub(crate) inverse_mass: f64,
    pub(crate) inverse_inertia: f64,
    /// Displacement and turn within the sub-step.
    pub(crate) d: Vec2,
    pub(crate) turn: f64,
    /// Some row pushes it.
    pub(crate) acted: bool,
}

/// A contact of up to two points with one normal: two normal impulses and one of friction.
///
/// ```text
/// a_i = r_A × n, b_i = r_B × n of point i;   a_t = r_A · n, b_t = r_B · n of the face
/// v_i = n·(v_B − v_A) + b_i ω_B − a_i ω_A     normal velocity of point i, positive opens
/// v_t = t·(v_B − v_A) + b_t ω_B − a_t ω_A     slip along t, the normal turned by +90°
/// ```
/// In the plane both friction forces of a face act along one line: one row with limit µ (j₁ + j₂)
/// is the same mechanics. A contact of one point keeps its second gap at [`Row::OPEN`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// Places in the solver's list of bodies.
    pub(crate) bodies: (u32, u32),
    pub(crate) n: Vec2,
    pub(crate) a: [f64; 2],
    pub(crate) b: [f64; 2],
    pub(crate) at: f64,
    pub(crate) bt: f64,
    pub(crate) mu: f64,
    /// Slip at which both surfaces run along with each other, in m/s: see [`crate::PairMaterial`].
    pub(crate) belt: f64,
    /// Gaps at the start of the sub-step, in m.
    pub(crate) gap: [f64; 2],
    /// Normal impulses, in N·s.
    pub(crate) j: [f64; 2],
    /// Tangential impulse, in N·s.
    pub(crate) jt: f64,
}

impl Row {
    /// A gap so wide that the point never acts.
    pub(crate) const OPEN: f64 = 1e6;

    /// A row for points at `arms` from the two centres of mass.
    pub(crate) fn new(bodies: (u32, u32), n: Vec2, arms: &[(Vec2, Vec2)], mu: f64) -> Self {
        let first = arms[0];
        let last = arms[arms.len() - 1];
        let (mid_a, mid_b) = ((first.0 + last.0) * 0.5, (first.1 + last.1) * 0.5);
        // An empty second point must leave the 2 × 2 matrix regular.
        let second = |r: Vec2| {
            if arms.len() == 1 {
                cross(r, n) + 1.0
            } else {
                cross(r, n)
            }
        };
        Self {
            bodies,
            n,
            a: [cross(first.0, n), second(last.0)],
            b: [cross(first.1, n), second(last.1)],
            at: mid_a.dot(n),
            bt: mid_b.dot(n),
            mu,
            belt: 0.0,
            gap: [Self::OPEN; 2],
            j: [0.0; 2],
            jt: 0.0,
        }
    }

    /// Slip of the bodies at the face; of its surfaces, with their belts left out.
    pub(crate) fn slip(&self, a: &SolverBody, b: &SolverBody) -> f64 {
        self.slip_of((a.v, a.w), (b.v, b.w))
    }

    /// Opening speeds of both points, and the slip beyond that of the surfaces, of bodies that move like this.
    pub(crate) fn seen(&self, a: (Vec2, f64), b: (Vec2, f64)) -> [f64; 3] {
        let v = self.n.dot(b.0 - a.0);
        [
            v + self.b[0] * b.1 - self.a[0] * a.1,
            v + self.b[1] * b.1 - self.a[1] * a.1,
            self.slip_of(a, b) - self.belt,
        ]
    }

    fn slip_of(&self, (va, wa): (Vec2, f64), (vb, wb): (Vec2, f64)) -> f64 {
        perp(self.n).dot(vb - va) + self.bt * wb - self.at * wa
    }

    /// Applies ±(j₁ + j₂) n ± `j_t` t.
    pub(crate) fn push(&self, a: &mut SolverBody, b: &mut SolverBody, j: [f64; 2], jt: f64) {
        let impulse = self.n * (j[0] + j[1]) + perp(self.n) * jt;
        a.v -= impulse * a.inverse_mass;
        b.v += impulse * b.inverse_mass;
        a.w -= (self.a[0] * j[0] + self.a[1] * j[1] + self.at * jt) * a.inverse_inertia;
        b.w += (self.b[0] * j[0] + self.b[1] * j[1] + self.bt * jt) * b.inverse_inertia;
    }

    /// Whether it pushes at all.
    pub(crate) fn acts(&self) -> bool {
        self.j[0] + self.j[1] > 0.0
    }

    /// Work that the impulse does on the solver's moving bodies because A or B is driven, in J:
    /// impulse × velocity of the driven point.
    pub(crate) fn driven_work(&self, a: &SolverBody, b: &SolverBody) -> f64 {
        let drive = |v: Vec2, w: f64, arms: [f64; 2], tangent: f64| {
            (self.n.dot(v) + arms[0] * w) * self.j[0]
                + (self.n.dot(v) + arms[1] * w) * self.j[1]
                + (perp(self.n).dot(v) + tangent * w) * self.jt
        };
        let mut work = 0.0;
        if a.inverse_mass == 0.0 {
            work += drive(a.v, a.w, self.a, self.at);
        }
        if b.inverse_mass == 0.0 {
            work -= drive(b.v, b.w, self.b, self.bt);
        }
        work
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::{cross_scalar, vec2};

    #[test]
    fn row_velocities_are_those_of_the_points() {
        let a = SolverBody {
            v: vec2(1.0, -2.0),
            w: 0.7,
            ..SolverBody::default()
        };
        let b = SolverBody {
            v: vec2(-0.5, 3.0),
            w: -1.3,
            ..SolverBody::default()
        };
        let n = vec2(0.6, 0.8);
        // Two points on one line along the tangent, seen from two centres.
        let base = vec2(0.3, 0.4);
        let ends = [base, base + perp(n) * 0.9];
        let centres = [vec2(-1.0, 0.2), vec2(1.4, 1.1)];
        let arms: Vec<_> = ends
            .iter()
            .map(|p| (*p - centres[0], *p - centres[1]))
            .collect();
        let row = Row::new((0, 1), n, &arms, 0.5);
        let [first, last, _] = row.seen((a.v, a.w), (b.v, b.w));
        for (arm, got) in arms.iter().zip([first, last]) {
            let u = (b.v + cross_scalar(b.w, arm.1)) - (a.v + cross_scalar(a.w, arm.0));
            assert!((got - u.dot(n)).abs() < 1e-15);
            assert!((row.slip(&a, &b) - u.dot(perp(n))).abs() < 1e-15);
        }
    }
}
