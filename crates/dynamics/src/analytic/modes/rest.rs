//! Rest: what friction and support can hold stays where it is.

use super::faces::Faces;
use super::{BodyMove, GroupMove, STILL, Touch, TouchMove};
use crate::ContactMode;
use crate::impact::ImpactBody;
use crate::impact::dense::dot;
use crate::impact::project::balance;

/// Unbalanced acceleration below which a group is held, as a part of the largest.
const HELD: f64 = 1e-12;

/// The group at rest, if nothing in it moves and forces within the cones of friction hold it.
///
/// Where friction could hold it or not (a wedge), it is held. One cone is spanned by n ± µt of each
/// point; the nearest point of what they can reach is 0 if they can balance all that pulls.
pub(super) fn rest(
    bodies: &[ImpactBody],
    touches: &[Touch],
    faces: &Faces,
    speed: f64,
) -> Option<GroupMove> {
    let still = |body: &ImpactBody| {
        let reach = if body.inverse_inertia > 0.0 && body.inverse_mass > 0.0 {
            (body.inverse_mass / body.inverse_inertia).sqrt()
        } else {
            1.0
        };
        body.velocity.length() <= STILL * speed && body.spin.abs() * reach <= STILL * speed
    };
    if !bodies.iter().all(still) {
        return None;
    }
    let mut edges = Vec::new();
    let mut owners = Vec::new();
    for (i, face) in faces.list.iter().enumerate() {
        for (k, normal) in face.normals.iter().enumerate() {
            let signs: &[f64] = if face.friction > 0.0 {
                &[1.0, -1.0]
            } else {
                &[0.0]
            };
            for &sign in signs {
                let along = sign * face.friction * face.tangent.length;
                let mut edge = vec![0.0; faces.free.len()];
                normal.add_to(&mut edge, normal.length);
                face.tangent.add_to(&mut edge, along);
                let length = dot(&edge, &edge).sqrt();
                edge.iter_mut().for_each(|x| *x /= length);
                edges.push(edge);
                owners.push((i, k, sign, length));
            }
        }
    }
    let size = faces.free.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let (multipliers, left) = balance(&edges, &faces.free, 1e-15 * size);
    if left > HELD * size {
        return None;
    }
    let mut forces = vec![([0.0; 2], 0.0); touches.len()];
    for ((i, k, sign, length), multiplier) in owners.into_iter().zip(multipliers) {
        let force = multiplier / length;
        forces[i].0[k] += force;
        forces[i].1 += sign * touches[i].friction * force;
    }
    let touch_moves = forces.into_iter().map(|(normal, tangential)| TouchMove {
        mode: ContactMode::Rest,
        normal,
        tangential,
        slip: 0.0,
    });
    Some(GroupMove {
        bodies: vec![BodyMove::default(); bodies.len()],
        touches: touch_moves.collect(),
        change: None,
    })
}
