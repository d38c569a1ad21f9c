//! Free bodies: no contact holds them. Each has one motion until something happens to it, and what
//! may happen is kept in one queue that lives across steps.
//!
//! A free body is found by the box swept over its own *horizon*: the time to travel a part of a cell.
//! Prediction is lazy: a pair enters the queue with the instant from which on it is near enough to
//! meet, and its time of impact is sought only when that instant comes with both motions unchanged.
//! A body that nothing can happen to has no entry, and costs nothing.

mod aside;
mod circle;
mod foresee;
mod foreseen;
mod ground;
mod held;
mod low;
mod piece;
mod present;
mod queue;
mod seek;
mod strike;
mod together;
mod turning;

use std::collections::BTreeSet;

use carom_collision::{BoxTree, ImpactFeature, NodeId};
use carom_math::{SimTime, Vec2};

use crate::broad::free_fall_frame::{Frame, Track};
use crate::broad::grid::{Grid, SweptBox};
use crate::store::bodies::Bodies;
use crate::store::course::Course;
use crate::store::slots::{List, Slots};
use crate::{BodyIx, ColliderIx, ImpactIx, Two};
use aside::Aside;
pub(crate) use foresee::Cause;
pub(crate) use foreseen::Foreseen;

use queue::{Queue, What};

impl Course {
    /// The earliest entry for the end of a search.
    fn entered(&mut self, what: What) -> &mut SimTime {
        match what {
            What::GROUND => &mut self.entered.1,
            _ => &mut self.entered.0,
        }
    }

    /// Until when other free bodies have been looked for; by those that are not in the grid, where they look for all.
    fn horizon(&self) -> SimTime {
        if self.cells.is_some() {
            self.horizon
        } else {
            self.ground
        }
    }

    /// Until when all has been looked for that does not fly; all that flies, where nothing else is there.
    fn end_of_search(&self) -> SimTime {
        if self.ground == SimTime::NEVER {
            self.horizon()
        } else {
            self.ground
        }
    }

    /// When a search ends.
    fn end(&self, what: What) -> SimTime {
        match what {
            What::GROUND => self.ground,
            _ => self.horizon(),
        }
    }
}

/// Boxes tested per search that a cell is sized for, where all searches follow impacts, and how many more where all
/// follow the ends of horizons: larger cells make horizons longer, and searches dearer.
const PARTNERS: (f64, f64) = (16.0, 72.0);

/// How much later the size of the cells is looked at again where it was right.
const FITS: usize = 8;

/// Cells that a box may cover before the body goes to the tree instead.
const MOST_CELLS: u64 = 64;

/// The free bodies of a world, and their calendar queue.
#[derive(Clone, Debug, Default)]
pub(crate) struct FreeBodies {
    pub(crate) grid: Grid,
    frame: Frame,
    /// The frame has got too fast for its bodies.
    drifts: bool,
    /// There is, or was, something in the tree of boxes that they look down for.
    grounded: bool,
    /// Boxes of the grid's free bodies in the world, while other bodies need to find them there.
    aloft: Option<BoxTree>,
    /// When they go, if no body waits for its method then.
    raised_until: SimTime,
    /// Their nodes there, by body.
    nodes: List<BodyIx, Option<NodeId>>,
    /// Bodies in the grid.
    in_grid: BTreeSet<BodyIx>,
    queue: Queue,
    aside: Aside,
    impacts: Slots<ImpactIx, Foreseen>,
    /// Mark of the last search that met a body.
    seen: List<BodyIx, u32>,
    mark: u32,
    /// Since the cells were sized: searches, those at the ends of horizons, and the boxes they tested.
    searches: usize,
    renewed: usize,
    met: usize,
    /// They were of the right size when that was last looked at.
    fits: bool,
    /// Scratch of a search: free bodies, and shapes of bodies that are not free.
    near: Vec<BodyIx>,
    shapes: Vec<ColliderIx>,
    /// The end of a micro-bounce, in s from the impact that is being resolved.
    micro_bounce: Option<(f64, Foreseen)>,
    /// The shapes in the impact that is being resolved, and where they part.
    struck: Option<(Two<ColliderIx>, ImpactFeature)>,
    /// Bodies that began to last in contact, when, and how often at that instant.
    lasting: (Two<BodyIx>, SimTime, u32),
}

impl FreeBodies {
    /// No free bodies yet, under uniform gravity.
    pub(crate) fn under(gravity: Vec2) -> Self {
        Self {
            frame: Frame::falling(gravity),
            ..Self::default()
        }
    }

    /// Makes room for so many more.
    pub(crate) fn reserve(&mut self, more: usize) {
        self.seen.reserve_exact(more);
    }

    /// Puts a body into the grid, if it fits, or where it belongs there by now.
    fn enter(&mut self, bodies: &mut Bodies, index: BodyIx, horizon: SimTime) -> bool {
        let course = &mut bodies.get_mut(index).course;
        let cells = self.grid.cells(course.swept.bounds());
        if !course.swept.is_finite() || cells.count() > MOST_CELLS {
            self.leave(bodies, index);
            return false;
        }
        course.horizon = horizon;
        if let Some(known) = course.cells.replace(cells) {
            self.grid.remove(index, known);
        } else {
            self.in_grid.insert(index);
        }
        self.grid.insert(SweptBox::new(index, course.swept), cells);
        true
    }

    /// Takes a body out of the grid.
    fn leave(&mut self, bodies: &mut Bodies, index: BodyIx) {
        let course = &mut bodies.get_mut(index).course;
        if let Some(cells) = course.cells.take() {
            self.grid.remove(index, cells);
            self.in_grid.remove(&index);
        }
    }

    /// Bodies of the grid, in order.
    fn in_order(&self) -> Vec<BodyIx> {
        self.in_grid.iter().copied().collect()
    }

    /// Sizes the cells anew where searches meet too many bodies, or hardly any.
    fn resize(&mut self, bodies: &mut Bodies, time: SimTime) {
        let overfull = self.in_grid.len() > self.grid.room();
        let patience = if self.fits { FITS } else { 1 };
        if self.searches < patience * 64.max(self.in_grid.len()) && !overfull {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^52 searches")]
        let (met, renewed) = {
            let searches = self.searches.max(1) as f64;
            (self.met as f64 / searches, self.renewed as f64 / searches)
        };
        (self.searches, self.renewed, self.met) = (0, 0, 0);
        let free = self.in_order();
        if free.is_empty() {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^32 bodies")]
        let reach = free.iter().map(|i| bodies.get(*i).reach).sum::<f64>() / free.len() as f64;
        self.drifts = drift(&self.frame, bodies, &free, time).is_some();
        // What is met grows with the area that is searched.
        let wanted = (PARTNERS.0 + PARTNERS.1 * renewed) / met.max(1.0);
        let factor = if (0.7..1.4).contains(&wanted) {
            1.0
        } else {
            wanted.sqrt().clamp(0.5, 4.0)
        };
        let side = (factor * self.grid.side()).clamp(2.0 * reach, 1e6 * reach);
        self.fits = (side - self.grid.side()).abs() < 0.1 * side && !overfull;
        if self.fits {
            return;
        }
        self.grid = Grid::new(side, free.len());
        for index in free {
            let course = &mut bodies.get_mut(index).course;
            let cells = self.grid.cells(course.swept.bounds());
            self.grid.insert(SweptBox::new(index, course.swept), cells);
            course.cells = Some(cells);
        }
    }
}

/// Mean velocity of free bodies in the frame, in m/s, where it is faster than they are among themselves.
fn drift(frame: &Frame, bodies: &Bodies, free: &[BodyIx], time: SimTime) -> Option<Vec2> {
    let (mut sum, mut squares) = (Vec2::ZERO, 0.0);
    for &index in free {
        let track = Track::of(&bodies.get(index).motion, time);
        let velocity = frame.track(&track, time).velocity;
        sum += velocity;
        squares += velocity.length_squared();
    }
    #[expect(clippy::cast_precision_loss, reason = "fewer than 2^32 bodies")]
    let count = free.len() as f64;
    let mean = sum / count;
    // The mean square is that of the mean and that about it.
    let square = mean.length_squared();
    (square > 2.0 * (squares / count - square)).then_some(mean)
}
