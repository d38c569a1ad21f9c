//! Random bodies that do not overlap, by trying places.

use core::f64::consts::TAU;

use carom_geometry::{Aabb, Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};

use super::plan::{MAX_BODIES, Planned, Planner};
use super::shape::ring;
use crate::error::{Problem, SceneError};
use crate::model::{Corners, PopulationTable, RandomShape};
use crate::path::FieldPath;
use crate::random::Random;

/// How many places are tried for one body.
///
/// Discs stop fitting at about 0.55 of the area (random sequential addition); half of that needs two tries a body.
const MAX_TRIES: u64 = 5000;

/// Adds the bodies of population `index`.
pub(crate) fn populate(
    planner: &mut Planner<'_>,
    index: usize,
    table: &PopulationTable,
) -> Result<(), SceneError> {
    let field = FieldPath::root("population").index(index);
    check(planner, index, table, &field)?;
    let material = planner.surface(&table.material, &table.filter, &field)?;
    let mut random = Random::new(planner.file.seed, index as u64);
    let mut free = FreeSpace::new(planner, table);
    for k in 0..table.count {
        let radius = random.between(table.radius.least, table.radius.most);
        let shape = random_shape(&mut random, table, radius).map_err(|reason| {
            planner
                .document
                .error(&field.key("radius"), Problem::Refused(reason))
        })?;
        let angle = TAU * random.unit();
        let place = free
            .take(&mut random, table.region, radius)
            .ok_or_else(|| {
                planner.document.error(
                    &field,
                    Problem::DoesNotFit {
                        name: table.name.clone(),
                        placed: k,
                        wanted: table.count,
                        tries: MAX_TRIES,
                    },
                )
            })?;
        let heading = Rot::from_angle(TAU * random.unit());
        let speed = table.speed.map_or(0.0, |v| random.between(v.least, v.most));
        let spin = table.spin.map_or(0.0, |w| random.between(w.least, w.most));
        let mut body = Planned::new(format!("{}/{k}", table.name), field.clone());
        body.position = place;
        body.angle = angle;
        body.velocity = heading * vec2(speed, 0.0);
        body.spin = spin;
        body.shapes = vec![(shape, material.clone())];
        body.colour.clone_from(&table.colour);
        planner.add(body)?;
    }
    Ok(())
}

fn check(
    planner: &Planner<'_>,
    index: usize,
    table: &PopulationTable,
    field: &FieldPath,
) -> Result<(), SceneError> {
    let parameters = &planner.file.parameters;
    let key = |key: &str, parameter: &str, set: bool| {
        if set && index == 0 {
            FieldPath::root("parameters").key(parameter)
        } else {
            field.key(key)
        }
    };
    let refuse = |field: FieldPath, reason: String| {
        Err(planner.document.error(&field, Problem::Refused(reason)))
    };
    let radius = table.radius;
    let radius_field = key("radius", "radius", parameters.radius.is_some());
    if radius.least <= 0.0 || radius.most < radius.least {
        let reason = format!(
            "radii go from {} to {}: they must rise, from above 0",
            radius.least, radius.most
        );
        return refuse(radius_field, reason);
    }
    if let Some(speed) = table.speed
        && (speed.least < 0.0 || speed.most < speed.least)
    {
        let reason = format!(
            "speeds go from {} to {}: they must rise, from 0",
            speed.least, speed.most
        );
        return refuse(key("speed", "v", parameters.v.is_some()), reason);
    }
    if table.count > MAX_BODIES {
        let reason = format!("{} bodies are over the limit of {MAX_BODIES}", table.count);
        return refuse(key("count", "n", parameters.n.is_some()), reason);
    }
    if table.shapes.is_empty() {
        return refuse(
            field.key("shapes"),
            "the list of shapes is empty".to_owned(),
        );
    }
    if table.corners.least < 3
        || table.corners.most < table.corners.least
        || table.corners.most > 1000
    {
        let reason = format!(
            "corners go from {} to {}: they must rise, from 3 to at most 1000",
            table.corners.least, table.corners.most
        );
        return refuse(field.key("corners"), reason);
    }
    let room = table.region.max - table.region.min;
    if table.count > 0 && room.min_element() < 2.0 * radius.most {
        let reason = format!(
            "{} m x {} m is too small for a radius of {} m",
            room.x, room.y, radius.most
        );
        return refuse(field.key("region"), reason);
    }
    Ok(())
}

/// A shape within the circle of `radius` metres about its origin.
fn random_shape(
    random: &mut Random,
    table: &PopulationTable,
    radius: f64,
) -> Result<Shape, String> {
    let kind = table.shapes[random.index(table.shapes.len())];
    let span = usize::try_from(table.corners.most - table.corners.least).unwrap_or(0);
    let least = usize::try_from(table.corners.least).unwrap_or(3);
    let corners = least + random.index(span + 1);
    match kind {
        RandomShape::Disc => Circle::new(radius)
            .map(Shape::from)
            .map_err(|error| error.to_string()),
        RandomShape::Regular => ConvexPolygon::regular(corners, radius)
            .map(Shape::from)
            .map_err(|error| error.to_string()),
        RandomShape::Random => ring(corners_on_circle(random, corners, radius)),
        RandomShape::Rectangle => {
            let ratio = random.between(1.0, 3.0);
            let height = 2.0 * radius / (1.0 + ratio * ratio).sqrt();
            ConvexPolygon::rectangle(ratio * height, height)
                .map(Shape::from)
                .map_err(|error| error.to_string())
        }
        RandomShape::Star => {
            let inner = radius * random.between(0.4, 0.7);
            Polygon::star(corners, radius, inner)
                .map(Shape::from)
                .map_err(|error| error.to_string())
        }
    }
}

/// Corners in counter-clockwise order, each within four fifths of its own sector: neighbours never meet.
#[expect(clippy::cast_precision_loss, reason = "shapes have few corners")]
fn corners_on_circle(random: &mut Random, corners: usize, radius: f64) -> Vec<Vec2> {
    (0..corners)
        .map(|corner| {
            let sector = corner as f64 + 0.8 * random.unit();
            Rot::from_angle(TAU * sector / corners as f64) * vec2(radius, 0.0)
        })
        .collect()
}

/// Circles that are taken, by cell, and the bodies that stood there before.
struct FreeSpace {
    origin: Vec2,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Centre and radius of each circle, in the cell of its centre.
    cells: Vec<Vec<(Vec2, f64)>>,
    widest: f64,
    obstacles: Vec<(Aabb, Shape, Pose)>,
}

impl FreeSpace {
    fn new(planner: &Planner<'_>, table: &PopulationTable) -> Self {
        let room = table.region.max - table.region.min;
        let widest = table.radius.most;
        // About a body a cell and no more cells than bodies: a wide region must not cost memory.
        #[expect(clippy::cast_precision_loss, reason = "a limit, not a sum")]
        let by_count = (room.x * room.y / (table.count.max(1) as f64)).sqrt();
        let cell = if by_count > 2.0 * widest {
            by_count
        } else {
            2.0 * widest
        };
        let cells_along = |length: f64| whole((length / cell).ceil()).clamp(1, 1 << 20);
        let (columns, rows) = (cells_along(room.x), cells_along(room.y));
        let region = Aabb::new(table.region.min, table.region.max);
        let obstacles = planner
            .bodies
            .iter()
            .flat_map(|body| body.shapes.iter().map(|(shape, _)| (shape, body.pose())))
            .map(|(shape, pose)| (shape.aabb(pose), shape.clone(), pose))
            .filter(|(bounds, ..)| bounds.overlaps(region))
            .collect();
        Self {
            origin: table.region.min,
            cell,
            columns,
            rows,
            cells: vec![Vec::new(); columns * rows],
            widest,
            obstacles,
        }
    }

    /// A free place for a circle, which is taken from now on.
    fn take(&mut self, random: &mut Random, region: Corners, radius: f64) -> Option<Vec2> {
        for _ in 0..MAX_TRIES {
            let x = random.between(region.min.x + radius, region.max.x - radius);
            let y = random.between(region.min.y + radius, region.max.y - radius);
            let place = vec2(x, y);
            if self.is_free(place, radius) {
                let (column, row) = self.cell_of(place);
                self.cells[row * self.columns + column].push((place, radius));
                return Some(place);
            }
        }
        None
    }

    fn is_free(&self, place: Vec2, radius: f64) -> bool {
        // A circle that overlaps this one has its centre in one of the cells within reach.
        let reach = Vec2::splat(radius + self.widest);
        let (first_column, first_row) = self.cell_of(place - reach);
        let (last_column, last_row) = self.cell_of(place + reach);
        for row in first_row..=last_row {
            for column in first_column..=last_column {
                for &(other, other_radius) in &self.cells[row * self.columns + column] {
                    if place.distance_squared(other)
                        <= (radius + other_radius) * (radius + other_radius)
                    {
                        return false;
                    }
                }
            }
        }
        let around = Aabb::new(place, place).grown(radius);
        self.obstacles
            .iter()
            .filter(|(bounds, ..)| bounds.overlaps(around))
            .all(|(_, shape, pose)| shape.signed_distance(pose.inverse_point(place)) > radius)
    }

    fn cell_of(&self, place: Vec2) -> (usize, usize) {
        let from_origin = (place - self.origin) / self.cell;
        let column = whole(from_origin.x.floor()).min(self.columns - 1);
        let row = whole(from_origin.y.floor()).min(self.rows - 1);
        (column, row)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates: what lies outside counts to the cells at the rim"
)]
fn whole(value: f64) -> usize {
    value as usize
}
