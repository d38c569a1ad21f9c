//! Pictures that bodies wear: clipped to a disc, turning with it.

use std::sync::Arc;

use carom_math::vec2;

use crate::{Colour, Frame, Ink, Op, RenderError, Size, Style, colour::round_u8, png};

/// Longest side of a face, in pixels.
pub const MAX_FACE_SIDE: u32 = 4096;

/// A picture to be drawn on discs; cheap to clone.
///
/// The largest disc that fits into the middle of the picture is what is seen.
///
/// # Examples
/// ```
/// use carom_render::Face;
/// let smile = Face::smile();
/// assert_eq!((smile.width(), smile.height()), (256, 256));
/// assert!(Face::from_png(b"no picture").is_err());
/// ```
#[derive(Clone)]
pub struct Face {
    /// The picture, then halves of it down to a few pixels: small discs take a small one, so that nothing flickers.
    levels: Arc<Vec<Level>>,
}

/// Premultiplied RGBA, row by row from above.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Level {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) rgba: Vec<u8>,
    /// The same with 16 bits a channel, ready to be mixed, and [`PAD`] more pixels on each side that repeat the border.
    pub(crate) wide: Vec<Texel>,
    /// Whether no pixel lets anything through.
    pub(crate) opaque: bool,
}

/// Pixels that a level's border is repeated by: what lies on the rim of a disc reads so far outside.
pub(crate) const PAD: u32 = 3;

/// Red, green, blue and opacity, 255 at most, with room for products.
pub(crate) type Texel = [u16; 4];

impl Face {
    /// A face from a PNG of any colour type; transparent parts show the body's paint.
    ///
    /// # Errors
    /// [`RenderError::Decode`] if the bytes are no PNG, [`RenderError::TooLarge`] over [`MAX_FACE_SIDE`].
    pub fn from_png(bytes: &[u8]) -> Result<Self, RenderError> {
        let (size, rgba) = png::decode(bytes, MAX_FACE_SIDE)?;
        Ok(Self::from_straight(size, rgba))
    }

    /// The face that comes with the library: drawn by its own painter.
    #[must_use]
    pub fn smile() -> Self {
        let picture = smile_frame(SMILE).paint(&Style::light());
        Self::from_straight(picture.size(), picture.rgba().to_vec())
    }

    fn from_straight(size: Size, mut rgba: Vec<u8>) -> Self {
        for pixel in rgba.chunks_exact_mut(4) {
            let alpha = f64::from(pixel[3]) / 255.0;
            for channel in &mut pixel[..3] {
                *channel = round_u8(f64::from(*channel) * alpha);
            }
        }
        let mut levels = vec![Level::new(size.width(), size.height(), rgba)];
        while let Some(half) = levels.last().and_then(Level::half) {
            levels.push(half);
        }
        Self {
            levels: Arc::new(levels),
        }
    }

    /// Width of the picture, in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.levels[0].width
    }

    /// Height of the picture, in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.levels[0].height
    }

    /// The level to draw on a disc of `radius` pixels, and how many of its pixels make one of the canvas, at most 1
    /// unless the smallest level is still too large.
    pub(crate) fn level(&self, radius: f64) -> (&Level, f64) {
        let mut chosen = &self.levels[0];
        for level in self.levels.iter() {
            if level.scale(radius) > 1.0 {
                break;
            }
            chosen = level;
        }
        (chosen, chosen.scale(radius))
    }

    /// The picture with straight opacity, for files.
    pub(crate) fn straight(&self) -> (Size, Vec<u8>) {
        let level = &self.levels[0];
        let mut rgba = level.rgba.clone();
        for pixel in rgba.chunks_exact_mut(4) {
            let alpha = f64::from(pixel[3].max(1)) / 255.0;
            for channel in &mut pixel[..3] {
                *channel = round_u8(f64::from(*channel) / alpha);
            }
        }
        let size = Size::new(level.width, level.height).expect("checked when the face was made");
        (size, rgba)
    }
}

/// By what they show; clones share their levels, which is asked first.
impl PartialEq for Face {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.levels, &other.levels) || self.levels == other.levels
    }
}

impl core::fmt::Debug for Face {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Face({} x {})", self.width(), self.height())
    }
}

impl Level {
    fn new(width: u32, height: u32, rgba: Vec<u8>) -> Self {
        let (pixels, _) = rgba.as_chunks();
        let within = |place: u32, side: u32| place.saturating_sub(PAD).min(side - 1) as usize;
        let mut wide = Vec::with_capacity((width + 2 * PAD) as usize * (height + 2 * PAD) as usize);
        for y in 0..height + 2 * PAD {
            let row = &pixels[within(y, height) * width as usize..][..width as usize];
            let columns = (0..width + 2 * PAD).map(|x| row[within(x, width)].map(u16::from));
            wide.extend(columns);
        }
        let opaque = pixels.iter().all(|pixel| pixel[3] == 255);
        Self {
            width,
            height,
            rgba,
            wide,
            opaque,
        }
    }

    /// Pixels of the canvas per pixel of this level, if the shorter side spans a disc of `radius`.
    fn scale(&self, radius: f64) -> f64 {
        2.0 * radius / f64::from(self.width.min(self.height))
    }

    /// Means of two by two pixels, or `None` at 4 pixels a side; an odd row or column at the end is dropped.
    fn half(&self) -> Option<Self> {
        let (width, height) = (self.width / 2, self.height / 2);
        if width.min(height) < 4 {
            return None;
        }
        let stride = 4 * self.width as usize;
        let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
        for y in 0..height as usize {
            for x in 0..width as usize {
                for channel in 0..4 {
                    let at = 2 * y * stride + 8 * x + channel;
                    let sum = [at, at + 4, at + stride, at + stride + 4]
                        .iter()
                        .map(|&i| u16::from(self.rgba[i]))
                        .sum::<u16>();
                    rgba.push(u8::try_from((sum + 2) / 4).unwrap_or(u8::MAX));
                }
            }
        }
        Some(Self::new(width, height, rgba))
    }
}

/// Side of the built-in face, in pixels.
const SMILE: u32 = 256;

/// A round face on a square of skin, in units of 1/256 of the side.
fn smile_frame(side: u32) -> Frame {
    const SKIN: Colour = Colour::hex(0xFFCF4A);
    const INK: Colour = Colour::hex(0x3A2A16);
    const BLUSH: Colour = Colour::hex(0xF59A5B);
    let mut frame = Frame::new(Size::new(side, side).expect("within the limits"));
    let dot = |x: f64, y: f64, radius: f64, colour: Colour| Op::Dot {
        centre: vec2(x, y),
        radius,
        ink: Ink::Of(colour),
    };
    frame.push(dot(128.0, 128.0, 200.0, SKIN));
    // A darker rim, so that the face reads as round without an outline.
    for (radius, part) in [(128.0, 0.30), (121.0, 0.16), (114.0, 0.0)] {
        frame.push(dot(
            128.0,
            128.0,
            radius,
            SKIN.mixed(Colour::hex(0xB86A12), part),
        ));
    }
    for x in [62.0, 194.0] {
        frame.push(dot(x, 150.0, 20.0, BLUSH.with_alpha(150)));
    }
    for x in [90.0, 166.0] {
        frame.push(dot(x, 104.0, 17.0, INK));
        frame.push(dot(x - 5.0, 98.0, 5.5, Colour::WHITE));
    }
    // The mouth: an arc from one cheek to the other.
    let mouth = (0..=24_i32)
        .map(|i| {
            let part = f64::from(i) / 12.0 - 1.0;
            vec2(128.0 + 54.0 * part, 190.0 - 38.0 * part * part)
        })
        .collect();
    frame.push(Op::Line {
        points: mouth,
        width: 13.0,
        dash: None,
        ink: Ink::Of(INK),
    });
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_halve_and_keep_the_mean() {
        let face = Face::smile();
        let means: Vec<f64> = face
            .levels
            .iter()
            .map(|level| {
                let sum: f64 = level.rgba.iter().map(|&b| f64::from(b)).sum();
                sum / f64::from(level.width * level.height)
            })
            .collect();
        assert_eq!(means.len(), 7, "256 down to 4");
        // Rounding a half up adds an eighth of a step a channel and level: four channels, six levels.
        for mean in &means {
            assert!((mean - means[0]).abs() < 3.0, "{means:?}");
        }
    }

    #[test]
    fn a_small_disc_takes_a_small_level() {
        let face = Face::smile();
        for (radius, width) in [
            (200.0, 256),
            (128.0, 256),
            (64.0, 128),
            (60.0, 64),
            (3.0, 4),
            (1e-9, 4),
        ] {
            let (level, scale) = face.level(radius);
            assert!(
                level.width >= width && level.width <= 2 * width,
                "{radius}: {}",
                level.width
            );
            assert!(scale <= 1.0 || level.width == 256, "{radius}: {scale}");
        }
    }

    #[test]
    fn too_large_or_broken_faces_are_refused() {
        let wide = crate::Picture::new(Size::new(MAX_FACE_SIDE + 1, 1).unwrap(), Colour::WHITE);
        let error = Face::from_png(&wide.to_png()).unwrap_err();
        assert!(matches!(error, RenderError::TooLarge { .. }), "{error}");
        let good = crate::Picture::new(Size::new(8, 8).unwrap(), Colour::WHITE).to_png();
        for bytes in [
            &good[..0],
            &good[..20],
            &good[..good.len() - 20],
            b"GIF89a".as_slice(),
        ] {
            let error = Face::from_png(bytes).unwrap_err();
            assert!(matches!(error, RenderError::Decode { .. }), "{error}");
        }
    }
}
