//! Eight contacts of one colour.

use carom_math::{Vec2, perp};

use super::line::{Line, Quad};
use super::plain::friction_heat;
use crate::bodies::Bodies;
use crate::narrow::Manifold;
use crate::{ContactIx, LineIx, PieceIx};

/// Contacts in a block.
pub(crate) const LANES: usize = 8;

/// A contact that sinks in under a load is held by the sweeps until it is so many times as deep as one that was put so. 5: a
/// smash takes a fifth longer.
const CRUSHED: f64 = 10.0;

/// What was put into each other is parted by displacement until it is no deeper than this part of what sweeps may see: their pushes
/// would leave as velocity. A hundred boxes at one place part with 1.5 J of kinetic energy at most (eight seeds); 0.5: 7 J; 1:
/// 27 J.
const PUT: f64 = 0.2;

/// By what two bodies may have come to overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pressed {
    /// One of them was put there.
    ByCaller,
    /// One of them is displaced out of a third one, by no velocity that rows could stop. Taken for [`Self::ByRows`], a hundred boxes
    /// at one place part with 46 to 68 J of kinetic energy, not with 0.9 to 1.5 (eight seeds).
    ByDisplacement,
    /// Their contact is new.
    New,
    ByRows,
}

/// Gap of a point that is not there, in m: no body closes it within a sub-step.
pub(crate) const OPEN: f64 = 1e30;

/// Those lanes that have a bit.
pub(crate) fn lanes(mut bits: u8) -> impl Iterator<Item = usize> + Clone {
    core::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

/// Eight contacts of one colour, 112 bytes each: no two of them move the same body.
///
/// ```text
/// a_i = r_A × n, b_i = r_B × n of point i;   a_t = r_A · n, b_t = r_B · n of the face
/// v_i = n·(v_B − v_A) + b_i ω_B − a_i ω_A     normal velocity of point i, positive opens
/// v_t = t·(v_B − v_A) + b_t ω_B − a_t ω_A     slip along t, the normal turned by +90°, less the speed of a belt
/// gap_i = s_i + n·(d_B − d_A) + b_i θ_B − a_i θ_A
/// ```
/// Both points lie on one face, l apart, and point 1 is the farther one along t: a₂ = a₁ + l, b₂ = b₁ + l.
/// In the plane the friction forces of both points act along one line: one row with limit µ (j₁ + j₂) is the same mechanics.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Block {
    /// Lines of the bodies.
    pub(crate) a: [LineIx; LANES],
    pub(crate) b: [LineIx; LANES],
    pub(crate) nx: [f64; LANES],
    pub(crate) ny: [f64; LANES],
    pub(crate) a1: [f64; LANES],
    pub(crate) b1: [f64; LANES],
    pub(crate) l: [f64; LANES],
    pub(crate) s1: [f64; LANES],
    pub(crate) s2: [f64; LANES],
    pub(crate) j1: [f64; LANES],
    pub(crate) j2: [f64; LANES],
    pub(crate) at: [f64; LANES],
    pub(crate) bt: [f64; LANES],
    pub(crate) mu: [f64; LANES],
    pub(crate) jt: [f64; LANES],
}

/// What only the tick reads of eight contacts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cold {
    /// Numbers of the contacts.
    pub(crate) contact: [ContactIx; LANES],
    pub(crate) pieces: [[PieceIx; 2]; LANES],
    /// Coefficients of restitution.
    pub(crate) restitution: [f64; LANES],
    /// How fast the surfaces run, together, in m/s.
    pub(crate) belt: [f64; LANES],
    /// By how much both points of what is too deep for the sweeps are deeper than these see, in m.
    pub(super) hidden: [[f64; 2]; LANES],
    /// The least gap that the sweeps see of it, in m.
    pub(crate) shown: [f64; LANES],
    /// A bit for each lane that pushed when it was last asked.
    pub(crate) touching: u8,
    /// A bit for each lane that was too deep for the sweeps when it was last computed.
    pub(crate) deep: u8,
    /// A bit for each of these that came so, and was not crushed.
    pub(crate) put: u8,
    /// A bit for each of these that rows did not press together, and that bear no load.
    pub(super) unloaded: u8,
    /// A bit for each lane with a row of whole shapes.
    pub(crate) whole: u8,
    /// A bit for each lane that holds a contact.
    pub(crate) used: u8,
}

impl Block {
    /// No rows: gaps that never close, between line 0 and itself.
    pub(crate) const EMPTY: Self = Self {
        a: [LineIx::EMPTY; LANES],
        b: [LineIx::EMPTY; LANES],
        nx: [1.0; LANES],
        ny: [0.0; LANES],
        a1: [0.0; LANES],
        b1: [0.0; LANES],
        l: [0.0; LANES],
        s1: [OPEN; LANES],
        s2: [OPEN; LANES],
        j1: [0.0; LANES],
        j2: [0.0; LANES],
        at: [0.0; LANES],
        bt: [0.0; LANES],
        mu: [0.0; LANES],
        jt: [0.0; LANES],
    };

    /// Writes where a contact is; impulses and friction stay.
    pub(crate) fn put(&mut self, lane: usize, manifold: &Manifold) {
        (self.nx[lane], self.ny[lane]) = (manifold.normal.x, manifold.normal.y);
        (self.a1[lane], self.b1[lane]) = (manifold.arm_a, manifold.arm_b);
        (self.at[lane], self.bt[lane]) = (manifold.tangent_a, manifold.tangent_b);
        self.s1[lane] = manifold.gaps[0];
        // The second point of a single one is at the same place, and never acts.
        let two = manifold.points == 2;
        self.l[lane] = if two { manifold.length } else { 0.0 };
        self.s2[lane] = if two { manifold.gaps[1] } else { OPEN };
    }

    /// A bit for each lane that pushes.
    pub(crate) fn pushing(&self) -> u8 {
        let each = self.j1.iter().zip(&self.j2).zip(0..);
        each.fold(0, |bits, ((j1, j2), lane)| {
            bits | u8::from(j1 + j2 > 0.0) << lane
        })
    }

    /// Unit normal from A to B.
    pub(crate) const fn normal(&self, lane: usize) -> Vec2 {
        Vec2::new(self.nx[lane], self.ny[lane])
    }

    pub(crate) const fn impulses(&self, lane: usize) -> [f64; 3] {
        [self.j1[lane], self.j2[lane], self.jt[lane]]
    }

    pub(crate) const fn set_impulses(&mut self, lane: usize, j: [f64; 3]) {
        [self.j1[lane], self.j2[lane], self.jt[lane]] = j;
    }

    /// Lines of the bodies of a lane.
    pub(crate) const fn lines(&self, lane: usize) -> [LineIx; 2] {
        [self.a[lane], self.b[lane]]
    }

    /// The heat of a lane's friction in J that its last sweep told, by what the slip is now: what sticks made none.
    pub(crate) fn heat(&self, lane: usize, lines: &[Line], belt: f64) -> f64 {
        let (at, bt, jt) = (self.at[lane], self.bt[lane], self.jt[lane]);
        if jt.abs() < self.mu[lane] * (self.j1[lane] + self.j2[lane]) {
            return 0.0;
        }
        let [a, b] = self.ends(lane, lines);
        let slip = self.slip(lane, lines) - belt;
        let m = a.inverse_mass() + b.inverse_mass();
        let k = m + a.inverse_inertia() * at * at + b.inverse_inertia() * bt * bt;
        friction_heat(jt, slip, k)
    }

    /// The acceleration with which what pulls the bodies of a lane opens its points, in m/s².
    pub(crate) fn pull(&self, lane: usize, bodies: &Bodies) -> f64 {
        let [a, b] = self.lines(lane).map(|line| bodies.pull[line].v());
        self.normal(lane).dot(b - a)
    }

    /// The bodies of a lane.
    fn ends<'l>(&self, lane: usize, lines: &'l [Line]) -> [&'l Line; 2] {
        self.lines(lane).map(|line| &lines[line.at()])
    }

    /// M⁻¹ Jᵀ j of a lane: what its impulses add to the velocities of A and of B.
    pub(crate) fn push(&self, lane: usize, lines: &[Line]) -> [Quad; 2] {
        let [a, b] = self.ends(lane, lines);
        let [j1, j2, jt] = self.impulses(lane);
        let n = self.normal(lane);
        let sum = j1 + j2;
        let impulse = n * sum + perp(n) * jt;
        let bend = self.l[lane] * j2;
        let turn_a = self.a1[lane] * sum + bend + self.at[lane] * jt;
        let turn_b = self.b1[lane] * sum + bend + self.bt[lane] * jt;
        [
            Quad::new(impulse * -a.inverse_mass(), -turn_a * a.inverse_inertia()),
            Quad::new(impulse * b.inverse_mass(), turn_b * b.inverse_inertia()),
        ]
    }

    /// Has impulses act at one point, midway between where either body took the one of the base poses, so that they change no angular
    /// momentum: `b1 − a1 = (c_A − c_B) × n`, and likewise along the normal. Gaps stay. Of bodies that can be moved; by how much arms
    /// changed, across and along the normal.
    pub(crate) fn meet(&mut self, lane: usize, bodies: &Bodies) -> (f64, f64) {
        let [a, b] = self.lines(lane);
        let (n, away) = (self.normal(lane), bodies.centre_at(a) - bodies.centre_at(b));
        let lever = 0.5 * (away.perp_dot(n) - (self.b1[lane] - self.a1[lane]));
        let height = 0.5 * (away.dot(n) - (self.bt[lane] - self.at[lane]));
        (self.a1[lane], self.b1[lane]) = (self.a1[lane] - lever, self.b1[lane] + lever);
        (self.at[lane], self.bt[lane]) = (self.at[lane] - height, self.bt[lane] + height);
        let turned = lever * (bodies.lines[a].turn() + bodies.lines[b].turn());
        (self.s1[lane], self.s2[lane]) = (self.s1[lane] - turned, self.s2[lane] - turned);
        (lever, height)
    }

    pub(crate) const fn points(&self, lane: usize) -> usize {
        if self.s2[lane] < OPEN { 2 } else { 1 }
    }

    /// Normal velocities of both points, in m/s.
    pub(crate) fn opening(&self, lane: usize, lines: &[Line]) -> [f64; 2] {
        let [a, b] = self.ends(lane, lines);
        self.along(lane, (a.v(), a.w()), (b.v(), b.w()))
    }

    /// What a push of both bodies opens a point by.
    #[cfg(test)]
    pub(crate) fn response(&self, lane: usize, point: usize, a: &Quad, b: &Quad) -> f64 {
        self.along(lane, (a.v(), a.w()), (b.v(), b.w()))[point]
    }

    /// Speed of B along t less that of A where they meet, in m/s: the slip, but for the speed of a belt.
    pub(crate) fn slip(&self, lane: usize, lines: &[Line]) -> f64 {
        let [a, b] = self.ends(lane, lines);
        self.across(lane, (a.v(), a.w()), (b.v(), b.w()))
    }

    /// What two motions shift B by, along t, against A.
    pub(crate) fn across(&self, lane: usize, a: (Vec2, f64), b: (Vec2, f64)) -> f64 {
        perp(self.normal(lane)).dot(b.0 - a.0) + self.bt[lane] * b.1 - self.at[lane] * a.1
    }

    /// What two motions open both points by.
    pub(crate) fn along(&self, lane: usize, a: (Vec2, f64), b: (Vec2, f64)) -> [f64; 2] {
        let first = self.normal(lane).dot(b.0 - a.0) + self.b1[lane] * b.1 - self.a1[lane] * a.1;
        [first, first + self.l[lane] * (b.1 - a.1)]
    }

    /// Both gaps with the bodies where their lines say, in m.
    pub(crate) fn gaps(&self, lane: usize, lines: &[Line]) -> [f64; 2] {
        let [first, second] = self.opened(lane, lines);
        [self.s1[lane] + first, self.s2[lane] + second]
    }

    /// What both points of a lane opened by since the base poses, in m.
    pub(crate) fn opened(&self, lane: usize, lines: &[Line]) -> [f64; 2] {
        let [a, b] = self.ends(lane, lines);
        self.along(lane, (a.d(), a.turn()), (b.d(), b.turn()))
    }

    /// Copies a lane of another block.
    pub(crate) fn copy_lane(&mut self, to: usize, other: &Self, from: usize) {
        (self.a[to], self.b[to]) = (other.a[from], other.b[from]);
        (self.nx[to], self.ny[to]) = (other.nx[from], other.ny[from]);
        (self.a1[to], self.b1[to]) = (other.a1[from], other.b1[from]);
        (self.at[to], self.bt[to]) = (other.at[from], other.bt[from]);
        (self.s1[to], self.s2[to]) = (other.s1[from], other.s2[from]);
        (self.l[to], self.mu[to]) = (other.l[from], other.mu[from]);
        self.set_impulses(to, other.impulses(from));
    }
}

impl Cold {
    pub(crate) const EMPTY: Self = Self {
        contact: [ContactIx::NONE; LANES],
        pieces: [[PieceIx::NONE; 2]; LANES],
        restitution: [0.0; LANES],
        belt: [0.0; LANES],
        hidden: [[0.0; 2]; LANES],
        shown: [0.0; LANES],
        touching: 0,
        deep: 0,
        put: 0,
        unloaded: 0,
        whole: 0,
        used: 0,
    };

    /// Whether a contact was too deep for the sweeps when it was last computed.
    pub(crate) const fn is_deep(&self, lane: usize) -> bool {
        self.deep >> lane & 1 == 1
    }

    /// Whether it is, and came so.
    pub(crate) const fn was_put(&self, lane: usize) -> bool {
        self.put >> lane & 1 == 1
    }

    /// Whether it is, rows did not press it together, and it bears no load.
    pub(crate) const fn is_unloaded(&self, lane: usize) -> bool {
        self.unloaded >> lane & 1 == 1
    }

    /// Notes how deep a contact is, if it is too deep for the sweeps, and whether that is so: if it was so or became so otherwise than
    /// `by` rows from `deepest` on, else if it is [`CRUSHED`] times as deep. What was put so stays so down to a [`PUT`] of that; and
    /// what displacement presses is, however deep, if nothing but contacts moves the two: no row bears a load there.
    pub(crate) fn note_depth(
        &mut self,
        (block, lane): (&mut Block, usize),
        lines: &[Line],
        deepest: f64,
        (by, are_free): (Pressed, bool),
    ) -> bool {
        let [first, second] = block.gaps(lane, lines);
        let was_put = self.was_put(lane);
        let least = if was_put {
            PUT * deepest
        } else if self.is_deep(lane) || by != Pressed::ByRows {
            deepest
        } else {
            CRUSHED * deepest
        };
        let is_displaced = are_free && by == Pressed::ByDisplacement;
        let deep = first.min(second) < least || is_displaced;
        let put = deep && (was_put || by == Pressed::ByCaller);
        let parts = put || is_displaced;
        let set = |bits: u8, is: bool| bits & !(1 << lane) | u8::from(is) << lane;
        (self.deep, self.put) = (set(self.deep, deep), set(self.put, put));
        self.unloaded = set(self.unloaded, are_free && parts);
        self.hidden[lane] = [0.0; 2];
        self.shown[lane] = if parts { PUT * deepest } else { deepest };
        if deep {
            self.show((block, lane), lines);
        }
        deep
    }

    /// Gaps of both points with the bodies where their lines say, in m.
    pub(crate) fn gaps(&self, block: &Block, lane: usize, lines: &[Line]) -> [f64; 2] {
        let [first, second] = block.gaps(lane, lines);
        let hidden = self.hidden[lane];
        [first - hidden[0], second - hidden[1]]
    }

    /// Shows the sweeps a contact as deep as it is with the bodies where their lines say, but no deeper than they may see it.
    pub(super) fn show(&mut self, (block, lane): (&mut Block, usize), lines: &[Line]) {
        let gaps = self.gaps(block, lane, lines);
        let hidden = gaps.map(|gap| (self.shown[lane] - gap).max(0.0));
        block.s1[lane] += hidden[0] - self.hidden[lane][0];
        block.s2[lane] += hidden[1] - self.hidden[lane][1];
        self.hidden[lane] = hidden;
    }

    pub(crate) fn copy_lane(&mut self, to: usize, other: &Self, from: usize) {
        self.contact[to] = other.contact[from];
        self.pieces[to] = other.pieces[from];
        self.restitution[to] = other.restitution[from];
        self.belt[to] = other.belt[from];
        self.hidden[to] = other.hidden[from];
        self.shown[to] = other.shown[from];
        let bit = |mine: u8, theirs: u8| mine & !(1 << to) | (theirs >> from & 1) << to;
        self.touching = bit(self.touching, other.touching);
        self.deep = bit(self.deep, other.deep);
        self.put = bit(self.put, other.put);
        self.unloaded = bit(self.unloaded, other.unloaded);
        self.whole = bit(self.whole, other.whole);
    }
}
