//! Polygons by name: regular, rectangle, triangle, trapezoid, ellipse, star, gear.

use carom_math::{Rot, Vec2, trig, vec2};

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

    /// A trapezoid about its centroid: `bottom` and `top` along x, `height` apart, in m; the middle of
    /// the top lies `lean` m to the right of that of the bottom.
    ///
    /// # Errors
    /// If a length is not above 0, or the lean is not finite or too large.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let dam = ConvexPolygon::trapezoid(6.0, 2.0, 3.0, 0.0)?;
    /// let area = dam.area_properties();
    /// assert_eq!(area.area, 12.0);                                  // m², (b + t) h / 2
    /// assert!((dam.vertices()[0].y + 1.25).abs() < 1e-15);          // m, h (b + 2 t) / (3 (b + t))
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn trapezoid(bottom: f64, top: f64, height: f64, lean: f64) -> Result<Self, PolygonError> {
        check_length("bottom", bottom)?;
        check_length("top", top)?;
        check_length("height", height)?;
        if !(-COORDINATE_LIMIT..=COORDINATE_LIMIT).contains(&lean) {
            return Err(PolygonError::OutOfRange {
                name: "lean",
                value: lean,
                low: -COORDINATE_LIMIT,
                high: COORDINATE_LIMIT,
            });
        }
        // The centroid lies on the line between both middles, this part of the way up.
        let part = (bottom + 2.0 * top) / (3.0 * (bottom + top));
        let (below, above) = (part * height, (1.0 - part) * height);
        let (left, right) = (-part * lean, (1.0 - part) * lean);
        Self::new(vec![
            vec2(left - 0.5 * bottom, -below),
            vec2(left + 0.5 * bottom, -below),
            vec2(right + 0.5 * top, above),
            vec2(right - 0.5 * top, above),
        ])
    }

    /// An ellipse about the origin by its half axes along x and y, as a polygon inside it that no
    /// point of it is farther from than `sagitta`; all in m.
    ///
    /// As many corners as that takes, a multiple of 4, at equal steps of the eccentric anomaly: the
    /// tips are corners.
    ///
    /// # Errors
    /// If a length is not above 0, or more corners are needed than a ring may have.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let lens = ConvexPolygon::ellipse(2.0, 1.0, 1e-3)?;
    /// assert_eq!(lens.vertices().len(), 100);
    /// let missing = std::f64::consts::TAU - lens.area_properties().area;   // π a b of the ellipse
    /// assert!(missing > 0.0 && missing < 9.7 * 1e-3);                      // its girth is 9.69 m
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn ellipse(a: f64, b: f64, sagitta: f64) -> Result<Self, PolygonError> {
        check_length("a", a)?;
        check_length("b", b)?;
        check_length("sagitta", sagitta)?;
        // Seen as a circle of radius 1, a chord of the angle d leaves 1 − cos(d/2) = 2 sin²(d/4);
        // stretched, at most max(a, b) times that. So d = 4 asin √(sagitta / (2 max(a, b))).
        let square = (0.5 * sagitta / a.max(b)).min(0.5);
        let angle = 4.0 * trig::atan2(square.sqrt(), (1.0 - square).sqrt());
        let count = (0.5 * core::f64::consts::PI / angle).ceil().max(1.0) * 4.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "above 0, and the cast saturates"
        )]
        let count = count as usize;
        check_count(count)?;
        let corners = (0..count).map(|i| {
            let direction = part_of_turn(real(i), count).x_axis();
            vec2(a * direction.x, b * direction.y)
        });
        Self::new(corners.collect::<Vec<Vec2>>())
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

    /// A gear about the origin: `teeth` of them, flat tips at `outer` m, flat gaps at `root` m.
    ///
    /// A tip takes three tenths of the pitch, a gap four, the flanks the rest; the first tip is cut
    /// by the x axis.
    ///
    /// # Errors
    /// If there are fewer than 3 teeth or too many, a radius is not above 0, or `root` is not below
    /// `outer`.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::Polygon;
    /// let gear = Polygon::gear(12, 1.0, 0.8)?;
    /// assert_eq!(gear.vertices().len(), 48);
    /// assert!(gear.area_properties().centroid.length() < 1e-15);
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn gear(teeth: usize, outer: f64, root: f64) -> Result<Self, PolygonError> {
        check_length("outer", outer)?;
        check_length("root", root)?;
        if root >= outer {
            return Err(PolygonError::OutOfRange {
                name: "root",
                value: root,
                low: LENGTH_LIMIT,
                high: outer,
            });
        }
        check_count(teeth)?;
        let corners = (0..teeth).flat_map(|tooth| {
            let at = |part: f64, radius: f64| {
                part_of_turn(real(tooth) + part, teeth) * vec2(radius, 0.0)
            };
            [
                at(-0.3, root),
                at(-0.15, outer),
                at(0.15, outer),
                at(0.3, root),
            ]
        });
        Self::new(corners.collect::<Vec<Vec2>>())
    }
}

/// The turn by `part/n`, exact at quarters.
pub(crate) fn part_of_turn(part: f64, n: usize) -> Rot {
    Rot::from_degrees(360.0 * part / real(n))
}

#[expect(clippy::cast_precision_loss, reason = "counts stay below 2^25")]
pub(crate) fn real(count: usize) -> f64 {
    count as f64
}

pub(crate) fn check_count(count: usize) -> Result<(), PolygonError> {
    match count {
        0..3 => Err(PolygonError::TooFewVertices { count }),
        3..=VERTEX_LIMIT => Ok(()),
        _ => Err(PolygonError::TooManyVertices {
            count,
            limit: VERTEX_LIMIT,
        }),
    }
}

pub(crate) fn check_length(name: &'static str, value: f64) -> Result<(), PolygonError> {
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
