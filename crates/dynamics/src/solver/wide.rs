//! What the sweeps read and write: body lines, and contact rows in blocks of eight.

use carom_math::{Vec2, vec2};

use super::Row;

/// Rows in a block, and lanes of a wide register.
pub(crate) const LANES: usize = 8;

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

/// Eight rows of one colour: no two of them move the same body. 120 bytes a row, of which a solving sweep reads 88.
///
/// The letters are those of [`Row`]; `s` is a gap told so that it holds however the bodies move on:
///
/// ```text
/// gap_i = s_i + n·(d_B − d_A) + b_i θ_B − a_i θ_A
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
    pub(crate) a2: [f64; LANES],
    pub(crate) b2: [f64; LANES],
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
        a2: [1.0; LANES],
        b2: [1.0; LANES],
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
        [self.a1[lane], self.a2[lane]] = row.a;
        [self.b1[lane], self.b2[lane]] = row.b;
        (self.at[lane], self.bt[lane]) = (row.at, row.bt);
        self.mu[lane] = row.mu;
        let moved = row.n.dot(b.d() - a.d());
        self.s1[lane] = row.gap[0] - moved - row.b[0] * b.turn() + row.a[0] * a.turn();
        self.s2[lane] = row.gap[1] - moved - row.b[1] * b.turn() + row.a[1] * a.turn();
        [self.j1[lane], self.j2[lane]] = row.j;
        self.jt[lane] = row.jt;
        self.belt[lane] = row.belt;
    }

    /// The row of a lane, with its gaps as the bodies are now.
    pub(crate) fn row(&self, lane: usize, bodies: (u32, u32), lines: &[Line]) -> Row {
        let (a, b) = (&lines[bodies.0 as usize], &lines[bodies.1 as usize]);
        let n = vec2(self.nx[lane], self.ny[lane]);
        let moved = n.dot(b.d() - a.d());
        let gap = |s: f64, arm_a: f64, arm_b: f64| s + moved + arm_b * b.turn() - arm_a * a.turn();
        Row {
            bodies,
            n,
            a: [self.a1[lane], self.a2[lane]],
            b: [self.b1[lane], self.b2[lane]],
            at: self.at[lane],
            bt: self.bt[lane],
            mu: self.mu[lane],
            belt: self.belt[lane],
            gap: [
                gap(self.s1[lane], self.a1[lane], self.b1[lane]),
                gap(self.s2[lane], self.a2[lane], self.b2[lane]),
            ],
            j: [self.j1[lane], self.j2[lane]],
            jt: self.jt[lane],
            ground: a.inverse_mass() == 0.0 || b.inverse_mass() == 0.0,
        }
    }

    /// Copies a lane of another block.
    pub(crate) fn copy_lane(&mut self, to: usize, other: &Self, from: usize) {
        (self.a[to], self.b[to]) = (other.a[from], other.b[from]);
        for (mine, theirs) in self.columns_mut().into_iter().zip(other.columns()) {
            mine[to] = theirs[from];
        }
    }

    fn columns(&self) -> [&[f64; LANES]; 15] {
        [
            &self.nx, &self.ny, &self.a1, &self.b1, &self.a2, &self.b2, &self.s1, &self.s2,
            &self.j1, &self.j2, &self.at, &self.bt, &self.mu, &self.jt, &self.belt,
        ]
    }

    fn columns_mut(&mut self) -> [&mut [f64; LANES]; 15] {
        [
            &mut self.nx,
            &mut self.ny,
            &mut self.a1,
            &mut self.b1,
            &mut self.a2,
            &mut self.b2,
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
