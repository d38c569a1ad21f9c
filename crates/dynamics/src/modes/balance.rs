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
use super::faces::{Face, Faces, Row, dot};
use crate::impact::lemke::complementary;

/// Accelerations below this part of what they are the difference of are none.
const ROUNDING: f64 = 1e-11;

/// What friction does at a touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Tangent {
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
    /// In N, for each point.
    pub(super) normal: Vec<[f64; 2]>,
    /// In N.
    pub(super) tangential: Vec<f64>,
    /// Points that do not open.
    pub(super) closed: Vec<[bool; 2]>,
    /// Touches that friction holds.
    pub(super) sticks: Vec<bool>,
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
    let unknowns = unknowns(faces, tangents);
    let columns: Vec<Vec<f64>> = unknowns
        .iter()
        .map(|unknown| column(faces, tangents, *unknown))
        .collect();
    let slides = tangents.iter().any(|t| matches!(t, Tangent::Slides(_)));
    for (unknown, column) in unknowns.iter().zip(&columns) {
        if let Unknown::Normal { face, point } = *unknown
            && faces.list[face].normals[point].rate(column) <= 0.0
        {
            return Err(NotMine::Painleve);
        }
    }
    let mut m = Vec::with_capacity(unknowns.len() * unknowns.len());
    let mut q = Vec::with_capacity(unknowns.len());
    for row in &unknowns {
        let others = unknowns.iter().zip(&columns);
        m.extend(others.map(|(other, column)| entry(faces, *row, *other, column)));
        q.push(growth(faces, *row, &faces.free));
    }
    let failed = if slides {
        NotMine::Painleve
    } else {
        NotMine::Unsolved
    };
    let z = complementary(&m, &q).ok_or(failed)?.z;
    let mut state = faces.free.clone();
    let mut sizes: Vec<f64> = faces.free.iter().map(|x| x.abs()).collect();
    for (column, z) in columns.iter().zip(&z) {
        for ((x, size), y) in state.iter_mut().zip(&mut sizes).zip(column) {
            *x += z * y;
            *size += (z * y).abs();
        }
    }
    read(faces, tangents, &unknowns, &z, (state, &sizes)).ok_or(failed)
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

/// What one unit of an unknown adds to the scaled accelerations.
fn column(faces: &Faces, tangents: &[Tangent], unknown: Unknown) -> Vec<f64> {
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
            let both = normals[point].unit.iter().zip(&tangent.unit);
            both.map(|(n, t)| n + along * t).collect()
        }
        Unknown::Friction { face, sign } => faces.list[face]
            .tangent
            .unit
            .iter()
            .map(|t| sign * t)
            .collect(),
        Unknown::Rate { .. } => vec![0.0; faces.free.len()],
    }
}

/// The rate that is complementary to an unknown, in a state.
fn rate(faces: &Faces, row: Unknown, state: &[f64]) -> f64 {
    match row {
        Unknown::Normal { face, point } => faces.list[face].normals[point].rate(state),
        Unknown::Friction { face, sign } => sign * faces.list[face].tangent.rate(state),
        Unknown::Rate { .. } => 0.0,
    }
}

/// [`rate`] of accelerations, with what velocities add.
fn growth(faces: &Faces, row: Unknown, state: &[f64]) -> f64 {
    match row {
        Unknown::Normal { face, point } => faces.list[face].normals[point].growth(state),
        Unknown::Friction { face, sign } => sign * faces.list[face].tangent.growth(state),
        Unknown::Rate { .. } => 0.0,
    }
}

fn entry(faces: &Faces, row: Unknown, of: Unknown, column: &[f64]) -> f64 {
    match (row, of) {
        (Unknown::Friction { face, .. }, Unknown::Rate { face: other }) if face == other => 1.0,
        (Unknown::Rate { face }, Unknown::Normal { face: other, point }) if face == other => {
            let face = &faces.list[face];
            face.friction * face.tangent.length / face.normals[point].length
        }
        (Unknown::Rate { face }, Unknown::Friction { face: other, .. }) if face == other => -1.0,
        _ => rate(faces, row, column),
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
    let count = faces.list.len();
    let mut found = Balance {
        state,
        normal: vec![[0.0; 2]; count],
        tangential: vec![0.0; count],
        closed: vec![[false; 2]; count],
        sticks: vec![false; count],
    };
    for (unknown, z) in unknowns.iter().zip(z) {
        match *unknown {
            Unknown::Normal { face, point } => {
                found.normal[face][point] = z / faces.list[face].normals[point].length;
            }
            Unknown::Friction { face, sign } => {
                found.tangential[face] += sign * z / faces.list[face].tangent.length;
            }
            Unknown::Rate { .. } => {}
        }
    }
    for (i, face) in faces.list.iter().enumerate() {
        let limit = face.friction * (found.normal[i][0] + found.normal[i][1]);
        if let Tangent::Slides(sign) = tangents[i] {
            found.tangential[i] = -sign * limit;
        }
        for (point, row) in face.normals.iter().enumerate() {
            let (rate, rounding) = (row.growth(&found.state), rounding(row, sizes));
            if rate < -rounding || (found.normal[i][point] > 0.0 && rate > rounding) {
                return None;
            }
            found.closed[i][point] = rate <= rounding;
        }
        if tangents[i] == Tangent::Holds {
            let seen = faces.free.iter().zip(&found.state);
            let seen: Vec<f64> = seen.map(|(a, b)| a.abs().max(b.abs())).collect();
            let rounding = rounding_of_arms(&face.tangent, &seen);
            found.sticks[i] = face.tangent.growth(&found.state).abs() <= rounding;
        }
    }
    Some(found)
}

/// What rounding may leave of a row's rate, by the sizes of what it is summed of.
fn rounding(row: &Row, sizes: &[f64]) -> f64 {
    let lengths: Vec<f64> = row.unit.iter().map(|x| x.abs()).collect();
    ROUNDING * (dot(&lengths, sizes) + row.bend.abs())
}

/// The same where arms are rounded, too: a normal force a little off a disc's centre turns it, against a tangent along
/// which nothing else pulls. A body's sizes count in any direction.
fn rounding_of_arms(row: &Row, sizes: &[f64]) -> f64 {
    let length = |body: &[f64]| dot(body, body).sqrt();
    let bodies = row.unit.chunks_exact(3).zip(sizes.chunks_exact(3));
    let total: f64 = bodies
        .map(|(unit, sizes)| length(unit) * length(sizes))
        .sum();
    ROUNDING * (total + row.bend.abs())
}
