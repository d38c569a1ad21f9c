//! From plain data to bodies of a world.

use carom_dynamics::{BodyDef, BodyId, BodyKind, Material, Settings, Sleep, World};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Segment, Shape};

use super::{PlainBody, PlainKind, PlainMaterial, PlainScene, PlainShape};

/// Why a plain scene does not become a world.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("body {body}: {reason}")]
pub struct PlainError {
    /// Index of the body.
    pub body: usize,
    /// What is wrong with it.
    pub reason: String,
}

impl PlainScene {
    /// The engine's default settings with the scene's gravity and sleeping; a tick is a step.
    ///
    /// # Examples
    /// ```
    /// use carom_dynamics::World;
    /// let scene = carom_scenes::plain_scene("c_smash").ok_or("it is there")?;
    /// let mut world = World::new(scene.settings())?;
    /// scene.insert_into(&mut world)?;
    /// assert_eq!(world.bodies().filter(|body| body.is_asleep()).count(), 9600);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn settings(&self) -> Settings {
        let default = Settings::default();
        Settings {
            gravity: self.gravity,
            tick: self.dt,
            substep: self.dt * (default.substep / default.tick),
            sleep: self.sleeping.then(Sleep::default),
            ..default
        }
    }

    /// Gives a world all bodies of the scene, in its order.
    ///
    /// A body with an outline is made of that, any other of its shapes. Fast bodies are swept whether they are told to
    /// be or not.
    ///
    /// # Errors
    /// If a body names what the scene's tables do not have, or geometry or the world refuses it.
    pub fn insert_into(&self, world: &mut World) -> Result<Vec<BodyId>, PlainError> {
        world.reserve(self.bodies.len());
        let bodies = self.bodies.iter().enumerate();
        bodies
            .map(|(index, body)| {
                let solids = self.solids(index)?;
                let inserted = world.insert_compound(body.def(), solids);
                inserted.map_err(|error| PlainError {
                    body: index,
                    reason: error.to_string(),
                })
            })
            .collect()
    }

    /// The shapes of a body with their material: its outline where there is one.
    pub(crate) fn solids(&self, index: usize) -> Result<Vec<(Shape, Material)>, PlainError> {
        self.try_solids(&self.bodies[index])
            .map_err(|reason| PlainError {
                body: index,
                reason,
            })
    }

    fn try_solids(&self, body: &PlainBody) -> Result<Vec<(Shape, Material)>, String> {
        let material = entry("material", &self.materials, body.material)?;
        let material = Material::from(*material);
        if let Some(outline) = body.outline {
            let ring = entry("outline", &self.outlines, outline)?;
            let polygon = Polygon::new(ring.clone()).map_err(words)?;
            return Ok(vec![(polygon.into(), material)]);
        }
        let shapes = body.shapes.iter();
        shapes
            .map(|&index| Ok((entry("shape", &self.shapes, index)?.solid()?, material)))
            .collect()
    }
}

impl From<PlainMaterial> for Material {
    fn from(plain: PlainMaterial) -> Self {
        Self {
            density: plain.density,
            friction: plain.friction,
            restitution: plain.restitution,
            ..Self::default()
        }
    }
}

impl PlainBody {
    /// How the body starts, without its shapes.
    pub(crate) fn def(&self) -> BodyDef {
        let kind = match self.kind {
            PlainKind::Fixed => BodyKind::Fixed,
            PlainKind::Dynamic => BodyKind::Dynamic,
            PlainKind::Kinematic => BodyKind::Kinematic,
        };
        BodyDef {
            asleep: self.asleep,
            ..BodyDef::new(kind)
                .at(self.position)
                .turned(self.angle)
                .moving(self.velocity)
                .spinning(self.spin)
        }
    }
}

impl PlainShape {
    fn solid(&self) -> Result<Shape, String> {
        Ok(match self {
            Self::Circle { radius } => Circle::new(*radius).map_err(words)?.into(),
            Self::Box { half, offset } => ConvexPolygon::rectangle(2.0 * half.x, 2.0 * half.y)
                .map_err(words)?
                .translated(*offset)
                .into(),
            Self::Polygon(corners) => ConvexPolygon::new(corners.clone()).map_err(words)?.into(),
            Self::Segment([a, b]) => Segment::new(*a, *b).map_err(words)?.into(),
        })
    }
}

fn entry<'a, T>(what: &str, table: &'a [T], index: usize) -> Result<&'a T, String> {
    let missing = || format!("{what} {index} of {} does not exist", table.len());
    table.get(index).ok_or_else(missing)
}

#[expect(clippy::needless_pass_by_value, reason = "as `map_err` hands it over")]
fn words(error: impl ToString) -> String {
    error.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::Vec2;

    #[test]
    fn a_body_that_names_what_is_not_there_is_refused() {
        let mut scene = PlainScene::empty("bad", Vec2::ZERO);
        let mut world = World::new(scene.settings()).unwrap();
        let body = PlainBody::new(PlainKind::Dynamic, Vec2::ZERO, 0);
        scene.place(body, 3);
        let error = scene.insert_into(&mut world).unwrap_err();
        assert_eq!(error.to_string(), "body 0: material 0 of 0 does not exist");
        scene.material(1.0, 0.0, 0.0);
        let error = scene.insert_into(&mut world).unwrap_err();
        assert_eq!(error.to_string(), "body 0: shape 3 of 0 does not exist");
        scene.bodies[0].outline = Some(1);
        let error = scene.insert_into(&mut world).unwrap_err();
        assert_eq!(error.to_string(), "body 0: outline 1 of 0 does not exist");
    }

    #[test]
    fn pieces_and_outline_weigh_the_same() {
        let scene = crate::plain_scene("g").unwrap();
        let mut pieces = scene.clone();
        for body in &mut pieces.bodies {
            body.outline = None;
        }
        let world = |scene: &PlainScene| {
            let mut world = World::new(scene.settings()).unwrap();
            scene.insert_into(&mut world).unwrap();
            world
        };
        for (a, b) in world(&scene).bodies().zip(world(&pieces).bodies()).skip(3) {
            assert!((a.mass() - b.mass()).abs() < 1e-14);
            assert!((a.inertia() - b.inertia()).abs() < 1e-14);
            assert!((a.centre() - b.centre()).length() < 1e-14);
        }
    }
}
