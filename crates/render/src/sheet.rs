//! Contact sheets: many pictures small on one, each with a line below.

use carom_math::{Vec2, vec2};

use crate::{Frame, Ink, Label, Op, Picture, RenderError, Size, Style};

/// Pictures in a grid, scaled down by exact means of the area that a pixel covers.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Picture, Sheet, Size, Style};
/// let mut sheet = Sheet::new(2, 60);                                     // columns, px
/// for (grey, caption) in [(0, "t = 0 s"), (128, "t = 1 s"), (255, "t = 2 s")] {
///     sheet.push(&Picture::new(Size::new(120, 80)?, Colour::rgb(grey, grey, grey)), caption)?;
/// }
/// let picture = sheet.paint(&Style::default())?;
/// assert_eq!(picture.size().width(), 2 * 60 + 3 * 12);
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sheet {
    columns: u32,
    width: u32,
    title: String,
    tiles: Vec<(Picture, String)>,
}

/// Room between tiles and around them, in pixels.
const GAP: u32 = 12;
/// Height of a caption's capitals and of the room it takes, in pixels.
const CAPTION: f64 = 8.0;
const CAPTION_ROOM: u32 = 18;
/// The same for the title.
const TITLE: f64 = 12.0;
const TITLE_ROOM: u32 = 34;

impl Sheet {
    /// An empty sheet of `columns` tiles, each `width` pixels wide; 0 counts as 1.
    #[must_use]
    pub fn new(columns: u32, width: u32) -> Self {
        Self {
            columns: columns.max(1),
            width: width.max(1),
            title: String::new(),
            tiles: Vec::new(),
        }
    }

    /// The same with a title above the tiles.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..self
        }
    }

    /// Adds a picture, scaled down to the tile's width (never up).
    ///
    /// # Errors
    /// [`RenderError::SizeChanged`] if its size is not that of the first picture.
    pub fn push(
        &mut self,
        picture: &Picture,
        caption: impl Into<String>,
    ) -> Result<(), RenderError> {
        let small = shrunk(picture, self.tile(picture.size())?);
        if let Some((first, _)) = self.tiles.first()
            && first.size() != small.size()
        {
            return Err(RenderError::SizeChanged {
                index: self.tiles.len() as u64,
                expected: first.size(),
                found: small.size(),
            });
        }
        self.tiles.push((small, caption.into()));
        Ok(())
    }

    /// The size of the whole sheet with `count` pictures of this size: known before any of them is painted.
    ///
    /// # Errors
    /// [`RenderError::NoFrames`] if `count` is 0, [`RenderError::TooLarge`] if the sheet would be.
    ///
    /// # Examples
    /// ```
    /// use carom_render::{Sheet, Size};
    /// let sheet = Sheet::new(4, 100);                                        // columns, px
    /// assert_eq!(sheet.size(Size::new(300, 200)?, 12)?.width(), 4 * 100 + 5 * 12);
    /// assert!(Sheet::new(4, 5000).size(Size::new(5000, 10)?, 12).is_err());
    /// # Ok::<(), carom_render::RenderError>(())
    /// ```
    pub fn size(&self, picture: Size, count: u32) -> Result<Size, RenderError> {
        self.canvas(self.tile(picture)?, count)
    }

    /// The same, with tiles of this size.
    fn canvas(&self, tile: Size, count: u32) -> Result<Size, RenderError> {
        if count == 0 {
            return Err(RenderError::NoFrames);
        }
        let columns = self.columns.min(count);
        let (step_x, step_y) = steps(tile);
        let rows = count.div_ceil(columns);
        Size::new(
            step_x.saturating_mul(columns).saturating_add(GAP),
            step_y.saturating_mul(rows).saturating_add(self.top()),
        )
    }

    /// A picture scaled down to the tile's width.
    fn tile(&self, picture: Size) -> Result<Size, RenderError> {
        let width = self.width.min(picture.width());
        let height = u64::from(picture.height()) * u64::from(width) / u64::from(picture.width());
        Size::new(width, u32::try_from(height).unwrap_or(u32::MAX).max(1))
    }

    /// Height above the first row.
    const fn top(&self) -> u32 {
        if self.title.is_empty() {
            GAP
        } else {
            GAP + TITLE_ROOM
        }
    }

    /// Lays the tiles out, row by row.
    ///
    /// # Errors
    /// [`RenderError::NoFrames`] if there is no picture, [`RenderError::TooLarge`] if the sheet would be.
    pub fn paint(&self, style: &Style) -> Result<Picture, RenderError> {
        let (first, _) = self.tiles.first().ok_or(RenderError::NoFrames)?;
        let count = u32::try_from(self.tiles.len()).unwrap_or(u32::MAX);
        let columns = self.columns.min(count);
        let (tile_width, tile_height) = (first.size().width(), first.size().height());
        let (step_x, step_y) = steps(first.size());
        let top = self.top();
        let mut frame = Frame::new(self.canvas(first.size(), count)?);
        if !self.title.is_empty() {
            let at = vec2(f64::from(GAP), f64::from(GAP) + 1.6 * TITLE);
            frame.push(Label::new(at, self.title.clone(), TITLE, Ink::Text));
        }
        let places = (0..count).map(|i| (GAP + i % columns * step_x, top + i / columns * step_y));
        for ((x, y), (_, caption)) in places.clone().zip(&self.tiles) {
            let (min, max) = (
                vec2(f64::from(x), f64::from(y)),
                vec2(f64::from(x + tile_width), f64::from(y + tile_height)),
            );
            // A border of one pixel around the tile, which covers the inside.
            frame.push(Op::Box {
                min: min - Vec2::splat(1.0),
                max: max + Vec2::splat(1.0),
                fill: Some(Ink::Grid),
                border: None,
                width: 0.0,
                dash: None,
            });
            let at = vec2(min.x, max.y + 1.75 * CAPTION);
            frame.push(Label::new(at, caption.clone(), CAPTION, Ink::Muted));
        }
        let mut sheet = frame.paint(style);
        for ((x, y), (tile, _)) in places.zip(&self.tiles) {
            sheet.place(tile, x, y);
        }
        Ok(sheet)
    }
}

/// From a tile to the next one in its row and in its column.
fn steps(tile: Size) -> (u32, u32) {
    (tile.width() + GAP, tile.height() + CAPTION_ROOM + GAP)
}

/// The picture at a smaller size: every pixel is the mean of the area it covers, in whole numbers.
fn shrunk(picture: &Picture, size: Size) -> Picture {
    if size == picture.size() {
        return picture.clone();
    }
    let (from_width, from_height) = (
        picture.size().width() as usize,
        picture.size().height() as usize,
    );
    let (width, height) = (size.width() as usize, size.height() as usize);
    let mut rgba = Vec::with_capacity(4 * size.pixels());
    // In units where a source pixel is `width` x `height` and a target pixel `from_width` x `from_height`,
    // all borders are whole numbers and a target pixel has the area `from_width` · `from_height`.
    let area = (from_width * from_height) as u64;
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0_u64; 3];
            for (row, row_part) in parts(y, from_height, height) {
                for (column, column_part) in parts(x, from_width, width) {
                    let at = 4 * (row * from_width + column);
                    for (channel, total) in sum.iter_mut().enumerate() {
                        *total += row_part * column_part * u64::from(picture.rgba()[at + channel]);
                    }
                }
            }
            rgba.extend(
                sum.map(|total| u8::try_from((total + area / 2) / area).unwrap_or(u8::MAX)),
            );
            rgba.push(255);
        }
    }
    let mut small = Picture::new(size, crate::Colour::BLACK);
    small.rgba_mut().copy_from_slice(&rgba);
    small
}

/// The source pixels under target pixel `index` along one side, with the length that each shares with it.
fn parts(index: usize, from: usize, to: usize) -> impl Iterator<Item = (usize, u64)> {
    let (start, end) = (index * from, (index + 1) * from);
    (start / to..end.div_ceil(to)).map(move |i| {
        let shared = ((i + 1) * to).min(end) - (i * to).max(start);
        (i, shared as u64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Colour;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn shrinking_keeps_the_mean(width in 1..40_u32, height in 1..40_u32, w in 1..40_u32, h in 1..40_u32, seed: u8) {
            let size = Size::new(width, height).unwrap();
            let noise = (0..4 * size.pixels()).map(|i| (i * i / 3 + i) as u8 ^ seed).collect();
            let picture = Picture::from_rgba(size, noise).unwrap();
            let small = shrunk(&picture, Size::new(w.min(width), h.min(height)).unwrap());
            let mean = |p: &Picture| {
                let sum: f64 = p.to_rgb().iter().map(|&b| f64::from(b)).sum();
                sum / p.size().pixels() as f64 / 3.0
            };
            // Each pixel is rounded by half a step at most.
            prop_assert!((mean(&picture) - mean(&small)).abs() <= 0.5, "{} {}", mean(&picture), mean(&small));
        }
    }

    #[test]
    fn a_sheet_that_would_be_too_large_is_refused() {
        let mut sheet = Sheet::new(1, 2);
        let tall = Picture::new(Size::new(2, 9000).unwrap(), Colour::WHITE);
        sheet.push(&tall, "").unwrap();
        sheet.push(&tall, "").unwrap();
        assert!(matches!(
            sheet.paint(&Style::default()),
            Err(RenderError::TooLarge { .. })
        ));
        assert!(matches!(
            Sheet::new(1, 1).paint(&Style::default()),
            Err(RenderError::NoFrames)
        ));
    }
}
