//! A stroke font of printable ASCII and a few signs of units (° ² ³ µ · × − –): no font file, the same text on every machine.
//!
//! A glyph is a few polylines on a grid where a capital is 10 high, a small letter 7, and the base line is 0;
//! [`glyphs`](crate::glyphs) holds the drawings. Spacing follows from the shapes: a side that leans or bulges away
//! from its neighbour gets less room than a straight stem. Digits all take the same room, so numbers that change do not dance.

use std::sync::OnceLock;

use carom_math::{Rot, Vec2, vec2};

use crate::glyphs::{DRAWINGS, EXTRA, MISSING};

/// Height of a capital on the grid of the drawings.
const CAPITAL: f64 = 10.0;
/// Room beside a straight stem, on the grid: a bit over one stroke.
const BEARING: f64 = 1.35;
/// Room that a digit takes, on the grid.
const DIGIT_ADVANCE: f64 = 8.1;
/// Room of a space, on the grid.
const SPACE_ADVANCE: f64 = 4.8;
/// Arcs are cut into chords of at most this many degrees: 1/500 of the radius from the arc.
const CHORD_DEGREES: f64 = 7.5;

/// One letter: its strokes, moved so that it starts at 0, and the room it takes.
#[derive(Debug)]
struct Glyph {
    strokes: Vec<Vec<Vec2>>,
    advance: f64,
}

/// Width of a stroke for text with capitals of `height` pixels: a ninth of it, and never a hair.
#[must_use]
pub(crate) fn weight(height: f64) -> f64 {
    let weight = 0.118 * height;
    if weight > 1.05 { weight } else { 1.05 }
}

/// What the seam of a text with a halo adds to its strokes, in pixels.
#[must_use]
pub(crate) fn seam(height: f64) -> f64 {
    (0.22 * height).clamp(2.0, 5.0)
}

/// Width of `text` in pixels, with capitals of `height` pixels.
#[must_use]
pub(crate) fn width(text: &str, height: f64) -> f64 {
    let units: f64 = text.chars().map(|c| glyph(c).advance).sum();
    units * height / CAPITAL
}

/// Hands over every stroke of `text`: pixels from the start of its base line, y up.
pub(crate) fn strokes(text: &str, height: f64, mut each: impl FnMut(&[Vec2])) {
    let scale = height / CAPITAL;
    let mut pen = 0.0;
    let mut placed = Vec::new();
    for character in text.chars() {
        let glyph = glyph(character);
        for stroke in &glyph.strokes {
            placed.clear();
            placed.extend(stroke.iter().map(|p| scale * vec2(p.x + pen, p.y)));
            each(&placed);
        }
        pen += glyph.advance;
    }
}

fn glyph(character: char) -> &'static Glyph {
    static GLYPHS: OnceLock<Vec<Glyph>> = OnceLock::new();
    let glyphs = GLYPHS.get_or_init(|| {
        let drawn = DRAWINGS.iter().enumerate().map(|(i, drawing)| {
            let digit = (16..26).contains(&i); // '0' is the seventeenth printable character
            build(drawing, digit)
        });
        let extra = EXTRA.iter().map(|(_, drawing)| build(drawing, false));
        drawn.chain(extra).chain([build(MISSING, false)]).collect()
    });
    let printable = (character as usize)
        .checked_sub(32)
        .filter(|&i| i < DRAWINGS.len());
    let index = printable.unwrap_or_else(|| {
        let extra = EXTRA.iter().position(|(other, _)| *other == character);
        DRAWINGS.len() + extra.unwrap_or(EXTRA.len())
    });
    &glyphs[index]
}

fn build(drawing: &str, digit: bool) -> Glyph {
    let mut strokes = parse(drawing);
    if strokes.is_empty() {
        return Glyph {
            strokes,
            advance: SPACE_ADVANCE,
        };
    }
    let points = || strokes.iter().flatten();
    let left = points().fold(f64::INFINITY, |low, p| low.min(p.x));
    let right = points().fold(f64::NEG_INFINITY, |high, p| high.max(p.x));
    let (start, advance) = if digit {
        (0.5 * (DIGIT_ADVANCE - (right - left)), DIGIT_ADVANCE)
    } else {
        let before = bearing(&strokes, |p| p.x - left);
        (
            before,
            before + right - left + bearing(&strokes, |p| right - p.x),
        )
    };
    for point in strokes.iter_mut().flatten() {
        point.x += start - left;
    }
    Glyph { strokes, advance }
}

/// Room on one side of a glyph: less, the further its ink lies back from that side on average.
fn bearing(strokes: &[Vec<Vec2>], depth: impl Fn(&Vec2) -> f64) -> f64 {
    const LEVELS: usize = 20;
    const DEEPEST: f64 = 2.2;
    let mut nearest = [DEEPEST; LEVELS + 1];
    let mut ink = [false; LEVELS + 1];
    for stroke in strokes {
        for pair in stroke.windows(2) {
            // Sampled finely enough to meet every level between base line and capital.
            for step in 0..=40 {
                let point = pair[0].lerp(pair[1], f64::from(step) / 40.0);
                let level = point.y / CAPITAL * 20.0;
                if !(0.0..=20.0).contains(&level) {
                    continue;
                }
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "the level was checked to lie in 0..=20"
                )]
                let level = level.round() as usize;
                ink[level] = true;
                nearest[level] = nearest[level].min(depth(&point));
            }
        }
    }
    let first = ink.iter().position(|&has| has).unwrap_or(0);
    let last = ink.iter().rposition(|&has| has).unwrap_or(0);
    let levels = &nearest[first..=last];
    #[expect(clippy::cast_precision_loss, reason = "at most 21 levels")]
    let mean = levels.iter().sum::<f64>() / levels.len() as f64;
    BEARING - 0.42 * mean
}

/// Reads a drawing: `M x y` starts a stroke, `L x y` draws a line, `A cx cy rx ry from to` an arc of an ellipse
/// (degrees, counter-clockwise if `to` is larger), joined to the stroke by a line.
fn parse(drawing: &str) -> Vec<Vec<Vec2>> {
    let mut strokes: Vec<Vec<Vec2>> = Vec::new();
    let mut words = drawing.split_ascii_whitespace();
    while let Some(command) = words.next() {
        let mut number = || -> f64 {
            let word = words.next().unwrap_or_default();
            word.parse().unwrap_or(f64::NAN)
        };
        if command == "M" || strokes.is_empty() {
            strokes.push(Vec::new());
        }
        let Some(stroke) = strokes.last_mut() else {
            continue;
        };
        if command != "A" {
            stroke.push(vec2(number(), number()));
            continue;
        }
        let (centre, radii) = (vec2(number(), number()), vec2(number(), number()));
        let (from, to) = (number(), number());
        let chords = ((to - from).abs() / CHORD_DEGREES).ceil().max(1.0);
        let mut chord = 0.0;
        while chord <= chords {
            let direction = Rot::from_degrees(from + (to - from) * chord / chords).x_axis();
            stroke.push(centre + radii * direction);
            chord += 1.0;
        }
    }
    strokes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printable() -> impl Iterator<Item = char> {
        let extra = EXTRA.iter().map(|(character, _)| *character);
        (32..127_u8).map(char::from).chain(extra)
    }

    #[test]
    fn every_printable_character_is_drawn_and_distinct() {
        assert_eq!(DRAWINGS.len(), 95);
        let mut seen: Vec<(char, &Glyph)> = Vec::new();
        for character in printable() {
            let new = glyph(character);
            assert_eq!(new.strokes.is_empty(), character == ' ', "'{character}'");
            for (other, old) in &seen {
                assert_ne!(
                    new.strokes, old.strokes,
                    "'{character}' looks like '{other}'"
                );
            }
            seen.push((character, new));
        }
    }

    #[test]
    fn every_glyph_stays_in_its_box() {
        for character in printable() {
            let glyph = glyph(character);
            assert!(
                glyph.advance > 1.0 && glyph.advance < 14.0,
                "'{character}' {}",
                glyph.advance
            );
            for point in glyph.strokes.iter().flatten() {
                assert!(
                    (0.0..=glyph.advance).contains(&point.x),
                    "'{character}' {point}"
                );
                assert!((-3.5..=11.5).contains(&point.y), "'{character}' {point}");
            }
            for stroke in &glyph.strokes {
                assert!(stroke.len() >= 2, "'{character}' has a lone point");
            }
        }
    }

    #[test]
    fn digits_take_the_same_room() {
        for digit in '0'..='9' {
            assert_eq!(glyph(digit).advance, DIGIT_ADVANCE, "{digit}");
        }
        assert_eq!(width("12:30", 9.0), width("47:05", 9.0));
    }

    #[test]
    fn other_characters_are_a_box() {
        assert_eq!(glyph('é').strokes, glyph('\n').strokes);
        assert_eq!(glyph('é').strokes.len(), 1);
        assert_ne!(glyph('²').strokes, glyph('é').strokes);
    }

    #[test]
    fn text_is_as_wide_as_its_letters() {
        assert_eq!(width("", 10.0), 0.0);
        let sum = width("a", 10.0) + width("b", 10.0);
        assert!((width("ab", 10.0) - sum).abs() < 1e-12);
        assert!((width("ab", 20.0) - 2.0 * sum).abs() < 1e-12);
        let mut last = 0.0_f64;
        strokes("carom", 12.0, |stroke| {
            for point in stroke {
                last = last.max(point.x);
            }
        });
        assert!(last < width("carom", 12.0), "{last}");
    }
}
