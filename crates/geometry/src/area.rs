//! Area, centroid and second moments of anything flat.

use core::iter::Sum;
use core::ops::Add;

use carom_math::{self as careful, Pose, Rot, Vec2, vec2};

use crate::moments::ring_moments;
use crate::{MassProperties, PolygonError, ring};

/// Area and its first and second moments.
///
/// ```text
/// area = ∫ dA,  centroid = ∫ p dA / area,  polar = ∫ |p − centroid|² dA
/// ixx = ∫ y² dA,  iyy = ∫ x² dA,  ixy = ∫ x y dA    about the centroid
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
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

    /// Mass properties of `mass` kg spread evenly: density from mass. What has no area is taken for a
    /// point.
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
            inertia: if self.area > 0.0 {
                mass * (self.polar / self.area)
            } else {
                0.0
            },
        }
    }

    /// Density that spreads `mass` kg evenly over the area, in kg/m²; infinite if there is none.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ring_properties;
    /// use carom_math::vec2;
    /// let triangle = ring_properties(&[vec2(0.0, 0.0), vec2(4.0, 0.0), vec2(1.0, 3.0)])?;
    /// assert_eq!(triangle.density(12.0), 2.0);                        // kg/m²: 12 kg over 6 m²
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    #[must_use]
    pub fn density(self, mass: f64) -> f64 {
        mass / self.area
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

    /// The same area, given in a frame at `pose`, seen from the parent.
    #[must_use]
    pub fn transformed(self, pose: Pose) -> Self {
        self.rotated(pose.rotation).translated(pose.position)
    }

    /// Largest and smallest second moment about an axis through the centroid, in m⁴, and the
    /// rotation that takes the x axis to the axis of the largest (no turn if all are equal).
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let plank = ConvexPolygon::rectangle(4.0, 1.0)?.area_properties();
    /// let (largest, smallest, axis) = plank.principal_axes();
    /// assert!((largest - 16.0 / 3.0).abs() < 1e-14);                  // m⁴, h w³ / 12
    /// assert!((smallest - 1.0 / 3.0).abs() < 1e-15);                  // m⁴, w h³ / 12
    /// assert_eq!(axis.x_axis().x, 0.0);                               // about y: across the plank
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    #[must_use]
    pub fn principal_axes(self) -> (f64, f64, Rot) {
        // Mohr's circle: the moment about an axis at angle a is mean + half cos 2a − ixy sin 2a.
        let mean = 0.5 * (self.ixx + self.iyy);
        let half = 0.5 * (self.ixx - self.iyy);
        let radius = (half * half + self.ixy * self.ixy).sqrt();
        let largest = mean + radius;
        // mean − radius by the product of both: it does not cancel where ixy is small.
        let product = self.ixx * self.iyy - self.ixy * self.ixy;
        let smallest = if largest > 0.0 {
            (product.max(0.0) / largest).min(largest)
        } else {
            0.0
        };
        // Half the angle of (half, −ixy), from the side that does not cancel.
        let axis = if half >= 0.0 {
            vec2(radius + half, -self.ixy)
        } else {
            vec2(-self.ixy, radius - half)
        };
        (largest, smallest, direction(axis).unwrap_or_default())
    }
}

/// As [`Rot::from_direction`], for vectors of any size: squares of m⁴ leave the range of `f64`.
fn direction(v: Vec2) -> Option<Rot> {
    Rot::from_direction(v / v.abs().max_element())
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

/// All areas as one, right to a few roundings however many they are.
impl Sum for AreaProperties {
    fn sum<I: Iterator<Item = Self>>(areas: I) -> Self {
        let parts: Vec<Self> = areas.collect();
        let total =
            |of: &dyn Fn(&Self) -> f64| parts.iter().map(of).collect::<careful::Sum>().value();
        let area = total(&|part| part.area);
        // From the largest part, so that what lies far out does not cost the others their digits.
        let largest = parts.iter().max_by(|a, b| a.area.total_cmp(&b.area));
        let Some(anchor) = largest.map(|part| part.centroid).filter(|_| area != 0.0) else {
            return Self::ZERO;
        };
        let away = |part: &Self| part.centroid - anchor;
        let middle = vec2(
            total(&|part| part.area * away(part).x),
            total(&|part| part.area * away(part).y),
        ) / area;
        // Steiner's theorem for every part about the common centroid.
        let off = |part: &Self| away(part) - middle;
        let ixx = total(&|part| part.ixx + part.area * off(part).y * off(part).y);
        let iyy = total(&|part| part.iyy + part.area * off(part).x * off(part).x);
        Self {
            area,
            centroid: anchor + middle,
            polar: ixx + iyy,
            ixx,
            iyy,
            ixy: total(&|part| part.ixy + part.area * off(part).x * off(part).y),
        }
    }
}

/// Area properties of any closed ring of points, in m: clockwise, pinched, slit or repeated ones too.
///
/// The ring may cross itself: then each part counts as often as it is wound around.
/// Right to 2e-13 of each value, while the area is above 1e-15 of reach × girth and the polar moment
/// above 1e-15 of reach³ × girth; a [`crate::Polygon`] is right even where it is not.
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
    let properties = ring_moments(points);
    if properties.area > 0.0 && properties.polar > 0.0 {
        Ok(properties)
    } else {
        Err(PolygonError::Degenerate)
    }
}
