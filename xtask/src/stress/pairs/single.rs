//! Random shapes, a million each, against whole numbers: mass, convex pieces, generators.

use carom_geometry::{AreaProperties, ConvexPolygon, Polygon, PolygonError, ring_properties};
use carom_math::{Rot, Vec2, orient2d, vec2};

use super::exact::{Point, moments, on_grid, placed, turn, twice_area};
use super::over_all;
use super::random::Random;
use crate::exit::Failure;
use crate::stress::Finding;

/// What mass properties and pieces promise, relative.
const PROMISE: f64 = 2e-13;

/// A ring of up to 48 corners on a grid, simple or not: star-shaped, anything, or pressed to a sliver.
fn ring(random: &mut Random) -> Result<Vec<Point>, PolygonError> {
    let corners = random.corners(3, 49);
    let kind = random.count(0, 3);
    let flat = if kind == 2 {
        random.between(1e-4, 1e-2)
    } else {
        1.0
    };
    let slope = random.between(-0.5, 0.5);
    let mut next = || random.between(0.0, 1.0);
    let made = if kind == 0 {
        Polygon::random(corners, 2.0, 2.0, &mut next)?
    } else {
        Polygon::random_star(corners, 0.2, 1.0, &mut next)?
    };
    let pressed = made
        .vertices()
        .iter()
        .map(|v| vec2(v.x, v.y * flat + v.x * slope));
    Ok(pressed.map(on_grid).collect())
}

/// Area, centroid and moments of rings up to 1,000 km away, against whole numbers.
pub(in crate::stress) fn masses() -> Result<Finding, Failure> {
    over_all("each right to 2e-13", |number, tally| {
        let mut random = Random::new(number);
        let Ok(ring) = ring(&mut random) else {
            tally.check(number, false);
            return;
        };
        let mut away = || random.between(-1e6, 1e6).round();
        let offset = vec2(away(), away());
        let points: Vec<Vec2> = ring.iter().map(|p| placed(*p, offset)).collect();
        // Corners that rounding has folded onto one line enclose nothing.
        if twice_area(&ring) <= 0 {
            return;
        }
        let Ok(found) = ring_properties(&points) else {
            tally.check(number, false);
            return;
        };
        let (area, centroid, polar) = moments(&ring);
        tally.error(number, (found.area / area - 1.0).abs(), 1.0, PROMISE);
        tally.error(number, (found.polar / polar - 1.0).abs(), 1.0, PROMISE);
        let off = (found.centroid - offset - centroid).length();
        let room = PROMISE * 2.0 + f64::EPSILON * offset.length();
        tally.check(number, off <= room);
    })
}

/// Convex pieces of polygons: strictly convex, and area and moments are those of the whole.
pub(in crate::stress) fn pieces() -> Result<Finding, Failure> {
    over_all("convex, area exact, moments to 2e-13", |number, tally| {
        let mut random = Random::new(number);
        let Ok(ring) = ring(&mut random) else {
            tally.check(number, false);
            return;
        };
        let points: Vec<Vec2> = ring.iter().map(|p| placed(*p, Vec2::ZERO)).collect();
        let simple = Polygon::check(&points).is_ok();
        let polygon = Polygon::new(points);
        tally.check(number, polygon.is_ok() == simple);
        let Ok(polygon) = polygon else {
            return;
        };
        let parts: Vec<Vec<Point>> = polygon
            .pieces()
            .iter()
            .map(|piece| piece.vertices().iter().copied().map(on_grid).collect())
            .collect();
        let convex = |part: &Vec<Point>| {
            let at = |i: usize| part[i % part.len()];
            (0..part.len()).all(|i| turn(at(i), at(i + 1), at(i + 2)) > 0)
        };
        tally.check(number, parts.iter().all(convex));
        let area: i128 = parts.iter().map(|part| twice_area(part)).sum();
        tally.check(number, area == twice_area(&ring).abs());
        let each = polygon
            .pieces()
            .iter()
            .map(|p| ring_properties(p.vertices()));
        let Ok(each) = each.collect::<Result<Vec<AreaProperties>, _>>() else {
            tally.check(number, false);
            return;
        };
        let together: AreaProperties = each.into_iter().sum();
        let whole = polygon.area_properties();
        let error = (together.polar / whole.polar - 1.0).abs();
        tally.error(number, error, 1.0, PROMISE);
    })
}

/// Generators: never an error, as many corners as asked for, strictly convex or simple.
pub(in crate::stress) fn generators() -> Result<Finding, Failure> {
    over_all(
        "no error; convex or simple, corners counted",
        |number, tally| {
            let mut random = Random::new(number);
            let corners = random.corners(3, 65);
            let (w, h) = (random.between(1e-3, 1e3), random.between(1e-3, 1e3));
            let angle = Rot::from_degrees(random.between(1.0, 179.0)).angle();
            let inner = w * random.between(0.05, 0.95);
            let mut next = || random.between(0.0, 1.0);
            let convex = [
                (corners, ConvexPolygon::regular(corners, w)),
                (corners, ConvexPolygon::random(corners, w, &mut next)),
                (
                    corners,
                    ConvexPolygon::random_in_box(corners, w, h, &mut next),
                ),
                (4, ConvexPolygon::rectangle(w, h)),
                (3, ConvexPolygon::triangle(w, h, angle)),
            ];
            for (wanted, made) in convex {
                let right = made.is_ok_and(|polygon| {
                    let v = polygon.vertices();
                    let at = |i: usize| v[i % v.len()];
                    v.len() == wanted
                        && (0..v.len()).all(|i| orient2d(at(i), at(i + 1), at(i + 2)) > 0.0)
                });
                tally.check(number, right);
            }
            let simple = [
                (corners, Polygon::random(corners, w, h, &mut next)),
                (corners, Polygon::random_star(corners, inner, w, &mut next)),
                (2 * corners, Polygon::star(corners, w, inner)),
            ];
            for (wanted, made) in simple {
                let right = made.is_ok_and(|polygon| {
                    let ring = polygon.vertices();
                    ring.len() == wanted && Polygon::check(ring).is_ok()
                });
                tally.check(number, right);
            }
        },
    )
}
