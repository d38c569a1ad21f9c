//! What a free body remembers: where it sweeps, what was searched for around it, and its last impacts.

use carom_math::SimTime;

use super::swept::{Cells, Sides};
use super::zeno::ZenoSeries;

/// How a free body moves, and what was searched for around it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Course {
    /// Until when what does not fly has been looked for.
    pub(crate) ground: SimTime,
    /// Until when it has looked round for free bodies, where it is in the grid.
    pub(crate) horizon: SimTime,
    /// Where it is in the grid; none for what is too large for it, and is in the tree of boxes.
    pub(crate) cells: Option<Cells>,
    /// Nothing was found where it looked down, but for half-planes.
    pub(crate) alone: bool,
    /// Box of its bounding circle up to the horizon, in the frame that falls.
    pub(crate) swept: Sides,
    /// Box of its bounding circle up to the end of its look at what does not fly, in the world.
    pub(crate) reached: Sides,
    /// The earliest entries for the ends of both searches.
    pub(crate) entered: (SimTime, SimTime),
    /// How long it looked down for, in s.
    pub(crate) span: f64,
    /// Way of its first look down, as a part of the longest: less where it found much.
    pub(crate) look: f64,
    /// The tick in which it last struck, and what its impacts spent in it.
    pub(crate) tick: u64,
    pub(crate) spent: f64,
    /// Its last impacts, while they come ever faster.
    pub(crate) series: ZenoSeries,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            swept: Sides::NOTHING,
            cells: None,
            ground: SimTime::ZERO,
            horizon: SimTime::ZERO,
            reached: Sides::NOTHING,
            span: 0.0,
            look: 1.0,
            alone: false,
            entered: (SimTime::NEVER, SimTime::NEVER),
            tick: 0,
            spent: 0.0,
            series: ZenoSeries::default(),
        }
    }
}
