//! One picture as a plain list of marks, before any pixel exists.

use carom_math::Vec2;

use crate::{Engine, Mark, Op, Picture, Size, Source, Style};

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
