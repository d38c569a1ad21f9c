//! Colours in sRGB, and palettes that most eyes can tell apart.

use core::fmt;
use core::str::FromStr;

use crate::RenderError;

/// A colour in sRGB with straight (not premultiplied) opacity; 255 is opaque.
///
/// # Examples
/// ```
/// use carom_render::Colour;
/// let steel: Colour = "#4682b4".parse()?;
/// assert_eq!(steel, Colour::rgb(0x46, 0x82, 0xb4));
/// assert_eq!(Colour::BLACK.mixed(Colour::WHITE, 0.2), Colour::rgb(51, 51, 51));
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour {
    /// Red, 0..=255.
    pub red: u8,
    /// Green, 0..=255.
    pub green: u8,
    /// Blue, 0..=255.
    pub blue: u8,
    /// Opacity, 0 (invisible) to 255 (opaque).
    pub alpha: u8,
}

impl Colour {
    /// Black.
    pub const BLACK: Self = Self::rgb(0, 0, 0);
    /// White.
    pub const WHITE: Self = Self::rgb(255, 255, 255);

    /// An opaque colour.
    #[must_use]
    pub const fn rgb(red: u8, green: u8, blue: u8) -> Self {
        Self {
            red,
            green,
            blue,
            alpha: 255,
        }
    }

    /// The opaque colour 0xRRGGBB.
    #[must_use]
    pub const fn hex(rgb: u32) -> Self {
        let [_, red, green, blue] = rgb.to_be_bytes();
        Self::rgb(red, green, blue)
    }

    /// The same colour with another opacity, 0 to 255.
    #[must_use]
    pub const fn with_alpha(self, alpha: u8) -> Self {
        Self { alpha, ..self }
    }

    /// This colour (at `part` 0) blended into `other` (at 1), channel by channel.
    #[must_use]
    pub fn mixed(self, other: Self, part: f64) -> Self {
        let part = if part > 0.0 { part.min(1.0) } else { 0.0 };
        Self {
            red: mix(self.red, other.red, part),
            green: mix(self.green, other.green, part),
            blue: mix(self.blue, other.blue, part),
            alpha: mix(self.alpha, other.alpha, part),
        }
    }

    /// Lightness between 0 (black) and 1 (white): the weighted mean of the channels (Rec. 601).
    #[must_use]
    pub fn lightness(self) -> f64 {
        (0.299 * f64::from(self.red) + 0.587 * f64::from(self.green) + 0.114 * f64::from(self.blue))
            / 255.0
    }

    /// A colour by hue (turns), saturation and value (0 to 1); NaN counts as 0.
    #[must_use]
    pub fn hsv(hue: f64, saturation: f64, value: f64) -> Self {
        let unit = |x: f64| if x > 0.0 { x.min(1.0) } else { 0.0 };
        let (saturation, value) = (unit(saturation), unit(value));
        let hue = if hue.is_finite() {
            hue - hue.floor()
        } else {
            0.0
        };
        // Each channel is a trapezium of the hue, a third of a turn from the next.
        let channel = |offset: f64| {
            let k = (offset + 6.0 * hue) % 6.0;
            let ramp = unit(if k < 4.0 - k { k } else { 4.0 - k });
            round_u8(255.0 * value * (1.0 - saturation * ramp))
        };
        Self::rgb(channel(5.0), channel(3.0), channel(1.0))
    }
}

/// `#rrggbb`, with `aa` after it where the colour is not opaque.
impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.red, self.green, self.blue)?;
        if self.alpha == 255 {
            return Ok(());
        }
        write!(f, "{:02x}", self.alpha)
    }
}

impl FromStr for Colour {
    type Err = RenderError;

    fn from_str(text: &str) -> Result<Self, RenderError> {
        let wrong = || RenderError::Colour {
            text: text.to_owned(),
        };
        let digits = text.strip_prefix('#').ok_or_else(wrong)?;
        if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(wrong());
        }
        let number = u32::from_str_radix(digits, 16).map_err(|_| wrong())?;
        match digits.len() {
            6 => Ok(Self::hex(number)),
            8 => Ok(Self::hex(number >> 8).with_alpha(number.to_be_bytes()[3])),
            _ => Err(wrong()),
        }
    }
}

/// Nine fills for bodies: of like strength, told apart by most colour-blind eyes, on light and dark ground.
pub const BODY_COLOURS: [Colour; 9] = [
    Colour::hex(0x4C8ED9),
    Colour::hex(0xF2A541),
    Colour::hex(0x3FA796),
    Colour::hex(0xE4685D),
    Colour::hex(0x9A7BD0),
    Colour::hex(0xF2CF5B),
    Colour::hex(0x6CC4E8),
    Colour::hex(0xD982B5),
    Colour::hex(0x9DBF5E),
];

fn mix(a: u8, b: u8, part: f64) -> u8 {
    round_u8(f64::from(a) + (f64::from(b) - f64::from(a)) * part)
}

/// The nearest byte; the cast saturates.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, which is what a channel wants"
)]
pub(crate) fn round_u8(value: f64) -> u8 {
    value.round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn wrong_texts_are_named() {
        for text in [
            "", "#", "red", "#12345", "#1234567", "#+12345", "#gggggg", "123456", "#ééé",
        ] {
            let error = text.parse::<Colour>().unwrap_err().to_string();
            assert!(error.contains(&format!("'{text}'")), "{error}");
        }
    }

    #[test]
    fn hues_go_round() {
        assert_eq!(Colour::hsv(0.0, 1.0, 1.0), Colour::rgb(255, 0, 0));
        assert_eq!(Colour::hsv(1.0 / 3.0, 1.0, 1.0), Colour::rgb(0, 255, 0));
        assert_eq!(Colour::hsv(-1.0 / 3.0, 1.0, 1.0), Colour::rgb(0, 0, 255));
        assert_eq!(Colour::hsv(f64::NAN, 0.0, 1.0), Colour::WHITE);
    }

    proptest! {
        #[test]
        fn text_and_back(red: u8, green: u8, blue: u8, alpha: u8) {
            let colour = Colour { red, green, blue, alpha };
            prop_assert_eq!(colour.to_string().parse::<Colour>().unwrap(), colour);
        }

        #[test]
        fn a_mix_lies_between(a: u8, b: u8, part in -1.0..2.0_f64) {
            let mixed = mix(a, b, part.clamp(0.0, 1.0));
            prop_assert!(mixed >= a.min(b) && mixed <= a.max(b));
        }
    }
}
