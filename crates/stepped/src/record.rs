//! What is kept of a body beside its line.

use carom_math::{Pose, trig};

use crate::bodies::Bodies;
use crate::input::BodyKind;
use crate::rows::{Line, Quad};

/// What is kept of a body, awake or not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    pub(crate) generation: u32,
    pub(crate) kind: BodyKind,
    pub(crate) live: bool,
    /// Its line: [`Bodies::GROUND`] if fixed.
    pub(crate) line: u32,
    /// Pieces are numbered from here on.
    pub(crate) first_piece: u32,
    pub(crate) pieces: u32,
    /// Counts insertions: the order of bodies that recycled slots cannot change.
    pub(crate) birth: u64,
    /// Head of the list of its contacts.
    pub(crate) contacts: u32,
    /// A bit for each colour that has a contact of it.
    pub(crate) colours: u64,
    /// Where a fixed body is; others have theirs by line.
    pub(crate) pose: Pose,
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
    pub(crate) gravity_scale: f64,
    /// Distance of its farthest point from the centre of mass, in m.
    pub(crate) reach: f64,
    /// The island that it sleeps in, or [`Bodies::NONE`].
    pub(crate) island: u32,
    /// What velocity and spin lose by themselves, in 1/s.
    pub(crate) damping: [f64; 2],
    pub(crate) tag: u64,
}

/// A body without its line: what waking puts back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sleeper {
    pub(crate) slot: u32,
    pub(crate) line: Line,
    pub(crate) start: Quad,
    pub(crate) pull: Quad,
    pub(crate) base: Pose,
    pub(crate) turned: f64,
    pub(crate) limit: Limit,
    /// Its contacts are not those of where it lies.
    pub(crate) moved: bool,
}

impl Sleeper {
    /// Whether it was put to sleep before its contacts were found.
    pub(crate) const fn is_unmet(&self) -> bool {
        self.moved
    }
}

/// How far a body may go from its base pose before its contacts are computed anew.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    /// Distance of its farthest point from the centre of mass, in m.
    pub(crate) reach: f64,
    /// In m.
    pub(crate) tolerance: f64,
    /// Of its smallest piece, in m.
    pub(crate) extent: f64,
}

/// What a sub-step of `h` seconds leaves of velocity and spin that lose `rates` of themselves in a second, and what part of
/// their accelerations it adds: `v' = a − c v` gives `v(h) = e^(−ch) v + h a (1 − e^(−ch))/(ch)`.
pub(crate) fn drag(rates: [f64; 2], h: f64) -> [Quad; 2] {
    let [linear, angular] = rates.map(|rate| {
        let loss = rate * h;
        if loss > 0.0 {
            (trig::exp(-loss), -trig::exp_m1(-loss) / loss)
        } else {
            (1.0, 1.0)
        }
    });
    [
        Quad([linear.0, linear.0, angular.0, 1.0]),
        Quad([linear.1, linear.1, angular.1, 1.0]),
    ]
}

/// [`drag`] of what is not damped.
pub(crate) const UNDAMPED: [Quad; 2] = [Quad([1.0; 4]); 2];

impl Record {
    pub(crate) const NONE: Self = Self {
        generation: 0,
        kind: BodyKind::Fixed,
        live: false,
        line: Bodies::NONE,
        first_piece: 0,
        pieces: 0,
        birth: 0,
        contacts: u32::MAX,
        colours: 0,
        pose: Pose::IDENTITY,
        mass: f64::INFINITY,
        inertia: f64::INFINITY,
        gravity_scale: 0.0,
        reach: 0.0,
        island: Bodies::NONE,
        damping: [0.0; 2],
        tag: 0,
    };
}
