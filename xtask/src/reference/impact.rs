//! Category `impacts`: two bodies at one point, three laws.

use carom_dynamics::impact::{ImpactBody, ImpactContact, Outcome, newton, poisson, stronge};
use carom_geometry::{Circle, MassProperties, ring_properties};
use carom_math::Vec2;
use serde_json::Value;

use super::book::{Outputs, number_at, pair, point, point_at, points_at};
use super::symmetry::Symmetry;

/// What a case gives.
#[derive(Clone, Debug)]
pub(super) struct ImpactCase {
    bodies: [Body; 2],
    restitution: f64,
    friction: f64,
    point: Option<Vec2>,
    normal: Option<Vec2>,
}

#[derive(Clone, Debug)]
struct Body {
    shape: Shape,
    /// `None` for a body that cannot be moved.
    density: Option<f64>,
    position: Vec2,
    velocity: Vec2,
    spin: f64,
}

#[derive(Clone, Debug)]
enum Shape {
    Circle(f64),
    Polygon(Vec<Vec2>),
}

/// What the three laws say, in the order newton, poisson, stronge.
pub(super) type Outcomes = [Outcome; 3];

impl ImpactCase {
    pub(super) fn read(inputs: &Value) -> Result<Self, String> {
        Ok(Self {
            bodies: [
                Body::read(&inputs["body_a"])?,
                Body::read(&inputs["body_b"])?,
            ],
            restitution: number_at(inputs, "restitution")?,
            friction: number_at(inputs, "friction")?,
            point: point(&inputs["contact_point"]),
            normal: point(&inputs["normal_a_to_b"]),
        })
    }

    /// The points that a shift must keep exact.
    pub(super) fn places(&self) -> Vec<Vec2> {
        let centres = self.bodies.iter().map(|body| body.position);
        centres.chain(self.point).collect()
    }

    /// The case in another guise; an odd label swaps A and B.
    pub(super) fn transformed(mut self, symmetry: &Symmetry) -> Self {
        for body in &mut self.bodies {
            body.position = symmetry.point(body.position);
            body.velocity = symmetry.vector(body.velocity);
            body.spin = symmetry.turning(body.spin);
            if let Shape::Polygon(points) = &mut body.shape {
                points.iter_mut().for_each(|p| *p = symmetry.vector(*p));
            }
        }
        self.point = self.point.map(|p| symmetry.point(p));
        self.normal = self.normal.map(|n| symmetry.vector(n));
        if swaps(symmetry) {
            self.bodies.swap(0, 1);
            self.normal = self.normal.map(|n| -n);
        }
        self
    }

    /// Asks the library.
    pub(super) fn answer(&self) -> Result<Outcomes, String> {
        let [a, b] = &self.bodies;
        let apart = b.position - a.position;
        let normal = self.normal.unwrap_or(apart).normalize();
        // From A's centre: far out a point between two circles would be rounded.
        let point = match (self.point, &a.shape, &b.shape) {
            (Some(point), _, _) => point - a.position,
            (None, Shape::Circle(radius), _) => normal * *radius,
            (None, _, Shape::Circle(radius)) => apart - normal * *radius,
            _ => return Err("neither a contact point nor a circle".to_owned()),
        };
        let contact = ImpactContact {
            point,
            normal,
            restitution: self.restitution,
            friction: self.friction,
        };
        let (a, b) = (a.built(Vec2::ZERO)?, b.built(apart)?);
        Ok([newton, poisson, stronge].map(|law| law(&a, &b, &contact)))
    }

    /// The answer in the guise of the case, by the reference's keys.
    pub(super) fn outputs(found: &Outcomes, symmetry: &Symmetry) -> Outputs {
        let mut outputs = Outputs::new();
        for (law, outcome) in ["newton", "poisson", "stronge"].iter().zip(found) {
            let mut put = |key: &str, value: Value| outputs.insert(format!("{law}.{key}"), value);
            let (a, b) = match swaps(symmetry) {
                true => (&outcome.b, &outcome.a),
                false => (&outcome.a, &outcome.b),
            };
            put("jn", outcome.normal_impulse.into());
            // With A and B both J and the axes change sign; a mirror image turns only the tangent.
            put("jt", symmetry.turning(outcome.tangential_impulse).into());
            put("velocity_a", pair(symmetry.vector_back(a.velocity)));
            put("omega_a", symmetry.turning(a.spin).into());
            put("velocity_b", pair(symmetry.vector_back(b.velocity)));
            put("omega_b", symmetry.turning(b.spin).into());
        }
        outputs
    }
}

impl Body {
    fn read(value: &Value) -> Result<Self, String> {
        let shape = &value["shape"];
        let shape = if shape.get("circle").is_some() {
            Shape::Circle(number_at(shape, "circle")?)
        } else {
            Shape::Polygon(points_at(shape, "polygon")?)
        };
        let density = match value["static"].as_bool() {
            Some(true) => None,
            _ => Some(number_at(value, "density")?),
        };
        Ok(Self {
            shape,
            density,
            position: point_at(value, "position")?,
            velocity: point_at(value, "velocity")?,
            spin: number_at(value, "angular_velocity")?,
        })
    }

    fn built(&self, at: Vec2) -> Result<ImpactBody, String> {
        let (velocity, spin) = (self.velocity, self.spin);
        Ok(match self.density {
            None => ImpactBody::immovable(at, velocity, spin),
            Some(density) => ImpactBody::free(self.mass(density)?, at, velocity, spin),
        })
    }

    fn mass(&self, density: f64) -> Result<MassProperties, String> {
        let area = match &self.shape {
            Shape::Circle(radius) => Circle::new(*radius)
                .map(|circle| circle.area_properties())
                .map_err(|error| error.to_string())?,
            Shape::Polygon(points) => ring_properties(points).map_err(|error| error.to_string())?,
        };
        Ok(area.with_density(density))
    }
}

fn swaps(symmetry: &Symmetry) -> bool {
    !symmetry.label.is_multiple_of(2)
}
