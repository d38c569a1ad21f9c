//! Where the time of a step goes, by a clock that the caller hands in.

/// Seconds that the last step spent in each of its stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepProfile {
    /// What enters and leaves the engine, and which bodies may meet its members.
    pub contacts: f64,
    /// Sub-steps of the engine.
    pub solver: f64,
    /// Events: impacts, modes of contact islands, and the searches for the next ones.
    pub impacts: f64,
}

impl StepProfile {
    /// The stages in order, by name.
    #[must_use]
    pub const fn stages(&self) -> [(&'static str, f64); 3] {
        [
            ("contacts", self.contacts),
            ("solver", self.solver),
            ("impacts", self.impacts),
        ]
    }

    /// The whole step.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.stages().iter().map(|(_, seconds)| seconds).sum()
    }
}

/// Laps between stages; without a clock it does nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stopwatch {
    pub(crate) clock: Option<fn() -> f64>,
    pub(crate) profile: StepProfile,
    last: f64,
}

impl Stopwatch {
    /// A new step begins.
    pub(crate) fn start(&mut self) {
        if let Some(clock) = self.clock {
            self.profile = StepProfile::default();
            self.last = clock();
        }
    }

    /// What passed since the last lap was `stage`.
    pub(crate) fn lap(&mut self, stage: fn(&mut StepProfile) -> &mut f64) {
        if let Some(clock) = self.clock {
            let now = clock();
            *stage(&mut self.profile) += now - self.last;
            self.last = now;
        }
    }
}
