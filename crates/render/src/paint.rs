//! Whole frames to pixels, by either engine.

use core::ops::Range;

use carom_math::Vec2;
use tiny_skia::PixmapMut;

use crate::own::{Own, packed};
use crate::painter::BAND;
use crate::raster::{Canvas, Pixel};
use crate::skia::{Paths, Pen};
use crate::tiles::Tiles;
use crate::{Colour, Engine, Frame, Ink, Mark, Op, Paint, Picture, PixelBox, Size, Style};

/// Bytes of a picture that are painted at a time: half of a processor's second cache, so that the pixels of scattered
/// marks are near.
const NEAR: usize = 1 << 18;

/// Paints all marks of a frame on a ground of the style's colour.
pub(crate) fn paint(frame: &Frame, style: &Style, engine: Engine, picture: &mut Picture) {
    picture.shape(frame.size());
    let ground = style.background.with_alpha(255);
    match engine {
        Engine::Own => {
            let all = 0..frame.ops().len();
            Sheets::default().paint(frame, all, style, Base::Colour(ground), picture.rgba_mut());
        }
        Engine::TinySkia => by_skia(frame, style, ground, picture.rgba_mut()),
    }
}

/// Paints by tiny-skia alone; `bytes` are as many as the frame has.
pub(crate) fn by_skia(frame: &Frame, style: &Style, ground: Colour, bytes: &mut [u8]) {
    let size = frame.size();
    let (pixels, _) = bytes.as_chunks_mut();
    pixels.fill(packed(ground).to_le_bytes());
    let Some(map) = PixmapMut::from_bytes(bytes, size.width(), size.height()) else {
        return;
    };
    let mut paths = Paths::default();
    let mut pen = Pen::new(&mut paths, style, size, map);
    for op in frame.ops() {
        pen.op(op);
    }
}

/// What marks are painted on.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Base<'a> {
    /// One colour.
    Colour(Colour),
    /// A picture of the frame's size.
    Layer(&'a [u8]),
}

impl Base<'_> {
    /// Puts the base back into a rectangle.
    fn restore(self, pixels: &mut [Pixel], clip: PixelBox, size: Size) {
        let width = size.width() as usize;
        let columns = clip.left as usize..clip.right as usize;
        let rows = (clip.top as usize..clip.bottom as usize).map(|row| row * width);
        match self {
            Self::Colour(colour) => {
                let pixel = packed(colour).to_le_bytes();
                for row in rows {
                    pixels[row + columns.start..row + columns.end].fill(pixel);
                }
            }
            Self::Layer(bytes) => {
                let (layer, _) = bytes.as_chunks();
                for row in rows {
                    let range = row + columns.start..row + columns.end;
                    pixels[range.clone()].copy_from_slice(&layer[range]);
                }
            }
        }
    }
}

/// The own painter, a sheet of rows at a time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sheets {
    own: Own,
    sheets: Vec<Sheet>,
    /// Marks that touch each sheet where it is painted again, and their boxes.
    marks: Vec<Vec<(u32, PixelBox)>>,
}

impl Sheets {
    /// Paints some marks of a frame on a base; `bytes` are as many as the frame has.
    pub(crate) fn paint(
        &mut self,
        frame: &Frame,
        range: Range<usize>,
        style: &Style,
        base: Base<'_>,
        bytes: &mut [u8],
    ) {
        let size = frame.size();
        let (pixels, _) = bytes.as_chunks_mut();
        let rows = rows(size);
        self.sort(frame, range, style, rows);
        self.own.start();
        for (sheet, top) in self.sheets.iter().zip((0..).step_by(rows as usize)) {
            let clip = PixelBox {
                top,
                bottom: size.height().min(top + rows),
                ..PixelBox::of(size)
            };
            base.restore(pixels, clip, size);
            let mut canvas = Canvas {
                pixels,
                width: size.width() as usize,
                clip,
            };
            for item in &sheet.items {
                let index = item.index as usize;
                let mut hand = self.own.hand((index, item.sound), style, &mut canvas, size);
                match item.what {
                    What::Polygon(points, paint) => hand.polygon(sheet.points(points), paint),
                    What::Area(points, ink) => hand.area(sheet.points(points), ink),
                    What::Disc(centre, radius, paint) => hand.round(centre, radius, paint),
                    What::Dot(centre, radius, ink) => hand.dot(centre, radius, ink),
                    What::Other => hand.op(&frame.ops()[index]),
                }
            }
        }
    }

    /// Paints some marks of a frame again where tiles are marked.
    pub(crate) fn repaint(
        &mut self,
        frame: &Frame,
        range: Range<usize>,
        style: &Style,
        base: Base<'_>,
        (tiles, bytes): (&Tiles, &mut [u8]),
    ) {
        let size = frame.size();
        let (pixels, _) = bytes.as_chunks_mut();
        // Whole rows of tiles, so that a tile lies in one sheet.
        let rows = rows(size).next_multiple_of(BAND);
        for marks in &mut self.marks {
            marks.clear();
        }
        self.marks
            .resize(size.height().div_ceil(rows) as usize, Vec::new());
        for index in range {
            let seen = frame.mark(index).pixels(style, size);
            if !seen.is_empty() && tiles.touch(seen) {
                for sheet in seen.top / rows..=(seen.bottom - 1) / rows {
                    self.marks[sheet as usize].push((narrow(index), seen));
                }
            }
        }
        self.own.start();
        for (marks, top) in self.marks.iter().zip((0..).step_by(rows as usize)) {
            let sheet = PixelBox {
                top,
                bottom: size.height().min(top + rows),
                ..PixelBox::of(size)
            };
            tiles.each(sheet, |run| base.restore(pixels, run, size));
            for &(index, seen) in marks {
                let index = index as usize;
                tiles.each(seen.common(sheet), |clip| {
                    let mut canvas = Canvas {
                        pixels,
                        width: size.width() as usize,
                        clip,
                    };
                    self.own
                        .mark((index, frame.mark(index)), style, &mut canvas, size);
                });
            }
        }
    }

    /// Hands each sheet its marks, lowest first.
    fn sort(&mut self, frame: &Frame, range: Range<usize>, style: &Style, rows: u32) {
        let size = frame.size();
        let count = size.height().div_ceil(rows) as usize;
        self.sheets.resize(count, Sheet::default());
        for sheet in &mut self.sheets {
            sheet.items.clear();
            sheet.points.clear();
        }
        for index in range {
            let mark = frame.mark(index);
            let seen = mark.pixels(style, size);
            if !seen.is_empty() {
                for sheet in seen.top / rows..=(seen.bottom - 1) / rows {
                    self.sheets[sheet as usize].add(index, mark);
                }
            }
        }
    }
}

/// The marks that touch a sheet, lowest first. Of those that there may be many of it has a copy: they lie scattered in
/// the frame, and to wait for each of them took a quarter of the time of 100,000.
#[derive(Clone, Debug, Default)]
struct Sheet {
    items: Vec<Item>,
    points: Vec<Vec2>,
}

/// A mark, or which mark it is.
#[derive(Clone, Copy, Debug)]
struct Item {
    index: u32,
    /// Whether its rings are known not to cross themselves.
    sound: bool,
    what: What,
}

/// First of some points, and how many they are.
type Points = (u32, u32);

#[derive(Clone, Copy, Debug)]
enum What {
    Polygon(Points, Paint),
    Area(Points, Ink),
    Disc(Vec2, f64, Paint),
    Dot(Vec2, f64, Ink),
    Other,
}

impl Sheet {
    fn add(&mut self, index: usize, mark: Mark<'_>) {
        /// Most points that are copied: 256 bytes.
        const FEW: usize = 16;
        let what = match mark.op {
            Op::Polygon { points, paint } if points.len() <= FEW => {
                What::Polygon(self.copy(points), *paint)
            }
            Op::Area { points, ink } if points.len() <= FEW => What::Area(self.copy(points), *ink),
            &Op::Disc {
                centre,
                radius,
                paint,
            } => What::Disc(centre, radius, paint),
            &Op::Dot {
                centre,
                radius,
                ink,
            } => What::Dot(centre, radius, ink),
            _ => What::Other,
        };
        self.items.push(Item {
            index: narrow(index),
            sound: mark.is_sound(),
            what,
        });
    }

    fn copy(&mut self, points: &[Vec2]) -> Points {
        let first = self.points.len();
        self.points.extend_from_slice(points);
        (narrow(first), narrow(points.len()))
    }

    fn points(&self, (first, count): Points) -> &[Vec2] {
        &self.points[first as usize..][..count as usize]
    }
}

/// A number of marks or of their points: 2^32 of them would fill 64 GiB.
fn narrow(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Rows of a sheet.
fn rows(size: Size) -> u32 {
    let near = u32::try_from(NEAR).unwrap_or(u32::MAX) / (4 * size.width());
    near.clamp(16, size.height().max(16))
}

#[cfg(test)]
#[path = "paint_tests.rs"]
mod tests;
