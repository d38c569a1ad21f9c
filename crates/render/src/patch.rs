//! What changed from one picture to the next, packed.

use ::png::ColorType;

use crate::png::{encode, image_data};
use crate::{Packing, Picture, PixelBox, Size};

/// How a patch meets what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Blend {
    /// It takes its place.
    Source,
    /// It lies over it: where it is transparent, what was there stays.
    Over,
}

/// What changed from one picture to the next: a frame of an [`Animation`](crate::Animation), packed on any thread.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Packing, Patch, Picture, Size};
/// let before = Picture::new(Size::new(8, 8)?, Colour::WHITE);
/// let mut now = before.clone();
/// now.place(&Picture::new(Size::new(2, 3)?, Colour::BLACK), 4, 1);
/// let patch = Patch::between(Some(&before), &now, Packing::Fast);
/// assert_eq!((patch.place().left, patch.place().bottom), (4, 4));        // px
/// assert!(Patch::between(Some(&now), &now, Packing::Fast).is_empty());
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Patch {
    canvas: Size,
    place: PixelBox,
    blend: Blend,
    empty: bool,
    /// A zlib stream of the place's rows, RGBA.
    data: Vec<u8>,
}

impl Patch {
    /// What turns `before` into `now`; all of `now` if there was nothing before, or a picture of another size.
    #[must_use]
    pub fn between(before: Option<&Picture>, now: &Picture, packing: Packing) -> Self {
        let canvas = now.size();
        let Some(before) = before.filter(|before| before.size() == canvas) else {
            let data = pack(canvas, now.rgba(), packing);
            return Self {
                canvas,
                place: PixelBox::of(canvas),
                blend: Blend::Source,
                empty: false,
                data,
            };
        };
        let place = changed(before, now);
        if place.is_empty() {
            return Self::nothing(canvas, packing);
        }
        let (mut all, mut news) = (Vec::new(), Vec::new());
        for (old, new) in rows(before, place).zip(rows(now, place)) {
            all.extend_from_slice(new);
            for (old, new) in old.chunks_exact(4).zip(new.chunks_exact(4)) {
                news.extend_from_slice(if old == new { &[0; 4] } else { new });
            }
        }
        // The place is part of a canvas that was checked.
        let size = Size::new(place.right - place.left, place.bottom - place.top).unwrap_or(canvas);
        let source = pack(size, &all, packing);
        let over = pack(size, &news, packing);
        let (blend, data) = if over.len() < source.len() {
            (Blend::Over, over)
        } else {
            (Blend::Source, source)
        };
        Self {
            canvas,
            place,
            blend,
            empty: false,
            data,
        }
    }

    /// One transparent pixel: the picture before, once more.
    fn nothing(canvas: Size, packing: Packing) -> Self {
        let place = PixelBox {
            left: 0,
            top: 0,
            right: 1,
            bottom: 1,
        };
        let data = Size::new(1, 1).map_or_else(|_| Vec::new(), |one| pack(one, &[0; 4], packing));
        Self {
            canvas,
            place,
            blend: Blend::Over,
            empty: true,
            data,
        }
    }

    /// Size of the picture.
    #[must_use]
    pub const fn canvas(&self) -> Size {
        self.canvas
    }

    /// The pixels that it may change.
    #[must_use]
    pub const fn place(&self) -> PixelBox {
        self.place
    }

    /// Whether nothing changed.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.empty
    }

    /// Whether it is a picture of its own.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.blend == Blend::Source && self.place == PixelBox::of(self.canvas)
    }

    /// Packed size, in bytes.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.data.len()
    }

    pub(crate) const fn blend(&self) -> Blend {
        self.blend
    }

    pub(crate) fn data(&self) -> &[u8] {
        &self.data
    }
}

fn pack(size: Size, rgba: &[u8], packing: Packing) -> Vec<u8> {
    let png = encode(size, rgba, ColorType::Rgba, packing);
    image_data(&png).collect::<Vec<_>>().concat()
}

/// The rows of a rectangle, four bytes a pixel.
fn rows(picture: &Picture, place: PixelBox) -> impl Iterator<Item = &[u8]> {
    let stride = 4 * picture.size().width() as usize;
    let columns = 4 * place.left as usize..4 * place.right as usize;
    let rows = place.top as usize..place.bottom as usize;
    picture
        .rgba()
        .chunks_exact(stride)
        .take(rows.end)
        .skip(rows.start)
        .map(move |row| &row[columns.clone()])
}

/// The smallest rectangle that holds every pixel that differs.
fn changed(before: &Picture, now: &Picture) -> PixelBox {
    let stride = 4 * now.size().width() as usize;
    let mut place = PixelBox::EMPTY;
    let pairs = before
        .rgba()
        .chunks_exact(stride)
        .zip(now.rgba().chunks_exact(stride));
    for ((old, new), row) in pairs.zip(0..) {
        if old == new {
            continue;
        }
        let differs = |(a, b): (&[u8], &[u8])| a != b;
        let pixels = || old.chunks_exact(4).zip(new.chunks_exact(4));
        let (Some(first), Some(last)) = (pixels().position(differs), pixels().rposition(differs))
        else {
            continue;
        };
        // A column of a picture is below 16384.
        let column = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
        place = place.united(PixelBox {
            left: column(first),
            top: row,
            right: column(last + 1),
            bottom: row + 1,
        });
    }
    place
}
