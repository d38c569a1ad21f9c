//! Cross products in the plane.

use crate::{Vec2, vec2};

/// The z component of `a × b`: positive when `b` lies counter-clockwise of `a`.
#[must_use]
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// `w × v` for a spin `w` about z: the velocity of a point at `v` from the axis; `v × w` is its negative.
#[must_use]
pub fn cross_scalar(w: f64, v: Vec2) -> Vec2 {
    vec2(-w * v.y, w * v.x)
}

/// `v` turned by +90 degrees.
#[must_use]
pub fn perp(v: Vec2) -> Vec2 {
    vec2(-v.y, v.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn x_cross_y_points_out_of_the_plane() {
        assert_eq!(cross(Vec2::X, Vec2::Y), 1.0);
        assert_eq!(cross_scalar(2.0, Vec2::X), vec2(-0.0, 2.0));
        assert_eq!(perp(Vec2::X), vec2(-0.0, 1.0));
    }
}
