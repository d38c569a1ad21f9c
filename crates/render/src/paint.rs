//! Whole frames to pixels, by either engine.

use tiny_skia::PixmapMut;

use crate::own::Own;
use crate::raster::Canvas;
use crate::skia::{Paths, Pen};
use crate::{Engine, Frame, Picture, PixelBox, Style};

/// Paints all marks of a frame over a picture of its size.
pub(crate) fn paint(frame: &Frame, style: &Style, engine: Engine, picture: &mut Picture) {
    match engine {
        Engine::Own => {
            let size = picture.size();
            let (pixels, _) = picture.rgba_mut().as_chunks_mut();
            let mut canvas = Canvas {
                pixels,
                width: size.width() as usize,
                clip: PixelBox::of(size),
            };
            let mut own = Own::default();
            for mark in frame.marks() {
                own.mark(mark, style, &mut canvas, size);
            }
        }
        Engine::TinySkia => by_skia(frame, style, picture),
    }
}

fn by_skia(frame: &Frame, style: &Style, picture: &mut Picture) {
    let size = picture.size();
    let Some(map) = PixmapMut::from_bytes(picture.rgba_mut(), size.width(), size.height()) else {
        return;
    };
    let mut paths = Paths::default();
    let mut pen = Pen::new(&mut paths, style, size, map);
    for op in frame.ops() {
        pen.op(op);
    }
}

#[cfg(test)]
#[path = "paint_tests.rs"]
mod tests;
