//! Area, centroid and second moments of anything flat.

use core::ops::Add;

use carom_math::{Rot, Sum, Vec2, cross, two_product, two_sum, vec2};

use crate::{MassProperties, PolygonError, ring};

/// Area and its first and second moments.
///
/// ```text
/// area = ∫ dA,  centroid = ∫ p dA / area,  polar = ∫ |p − centroid|² dA
/// ixx = ∫ y² dA,  iyy = ∫ x² dA,  ixy = ∫ x y dA    about the centroid
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AreaProperties {
    /// Area, in m².
    pub area: f64,
    /// Centre of area, in m.
    pub centroid: Vec2,
    /// Polar second moment about the centroid, in m⁴.
    pub polar: f64,
    /// Second moment about the x axis through the centroid, in m⁴.
    pub ixx: f64,
    /// Second moment about the y axis through the centroid, in m⁴.
    pub iyy: f64,
    /// Product moment about the centroid, in m⁴; positive leans towards x = y.
    pub ixy: f64,
}

impl AreaProperties {
    /// Nothing.
    pub const ZERO: Self = Self {
        area: 0.0,
        centroid: Vec2::ZERO,
        polar: 0.0,
        ixx: 0.0,
        iyy: 0.0,
        ixy: 0.0,
    };

    /// Mass properties at `density` kg/m².
    #[must_use]
    pub fn with_density(self, density: f64) -> MassProperties {
        MassProperties {
            mass: self.area * density,
            centroid: self.centroid,
            inertia: self.polar * density,
        }
    }

    /// Mass properties of `mass` kg spread evenly: density from mass.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let square = ConvexPolygon::square(2.0)?.area_properties();
    /// assert_eq!(square.with_mass(12.0), square.with_density(3.0));    // 12 kg over 4 m²
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    #[must_use]
    pub fn with_mass(self, mass: f64) -> MassProperties {
        MassProperties {
            mass,
            centroid: self.centroid,
            inertia: mass * (self.polar / self.area),
        }
    }

    /// Polar second moment about `point`, in m⁴: Steiner's parallel axis theorem.
    #[must_use]
    pub fn polar_about(self, point: Vec2) -> f64 {
        self.polar + self.area * (self.centroid - point).length_squared()
    }

    /// The same area moved by `offset`, in m.
    #[must_use]
    pub fn translated(self, offset: Vec2) -> Self {
        Self {
            centroid: self.centroid + offset,
            ..self
        }
    }

    /// The same area turned about the origin.
    #[must_use]
    pub fn rotated(self, rotation: Rot) -> Self {
        let (c, s) = (rotation.cos(), rotation.sin());
        let shear = 2.0 * c * s * self.ixy;
        Self {
            centroid: rotation * self.centroid,
            ixx: c * c * self.ixx + s * s * self.iyy + shear,
            iyy: s * s * self.ixx + c * c * self.iyy - shear,
            ixy: c * s * (self.iyy - self.ixx) + (c * c - s * s) * self.ixy,
            ..self
        }
    }

    /// Largest and smallest second moment about an axis through the centroid, in m⁴, and the
    /// rotation of the axis of the largest.
    #[must_use]
    pub fn principal_axes(self) -> (f64, f64, Rot) {
        // Mohr's circle.
        let mean = 0.5 * (self.ixx + self.iyy);
        let half = 0.5 * (self.ixx - self.iyy);
        let radius = (half * half + self.ixy * self.ixy).sqrt();
        let twice = carom_math::trig::atan2(-self.ixy, half);
        (mean + radius, mean - radius, Rot::from_angle(0.5 * twice))
    }
}

/// Both areas as one.
impl Add for AreaProperties {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let area = self.area + other.area;
        if area == 0.0 {
            return Self::ZERO;
        }
        let between = other.centroid - self.centroid;
        let share = other.area / area;
        // Steiner about the common centroid: reduced area × distance².
        let reduced = self.area * share;
        Self {
            area,
            centroid: self.centroid + between * share,
            polar: self.polar + other.polar + reduced * between.length_squared(),
            ixx: self.ixx + other.ixx + reduced * between.y * between.y,
            iyy: self.iyy + other.iyy + reduced * between.x * between.x,
            ixy: self.ixy + other.ixy + reduced * between.x * between.y,
        }
    }
}

/// Area properties of any closed ring of points, in m: clockwise, pinched, slit or repeated ones too.
///
/// The ring may cross itself: then each part counts as often as it is wound around.
/// Right to 2e-13 of each value, or to 8 roundings times what the cross products cancel.
///
/// # Errors
/// If a point is not finite or too large, there are fewer than three, or they enclose no area.
///
/// # Examples
/// ```
/// use carom_geometry::ring_properties;
/// use carom_math::vec2;
/// // A right triangle of legs 3 and 4, clockwise and far away.
/// let (x, y) = (1e6, -1e6);
/// let area = ring_properties(&[vec2(x, y), vec2(x, y + 4.0), vec2(x + 3.0, y)])?;
/// assert_eq!(area.area, 6.0);                                          // m²
/// assert!((area.polar - 6.0 * 50.0 / 36.0).abs() < 1e-14);             // A (a² + b² + c²) / 36
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
pub fn ring_properties(points: &[Vec2]) -> Result<AreaProperties, PolygonError> {
    ring::check_points(points)?;
    let properties = shoelace(points);
    if properties.area > 0.0 && properties.polar > 0.0 {
        Ok(properties)
    } else {
        Err(PolygonError::Degenerate)
    }
}

/// Signed sums over the triangles of the first vertex and each edge (Green's theorem).
///
/// With `k = u × v` for an edge from u to v, seen from the first vertex:
/// ```text
/// A = Σ k/2,  A C = Σ k (u + v)/6,  ∫y² = Σ k (u_y² + u_y v_y + v_y²)/12,  ∫xy alike
/// ```
/// Taken about a vertex, not the origin: far away the cross products of world coordinates cancel.
/// Products are exact and sums compensated, so that slivers keep their digits.
pub(crate) fn shoelace(points: &[Vec2]) -> AreaProperties {
    let Some(&anchor) = points.first() else {
        return AreaProperties::ZERO;
    };
    let mut sums = [Sum::ZERO; 6];
    let mut u = Offset::of(anchor, anchor);
    for &p in points.iter().cycle().skip(1).take(points.len()) {
        let v = Offset::of(p, anchor);
        let k = u.cross(v);
        let (a, b) = (u.high, v.high);
        sums[0].add(k);
        sums[1].add(k * (a.x + b.x));
        sums[2].add(k * (a.y + b.y));
        sums[3].add(k * (a.y * a.y + a.y * b.y + b.y * b.y));
        sums[4].add(k * (a.x * a.x + a.x * b.x + b.x * b.x));
        sums[5].add(k * (a.x * (2.0 * a.y + b.y) + b.x * (a.y + 2.0 * b.y)));
        u = v;
    }
    let sign = if sums[0].value() < 0.0 { -1.0 } else { 1.0 };
    let [twice, cx, cy, yy, xx, xy] = sums.map(|sum| sign * sum.value());
    if twice == 0.0 {
        return AreaProperties::ZERO;
    }
    let area = 0.5 * twice;
    let c = vec2(cx, cy) / (3.0 * twice);
    let ixx = yy / 12.0 - area * c.y * c.y;
    let iyy = xx / 12.0 - area * c.x * c.x;
    let ixy = xy / 24.0 - area * c.x * c.y;
    AreaProperties {
        area,
        centroid: anchor + c,
        polar: ixx + iyy,
        ixx,
        iyy,
        ixy,
    }
}

/// A point seen from another one, with what rounding the difference lost.
#[derive(Clone, Copy)]
struct Offset {
    high: Vec2,
    low: Vec2,
}

impl Offset {
    fn of(p: Vec2, anchor: Vec2) -> Self {
        let (x, x_lost) = two_sum(p.x, -anchor.x);
        let (y, y_lost) = two_sum(p.y, -anchor.y);
        Self {
            high: vec2(x, y),
            low: vec2(x_lost, y_lost),
        }
    }

    /// The cross product, rounded about once.
    fn cross(self, v: Self) -> f64 {
        let (forth, forth_lost) = two_product(self.high.x, v.high.y);
        let (back, back_lost) = two_product(self.high.y, v.high.x);
        let (main, lost) = two_sum(forth, -back);
        let small = cross(self.low, v.high) + cross(self.high, v.low);
        main + (lost + (forth_lost - back_lost) + small)
    }
}
