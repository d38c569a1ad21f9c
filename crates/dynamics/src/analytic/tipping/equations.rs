//! The accelerations of an island while its contacts keep their modes, wherever its bodies are.
//!
//! ```text
//! R M⁻¹ C λ = −(R M⁻¹ f + γ)
//! ```
//!
//! R: rows of what is held (gaps that stay closed, slips that stay 0). C: what their forces act along: the row itself, and
//! for a normal force where the touch slides `n − µ sign(v_t) t`.

use carom_math::{Vec2, cross, perp};

use super::joint::Seen;
use super::{Contact, Hold, Tangent};
use crate::impact::ImpactBody;
use crate::impact::dense::Factored;
use crate::law::path::Place;

/// Rows that depend on each other to more than this have no forces of their own.
const DEPENDENT: f64 = 1e-11;

/// Bodies, contacts and modes: all that the accelerations follow from.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    pub(crate) bodies: Vec<ImpactBody>,
    /// Their accelerations by all that is no contact, in m/s² and rad/s².
    pub(crate) pulls: Vec<(Vec2, f64)>,
    pub(crate) contacts: Vec<Contact>,
    pub(crate) holds: Vec<Hold>,
}

/// Forces and accelerations at an instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Forces {
    /// Of each body, in m/s² and rad/s².
    pub(crate) accelerations: Vec<(Vec2, f64)>,
    /// On B along the normal, of each point of each contact, in N.
    pub(crate) normal: Vec<[f64; 2]>,
    /// On B along the tangent, in N.
    pub(crate) tangential: Vec<f64>,
}

/// What evaluations one after another need, and the forces of the last one: a path asks for a hundred of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    unknowns: Vec<Unknown>,
    factored: Factored,
    right: Vec<f64>,
    sizes: Vec<f64>,
    forces: Forces,
}

/// A force of unknown size.
#[derive(Clone, Debug)]
struct Unknown {
    contact: usize,
    /// Which normal force; `None`: friction that holds.
    point: Option<usize>,
    /// A and B, and the arms of its point.
    bodies: [usize; 2],
    arms: [Vec2; 2],
    /// What is held at rest, and what the force acts along on B.
    row: Vec2,
    force: Vec2,
    /// Arm × row and arm × force, of A and B, in m.
    turns: [f64; 2],
    levers: [f64; 2],
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

    /// Forces that the modes need, in `workspace`; `None` where there are none.
    pub(crate) fn forces<'r>(
        &self,
        places: &[Place],
        workspace: &'r mut Workspace,
    ) -> Option<&'r Forces> {
        self.find_unknowns(places, &mut workspace.unknowns);
        if !self.solve(workspace) {
            self.drop_idle(workspace);
            if !self.solve(workspace) {
                return None;
            }
        }
        let Workspace {
            unknowns,
            sizes,
            forces,
            ..
        } = workspace;
        forces.accelerations.clone_from(&self.pulls);
        forces.normal.clear();
        forces.normal.resize(self.contacts.len(), [0.0; 2]);
        forces.tangential.clear();
        forces.tangential.resize(self.contacts.len(), 0.0);
        for (unknown, &size) in unknowns.iter().zip(&*sizes) {
            let force = unknown.force * size;
            for ((place, arm), sign) in unknown
                .bodies
                .into_iter()
                .zip(unknown.arms)
                .zip([-1.0, 1.0])
            {
                let body = &self.bodies[place];
                let (a, alpha) = &mut forces.accelerations[place];
                *a += force * (sign * body.inverse_mass);
                *alpha += sign * cross(arm, force) * body.inverse_inertia;
            }
            match unknown.point {
                Some(point) => {
                    forces.normal[unknown.contact][point] = size;
                    if let Tangent::Slides(sign) = self.holds[unknown.contact].rub {
                        forces.tangential[unknown.contact] -=
                            sign * self.contacts[unknown.contact].friction * size;
                    }
                }
                None => forces.tangential[unknown.contact] = size,
            }
        }
        Some(forces)
    }

    /// Sizes of the forces; whether rows do not depend on each other.
    fn solve(&self, workspace: &mut Workspace) -> bool {
        let Workspace {
            unknowns,
            factored,
            right,
            sizes,
            ..
        } = workspace;
        sizes.clear();
        let count = unknowns.len();
        if count == 0 {
            return true;
        }
        let mut largest = 0.0_f64;
        let entries = unknowns
            .iter()
            .flat_map(|row| unknowns.iter().map(|other| self.answer(row, other)))
            .inspect(|entry| largest = largest.max(entry.abs()));
        if !factored.refactor(count, entries) || factored.least_pivot() <= DEPENDENT * largest {
            return false;
        }
        right.clear();
        right.extend(unknowns.iter().map(|row| -self.free_rate(row)));
        factored.solve_into(right, sizes);
        true
    }

    /// Takes friction out that holds what others hold already: a disc in a corner that sticks to one wall sticks to the
    /// other. Any share of the forces moves the bodies alike; this one is none.
    fn drop_idle(&self, workspace: &mut Workspace) {
        let (kept, holding): (Vec<Unknown>, Vec<Unknown>) = workspace
            .unknowns
            .drain(..)
            .partition(|unknown| unknown.point.is_some());
        workspace.unknowns = kept;
        for unknown in holding {
            workspace.unknowns.push(unknown);
            if !self.solve(workspace) {
                workspace.unknowns.pop();
            }
        }
    }

    fn find_unknowns(&self, places: &[Place], unknowns: &mut Vec<Unknown>) {
        unknowns.clear();
        for (i, (contact, hold)) in self.contacts.iter().zip(&self.holds).enumerate() {
            let (a, b) = (&places[contact.bodies.0], &places[contact.bodies.1]);
            let mut holds_slip = hold.rub == Tangent::Holds;
            for (k, joint) in contact.joints.iter().enumerate() {
                if !hold.closed[k] {
                    continue;
                }
                let seen = joint.seen(a, b);
                let t = perp(seen.normal);
                let arms = [seen.point - a.centre, seen.point - b.centre];
                let mut add = |point: Option<usize>, row: Vec2, force: Vec2, bend: f64| {
                    unknowns.push(Unknown {
                        contact: i,
                        point,
                        bodies: contact.bodies.into(),
                        arms,
                        turns: arms.map(|arm| cross(arm, row)),
                        levers: arms.map(|arm| cross(arm, force)),
                        row,
                        force,
                        bend,
                    });
                };
                let force = match hold.rub {
                    Tangent::Slides(sign) => seen.normal - t * (sign * contact.friction),
                    Tangent::Smooth | Tangent::Holds => seen.normal,
                };
                add(Some(k), seen.normal, force, seen.bend);
                // Both ends of a face rub along one line.
                if core::mem::take(&mut holds_slip) {
                    add(None, t, t, seen.drift);
                }
            }
        }
    }

    /// What a unit of a force adds to the rate of a row.
    fn answer(&self, row: &Unknown, force: &Unknown) -> f64 {
        let along = row.row.dot(force.force);
        let mut sum = 0.0;
        for (k, place) in force.bodies.into_iter().enumerate() {
            for (l, at) in row.bodies.into_iter().enumerate() {
                if at == place {
                    let body = &self.bodies[place];
                    let part = along * body.inverse_mass
                        + row.turns[l] * force.levers[k] * body.inverse_inertia;
                    sum += if k == l { part } else { -part };
                }
            }
        }
        sum
    }

    /// The rate of a row without contacts.
    fn free_rate(&self, row: &Unknown) -> f64 {
        let of = |k: usize| {
            let (pull, twist) = self.pulls[row.bodies[k]];
            pull.dot(row.row) + twist * row.turns[k]
        };
        of(1) - of(0) + row.bend
    }
}
