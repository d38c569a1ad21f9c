//! A rotation as unit cosine and sine: no angle wraps, no trigonometry to apply it.

use core::ops::Mul;

use crate::{Vec2, trig, vec2};

/// Squares of angles below this have a shorter series: 1/256 rad, where the terms left out are below 1e-18.
const TINY: f64 = 1.0 / 65536.0;

/// A rotation of the plane, counter-clockwise positive.
///
/// Cosine and sine are kept at unit length to a few units of rounding by [`Rot::renormalized`].
///
/// # Examples
/// ```
/// use carom_math::{Rot, Vec2};
/// let quarter = Rot::from_degrees(90.0);
/// assert_eq!(quarter * Vec2::X, Vec2::Y);                              // exact at quarter turns
/// assert_eq!((quarter * quarter).angle(), core::f64::consts::PI);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "crate::wire::CosSin", into = "crate::wire::CosSin")
)]
pub struct Rot {
    cos: f64,
    sin: f64,
}

impl Default for Rot {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Rot {
    /// No rotation.
    pub const IDENTITY: Self = Self { cos: 1.0, sin: 0.0 };

    /// Rotation by `angle`, in radians.
    #[must_use]
    pub fn from_angle(angle: f64) -> Self {
        let (sin, cos) = trig::sin_cos(angle);
        Self { cos, sin }
    }

    /// The rotation with this cosine and sine: their squares add up to 1 but for rounding, see [`Rot::renormalized`].
    #[must_use]
    pub const fn from_cos_sin(cos: f64, sin: f64) -> Self {
        Self { cos, sin }
    }

    /// Rotation by `degrees`; exact at multiples of 90.
    #[must_use]
    pub fn from_degrees(degrees: f64) -> Self {
        // The remainder is exact, so a quarter turn stays one however often it is repeated.
        let quarters = (degrees / 90.0).round();
        let rest = Self::from_angle((degrees - 90.0 * quarters) * (core::f64::consts::PI / 180.0));
        match quarters.rem_euclid(4.0) {
            q if q < 0.5 => rest,
            q if q < 1.5 => Self {
                cos: -rest.sin,
                sin: rest.cos,
            },
            q if q < 2.5 => Self {
                cos: -rest.cos,
                sin: -rest.sin,
            },
            _ => Self {
                cos: rest.sin,
                sin: -rest.cos,
            },
        }
    }

    /// The rotation that takes the x axis to `direction`, or `None` if that has no direction.
    #[must_use]
    pub fn from_direction(direction: Vec2) -> Option<Self> {
        // Beyond these the square of a length over- or underflows.
        let largest = direction.abs().max_element();
        let unit = if (1e-140..1e140).contains(&largest) {
            direction.try_normalize()?
        } else {
            (direction / largest).try_normalize()?
        };
        Some(Self {
            cos: unit.x,
            sin: unit.y,
        })
    }

    /// Cosine of the angle.
    #[must_use]
    pub const fn cos(self) -> f64 {
        self.cos
    }

    /// Sine of the angle.
    #[must_use]
    pub const fn sin(self) -> f64 {
        self.sin
    }

    /// The principal angle, in radians, in (−π, π].
    #[must_use]
    pub fn angle(self) -> f64 {
        // Half a turn is +π from either side: a sine of −0 or −1e-17 makes no other.
        let angle = trig::atan2(self.sin + 0.0, self.cos);
        if angle > -core::f64::consts::PI {
            angle
        } else {
            angle.abs()
        }
    }

    /// The principal angle, in degrees, in (−180, 180]; exact at multiples of 90.
    ///
    /// # Examples
    /// ```
    /// use carom_math::Rot;
    /// assert_eq!(Rot::from_degrees(-450.0).degrees(), -90.0);
    /// assert!((Rot::from_degrees(33.0).degrees() - 33.0).abs() < 1e-14);
    /// ```
    #[must_use]
    pub fn degrees(self) -> f64 {
        // From the nearest quarter turn on: what is left is small, and keeps its digits.
        let (cos, sin) = (self.cos, self.sin + 0.0);
        let (quarter, rest) = if cos.abs() >= sin.abs() {
            if cos > 0.0 {
                (0.0, trig::atan2(sin, cos))
            } else if sin >= 0.0 {
                (180.0, trig::atan2(-sin, -cos))
            } else {
                (-180.0, trig::atan2(-sin, -cos))
            }
        } else if sin > 0.0 {
            (90.0, trig::atan2(-cos, sin))
        } else {
            (-90.0, trig::atan2(cos, -sin))
        };
        let degrees = quarter + rest * (180.0 / core::f64::consts::PI);
        if degrees > -180.0 {
            degrees
        } else {
            degrees.abs()
        }
    }

    /// The rotation a part of the way to `other`, by the shorter turn: 0 is this one, 1 the other; any `part` is allowed.
    ///
    /// # Examples
    /// ```
    /// use carom_math::Rot;
    /// let half = Rot::from_degrees(170.0).blend(Rot::from_degrees(-150.0), 0.5);
    /// assert!((half.degrees() + 170.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn blend(self, other: Self, part: f64) -> Self {
        self.turned(part * (self.inverse() * other).angle())
    }

    /// The opposite rotation.
    #[must_use]
    pub const fn inverse(self) -> Self {
        Self {
            cos: self.cos,
            sin: -self.sin,
        }
    }

    /// This rotation followed by `angle` radians more, back at unit length.
    #[must_use]
    pub fn turned(self, angle: f64) -> Self {
        if angle == 0.0 {
            return self;
        }
        (Self::from_angle(angle) * self).renormalized()
    }

    /// Two rotations, each followed by its angle in radians: the bits of [`Rot::turned`] of each, sooner.
    #[must_use]
    pub fn turned_pair(rotations: [Self; 2], angles: [f64; 2]) -> [Self; 2] {
        let [a, b] = rotations;
        if angles[0] == 0.0 || angles[1] == 0.0 {
            return [a.turned(angles[0]), b.turned(angles[1])];
        }
        let (sin, cos) = trig::sin_cos_pair(angles);
        [0, 1].map(|k| {
            let turn = Self {
                cos: cos[k],
                sin: sin[k],
            };
            (turn * rotations[k]).renormalized()
        })
    }

    /// As [`Self::turned`], faster where `angle` is at most half a radian: by its series.
    ///
    /// ```text
    /// sin x = x (1 − x²/6 (1 − x²/20 (1 − x²/42 …)))        cos x = 1 − x²/2 (1 − x²/12 (1 − x²/30 …))
    /// ```
    /// The first term left out is below 1e-17 for both.
    #[must_use]
    pub fn turned_slightly(self, angle: f64) -> Self {
        if angle.abs() > 0.5 {
            return self.turned(angle);
        }
        let x = angle * angle;
        if x < TINY {
            let sin = angle * (1.0 - x * (1.0 / 6.0) * (1.0 - x * (1.0 / 20.0)));
            let cos = 1.0 - x * 0.5 * (1.0 - x * (1.0 / 12.0) * (1.0 - x * (1.0 / 30.0)));
            return (Self { cos, sin } * self).renormalized();
        }
        let sin = 1.0 - x * (1.0 / 110.0) * (1.0 - x * (1.0 / 156.0));
        let sin = 1.0 - x * (1.0 / 42.0) * (1.0 - x * (1.0 / 72.0) * sin);
        let sin = angle * (1.0 - x * (1.0 / 6.0) * (1.0 - x * (1.0 / 20.0) * sin));
        let cos = 1.0 - x * (1.0 / 90.0) * (1.0 - x * (1.0 / 132.0) * (1.0 - x * (1.0 / 182.0)));
        let cos = 1.0 - x * (1.0 / 30.0) * (1.0 - x * (1.0 / 56.0) * cos);
        let cos = 1.0 - x * 0.5 * (1.0 - x * (1.0 / 12.0) * cos);
        (Self { cos, sin } * self).renormalized()
    }

    /// Cosine and sine brought back to unit length.
    ///
    /// One Newton step for 1/√(c² + s²) from 1: the error e of the square becomes 3e²/8, far
    /// below rounding for any rotation that was a product of unit ones.
    #[must_use]
    pub fn renormalized(self) -> Self {
        let square = self.cos * self.cos + self.sin * self.sin;
        let scale = 1.5 - 0.5 * square;
        Self {
            cos: self.cos * scale,
            sin: self.sin * scale,
        }
    }

    /// `v` turned backwards: from the parent frame into the turned one.
    #[must_use]
    pub fn inverse_mul(self, v: Vec2) -> Vec2 {
        vec2(
            self.cos * v.x + self.sin * v.y,
            self.cos * v.y - self.sin * v.x,
        )
    }

    /// The turned x axis.
    #[must_use]
    pub fn x_axis(self) -> Vec2 {
        vec2(self.cos, self.sin)
    }

    /// The turned y axis.
    #[must_use]
    pub fn y_axis(self) -> Vec2 {
        vec2(-self.sin, self.cos)
    }
}

impl Mul<Vec2> for Rot {
    type Output = Vec2;

    fn mul(self, v: Vec2) -> Vec2 {
        vec2(
            self.cos * v.x - self.sin * v.y,
            self.sin * v.x + self.cos * v.y,
        )
    }
}

/// `a * b` turns by `b` first, then by `a`; rotations of the plane commute.
impl Mul for Rot {
    type Output = Self;

    fn mul(self, b: Self) -> Self {
        Self {
            cos: self.cos * b.cos - self.sin * b.sin,
            sin: self.sin * b.cos + self.cos * b.sin,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_turns_are_exact() {
        for quarters in -9_i32..=9 {
            let turned = Rot::from_degrees(90.0 * f64::from(quarters)) * vec2(3.0, 5.0);
            let want = [
                vec2(3.0, 5.0),
                vec2(-5.0, 3.0),
                vec2(-3.0, -5.0),
                vec2(5.0, -3.0),
            ][quarters.rem_euclid(4) as usize];
            assert_eq!(turned, want, "{quarters} quarter turns");
        }
    }

    #[test]
    fn half_a_turn_is_positive_from_either_side() {
        for sine in [0.0, -0.0, 1e-17, -1e-17, 5e-324, -5e-324] {
            let half = Rot::from_cos_sin(-1.0, sine);
            let found = (half.angle(), half.degrees());
            assert_eq!(found, (core::f64::consts::PI, 180.0), "sine {sine:e}");
        }
        let less = Rot::from_cos_sin(-1.0, -1e-12);
        assert!(less.angle() < 0.0 && less.degrees() < 0.0, "{less:?}");
    }

    #[test]
    fn short_and_long_directions_are_directions() {
        for length in [5e-324, 1e-310, 1e-170, 1e-155, 1.0, 1e155, 3e307] {
            let found = Rot::from_direction(vec2(0.0, -length));
            let down = Rot::from_degrees(-90.0);
            assert_eq!(found, Some(down), "{length:e}");
            let found = Rot::from_direction(vec2(3.0, 4.0) * length);
            let off = found.map(|rot| (rot * Vec2::X - vec2(0.6, 0.8)).length());
            assert!(off.is_some_and(|off| off < 1e-15), "{length:e}: {off:?}");
        }
        for none in [Vec2::ZERO, Vec2::NAN, vec2(f64::INFINITY, 0.0)] {
            assert_eq!(Rot::from_direction(none), None, "{none}");
        }
    }

    #[test]
    fn a_million_small_turns_stay_a_rotation() {
        let mut rot = Rot::IDENTITY;
        let step = 1e-3;
        for _ in 0..1_000_000 {
            rot = rot.turned(step);
        }
        let length = (rot.cos * rot.cos + rot.sin * rot.sin).sqrt();
        assert!((length - 1.0).abs() < 1e-15, "length {length}");
        let drift = (rot * Rot::from_angle(1_000_000.0 * step).inverse()).angle();
        assert!(drift.abs() < 1e-11, "angle drifted by {drift:e} rad");
    }

    proptest! {
        #[test]
        fn angle_is_the_inverse_of_from_angle(angle in -3.1..3.1_f64) {
            prop_assert!((Rot::from_angle(angle).angle() - angle).abs() < 1e-15);
        }

        #[test]
        fn degrees_are_the_inverse_of_from_degrees(degrees in -179.9..180.0_f64, quarters in -1..=2_i32) {
            prop_assert!((Rot::from_degrees(degrees).degrees() - degrees).abs() < 1e-13);
            let exact = 90.0 * f64::from(quarters);
            prop_assert_eq!(Rot::from_degrees(exact).degrees(), exact);
        }

        #[test]
        fn two_at_once_turn_as_one_after_the_other(start in -4.0..4.0_f64, a in -2.0..2.0_f64, b in -2.0..2.0_f64) {
            let rotations = [Rot::from_angle(start), Rot::from_angle(1.0 - start)];
            for angles in [[a, b], [a, 0.0], [0.0, 0.0], [0.1 * a, 0.1 * b]] {
                let one_by_one = [0, 1].map(|k| rotations[k].turned(angles[k]));
                prop_assert_eq!(Rot::turned_pair(rotations, angles), one_by_one);
            }
        }

        #[test]
        fn inverse_mul_undoes_mul(angle in -100.0..100.0_f64, x in -1e3..1e3_f64, y in -1e3..1e3_f64) {
            let rot = Rot::from_angle(angle);
            prop_assert!((rot.inverse_mul(rot * vec2(x, y)) - vec2(x, y)).length() < 1e-12);
        }
    }
}
