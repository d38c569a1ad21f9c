//! The accelerations that forces and contacts agree on: Signorini's and Coulomb's conditions.
//!
//! ```text
//! a_n ≥ 0 ⊥ N ≥ 0                             at each point
//! T = −µ ΣN sign(v_t)                         where it slips
//! a_t + σ ≥ 0 ⊥ β₊ ≥ 0,  −a_t + σ ≥ 0 ⊥ β₋ ≥ 0,  µ ΣN − β₊ − β₋ ≥ 0 ⊥ σ ≥ 0      where it does not: T = β₊ − β₋
//! ```
//!
//! In the plane the cone is a polyhedron, so this linear complementarity problem is exact (Stewart,
//! Trinkle 1996). Both friction forces of a face act along one line, so it has one.

use super::NotMine;
use super::faces::{Face, Faces, Row};
use crate::impact::dense::dot;
use crate::impact::lemke::{Solution, complementary};

/// Accelerations below this part of what they are the difference of are none.
const ROUNDING: f64 = 1e-11;

/// What friction does at a touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tangent {
    /// There is none.
    Smooth,
    /// It opposes a slip of this sign.
    Slides(f64),
    /// It holds as long as it can.
    Holds,
}

/// Accelerations and forces of a group.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Balance {
    /// Scaled accelerations.
    pub(super) state: Vec<f64>,
    /// Of each touch.
    pub(super) reactions: Vec<Reaction>,
}

/// Forces of a touch, and what they hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Reaction {
    /// In N, for each point.
    pub(crate) normal: [f64; 2],
    /// In N.
    pub(crate) tangential: f64,
    /// Points that do not open.
    pub(crate) closed: [bool; 2],
    /// Whether friction holds it.
    pub(crate) sticks: bool,
}

/// An unknown of the problem.
#[derive(Clone, Copy)]
enum Unknown {
    Normal { face: usize, point: usize },
    Friction { face: usize, sign: f64 },
    Rate { face: usize },
}

/// Solves for accelerations and forces.
pub(super) fn balance(faces: &Faces, tangents: &[Tangent]) -> Result<Balance, NotMine> {
    Problem::of(faces, tangents)?.solve()
}

/// The complementarity problem of one configuration, w = M z + q: a unit of unknown j adds column j to the accelerations.
struct Problem<'a> {
    faces: &'a Faces,
    tangents: &'a [Tangent],
    unknowns: Vec<Unknown>,
    /// One after the other.
    columns: Vec<f64>,
    q: Vec<f64>,
}

impl<'a> Problem<'a> {
    fn of(faces: &'a Faces, tangents: &'a [Tangent]) -> Result<Self, NotMine> {
        let unknowns = unknowns(faces, tangents);
        let size = faces.free.len();
        let mut columns = vec![0.0; size * unknowns.len()];
        for (unknown, column) in unknowns.iter().zip(columns.chunks_exact_mut(size)) {
            add_column(faces, tangents, *unknown, column);
            if let Unknown::Normal { face, point } = *unknown
                && faces.list[face].normals[point].rate(column) <= 0.0
            {
                return Err(NotMine::Painleve);
            }
        }
        let growth = |unknown: &Unknown| {
            row(faces, *unknown).map_or(0.0, |(row, sign)| sign * row.growth(&faces.free))
        };
        let q = unknowns.iter().map(growth);
        Ok(Self {
            q: q.collect(),
            faces,
            tangents,
            unknowns,
            columns,
        })
    }

    fn column(&self, j: usize) -> &[f64] {
        let size = self.faces.free.len();
        &self.columns[j * size..(j + 1) * size]
    }

    /// M, row i and column j.
    fn entry(&self, i: usize, j: usize) -> f64 {
        entry(
            self.faces,
            self.unknowns[i],
            self.unknowns[j],
            self.column(j),
        )
    }

    fn solve(&self) -> Result<Balance, NotMine> {
        let count = self.unknowns.len();
        let mut m = Vec::with_capacity(count * count);
        for i in 0..count {
            m.extend((0..count).map(|j| self.entry(i, j)));
        }
        let slides = |tangent: &Tangent| matches!(tangent, Tangent::Slides(_));
        let failed = if self.tangents.iter().any(slides) {
            NotMine::Painleve
        } else {
            NotMine::Unsolved
        };
        let Solution { z, .. } = complementary(&m, &self.q).ok_or(failed)?;
        let sizes = self.sum(&z, f64::abs);
        let state = (self.sum(&z, |x| x), &*sizes);
        read(self.faces, self.tangents, &self.unknowns, &z, state).ok_or(failed)
    }

    /// Accelerations for these unknowns, or the sum of the sizes of their parts.
    fn sum(&self, z: &[f64], part: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut sum: Vec<f64> = self.faces.free.iter().map(|x| part(*x)).collect();
        for (j, z) in z.iter().enumerate() {
            for (x, y) in sum.iter_mut().zip(self.column(j)) {
                *x += part(z * y);
            }
        }
        sum
    }
}

fn unknowns(faces: &Faces, tangents: &[Tangent]) -> Vec<Unknown> {
    let mut unknowns = Vec::new();
    for (i, face) in faces.list.iter().enumerate() {
        for point in 0..face.normals.len() {
            unknowns.push(Unknown::Normal { face: i, point });
        }
        if tangents[i] == Tangent::Holds {
            for sign in [1.0, -1.0] {
                unknowns.push(Unknown::Friction { face: i, sign });
            }
            unknowns.push(Unknown::Rate { face: i });
        }
    }
    unknowns
}

/// Adds what one unit of an unknown does to the scaled accelerations.
fn add_column(faces: &Faces, tangents: &[Tangent], unknown: Unknown, column: &mut [f64]) {
    match unknown {
        Unknown::Normal { face, point } => {
            let Face {
                normals,
                tangent,
                friction,
            } = &faces.list[face];
            let along = match tangents[face] {
                Tangent::Slides(sign) => -sign * friction * tangent.length / normals[point].length,
                _ => 0.0,
            };
            normals[point].add_to(column, 1.0);
            tangent.add_to(column, along);
        }
        Unknown::Friction { face, sign } => faces.list[face].tangent.add_to(column, sign),
        Unknown::Rate { .. } => {}
    }
}

/// The row with the rate that is complementary to an unknown, and the sign that it counts with; none for a rate itself.
fn row(faces: &Faces, unknown: Unknown) -> Option<(&Row, f64)> {
    match unknown {
        Unknown::Normal { face, point } => Some((&faces.list[face].normals[point], 1.0)),
        Unknown::Friction { face, sign } => Some((&faces.list[face].tangent, sign)),
        Unknown::Rate { .. } => None,
    }
}

fn entry(faces: &Faces, to: Unknown, of: Unknown, column: &[f64]) -> f64 {
    match (to, of) {
        (Unknown::Friction { face, .. }, Unknown::Rate { face: other }) if face == other => 1.0,
        (Unknown::Rate { face }, Unknown::Normal { face: other, point }) if face == other => {
            let face = &faces.list[face];
            face.friction * face.tangent.length / face.normals[point].length
        }
        (Unknown::Rate { face }, Unknown::Friction { face: other, .. }) if face == other => -1.0,
        _ => row(faces, to).map_or(0.0, |(row, sign)| sign * row.rate(column)),
    }
}

/// Forces, and what holds; `None` if the conditions are not met after all. `sizes` are those of what the accelerations
/// are summed of: forces of other rows may turn a body to and fro, and leave a rounding where nothing else is.
fn read(
    faces: &Faces,
    tangents: &[Tangent],
    unknowns: &[Unknown],
    z: &[f64],
    (state, sizes): (Vec<f64>, &[f64]),
) -> Option<Balance> {
    let mut found = Balance {
        state,
        reactions: vec![Reaction::default(); faces.list.len()],
    };
    for (unknown, z) in unknowns.iter().zip(z) {
        match *unknown {
            Unknown::Normal { face, point } => {
                found.reactions[face].normal[point] = z / faces.list[face].normals[point].length;
            }
            Unknown::Friction { face, sign } => {
                found.reactions[face].tangential += sign * z / faces.list[face].tangent.length;
            }
            Unknown::Rate { .. } => {}
        }
    }
    let both = faces.list.iter().zip(tangents);
    for ((face, tangent), reaction) in both.zip(&mut found.reactions) {
        let limit = face.friction * (reaction.normal[0] + reaction.normal[1]);
        if let Tangent::Slides(sign) = tangent {
            reaction.tangential = -sign * limit;
        }
        for (point, row) in face.normals.iter().enumerate() {
            let (rate, rounding) = (row.growth(&found.state), rounding(row, sizes));
            if rate < -rounding || (reaction.normal[point] > 0.0 && rate > rounding) {
                return None;
            }
            reaction.closed[point] = rate <= rounding;
        }
        if *tangent == Tangent::Holds {
            let seen = faces.free.iter().zip(&found.state);
            let seen: Vec<f64> = seen.map(|(a, b)| a.abs().max(b.abs())).collect();
            let rounding = rounding_of_arms(&face.tangent, &seen);
            reaction.sticks = face.tangent.growth(&found.state).abs() <= rounding;
        }
    }
    Some(found)
}

/// What rounding may leave of a row's rate, by the sizes of what it is summed of.
fn rounding(row: &Row, sizes: &[f64]) -> f64 {
    let unit = row.unit.map(f64::abs);
    ROUNDING * (Row { unit, ..*row }.rate(sizes) + row.bend.abs())
}

/// The same where arms are rounded, too: a normal force a little off a disc's centre turns it, against a tangent along
/// which nothing else pulls. A body's sizes count in any direction.
fn rounding_of_arms(row: &Row, sizes: &[f64]) -> f64 {
    let length = |body: &[f64]| dot(body, body).sqrt();
    let bodies = row.unit.chunks_exact(3).zip(row.places);
    let total: f64 = bodies
        .map(|(unit, place)| length(unit) * length(&sizes[3 * place..3 * place + 3]))
        .sum();
    ROUNDING * (total + row.bend.abs())
}
