//! Category `mass_properties`: area, centroid and second moments of one outline.

use carom_geometry::{AreaProperties, Circle, ring_properties};
use carom_math::Vec2;
use serde_json::Value;

use super::book::{Outputs, number_at, pair, points_at};
use super::symmetry::Symmetry;

/// What a case gives.
#[derive(Debug)]
pub(super) struct MassCase {
    outline: Outline,
    density: f64,
    mass: f64,
}

#[derive(Debug)]
enum Outline {
    Circle(f64),
    Ring(Vec<Vec2>),
}

impl MassCase {
    pub(super) fn read(inputs: &Value) -> Result<Self, String> {
        let outline = if inputs.get("radius").is_some() {
            Outline::Circle(number_at(inputs, "radius")?)
        } else {
            Outline::Ring(points_at(inputs, "vertices")?)
        };
        Ok(Self {
            outline,
            density: number_at(inputs, "density")?,
            mass: number_at(inputs, "mass")?,
        })
    }

    /// The points that a shift must keep exact.
    pub(super) fn places(&self) -> &[Vec2] {
        match &self.outline {
            Outline::Circle(_) => &[],
            Outline::Ring(points) => points,
        }
    }

    /// The outline in another guise, begun at another vertex and perhaps run through backwards.
    pub(super) fn transformed(mut self, symmetry: &Symmetry) -> Self {
        if let Outline::Ring(points) = &mut self.outline {
            points.iter_mut().for_each(|p| *p = symmetry.point(*p));
            if !symmetry.label.is_multiple_of(2) {
                points.reverse();
            }
            let count = points.len().max(1);
            let start = (0..count).nth((symmetry.label / 2 % count as u64).try_into().unwrap_or(0));
            points.rotate_left(start.unwrap_or(0) % count);
        }
        self
    }

    /// Asks the library.
    pub(super) fn answer(&self) -> Result<AreaProperties, String> {
        match &self.outline {
            Outline::Circle(radius) => Circle::new(*radius)
                .map(|circle| circle.area_properties())
                .map_err(|error| error.to_string()),
            Outline::Ring(points) => ring_properties(points).map_err(|error| error.to_string()),
        }
    }

    /// The answer in the guise of the case, by the reference's keys.
    pub(super) fn outputs(&self, found: &AreaProperties, symmetry: &Symmetry) -> Outputs {
        let by_density = found.with_density(self.density);
        let (ixx, iyy) = match symmetry.quarter_turns % 2 {
            0 => (found.ixx, found.iyy),
            _ => (found.iyy, found.ixx),
        };
        // xy changes its sign with every mirror image and every quarter turn.
        let odd = symmetry.mirrored != (symmetry.quarter_turns % 2 == 1);
        let ixy = if odd { -found.ixy } else { found.ixy };
        let mut outputs = Outputs::new();
        let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
        put("area", found.area.into());
        put("centroid", pair(symmetry.point_back(found.centroid)));
        put("second_moment_polar", found.polar.into());
        put("ixx", ixx.into());
        put("iyy", iyy.into());
        put("ixy", ixy.into());
        put("mass_from_density", by_density.mass.into());
        put("inertia_from_density", by_density.inertia.into());
        put(
            "inertia_from_mass",
            found.with_mass(self.mass).inertia.into(),
        );
        outputs
    }
}
