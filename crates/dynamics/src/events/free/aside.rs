//! Impacts that are due at the instant of another one.
//!
//! The first impact looks for others that are due, and is resolved together with those of its cluster. The rest are
//! laid aside, where they are found by their bodies: of thousands at one instant each is examined once.

use std::collections::BTreeSet;

use super::queue::Entry;
use crate::BodyIx;

/// Impacts laid aside, in order, and by body.
#[derive(Clone, Debug, Default)]
pub(super) struct Aside {
    entries: BTreeSet<Entry>,
    /// `None` comes before all entries of a body.
    by_body: BTreeSet<(BodyIx, Option<Entry>)>,
}

impl Aside {
    pub(super) fn first(&self) -> Option<&Entry> {
        self.entries.first()
    }

    pub(super) fn lay(&mut self, entry: Entry) {
        self.entries.insert(entry);
        for body in [entry.a, entry.other()] {
            self.by_body.insert((body, Some(entry)));
        }
    }

    pub(super) fn take(&mut self, entry: &Entry) {
        self.entries.remove(entry);
        for body in [entry.a, entry.other()] {
            self.by_body.remove(&(body, Some(*entry)));
        }
    }

    /// Those of a body, in order.
    pub(super) fn of(&self, body: BodyIx) -> impl Iterator<Item = &Entry> {
        self.by_body
            .range((body, None)..)
            .take_while(move |(other, _)| *other == body)
            .filter_map(|(_, entry)| entry.as_ref())
    }
}
