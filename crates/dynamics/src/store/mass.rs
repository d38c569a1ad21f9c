//! What a body weighs: from its definition and its shapes.

use carom_geometry::{Aabb, AreaProperties, MassProperties, Shape};
use carom_math::{Pose, Vec2};

use crate::values::error::{BodyError, check_positive};
use crate::{BodyDef, BodyKind, Material};

/// A centre of mass nearer to the origin of its shapes than this, as a fraction of how far they reach from there, is there: two
/// roundings of what the farthest corner adds to it.
pub(crate) const CENTRED: f64 = 2.0 * f64::EPSILON;

/// Mass, centre of mass and inertia of a definition.
///
/// What is drawn about its centre of mass is found to be so: it is kept once, for drawing and for motion.
pub(crate) fn mass_of(
    def: &BodyDef,
    shapes: &[(Shape, Material)],
) -> Result<MassProperties, BodyError> {
    if def.kind != BodyKind::Fixed {
        let unbounded = shapes.iter().position(|(shape, _)| !shape.is_bounded());
        if let Some(shape) = unbounded {
            return Err(BodyError::HalfPlaneMoves { shape });
        }
    }
    let mut mass = MassProperties::ZERO;
    // A half-plane, on a fixed body, weighs nothing.
    for (area, material) in areas(shapes) {
        mass = mass + area.with_density(material.density);
    }
    if is_centred(mass.centroid, shapes) {
        mass.centroid = Vec2::ZERO;
    }
    if def.kind != BodyKind::Dynamic {
        // Infinite: only where the centre is matters, and any density gives that.
        if mass.mass == 0.0 {
            mass = middle_of(shapes);
        }
        mass.centroid = def.centre.unwrap_or(mass.centroid);
        return Ok(mass);
    }
    if mass.mass <= 0.0 && def.mass.is_none() {
        return Err(BodyError::NoMass {
            density: shapes[0].1.density,
        });
    }
    if let Some(given) = def.mass {
        if mass.mass <= 0.0 {
            // Shapes without density share the given mass by area.
            let mut area = MassProperties::ZERO;
            for (next, _) in areas(shapes) {
                area = area + next.with_density(1.0);
            }
            mass = if area.mass > 0.0 {
                area
            } else {
                middle_of(shapes)
            };
        }
        mass.inertia = if mass.mass > 0.0 {
            mass.inertia * (given / mass.mass)
        } else {
            0.0
        };
        mass.mass = given;
    }
    if let Some(centre) = def.centre {
        // Steiner: about another point it is larger by m d².
        mass.inertia += mass.mass * (centre - mass.centroid).length_squared();
        mass.centroid = centre;
    }
    if let Some(given) = def.inertia {
        mass.inertia = given;
    }
    if !def.locked_rotation {
        check_positive("inertia", mass.inertia)?;
    }
    Ok(mass)
}

/// Whether a centre of mass differs from the origin by roundings alone.
fn is_centred(centroid: Vec2, shapes: &[(Shape, Material)]) -> bool {
    let bounded = shapes.iter().filter(|(shape, _)| shape.is_bounded());
    centroid.length() <= CENTRED * reach_of(bounded, Vec2::ZERO)
}

/// Largest distance of a point of shapes from a centre, in m.
pub(crate) fn reach_of<'a>(
    shapes: impl IntoIterator<Item = &'a (Shape, Material)>,
    centre: Vec2,
) -> f64 {
    let reaches = shapes.into_iter();
    let reaches = reaches.map(|(shape, _)| shape.reach_about(centre));
    reaches.fold(0.0, f64::max)
}

/// Areas of the shapes that have one.
fn areas(shapes: &[(Shape, Material)]) -> impl Iterator<Item = (AreaProperties, &Material)> {
    shapes.iter().filter_map(|(shape, material)| {
        let area = shape.area_properties().ok()?;
        Some((area, material))
    })
}

/// Shapes without area: the middle of their box, that of a half-plane being its point.
fn middle_of(shapes: &[(Shape, Material)]) -> MassProperties {
    let mut bounds = Aabb::EMPTY;
    for (shape, _) in shapes {
        bounds = bounds.union(if shape.is_bounded() {
            shape.aabb(Pose::IDENTITY)
        } else {
            Aabb::from_points(shape.vertices().iter().copied())
        });
    }
    MassProperties {
        centroid: bounds.centre(),
        ..MassProperties::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_geometry::ConvexPolygon;
    use carom_math::vec2;

    #[test]
    fn what_is_drawn_about_its_centre_of_mass_has_it_there() {
        for sides in 3..40 {
            let polygon = ConvexPolygon::regular(sides, 1.3)
                .expect("a polygon")
                .centred();
            let centroid = |offset: Vec2| {
                let shape = Shape::from(polygon.translated(offset));
                let mass = mass_of(&BodyDef::dynamic(), &[(shape, Material::default())]);
                mass.expect("it has a mass").centroid
            };
            assert_eq!(centroid(Vec2::ZERO), Vec2::ZERO, "{sides} sides");
            let aside = vec2(1e-14, 0.0);
            assert!((centroid(aside) - aside).length() < 1e-15, "{sides} sides");
        }
    }
}
