//! The accelerations of a group whose contacts keep their modes, wherever its bodies are.
//!
//! ```text
//! R M⁻¹ C λ = −(R M⁻¹ f + γ)
//! ```
//!
//! R: rows of what is held (gaps that stay closed, slips that stay 0). C: what their forces act along: the row itself, and
//! for a normal force where the touch slides `n − µ sign(v_t) t`.

use carom_math::{Vec2, cross, perp};

use super::joint::{Place, Seen};
use super::{Contact, Hold, Rub};
use crate::impact::dense::Factored;
use crate::modes::ModeBody;

/// Rows that depend on each other to more than this have no forces of their own.
const DEPENDENT: f64 = 1e-11;

/// Bodies, contacts and modes: all that the accelerations follow from.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    pub(crate) bodies: Vec<ModeBody>,
    pub(crate) contacts: Vec<Contact>,
    pub(crate) holds: Vec<Hold>,
}

/// Forces and accelerations at an instant.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Forces {
    /// Of each body, in m/s² and rad/s².
    pub(crate) accelerations: Vec<(Vec2, f64)>,
    /// On B along the normal, of each point of each contact, in N.
    pub(crate) normal: Vec<[f64; 2]>,
    /// On B along the tangent, in N.
    pub(crate) tangential: Vec<f64>,
}

/// A force of unknown size.
struct Unknown {
    contact: usize,
    /// Which normal force; `None`: friction that holds.
    point: Option<usize>,
    bodies: (usize, usize),
    arms: (Vec2, Vec2),
    /// What is held at rest, and what the force acts along on B.
    row: Vec2,
    force: Vec2,
    /// γ, in m/s².
    bend: f64,
}

impl Equations {
    /// All points of contact.
    pub(crate) fn seen(&self, places: &[Place]) -> Vec<[Option<Seen>; 2]> {
        let one = |contact: &Contact| {
            let (a, b) = (&places[contact.bodies.0], &places[contact.bodies.1]);
            let seen = |k: usize| contact.joints.get(k).map(|joint| joint.seen(a, b));
            [seen(0), seen(1)]
        };
        self.contacts.iter().map(one).collect()
    }

    /// Forces that the modes need; `None` where there are none.
    pub(crate) fn forces(&self, places: &[Place]) -> Option<Forces> {
        let mut unknowns = self.unknowns(places);
        let found = self.solved(&unknowns).or_else(|| {
            self.drop_idle(&mut unknowns);
            self.solved(&unknowns)
        })?;
        let mut forces = Forces {
            accelerations: self
                .bodies
                .iter()
                .map(|body| (body.pull, body.twist))
                .collect(),
            normal: vec![[0.0; 2]; self.contacts.len()],
            tangential: vec![0.0; self.contacts.len()],
        };
        for (unknown, size) in unknowns.iter().zip(found) {
            let force = unknown.force * size;
            for (place, arm, sign) in [
                (unknown.bodies.0, unknown.arms.0, -1.0),
                (unknown.bodies.1, unknown.arms.1, 1.0),
            ] {
                let body = &self.bodies[place];
                let (a, alpha) = &mut forces.accelerations[place];
                *a += force * (sign * body.inverse_mass);
                *alpha += sign * cross(arm, force) * body.inverse_inertia;
            }
            match unknown.point {
                Some(point) => {
                    forces.normal[unknown.contact][point] = size;
                    if let Rub::Slides(sign) = self.holds[unknown.contact].rub {
                        forces.tangential[unknown.contact] -=
                            sign * self.contacts[unknown.contact].friction * size;
                    }
                }
                None => forces.tangential[unknown.contact] = size,
            }
        }
        Some(forces)
    }

    /// Sizes of the forces; `None` where rows depend on each other.
    fn solved(&self, unknowns: &[Unknown]) -> Option<Vec<f64>> {
        let size = unknowns.len();
        if size == 0 {
            return Some(Vec::new());
        }
        let mut matrix = Vec::with_capacity(size * size);
        for row in unknowns {
            matrix.extend(unknowns.iter().map(|other| self.answer(row, other)));
        }
        let largest = matrix.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let factored = Factored::of(size, matrix)?;
        if factored.least_pivot() <= DEPENDENT * largest {
            return None;
        }
        let right: Vec<f64> = unknowns.iter().map(|row| -self.free_rate(row)).collect();
        Some(factored.solve(&right))
    }

    /// Takes friction out that holds what others hold already: a disc in a corner that sticks to one wall sticks to the
    /// other. Any share of the forces moves the bodies alike; this one is none.
    fn drop_idle(&self, unknowns: &mut Vec<Unknown>) {
        let (mut kept, holding): (Vec<Unknown>, Vec<Unknown>) = unknowns
            .drain(..)
            .partition(|unknown| unknown.point.is_some());
        for unknown in holding {
            kept.push(unknown);
            if self.solved(&kept).is_none() {
                kept.pop();
            }
        }
        *unknowns = kept;
    }

    fn unknowns(&self, places: &[Place]) -> Vec<Unknown> {
        let mut unknowns = Vec::new();
        for (i, (contact, hold)) in self.contacts.iter().zip(&self.holds).enumerate() {
            let (a, b) = (&places[contact.bodies.0], &places[contact.bodies.1]);
            let mut holds_slip = hold.rub == Rub::Sticks;
            for (k, joint) in contact.joints.iter().enumerate() {
                if !hold.closed[k] {
                    continue;
                }
                let seen = joint.seen(a, b);
                let t = perp(seen.normal);
                let arms = (seen.point - a.centre, seen.point - b.centre);
                let mut add = |point: Option<usize>, row: Vec2, force: Vec2, bend: f64| {
                    unknowns.push(Unknown {
                        contact: i,
                        point,
                        bodies: contact.bodies,
                        arms,
                        row,
                        force,
                        bend,
                    });
                };
                let force = match hold.rub {
                    Rub::Slides(sign) => seen.normal - t * (sign * contact.friction),
                    Rub::Smooth | Rub::Sticks => seen.normal,
                };
                add(Some(k), seen.normal, force, seen.bend);
                // Both ends of a face rub along one line.
                if core::mem::take(&mut holds_slip) {
                    add(None, t, t, seen.drift);
                }
            }
        }
        unknowns
    }

    /// What a unit of a force adds to the rate of a row.
    fn answer(&self, row: &Unknown, force: &Unknown) -> f64 {
        let mut sum = 0.0;
        for (place, arm, sign) in [
            (force.bodies.0, force.arms.0, -1.0),
            (force.bodies.1, force.arms.1, 1.0),
        ] {
            let body = &self.bodies[place];
            for (at, lever, side) in [
                (row.bodies.0, row.arms.0, -1.0),
                (row.bodies.1, row.arms.1, 1.0),
            ] {
                if at == place {
                    sum += sign
                        * side
                        * (row.row.dot(force.force) * body.inverse_mass
                            + cross(lever, row.row)
                                * cross(arm, force.force)
                                * body.inverse_inertia);
                }
            }
        }
        sum
    }

    /// The rate of a row without contacts.
    fn free_rate(&self, row: &Unknown) -> f64 {
        let of = |place: usize, arm: Vec2| {
            let body = &self.bodies[place];
            body.pull.dot(row.row) + body.twist * cross(arm, row.row)
        };
        of(row.bodies.1, row.arms.1) - of(row.bodies.0, row.arms.0) + row.bend
    }
}
