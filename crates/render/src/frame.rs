//! One picture as a plain list of marks, before any pixel exists.

use carom_math::Vec2;

use crate::standing::{Resting, Standing};
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
    memory: Memory,
}

/// What a frame remembers of how it was made: no part of what it is. A clone goes its own way, and remembers nothing.
#[derive(Debug, Default)]
struct Memory {
    /// Lists of points that marks had before they were taken away.
    spare: Vec<Vec<Vec2>>,
    /// Which marks are those of before.
    standing: Standing,
    /// The bodies at rest that its first marks show.
    resting: Option<Box<Resting>>,
}

impl Clone for Memory {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Memory {
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
            memory: Memory {
                spare: Vec::new(),
                standing: Standing::new(),
                resting: None,
            },
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

    /// How many marks at the beginning are known to be those of an earlier state of `other`, without a look.
    pub(crate) fn common(&self, earlier: &Self) -> usize {
        let known = self.memory.standing.since(&earlier.memory.standing);
        known.min(self.ops.len()).min(earlier.ops.len())
    }

    /// A copy that notes which of its marks this one will still have; it must never get others but by [`Frame::copy`].
    pub(crate) fn snapshot(&self) -> Self {
        let mut copy = self.clone();
        copy.stand_as(self);
        copy
    }

    /// Takes over what another frame, of which it is a copy, notes of its marks.
    pub(crate) fn stand_as(&mut self, other: &Self) {
        self.memory.standing = other.memory.standing.clone();
    }

    /// Makes it a copy of another frame, with as little new memory as may be; the first `common` marks are equal.
    pub(crate) fn copy(&mut self, other: &Self, common: usize) {
        self.size = other.size;
        self.sources.truncate(common);
        self.sources.extend_from_slice(&other.sources[common..]);
        self.ops.truncate(other.ops.len());
        let (known, new) = other.ops.split_at(self.ops.len());
        for (op, from) in self.ops.iter_mut().zip(known).skip(common) {
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
        self.memory.resting = None;
        self.memory.standing = Standing::anew();
        self.take_away(0);
    }

    /// Takes away all but the first `marks` marks, and keeps the memory of the others.
    ///
    /// So the first marks of a list, if they do not change, are kept from frame to frame: a
    /// [`Painter`](crate::Painter) does not even compare them.
    ///
    /// # Examples
    /// ```
    /// use carom_render::{Frame, Ink, Op, Size};
    /// use carom_math::vec2;
    /// let dot = |x: f64| Op::Dot { centre: vec2(x, 50.0), radius: 10.0, ink: Ink::Text };    // px
    /// let mut frame = Frame::new(Size::new(200, 100)?);
    /// frame.push(dot(30.0));
    /// for step in 0..10 {
    ///     frame.truncate(1);
    ///     frame.push(dot(40.0 + f64::from(step)));
    /// }
    /// assert_eq!(frame.ops(), [dot(30.0), dot(49.0)]);
    /// # Ok::<(), carom_render::RenderError>(())
    /// ```
    pub fn truncate(&mut self, marks: usize) {
        if let Some(resting) = &mut self.memory.resting {
            resting.keep(marks);
        }
        self.memory.standing.cut(marks);
        self.take_away(marks);
    }

    /// Takes away marks and their sources; the memory of the first one comes to lie on top.
    fn take_away(&mut self, from: usize) {
        self.sources.truncate(from);
        self.memory.spare.clear();
        let from = from.min(self.ops.len());
        for op in self.ops.drain(from..).rev() {
            if let Op::Polygon { mut points, .. }
            | Op::Area { mut points, .. }
            | Op::Line { mut points, .. } = op
            {
                points.clear();
                self.memory.spare.push(points);
            }
        }
    }

    /// What it remembers of bodies at rest, to be given back when it holds for the marks at the beginning.
    pub(crate) const fn take_resting(&mut self) -> Option<Box<Resting>> {
        self.memory.resting.take()
    }

    pub(crate) fn set_resting(&mut self, resting: Box<Resting>) {
        self.memory.resting = Some(resting);
    }

    /// An empty list for the points of a mark, with memory of a mark cleared away if there is any.
    #[must_use]
    pub fn points(&mut self) -> Vec<Vec2> {
        self.memory.spare.pop().unwrap_or_default()
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
