//! One shape: mass properties, convex hulls, convex pieces.

use carom_geometry::{ConvexPolygon, Polygon, ring_properties};
use carom_math::{Vec2, vec2};
use parry2d_f64::mass_properties::MassProperties;
use parry2d_f64::math::Vector;
use parry2d_f64::shape::TriMesh;
use parry2d_f64::transformation::{convex_hull, hertel_mehlhorn};

use crate::exact::{GRID, Point, moments, on_grid, placed, turn, twice_area};
use crate::race::Table;
use crate::shapes::{Random, vector};

/// Shapes of each row.
const COUNT: u64 = 500;

/// Corners of the shapes.
const SIZES: [usize; 3] = [8, 32, 256];

/// Points of the grid, moved by `offset`, for both libraries.
struct Points {
    grid: Vec<Point>,
    offset: Vec2,
    ours: Vec<Vec2>,
    theirs: Vec<Vector>,
}

impl Points {
    fn new(points: impl IntoIterator<Item = Vec2>, offset: Vec2) -> Self {
        let grid: Vec<Point> = points.into_iter().map(on_grid).collect();
        let ours: Vec<Vec2> = grid.iter().map(|p| placed(*p, offset)).collect();
        Self {
            theirs: ours.iter().copied().map(vector).collect(),
            ours,
            grid,
            offset,
        }
    }

    fn some(make: impl Fn(&mut Random) -> Self) -> Vec<Self> {
        (0..COUNT).map(|i| make(&mut Random::new(i + 5))).collect()
    }
}

/// Convex polygons on a circle of 1 m, by their corners: at the origin, and 1,000 km away.
pub(crate) fn mass(table: &Table) {
    for (place, offset) in [("", Vec2::ZERO), (", 1000 km away", vec2(1e6, -1e6))] {
        for size in SIZES {
            let make = |random: &mut Random| {
                let round = ConvexPolygon::random(size, 1.0, &mut || random.next());
                let round = round.expect("a radius above 0");
                let steps = round
                    .vertices()
                    .iter()
                    .map(|v| placed(on_grid(*v), Vec2::ZERO));
                let convex = ConvexPolygon::hull(steps.collect::<Vec<Vec2>>());
                let convex = convex.expect("corners all around");
                Points::new(convex.vertices().iter().copied(), offset)
            };
            table.row(
                &format!("mass properties, {size} vertices{place}"),
                &Points::some(make),
                |points| ring_properties(&points.ours),
                |points| MassProperties::from_convex_polygon(1.0, &points.theirs),
                |points, ours, theirs| {
                    let right = moments(&points.grid);
                    let wrong = |area: f64, centroid: Vec2, polar: f64| {
                        let far = centroid - points.offset - right.1;
                        let room = 1e-12 + f64::EPSILON * points.offset.length();
                        !((area / right.0 - 1.0).abs() <= 1e-12
                            && (polar / right.2 - 1.0).abs() <= 1e-12
                            && far.length() <= room)
                    };
                    let ours = ours
                        .as_ref()
                        .map_or(true, |found| wrong(found.area, found.centroid, found.polar));
                    let centre = vec2(theirs.local_com.x, theirs.local_com.y);
                    [
                        ours,
                        wrong(theirs.mass(), centre, theirs.principal_inertia()),
                    ]
                },
            );
        }
    }
}

/// Hulls of points all over a square: anywhere, and on a lattice of 16 × 16, where many are on one line.
pub(crate) fn hulls(table: &Table) {
    for (place, lattice) in [("", GRID), (" on a lattice", 0.125)] {
        for size in SIZES {
            let make = |random: &mut Random| {
                let mut coordinate = || (random.between(-1.0, 1.0) / lattice).floor() * lattice;
                let points = (0..size).map(|_| vec2(coordinate(), coordinate()));
                Points::new(points.collect::<Vec<Vec2>>(), Vec2::ZERO)
            };
            table.row(
                &format!("convex hull, {size} points{place}"),
                &Points::some(make),
                |points| ConvexPolygon::hull(points.ours.as_slice()),
                |points| convex_hull(&points.theirs),
                |points, ours, theirs| {
                    let ours = ours.as_ref().map_or(true, |hull| {
                        !is_hull(&points.grid, hull.vertices().iter().copied())
                    });
                    let theirs = theirs.iter().map(|v| vec2(v.x, v.y));
                    [ours, !is_hull(&points.grid, theirs)]
                },
            );
        }
    }
}

/// Whether a ring has all points in it, is convex and goes around once; corners may be straight.
fn is_hull(points: &[Point], ring: impl Iterator<Item = Vec2>) -> bool {
    let ring: Vec<Point> = ring.map(on_grid).collect();
    let next = |i: usize| ring[(i + 1) % ring.len()];
    ring.len() > 2
        && twice_area(&ring) > 0
        && ring.iter().all(|v| points.contains(v))
        && (0..ring.len()).all(|i| points.iter().all(|p| turn(ring[i], next(i), *p) >= 0))
}

/// Convex pieces of random stars with long arms and of random rings: validated by carom, not by parry.
pub(crate) fn pieces(table: &Table) {
    for (kind, wild) in [("star", false), ("ring", true)] {
        for size in SIZES {
            let make = |random: &mut Random| loop {
                let mut next = || random.next();
                let made = if wild {
                    Polygon::random(size, 2.0, 2.0, &mut next)
                } else {
                    Polygon::random_star(size, 0.3, 1.0, &mut next)
                };
                let points = Points::new(
                    made.expect("lengths above 0").vertices().iter().copied(),
                    Vec2::ZERO,
                );
                // Rounding to the grid may have folded it.
                if Polygon::check(&points.ours).is_ok() {
                    break points;
                }
            };
            table.row(
                &format!("convex pieces of a random {kind}, {size} vertices"),
                &Points::some(make),
                |points| Polygon::new(points.ours.as_slice()),
                |points| {
                    let mesh = TriMesh::from_polygon(points.theirs.clone());
                    mesh.map(|mesh| hertel_mehlhorn(mesh.vertices(), mesh.indices()))
                },
                |points, ours, theirs| {
                    let ours = ours.as_ref().ok().map(|polygon| {
                        let pieces = polygon.pieces().iter();
                        let rings =
                            pieces.map(|piece| piece.vertices().iter().copied().map(on_grid));
                        rings.map(Iterator::collect).collect::<Vec<Vec<Point>>>()
                    });
                    let theirs = theirs.as_ref().map(|pieces| {
                        let ring = |piece: &Vec<Vector>| {
                            let corners = piece.iter().map(|v| on_grid(vec2(v.x, v.y)));
                            corners.collect::<Vec<Point>>()
                        };
                        pieces.iter().map(ring).collect::<Vec<Vec<Point>>>()
                    });
                    [ours, theirs].map(|pieces| {
                        !pieces.is_some_and(|pieces| are_pieces(&points.grid, &pieces))
                    })
                },
            );
        }
    }
}

/// Whether rings are convex and have the area of the whole together.
fn are_pieces(whole: &[Point], pieces: &[Vec<Point>]) -> bool {
    let convex = |ring: &Vec<Point>| {
        let at = |i: usize| ring[i % ring.len()];
        (0..ring.len()).all(|i| turn(at(i), at(i + 1), at(i + 2)) >= 0)
    };
    let area: i128 = pieces.iter().map(|ring| twice_area(ring)).sum();
    area == twice_area(whole) && pieces.iter().all(convex)
}
