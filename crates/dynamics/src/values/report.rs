//! What a step did, in numbers.

use core::ops::AddAssign;

use thiserror::Error;

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// Seconds that passed: less than asked for where a step to the next event found one, or its work was
    /// [used up](crate::Settings::work).
    pub advanced: f64,
    /// Sub-steps that began.
    pub substeps: u64,
    /// Impacts with an impulse. Of bodies that the engine of `carom-stepped` moves they are noted where events are.
    pub impacts: u64,
    /// Sub-steps of single bodies that were solved for as part of a group in lasting contact.
    pub handed_over: u64,
    /// Pairs with impacts that outran the budget of a sub-step, or of a tick in flight, or that are squeezed by driven bodies;
    /// the solver took the rest.
    pub collapsed: u64,
    /// Searches for a time of impact that ended without an answer; the pair is watched by overlap.
    pub unresolved: u64,
    /// Pairs looked at by shape.
    pub pairs: u64,
    /// Contact rows that were solved for.
    pub rows: u64,
    /// Mode solves of contact islands: a closed form until the next change of mode, if there is one.
    pub modes_solved: u64,
    /// Flights in fields that leave out more than [`Settings::field_error`](crate::Settings::field_error) in their shortest pieces.
    pub inaccurate: u64,
    /// Pairs found deeper in each other at the start of a sub-step, or at the end of the call, than a touch is, 1e-9 of the smaller
    /// body's reach: an impact came late, a contact gave way, or they were put so.
    pub sunken: u64,
    /// Bodies that were stopped because a number was no longer finite.
    pub stopped: u64,
    /// Deepest overlap seen at the start or the end of a sub-step, or at the end of the call, in m, ≥ 0.
    pub deepest_overlap: f64,
    /// Why nothing happened, if the step was refused.
    pub refused: Option<Refusal>,
}

impl StepReport {
    /// Whether every motion came from a closed form: nothing was sub-stepped, cut off or stopped, each is as near as was
    /// asked for, and none lets bodies sink into each other.
    #[must_use]
    pub const fn is_exact(&self) -> bool {
        self.handed_over == 0
            && self.collapsed == 0
            && self.unresolved == 0
            && self.inaccurate == 0
            && self.sunken == 0
            && self.stopped == 0
            && self.refused.is_none()
    }
}

/// Sums of counts and time, the deeper overlap, the first refusal.
impl AddAssign for StepReport {
    fn add_assign(&mut self, later: Self) {
        self.advanced += later.advanced;
        self.substeps += later.substeps;
        self.impacts += later.impacts;
        self.handed_over += later.handed_over;
        self.collapsed += later.collapsed;
        self.unresolved += later.unresolved;
        self.pairs += later.pairs;
        self.rows += later.rows;
        self.modes_solved += later.modes_solved;
        self.inaccurate += later.inaccurate;
        self.sunken += later.sunken;
        self.stopped += later.stopped;
        if later.deepest_overlap > self.deepest_overlap {
            self.deepest_overlap = later.deepest_overlap;
        }
        self.refused = self.refused.or(later.refused);
    }
}

/// Why a step was refused. The world is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The step is NaN or infinite.
    #[error("dt is {dt}, not a finite number")]
    NotFinite {
        /// What was asked for, in s.
        dt: f64,
    },
    /// The step goes backwards.
    #[error("dt is {dt} s, below 0")]
    Negative {
        /// What was asked for, in s.
        dt: f64,
    },
    /// The step holds more than 1e7 ticks.
    #[error("dt is {dt:e} s, more than {limit:e} s (1e7 ticks)")]
    TooLong {
        /// What was asked for, in s.
        dt: f64,
        /// Longest step that is accepted, in s.
        limit: f64,
    },
}
