//! Events ahead of free bodies: entries of the calendar queue with their impacts, and which of them are stale.

use arrayvec::ArrayVec;
use carom_collision::{AxisFeature, Impact, ImpactFeature, Side};
use carom_math::{SimTime, Vec2};

use super::FreeBodies;
use super::queue::{Entry, What};
use crate::store::bodies::Bodies;
use crate::{BodyId, BodyIx, ColliderIx, Ix, Two};

/// An impact ahead: all that its response needs.
#[derive(Clone, Debug)]
pub(crate) struct Foreseen {
    pub(crate) bodies: Two<BodyIx>,
    pub(crate) colliders: Two<ColliderIx>,
    /// Unit normal from the first body to the second.
    pub(crate) normal: Vec2,
    /// One point, or both ends of a common stretch, in m.
    pub(crate) points: ArrayVec<Vec2, 2>,
    /// What touches at the first point.
    pub(crate) feature: ImpactFeature,
}

impl Foreseen {
    /// What a search found for these shapes of two bodies.
    pub(super) fn of(bodies: Two<BodyIx>, colliders: Two<ColliderIx>, impact: &Impact) -> Self {
        Self {
            bodies,
            colliders,
            normal: impact.normal,
            points: impact.points.clone(),
            feature: impact.features[0],
        }
    }

    /// The side with the straight face that is struck, if one is.
    pub(super) const fn face(&self) -> Option<Side> {
        match self.feature.feature {
            AxisFeature::Edge { owner, .. } => Some(owner),
            AxisFeature::Vertices { .. } => None,
        }
    }
}

impl FreeBodies {
    /// When the next entry is due, if that is by `limit`.
    pub(crate) fn next(&mut self, bodies: &Bodies, limit: SimTime) -> Option<SimTime> {
        let aside = self.aside.first().map(|entry| entry.time);
        let aside = aside.filter(|time| *time <= limit);
        self.next_queued(bodies, aside.unwrap_or(limit)).or(aside)
    }

    /// The same, of all entries not laid aside.
    fn next_queued(&mut self, bodies: &Bodies, limit: SimTime) -> Option<SimTime> {
        let impacts = &mut self.impacts;
        self.queue.next(limit, |entry| {
            let stale = is_stale(entry, bodies);
            if let (true, Some(slot)) = (stale, entry.what.slot()) {
                impacts.remove(slot);
            }
            stale
        })
    }

    /// Takes the next entry out; an impact with all that belongs to it.
    pub(super) fn pop(&mut self) -> Option<(Entry, Option<Foreseen>)> {
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

    /// Takes the next entry not laid aside out, if it is due by `limit`.
    pub(super) fn pop_queued(&mut self, bodies: &Bodies, limit: SimTime) -> Option<Entry> {
        self.next_queued(bodies, limit)?;
        self.queue.pop()
    }

    /// Takes the impacts of a body that were laid aside and are due by `limit`, in order.
    pub(super) fn take_aside(&mut self, body: BodyIx, limit: SimTime) -> Vec<Entry> {
        let due = self.aside.of(body).take_while(|e| e.time <= limit);
        let due: Vec<Entry> = due.copied().collect();
        for entry in &due {
            self.aside.take(entry);
        }
        due
    }

    pub(super) fn release(&mut self, entry: &Entry) -> Option<Foreseen> {
        self.impacts.remove(entry.what.slot()?)
    }

    pub(super) fn push_impact(&mut self, time: SimTime, stamp: u32, impact: Foreseen) {
        let (a, b) = impact.bodies;
        let slot = self.impacts.insert(impact);
        self.queue.push(Entry {
            time,
            a,
            b: b.number(),
            stamp,
            what: What::impact(slot),
        });
    }

    /// Reports the end of infinitely many impacts at its instant, if both bodies are still there.
    pub(super) fn announce(&mut self, time: SimTime, ids: [BodyId; 2]) {
        let [a, b] = ids.map(|id| id.index);
        self.queue.push(Entry {
            time,
            a,
            b: b.number(),
            stamp: generations(ids),
            what: What::COLLAPSE,
        });
    }
}

/// Whether an entry is for nothing: a motion has changed since it was made, or another one comes before it.
pub(super) fn is_stale(entry: &Entry, bodies: &Bodies) -> bool {
    let version = |index: BodyIx| bodies.version(index);
    let other = match entry.what {
        What::COLLAPSE => {
            let ids = [entry.a, entry.other()].map(|index| bodies.get(index).id);
            let alive = bodies.is_alive(entry.a) && bodies.is_alive(entry.other());
            return !alive || generations(ids) != entry.stamp;
        }
        What::HORIZON => return bodies.get(entry.a).course.entered.0 != entry.time,
        What::GROUND => return bodies.get(entry.a).course.entered.1 != entry.time,
        What::NEAR_SHAPE => bodies.colliders[entry.shape()].body,
        _ => entry.other(),
    };
    version(entry.a).wrapping_add(version(other)) != entry.stamp
}

/// Generations of a place only grow, so that their sum is equal only if both are.
const fn generations([a, b]: [BodyId; 2]) -> u32 {
    a.generation.wrapping_add(b.generation)
}
