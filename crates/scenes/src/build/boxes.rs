//! Walls, stacks, pyramids and grids.

use std::sync::Arc;

use carom_dynamics::BodyKind;
use carom_geometry::{ConvexPolygon, Shape};
use carom_math::{Vec2, vec2};

use super::plan::{MAX_BODIES, Planned, Planner, count};
use super::shape::shape;
use crate::error::SceneError;
use crate::model::{
    FilterTable, GridTable, Kind, MaterialChoice, PyramidTable, StackTable, WallsTable,
};
use crate::path::FieldPath;

/// A closed box (or, without a ceiling, a bin) of fixed walls around the inner rectangle.
pub(crate) fn walls(planner: &mut Planner<'_>, table: &WallsTable) -> Result<(), SceneError> {
    let field = FieldPath::root("walls");
    let (min, max, t) = (table.inner.min, table.inner.max, table.thickness);
    let room = max - min;
    if room.min_element() <= 0.0 {
        let reason = format!(
            "the room is {} m x {} m: [x0, y0] is the lower left corner",
            room.x, room.y
        );
        return Err(planner.refuse(&field.key("inner"), reason));
    }
    let material = planner.surface(&table.material, &table.filter, &field)?;
    let middle = min + 0.5 * room;
    let above = if table.ceiling { t } else { 0.0 };
    let side = vec2(t, room.y + t + above);
    let side_y = 0.5 * (min.y - t + max.y + above);
    let level = vec2(room.x, t);
    let mut parts = vec![
        ("left", vec2(min.x - 0.5 * t, side_y), side),
        ("right", vec2(max.x + 0.5 * t, side_y), side),
        ("floor", vec2(middle.x, min.y - 0.5 * t), level),
    ];
    if table.ceiling {
        parts.push(("ceiling", vec2(middle.x, max.y + 0.5 * t), level));
    }
    for (name, place, size) in parts {
        let shape = box_shape(planner, &field.key("thickness"), size)?;
        let mut wall = Planned::new(format!("wall/{name}"), field.clone());
        wall.kind = BodyKind::Fixed;
        wall.position = place;
        wall.shapes = vec![(Arc::new(shape), material.clone())];
        wall.colour.clone_from(&table.colour);
        planner.add(wall)?;
    }
    Ok(())
}

/// What all bodies of a generator share.
struct Batch<'a> {
    field: FieldPath,
    name: &'a str,
    kind: Kind,
    material: &'a MaterialChoice,
    filter: &'a FilterTable,
    colour: Option<&'a str>,
}

/// Boxes on top of each other.
pub(crate) fn stack(
    planner: &mut Planner<'_>,
    index: usize,
    table: &StackTable,
) -> Result<(), SceneError> {
    let field = FieldPath::root("stack").index(index);
    limit(planner, &field, "count", table.count, Some(table.count))?;
    let size = table.size.0;
    let shape = box_shape(planner, &field.key("size"), size)?;
    let places = (0..table.count)
        .map(|k| table.base.0 + vec2(0.0, 0.5 * size.y + number(k) * (size.y + table.gap)));
    let batch = Batch {
        field,
        name: &table.name,
        kind: Kind::Dynamic,
        material: &table.material,
        filter: &table.filter,
        colour: table.colour.as_deref(),
    };
    batch.add(planner, shape, table.count, places)
}

/// Rows of boxes, from `rows` boxes at the bottom to one.
pub(crate) fn pyramid(
    planner: &mut Planner<'_>,
    index: usize,
    table: &PyramidTable,
) -> Result<(), SceneError> {
    let field = FieldPath::root("pyramid").index(index);
    let twice = table
        .rows
        .checked_add(1)
        .and_then(|next| table.rows.checked_mul(next));
    let boxes = twice.map(|twice| twice / 2);
    limit(planner, &field, "rows", table.rows, boxes)?;
    let size = table.size.0;
    let shape = box_shape(planner, &field.key("size"), size)?;
    let pitch = size + table.gap.map_or(Vec2::ZERO, |gap| gap.0);
    let places = (0..table.rows).flat_map(|row| {
        let in_row = table.rows - row;
        (0..in_row).map(move |column| {
            let from_middle = number(column) - 0.5 * number(in_row - 1);
            table.base.0 + vec2(from_middle * pitch.x, 0.5 * size.y + number(row) * pitch.y)
        })
    });
    let batch = Batch {
        field,
        name: &table.name,
        kind: Kind::Dynamic,
        material: &table.material,
        filter: &table.filter,
        colour: table.colour.as_deref(),
    };
    batch.add(planner, shape, boxes.unwrap_or(u64::MAX), places)
}

/// One shape in columns and rows, row by row from below.
pub(crate) fn grid(
    planner: &mut Planner<'_>,
    index: usize,
    table: &GridTable,
) -> Result<(), SceneError> {
    let field = FieldPath::root("grid").index(index);
    limit(
        planner,
        &field,
        "columns",
        table.columns,
        table.columns.checked_mul(table.rows),
    )?;
    let made = shape(planner.document, &table.shape, &field.key("shape"))?;
    let places = (0..table.rows).flat_map(|row| {
        (0..table.columns)
            .map(move |column| table.corner.0 + vec2(number(column), number(row)) * table.spacing.0)
    });
    let batch = Batch {
        field,
        name: &table.name,
        kind: table.kind,
        material: &table.material,
        filter: &table.filter,
        colour: table.colour.as_deref(),
    };
    batch.add(planner, made, table.columns * table.rows, places)
}

impl Batch<'_> {
    fn add(
        &self,
        planner: &mut Planner<'_>,
        shape: Shape,
        number: u64,
        places: impl Iterator<Item = Vec2>,
    ) -> Result<(), SceneError> {
        planner.room_for(&self.field, number.saturating_mul(count(&shape)))?;
        let shape = Arc::new(shape);
        let material = planner.surface(self.material, self.filter, &self.field)?;
        for (k, place) in places.enumerate() {
            let mut body = Planned::new(format!("{}/{k}", self.name), self.field.clone());
            body.kind = self.kind.into();
            body.position = place;
            body.shapes = vec![(Arc::clone(&shape), material.clone())];
            body.colour = self.colour.map(str::to_owned);
            planner.add(body)?;
        }
        Ok(())
    }
}

fn box_shape(planner: &Planner<'_>, field: &FieldPath, size: Vec2) -> Result<Shape, SceneError> {
    ConvexPolygon::rectangle(size.x, size.y)
        .map(Shape::from)
        .map_err(|error| planner.refuse(field, error.to_string()))
}

/// Checked before anything is made: `total` is `None` where the product overflows.
fn limit(
    planner: &Planner<'_>,
    field: &FieldPath,
    key: &str,
    given: u64,
    total: Option<u64>,
) -> Result<(), SceneError> {
    if total.is_some_and(|total| total <= MAX_BODIES) {
        return Ok(());
    }
    let reason = format!("{given} makes more than {MAX_BODIES} bodies");
    Err(planner.refuse(&field.key(key), reason))
}

#[expect(clippy::cast_precision_loss, reason = "at most a million")]
fn number(count: u64) -> f64 {
    count as f64
}
