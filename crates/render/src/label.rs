//! Lines of text.

use carom_math::{Rot, Vec2, vec2};

use crate::{Ink, Op, font};

/// A line of text in the built-in stroke font.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Where its anchor is, in pixels.
    pub at: Vec2,
    /// The text; what is neither printable ASCII nor one of ° ² ³ µ · × − – is drawn as a small box.
    pub text: String,
    /// Height of a capital, in pixels.
    pub height: f64,
    /// Its colour.
    pub ink: Ink,
    /// Which point of the text lies at `at`: x from 0 (start) to 1 (end), y from 0 (base line) to 1 (top of a capital).
    pub anchor: Vec2,
    /// How the base line is turned in the picture.
    pub turn: Rot,
    /// Whether a seam of the ground's colour keeps it readable above other marks.
    pub halo: bool,
}

impl Label {
    /// A level text that starts at `at` on its base line.
    #[must_use]
    pub fn new(at: Vec2, text: impl Into<String>, height: f64, ink: Ink) -> Self {
        Self {
            at,
            text: text.into(),
            height,
            ink,
            anchor: Vec2::ZERO,
            turn: Rot::IDENTITY,
            halo: false,
        }
    }

    /// The same with another anchor.
    #[must_use]
    pub fn anchored(self, x: f64, y: f64) -> Self {
        Self {
            anchor: vec2(x, y),
            ..self
        }
    }

    /// The same with a seam.
    #[must_use]
    pub fn with_halo(self) -> Self {
        Self { halo: true, ..self }
    }

    /// The same, reading upwards.
    #[must_use]
    pub fn upwards(self) -> Self {
        Self {
            turn: Rot::from_degrees(-90.0),
            ..self
        }
    }

    /// Width of the text, in pixels.
    #[must_use]
    pub fn width(&self) -> f64 {
        font::width(&self.text, self.height)
    }

    /// The strokes of the text, in pixels of the picture.
    pub(crate) fn strokes(&self, mut each: impl FnMut(&[Vec2])) {
        let origin = vec2(-self.anchor.x * self.width(), self.anchor.y * self.height);
        let mut placed = Vec::new();
        font::strokes(&self.text, self.height, |stroke| {
            placed.clear();
            // The font has y up, the picture y down.
            placed.extend(
                stroke
                    .iter()
                    .map(|p| self.at + self.turn * (origin + vec2(p.x, -p.y))),
            );
            each(&placed);
        });
    }
}

impl From<Label> for Op {
    fn from(label: Label) -> Self {
        Self::Label(label)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_fills_the_box_of_its_anchor() {
        for (x, y) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0)] {
            let label = Label::new(vec2(100.0, 100.0), "Heft", 20.0, Ink::Text).anchored(x, y);
            let (left, top) = (100.0 - x * label.width(), 100.0 - (1.0 - y) * 20.0);
            label.strokes(|stroke| {
                for p in stroke {
                    assert!((left..=left + label.width()).contains(&p.x), "{p} {left}");
                    assert!((top - 2.0..=top + 21.0).contains(&p.y), "{p} {top}");
                }
            });
        }
    }
}
