//! Boxes along the axes.

use carom_math::Vec2;

/// An axis-aligned box: all points between `min` and `max`, both included, in m.
///
/// # Examples
/// ```
/// use carom_geometry::Aabb;
/// use carom_math::vec2;
/// let a = Aabb::from_points([vec2(0.0, 0.0), vec2(2.0, 1.0)]);
/// let b = Aabb::new(vec2(2.0, 0.5), vec2(3.0, 4.0));
/// assert!(a.overlaps(b));                                      // a common edge is enough
/// assert_eq!(a.union(b).extents(), vec2(3.0, 4.0));            // m
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Aabb {
    /// Lower left corner, in m.
    pub min: Vec2,
    /// Upper right corner, in m.
    pub max: Vec2,
}

impl Aabb {
    /// The box of no points: it overlaps nothing, and any union leaves it.
    pub const EMPTY: Self = Self {
        min: Vec2::INFINITY,
        max: Vec2::NEG_INFINITY,
    };

    /// The box between two corners.
    #[must_use]
    pub const fn new(min: Vec2, max: Vec2) -> Self {
        Self { min, max }
    }

    /// The smallest box around `points`.
    #[must_use]
    pub fn from_points(points: impl IntoIterator<Item = Vec2>) -> Self {
        points.into_iter().fold(Self::EMPTY, |all, p| Self {
            min: all.min.min(p),
            max: all.max.max(p),
        })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether the boxes have a point in common.
    #[must_use]
    pub fn overlaps(self, other: Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
    }

    /// Whether `other` lies within this box.
    #[must_use]
    pub fn contains(self, other: Self) -> bool {
        self.min.x <= other.min.x
            && other.max.x <= self.max.x
            && self.min.y <= other.min.y
            && other.max.y <= self.max.y
    }

    /// Whether `point` lies within this box.
    #[must_use]
    pub fn contains_point(self, point: Vec2) -> bool {
        self.contains(Self::new(point, point))
    }

    /// The box with every side moved out by `margin`, in m.
    #[must_use]
    pub fn grown(self, margin: f64) -> Self {
        Self {
            min: self.min - Vec2::splat(margin),
            max: self.max + Vec2::splat(margin),
        }
    }

    /// Middle of the box, in m.
    #[must_use]
    pub fn centre(self) -> Vec2 {
        // Halved first, so that corners near the largest double do not overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Width and height, in m.
    #[must_use]
    pub fn extents(self) -> Vec2 {
        self.max - self.min
    }

    /// Whether it is a box: neither side is negative, and no corner is NaN (those of [`Self::EMPTY`] are the wrong way round).
    #[must_use]
    pub fn is_valid(self) -> bool {
        self.min.x <= self.max.x && self.min.y <= self.max.y
    }

    /// Length of the rim, in m.
    #[must_use]
    pub fn perimeter(self) -> f64 {
        let sides = self.extents();
        2.0 * (sides.x + sides.y)
    }

    /// The box with both sides times `factor`, about its centre.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let (centre, half) = (self.centre(), self.extents() * (0.5 * factor));
        Self::new(centre - half, centre + half)
    }

    /// The part of the segment from `a` to `b` that lies in the box, as fractions of its length; `None` if it misses.
    ///
    /// Source: Y.-D. Liang, B. Barsky, *A new concept and method for line clipping*, 1984.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::Aabb;
    /// use carom_math::vec2;
    /// let unit = Aabb::new(vec2(0.0, 0.0), vec2(1.0, 1.0));
    /// assert_eq!(unit.clip_segment(vec2(-1.0, 0.5), vec2(3.0, 0.5)), Some((0.25, 0.5)));
    /// assert_eq!(unit.clip_segment(vec2(-1.0, 2.0), vec2(3.0, 2.0)), None);
    /// ```
    #[must_use]
    pub fn clip_segment(self, a: Vec2, b: Vec2) -> Option<(f64, f64)> {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        let axes = [
            (a.x, b.x - a.x, self.min.x, self.max.x),
            (a.y, b.y - a.y, self.min.y, self.max.y),
        ];
        for (start, way, low, high) in axes {
            if way == 0.0 {
                if start < low || start > high {
                    return None;
                }
                continue;
            }
            let (one, other) = ((low - start) / way, (high - start) / way);
            let (enters, leaves) = if one < other {
                (one, other)
            } else {
                (other, one)
            };
            if enters > from {
                from = enters;
            }
            if leaves < to {
                to = leaves;
            }
        }
        (from <= to).then_some((from, to))
    }

    /// Whether all corners are finite (those of [`Self::EMPTY`] are not).
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use carom_math::vec2;

    use super::*;

    #[test]
    fn the_empty_box_is_neutral() {
        let a = Aabb::new(vec2(-1.0, 2.0), vec2(3.0, 4.0));
        assert_eq!(a.union(Aabb::EMPTY), a);
        assert_eq!(Aabb::from_points([]), Aabb::EMPTY);
        assert!(!a.overlaps(Aabb::EMPTY) && !Aabb::EMPTY.contains_point(Vec2::ZERO));
        assert!(a.contains(Aabb::EMPTY) && !Aabb::EMPTY.is_finite());
    }

    #[test]
    fn corners_belong_to_the_box() {
        let a = Aabb::new(vec2(-1.0, 2.0), vec2(3.0, 4.0));
        assert!(a.contains_point(a.min) && a.contains_point(a.max));
        assert!(!a.contains_point(vec2(3.0_f64.next_up(), 3.0)));
        assert_eq!((a.centre(), a.extents()), (vec2(1.0, 3.0), vec2(4.0, 2.0)));
        assert!(a.grown(0.5).contains(a) && !a.contains(a.grown(0.5)));
        assert_eq!(Aabb::from_points([a.max, a.min]), a);
    }
}
