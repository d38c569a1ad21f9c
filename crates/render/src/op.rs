//! Marks: what a frame is a list of.

use carom_math::{Rot, Vec2, vec2};

use crate::{Colour, Face, Ink, Label};

/// How a body is filled.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Paint};
/// let ball = Paint::flat(Colour::hex(0x4C8ED9)).shaded();
/// assert!(ball.shaded);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paint {
    /// Colour of the inside.
    pub fill: Colour,
    /// Colour of the outline; `None` leaves it to [`Style::outline_of`](crate::Style::outline_of).
    pub outline: Option<Colour>,
    /// Whether a disc is lit from its upper left: full colour up to 0.2 r around a point at −0.2 r, a third of it
    /// at 1.3 r. Other shapes stay flat.
    pub shaded: bool,
}

impl Paint {
    /// One colour, with the style's outline.
    #[must_use]
    pub const fn flat(fill: Colour) -> Self {
        Self {
            fill,
            outline: None,
            shaded: false,
        }
    }

    /// The same, discs shaded as balls.
    #[must_use]
    pub const fn shaded(self) -> Self {
        Self {
            shaded: true,
            ..self
        }
    }

    /// The same with an outline of its own.
    #[must_use]
    pub const fn outlined(self, colour: Colour) -> Self {
        Self {
            outline: Some(colour),
            ..self
        }
    }
}

/// One mark of a frame. All places and lengths are pixels of the picture, y down.
///
/// Any number may be given: what is not finite is left out, what lies outside is clipped, and a width
/// or radius that is not positive draws nothing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Op {
    /// A closed ring of points, filled and outlined.
    Polygon {
        /// The ring, either way round.
        points: Vec<Vec2>,
        /// Fill and outline.
        paint: Paint,
    },
    /// Several closed rings, filled and outlined: a ring the other way round inside another is a hole.
    Region {
        /// The rings.
        rings: Vec<Vec<Vec2>>,
        /// Fill and outline.
        paint: Paint,
    },
    /// A disc, filled and outlined.
    Disc {
        /// Its centre.
        centre: Vec2,
        /// Its radius.
        radius: f64,
        /// Fill and outline.
        paint: Paint,
    },
    /// A closed ring of points, filled, without an outline.
    Area {
        /// The ring, either way round.
        points: Vec<Vec2>,
        /// Its colour.
        ink: Ink,
    },
    /// A dot without an outline.
    Dot {
        /// Its centre.
        centre: Vec2,
        /// Its radius.
        radius: f64,
        /// Its colour.
        ink: Ink,
    },
    /// A circle line.
    Ring {
        /// Its centre.
        centre: Vec2,
        /// Its radius, to the middle of the line.
        radius: f64,
        /// Width of the line.
        width: f64,
        /// Its colour.
        ink: Ink,
    },
    /// A line through points, with round ends and corners.
    Line {
        /// The points, in order.
        points: Vec<Vec2>,
        /// Width of the line.
        width: f64,
        /// Length of a dash and of the gap after it; `None` draws through.
        dash: Option<f64>,
        /// Its colour.
        ink: Ink,
    },
    /// An arrow: a shaft with a head, one outline.
    Arrow {
        /// Where it starts.
        from: Vec2,
        /// Where its tip is.
        to: Vec2,
        /// Width of the shaft.
        width: f64,
        /// Its colour.
        ink: Ink,
    },
    /// A picture clipped to a disc and turning with it.
    Face {
        /// Centre of the disc.
        centre: Vec2,
        /// Radius of the disc.
        radius: f64,
        /// How it is turned in the picture, where y points down ([`Camera::turn`](crate::Camera::turn)).
        turn: Rot,
        /// The picture.
        face: Face,
    },
    /// A rectangle along the axes.
    Box {
        /// Corner with the smallest coordinates.
        min: Vec2,
        /// Corner with the largest coordinates.
        max: Vec2,
        /// Colour of the inside.
        fill: Option<Ink>,
        /// Colour of the border.
        border: Option<Ink>,
        /// Width of the border.
        width: f64,
        /// Length of a dash of the border and of the gap after it; `None` draws through.
        dash: Option<f64>,
    },
    /// A line of text.
    Label(Label),
}

impl Op {
    /// Makes it a copy of another mark; the lists of points that there are many of keep their memory.
    pub(crate) fn copy(&mut self, other: &Self) {
        match (self, other) {
            (
                Self::Polygon { points, paint },
                Self::Polygon {
                    points: other,
                    paint: with,
                },
            ) => {
                points.clone_from(other);
                *paint = *with;
            }
            (
                Self::Area { points, ink },
                Self::Area {
                    points: other,
                    ink: with,
                },
            ) => {
                points.clone_from(other);
                *ink = *with;
            }
            (
                Self::Line {
                    points,
                    width,
                    dash,
                    ink,
                },
                Self::Line {
                    points: other,
                    width: wide,
                    dash: with_dash,
                    ink: with,
                },
            ) => {
                points.clone_from(other);
                (*width, *dash, *ink) = (*wide, *with_dash, *with);
            }
            (op, from) => op.clone_from(from),
        }
    }
}

/// The corners of a box, counter-clockwise in pixels that count downwards, and the first one again.
pub(crate) const fn box_ring(min: Vec2, max: Vec2) -> [Vec2; 5] {
    [min, vec2(max.x, min.y), max, vec2(min.x, max.y), min]
}

/// The outline of an arrow: seven points, or `None` if it is shorter than half a pixel.
pub(crate) fn arrow_outline(from: Vec2, to: Vec2, width: f64) -> Option<[Vec2; 7]> {
    let along = to - from;
    let length = along.length();
    if !(length >= 0.5 && length.is_finite() && width > 0.0 && width.is_finite()) {
        return None;
    }
    let along = along / length;
    let across = vec2(-along.y, along.x);
    // The head is three and a half shafts wide, and at most six tenths of the arrow.
    let head = (5.0 * width).min(0.6 * length);
    let half_head = 0.42 * head;
    let half = (0.5 * width).min(0.6 * half_head);
    let neck = to - along * head;
    Some([
        from + across * half,
        neck + across * half,
        neck + across * half_head,
        to,
        neck - across * half_head,
        neck - across * half,
        from - across * half,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrow_stays_within_its_head() {
        let outline = arrow_outline(vec2(10.0, 10.0), vec2(50.0, 10.0), 2.0).unwrap();
        assert_eq!(outline[3], vec2(50.0, 10.0));
        for point in outline {
            assert!((10.0..=50.0).contains(&point.x), "{point}");
            assert!((point.y - 10.0).abs() <= 4.2 + 1e-12, "{point}");
        }
    }

    #[test]
    fn an_arrow_without_direction_is_none() {
        for to in [
            vec2(10.0, 10.0),
            vec2(10.4, 10.0),
            vec2(f64::NAN, 0.0),
            vec2(f64::INFINITY, 0.0),
        ] {
            assert_eq!(arrow_outline(vec2(10.0, 10.0), to, 2.0), None, "{to}");
        }
    }
}
