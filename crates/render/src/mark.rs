//! Where a mark comes from, and which pixels it can touch.

use carom_dynamics::BodyId;
use carom_math::{Vec2, vec2};

use crate::clip::is_near;
use crate::op::{arrow_outline, box_ring};
use crate::raster::{greater, lesser};
use crate::skia::{MAX_STROKE, usable_width};
use crate::{Op, Size, Style, font};

/// Where a mark comes from.
///
/// # Examples
/// ```
/// use carom_render::Source;
/// let by_hand = Source::default();
/// assert!(by_hand.awake && by_hand.body.is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// The body that it shows, if it shows one. Rings of such a mark must not cross themselves, as those of a body's shapes
    /// do not: they are filled without a look, and where they did cross the picture would be wrong.
    pub body: Option<BodyId>,
    /// Whether it may move soon. What is said not to is painted beneath once and kept, and painted anew when it does
    /// move: a wrong flag costs time, never a pixel.
    pub awake: bool,
}

/// Made by hand: of no body, awake.
impl Default for Source {
    fn default() -> Self {
        Self {
            body: None,
            awake: true,
        }
    }
}

/// A mark of a frame, and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark<'a> {
    /// What is drawn.
    pub op: &'a Op,
    /// Where it comes from.
    pub source: Source,
}

impl Mark<'_> {
    /// The pixels of a canvas that it can touch; empty if it touches none.
    #[must_use]
    pub fn pixels(&self, style: &Style, size: Size) -> PixelBox {
        extent(self.op, style).map_or(PixelBox::EMPTY, |(min, max)| {
            PixelBox::around(min, max, size)
        })
    }

    /// Whether its rings are known not to cross themselves: a body's were checked when its shape was made.
    pub(crate) const fn is_sound(&self) -> bool {
        self.source.body.is_some()
    }
}

/// A rectangle of whole pixels, counted from the upper left corner.
///
/// # Examples
/// ```
/// use carom_render::PixelBox;
/// let left = PixelBox { left: 0, top: 0, right: 10, bottom: 4 };
/// let right = PixelBox { left: 8, top: 1, right: 20, bottom: 9 };
/// assert_eq!(left.common(right), PixelBox { left: 8, top: 1, right: 10, bottom: 4 });
/// assert_eq!(left.united(PixelBox::EMPTY), left);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelBox {
    /// First column.
    pub left: u32,
    /// First row.
    pub top: u32,
    /// The column after the last.
    pub right: u32,
    /// The row after the last.
    pub bottom: u32,
}

impl PixelBox {
    /// No pixel.
    pub const EMPTY: Self = Self {
        left: 0,
        top: 0,
        right: 0,
        bottom: 0,
    };

    /// All pixels of a canvas.
    #[must_use]
    pub const fn of(size: Size) -> Self {
        Self {
            left: 0,
            top: 0,
            right: size.width(),
            bottom: size.height(),
        }
    }

    /// Whether it has no pixel.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }

    /// The pixels of both.
    #[must_use]
    pub fn common(self, other: Self) -> Self {
        let both = Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        };
        if both.is_empty() { Self::EMPTY } else { both }
    }

    /// The smallest rectangle around both.
    #[must_use]
    pub fn united(self, other: Self) -> Self {
        if self.is_empty() {
            return other;
        }
        if other.is_empty() {
            return self;
        }
        Self {
            left: self.left.min(other.left),
            top: self.top.min(other.top),
            right: self.right.max(other.right),
            bottom: self.bottom.max(other.bottom),
        }
    }

    /// The pixels of a canvas that the rectangle from `min` to `max` touches.
    pub(crate) fn around(min: Vec2, max: Vec2, size: Size) -> Self {
        let corner = size.corner();
        let cut = |x: f64, most: f64| lesser(greater(x, 0.0), most);
        let (right, bottom) = (cut(max.x, corner.x), cut(max.y, corner.y));
        // Up to the next whole pixel; a call of `ceil` takes longer than all the rest.
        let up = |x: f64| whole(x) + u32::from(x > f64::from(whole(x)));
        let found = Self {
            left: whole(cut(min.x, corner.x)),
            top: whole(cut(min.y, corner.y)),
            right: up(right),
            bottom: up(bottom),
        };
        if found.is_empty() { Self::EMPTY } else { found }
    }
}

/// The whole part of a number that was cut to the canvas.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 0 and 16384"
)]
const fn whole(pixels: f64) -> u32 {
    pixels as u32
}

/// The rectangle that a mark lies in, in pixels, with its outline and all rounding; `None` if it draws nothing.
pub(crate) fn extent(op: &Op, style: &Style) -> Option<(Vec2, Vec2)> {
    /// Room for roundings, and for the pixel that a line is wide at least.
    const ROOM: f64 = 1.0;
    let grown = |(min, max): (Vec2, Vec2), by: f64| {
        (is_near(min) && is_near(max)).then(|| {
            let by = Vec2::splat(by + ROOM);
            (min - by, max + by)
        })
    };
    let half = |width: f64| usable_width(width).map_or(0.0, |width| 0.5 * width);
    match op {
        Op::Polygon { points, .. } => grown(hull(points)?, half(style.outline)),
        Op::Region { rings, .. } => {
            let boxes = rings.iter().filter_map(|ring| hull(ring));
            let all = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
            grown(all, half(style.outline))
        }
        Op::Area { points, .. } => grown(hull(points)?, 0.0),
        Op::Disc { centre, radius, .. } => grown(disc(*centre, *radius)?, half(style.outline)),
        Op::Dot { centre, radius, .. } | Op::Face { centre, radius, .. } => {
            grown(disc(*centre, *radius)?, 0.0)
        }
        Op::Ring {
            centre,
            radius,
            width,
            ..
        } => grown(disc(*centre, *radius)?, half(*width)),
        Op::Line { points, width, .. } => grown(line(points)?, half(*width)),
        Op::Arrow {
            from, to, width, ..
        } => grown(hull(&arrow_outline(*from, *to, *width)?)?, 0.0),
        Op::Box {
            min, max, width, ..
        } => grown(line(&box_ring(*min, *max))?, half(*width)),
        Op::Label(label) => {
            if !(label.height > 0.0 && label.height <= MAX_STROKE) {
                return None;
            }
            let mut all: Option<(Vec2, Vec2)> = None;
            label.strokes(|stroke| {
                if let Some(one) = line(stroke) {
                    all = Some(all.map_or(one, |a| (a.0.min(one.0), a.1.max(one.1))));
                }
            });
            let weight = font::weight(label.height) + font::seam(label.height);
            grown(all?, 0.5 * weight)
        }
    }
}

fn disc(centre: Vec2, radius: f64) -> Option<(Vec2, Vec2)> {
    (radius > 0.0).then(|| (centre - Vec2::splat(radius), centre + Vec2::splat(radius)))
}

/// The box around the points of a line that are drawn: one that is not finite or far away is left out alone.
fn line(points: &[Vec2]) -> Option<(Vec2, Vec2)> {
    let near = points.iter().filter(|&&point| is_near(point));
    near.fold(None, |all: Option<(Vec2, Vec2)>, &point| {
        Some(all.map_or((point, point), |a| (a.0.min(point), a.1.max(point))))
    })
}

/// The box around a closed ring; `None` without points, or where one is not finite or far away: such a ring is left out.
fn hull(points: &[Vec2]) -> Option<(Vec2, Vec2)> {
    let first = *points.first()?;
    let (mut min, mut max) = (first, first);
    // A sum is no number where a point is none, or where points are infinite: neither ring is drawn.
    let mut sum = Vec2::ZERO;
    for &point in points {
        min = vec2(lesser(point.x, min.x), lesser(point.y, min.y));
        max = vec2(greater(point.x, max.x), greater(point.y, max.y));
        sum += point;
    }
    (!sum.is_nan() && is_near(min) && is_near(max)).then_some((min, max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ink, Label};
    use proptest::prelude::*;

    fn size() -> Size {
        Size::new(100, 80).unwrap()
    }

    fn pixels(op: &Op) -> PixelBox {
        let source = Source::default();
        Mark { op, source }.pixels(&Style::light(), size())
    }

    #[test]
    fn a_box_holds_its_mark_and_is_cut_to_the_canvas() {
        let dot = |centre: Vec2, radius: f64| Op::Dot {
            centre,
            radius,
            ink: Ink::Text,
        };
        let inside = pixels(&dot(vec2(50.5, 40.5), 3.0));
        assert_eq!(
            inside,
            PixelBox {
                left: 46,
                top: 36,
                right: 55,
                bottom: 45
            }
        );
        assert!(pixels(&dot(vec2(500.0, 40.0), 3.0)).is_empty());
        assert!(pixels(&dot(vec2(f64::NAN, 40.0), 3.0)).is_empty());
        assert!(pixels(&dot(vec2(50.0, 40.0), -1.0)).is_empty());
        assert_eq!(pixels(&dot(vec2(50.0, 40.0), 1e9)), PixelBox::of(size()));
    }

    proptest! {
        #[test]
        fn a_box_reaches_to_whole_pixels(x in -50.0..150.0_f64, y in -50.0..130.0_f64, w in 0.0..40.0_f64, on_pixels: bool) {
            let snap = |x: f64| if on_pixels { x.floor() } else { x };
            let (min, max) = (vec2(snap(x), snap(y)), vec2(snap(x + w), snap(y + w)));
            let corner = size().corner();
            let (low, high) = (min.clamp(Vec2::ZERO, corner), max.clamp(Vec2::ZERO, corner));
            let found = PixelBox::around(min, max, size());
            let [left, top, right, bottom] = [low.x, low.y, high.x.ceil(), high.y.ceil()].map(whole);
            let want = PixelBox { left, top, right, bottom };
            prop_assert_eq!(found, if want.is_empty() { PixelBox::EMPTY } else { want });
        }
    }

    #[test]
    fn a_label_has_the_box_of_its_strokes() {
        let label = Label::new(vec2(20.0, 40.0), "Hi", 10.0, Ink::Text);
        let found = pixels(&label.into());
        assert!(found.left >= 15 && found.right < 45 && found.top >= 26 && found.bottom <= 44);
    }
}
