//! What the sweeps read and write: body lines, and contact rows in blocks of eight.

use carom_math::{Vec2, perp, vec2};

use super::Row;

/// Rows in a block, and lanes of a wide register.
pub(crate) const LANES: usize = 8;

/// What is left of k₁₂: where nobody can turn both points are one, and may share the load as they like. As its
/// determinant the matrix has 2e-12 of the product of its diagonal then.
pub(super) const REGULAR: f64 = 1.0 - 1e-12;

/// A body in the solver, in one cache line:
///
/// ```text
/// vx vy ω m⁻¹   dx dy dθ I⁻¹
/// ```
/// d is where the body is, against its base pose. What cannot be moved has m⁻¹ = I⁻¹ = 0, so
/// that writing its line back changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Line(pub(crate) [f64; 8]);

impl Line {
    /// The line that empty lanes name for both bodies: its matrix is regular, its velocity stays 0.
    pub(crate) const EMPTY: Self = Self([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);

    pub(crate) const fn new(v: Vec2, w: f64, inverse_mass: f64, inverse_inertia: f64) -> Self {
        Self([v.x, v.y, w, inverse_mass, 0.0, 0.0, 0.0, inverse_inertia])
    }

    pub(crate) const fn v(&self) -> Vec2 {
        vec2(self.0[0], self.0[1])
    }

    pub(crate) const fn w(&self) -> f64 {
        self.0[2]
    }

    pub(crate) const fn d(&self) -> Vec2 {
        vec2(self.0[4], self.0[5])
    }

    pub(crate) const fn turn(&self) -> f64 {
        self.0[6]
    }

    pub(crate) const fn inverse_mass(&self) -> f64 {
        self.0[3]
    }

    pub(crate) const fn inverse_inertia(&self) -> f64 {
        self.0[7]
    }
}

/// Eight rows of one colour: no two of them move the same body. 120 bytes a row, of which a solving sweep reads 80.
///
/// The letters are those of [`Row`]. Both points lie on one face, l apart: a₂ = a₁ + l, b₂ = b₁ + l. `s` is a gap told so
/// that it holds however the bodies move on. The unsoftened matrix of the points is worked out where it is needed, and so
/// is what friction feels: large piles wait for memory.
///
/// ```text
/// gap_i = s_i + n·(d_B − d_A) + b_i θ_B − a_i θ_A
/// k_ij  = m_A⁻¹ + m_B⁻¹ + I_A⁻¹ a_i a_j + I_B⁻¹ b_i b_j,   k_t alike with a_t and b_t
/// k_12  = k_11 + (I_A⁻¹ a_1 + I_B⁻¹ b_1) l
/// k_22  = k_12 + (I_A⁻¹ a_1 + I_B⁻¹ b_1 + (I_A⁻¹ + I_B⁻¹) l) l
/// ```
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Wide {
    pub(crate) a: [u32; LANES],
    pub(crate) b: [u32; LANES],
    pub(crate) nx: [f64; LANES],
    pub(crate) ny: [f64; LANES],
    pub(crate) a1: [f64; LANES],
    pub(crate) b1: [f64; LANES],
    pub(crate) l: [f64; LANES],
    pub(crate) s1: [f64; LANES],
    pub(crate) s2: [f64; LANES],
    pub(crate) j1: [f64; LANES],
    pub(crate) j2: [f64; LANES],
    /// From here on: friction, for relaxing sweeps.
    pub(crate) at: [f64; LANES],
    pub(crate) bt: [f64; LANES],
    pub(crate) mu: [f64; LANES],
    pub(crate) jt: [f64; LANES],
    /// Read only where some surface runs along.
    pub(crate) belt: [f64; LANES],
}

impl Wide {
    /// No rows: gaps so wide that nothing acts, between line 0 and itself.
    pub(crate) const EMPTY: Self = Self {
        a: [0; LANES],
        b: [0; LANES],
        nx: [1.0; LANES],
        ny: [0.0; LANES],
        a1: [0.0; LANES],
        b1: [0.0; LANES],
        l: [1.0; LANES],
        at: [0.0; LANES],
        bt: [0.0; LANES],
        mu: [0.0; LANES],
        s1: [Row::OPEN; LANES],
        s2: [Row::OPEN; LANES],
        j1: [0.0; LANES],
        j2: [0.0; LANES],
        jt: [0.0; LANES],
        belt: [0.0; LANES],
    };

    /// Puts a row of the lane's bodies into it; its gaps are those of now, with the bodies where their lines say.
    pub(crate) fn put(&mut self, lane: usize, row: &Row, a: &Line, b: &Line) {
        (self.nx[lane], self.ny[lane]) = (row.n.x, row.n.y);
        (self.a1[lane], self.b1[lane]) = (row.a[0], row.b[0]);
        self.l[lane] = row.a[1] - row.a[0];
        (self.at[lane], self.bt[lane]) = (row.at, row.bt);
        self.mu[lane] = row.mu;
        let moved = row.n.dot(b.d() - a.d());
        self.s1[lane] = row.gap[0] - moved - row.b[0] * b.turn() + row.a[0] * a.turn();
        self.s2[lane] = row.gap[1] - moved - row.b[1] * b.turn() + row.a[1] * a.turn();
        [self.j1[lane], self.j2[lane]] = row.j;
        self.jt[lane] = row.jt;
        self.belt[lane] = row.belt;
    }

    /// B, or else A, counts from where its line says from now on: the gaps stay.
    pub(crate) fn rebase(&mut self, lane: usize, of_b: bool, line: &Line) {
        let n = vec2(self.nx[lane], self.ny[lane]);
        let (arm, sign) = if of_b {
            (self.b1[lane], 1.0)
        } else {
            (self.a1[lane], -1.0)
        };
        let moved = n.dot(line.d());
        self.s1[lane] += sign * (moved + arm * line.turn());
        self.s2[lane] += sign * (moved + (arm + self.l[lane]) * line.turn());
    }

    /// The row of a lane, with its gaps as the bodies are now.
    pub(crate) fn row(&self, lane: usize, bodies: (u32, u32), lines: &[Line]) -> Row {
        let (a, b) = (&lines[bodies.0 as usize], &lines[bodies.1 as usize]);
        let n = vec2(self.nx[lane], self.ny[lane]);
        let moved = n.dot(b.d() - a.d());
        let arms_a = [self.a1[lane], self.a1[lane] + self.l[lane]];
        let arms_b = [self.b1[lane], self.b1[lane] + self.l[lane]];
        let gap = |s: f64, arm_a: f64, arm_b: f64| s + moved + arm_b * b.turn() - arm_a * a.turn();
        Row {
            bodies,
            n,
            a: arms_a,
            b: arms_b,
            at: self.at[lane],
            bt: self.bt[lane],
            mu: self.mu[lane],
            belt: self.belt[lane],
            gap: [
                gap(self.s1[lane], arms_a[0], arms_b[0]),
                gap(self.s2[lane], arms_a[1], arms_b[1]),
            ],
            j: [self.j1[lane], self.j2[lane]],
            jt: self.jt[lane],
            ground: a.inverse_mass() == 0.0 || b.inverse_mass() == 0.0,
        }
    }

    /// What the row of a lane does to B: its impulse, and the turning ones about the centres of A and of B.
    pub(crate) fn push(&self, lane: usize) -> (Vec2, f64, f64) {
        let (j1, j2, jt) = (self.j1[lane], self.j2[lane], self.jt[lane]);
        let n = vec2(self.nx[lane], self.ny[lane]);
        let turn = |arm: f64| arm * j1 + (arm + self.l[lane]) * j2;
        (
            n * (j1 + j2) + perp(n) * jt,
            turn(self.a1[lane]) + self.at[lane] * jt,
            turn(self.b1[lane]) + self.bt[lane] * jt,
        )
    }

    /// The sum of all numbers of a lane, for whoever wants them to be read.
    pub(crate) fn sum_of(&self, lane: usize) -> f64 {
        self.columns().into_iter().map(|column| column[lane]).sum()
    }

    /// Copies a lane of another block.
    pub(crate) fn copy_lane(&mut self, to: usize, other: &Self, from: usize) {
        (self.a[to], self.b[to]) = (other.a[from], other.b[from]);
        for (mine, theirs) in self.columns_mut().into_iter().zip(other.columns()) {
            mine[to] = theirs[from];
        }
    }

    /// Exchanges a lane of this block with one of another.
    pub(crate) fn swap_lanes(&mut self, lane: usize, other: &mut Self, theirs: usize) {
        core::mem::swap(&mut self.a[lane], &mut other.a[theirs]);
        core::mem::swap(&mut self.b[lane], &mut other.b[theirs]);
        for (x, y) in self.columns_mut().into_iter().zip(other.columns_mut()) {
            core::mem::swap(&mut x[lane], &mut y[theirs]);
        }
    }

    fn columns(&self) -> [&[f64; LANES]; 14] {
        [
            &self.nx, &self.ny, &self.a1, &self.b1, &self.l, &self.s1, &self.s2, &self.j1,
            &self.j2, &self.at, &self.bt, &self.mu, &self.jt, &self.belt,
        ]
    }

    fn columns_mut(&mut self) -> [&mut [f64; LANES]; 14] {
        [
            &mut self.nx,
            &mut self.ny,
            &mut self.a1,
            &mut self.b1,
            &mut self.l,
            &mut self.s1,
            &mut self.s2,
            &mut self.j1,
            &mut self.j2,
            &mut self.at,
            &mut self.bt,
            &mut self.mu,
            &mut self.jt,
            &mut self.belt,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Told from where a body is, gaps are what they were, and go on as they went.
    #[test]
    fn gaps_stay_where_a_line_counts_from_elsewhere() {
        let n = vec2(0.6, -0.8);
        let arms = [
            (vec2(0.3, -0.5), vec2(-0.2, 0.4)),
            (vec2(0.7, -0.2), vec2(0.2, 0.7)),
        ];
        let mut row = Row::new((0, 1), n, &arms, 0.5);
        row.gap = [0.01, -0.02];
        let mut lines = [1.0, 0.5].map(|m| Line::new(Vec2::ZERO, 0.0, m, 3.0 * m));
        let mut wide = Wide::EMPTY;
        wide.put(3, &row, &lines[0], &lines[1]);
        for (line, by) in lines.iter_mut().zip([0.3, -0.2]) {
            line.0[4..7].copy_from_slice(&[by, 0.5 - by, 0.7 * by]);
        }
        for of_b in [false, true] {
            let before = wide.row(3, (0, 1), &lines).gap;
            assert!((before[0] - 0.01).abs() > 0.1, "{before:?}");
            let line = &mut lines[usize::from(of_b)];
            wide.rebase(3, of_b, line);
            line.0[4..7].fill(0.0);
            let after = wide.row(3, (0, 1), &lines).gap;
            for (before, after) in before.into_iter().zip(after) {
                assert!((after - before).abs() < 1e-15, "{before} and {after}");
            }
            if !of_b {
                lines[0].0[4..7].copy_from_slice(&[0.1, 0.4, -0.3]);
            }
        }
    }
}
