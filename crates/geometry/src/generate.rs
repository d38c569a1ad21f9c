//! Polygons by name: regular, rectangle, triangle, star.

use carom_math::{Rot, Vec2, vec2};

use crate::error::{COORDINATE_LIMIT, LENGTH_LIMIT, VERTEX_LIMIT};
use crate::{ConvexPolygon, Polygon, PolygonError};

impl ConvexPolygon {
    /// A regular polygon about the origin with its first vertex on the x axis; `circumradius` in m.
    ///
    /// # Errors
    /// If there are fewer than 3 sides or too many, or the radius is not above 0.
    pub fn regular(sides: usize, circumradius: f64) -> Result<Self, PolygonError> {
        check_length("circumradius", circumradius)?;
        check_count(sides)?;
        Ok(Self::from_checked(
            (0..sides)
                .map(|i| part_of_turn(real(i), sides) * vec2(circumradius, 0.0))
                .collect(),
        ))
    }

    /// An irregular polygon with its corners on a circle about the origin; `circumradius` in m.
    ///
    /// `next` gives numbers from 0 to 1 (values outside are clamped), one a corner; the same numbers
    /// make the same polygon. Corners keep a tenth of an even share apart, so that none is needless.
    ///
    /// # Errors
    /// If there are fewer than 3 sides or too many, or the radius is not above 0.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let mut step = 0.0;
    /// let mut next = || { step += 0.618; step % 1.0 };
    /// let stone = ConvexPolygon::random(7, 0.5, &mut next)?;
    /// assert_eq!(stone.vertices().len(), 7);
    /// assert!(stone.vertices().iter().all(|v| (v.length() - 0.5).abs() < 1e-15));
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn random(
        sides: usize,
        circumradius: f64,
        next: &mut impl FnMut() -> f64,
    ) -> Result<Self, PolygonError> {
        check_length("circumradius", circumradius)?;
        check_count(sides)?;
        let corners = (0..sides).map(|i| {
            let late = 0.9 * next().clamp(0.0, 1.0);
            let late = if late.is_nan() { 0.0 } else { late };
            part_of_turn(real(i) + late, sides) * vec2(circumradius, 0.0)
        });
        Self::new(corners.collect::<Vec<Vec2>>())
    }

    /// A rectangle about the origin; `width` along x and `height` along y, in m.
    ///
    /// # Errors
    /// If a side is not above 0.
    pub fn rectangle(width: f64, height: f64) -> Result<Self, PolygonError> {
        check_length("width", width)?;
        check_length("height", height)?;
        let (x, y) = (0.5 * width, 0.5 * height);
        Ok(Self::from_checked(vec![
            vec2(-x, -y),
            vec2(x, -y),
            vec2(x, y),
            vec2(-x, y),
        ]))
    }

    /// A square about the origin; `side` in m.
    ///
    /// # Errors
    /// If the side is not above 0.
    pub fn square(side: f64) -> Result<Self, PolygonError> {
        check_length("side", side)?;
        Self::rectangle(side, side)
    }

    /// A triangle by two sides (in m) and the angle between them (in rad), about its centroid.
    ///
    /// Side `a` points along +x from the corner of the angle, side `b` is turned from it by `angle`.
    ///
    /// # Errors
    /// If a side is not above 0, or the angle is not between 0 and π.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let right = ConvexPolygon::triangle(3.0, 4.0, std::f64::consts::FRAC_PI_2)?;
    /// let mass = right.area_properties().with_mass(36.0);
    /// assert!((mass.inertia - 50.0).abs() < 1e-13);                // m (a² + b² + c²) / 36
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn triangle(a: f64, b: f64, angle: f64) -> Result<Self, PolygonError> {
        check_length("a", a)?;
        check_length("b", b)?;
        if !(angle > 0.0 && angle < core::f64::consts::PI) {
            return Err(PolygonError::OutOfRange {
                name: "angle",
                value: angle,
                low: 0.0,
                high: core::f64::consts::PI,
            });
        }
        let corner = [vec2(a, 0.0), Rot::from_angle(angle) * vec2(b, 0.0)];
        let centroid = (corner[0] + corner[1]) / 3.0;
        Self::new(vec![-centroid, corner[0] - centroid, corner[1] - centroid])
    }
}

impl Polygon {
    /// A star about the origin: `points` corners at `outer` m and as many between them at `inner` m.
    ///
    /// The first corner lies on the x axis.
    ///
    /// # Errors
    /// If there are fewer than 3 corners or too many, or a radius is not above 0.
    pub fn star(points: usize, outer: f64, inner: f64) -> Result<Self, PolygonError> {
        check_length("outer", outer)?;
        check_length("inner", inner)?;
        check_count(points)?;
        let corners = (0..2 * points).map(|i| {
            let radius = if i % 2 == 0 { outer } else { inner };
            part_of_turn(real(i), 2 * points) * vec2(radius, 0.0)
        });
        Self::new(corners.collect::<Vec<Vec2>>())
    }
}

/// The turn by `part/n`, exact at quarters.
fn part_of_turn(part: f64, n: usize) -> Rot {
    Rot::from_degrees(360.0 * part / real(n))
}

#[expect(clippy::cast_precision_loss, reason = "counts stay below 2^25")]
fn real(count: usize) -> f64 {
    count as f64
}

fn check_count(count: usize) -> Result<(), PolygonError> {
    match count {
        0..3 => Err(PolygonError::TooFewVertices { count }),
        3..=VERTEX_LIMIT => Ok(()),
        _ => Err(PolygonError::TooManyVertices {
            count,
            limit: VERTEX_LIMIT,
        }),
    }
}

fn check_length(name: &'static str, value: f64) -> Result<(), PolygonError> {
    if !(value > 0.0 && value.is_finite()) {
        return Err(PolygonError::NotPositive { name, value });
    }
    if !(LENGTH_LIMIT..=COORDINATE_LIMIT).contains(&value) {
        return Err(PolygonError::OutOfRange {
            name,
            value,
            low: LENGTH_LIMIT,
            high: COORDINATE_LIMIT,
        });
    }
    Ok(())
}
