//! Packing picture after picture: what did not change is not packed again.

use crate::bands::Bands;
use crate::{Changes, Packing, Picture, Size};

/// Packs one picture after another into PNG files, and packs again only what changed.
///
/// The file is byte for byte the one that [`Picture::to_png_packed`] makes.
/// [`Packing::Fast`] packs the strips of two bands that changed, [`Packing::Small`] the whole picture unless nothing changed.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Frame, Ink, Op, Packer, Packing, Painter, Picture, Size, Style};
/// use carom_math::vec2;
///
/// let size = Size::new(200, 100)?;
/// let mut picture = Picture::new(size, Colour::WHITE);
/// let mut painter = Painter::new(Style::light());
/// let mut packer = Packer::new(Packing::Fast);
/// let mut frame = Frame::new(size);
/// for x in [30.0, 30.0, 31.0] {
///     frame.clear(size);
///     frame.push(Op::Dot { centre: vec2(x, 50.0), radius: 10.0, ink: Ink::Text });
///     let changes = painter.paint(&frame, &mut picture);
///     assert_eq!(packer.pack(&picture, changes), picture.to_png());
/// }
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Packer {
    packing: Packing,
    /// Of the picture packed last.
    size: Option<Size>,
    bands: Bands,
    file: Vec<u8>,
}

impl Packer {
    /// A packer that has packed nothing yet.
    #[must_use]
    pub fn new(packing: Packing) -> Self {
        Self {
            packing,
            size: None,
            bands: Bands::default(),
            file: Vec::new(),
        }
    }

    /// The picture as a PNG file. `changes` is what the [`Painter`](crate::Painter) that painted it said, and the picture
    /// that it painted before was packed here; of the first picture everything is packed.
    pub fn pack(&mut self, picture: &Picture, changes: &Changes) -> &[u8] {
        if changes.is_empty() && self.size == Some(picture.size()) {
            return &self.file;
        }
        self.size = Some(picture.size());
        match self.packing {
            Packing::Fast => {
                self.bands.pack(picture, changes);
                self.bands.file(&mut self.file);
            }
            Packing::Small => self.file = picture.to_png_packed(Packing::Small),
        }
        &self.file
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Colour, Frame, Ink, Op, Painter, Size, Style, second_reader};
    use carom_math::vec2;
    use proptest::prelude::*;

    /// Dots on a canvas of one of two sizes; most stay where they are from frame to frame.
    fn frame(large: bool, places: &[(u8, u8)]) -> Frame {
        let size = Size::new(if large { 130 } else { 97 }, 71).unwrap();
        let mut frame = Frame::new(size);
        for &(x, y) in places {
            frame.push(Op::Dot {
                centre: vec2(f64::from(x) / 2.0, f64::from(y) / 4.0),
                radius: 5.0,
                ink: Ink::Of(Colour::rgb(x, y, 90)),
            });
        }
        frame
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn files_do_not_depend_on_what_was_packed_before(
            start in prop::collection::vec(any::<(u8, u8)>(), 1..6),
            steps in prop::collection::vec((any::<prop::sample::Index>(), 0..4_u8, prop::bool::weighted(0.9)), 1..12),
        ) {
            let mut places = start;
            let mut painter = Painter::new(Style::light());
            let mut picture = Picture::new(Size::new(1, 1).unwrap(), Colour::BLACK);
            let mut packers = [Packing::Fast, Packing::Small].map(Packer::new);
            for (which, by, large) in steps {
                let one = which.index(places.len());
                places[one].0 = places[one].0.wrapping_add(by);
                let changes = painter.paint(&frame(large, &places), &mut picture);
                for packer in &mut packers {
                    let packing = packer.packing;
                    let file = packer.pack(&picture, changes);
                    prop_assert!(file == picture.to_png_packed(packing));
                    prop_assert_eq!(&Picture::from_png(file).unwrap(), &picture);
                }
            }
            second_reader::agrees(packers[0].pack(&picture, &Changes::default()));
        }
    }
}
