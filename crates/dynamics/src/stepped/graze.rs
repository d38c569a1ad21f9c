//! Contacts of bodies that pass each other by a hair.
//!
//! A box on a floor of tiles sinks in by its softness. The side of the next tile then stands in its way
//! by that much, and so does the tile's corner while the two are apart. A row made of such a contact
//! stops the box at a seam that nobody can feel. So corners that are to meet, and sides that share but a
//! hair of their length, become rows only if the bodies would meet but for a skin of their width.

use carom_collision::{Motion, PartManifold, TimeOfImpact, part, time_of_impact_of_parts};
use carom_math::{Pose, SimTime, Vec2};

use crate::World;

/// Stretches of contact shorter than this fraction of the smaller reach are a hair: 1 mm for boxes of 1 m.
/// A box of 1 m sinks in by 0.1 mm, one that carries ten by 1 mm.
const HAIR: f64 = 1.5e-3;

/// Sine of the angle by which a normal may differ from that of an edge.
const ALONG: f64 = 1e-6;

impl World {
    /// Drops the contacts of the present look along which two bodies pass each other.
    pub(super) fn drop_grazes(
        &mut self,
        colliders: (u32, u32),
        slots: [u32; 2],
        poses: [Pose; 2],
        size: f64,
    ) {
        let mut found = core::mem::take(&mut self.pool.found);
        found.retain(|contact| {
            !self.is_hair(contact, colliders, poses, size)
                || self.cores_meet(contact, colliders, slots, poses)
        });
        self.pool.found = found;
    }

    /// Whether corners are to meet corners, or sides share but a hair of their length.
    fn is_hair(
        &self,
        contact: &PartManifold,
        colliders: (u32, u32),
        poses: [Pose; 2],
        size: f64,
    ) -> bool {
        let part_of = |k: usize| {
            let (at, number) = [(colliders.0, contact.part_a), (colliders.1, contact.part_b)][k];
            part(&self.colliders[at as usize].solid, number as usize)
        };
        let normal = contact.manifold.normal;
        match contact.manifold.points.as_slice() {
            [one] if one.separation > 0.0 => {
                let parts = [part_of(0), part_of(1)];
                if parts.iter().any(|part| part.normals.is_empty()) {
                    return false;
                }
                let along = |normals: &[Vec2], n: Vec2| {
                    normals
                        .iter()
                        .any(|edge| edge.dot(n) > 0.0 && carom_math::cross(*edge, n).abs() < ALONG)
                };
                let in_b = || {
                    let [a, b] = poses.map(|pose| pose.rotation);
                    b.inverse() * (a * -normal)
                };
                !along(parts[0].normals, normal) && !along(parts[1].normals, in_b())
            }
            [first, second] => {
                let stretch = (second.point - first.point).length();
                if stretch >= HAIR * size {
                    return false;
                }
                let parts = [part_of(0), part_of(1)];
                // A short edge that is all in touch is a face.
                let edges = [
                    parts[0].edge(first.feature.vertices().0),
                    parts[0].edge(second.feature.vertices().0),
                    parts[1].edge(first.feature.vertices().1),
                    parts[1].edge(second.feature.vertices().1),
                ];
                let shortest = edges
                    .iter()
                    .map(|(from, to)| (*to - *from).length())
                    .fold(f64::INFINITY, f64::min);
                stretch < 0.5 * shortest
            }
            _ => false,
        }
    }

    /// Whether the two parts would meet within a tick, the first without its skin.
    fn cores_meet(
        &mut self,
        contact: &PartManifold,
        colliders: (u32, u32),
        slots: [u32; 2],
        poses: [Pose; 2],
    ) -> bool {
        let solid = &self.colliders[colliders.0 as usize].solid;
        let cores = self.pool.cores.of(colliders.0, solid);
        let target = &self.colliders[colliders.1 as usize].solid;
        let lines = &self.pool.seats.rig.lines;
        let [a, b] = [0, 1].map(|k| {
            let (pose, line) = (poses[k], &lines[slots[k] as usize]);
            Motion {
                start: SimTime::ZERO,
                velocity: line.v(),
                rotation: pose.rotation,
                spin: line.w(),
                ..Motion::resting(pose.position)
            }
        });
        self.report.pairs += 1;
        let next = time_of_impact_of_parts(
            &part(&cores[contact.part_a as usize], 0),
            &a,
            &part(target, contact.part_b as usize),
            &b,
            self.settings.tick,
        );
        !matches!(next, TimeOfImpact::Clear)
    }
}
