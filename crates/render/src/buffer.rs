//! Painting into memory of the caller, on the style's ground or on none.

use crate::paint::{Base, Sheets};
use crate::{Colour, Frame, RenderError, Style};

/// What lies beneath all marks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// The style's background, opaque.
    #[default]
    Style,
    /// Nothing: where no mark is, the picture is transparent.
    Clear,
}

impl Frame {
    /// Paints the frame into bytes of the caller, four a pixel, row by row from the upper left corner: red, green, blue and
    /// opacity, the colours already multiplied by the opacity.
    ///
    /// # Errors
    /// [`RenderError::Bytes`] if there are more or fewer than the size takes; they are untouched then.
    ///
    /// # Examples
    /// ```
    /// use carom_render::{Colour, Frame, Ground, Ink, Op, Size, Style};
    /// use carom_math::vec2;
    ///
    /// let mut frame = Frame::new(Size::new(20, 10)?);
    /// frame.push(Op::Dot { centre: vec2(5.0, 5.0), radius: 4.0, ink: Ink::Of(Colour::rgb(200, 30, 30)) });
    /// let mut bytes = [7; 4 * 20 * 10];
    /// frame.paint_bytes(&Style::light(), Ground::Clear, &mut bytes)?;
    /// let pixel = |x: usize, y: usize| &bytes[4 * (20 * y + x)..][..4];
    /// assert_eq!(pixel(5, 5), [200, 30, 30, 255]);
    /// assert_eq!(pixel(15, 5), [0, 0, 0, 0]);
    /// # Ok::<(), carom_render::RenderError>(())
    /// ```
    pub fn paint_bytes(
        &self,
        style: &Style,
        ground: Ground,
        bytes: &mut [u8],
    ) -> Result<(), RenderError> {
        let expected = 4 * self.size().pixels();
        if bytes.len() != expected {
            return Err(RenderError::Bytes {
                size: self.size(),
                expected,
                found: bytes.len(),
            });
        }
        let colour = match ground {
            Ground::Style => style.background.with_alpha(255),
            Ground::Clear => Colour::BLACK.with_alpha(0),
        };
        let all = 0..self.ops().len();
        Sheets::default().paint(self, all, style, Base::Colour(colour), bytes);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agreement_tests;

    #[test]
    fn a_clear_picture_laid_over_a_ground_is_the_picture_on_it() {
        let frame = agreement_tests::frame();
        let style = Style::light();
        let mut clear = vec![0; 4 * frame.size().pixels()];
        frame
            .paint_bytes(&style, Ground::Clear, &mut clear)
            .unwrap();
        let opaque = frame.paint(&style);
        let ground = style.background;
        let channels = [ground.red, ground.green, ground.blue].map(f64::from);
        for (a, b) in clear.chunks_exact(4).zip(opaque.rgba().chunks_exact(4)) {
            assert!(a[..3].iter().all(|&c| c <= a[3].saturating_add(1)), "{a:?}");
            for i in 0..3 {
                let laid = f64::from(a[i]) + channels[i] * (1.0 - f64::from(a[3]) / 255.0);
                // Each of the few marks over one another rounds once.
                assert!((laid - f64::from(b[i])).abs() <= 3.0, "{a:?} for {b:?}");
            }
        }
        assert!(clear.chunks_exact(4).any(|p| p[3] == 0));
    }

    #[test]
    fn bytes_on_the_style_are_the_picture() {
        let frame = agreement_tests::frame();
        let mut bytes = vec![1; 4 * frame.size().pixels()];
        let style = Style::dark();
        frame
            .paint_bytes(&style, Ground::Style, &mut bytes)
            .unwrap();
        assert!(bytes == frame.paint(&style).rgba());
        let error = frame.paint_bytes(&style, Ground::Style, &mut bytes[1..]);
        assert!(matches!(error, Err(RenderError::Bytes { .. })));
    }
}
