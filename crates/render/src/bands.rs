//! Strips of a picture as parts of a PNG, each of which can be written again without the others.
//!
//! A strip of two bands is one IDAT chunk: a block of deflate that ends with a byte, of rows that refer to no row above the strip. So its
//! bytes depend on its pixels alone, and the file is put together from the chunks of its strips.

use core::ops::Range;

use crate::deflate::{Deflater, LAST};
use crate::painter::BAND;
use crate::png::{SIGNATURE, chunk};
use crate::{Changes, Picture, Size};

/// Rows of differences begin with what they differ from.
const LEFT: u8 = 1;
const ABOVE: u8 = 2;

/// A zlib stream with a window of 32 KiB (RFC 1950).
const ZLIB: [u8; 2] = [0x78, 0x01];

/// Rows of a strip. Every strip has a table of codes: making those of single bands takes a tenth of the time.
const ROWS: usize = 2 * BAND as usize;

/// A picture in strips, packed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bands {
    size: Option<Size>,
    strips: Vec<(Vec<u8>, Strip)>,
    maker: Maker,
}

/// Of a packed strip: checksum (Adler-32) and number of its bytes unpacked.
#[derive(Clone, Copy, Debug, Default)]
struct Strip {
    sum: u32,
    length: usize,
}

/// Packs strips; its memory goes from one to the next.
#[derive(Clone, Debug, Default)]
struct Maker {
    deflater: Deflater,
    rows: Vec<u8>,
}

impl Bands {
    /// Packs a picture; `changes` says where it differs from the one before.
    pub(crate) fn pack(&mut self, picture: &Picture, changes: &Changes) {
        let size = picture.size();
        let known = self.size == Some(size);
        self.size = Some(size);
        self.strips.resize(count(size), Default::default());
        let mut dirty = changes.bands().chunks(ROWS / BAND as usize);
        for (index, (chunk, strip)) in self.strips.iter_mut().enumerate() {
            // What nothing is known about is packed.
            if dirty.next().is_none_or(|bands| bands.contains(&true)) || !known {
                chunk.clear();
                *strip = self.maker.strip(picture, index, chunk);
            }
        }
    }

    /// The file.
    pub(crate) fn file(&self, out: &mut Vec<u8>) {
        out.clear();
        let Some(size) = self.size else { return };
        begin(size, out);
        let mut sum = 1;
        for (chunk, strip) in &self.strips {
            out.extend_from_slice(chunk);
            sum = joined(sum, *strip);
        }
        end(sum, out);
    }
}

/// The file of a picture, packed as a whole.
pub(crate) fn file(picture: &Picture) -> Vec<u8> {
    // Most pictures take less than an eighth of their bytes.
    let mut out = Vec::with_capacity(picture.rgba().len() / 8 + 1024);
    let mut maker = Maker::default();
    begin(picture.size(), &mut out);
    let strips = 0..count(picture.size());
    let sum = strips.fold(1, |sum, index| {
        joined(sum, maker.strip(picture, index, &mut out))
    });
    end(sum, &mut out);
    out
}

fn count(size: Size) -> usize {
    (size.height() as usize).div_ceil(ROWS)
}

/// What stands before the first strip.
fn begin(size: Size, out: &mut Vec<u8>) {
    out.extend(SIGNATURE);
    let [width, height] = [size.width(), size.height()].map(u32::to_be_bytes);
    // Eight bits a channel, RGB.
    chunk(*b"IHDR", &[&width, &height, &[8, 2, 0, 0, 0]], out);
}

/// What stands after the last one, from the checksum of all.
fn end(sum: u32, out: &mut Vec<u8>) {
    chunk(*b"IDAT", &[&LAST, &sum.to_be_bytes()], out);
    chunk(*b"IEND", &[], out);
}

impl Maker {
    /// Appends the chunk of a strip.
    fn strip(&mut self, picture: &Picture, index: usize, out: &mut Vec<u8>) -> Strip {
        let size = picture.size();
        let top = index * ROWS;
        let rows = top..(size.height() as usize).min(top + ROWS);
        differences(picture.rgba(), size.width() as usize, rows, &mut self.rows);
        let begin: &[u8] = if index == 0 { &ZLIB } else { &[] };
        chunk(*b"IDAT", &[begin, self.deflater.block(&self.rows)], out);
        Strip {
            sum: simd_adler32::adler32(&self.rows.as_slice()),
            length: self.rows.len(),
        }
    }
}

/// The checksum of some data and a strip after it.
///
/// Adler-32 is a = 1 + Σ dᵢ and b = Σ aᵢ, modulo 65521: the second piece begins with the first one's a instead of 1.
fn joined(first: u32, second: Strip) -> u32 {
    const PRIME: u64 = 65_521;
    let parts = |sum: u32| (u64::from(sum & 0xFFFF), u64::from(sum >> 16));
    let ((a, b), (c, d)) = (parts(first), parts(second.sum));
    let more = a + PRIME - 1;
    let low = (c + more) % PRIME;
    let high = (b + d + second.length as u64 % PRIME * (more % PRIME)) % PRIME;
    u32::try_from(high << 16 | low).unwrap_or(0)
}

/// Rows as differences, three bytes a pixel: the first to the pixel on the left, the others to the pixel above.
fn differences(rgba: &[u8], width: usize, rows: Range<usize>, out: &mut Vec<u8>) {
    let stride = 4 * width;
    let line = 3 * width + 1;
    out.resize(line * rows.len(), 0);
    let band = &rgba[rows.start * stride..rows.end * stride];
    let mut lines = out.chunks_exact_mut(line);
    if let Some([kind, first @ ..]) = lines.next() {
        *kind = LEFT;
        let (pixels, _) = band[..stride].as_chunks::<4>();
        let (places, _) = first.as_chunks_mut::<3>();
        let mut before = [0; 4];
        for (place, &pixel) in places.iter_mut().zip(pixels) {
            for ((place, channel), before) in place.iter_mut().zip(pixel).zip(before) {
                *place = channel.wrapping_sub(before);
            }
            before = pixel;
        }
    }
    let pairs = band
        .chunks_exact(stride)
        .zip(band[stride..].chunks_exact(stride));
    for (line, (above, here)) in lines.zip(pairs) {
        if let [kind, line @ ..] = line {
            *kind = ABOVE;
            to_above(above, here, line);
        }
    }
}

/// Differences of a row to the row above, sixteen pixels at a time: mostly they are all zero.
fn to_above(above: &[u8], here: &[u8], out: &mut [u8]) {
    let (aboves, above) = above.as_chunks::<64>();
    let (heres, here) = here.as_chunks::<64>();
    let (outs, out) = out.as_chunks_mut::<48>();
    for ((above, here), out) in aboves.iter().zip(heres).zip(outs) {
        if same(above, here) {
            *out = [0; 48];
            continue;
        }
        let (aboves, _) = above.as_chunks();
        let (heres, _) = here.as_chunks();
        let (outs, _) = out.as_chunks_mut();
        for ((&above, &here), out) in aboves.iter().zip(heres).zip(outs) {
            four(above, here, out);
        }
    }
    let pixels = above.chunks_exact(4).zip(here.chunks_exact(4));
    for (out, (above, here)) in out.chunks_exact_mut(3).zip(pixels) {
        for ((out, above), here) in out.iter_mut().zip(above).zip(here) {
            *out = here.wrapping_sub(*above);
        }
    }
}

/// Whether sixteen pixels are the same: without a branch for each of them.
#[inline]
fn same(a: &[u8; 64], b: &[u8; 64]) -> bool {
    let (a, _) = a.as_chunks();
    let (b, _) = b.as_chunks();
    let differ = |(&a, &b): (&[u8; 8], &[u8; 8])| u64::from_le_bytes(a) ^ u64::from_le_bytes(b);
    a.iter().zip(b).fold(0, |all, pair| all | differ(pair)) == 0
}

/// Differences of four pixels, without their opacity.
#[inline]
fn four(above: [u8; 16], here: [u8; 16], out: &mut [u8; 12]) {
    let mut all = [0; 16];
    for ((all, above), here) in all.iter_mut().zip(above).zip(here) {
        *all = here.wrapping_sub(above);
    }
    let (pixels, _) = all.as_chunks::<4>();
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| u64::from(u32::from_le_bytes(pixels[i]) & 0x00FF_FFFF));
    let low = a | b << 24 | c << 48;
    let high = c >> 16 | d << 8;
    out[..8].copy_from_slice(&low.to_le_bytes());
    out[8..].copy_from_slice(&high.to_le_bytes()[..4]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn checksums_of_pieces_make_that_of_the_whole(first: Vec<u8>, second: Vec<u8>) {
            let [a, b] = [&first, &second].map(|bytes| simd_adler32::adler32(&bytes.as_slice()));
            let whole = [&first[..], &second].concat();
            let strip = Strip { sum: b, length: second.len() };
            prop_assert_eq!(joined(a, strip), simd_adler32::adler32(&whole.as_slice()));
        }

        #[test]
        fn differences_add_up_to_the_rows(width in 1..70_usize, height in 1..5_usize, flat: bool, seed: u8) {
            let byte = |i: usize| if flat { seed } else { (i * i / 7) as u8 ^ seed };
            let mut rgba: Vec<u8> = (0..4 * width * height).map(byte).collect();
            rgba.chunks_exact_mut(4).for_each(|pixel| pixel[3] = 255);
            let mut rows = Vec::new();
            differences(&rgba, width, 0..height, &mut rows);
            let mut above = vec![0; 3 * width];
            for (row, pixels) in rows.chunks_exact(3 * width + 1).zip(rgba.chunks_exact(4 * width)) {
                let mut here = Vec::new();
                for (i, &byte) in row[1..].iter().enumerate() {
                    let before = match row[0] {
                        LEFT => if i < 3 { 0 } else { here[i - 3] },
                        _ => above[i],
                    };
                    here.push(byte.wrapping_add(before));
                }
                let wanted: Vec<u8> = pixels.chunks_exact(4).flat_map(|p| p[..3].to_vec()).collect();
                prop_assert_eq!(&here, &wanted);
                above = here;
            }
        }
    }
}
