//! What colour a covered pixel takes: flat, along a ray, or out of a picture.
//!
//! All colours here are premultiplied, four bytes a pixel, so that opaque and transparent ground are one case.
//! Coverage counts from 0 to 256.

use carom_math::Vec2;

use crate::face::{Level, PAD, Texel};

/// A pixel: premultiplied red, green, blue, and opacity.
pub(crate) type Pixel = [u8; 4];

/// Coverage of a whole pixel.
pub(crate) const FULL: u32 = 256;

/// Paints pixels of a row, column by column of a shape.
pub(crate) trait Shade {
    /// Prepares columns `first..end` of row `y`.
    fn row(&mut self, y: usize, first: usize, end: usize);
    /// Paints pixels from column `first` on, all covered alike.
    fn span(&self, out: &mut [Pixel], first: usize, coverage: u32);
    /// Paints one pixel.
    fn pixel(&self, out: &mut Pixel, column: usize, coverage: u32);
}

/// `source`, covering a pixel in part, over `ground`; two channels at a time.
///
/// With c of 256 and opacity a the ground keeps k = 256 − c a / 255, rounded; s c + g k + 128 stays below 2^16.
#[inline]
pub(crate) fn over(source: u32, ground: u32, coverage: u32) -> u32 {
    const PAIR: u32 = 0x00FF_00FF;
    const HALF: u32 = 0x0080_0080;
    let keep = kept(source >> 24, coverage);
    let low = (source & PAIR) * coverage + (ground & PAIR) * keep + HALF;
    let high = (source >> 8 & PAIR) * coverage + (ground >> 8 & PAIR) * keep + HALF;
    (low >> 8 & PAIR) | (high & !PAIR)
}

/// What is kept of the ground, of 256, below `opacity` (255 is all) covering `coverage`.
#[inline]
const fn kept(opacity: u32, coverage: u32) -> u32 {
    if opacity == 255 {
        FULL - coverage
    } else {
        FULL - (opacity * coverage + 127) / 255
    }
}

#[inline]
fn blend(out: &mut Pixel, source: u32, coverage: u32) {
    *out = over(source, u32::from_le_bytes(*out), coverage).to_le_bytes();
}

/// A constant colour over many pixels.
fn blend_all(out: &mut [Pixel], source: u32, coverage: u32) {
    if coverage == FULL && source >> 24 == 255 {
        out.fill(source.to_le_bytes());
        return;
    }
    for pixel in out {
        blend(pixel, source, coverage);
    }
}

/// One colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flat(pub(crate) u32);

impl Shade for Flat {
    fn row(&mut self, _: usize, _: usize, _: usize) {}

    fn span(&self, out: &mut [Pixel], _: usize, coverage: u32) {
        blend_all(out, self.0, coverage);
    }

    #[inline]
    fn pixel(&self, out: &mut Pixel, _: usize, coverage: u32) {
        blend(out, self.0, coverage);
    }
}

/// Paints colours that were found before.
fn paint_row(colours: &[u32], out: &mut [Pixel], coverage: u32, opaque: bool) {
    let pixels = out.iter_mut().zip(colours);
    if opaque && coverage == FULL {
        for (pixel, colour) in pixels {
            *pixel = colour.to_le_bytes();
        }
    } else {
        for (pixel, &colour) in pixels {
            blend(pixel, colour, coverage);
        }
    }
}

/// From one colour at a distance from a point to another further out.
#[derive(Debug)]
pub(crate) struct Radial<'a> {
    /// The point from the left side of the shape and the top of the canvas.
    focus: Vec2,
    /// Distance, in pixels, at which the change begins, and one over the distance that it takes.
    begin: f32,
    per: f32,
    /// Channels at the beginning, and how much they change by; the opacity is that of both.
    from: [f32; 3],
    by: [f32; 3],
    opacity: u32,
    colours: &'a mut Vec<u32>,
    first: usize,
}

impl<'a> Radial<'a> {
    /// From the colour `inner` up to a distance of `begin` to `outer` from `end` on; both with the opacity of `inner`.
    #[expect(clippy::cast_possible_truncation, reason = "distances of a picture")]
    pub(crate) fn new(
        focus: Vec2,
        (begin, end): (f64, f64),
        inner: u32,
        outer: u32,
        colours: &'a mut Vec<u32>,
    ) -> Self {
        let from = channels(inner);
        let to = channels(outer);
        Self {
            focus,
            begin: begin as f32,
            per: (1.0 / (end - begin)) as f32,
            from,
            by: [to[0] - from[0], to[1] - from[1], to[2] - from[2]],
            opacity: inner & 0xFF00_0000,
            colours,
            first: 0,
        }
    }
}

fn channels(colour: u32) -> [f32; 3] {
    let [red, green, blue, _] = colour.to_le_bytes();
    [red, green, blue].map(f32::from)
}

impl Shade for Radial<'_> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "within a picture"
    )]
    fn row(&mut self, y: usize, first: usize, end: usize) {
        /// Added to a number below 2^22 it leaves its nearest integer in the lowest bits.
        const ROUND: f32 = 8_388_608.0;
        self.first = first;
        let count = end - first;
        if self.colours.len() < count {
            self.colours.resize(count, 0);
        }
        let dy = (y as f64 + 0.5 - self.focus.y) as f32;
        let dx = (0.5 - self.focus.x) as f32;
        let (begin, per, from, by, opacity) =
            (self.begin, self.per, self.from, self.by, self.opacity);
        let square = dy * dy;
        let columns = i32::try_from(first).unwrap_or(0)..;
        for (column, colour) in columns.zip(&mut self.colours[..count]) {
            let across = dx + column as f32;
            let distance = (across * across + square).sqrt();
            let part = (distance - begin) * per;
            let part = if part > 0.0 { part } else { 0.0 };
            let part = if part < 1.0 { part } else { 1.0 };
            let red = (from[0] + by[0] * part + ROUND).to_bits() & 0xFF;
            let green = (from[1] + by[1] * part + ROUND).to_bits() & 0xFF;
            let blue = (from[2] + by[2] * part + ROUND).to_bits() & 0xFF;
            *colour = red | green << 8 | blue << 16 | opacity;
        }
    }

    fn span(&self, out: &mut [Pixel], first: usize, coverage: u32) {
        let opaque = self.opacity == 0xFF00_0000;
        paint_row(&self.colours[first - self.first..], out, coverage, opaque);
    }

    #[inline]
    fn pixel(&self, out: &mut Pixel, column: usize, coverage: u32) {
        blend(out, self.colours[column - self.first], coverage);
    }
}

/// A picture laid over the shape: between the four nearest of its pixels.
#[derive(Debug)]
pub(crate) struct Textured<'a> {
    level: &'a Level,
    /// Where in the picture the shape's upper left corner falls, and what a step right or down adds there.
    origin: Vec2,
    right: Vec2,
    down: Vec2,
    colours: &'a mut Vec<u32>,
    first: usize,
}

impl<'a> Textured<'a> {
    pub(crate) fn new(
        level: &'a Level,
        origin: Vec2,
        (right, down): (Vec2, Vec2),
        colours: &'a mut Vec<u32>,
    ) -> Self {
        Self {
            level,
            origin,
            right,
            down,
            colours,
            first: 0,
        }
    }
}

impl Shade for Textured<'_> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "fixed point with 32 digits after the point, cut to the picture"
    )]
    fn row(&mut self, y: usize, first: usize, end: usize) {
        /// One in fixed point.
        const ONE: f64 = 4_294_967_296.0;
        self.first = first;
        let count = end - first;
        if self.colours.len() < count {
            self.colours.resize(count, 0);
        }
        let texels = &self.level.wide[..];
        // Where the middle of the first column falls, less half a texel: the corner of four.
        let start = self.origin
            + self.down * (y as f64 + 0.5)
            + 0.5 * (self.right - Vec2::ONE)
            + Vec2::splat(f64::from(PAD));
        let [du, dv] = [self.right.x, self.right.y].map(|step| (step * ONE) as i64);
        let column = i64::try_from(first).unwrap_or(0);
        let mut u = ((start.x * ONE) as i64).wrapping_add(du.wrapping_mul(column));
        let mut v = ((start.y * ONE) as i64).wrapping_add(dv.wrapping_mul(column));
        let [wide, high] = [self.level.width, self.level.height].map(|side| side + 2 * PAD);
        let stride = wide as usize;
        let most_u = i64::from(wide - 1) << 32;
        let most_v = i64::from(high - 1) << 32;
        let steps = i64::try_from(count - 1).unwrap_or(0);
        let inside = |from: i64, by: i64, most: i64| {
            let to = from.wrapping_add(by.wrapping_mul(steps));
            from.min(to) >= 0 && from.max(to) < most
        };
        let inside = inside(u, du, most_u) && inside(v, dv, most_v);
        let mut four = Four::default();
        for colours in self.colours[..count].chunks_mut(LANES) {
            for lane in 0..colours.len() {
                if inside {
                    // All four neighbours are there.
                    let at = (v >> 32) as usize * stride + (u >> 32) as usize;
                    let pair = |at: usize| {
                        let pair = texels.get(at..).and_then(<[Texel]>::first_chunk);
                        pair.copied().unwrap_or_default()
                    };
                    four.put(lane, [pair(at), pair(at + stride)], (u, v));
                } else {
                    let (x, y) = (u.clamp(0, most_u), v.clamp(0, most_v));
                    let at = (y >> 32) as usize * stride + (x >> 32) as usize;
                    let beside = usize::from(x < most_u);
                    let below = at + if y < most_v { stride } else { 0 };
                    let texel = |at: usize| texels.get(at).copied().unwrap_or_default();
                    let pair = |at: usize| [texel(at), texel(at + beside)];
                    four.put(lane, [pair(at), pair(below)], (x, y));
                }
                u = u.wrapping_add(du);
                v = v.wrapping_add(dv);
            }
            let mixed = four.mixed();
            for (colour, mixed) in colours.iter_mut().zip(mixed.as_chunks().0) {
                *colour = u32::from_le_bytes(*mixed);
            }
        }
    }

    fn span(&self, out: &mut [Pixel], first: usize, coverage: u32) {
        let colours = &self.colours[first - self.first..];
        paint_row(colours, out, coverage, self.level.opaque);
    }

    #[inline]
    fn pixel(&self, out: &mut Pixel, column: usize, coverage: u32) {
        blend(out, self.colours[column - self.first], coverage);
    }
}

/// Pixels that are mixed at once.
const LANES: usize = 16;

/// Four channels of so many pixels, with room between them: eight to a register of 128 bits.
type Wide = [u16; 4 * LANES];

/// Four neighbours each of some places in a picture, and how far from the first to the others the places lie.
#[derive(Default)]
struct Four {
    /// Upper left, upper right, lower left, lower right.
    corners: [[Texel; LANES]; 4],
    /// Right and down, of 256, the same for each channel.
    parts: [[Texel; LANES]; 2],
}

impl Four {
    /// Sets a place by its neighbours, an upper and a lower pair, and where it lies, in fixed point.
    #[inline]
    #[expect(clippy::cast_sign_loss, reason = "eight bits of each")]
    fn put(&mut self, lane: usize, [upper, lower]: [[Texel; 2]; 2], (u, v): (i64, i64)) {
        [self.corners[0][lane], self.corners[1][lane]] = upper;
        [self.corners[2][lane], self.corners[3][lane]] = lower;
        self.parts[0][lane] = [(u >> 24 & 0xFF) as u16; 4];
        self.parts[1][lane] = [(v >> 24 & 0xFF) as u16; 4];
    }

    /// The colours at all places, four bytes each.
    #[inline]
    fn mixed(&self) -> [u8; 4 * LANES] {
        let [a, b, c, d] = self.corners.each_ref().map(flat);
        let [right, down] = self.parts.each_ref().map(flat);
        let upper = between(&a, &b, &right);
        let lower = between(&c, &d, &right);
        #[expect(clippy::cast_possible_truncation, reason = "at most 255")]
        between(&upper, &lower, &down).map(|channel| channel as u8)
    }
}

#[inline]
fn flat(texels: &[Texel; LANES]) -> Wide {
    *texels
        .as_flattened()
        .first_chunk()
        .unwrap_or(&[0; 4 * LANES])
}

/// `part` of 256 of the way from `from` to `to`, rounded: sums stay below 2^16.
#[inline]
fn between(from: &Wide, to: &Wide, part: &Wide) -> Wide {
    let mut all = [0; 4 * LANES];
    let parts = from.iter().zip(to).zip(part);
    for (out, ((&from, &to), &part)) in all.iter_mut().zip(parts) {
        *out = (from * (256 - part) + to * part + 128) >> 8;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_blend_is_within_a_step_of_the_real_one(source: [u8; 3], opacity: u8, ground: [u8; 3], coverage in 0..=256_u32) {
            // Premultiplied: no channel above the opacity.
            let source = source.map(|c| c.min(opacity));
            let packed = u32::from_le_bytes([source[0], source[1], source[2], opacity]);
            let found = over(packed, u32::from_le_bytes([ground[0], ground[1], ground[2], 255]), coverage).to_le_bytes();
            let part = f64::from(coverage) / 256.0;
            for i in 0..3 {
                let wanted = f64::from(source[i]) * part + f64::from(ground[i]) * (1.0 - part * f64::from(opacity) / 255.0);
                prop_assert!((f64::from(found[i]) - wanted).abs() <= 1.0, "{found:?}, {wanted}");
            }
            prop_assert_eq!(found[3], 255, "opaque ground stays opaque");
        }

        #[test]
        fn no_channel_spills_into_another(source: u32, ground: u32, coverage in 0..=256_u32) {
            let [a, b] = [source, ground].map(|pixel| {
                let bytes = pixel.to_le_bytes();
                u32::from_le_bytes([bytes[0].min(bytes[3]), bytes[1].min(bytes[3]), bytes[2].min(bytes[3]), bytes[3]])
            });
            let found = over(a, b, coverage).to_le_bytes();
            prop_assert!(found[..3].iter().all(|&c| c <= found[3].saturating_add(1)), "{found:?}");
            let texel = a.to_le_bytes().map(u16::from);
            let part = i64::from(coverage.min(255)) << 24;
            let mut four = Four::default();
            four.put(3, [[texel; 2]; 2], (part, (255 << 24) - part));
            prop_assert_eq!(&four.mixed()[12..16], &a.to_le_bytes());
        }
    }
}
