//! `[plain]`: the bodies of a plain scene, and what the file leaves to it.

use std::sync::Arc;

use super::material::Resolved;
use super::plan::{Planned, Planner};
use crate::document::Document;
use crate::error::{Problem, SceneError, nearest};
use crate::model::{Point, SceneFile, SleepChoice};
use crate::path::FieldPath;
use crate::{PlainError, PlainScene, plain_scene, plain_scenes};

/// The plain scene that the file names, cut to the bodies that it takes. Its gravity and sleeping hold where the file
/// says nothing.
pub(super) fn lay_under(
    document: &Document,
    file: &mut SceneFile,
) -> Result<Option<PlainScene>, SceneError> {
    let Some(table) = &file.plain else {
        return Ok(None);
    };
    let field = FieldPath::root("plain");
    let Some(mut scene) = plain_scene(&table.scene) else {
        let known = plain_scenes().iter().map(|info| info.name);
        let problem = Problem::Unknown {
            what: "plain scene",
            nearest: nearest(&table.scene, known.clone()).map(str::to_owned),
            expected: known.map(str::to_owned).collect(),
        };
        return Err(document.error(&field.key("scene"), problem));
    };
    let there = scene.bodies.len();
    let end = |key: &str, wanted: u64| {
        let reason = format!("{wanted} bodies are asked for, {} has {there}", scene.name);
        let end = usize::try_from(wanted).ok().filter(|end| *end <= there);
        end.ok_or_else(|| document.error(&field.key(key), Problem::Refused(reason)))
    };
    let first = end("first", table.first)?;
    let last = match table.count {
        Some(count) => end("count", table.first.saturating_add(count))?,
        None => there,
    };
    scene.bodies.truncate(last);
    scene.bodies.drain(..first);
    file.gravity.get_or_insert(Point(scene.gravity));
    file.settings.sleep.get_or_insert(if scene.sleeping {
        SleepChoice::Default
    } else {
        SleepChoice::Never
    });
    Ok(Some(scene))
}

/// The bodies, named `SCENE/0`, `SCENE/1`, ….
pub(super) fn bodies(planner: &mut Planner<'_>, scene: &PlainScene) -> Result<(), SceneError> {
    let field = FieldPath::root("plain");
    for (index, body) in scene.bodies.iter().enumerate() {
        let refused = |error: PlainError| planner.refuse(&field, error.to_string());
        let solids = scene.solids(index).map_err(refused)?;
        let def = body.def();
        let mut planned = Planned::new(format!("{}/{index}", scene.name), field.clone());
        planned.kind = def.kind;
        planned.position = def.position;
        planned.angle = def.angle;
        planned.velocity = def.velocity;
        planned.spin = def.spin;
        planned.asleep = def.asleep;
        let by_parameter = planner.file.parameters.restitution;
        let surface = |mut material: carom_dynamics::Material| {
            material.restitution = by_parameter.unwrap_or(material.restitution);
            Resolved {
                material,
                field: field.clone(),
                by_parameter: by_parameter.is_some(),
                filter: def.filter,
            }
        };
        planned.shapes = solids
            .into_iter()
            .map(|(shape, material)| (Arc::new(shape), surface(material)))
            .collect();
        planner.add(planned)?;
    }
    Ok(())
}
