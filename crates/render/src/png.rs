//! Pictures to PNG and back.

use std::path::Path;

use ::png::{
    BitDepth, ColorType, Compression, DecodeOptions, Decoder, Encoder, Filter, Limits,
    Transformations,
};

use crate::output::write_file;
use crate::{MAX_SIDE, Picture, RenderError, Size, bands};

/// How hard a PNG is packed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Packing {
    /// For frames: twenty to thirty times faster than the usual setting, for a third more bytes.
    #[default]
    Fast,
    /// For published pictures: as small as is reasonable.
    Small,
}

impl Picture {
    /// The picture as a PNG file in memory: RGB, 8 bits, [`Packing::Fast`].
    ///
    /// # Examples
    /// ```
    /// use carom_render::{Colour, Picture, Size};
    /// let picture = Picture::new(Size::new(64, 48)?, Colour::hex(0x4682B4));
    /// let bytes = picture.to_png();
    /// assert_eq!(&bytes[1..4], b"PNG");
    /// assert_eq!(Picture::from_png(&bytes)?, picture);
    /// # Ok::<(), carom_render::RenderError>(())
    /// ```
    #[must_use]
    pub fn to_png(&self) -> Vec<u8> {
        self.to_png_packed(Packing::Fast)
    }

    /// The picture as a PNG file in memory.
    #[must_use]
    pub fn to_png_packed(&self, packing: Packing) -> Vec<u8> {
        match packing {
            Packing::Fast => bands::file(self),
            Packing::Small => encode(self.size(), &self.to_rgb(), ColorType::Rgb, packing),
        }
    }

    /// Writes the picture as a PNG, first under a temporary name in the same folder.
    ///
    /// # Errors
    /// [`RenderError::Io`] with the path and the system's reason; nothing is left behind then.
    pub fn save_png(&self, path: impl AsRef<Path>) -> Result<(), RenderError> {
        write_file(path.as_ref(), &self.to_png())
    }

    /// The same with [`Packing::Small`].
    ///
    /// # Errors
    /// As [`Picture::save_png`].
    pub fn save_small_png(&self, path: impl AsRef<Path>) -> Result<(), RenderError> {
        write_file(path.as_ref(), &self.to_png_packed(Packing::Small))
    }

    /// A picture from a PNG; transparent parts keep their colour and become opaque.
    ///
    /// # Errors
    /// [`RenderError::Decode`] if the bytes are no PNG, [`RenderError::TooLarge`] over the limits of [`Size`].
    pub fn from_png(bytes: &[u8]) -> Result<Self, RenderError> {
        let (size, rgba) = decode(bytes, MAX_SIDE)?;
        Self::from_rgba(size, rgba)
    }
}

/// A PNG of bytes that fit the size.
pub(crate) fn encode(size: Size, bytes: &[u8], colour: ColorType, packing: Packing) -> Vec<u8> {
    let packed = |compression, filter| encode_with(size, bytes, colour, compression, filter);
    match packing {
        Packing::Fast => packed(Compression::Fast, Filter::Up),
        Packing::Small => {
            // Flat colours pack better as they are, shaded ones as differences.
            let filtered = packed(Compression::Balanced, Filter::Adaptive);
            let plain = packed(Compression::Balanced, Filter::NoFilter);
            if plain.len() < filtered.len() {
                plain
            } else {
                filtered
            }
        }
    }
}

fn encode_with(
    size: Size,
    bytes: &[u8],
    colour: ColorType,
    compression: Compression,
    filter: Filter,
) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = Encoder::new(&mut out, size.width(), size.height());
    encoder.set_color(colour);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_filter(filter);
    let written = encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(bytes));
    // The size is valid, the bytes fit it and memory does not fail to be written: no error is left.
    debug_assert!(written.is_ok(), "{written:?}");
    out
}

pub(crate) const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Appends a PNG chunk: length, name, data, checksum of name and data.
pub(crate) fn chunk(name: [u8; 4], parts: &[&[u8]], out: &mut Vec<u8>) {
    let length: usize = parts.iter().map(|part| part.len()).sum();
    out.reserve(length + 12);
    // A frame of 64 Mi pixels packs to less than 2^31 bytes.
    out.extend(u32::try_from(length).unwrap_or(u32::MAX).to_be_bytes());
    let begin = out.len();
    out.extend(name);
    for part in parts {
        out.extend_from_slice(part);
    }
    let sum = crc32fast::hash(&out[begin..]);
    out.extend(sum.to_be_bytes());
}

/// Data of the IDAT chunks of a PNG, in order.
pub(crate) fn image_data(png: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = png.get(8..).unwrap_or_default();
    core::iter::from_fn(move || {
        loop {
            let (head, body) = rest.split_at_checked(8)?;
            let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
            let (data, after) = body.split_at_checked(length)?;
            rest = after.get(4..).unwrap_or_default();
            if head[4..] == *b"IDAT" {
                return Some(data);
            }
        }
    })
}

/// Size and straight RGBA of a PNG with sides up to `limit` pixels.
pub(crate) fn decode(bytes: &[u8], limit: u32) -> Result<(Size, Vec<u8>), RenderError> {
    let wrong = |error: ::png::DecodingError| RenderError::Decode {
        reason: error.to_string(),
    };
    // Room for rows and tables; the picture itself goes into our own memory, after its size is checked.
    let limits = Limits { bytes: 64 << 20 };
    let mut options = DecodeOptions::default();
    options.set_ignore_checksums(false);
    let mut decoder = Decoder::new_with_options(std::io::Cursor::new(bytes), options);
    decoder.set_limits(limits);
    decoder.set_transformations(Transformations::normalize_to_color8() | Transformations::ALPHA);
    let mut reader = decoder.read_info().map_err(wrong)?;
    let (width, height) = (reader.info().width, reader.info().height);
    let size = Size::new(width, height)?;
    if width > limit || height > limit {
        return Err(RenderError::TooLarge { width, height });
    }
    let mut raw = vec![0; reader.output_buffer_size().unwrap_or(0)];
    let found = reader.next_frame(&mut raw).map_err(wrong)?;
    raw.truncate(found.buffer_size());
    let rgba = match found.color_type {
        ColorType::GrayscaleAlpha => raw
            .chunks_exact(2)
            .flat_map(|p| [p[0], p[0], p[0], p[1]])
            .collect(),
        ColorType::Rgba => raw,
        other => {
            return Err(RenderError::Decode {
                reason: format!("unexpected colour type {other:?}"),
            });
        }
    };
    Ok((size, rgba))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Colour, second_reader};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn a_picture_survives_either_packing(width in 1..40_u32, height in 1..40_u32, seed: u8) {
            let size = Size::new(width, height).unwrap();
            let noise = (0..4 * size.pixels()).map(|i| (i * i / 7) as u8 ^ seed).collect();
            let picture = Picture::from_rgba(size, noise).unwrap();
            for packing in [Packing::Fast, Packing::Small] {
                let bytes = picture.to_png_packed(packing);
                prop_assert_eq!(&Picture::from_png(&bytes).unwrap(), &picture);
                second_reader::agrees(&bytes);
                prop_assert_eq!(bytes, picture.to_png_packed(packing), "same picture, same bytes");
            }
        }

        #[test]
        fn random_bytes_are_an_error(bytes: Vec<u8>) {
            prop_assert!(Picture::from_png(&bytes).is_err());
        }
    }

    #[test]
    fn a_huge_header_is_refused_before_memory_is_taken() {
        // A PNG that claims 2 000 000 x 2 000 000 pixels, with a correct checksum.
        let small = Picture::new(Size::new(1, 1).unwrap(), Colour::WHITE).to_png();
        let mut bytes = small.clone();
        bytes[16..24].copy_from_slice(&[0, 30, 132, 128, 0, 30, 132, 128]);
        let sum = crc32fast::hash(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&sum.to_be_bytes());
        let error = Picture::from_png(&bytes).unwrap_err();
        assert!(
            matches!(
                error,
                RenderError::TooLarge {
                    width: 2_000_000,
                    ..
                }
            ),
            "{error}"
        );
    }

    #[test]
    fn a_flipped_bit_is_never_another_picture() {
        let picture = Picture::from_rgba(Size::new(9, 7).unwrap(), (0..252).collect()).unwrap();
        for packing in [Packing::Fast, Packing::Small] {
            let bytes = picture.to_png_packed(packing);
            for bit in 0..8 * bytes.len() {
                let mut wrong = bytes.clone();
                wrong[bit / 8] ^= 1 << (bit % 8);
                if let Ok(read) = Picture::from_png(&wrong) {
                    assert_eq!(read, picture, "bit {bit}");
                }
            }
        }
    }

    #[test]
    fn a_missing_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let picture = Picture::new(Size::new(2, 2).unwrap(), Colour::WHITE);
        let error = picture
            .save_png(folder.path().join("no/picture.png"))
            .unwrap_err();
        assert!(error.to_string().contains("picture.png"), "{error}");
        picture.save_png(folder.path().join("picture.png")).unwrap();
        let names: Vec<_> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|e| e.unwrap().file_name())
            .collect();
        assert_eq!(names, ["picture.png"], "no temporary file stays");
    }
}
