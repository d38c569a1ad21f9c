//! Directions in which contacts push, and what the pushes do to velocities.
//!
//! ```text
//! u = u₀ + K j        u_r: velocity of B's point minus A's along row r's direction, in m/s
//!                     K_rs: change of u_r by an impulse of 1 N·s along row s (Delassus)
//! ```

use core::ops::Range;

use carom_math::{Vec2, cross, perp};

use super::body::{ImpactBody, is_driven};
use super::several::SharedContact;

/// Speed with which contacts open that rounding could leave closing, as a part of their points' speeds.
const OPENS: f64 = 4.0 * f64::EPSILON;

/// What an impulse along a row may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bound {
    /// `0 ≤ j ⟂ u ≥ 0`: bodies push, and do not close.
    Push,
    /// Coulomb: `|j| ≤ µ Σ j_n`, against u where it is at its limit. The rows of `j_n`, and µ.
    Friction(Normals, f64),
    /// The same with a limit that is given, in N·s.
    Limit(f64),
}

/// Rows of the pushes that one friction row has its limit from: of a point, or of both points of a face, along which their friction
/// acts as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Normals {
    first: usize,
    count: usize,
}

impl Normals {
    pub(super) const fn new(first: usize, count: usize) -> Self {
        Self { first, count }
    }

    pub(super) fn rows(self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

/// A direction in which a contact pushes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Places of A and B among the bodies.
    pub(super) a: usize,
    pub(super) b: usize,
    /// Direction of a push on B.
    pub(super) direction: Vec2,
    /// Where it pushes A, and where B: one point, or a gap apart.
    pub(super) points: (Vec2, Vec2),
    pub(super) bound: Bound,
    /// Arms of the direction about the centres of A and B, in m.
    arms: (f64, f64),
}

impl Row {
    pub(super) fn new(
        bodies: &[ImpactBody],
        shared: &SharedContact,
        direction: Vec2,
        bound: Bound,
    ) -> Self {
        let point = shared.contact.point;
        Self::between(
            bodies,
            (shared.a, shared.b),
            (point, point),
            direction,
            bound,
        )
    }

    pub(super) fn between(
        bodies: &[ImpactBody],
        (a, b): (usize, usize),
        points: (Vec2, Vec2),
        direction: Vec2,
        bound: Bound,
    ) -> Self {
        let arm = |body: &ImpactBody, point: Vec2| cross(point - body.centre, direction);
        Self {
            a,
            b,
            direction,
            points,
            bound,
            arms: (arm(&bodies[a], points.0), arm(&bodies[b], points.1)),
        }
    }

    /// Velocity of B's point minus A's along the direction, in m/s.
    pub(super) fn speed(&self, bodies: &[ImpactBody]) -> f64 {
        let (a, b) = (&bodies[self.a], &bodies[self.b]);
        (b.velocity_of(self.points.1) - a.velocity_of(self.points.0)).dot(self.direction)
    }

    /// What the rounding of both velocities may hide of it, in m/s.
    fn hidden(&self, bodies: &[ImpactBody]) -> f64 {
        let fastest = |body: &ImpactBody, point: Vec2| {
            body.velocity.length() + body.spin.abs() * (point - body.centre).length()
        };
        let (a, b) = (&bodies[self.a], &bodies[self.b]);
        2.0 * f64::EPSILON * (fastest(a, self.points.0) + fastest(b, self.points.1))
    }

    /// Applies ±`impulse`, in N·s.
    pub(super) fn push(&self, bodies: &mut [ImpactBody], impulse: f64) {
        let along = self.direction * impulse;
        bodies[self.a] = bodies[self.a].pushed(-along, self.points.0);
        bodies[self.b] = bodies[self.b].pushed(along, self.points.1);
    }

    /// Entry of K for this row and another.
    fn response(&self, other: &Self, bodies: &[ImpactBody]) -> f64 {
        let through = |index: usize, own: f64, its: f64| {
            let body = &bodies[index];
            self.direction.dot(other.direction) * body.inverse_mass
                + own * its * body.inverse_inertia
        };
        let mut sum = 0.0;
        if self.a == other.a {
            sum += through(self.a, self.arms.0, other.arms.0);
        }
        if self.b == other.b {
            sum += through(self.b, self.arms.1, other.arms.1);
        }
        if self.a == other.b {
            sum -= through(self.a, self.arms.0, other.arms.1);
        }
        if self.b == other.a {
            sum -= through(self.b, self.arms.1, other.arms.0);
        }
        sum
    }
}

/// Rows of all contacts with the matrix K, scaled so that its diagonal is 1.
///
/// What bodies move with in common is left out: impulses are answered for to the rounding of what they change, however fast
/// all of it goes.
pub(super) struct Rows {
    /// The bodies before any impulse, with no velocity.
    pub(super) still: Vec<ImpactBody>,
    /// Speeds before along the rows less those that count as none, in m/s, and what their rounding may hide.
    before: Vec<f64>,
    hidden: Vec<f64>,
    pub(super) rows: Vec<Row>,
    /// Whether bodies that do not yield move towards or past each other: what is between them may be driven without end.
    pub(super) driven: bool,
    /// K row by row, each entry divided by both rows' scales.
    pub(super) k: Vec<f64>,
    /// √`K_rr`; an impulse times it is the scaled impulse, a speed by it the scaled speed.
    pub(super) scales: Vec<f64>,
}

impl Rows {
    /// Rows that nothing can move have a scale of 0, and get no impulse.
    pub(super) fn new(bodies: &[ImpactBody], rows: Vec<Row>) -> Self {
        let mut all = Self::loose(bodies, rows);
        let size = all.len();
        all.k = vec![0.0; size * size];
        for r in 0..size {
            for s in 0..=r {
                let scale = all.scales[r] * all.scales[s];
                if scale > 0.0 {
                    let entry = all.rows[r].response(&all.rows[s], bodies) / scale;
                    all.k[r * size + s] = entry;
                    all.k[s * size + r] = entry;
                }
            }
        }
        all
    }

    /// Without the matrix: enough for sweeps, whatever their number.
    pub(super) fn loose(bodies: &[ImpactBody], rows: Vec<Row>) -> Self {
        let own = rows.iter().map(|row| row.response(row, bodies).sqrt());
        Self {
            scales: own.collect(),
            before: rows.iter().map(|row| row.speed(bodies)).collect(),
            hidden: rows.iter().map(|row| row.hidden(bodies)).collect(),
            k: Vec::new(),
            driven: is_driven(bodies),
            still: bodies.iter().map(ImpactBody::at_rest).collect(),
            rows,
        }
    }

    /// Speeds are counted from these on, in m/s: what contacts are to open with.
    pub(super) fn ask(&mut self, speeds: &[f64]) {
        for (before, asked) in self.before.iter_mut().zip(speeds) {
            *before -= asked;
        }
    }

    /// Speed with which contacts open so that rounding leaves none closing, in m/s.
    pub(super) fn opens(&self, bodies: &[ImpactBody]) -> f64 {
        let speed = |body: usize, point: Vec2| bodies[body].velocity_of(point).length();
        let of = |row: &Row| speed(row.a, row.points.0) + speed(row.b, row.points.1);
        OPENS * self.rows.iter().map(of).fold(0.0, f64::max)
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Speeds along the rows after scaled impulses, scaled; by way of the bodies, so that no
    /// entry of K takes its rounding there. `given`: velocities that the impulses give to the bodies.
    pub(super) fn speeds(&self, impulses: &[f64], given: &mut Vec<ImpactBody>, to: &mut Vec<f64>) {
        given.clear();
        given.extend_from_slice(&self.still);
        for (row, impulse) in self.rows.iter().zip(self.unscaled(impulses)) {
            if impulse != 0.0 {
                row.push(given, impulse);
            }
        }
        to.clear();
        to.extend((0..self.len()).map(|r| self.speed(r, given)));
    }

    /// Scaled speed along a row where impulses gave bodies these velocities.
    pub(super) fn speed(&self, r: usize, given: &[ImpactBody]) -> f64 {
        if self.scales[r] > 0.0 {
            (self.before[r] + self.rows[r].speed(given)) / self.scales[r]
        } else {
            0.0
        }
    }

    /// What the rounding of scaled impulses and of the velocities before is worth along each row, in m/s: large impulses
    /// through a light body leave the difference of what they do to it.
    pub(super) fn rounding(&self, impulses: &[f64]) -> Vec<f64> {
        let mut taken = vec![0.0; self.still.len()];
        for (row, impulse) in self.rows.iter().zip(self.unscaled(impulses)) {
            taken[row.a] += impulse.abs();
            taken[row.b] += impulse.abs();
        }
        let worth = |body: usize, point: Vec2| taken[body] * self.still[body].yields_at(point);
        let of = |(row, hidden): (&Row, &f64)| {
            let both = worth(row.a, row.points.0) + worth(row.b, row.points.1);
            4.0 * f64::EPSILON * both + hidden
        };
        self.rows.iter().zip(&self.hidden).map(of).collect()
    }

    /// Impulses in N·s.
    pub(super) fn unscaled<'b>(&'b self, impulses: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        impulses.iter().zip(&self.scales).map(
            |(impulse, scale)| {
                if *scale > 0.0 { impulse / scale } else { 0.0 }
            },
        )
    }

    /// Scaled limit of a row's impulse, in terms of the scaled impulses.
    pub(super) fn limit(&self, row: usize, impulses: &[f64]) -> f64 {
        match self.rows[row].bound {
            Bound::Push => f64::INFINITY,
            Bound::Friction(normals, _) => {
                let of = |normal: usize| self.factor(row, normal) * impulses[normal];
                normals.rows().map(of).sum()
            }
            Bound::Limit(limit) => limit * self.scales[row],
        }
    }

    /// Scaled µ: limit of a friction row for a scaled impulse of 1 of a normal row.
    pub(super) fn factor(&self, row: usize, normal: usize) -> f64 {
        match self.rows[row].bound {
            Bound::Friction(_, mu) if self.scales[normal] > 0.0 => {
                mu * (self.scales[row] / self.scales[normal])
            }
            _ => 0.0,
        }
    }
}

/// A normal row for each contact and a friction row for each that has friction.
pub(super) fn contact_rows(bodies: &[ImpactBody], contacts: &[SharedContact]) -> Vec<Row> {
    let mut rows = Vec::with_capacity(2 * contacts.len());
    for shared in contacts {
        let normal = shared.contact.normal;
        let place = rows.len();
        rows.push(Row::new(bodies, shared, normal, Bound::Push));
        if shared.contact.friction > 0.0 {
            let bound = Bound::Friction(Normals::new(place, 1), shared.contact.friction);
            rows.push(Row::new(bodies, shared, perp(normal), bound));
        }
    }
    rows
}
