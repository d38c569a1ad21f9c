//! Uncompressed film for encoders: YUV4MPEG2, the format that film tools read from a pipe.

use std::io::{self, Write};

use crate::{FrameRate, Picture, RenderError, Size};

/// How much colour a film keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Chroma {
    /// One colour for two by two pixels (4:2:0): half the bytes, what most players expect.
    #[default]
    Quarter,
    /// A colour for every pixel (4:4:4).
    Full,
}

/// A stream of frames in YUV4MPEG2, in studio range (luma 16..=235), by whole numbers only.
///
/// The format has no tag for the weights of colours. Players tell them by the size, and so does the film: Rec. 709 from
/// 1280 pixels a row or more than 576 rows on, Rec. 601 below.
///
/// # Examples
/// ```
/// use carom_render::{Chroma, Colour, Film, FrameRate, Picture, Size};
/// let size = Size::new(4, 2)?;
/// let mut film = Film::new(Vec::new(), size, FrameRate::per_second(25)?, Chroma::Quarter)?;
/// film.push(&Picture::new(size, Colour::WHITE))?;
/// let bytes = film.finish()?;
/// assert!(bytes.starts_with(b"YUV4MPEG2 W4 H2 F25:1 Ip A1:1 C420jpeg\nFRAME\n\xEB\xEB"));   // white is 235
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Debug)]
pub struct Film<W: Write> {
    out: W,
    size: Size,
    chroma: Chroma,
    weights: &'static Weights,
    frames: u64,
    /// One frame, used again and again.
    planes: Vec<u8>,
}

impl<W: Write> Film<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// [`RenderError::Io`] from the stream.
    pub fn new(
        mut out: W,
        size: Size,
        rate: FrameRate,
        chroma: Chroma,
    ) -> Result<Self, RenderError> {
        let name = match chroma {
            Chroma::Quarter => "420jpeg",
            Chroma::Full => "444",
        };
        let (width, height, rate) = (size.width(), size.height(), rate.get());
        writeln!(
            out,
            "YUV4MPEG2 W{width} H{height} F{rate}:1 Ip A1:1 C{name}"
        )
        .map_err(broken)?;
        Ok(Self {
            out,
            size,
            chroma,
            weights: Weights::of(size),
            frames: 0,
            planes: Vec::new(),
        })
    }

    /// Appends a picture.
    ///
    /// # Errors
    /// [`RenderError::SizeChanged`] if its size is not the film's, [`RenderError::Io`] from the stream.
    pub fn push(&mut self, picture: &Picture) -> Result<(), RenderError> {
        if picture.size() != self.size {
            return Err(RenderError::SizeChanged {
                index: self.frames,
                expected: self.size,
                found: picture.size(),
            });
        }
        self.planes.clear();
        let Weights {
            luma: parts,
            blue,
            red,
        } = *self.weights;
        let pixels = picture.rgba().chunks_exact(4);
        self.planes.extend(pixels.map(|pixel| luma(parts, pixel)));
        for weights in [blue, red] {
            match self.chroma {
                Chroma::Full => {
                    let plane = picture.rgba().chunks_exact(4);
                    self.planes.extend(
                        plane.map(|p| difference(weights, [p[0], p[1], p[2]].map(i32::from), 1)),
                    );
                }
                Chroma::Quarter => quarter_plane(picture, weights, &mut self.planes),
            }
        }
        self.out
            .write_all(b"FRAME\n")
            .and_then(|()| self.out.write_all(&self.planes))
            .map_err(broken)?;
        self.frames += 1;
        Ok(())
    }

    /// Frames so far.
    #[must_use]
    pub const fn frames(&self) -> u64 {
        self.frames
    }

    /// Flushes the stream and hands it back.
    ///
    /// # Errors
    /// [`RenderError::Io`] from the stream.
    pub fn finish(mut self) -> Result<W, RenderError> {
        self.out.flush().map_err(broken)?;
        Ok(self.out)
    }
}

/// Weights of red, green and blue in 1/256, of studio range. Those of luma add up to 220, for white to be 235; those of
/// a difference to 0, so that grey has no colour.
#[derive(Debug)]
struct Weights {
    luma: [u32; 3],
    blue: [i32; 3],
    red: [i32; 3],
}

/// Luma 16 + 219 (0.299 R + 0.587 G + 0.114 B) / 255.
const REC_601: Weights = Weights {
    luma: [66, 129, 25],
    blue: [-38, -74, 112],
    red: [112, -94, -18],
};

/// Luma 16 + 219 (0.2126 R + 0.7152 G + 0.0722 B) / 255.
const REC_709: Weights = Weights {
    luma: [47, 157, 16],
    blue: [-26, -86, 112],
    red: [112, -102, -10],
};

impl Weights {
    /// What players take a film of this size for: 576 rows are the most of a standard definition.
    const fn of(size: Size) -> &'static Self {
        if size.width() >= 1280 || size.height() > 576 {
            &REC_709
        } else {
            &REC_601
        }
    }
}

/// Rounded to the nearest.
fn luma(weights: [u32; 3], pixel: &[u8]) -> u8 {
    let [red, green, blue] = [pixel[0], pixel[1], pixel[2]].map(u32::from);
    let scaled = weights[0] * red + weights[1] * green + weights[2] * blue + 128;
    u8::try_from(16 + (scaled >> 8)).unwrap_or(235)
}

/// Colour difference of `count` pixels with channels that add up to `sum`: 128 is none.
fn difference(weights: [i32; 3], sum: [i32; 3], count: i32) -> u8 {
    let scaled = weights[0] * sum[0] + weights[1] * sum[1] + weights[2] * sum[2];
    // Rounded to the nearest; the shift of a negative number rounds down, the half makes it the nearest.
    let value = 128 + (scaled + 128 * count).div_euclid(256 * count);
    u8::try_from(value.clamp(16, 240)).unwrap_or(128)
}

/// Means of two by two pixels; an odd last row or column stands for itself.
fn quarter_plane(picture: &Picture, weights: [i32; 3], out: &mut Vec<u8>) {
    let (width, height) = (
        picture.size().width() as usize,
        picture.size().height() as usize,
    );
    let rgba = picture.rgba();
    for y in (0..height).step_by(2) {
        for x in (0..width).step_by(2) {
            let (mut sum, mut count) = ([0; 3], 0);
            for row in y..(y + 2).min(height) {
                for column in x..(x + 2).min(width) {
                    let at = 4 * (row * width + column);
                    for channel in 0..3 {
                        sum[channel] += i32::from(rgba[at + channel]);
                    }
                    count += 1;
                }
            }
            out.push(difference(weights, sum, count));
        }
    }
}

fn broken(source: io::Error) -> RenderError {
    RenderError::Io {
        action: "write",
        path: "the film".into(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Colour;
    use proptest::prelude::*;

    fn one_frame(width: u32, height: u32, colour: Colour, chroma: Chroma) -> Vec<u8> {
        let size = Size::new(width, height).unwrap();
        let mut film =
            Film::new(Vec::new(), size, FrameRate::per_second(30).unwrap(), chroma).unwrap();
        film.push(&Picture::new(size, colour)).unwrap();
        film.finish().unwrap()
    }

    #[test]
    fn known_colours() {
        // Studio range: black, white, pure red, green and blue.
        let known = [
            (0x000000, [16, 128, 128], [16, 128, 128]),
            (0xFFFFFF, [235, 128, 128], [235, 128, 128]),
            (0xFF0000, [82, 90, 240], [63, 102, 240]),
            (0x00FF00, [144, 54, 34], [173, 42, 26]),
            (0x0000FF, [41, 240, 110], [32, 240, 118]),
        ];
        for (rgb, small, large) in known {
            for ((width, height), yuv) in [
                ((1, 1), small),
                ((1279, 1), small),
                ((1, 576), small),
                ((1280, 1), large),
                ((1, 577), large),
            ] {
                let bytes = one_frame(width, height, Colour::hex(rgb), Chroma::Full);
                let pixels = (width * height) as usize;
                let planes = &bytes[bytes.len() - 3 * pixels..];
                for (plane, right) in planes.chunks(pixels).zip(yuv) {
                    let apart = i32::from(plane[0]).abs_diff(right);
                    assert!(
                        apart <= 1 && plane.iter().all(|&b| b == plane[0]),
                        "{rgb:06x} in {width} x {height}: {}, expected {right}",
                        plane[0]
                    );
                }
            }
        }
    }

    #[test]
    fn a_pipe_that_closes_is_an_error() {
        let size = Size::new(64, 64).unwrap();
        let mut room = [0_u8; 100];
        let mut film = Film::new(
            &mut room[..],
            size,
            FrameRate::per_second(1).unwrap(),
            Chroma::Full,
        )
        .unwrap();
        assert!(film.push(&Picture::new(size, Colour::WHITE)).is_err());
    }

    /// A stream that breaks at a write, after taking half of it.
    #[derive(Debug)]
    struct Breaking {
        writes: u32,
        taken: Vec<u8>,
    }

    impl Write for Breaking {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.writes == 0 {
                self.taken.extend(&bytes[..bytes.len() / 2]);
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.writes -= 1;
            self.taken.extend(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            match self.writes {
                0 => Err(io::ErrorKind::StorageFull.into()),
                _ => Ok(()),
            }
        }
    }

    #[test]
    fn a_stream_that_breaks_at_any_write_is_an_error_and_holds_a_beginning_of_the_film() {
        let size = Size::new(6, 4).unwrap();
        let rate = FrameRate::per_second(30).unwrap();
        let film = |out: &mut Breaking| -> Result<(), RenderError> {
            let mut film = Film::new(out, size, rate, Chroma::Quarter)?;
            for grey in [0, 90, 200] {
                film.push(&Picture::new(size, Colour::rgb(grey, 0, 7)))?;
            }
            film.finish().map(|_| ())
        };
        let sink = |writes| Breaking {
            writes,
            taken: Vec::new(),
        };
        let mut whole = sink(u32::MAX);
        film(&mut whole).unwrap();
        for writes in 0.. {
            let mut broken = sink(writes);
            let outcome = film(&mut broken);
            assert!(whole.taken.starts_with(&broken.taken), "{writes} writes");
            match outcome {
                Err(error) => {
                    let said = error.to_string();
                    assert_eq!(said, "cannot write the film: no storage space");
                }
                Ok(()) => {
                    assert!(writes > 6, "{writes} writes");
                    assert_eq!(broken.taken, whole.taken);
                    break;
                }
            }
        }
    }

    proptest! {
        #[test]
        fn frames_have_their_size_and_grey_no_colour(width in 1..9_u32, height in 1..9_u32, grey: u8) {
            for (chroma, planes) in [
                (Chroma::Full, 3 * width * height),
                (Chroma::Quarter, width * height + 2 * width.div_ceil(2) * height.div_ceil(2)),
            ] {
                let bytes = one_frame(width, height, Colour::rgb(grey, grey, grey), chroma);
                let head = bytes.iter().position(|&b| b == b'\n').unwrap() + 1;
                prop_assert_eq!(bytes.len(), head + 6 + planes as usize);
                let luma = (width * height) as usize;
                prop_assert!(bytes[head + 6 + luma..].iter().all(|&b| b == 128));
            }
        }
    }
}
