//! Materials by value or by name.

use carom_dynamics::{BodyError, Filter, Material};

use super::field_of;
use crate::document::Document;
use crate::error::{Problem, SceneError, nearest};
use crate::model::{FilterTable, MaterialChoice, MaterialTable, SceneFile};
use crate::path::FieldPath;

/// A material and where in the file it was written.
#[derive(Clone, Debug)]
pub(crate) struct Resolved {
    pub(crate) material: Material,
    pub(crate) field: FieldPath,
    /// Whether `parameters.restitution` stands in for the material's own.
    pub(crate) by_parameter: bool,
    /// Collision filter of the surface.
    pub(crate) filter: Filter,
}

impl Resolved {
    /// Where `density`, `friction` or `restitution` was written.
    pub(crate) fn field_of(&self, key: &str) -> FieldPath {
        if self.by_parameter && key == "restitution" {
            FieldPath::root("parameters").key(key)
        } else {
            self.field.key(key)
        }
    }
}

/// The filter that is written at `field`.
pub(crate) fn filter(
    document: &Document,
    table: &FilterTable,
    field: &FieldPath,
) -> Result<Filter, SceneError> {
    let default = Filter::default();
    let bits = |key: &str, numbers: &Option<Vec<u8>>, default: u64| {
        let Some(numbers) = numbers else {
            return Ok(default);
        };
        numbers.iter().try_fold(0, |bits, number| {
            let bit = 1_u64.checked_shl(u32::from(*number)).ok_or_else(|| {
                let reason = format!("there is no category {number}: they are 0..63");
                document.error(&field.key(key), Problem::Refused(reason))
            })?;
            Ok(bits | bit)
        })
    };
    Ok(Filter {
        categories: bits("categories", &table.categories, default.categories)?,
        mask: bits("mask", &table.mask, default.mask)?,
        group: table.group,
    })
}

/// Whether the engine takes all of `[materials]`, those that no body has, too.
pub(crate) fn check_all(document: &Document, file: &SceneFile) -> Result<(), SceneError> {
    for (name, table) in &file.materials {
        let field = FieldPath::root("materials").key(name);
        let named = filled(*table, field);
        named.material.check().map_err(|error| {
            let key = match &error {
                BodyError::Restitution { .. } => "restitution",
                other => field_of(other).unwrap_or("friction"),
            };
            document.error(&named.field.key(key), Problem::Refused(error.to_string()))
        })?;
    }
    Ok(())
}

/// The material that is chosen at `field`.
pub(crate) fn resolve(
    document: &Document,
    file: &SceneFile,
    choice: &MaterialChoice,
    field: FieldPath,
) -> Result<Resolved, SceneError> {
    match choice {
        MaterialChoice::Inline(table) => Ok(filled(*table, field)),
        MaterialChoice::Named(name) => {
            let Some(table) = file.materials.get(name) else {
                let expected: Vec<String> = file.materials.keys().cloned().collect();
                let close = nearest(name, expected.iter().map(String::as_str)).map(str::to_owned);
                return Err(document.error(
                    &field,
                    Problem::Unknown {
                        what: "material",
                        nearest: close,
                        expected,
                    },
                ));
            };
            Ok(filled(*table, FieldPath::root("materials").key(name)))
        }
    }
}

/// The engine's default for what is not given. Inline values are checked by the engine, on insertion.
fn filled(table: MaterialTable, field: FieldPath) -> Resolved {
    let default = Material::default();
    Resolved {
        material: Material {
            density: table.density.unwrap_or(default.density),
            friction: table.friction.unwrap_or(default.friction),
            restitution: table.restitution.unwrap_or(default.restitution),
            tangent_speed: table.tangent_speed.unwrap_or(default.tangent_speed),
        },
        field,
        by_parameter: false,
        filter: Filter::default(),
    }
}
