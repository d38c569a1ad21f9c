//! Whole frames to pixels, by either engine.

use core::hint::black_box;
use core::ops::Range;

use tiny_skia::PixmapMut;

use crate::own::{Own, packed};
use crate::raster::{Canvas, Pixel};
use crate::skia::{Paths, Pen};
use crate::tiles::Tiles;
use crate::{Colour, Engine, Frame, Op, Picture, PixelBox, Size, Style};

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
    /// The marks that touch each sheet, lowest first.
    marks: Vec<Vec<u32>>,
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
        for (marks, top) in self.marks.iter().zip((0..).step_by(rows as usize)) {
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
            let mut read = 0.0;
            for (i, &index) in marks.iter().enumerate() {
                // A sheet's marks lie scattered in the list: what comes soon is read already, so that it is near by then.
                let coming =
                    |ahead: usize| marks.get(i + ahead).map(|&k| frame.mark(k as usize).op);
                read +=
                    coming(2 * AHEAD).map_or(0.0, peek) + coming(AHEAD).map_or(0.0, peek_points);
                let index = index as usize;
                let mark = (index, frame.mark(index));
                self.own.mark(mark, style, &mut canvas, size);
            }
            black_box(read);
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
        tiles.each(PixelBox::of(size), |run| base.restore(pixels, run, size));
        self.own.start();
        for index in range {
            let mark = frame.mark(index);
            tiles.each(mark.pixels(style, size), |clip| {
                let mut canvas = Canvas {
                    pixels,
                    width: size.width() as usize,
                    clip,
                };
                self.own.mark((index, mark), style, &mut canvas, size);
            });
        }
    }

    /// Lists the marks of each sheet.
    fn sort(&mut self, frame: &Frame, range: Range<usize>, style: &Style, rows: u32) {
        let size = frame.size();
        let count = size.height().div_ceil(rows) as usize;
        self.marks.resize(count, Vec::new());
        for marks in &mut self.marks {
            marks.clear();
        }
        for index in range {
            let seen = frame.mark(index).pixels(style, size);
            let index = u32::try_from(index).unwrap_or(u32::MAX);
            if !seen.is_empty() {
                for sheet in seen.top / rows..=(seen.bottom - 1) / rows {
                    self.marks[sheet as usize].push(index);
                }
            }
        }
    }
}

/// Marks between reading the points of one for the first time and painting it.
const AHEAD: usize = 4;

/// Reads some number of a mark.
#[inline]
fn peek(op: &Op) -> f64 {
    match op {
        Op::Area { points, .. } | Op::Polygon { points, .. } => {
            f64::from(u8::from(points.is_empty()))
        }
        Op::Disc { centre, .. } | Op::Dot { centre, .. } => centre.x,
        _ => 0.0,
    }
}

/// Reads some number of a mark's points.
#[inline]
fn peek_points(op: &Op) -> f64 {
    match op {
        Op::Area { points, .. } | Op::Polygon { points, .. } => points.first().map_or(0.0, |p| p.x),
        _ => 0.0,
    }
}

/// Rows of a sheet.
fn rows(size: Size) -> u32 {
    let near = u32::try_from(NEAR).unwrap_or(u32::MAX) / (4 * size.width());
    near.clamp(16, size.height().max(16))
}

#[cfg(test)]
#[path = "paint_tests.rs"]
mod tests;
