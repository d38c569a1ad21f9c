//! The ink a frame is painted with: ground, text, overlays and the series of a chart.

use crate::{Colour, Paint};

/// Colours and stroke widths of a picture.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Style};
/// let night = Style { background: Colour::BLACK, ..Style::dark() };
/// assert_eq!(night.outline, 1.25);                                      // px
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// The ground.
    pub background: Colour,
    /// Labels, axes, titles.
    pub text: Colour,
    /// What should stay behind: tick labels, captions, dashed boxes.
    pub muted: Colour,
    /// Grid lines and the walls of an empty bar.
    pub grid: Colour,
    /// Outline of bodies, in pixels; 0 draws none.
    pub outline: f64,
    /// How much of the ground is mixed into the fill of a body that a world is captured with: 0 none, 1 all.
    pub wash: f64,
    /// Velocity arrows.
    pub velocity: Colour,
    /// Contact points and their normals.
    pub contact: Colour,
    /// The arrow of gravity and the circle of a field.
    pub field: Colour,
    /// The filled part of a bar.
    pub bar: Colour,
    /// The series of a chart, in order; the ninth starts over.
    pub series: [Colour; 8],
}

impl Style {
    /// Dark ink on white paper.
    #[must_use]
    pub const fn light() -> Self {
        Self {
            background: Colour::hex(0xFFFFFF),
            text: Colour::hex(0x24292F),
            muted: Colour::hex(0x6B7480),
            grid: Colour::hex(0xE3E7EB),
            outline: 1.25,
            wash: 0.0,
            velocity: Colour::hex(0x1F2933),
            contact: Colour::hex(0xC8102E),
            field: Colour::hex(0x3566B0),
            bar: Colour::hex(0xE0A100),
            series: [
                Colour::hex(0x2F6DB5),
                Colour::hex(0xD9541E),
                Colour::hex(0x128A6B),
                Colour::hex(0x8E4FB0),
                Colour::hex(0xC99A06),
                Colour::hex(0x3AA7DB),
                Colour::hex(0xC43E7E),
                Colour::hex(0x5C6570),
            ],
        }
    }

    /// Light ink on a night ground.
    #[must_use]
    pub const fn dark() -> Self {
        Self {
            background: Colour::hex(0x11151C),
            text: Colour::hex(0xE6EAF0),
            muted: Colour::hex(0x96A0AE),
            grid: Colour::hex(0x29303B),
            outline: 1.25,
            wash: 0.0,
            velocity: Colour::hex(0xF4F7FB),
            contact: Colour::hex(0xFF5C6C),
            field: Colour::hex(0x7FB0FF),
            bar: Colour::hex(0xF5C542),
            series: [
                Colour::hex(0x6AA9F4),
                Colour::hex(0xF58A4B),
                Colour::hex(0x45C7A1),
                Colour::hex(0xBE8FE6),
                Colour::hex(0xF0CB4C),
                Colour::hex(0x7ED3F2),
                Colour::hex(0xEE7FB0),
                Colour::hex(0xA9B3C1),
            ],
        }
    }

    /// For paper: black ink on white, pale bodies with strong outlines, marks that differ in grey too.
    #[must_use]
    pub const fn print() -> Self {
        Self {
            background: Colour::hex(0xFFFFFF),
            text: Colour::hex(0x000000),
            muted: Colour::hex(0x595959),
            grid: Colour::hex(0xD9D9D9),
            outline: 1.5,
            wash: 0.62,
            velocity: Colour::hex(0x000000),
            contact: Colour::hex(0xB00020),
            field: Colour::hex(0x1F4E9C),
            bar: Colour::hex(0x7A5200),
            series: [
                Colour::hex(0x1B4F8F),
                Colour::hex(0xC24A10),
                Colour::hex(0x0B6B52),
                Colour::hex(0x6E3A8C),
                Colour::hex(0x8F6A00),
                Colour::hex(0x2683B0),
                Colour::hex(0x96225A),
                Colour::hex(0x3F4750),
            ],
        }
    }

    /// The fill of a body that wears `colour`: washed out with the ground.
    #[must_use]
    pub fn body(&self, colour: Colour) -> Colour {
        colour.mixed(self.background.with_alpha(colour.alpha), self.wash)
    }

    /// What an ink looks like in this style.
    #[must_use]
    pub fn colour(&self, ink: Ink) -> Colour {
        match ink {
            Ink::Of(colour) => colour,
            Ink::Background => self.background,
            Ink::Text => self.text,
            Ink::Muted => self.muted,
            Ink::Grid => self.grid,
            Ink::Velocity => self.velocity,
            Ink::Contact => self.contact,
            Ink::Field => self.field,
            Ink::Bar => self.bar,
            Ink::Outline(fill) => self.outline_of(fill),
            Ink::Series(index) => self.series[index % self.series.len()],
        }
    }

    /// The outline of a mark painted so: its own, or that of its fill.
    pub(crate) fn outline_for(&self, paint: Paint) -> Colour {
        paint.outline.unwrap_or_else(|| self.outline_of(paint.fill))
    }

    /// The outline of a disc painted so: of a ball it goes with the colour at the rim.
    pub(crate) fn rim_for(&self, paint: Paint) -> Colour {
        let fill = if paint.shaded {
            shade(paint.fill)
        } else {
            paint.fill
        };
        paint.outline.unwrap_or_else(|| self.outline_of(fill))
    }

    /// The outline of a body filled with `fill`: the fill with a good part of the text's colour.
    #[must_use]
    pub fn outline_of(&self, fill: Colour) -> Colour {
        fill.mixed(self.text.with_alpha(fill.alpha), 0.45 + 0.5 * self.wash)
    }
}

/// The dark end of a ball's shading.
pub(crate) fn shade(colour: Colour) -> Colour {
    Colour {
        red: colour.red / 3,
        green: colour.green / 3,
        blue: colour.blue / 3,
        alpha: colour.alpha,
    }
}

/// [`Style::light`].
impl Default for Style {
    fn default() -> Self {
        Self::light()
    }
}

/// A colour by what it is for, so that one frame is painted light or dark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// This colour in every style.
    Of(Colour),
    /// [`Style::background`].
    Background,
    /// [`Style::text`].
    Text,
    /// [`Style::muted`].
    Muted,
    /// [`Style::grid`].
    Grid,
    /// [`Style::velocity`].
    Velocity,
    /// [`Style::contact`].
    Contact,
    /// [`Style::field`].
    Field,
    /// [`Style::bar`].
    Bar,
    /// [`Style::outline_of`] a fill.
    Outline(Colour),
    /// [`Style::series`], by index.
    Series(usize),
}

impl From<Colour> for Ink {
    fn from(colour: Colour) -> Self {
        Self::Of(colour)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Difference in lightness that a reader needs between ink and ground.
    const READABLE: f64 = 0.25;

    #[test]
    fn every_ink_stands_out_from_its_ground() {
        for style in [Style::light(), Style::dark(), Style::print()] {
            let ground = style.background.lightness();
            let inks = [
                style.text,
                style.muted,
                style.velocity,
                style.contact,
                style.field,
                style.bar,
            ];
            for ink in inks.into_iter().chain(style.series) {
                let apart = (ink.lightness() - ground).abs();
                assert!(
                    apart > READABLE,
                    "{ink} on {}: {apart:.2}",
                    style.background
                );
            }
        }
    }

    #[test]
    fn series_start_over() {
        let style = Style::default();
        assert_eq!(style.colour(Ink::Series(9)), style.series[1]);
    }
}
