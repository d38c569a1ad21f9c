//! Flyers: bodies that nothing holds. Each has one motion until something happens to it, and what
//! may happen is kept in one queue that lives across steps.
//!
//! A flyer is found by the box swept over its own *horizon*: the time to travel a part of a cell.
//! Prediction is lazy: a pair enters the queue with the instant from which on it is near enough to
//! meet, and its time of impact is sought only when that instant comes with both motions unchanged.
//! A body that nothing can happen to has no entry, and costs nothing.

mod aside;
mod circle;
mod foresee;
mod frame;
mod gap;
mod grid;
mod ground;
mod held;
mod piece;
mod queue;
mod seek;
mod streak;
mod strike;
mod together;
mod window;

use arrayvec::ArrayVec;
use carom_collision::{AxisFeature, BoxTree, ImpactFeature, NodeId, Side, roundable};
use carom_geometry::Aabb;
use carom_math::{SimTime, Vec2};

use crate::BodyId;
use crate::bodies::Bodies;
use crate::state::Collider;
use aside::Aside;
use circle::Registered;
pub(crate) use foresee::Cause;
use frame::{Frame, Track};
pub(crate) use grid::{Cells, Grid, Seat};
use queue::{Ahead, Entry, Queue};
use streak::Streak;

/// How a body flies.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Course {
    /// Until when other flyers have been looked for.
    pub(crate) horizon: SimTime,
    /// Until when what does not fly has been looked for.
    pub(crate) ground: SimTime,
    /// Where it is in the grid; none for what is too large for it, and is in the tree of boxes.
    pub(crate) cells: Option<Cells>,
    /// Moves in closed form, from event to event.
    pub(crate) flies: bool,
    /// Nothing was found where it looked down.
    pub(crate) alone: bool,
    /// Until when its motion stands for the law that it flies by; for ever where it is the law.
    pub(crate) piece: SimTime,
    /// Box of its bounding circle up to the horizon, in the frame that falls.
    pub(crate) swept: Aabb,
    /// Box of its bounding circle up to the end of its look at what does not fly, in the world.
    pub(crate) reached: Aabb,
    /// The earliest entries for the ends of both searches.
    pub(crate) entered: (SimTime, SimTime),
    /// How long it looked down for, in s.
    pub(crate) span: f64,
    /// When it found nothing there.
    pub(crate) clear_at: Option<SimTime>,
    /// The tick in which it last struck, and what its impacts spent in it.
    pub(crate) tick: i64,
    pub(crate) spent: f64,
    /// Node of that box in the tree aloft.
    pub(crate) node: Option<NodeId>,
    pub(crate) streak: Streak,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            flies: false,
            piece: SimTime::NEVER,
            horizon: SimTime::ZERO,
            swept: Aabb::EMPTY,
            cells: None,
            ground: SimTime::ZERO,
            reached: Aabb::EMPTY,
            span: 0.0,
            alone: false,
            clear_at: None,
            entered: (SimTime::NEVER, SimTime::NEVER),
            node: None,
            tick: 0,
            spent: 0.0,
            streak: Streak::default(),
        }
    }
}

impl Course {
    /// Until when all has been looked for that does not fly; all that flies, where nothing else is there.
    fn end_of_search(&self) -> SimTime {
        if self.ground == SimTime::NEVER {
            self.horizon
        } else {
            self.ground
        }
    }

    /// Until when the motion stands, if nothing changes it.
    pub(crate) fn stands_until(&self) -> SimTime {
        if self.flies {
            self.piece
        } else {
            SimTime::NEVER
        }
    }

    /// When a search ends, and the entry for that.
    fn end(&mut self, ahead: Ahead) -> (SimTime, &mut SimTime) {
        match ahead {
            Ahead::Ground => (self.ground, &mut self.entered.1),
            _ => (self.horizon, &mut self.entered.0),
        }
    }
}

/// An impact ahead: all that its response needs.
#[derive(Clone, Debug)]
pub(crate) struct Foreseen {
    pub(crate) bodies: (u32, u32),
    pub(crate) colliders: (u32, u32),
    /// Unit normal from the first body to the second.
    pub(crate) normal: Vec2,
    /// One point, or both ends of a common stretch, in m.
    pub(crate) points: ArrayVec<Vec2, 2>,
    /// What touches at the first point.
    pub(crate) feature: ImpactFeature,
}

impl Foreseen {
    /// Whose straight face is struck, if one is.
    const fn face(&self) -> Option<Side> {
        match self.feature.feature {
            AxisFeature::Edge { owner, .. } => Some(owner),
            AxisFeature::Vertices { .. } => None,
        }
    }
}

/// Boxes tested per search that a cell is sized for, where all searches follow impacts, and how many more where all
/// follow the ends of horizons: larger cells make horizons longer, and searches dearer.
const PARTNERS: (f64, f64) = (24.0, 72.0);

/// How much later the size of the cells is looked at again where it was right.
const FITS: usize = 8;

/// Cells that a box may cover before the body goes to the tree instead.
const MOST_CELLS: u64 = 64;

/// All that is ahead of flyers.
#[derive(Clone, Debug)]
pub(crate) struct Flyers {
    pub(crate) grid: Grid,
    frame: Frame,
    /// The frame has got too fast for its flyers.
    drifts: bool,
    /// There is, or was, something in the tree of boxes that they look down for.
    grounded: bool,
    /// Boxes of the grid's flyers in the world, while somebody needs to find them there.
    aloft: Option<BoxTree>,
    /// Circles of the grid's flyers, by body.
    circles: Vec<Registered>,
    /// Until when they have looked round, by body.
    horizons: Vec<SimTime>,
    queue: Queue,
    aside: Aside,
    impacts: Vec<Option<Foreseen>>,
    free: Vec<u32>,
    /// Mark of the last search that met a body.
    seen: Vec<u32>,
    mark: u32,
    /// Since the cells were sized: searches, those at the ends of horizons, and the boxes they tested.
    searches: usize,
    renewed: usize,
    met: usize,
    /// They were of the right size when that was last looked at.
    fits: bool,
    /// Scratch of a search: flyers, and shapes of what does not fly.
    near: Vec<u32>,
    shapes: Vec<u32>,
    /// The end of a low bounce, in s from the impact that is being resolved.
    hop: Option<(f64, Foreseen)>,
    /// The shapes whose impact is being resolved, and where they part.
    struck: Option<((u32, u32), ImpactFeature)>,
}

impl Flyers {
    /// No flyers yet, under uniform gravity.
    pub(crate) fn under(gravity: Vec2) -> Self {
        Self {
            grid: Grid::new(1.0, 0),
            frame: Frame::falling(gravity),
            drifts: false,
            grounded: false,
            aloft: None,
            circles: Vec::new(),
            horizons: Vec::new(),
            queue: Queue::default(),
            aside: Aside::default(),
            impacts: Vec::new(),
            free: Vec::new(),
            seen: Vec::new(),
            mark: 0,
            searches: 0,
            renewed: 0,
            met: 0,
            fits: false,
            near: Vec::new(),
            shapes: Vec::new(),
            hop: None,
            struck: None,
        }
    }

    /// When the next entry is due, if that is by `limit`.
    pub(crate) fn next(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        limit: SimTime,
    ) -> Option<SimTime> {
        let aside = self.aside.first().map(|entry| entry.time);
        let aside = aside.filter(|time| *time <= limit);
        self.next_queued(bodies, colliders, aside.unwrap_or(limit))
            .or(aside)
    }

    /// The same, of all that nobody laid aside.
    fn next_queued(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        limit: SimTime,
    ) -> Option<SimTime> {
        let (impacts, free) = (&mut self.impacts, &mut self.free);
        self.queue.next(limit, |entry| {
            let stale = is_stale(entry, bodies, colliders);
            if let (true, Ahead::Impact { slot }) = (stale, entry.ahead) {
                impacts[slot as usize] = None;
                free.push(slot);
            }
            stale
        })
    }

    /// Takes the next entry out; an impact with all that belongs to it.
    fn pop(&mut self) -> Option<(Entry, Option<Foreseen>)> {
        let aside = self.aside.first().copied();
        let entry = match (aside, self.queue.peek()) {
            (Some(first), other) if other.is_none_or(|other| first < *other) => {
                self.aside.take(&first);
                first
            }
            _ => self.queue.pop()?,
        };
        Some((entry, self.release(&entry)))
    }

    /// Takes the next entry that nobody laid aside out, if it is due by `limit`.
    fn pop_queued(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        limit: SimTime,
    ) -> Option<Entry> {
        self.next_queued(bodies, colliders, limit)?;
        self.queue.pop()
    }

    /// Takes the impacts of a body that were laid aside and are due by `limit`, in order.
    fn take_aside(&mut self, body: u32, limit: SimTime) -> Vec<Entry> {
        let due = self.aside.of(body).take_while(|e| e.time <= limit);
        let due: Vec<Entry> = due.copied().collect();
        for entry in &due {
            self.aside.take(entry);
        }
        due
    }

    fn release(&mut self, entry: &Entry) -> Option<Foreseen> {
        let Ahead::Impact { slot } = entry.ahead else {
            return None;
        };
        self.free.push(slot);
        self.impacts[slot as usize].take()
    }

    fn push_impact(&mut self, time: SimTime, stamp: u32, impact: Foreseen) {
        let (a, b) = impact.bodies;
        let slot = self.free.pop().unwrap_or_else(|| {
            self.impacts.push(None);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "fewer than 2^32 fit in memory"
            )]
            let slot = (self.impacts.len() - 1) as u32;
            slot
        });
        self.impacts[slot as usize] = Some(impact);
        let ahead = Ahead::Impact { slot };
        self.queue.push(Entry {
            time,
            a,
            b,
            stamp,
            ahead,
        });
    }

    /// Bodies of the grid whose boxes overlap that of a seat, each once.
    fn search(&mut self, seat: &Seat, cells: Cells, bodies: usize) -> Vec<u32> {
        let mut near = core::mem::take(&mut self.near);
        near.clear();
        if self.seen.len() < bodies {
            self.seen.resize(bodies, self.mark);
        }
        self.mark = self.mark.wrapping_add(1);
        let (mark, seen) = (self.mark, &mut self.seen);
        self.met += self.grid.gather(seat, cells, &mut near);
        near.retain(|body| {
            let last = core::mem::replace(&mut seen[*body as usize], mark);
            last != mark
        });
        near
    }

    /// Bodies of the grid that may be in `bounds` before they look down again, in order.
    pub(crate) fn overlapping(&self, bodies: &Bodies, bounds: Aabb, near: &mut Vec<u32>) {
        near.clear();
        if self.grid.count() == 0 {
            return;
        }
        let here = |body: u32| {
            let course = &bodies.get(body).course;
            course.cells.is_some() && course.reached.overlaps(bounds)
        };
        match &self.aloft {
            Some(tree) => tree.query(bounds, |body| {
                if here(body) {
                    near.push(body);
                }
            }),
            None => near.extend(bodies.indices().filter(|body| here(*body))),
        }
        near.sort_unstable();
    }

    /// Bodies of the grid that may be in `bounds` at `time`, in order.
    pub(crate) fn present(&self, bodies: &Bodies, bounds: Aabb, time: SimTime) -> Vec<u32> {
        let mut near = Vec::new();
        if self.grid.count() == 0 {
            return near;
        }
        let seen = Aabb::new(
            self.frame.point(bounds.min, time),
            self.frame.point(bounds.max, time),
        );
        let here = |body: u32| {
            let course = &bodies.get(body).course;
            course.cells.is_some() && course.swept.overlaps(seen)
        };
        let cells = self.grid.cells(seen);
        if cells.count() > self.grid.count() as u64 {
            near.extend(bodies.indices().filter(|body| here(*body)));
        } else {
            let seat = Seat::new(u32::MAX, seen);
            self.grid.gather(&seat, cells, &mut near);
            near.retain(|body| here(*body));
        }
        near.sort_unstable();
        near.dedup();
        near
    }

    /// From now on bodies look for flyers by boxes in the world.
    pub(crate) fn raise(&mut self, bodies: &mut Bodies) {
        let mut tree = BoxTree::new();
        for index in bodies.indices().collect::<Vec<_>>() {
            let course = &mut bodies.get_mut(index).course;
            course.node = course.cells.map(|_| {
                let bounds = course.reached;
                tree.insert(bounds.grown(roundable(bounds)), index)
            });
        }
        self.aloft = Some(tree);
    }

    /// Whether bodies look for flyers by boxes in the world.
    const fn is_raised(&self) -> bool {
        self.aloft.is_some()
    }

    /// Nobody looks for flyers any more.
    pub(crate) fn lower(&mut self) {
        self.aloft = None;
    }

    /// Keeps the box in the world of a flyer in the grid.
    fn lift(&mut self, course: &mut Course, index: u32) {
        let Some(tree) = &mut self.aloft else {
            course.node = None;
            return;
        };
        let bounds = course.reached.grown(roundable(course.reached));
        match course.node {
            Some(node) => {
                tree.update(node, bounds);
            }
            None => course.node = Some(tree.insert(bounds, index)),
        }
    }

    /// Puts a body into the grid, if it fits.
    fn enter(&mut self, bodies: &mut Bodies, colliders: &[Collider], index: u32) -> bool {
        let course = &mut bodies.get_mut(index).course;
        if !course.swept.is_finite() {
            return false;
        }
        let cells = self.grid.cells(course.swept);
        if cells.count() > MOST_CELLS {
            return false;
        }
        self.grid.insert(Seat::new(index, course.swept), cells);
        course.cells = Some(cells);
        let place = index as usize;
        if self.circles.len() <= place {
            self.circles.resize(place + 1, Registered::default());
            self.horizons.resize(place + 1, SimTime::ZERO);
        }
        let state = bodies.get(index);
        self.circles[place] = Registered::of(state, colliders, &self.frame);
        self.horizons[place] = state.course.horizon;
        true
    }

    /// Takes a body out of the grid.
    fn leave(&mut self, bodies: &mut Bodies, index: u32) {
        let course = &mut bodies.get_mut(index).course;
        if let Some(cells) = course.cells.take() {
            self.grid.remove(index, cells);
        }
    }

    /// Reports the end of infinitely many impacts at its instant, if both bodies are still there.
    fn announce(&mut self, time: SimTime, ids: [BodyId; 2]) {
        let ahead = Ahead::Collapse;
        let [a, b] = ids.map(|id| id.index);
        self.queue.push(Entry {
            time,
            a,
            b,
            stamp: generations(ids),
            ahead,
        });
    }

    /// Takes a body out of the grid, and its box out of the tree aloft.
    pub(crate) fn vanish(&mut self, bodies: &mut Bodies, index: u32) {
        self.leave(bodies, index);
        let node = bodies.get_mut(index).course.node.take();
        if let (Some(tree), Some(node)) = (&mut self.aloft, node) {
            tree.remove(node);
        }
    }

    /// Sizes the cells anew where searches meet too many bodies, or hardly any.
    fn resize(&mut self, bodies: &mut Bodies, time: SimTime) {
        let crowded = self.grid.count() > self.grid.room();
        let patience = if self.fits { FITS } else { 1 };
        if self.searches < patience * 64.max(self.grid.count()) && !crowded {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^52 searches")]
        let (met, renewed) = {
            let searches = self.searches.max(1) as f64;
            (self.met as f64 / searches, self.renewed as f64 / searches)
        };
        (self.searches, self.renewed, self.met) = (0, 0, 0);
        let flying: Vec<u32> = bodies
            .indices()
            .filter(|i| bodies.get(*i).course.cells.is_some())
            .collect();
        if flying.is_empty() {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^32 bodies")]
        let reach = flying.iter().map(|i| bodies.get(*i).reach).sum::<f64>() / flying.len() as f64;
        self.drifts = drift(&self.frame, bodies, &flying, time).is_some();
        // What is met grows with the area that is searched.
        let wanted = (PARTNERS.0 + PARTNERS.1 * renewed) / met.max(1.0);
        let factor = if (0.5..2.0).contains(&wanted) {
            1.0
        } else {
            wanted.sqrt().clamp(0.5, 4.0)
        };
        let side = (factor * self.grid.side()).clamp(2.0 * reach, 1e6 * reach);
        self.fits = (side - self.grid.side()).abs() < 0.1 * side && !crowded;
        if self.fits {
            return;
        }
        self.grid = Grid::new(side, flying.len());
        for index in flying {
            let course = &mut bodies.get_mut(index).course;
            let cells = self.grid.cells(course.swept);
            self.grid.insert(Seat::new(index, course.swept), cells);
            course.cells = Some(cells);
        }
    }
}

/// Mean velocity of flyers in the frame, in m/s, where it is faster than they are among themselves.
fn drift(frame: &Frame, bodies: &Bodies, flying: &[u32], time: SimTime) -> Option<Vec2> {
    let (mut sum, mut squares) = (Vec2::ZERO, 0.0);
    for &index in flying {
        let track = Track::of(&bodies.get(index).motion, time);
        let velocity = frame.track(&track, time).velocity;
        sum += velocity;
        squares += velocity.length_squared();
    }
    #[expect(clippy::cast_precision_loss, reason = "fewer than 2^32 bodies")]
    let count = flying.len() as f64;
    let mean = sum / count;
    // The mean square is that of the mean and that about it.
    let square = mean.length_squared();
    (square > 2.0 * (squares / count - square)).then_some(mean)
}

/// Whether an entry is for nothing: a motion has changed since it was made, or another one comes before it.
fn is_stale(entry: &Entry, bodies: &Bodies, colliders: &[Collider]) -> bool {
    let version = |index: u32| bodies.version(index);
    let other = match entry.ahead {
        Ahead::Collapse => {
            let ids = [entry.a, entry.b].map(|index| bodies.get(index).id);
            let alive = bodies.is_alive(entry.a) && bodies.is_alive(entry.b);
            return !alive || generations(ids) != entry.stamp;
        }
        Ahead::Horizon => return bodies.get(entry.a).course.entered.0 != entry.time,
        Ahead::Ground => return bodies.get(entry.a).course.entered.1 != entry.time,
        Ahead::NearShape => colliders[entry.b as usize].body,
        _ => entry.b,
    };
    version(entry.a).wrapping_add(version(other)) != entry.stamp
}

/// Generations of a place only grow, so that their sum is equal only if both are.
const fn generations([a, b]: [BodyId; 2]) -> u32 {
    a.generation.wrapping_add(b.generation)
}
