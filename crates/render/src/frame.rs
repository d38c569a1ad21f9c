//! One picture as a plain list of marks, before any pixel exists.

use carom_math::{Rot, Vec2, vec2};

use crate::{Colour, Engine, Face, Ink, Mark, Picture, Size, Source, Style, font};

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
    /// Colour of the outline; `None` leaves it to [`Style::outline_of`].
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
    fn copy(&mut self, other: &Self) {
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
            (op, from) => op.clone_from(from),
        }
    }
}

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

/// A picture as a list of marks: later ones cover earlier ones.
///
/// Built by hand, by a [`Chart`](crate::Chart) or from a world; painted to pixels or written as SVG.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Frame, Op, Paint, Size, Style};
/// use carom_math::vec2;
///
/// let mut frame = Frame::new(Size::new(40, 40)?);
/// let paint = Paint::flat(Colour::hex(0x4C8ED9));
/// frame.push(Op::Disc { centre: vec2(20.0, 20.0), radius: 15.0, paint });          // px
/// let picture = frame.paint(&Style::default());
/// assert_eq!(picture.pixel(20, 20), Some(Colour::hex(0x4C8ED9)));
/// assert_eq!(picture.pixel(0, 0), Some(Colour::WHITE));
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    size: Size,
    ops: Vec<Op>,
    /// Of each mark.
    sources: Vec<Source>,
    spare: Spare,
}

/// Lists of points that marks had before they were cleared away: no part of what a frame is.
#[derive(Debug, Default)]
struct Spare(Vec<Vec<Vec2>>);

impl Clone for Spare {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Spare {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Frame {
    /// An empty frame.
    #[must_use]
    pub const fn new(size: Size) -> Self {
        Self {
            size,
            ops: Vec::new(),
            sources: Vec::new(),
            spare: Spare(Vec::new()),
        }
    }

    /// Size of the picture.
    #[must_use]
    pub const fn size(&self) -> Size {
        self.size
    }

    /// The marks, lowest first.
    #[must_use]
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// The marks and where they come from, lowest first.
    pub fn marks(&self) -> impl ExactSizeIterator<Item = Mark<'_>> {
        let pairs = self.ops.iter().zip(&self.sources);
        pairs.map(|(op, &source)| Mark { op, source })
    }

    /// Mark number `index`, which is there.
    pub(crate) fn mark(&self, index: usize) -> Mark<'_> {
        Mark {
            op: &self.ops[index],
            source: self.sources[index],
        }
    }

    /// Adds a mark above all others, of no body.
    pub fn push(&mut self, op: impl Into<Op>) {
        self.push_from(Source::default(), op);
    }

    /// Adds a mark above all others and says where it comes from.
    pub fn push_from(&mut self, source: Source, op: impl Into<Op>) {
        self.ops.push(op.into());
        self.sources.push(source);
    }

    /// Makes it a copy of another frame, with as little new memory as may be.
    pub(crate) fn copy(&mut self, other: &Self) {
        self.size = other.size;
        self.sources.clone_from(&other.sources);
        self.ops.truncate(other.ops.len());
        let (known, new) = other.ops.split_at(self.ops.len());
        for (op, from) in self.ops.iter_mut().zip(known) {
            op.copy(from);
        }
        self.ops.extend_from_slice(new);
    }

    /// The same with one mark alone, which both have.
    pub(crate) fn copy_mark(&mut self, index: usize, other: &Self) {
        self.sources[index] = other.sources[index];
        self.ops[index].copy(&other.ops[index]);
    }

    /// Number of marks at the beginning of the list that are not awake.
    pub(crate) fn beneath(&self) -> usize {
        let asleep = self.sources.iter().take_while(|source| !source.awake);
        asleep.count()
    }

    /// Takes all marks away and keeps the memory: [`Frame::points`] hands it out again.
    pub fn clear(&mut self, size: Size) {
        self.size = size;
        self.sources.clear();
        self.spare.0.clear();
        // The first mark's memory comes to lie on top.
        for op in self.ops.drain(..).rev() {
            if let Op::Polygon { mut points, .. }
            | Op::Area { mut points, .. }
            | Op::Line { mut points, .. } = op
            {
                points.clear();
                self.spare.0.push(points);
            }
        }
    }

    /// An empty list for the points of a mark, with memory of a mark cleared away if there is any.
    #[must_use]
    pub fn points(&mut self) -> Vec<Vec2> {
        self.spare.0.pop().unwrap_or_default()
    }

    /// Paints the frame into a new picture.
    #[must_use]
    pub fn paint(&self, style: &Style) -> Picture {
        let mut picture = Picture::new(self.size, style.background);
        self.paint_into(style, &mut picture);
        picture
    }

    /// Paints the frame over `picture`, which takes the frame's size and keeps its memory.
    pub fn paint_into(&self, style: &Style, picture: &mut Picture) {
        crate::paint::paint(self, style, Engine::Own, picture);
    }

    /// The frame as an SVG document, with the same marks.
    #[must_use]
    pub fn to_svg(&self, style: &Style) -> String {
        crate::svg::write(self.size, &self.ops, style)
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
