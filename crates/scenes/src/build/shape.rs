//! From `{ regular = { sides = 5, radius = 1 } }` to a shape in its body's frame.

use core::fmt;

use carom_dynamics::WORLD_LIMIT;
use carom_geometry::{Circle, ConvexPolygon, Polygon, Segment, Shape};
use carom_math::{Pose, Rot, Vec2};

use crate::document::Document;
use crate::error::{Problem, SceneError};
use crate::model::{Point, ShapeTable};
use crate::path::FieldPath;

/// Most corners of a generated shape.
const MAX_SIDES: usize = 10_000;

/// The shape that is written at `field`.
pub(crate) fn shape(
    document: &Document,
    table: &ShapeTable,
    field: &FieldPath,
) -> Result<Shape, SceneError> {
    let given = table.given();
    let [kind] = given[..] else {
        let problem = if given.is_empty() {
            Problem::MissingField("a shape, like circle = 0.5".to_owned())
        } else {
            Problem::Refused(format!("one shape has both {}", given.join(" and ")))
        };
        return Err(document.error(field, problem));
    };
    let turn = angle(document, field, "turn", table.turn, table.turn_deg)?;
    let offset = table.offset.map_or(Vec2::ZERO, |offset| offset.0);
    let pose = Pose::new(offset, Rot::from_angle(turn));
    make(table, pose).map_err(|reason| document.error(&field.key(kind), Problem::Refused(reason)))
}

/// The one shape that is given, placed in the body's frame.
fn make(table: &ShapeTable, pose: Pose) -> Result<Shape, String> {
    let placed = |points: &[Vec2]| -> Vec<Vec2> { points.iter().map(|&p| pose.point(p)).collect() };
    let convex = |polygon: ConvexPolygon| -> Result<Shape, String> {
        if pose == Pose::IDENTITY {
            return Ok(polygon.into());
        }
        let moved = ConvexPolygon::new(placed(polygon.vertices())).map_err(words)?;
        Ok(moved.into())
    };
    if let Some(radius) = table.circle {
        return Ok(Circle::at(pose.point(Vec2::ZERO), radius)
            .map_err(words)?
            .into());
    }
    if let Some(Point(size)) = table.rectangle {
        return convex(ConvexPolygon::rectangle(size.x, size.y).map_err(words)?);
    }
    if let Some(side) = table.square {
        return convex(ConvexPolygon::square(side).map_err(words)?);
    }
    if let Some(regular) = &table.regular {
        few("sides", regular.sides)?;
        return convex(ConvexPolygon::regular(regular.sides, regular.radius).map_err(words)?);
    }
    if let Some(triangle) = &table.triangle {
        let angle = match (triangle.angle, triangle.angle_deg) {
            (Some(angle), None) => angle,
            (None, Some(degrees)) => degrees.to_radians(),
            (None, None) => return Err("the angle between a and b is missing".to_owned()),
            (Some(_), Some(_)) => return Err("both angle and angle_deg are given".to_owned()),
        };
        return convex(ConvexPolygon::triangle(triangle.a, triangle.b, angle).map_err(words)?);
    }
    if let Some(points) = &table.polygon {
        return ring(placed(&vectors(points)));
    }
    if let Some(points) = &table.hull {
        return Ok(ConvexPolygon::hull(placed(&vectors(points)))
            .map_err(words)?
            .into());
    }
    if let Some(star) = &table.star {
        few("points", star.points)?;
        let star = Polygon::star(star.points, star.outer, star.inner).map_err(words)?;
        return ring(placed(star.vertices()));
    }
    if let Some([a, b]) = table.segment {
        return Ok(Segment::new(pose.point(a.0), pose.point(b.0))
            .map_err(words)?
            .into());
    }
    Err("no shape".to_owned())
}

/// A convex polygon where the ring is one (it is cheaper), else any simple polygon.
pub(super) fn ring(points: Vec<Vec2>) -> Result<Shape, String> {
    if let Ok(convex) = ConvexPolygon::new(points.clone()) {
        return Ok(convex.into());
    }
    Ok(Polygon::new(points).map_err(words)?.into())
}

/// An angle given in rad or in degrees, in rad.
pub(crate) fn angle(
    document: &Document,
    field: &FieldPath,
    key: &str,
    radians: Option<f64>,
    degrees: Option<f64>,
) -> Result<f64, SceneError> {
    match (radians, degrees) {
        (None, None) => Ok(0.0),
        (Some(radians), None) => Ok(radians),
        // In degrees, as written: the engine's error has it in rad.
        (None, Some(degrees)) if degrees.to_radians().abs() > WORLD_LIMIT => {
            let reason =
                format!("{key}_deg is {degrees:e}, beyond the limit of {WORLD_LIMIT:e} rad");
            let field = field.key(&format!("{key}_deg"));
            Err(document.error(&field, Problem::Refused(reason)))
        }
        (None, Some(degrees)) => Ok(degrees.to_radians()),
        (Some(_), Some(_)) => {
            let problem = format!("both {key} and {key}_deg are given");
            Err(document.error(&field.key(key), Problem::Refused(problem)))
        }
    }
}

fn few(name: &str, count: usize) -> Result<(), String> {
    if count > MAX_SIDES {
        return Err(format!("{name} is {count}, over the limit of {MAX_SIDES}"));
    }
    Ok(())
}

fn vectors(points: &[Point]) -> Vec<Vec2> {
    points.iter().map(|point| point.0).collect()
}

fn words(error: impl fmt::Display) -> String {
    error.to_string()
}
