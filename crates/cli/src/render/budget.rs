//! What a film may ask for, checked as products before anything is drawn or written.

use carom_render::{FrameRate, Size};

use crate::exit::{Failure, fail};
use crate::number::number;

/// Most frames of a film: more than four hours at 60 frames per second.
const MAX_FRAMES: f64 = 1e6;

/// Most pixels of a film, all frames together: four hours of 1280 x 720 at 60 per second; hours of painting on one core.
const MAX_PIXELS: u64 = 1_000_000_000_000;

/// Most pixels on all drawing threads together: a thread takes 8 to 18 bytes a pixel for pictures, packed ones and those that wait, 1.2 GB here.
const MAX_AT_ONCE: usize = 1 << 26;

/// Frames of so many seconds, one at least, if all of them together are within the limits.
pub(crate) fn frames(seconds: f64, rate: FrameRate, size: Size) -> Result<u64, Failure> {
    let count = (seconds * f64::from(rate.get())).round();
    if count > MAX_FRAMES {
        fail!(
            "{} s at {} frames per second are {count:e} frames, more than {MAX_FRAMES:e}",
            number(seconds),
            rate.get()
        );
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 1e6"
    )]
    let frames = (count as u64).max(1);
    // At most 2^20 frames of 2^26 pixels: no overflow.
    let pixels = frames * size.pixels() as u64;
    if pixels > MAX_PIXELS {
        fail!(
            "{} s at {} per second of {size} px are {pixels} pixels, over the limit of {MAX_PIXELS}: fewer seconds, --fps or --size",
            number(seconds),
            rate.get()
        );
    }
    Ok(frames)
}

/// Threads that draw, at most so many: no more than there are frames, and than their pictures leave room for.
pub(crate) fn threads(asked: usize, frames: u64, size: Size) -> usize {
    let frames = usize::try_from(frames).unwrap_or(usize::MAX);
    asked.min(frames).min(MAX_AT_ONCE / size.pixels()).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(width: u32, height: u32) -> Size {
        Size::new(width, height).unwrap()
    }

    #[test]
    fn a_film_is_bounded_by_the_product_of_all_that_it_is_made_of() {
        let rate = FrameRate::per_second(60).unwrap();
        assert_eq!(frames(0.0, rate, size(800, 600)).unwrap(), 1);
        assert_eq!(frames(14_400.0, rate, size(1280, 720)).unwrap(), 864_000);
        // Each factor is within its own limit.
        let error = frames(14_400.0, rate, size(1920, 1080)).unwrap_err().line();
        assert!(
            error.contains("1920 x 1080 px are 1791590400000 pixels"),
            "{error}"
        );
        assert_eq!(frames(240.0, rate, size(8192, 8192)).unwrap(), 14_400);
        assert!(frames(300.0, rate, size(8192, 8192)).is_err());
        assert!(frames(1e300, rate, size(1, 1)).unwrap_err().line().len() < 100);
    }

    #[test]
    fn threads_are_no_more_than_their_pictures_have_room_for() {
        assert_eq!(threads(8, 600, size(3840, 2160)), 8);
        assert_eq!(threads(1024, 10_000, size(3840, 2160)), 8);
        assert_eq!(threads(1024, 10_000, size(8192, 8192)), 1);
        assert_eq!(threads(8, 3, size(80, 60)), 3);
    }
}
