//! Category `time_of_impact`: when two moving shapes first touch, if they do.

use carom_collision::{Impact, Motion, TimeOfImpact, time_of_impact};
use carom_geometry::Shape;
use carom_math::{Rot, Vec2};
use serde_json::Value;

use super::book::{Outputs, number_at, pair, point_at};
use super::outline::Outline;
use super::symmetry::Symmetry;

/// What a case gives.
#[derive(Clone, Debug)]
pub(super) struct FirstContactCase {
    bodies: [Body; 2],
    /// In s.
    horizon: f64,
}

#[derive(Clone, Debug)]
struct Body {
    outline: Outline,
    position: Vec2,
    /// In rad.
    angle: f64,
    velocity: Vec2,
    acceleration: Vec2,
    spin: f64,
}

/// The same as the library takes it.
#[derive(Debug)]
pub(super) struct Pair {
    shapes: [Shape; 2],
    motions: [Motion; 2],
    horizon: f64,
}

impl FirstContactCase {
    pub(super) fn read(inputs: &Value) -> Result<Self, String> {
        Ok(Self {
            bodies: [
                Body::read(&inputs["body_a"])?,
                Body::read(&inputs["body_b"])?,
            ],
            horizon: number_at(inputs, "horizon")?,
        })
    }

    /// The points that a shift must keep exact.
    pub(super) fn places(&self) -> [Vec2; 2] {
        [self.bodies[0].position, self.bodies[1].position]
    }

    /// The case in another guise: outlines begun at another vertex and perhaps run through backwards, A and B perhaps
    /// swapped.
    pub(super) fn transformed(mut self, symmetry: &Symmetry) -> Self {
        for body in &mut self.bodies {
            body.transform(symmetry);
        }
        if swaps(symmetry) {
            self.bodies.swap(0, 1);
        }
        self
    }

    /// Shapes and motions, made once.
    pub(super) fn built(&self) -> Result<Pair, String> {
        let [a, b] = &self.bodies;
        Ok(Pair {
            shapes: [a.outline.built()?, b.outline.built()?],
            motions: [a.motion(), b.motion()],
            horizon: self.horizon,
        })
    }

    /// The answer in the guise of the case, by the reference's keys.
    pub(super) fn outputs(found: &TimeOfImpact, symmetry: &Symmetry) -> Result<Outputs, String> {
        let mut outputs = Outputs::new();
        let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
        let mut hit = |time: f64, impact: &Impact| {
            let normal = symmetry.vector_back(impact.normal);
            let normal = if swaps(symmetry) { -normal } else { normal };
            put("hit", true.into());
            put("time_of_impact", time.into());
            put("contact_point", pair(symmetry.point_back(impact.point())));
            put("normal_a_to_b", pair(normal));
        };
        match found {
            TimeOfImpact::Hit(impact) => hit(impact.time, impact),
            TimeOfImpact::Touching(contact) => hit(0.0, contact),
            TimeOfImpact::Clear => {
                put("hit", false.into());
            }
            TimeOfImpact::Unresolved { safe_until } => {
                return Err(format!("unresolved after {safe_until:?} s"));
            }
        }
        Ok(outputs)
    }
}

impl Pair {
    /// Asks the library.
    pub(super) fn answer(&self) -> TimeOfImpact {
        let ([a, b], [motion_a, motion_b]) = (&self.shapes, &self.motions);
        time_of_impact(a, motion_a, b, motion_b, self.horizon)
    }
}

impl Body {
    fn read(value: &Value) -> Result<Self, String> {
        Ok(Self {
            outline: Outline::read(&value["shape"])?,
            position: point_at(value, "position")?,
            angle: number_at(value, "angle")?,
            velocity: point_at(value, "velocity")?,
            acceleration: point_at(value, "acceleration")?,
            spin: number_at(value, "angular_velocity")?,
        })
    }

    /// The outline is begun at another vertex, too.
    fn transform(&mut self, symmetry: &Symmetry) {
        self.position = symmetry.point(self.position);
        self.velocity = symmetry.vector(self.velocity);
        self.acceleration = symmetry.vector(self.acceleration);
        self.angle = symmetry.turning(self.angle);
        self.spin = symmetry.turning(self.spin);
        self.outline.transform(symmetry);
        if let Outline::Polygon(points) = &mut self.outline {
            let count = points.len().max(1);
            let start = symmetry.label / 4 % count as u64;
            points.rotate_left(usize::try_from(start).unwrap_or(0));
        }
    }

    fn motion(&self) -> Motion {
        Motion {
            velocity: self.velocity,
            acceleration: self.acceleration,
            rotation: Rot::from_angle(self.angle),
            spin: self.spin,
            ..Motion::resting(self.position)
        }
    }
}

fn swaps(symmetry: &Symmetry) -> bool {
    !symmetry.label.is_multiple_of(2)
}
