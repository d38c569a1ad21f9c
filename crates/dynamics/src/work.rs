//! The work of a call, which is bounded by a count ([`Settings::work`](crate::Settings::work)), never by a clock.

use crate::World;

/// So many bodies share [`Settings::work`](crate::Settings::work).
const SHARERS: f64 = 1000.0;

/// What a piece of a law counts for, in events: near the centre of a strong field it takes 70 µs, most events take 1 to 10.
const PIECE: u64 = 16;

/// Floating-point operations of an impact of several contacts that count for one event: 2,400, of two contacts with friction, take
/// 12 µs; most events take 1 to 10. The more they are, the longer is a call of such impacts beside one of other events; the fewer,
/// the earlier it stops.
const OPERATIONS: u64 = 1000;

/// The work of a call: what is done, and when it stops.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Events so far; pairs are counted by the report.
    done: u64,
    most: f64,
    used_up: bool,
}

impl Work {
    /// Counts a piece of a law.
    pub(crate) const fn piece(&mut self) {
        self.done += PIECE;
    }

    /// Counts an impact of several contacts by its `operations`, beside the event that it is.
    pub(crate) const fn impact(&mut self, operations: u64) {
        self.done += operations / OPERATIONS;
    }

    /// Whether the call stopped at its bound.
    pub(crate) const fn is_used_up(&self) -> bool {
        self.used_up
    }

    /// Counts an event; whether the step stops after it, since its work is used up. `pairs`: those that were looked at so far.
    ///
    /// Sub-steps that are made ahead cannot be looked into.
    pub(crate) const fn uses_up(&mut self, pairs: u64) -> bool {
        self.done += 1;
        self.used_up = (self.done + pairs) as f64 >= self.most;
        self.used_up
    }
}

impl World {
    /// Begins a call of `dt` seconds: it may take so many events and pairs a tick, and a thousand bodies.
    pub(crate) fn begin_work(&mut self, dt: f64) {
        let ticks = (dt / self.settings.tick).max(1.0);
        let shares = (self.bodies.places() as f64 / SHARERS).max(1.0);
        self.work = Work {
            most: self.settings.work as f64 * ticks * shares,
            ..Work::default()
        };
    }
}
