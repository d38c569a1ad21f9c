//! Category `simultaneous`: several contacts at once.

use carom_dynamics::impact::{
    ImpactBody, ImpactContact, SharedContact, SharedOutcome, blend, generalised_reflections,
    newton_lcp,
};
use carom_math::Vec2;
use serde_json::Value;

use super::book::{Outputs, number, number_at, point_at};
use super::symmetry::Symmetry;

/// What a case gives.
#[derive(Clone, Debug)]
pub(super) struct SimultaneousCase {
    bodies: Vec<ImpactBody>,
    contacts: Vec<SharedContact>,
    /// Whether the bodies stand in the opposite order.
    reversed: bool,
}

/// What the laws say.
pub(super) type Found = [(&'static str, SharedOutcome); 3];

impl SimultaneousCase {
    pub(super) fn read(inputs: &Value) -> Result<Self, String> {
        let list = |key: &str| {
            let found = inputs[key].as_array();
            found.ok_or_else(|| format!("input {key} is no list"))
        };
        let bodies: Result<_, String> = list("bodies")?.iter().map(body).collect();
        let bodies: Vec<ImpactBody> = bodies?;
        let (restitution, friction) = (
            number_at(inputs, "restitution")?,
            number_at(inputs, "friction")?,
        );
        if friction != 0.0 {
            return Err("contacts with friction are not answered yet".to_owned());
        }
        let contact = |value: &Value| {
            let normal = point_at(value, "normal")?;
            Ok::<_, String>(SharedContact {
                a: index_at(value, "a", bodies.len())?,
                b: index_at(value, "b", bodies.len())?,
                contact: ImpactContact {
                    point: point_at(value, "point")?,
                    normal: normal.normalize_or_zero(),
                    restitution,
                    friction,
                },
            })
        };
        let contacts: Result<_, String> = list("contacts")?.iter().map(contact).collect();
        Ok(Self {
            contacts: contacts?,
            bodies,
            reversed: false,
        })
    }

    /// The points that a shift must keep exact.
    pub(super) fn places(&self) -> Vec<Vec2> {
        let centres = self.bodies.iter().map(|body| body.centre);
        let points = self.contacts.iter().map(|shared| shared.contact.point);
        centres.chain(points).collect()
    }

    /// The case in another guise: bodies and contacts perhaps in the opposite order.
    pub(super) fn transformed(mut self, symmetry: &Symmetry) -> Self {
        for body in &mut self.bodies {
            body.centre = symmetry.point(body.centre);
            body.velocity = symmetry.vector(body.velocity);
            body.spin = symmetry.turning(body.spin);
        }
        for shared in &mut self.contacts {
            shared.contact.point = symmetry.point(shared.contact.point);
            shared.contact.normal = symmetry.vector(shared.contact.normal);
        }
        if !symmetry.label.is_multiple_of(2) {
            self.bodies.reverse();
            let last = self.bodies.len() - 1;
            for shared in &mut self.contacts {
                (shared.a, shared.b) = (last - shared.a, last - shared.b);
            }
            self.reversed = true;
        }
        if !(symmetry.label / 2).is_multiple_of(2) {
            self.contacts.reverse();
        }
        self
    }

    /// Asks the library.
    pub(super) fn answer(&self) -> Found {
        let (bodies, contacts) = (&self.bodies, &self.contacts);
        [
            ("newton_lcp", newton_lcp(bodies, contacts)),
            (
                "generalised_reflections",
                generalised_reflections(bodies, contacts),
            ),
            ("blend", blend(bodies, contacts)),
        ]
    }

    /// The answers in the case's own guise, by the reference's keys.
    pub(super) fn outputs(&self, found: &Found, symmetry: &Symmetry) -> Outputs {
        let mut outputs = Outputs::new();
        for (law, after) in found {
            let mut all: Vec<Value> = after
                .bodies
                .iter()
                .map(|body| {
                    let velocity = symmetry.vector_back(body.velocity);
                    vec![velocity.x, velocity.y, symmetry.turning(body.spin)].into()
                })
                .collect();
            if self.reversed {
                all.reverse();
            }
            outputs.insert(format!("{law}.velocities_vx_vy_omega"), all.into());
        }
        outputs
    }
}

fn body(value: &Value) -> Result<ImpactBody, String> {
    let inverse = |key: &str| number(&value[key]).map_or(0.0, f64::recip);
    let fixed = value["static"].as_bool().unwrap_or(false);
    Ok(ImpactBody {
        inverse_mass: if fixed { 0.0 } else { inverse("mass") },
        inverse_inertia: if fixed { 0.0 } else { inverse("inertia") },
        centre: point_at(value, "position")?,
        velocity: point_at(value, "velocity")?,
        spin: number_at(value, "angular_velocity")?,
    })
}

fn index_at(value: &Value, key: &str, count: usize) -> Result<usize, String> {
    let found = value[key].as_u64().and_then(|k| usize::try_from(k).ok());
    found
        .filter(|index| *index < count)
        .ok_or_else(|| format!("contact {key} is {}, not a body", value[key]))
}
