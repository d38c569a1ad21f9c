//! From metres to pixels: the only place that flips y or narrows to `f32`.

use carom_geometry::Aabb;
use carom_math::{Rot, Vec2, vec2};

use crate::{RenderError, Size};

/// A view of the world: what lies at the middle of the picture, and how large a metre is.
///
/// The world has y up, a picture has y down with its origin at the upper left corner; pixel (i, j) covers
/// i..i+1 and j..j+1.
///
/// # Examples
/// ```
/// use carom_render::Camera;
/// use carom_math::vec2;
/// let camera = Camera::new(vec2(0.0, 1.0), 100.0, 800, 600)?;         // m, px/m, px
/// assert_eq!(camera.point(vec2(0.0, 1.0)), vec2(400.0, 300.0));
/// assert_eq!(camera.point(vec2(1.0, 2.0)), vec2(500.0, 200.0));      // up is less
/// assert_eq!(camera.world(vec2(0.0, 0.0)), vec2(-4.0, 4.0));
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    centre: Vec2,
    scale: f64,
    size: Size,
}

impl Camera {
    /// A camera that looks at `centre` (m) with `scale` pixels per metre, onto `width` x `height` pixels.
    ///
    /// # Errors
    /// [`RenderError::NotFinite`] for the centre, [`RenderError::Scale`] unless the scale is positive and finite, and
    /// the errors of [`Size::new`].
    pub fn new(centre: Vec2, scale: f64, width: u32, height: u32) -> Result<Self, RenderError> {
        let size = Size::new(width, height)?;
        for (name, value) in [("camera centre x", centre.x), ("camera centre y", centre.y)] {
            if !value.is_finite() {
                return Err(RenderError::NotFinite { name, value });
            }
        }
        // An infinite width of a pixel would make every point behind it NaN.
        if !(scale > 0.0 && scale.is_finite() && (1.0 / scale).is_finite()) {
            return Err(RenderError::Scale { value: scale });
        }
        Ok(Self {
            centre,
            scale,
            size,
        })
    }

    /// The camera that shows all of a box (m), as large as it goes; [`Aabb::grown`] leaves room around it.
    ///
    /// # Errors
    /// [`RenderError::EmptyBounds`] unless the box is finite and wider or higher than nothing; else as [`Camera::new`].
    pub fn fit(bounds: Aabb, width: u32, height: u32) -> Result<Self, RenderError> {
        let size = Size::new(width, height)?;
        let Aabb { min, max } = bounds;
        let extent = max - min;
        if !(extent.is_finite() && extent.min_element() >= 0.0 && extent.max_element() > 0.0) {
            return Err(RenderError::EmptyBounds {
                width: extent.x,
                height: extent.y,
            });
        }
        // A side without extent asks for nothing: infinity loses against the other.
        let scales = size.corner() / extent;
        let scale = if scales.x < scales.y {
            scales.x
        } else {
            scales.y
        };
        Self::new(min + 0.5 * extent, scale, width, height)
    }

    /// What lies at the middle of the picture, in metres.
    #[must_use]
    pub const fn centre(&self) -> Vec2 {
        self.centre
    }

    /// Pixels per metre.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.scale
    }

    /// Size of the picture.
    #[must_use]
    pub const fn size(&self) -> Size {
        self.size
    }

    /// The same camera, looking at another point (m).
    ///
    /// # Errors
    /// [`RenderError::NotFinite`] if the point is not finite.
    pub fn looking_at(&self, centre: Vec2) -> Result<Self, RenderError> {
        Self::new(centre, self.scale, self.size.width(), self.size.height())
    }

    /// Where a point of the world (m) is in the picture (px).
    #[must_use]
    pub fn point(&self, world: Vec2) -> Vec2 {
        0.5 * self.size.corner() + self.vector(world - self.centre)
    }

    /// Where a point of the picture (px) is in the world (m).
    #[must_use]
    pub fn world(&self, pixel: Vec2) -> Vec2 {
        let from_middle = pixel - 0.5 * self.size.corner();
        self.centre + vec2(from_middle.x, -from_middle.y) / self.scale
    }

    /// A displacement of the world (m) in the picture (px).
    #[must_use]
    pub fn vector(&self, world: Vec2) -> Vec2 {
        vec2(self.scale * world.x, -self.scale * world.y)
    }

    /// A length of the world (m) in the picture (px).
    #[must_use]
    pub fn length(&self, metres: f64) -> f64 {
        self.scale * metres
    }

    /// How a body turned by `rotation` is turned in the picture, where y points down.
    #[must_use]
    pub fn turn(&self, rotation: Rot) -> Rot {
        rotation.inverse()
    }

    /// What is seen of the world, in metres.
    #[must_use]
    pub fn view(&self) -> Aabb {
        let half = 0.5 * self.size.corner() / self.scale;
        Aabb {
            min: self.centre - half,
            max: self.centre + half,
        }
    }
}

/// A coordinate of the picture, narrowed; callers have clipped it to a few thousand pixels around the canvas.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the one place where a coordinate loses digits: 2^-9 px at 16384 px"
)]
pub(crate) fn narrow(pixels: f64) -> f32 {
    pixels as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fit(min: Vec2, max: Vec2, width: u32, height: u32) -> Result<Camera, RenderError> {
        Camera::fit(Aabb { min, max }, width, height)
    }

    #[test]
    fn bad_cameras_are_refused() {
        for scale in [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, 1e-310] {
            let error = Camera::new(Vec2::ZERO, scale, 10, 10).unwrap_err();
            assert!(
                matches!(error, RenderError::Scale { .. }),
                "{scale}: {error}"
            );
        }
        for centre in [vec2(f64::NAN, 0.0), vec2(0.0, f64::INFINITY)] {
            let error = Camera::new(centre, 1.0, 10, 10).unwrap_err();
            assert!(error.to_string().starts_with("camera centre"), "{error}");
        }
        assert!(Camera::new(Vec2::ZERO, 1.0, 0, 10).is_err());
        assert!(Camera::new(Vec2::ZERO, 1.0, 100_000, 100_000).is_err());
    }

    #[test]
    fn a_fitted_box_touches_two_sides() {
        let camera = fit(vec2(-1.0, 0.0), vec2(3.0, 1.0), 400, 400).unwrap();
        assert_eq!(camera.scale(), 100.0);
        assert_eq!(camera.point(vec2(-1.0, 0.5)), vec2(0.0, 200.0));
        assert_eq!(camera.point(vec2(3.0, 0.5)), vec2(400.0, 200.0));
        // A level segment has no height, and still fits.
        let flat = fit(vec2(0.0, 2.0), vec2(4.0, 2.0), 400, 100).unwrap();
        assert_eq!(flat.scale(), 100.0);
    }

    #[test]
    fn empty_boxes_do_not_fit() {
        let wrong = [
            (Vec2::ZERO, Vec2::ZERO),
            (vec2(1.0, 0.0), vec2(0.0, 1.0)),
            (Vec2::ZERO, vec2(f64::NAN, 1.0)),
            (Vec2::ZERO, vec2(f64::INFINITY, 1.0)),
        ];
        for (min, max) in wrong {
            let error = fit(min, max, 10, 10).unwrap_err();
            assert!(matches!(error, RenderError::EmptyBounds { .. }), "{error}");
        }
    }

    proptest! {
        #[test]
        fn there_and_back(x in -1e3..1e3_f64, y in -1e3..1e3_f64, scale in 1e-3..1e4_f64) {
            let camera = Camera::new(vec2(3.0, -7.0), scale, 640, 480).unwrap();
            let back = camera.world(camera.point(vec2(x, y)));
            // Two roundings at a distance of 1e3 m, one of half the canvas in metres.
            prop_assert!((back - vec2(x, y)).length() <= 1e-12 + 1e-13 * 640.0 / scale);
        }

        #[test]
        fn turning_in_the_world_or_in_the_picture_is_the_same(angle in -10.0..10.0_f64) {
            let camera = Camera::new(Vec2::ZERO, 50.0, 100, 100).unwrap();
            let rotation = Rot::from_angle(angle);
            let local = vec2(0.3, 0.1);
            let world = camera.vector(rotation * local);
            let picture = camera.turn(rotation) * camera.vector(local);
            prop_assert!((world - picture).length() < 1e-13);
        }
    }
}
