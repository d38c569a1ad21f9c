//! A finished picture: rows of opaque RGBA bytes.

use crate::{Colour, RenderError, Size};

/// An opaque picture, row by row from the upper left corner, four bytes a pixel (the fourth is 255).
///
/// # Examples
/// ```
/// use carom_render::{Colour, Picture, Size};
/// let picture = Picture::new(Size::new(3, 2)?, Colour::rgb(10, 20, 30));
/// assert_eq!(picture.rgba().len(), 24);
/// assert_eq!(picture.pixel(2, 1), Some(Colour::rgb(10, 20, 30)));
/// assert_eq!(picture.pixel(3, 1), None);
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    size: Size,
    rgba: Vec<u8>,
}

impl Picture {
    /// A picture of one colour; its opacity is ignored.
    #[must_use]
    pub fn new(size: Size, colour: Colour) -> Self {
        let mut picture = Self {
            size,
            rgba: Vec::new(),
        };
        picture.reset(size, colour);
        picture
    }

    /// A picture from bytes, four a pixel; opacity is ignored.
    ///
    /// # Errors
    /// [`RenderError::Bytes`] if there are more or fewer than the size takes.
    pub fn from_rgba(size: Size, mut rgba: Vec<u8>) -> Result<Self, RenderError> {
        let expected = 4 * size.pixels();
        if rgba.len() != expected {
            return Err(RenderError::Bytes {
                size,
                expected,
                found: rgba.len(),
            });
        }
        for pixel in rgba.chunks_exact_mut(4) {
            pixel[3] = 255;
        }
        Ok(Self { size, rgba })
    }

    /// Makes it a picture of one colour, and keeps its memory.
    pub(crate) fn reset(&mut self, size: Size, colour: Colour) {
        let pixel = [colour.red, colour.green, colour.blue, 255];
        self.size = size;
        self.rgba.resize(4 * size.pixels(), 0);
        for place in self.rgba.chunks_exact_mut(4) {
            place.copy_from_slice(&pixel);
        }
    }

    /// Gives it a size, whatever its pixels are then, and keeps its memory.
    pub(crate) fn shape(&mut self, size: Size) {
        self.size = size;
        self.rgba.resize(4 * size.pixels(), 0);
    }

    /// Its size.
    #[must_use]
    pub const fn size(&self) -> Size {
        self.size
    }

    /// The colour of pixel (`x`, `y`), counted from the upper left corner, or `None` outside.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<Colour> {
        if x >= self.size.width() {
            return None;
        }
        let first = 4 * (y as usize * self.size.width() as usize + x as usize);
        let bytes = self.rgba.get(first..first + 4)?;
        Some(Colour::rgb(bytes[0], bytes[1], bytes[2]))
    }

    /// All bytes, four a pixel.
    #[must_use]
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }

    pub(crate) fn rgba_mut(&mut self) -> &mut [u8] {
        &mut self.rgba
    }

    /// All bytes without the opacity, three a pixel.
    #[must_use]
    pub fn to_rgb(&self) -> Vec<u8> {
        let mut rgb = Vec::with_capacity(3 * self.size.pixels());
        for pixel in self.rgba.chunks_exact(4) {
            rgb.extend_from_slice(&pixel[..3]);
        }
        rgb
    }

    /// Copies `other` with its upper left corner to (`x`, `y`); what reaches over the edge is left out.
    pub fn place(&mut self, other: &Self, x: u32, y: u32) {
        let columns = other.size.width().min(self.size.width().saturating_sub(x)) as usize;
        let rows = other
            .size
            .height()
            .min(self.size.height().saturating_sub(y)) as usize;
        let (stride, other_stride) = (
            4 * self.size.width() as usize,
            4 * other.size.width() as usize,
        );
        for row in 0..rows {
            let to = (y as usize + row) * stride + 4 * x as usize;
            let from = row * other_stride;
            self.rgba[to..to + 4 * columns].copy_from_slice(&other.rgba[from..from + 4 * columns]);
        }
    }
}

/// Its size: the bytes would fill pages.
impl core::fmt::Debug for Picture {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Picture")
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn placing_is_cut_at_the_edge() {
        let small = Picture::new(Size::new(2, 2).unwrap(), Colour::WHITE);
        for (x, y, white) in [
            (0, 0, 4),
            (2, 2, 1),
            (3, 0, 0),
            (0, 9, 0),
            (u32::MAX, u32::MAX, 0),
        ] {
            let mut large = Picture::new(Size::new(3, 3).unwrap(), Colour::BLACK);
            large.place(&small, x, y);
            let count = large.rgba().chunks(4).filter(|p| p[0] == 255).count();
            assert_eq!(count, white, "at {x}, {y}");
        }
    }

    #[test]
    fn bytes_must_fit_the_size() {
        let size = Size::new(2, 1).unwrap();
        assert!(Picture::from_rgba(size, vec![0; 7]).is_err());
        let picture = Picture::from_rgba(size, vec![9; 8]).unwrap();
        assert_eq!(picture.to_rgb(), vec![9; 6]);
        assert_eq!(picture.rgba()[3], 255);
    }
}
