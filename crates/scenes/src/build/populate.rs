//! Random bodies that do not overlap, by trying places.

use core::f64::consts::TAU;

use std::sync::Arc;

use carom_collision::BoxTree;
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
    let standing = planner.bodies.iter().flat_map(|body| {
        let shapes = body.shapes.iter();
        shapes.map(|(shape, _)| (shape, body.pose()))
    });
    let mut free = FreeSpace::new(table, standing);
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
        body.shapes = vec![(Arc::new(shape), material.clone())];
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
    obstacles: Vec<Obstacle>,
    /// Their boxes, by their places in the list.
    boxes: BoxTree,
    /// How many obstacles were held against a circle.
    looks: u64,
}

/// A part of a body that stood there before.
struct Obstacle {
    bounds: Aabb,
    shape: Arc<Shape>,
    pose: Pose,
}

impl FreeSpace {
    fn new<'s>(
        table: &PopulationTable,
        standing: impl Iterator<Item = (&'s Arc<Shape>, Pose)>,
    ) -> Self {
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
        let obstacles: Vec<Obstacle> = standing
            .map(|(shape, pose)| Obstacle {
                bounds: shape.aabb(pose),
                shape: Arc::clone(shape),
                pose,
            })
            .filter(|obstacle| obstacle.bounds.overlaps(region))
            .collect();
        let boxes = (0..).zip(&obstacles);
        let boxes = boxes.map(|(k, obstacle)| (obstacle.bounds, k)).collect();
        Self {
            origin: table.region.min,
            cell,
            columns,
            rows,
            cells: vec![Vec::new(); columns * rows],
            widest,
            obstacles,
            boxes,
            looks: 0,
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

    fn is_free(&mut self, place: Vec2, radius: f64) -> bool {
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
        let mut free = true;
        self.boxes.query(around, |k| {
            if !free {
                return;
            }
            self.looks += 1;
            let Obstacle {
                bounds,
                shape,
                pose,
            } = &self.obstacles[k as usize];
            // The boxes of the tree are a little wider.
            free = !bounds.overlaps(around)
                || shape.signed_distance(pose.inverse_point(place)) > radius;
        });
        free
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    /// A region of 20 m with 10,000 small discs and a half-plane in it.
    fn dense() -> (PopulationTable, Vec<(Arc<Shape>, Pose)>) {
        let text = "version = 1\n[[population]]\nname = 'p'\ncount = 100\nregion = [-10, -10, 10, 10]\nradius = 0.1\n";
        let scene = Scene::from_toml(text, "p").unwrap();
        let disc = Arc::new(Shape::from(Circle::new(0.03).unwrap()));
        let rows = (0..100_i32).flat_map(|i| (0..100_i32).map(move |j| vec2(i.into(), j.into())));
        let mut standing: Vec<_> = rows
            .map(|cell| (Arc::clone(&disc), Pose::at(0.2 * cell - Vec2::splat(9.9))))
            .collect();
        let below = carom_geometry::HalfPlane::new(vec2(0.0, -8.0), Vec2::Y).unwrap();
        standing.push((Arc::new(below.into()), Pose::IDENTITY));
        (scene.file.population[0].clone(), standing)
    }

    #[test]
    fn a_place_is_held_against_what_is_near_alone_and_decided_as_by_all() {
        let (table, standing) = dense();
        let each = || standing.iter().map(|(shape, pose)| (shape, *pose));
        let mut free = FreeSpace::new(&table, each());
        let mut random = Random::new(1, 0);
        let (mut tries, mut places) = (0, 0);
        while places < 500 {
            let place = vec2(random.between(-9.9, 9.9), random.between(-9.9, 9.9));
            let radius = random.between(0.001, 0.1);
            let found = free.is_free(place, radius);
            let right = each()
                .all(|(shape, pose)| shape.signed_distance(pose.inverse_point(place)) > radius);
            assert_eq!(found, right, "{place}, radius {radius}");
            places += u32::from(found);
            tries += 1;
        }
        // Nine cells of 0.2 m about a circle of 0.1 m, and the half-plane.
        assert!(
            free.looks <= 10 * tries,
            "{} looks in {tries} tries",
            free.looks
        );
    }
}
