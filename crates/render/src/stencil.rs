//! What is general: paths through tiny-skia's masks.

use std::collections::BTreeMap;

use tiny_skia::{FillRule, IntSize, Mask, Path, Transform};

use crate::own::packed;
use crate::raster::{Canvas, Flat, Pixel, Shade};
use crate::skia::{Fill, Ground};
use crate::{Colour, PixelBox};

/// What is covered, as bytes, and of what colour.
#[derive(Clone, Debug)]
struct Stencil {
    seen: PixelBox,
    bytes: Vec<u8>,
    colour: Colour,
}

/// Stencils of marks that are painted in several pieces: made once a frame, as a whole, so that pixels do not depend on
/// the pieces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Masks {
    /// The mark at hand, and how many general parts of it were painted.
    key: (usize, usize),
    kept: BTreeMap<(usize, usize), Vec<Stencil>>,
    spare: Vec<u8>,
}

impl Masks {
    /// Forgets what was kept of the marks of another frame.
    pub(crate) fn start(&mut self) {
        self.kept.clear();
    }

    /// Turns to mark number `index`.
    pub(crate) const fn mark(&mut self, index: usize) {
        self.key = (index, 0);
    }

    /// Paints the part at hand if it is known.
    pub(crate) fn again(&mut self, canvas: &mut Canvas<'_>) -> bool {
        self.key.1 += 1;
        let Some(stencils) = self.kept.get(&self.key) else {
            return false;
        };
        for stencil in stencils {
            stencil.paint(canvas);
        }
        true
    }
}

impl Stencil {
    fn paint(&self, canvas: &mut Canvas<'_>) {
        let Self { seen, bytes, .. } = self;
        let clip = seen.common(canvas.clip);
        let mut flat = Flat(packed(self.colour));
        let columns = seen.right - seen.left;
        for y in clip.top..clip.bottom {
            let from = ((y - seen.top) * columns + clip.left - seen.left) as usize;
            let to = y as usize * canvas.width + clip.left as usize;
            let count = (clip.right - clip.left) as usize;
            let pixels = &mut canvas.pixels[to..to + count];
            cover(pixels, &bytes[from..from + count], &mut flat);
        }
    }
}

/// Fills paths by way of a mask as large as what is seen of them.
pub(crate) struct OnMask<'a, 'c> {
    canvas: &'a mut Canvas<'c>,
    masks: &'a mut Masks,
}

impl<'a, 'c> OnMask<'a, 'c> {
    pub(crate) const fn new(canvas: &'a mut Canvas<'c>, masks: &'a mut Masks) -> Self {
        Self { canvas, masks }
    }
}

impl Ground for OnMask<'_, '_> {
    fn fill(&mut self, path: &Path, fill: &Fill<'_>) {
        // Gradients and pictures are never general.
        let &Fill::Flat(colour) = fill else { return };
        let width = self.canvas.width;
        let height = self.canvas.pixels.len() / width.max(1);
        let [width, height] = [width, height].map(|side| u32::try_from(side).unwrap_or(0));
        let bounds = path.bounds();
        let seen = PixelBox {
            left: clamped(bounds.left(), width),
            top: clamped(bounds.top(), height),
            right: clamped(bounds.right() + 1.0, width),
            bottom: clamped(bounds.bottom() + 1.0, height),
        };
        if seen.is_empty() {
            return;
        }
        let (columns, rows) = (seen.right - seen.left, seen.bottom - seen.top);
        let Some(size) = IntSize::from_wh(columns, rows) else {
            return;
        };
        let mut memory = core::mem::take(&mut self.masks.spare);
        memory.clear();
        memory.resize(columns as usize * rows as usize, 0);
        let Some(mut mask) = Mask::from_vec(memory, size) else {
            return;
        };
        #[expect(clippy::cast_precision_loss, reason = "at most 16384")]
        let shift = Transform::from_translate(-(seen.left as f32), -(seen.top as f32));
        mask.fill_path(path, FillRule::Winding, true, shift);
        let bytes = mask.take();
        let stencil = Stencil {
            seen,
            bytes,
            colour,
        };
        stencil.paint(self.canvas);
        if seen.common(self.canvas.clip) == seen {
            self.masks.spare = stencil.bytes;
        } else {
            let key = self.masks.key;
            self.masks.kept.entry(key).or_default().push(stencil);
        }
    }
}

/// Paints a row of pixels as far as a mask covers them.
fn cover(pixels: &mut [Pixel], mask: &[u8], flat: &mut Flat) {
    /// Pixels passed over at once where there is nothing.
    const STEP: usize = 16;
    for (pixels, mask) in pixels.chunks_mut(STEP).zip(mask.chunks(STEP)) {
        if mask.iter().all(|&m| m == 0) {
            continue;
        }
        for (pixel, &m) in pixels.iter_mut().zip(mask) {
            // 255 of 255 are 256 of 256.
            let coverage = u32::from(m) + u32::from(m >> 7);
            if coverage > 0 {
                flat.pixel(pixel, 0, coverage);
            }
        }
    }
}

/// A column or row of the canvas; NaN counts as 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cut to the canvas"
)]
const fn clamped(x: f32, most: u32) -> u32 {
    let x = if x > 0.0 { x as u32 } else { 0 };
    if x < most { x } else { most }
}
