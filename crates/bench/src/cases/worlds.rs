//! What the worlds of several cases are made of.

use carom_geometry::{AreaProperties, ConvexPolygon};
use carom_math::{Vec2, trig, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

/// Strength of gravity where there is any, in m/s².
pub(super) const G: f64 = 10.0;

/// Downwards, in m/s².
pub(super) const GRAVITY: Vec2 = vec2(0.0, -G);

/// A fixed box 2 km wide with its top at y = 0.
pub(super) fn floor(scene: &mut PlainScene, material: usize) -> usize {
    let body = PlainBody::new(PlainKind::Fixed, vec2(0.0, -1.0), material);
    scene.add(body, PlainShape::rectangle(1000.0, 1.0))
}

/// The slope of cases 8 and 9: 20 degrees, its top through the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Incline {
    /// In rad.
    pub(super) angle: f64,
    /// Sine of the angle.
    pub(super) sin: f64,
    /// Cosine of the angle.
    pub(super) cos: f64,
}

impl Incline {
    pub(super) fn new() -> Self {
        let angle = 20.0_f64.to_radians();
        let (sin, cos) = trig::sin_cos(angle);
        Self { angle, sin, cos }
    }

    /// Adds the fixed box.
    pub(super) fn add(self, scene: &mut PlainScene, material: usize) -> usize {
        let at = vec2(self.sin, -self.cos);
        let body = PlainBody::new(PlainKind::Fixed, at, material).turned(self.angle);
        scene.add(body, PlainShape::rectangle(200.0, 1.0))
    }

    /// `height` above the origin along the normal, in m.
    pub(super) fn above(self, height: f64) -> Vec2 {
        vec2(-self.sin, self.cos) * height
    }

    /// Unit vector.
    pub(super) fn downhill(self) -> Vec2 {
        -vec2(self.cos, self.sin)
    }
}

/// A moving body at rest, for the builder's methods to go on from.
pub(super) fn dynamic(position: Vec2, material: usize) -> PlainBody {
    PlainBody::new(PlainKind::Dynamic, position, material)
}

/// Corners about their centroid, with area and moments.
///
/// # Panics
/// If they are no convex polygon.
pub(super) fn centred(corners: &[Vec2]) -> (Vec<Vec2>, AreaProperties) {
    let polygon = ConvexPolygon::new(corners).expect("a convex polygon by its definition");
    let area = polygon.area_properties();
    let corners = corners.iter().map(|corner| *corner - area.centroid);
    (corners.collect(), area)
}

/// Root of the mean of squares.
#[expect(clippy::cast_precision_loss, reason = "dozens of numbers")]
pub(super) fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

/// The largest; NaN if one is.
pub(super) fn worst(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, larger)
}

/// The larger of two; NaN if one is, so that a broken run does not look like a good one.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_never_hidden() {
        assert!(worst(&[1.0, f64::NAN, 2.0]).is_nan());
        assert!(worst(&[f64::NAN, 2.0]).is_nan());
        assert!(rms(&[1.0, f64::NAN]).is_nan());
        assert!((worst(&[1.0, 3.0, 2.0]) - 3.0).abs() < 1e-15);
        assert!((rms(&[3.0, 4.0]) - 12.5_f64.sqrt()).abs() < 1e-15);
    }
}
