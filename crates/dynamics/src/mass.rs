//! What a body weighs: from its definition and its shapes.

use carom_geometry::{Aabb, AreaProperties, MassProperties, Shape};
use carom_math::Pose;

use crate::error::BodyError;
use crate::{BodyDef, BodyKind, Material};

/// Mass, centre of mass and inertia of a definition.
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
    if mass.inertia <= 0.0 && !def.locked_rotation {
        return Err(BodyError::NotPositive {
            field: "inertia",
            value: mass.inertia,
        });
    }
    Ok(mass)
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
