//! How large a picture may be, and how fast an animation may run.

use core::fmt;

use carom_math::{Vec2, vec2};

use crate::RenderError;

/// Longest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 16_384;

/// Most pixels in a picture: 256 MiB of RGBA.
pub const MAX_PIXELS: u64 = 64 << 20;

/// Highest frame rate, in frames per second.
pub const MAX_RATE: u32 = 1000;

/// Width and height of a picture, in pixels: at least one pixel, and within the limits.
///
/// Checked before anything is allocated, so nothing behind it can fail for its size.
///
/// # Examples
/// ```
/// use carom_render::Size;
/// assert_eq!(Size::new(1280, 720)?.pixels(), 921_600);
/// assert!(Size::new(0, 720).is_err());
/// assert!(Size::new(100_000, 100_000).is_err());
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    width: u32,
    height: u32,
}

impl Size {
    /// A size in pixels.
    ///
    /// # Errors
    /// [`RenderError::NoPixels`] if a side is 0, [`RenderError::TooLarge`] over [`MAX_SIDE`] or [`MAX_PIXELS`].
    pub fn new(width: u32, height: u32) -> Result<Self, RenderError> {
        if width == 0 || height == 0 {
            return Err(RenderError::NoPixels { width, height });
        }
        let pixels = u64::from(width) * u64::from(height);
        if width > MAX_SIDE || height > MAX_SIDE || pixels > MAX_PIXELS {
            return Err(RenderError::TooLarge { width, height });
        }
        Ok(Self { width, height })
    }

    /// Width, in pixels.
    #[must_use]
    pub const fn width(self) -> u32 {
        self.width
    }

    /// Height, in pixels.
    #[must_use]
    pub const fn height(self) -> u32 {
        self.height
    }

    /// Number of pixels.
    #[must_use]
    pub const fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The lower right corner, in pixels.
    #[must_use]
    pub fn corner(self) -> Vec2 {
        vec2(f64::from(self.width), f64::from(self.height))
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} x {}", self.width, self.height)
    }
}

/// A constant number of frames per second, 1 to [`MAX_RATE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate(u16);

impl FrameRate {
    /// `frames` per second.
    ///
    /// # Errors
    /// [`RenderError::FrameRate`] if it is 0 or over [`MAX_RATE`].
    pub fn per_second(frames: u32) -> Result<Self, RenderError> {
        match u16::try_from(frames) {
            Ok(rate) if rate > 0 && frames <= MAX_RATE => Ok(Self(rate)),
            _ => Err(RenderError::FrameRate { value: frames }),
        }
    }

    /// Frames per second.
    #[must_use]
    pub const fn get(self) -> u16 {
        self.0
    }

    /// Time from one frame to the next, in seconds.
    #[must_use]
    pub fn interval(self) -> f64 {
        1.0 / f64::from(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_inclusive() {
        assert!(Size::new(MAX_SIDE, 4096).is_ok());
        assert!(
            Size::new(MAX_SIDE, 4097).is_err(),
            "one row over 64 Mi pixels"
        );
        assert!(Size::new(MAX_SIDE + 1, 1).is_err());
        assert!(Size::new(u32::MAX, u32::MAX).is_err());
        assert_eq!(
            Size::new(100_000, 1).unwrap_err().to_string(),
            "canvas of 100000 x 1 px is over the limit of 16384 px a side and 67108864 px in all"
        );
    }

    #[test]
    fn a_frame_rate_is_positive_and_bounded() {
        assert!(FrameRate::per_second(0).is_err());
        assert!(FrameRate::per_second(1001).is_err());
        assert!(FrameRate::per_second(1_000_000_000).is_err());
        assert_eq!(FrameRate::per_second(25).unwrap().interval(), 0.04);
    }
}
