//! What touches, as callers see it: begins, ends, and contacts read from the engine.

use carom_collision::part_count;
use carom_geometry::Aabb;
use carom_math::SimTime;

use super::{Stepping, collider};
use crate::store::bodies::Bodies;
use crate::store::pairs::Shapes;
use crate::{BodyIx, ColliderIx, Contact, ContactPoint, EventKind, Events, StepReport};

impl Stepping {
    /// Begins and ends of touch since this was last called, in order of shapes.
    ///
    /// `told`: shapes that touched when one of their bodies joined.
    pub(crate) fn tell_touches(
        &mut self,
        bodies: &Bodies,
        told: &mut Vec<Shapes>,
        events: &mut Events,
        time: SimTime,
    ) {
        self.engine.touches(&mut self.changes);
        // What a shape pair's pieces gained in touches; told: it touched when one of its bodies joined.
        let mut changed: Vec<(Shapes, i32, bool)> = Vec::with_capacity(self.changes.len());
        for change in self.changes.drain(..) {
            let gained = if change.begins { 1 } else { -1 };
            changed.push((shapes_of(bodies, change.tags), gained, false));
        }
        // What joined within a sub-step waits to be entered: the engine cannot say yet whether it still touches.
        let waits = |index: BodyIx| self.id(index).is_none() && bodies.get(index).in_engine();
        let known = told.extract_if(.., |shapes| !shapes.iter().any(|shape| waits(shape.0)));
        changed.extend(known.map(|shapes| (shapes, 0, true)));
        changed.sort_unstable();
        for of_pair in changed.chunk_by(|one, other| one.0 == other.0) {
            let shapes = of_pair[0].0;
            let gained: i32 = of_pair.iter().map(|change| change.1).sum();
            let was_told = of_pair.iter().any(|change| change.2);
            let several =
                |(_, at): (BodyIx, ColliderIx)| part_count(&bodies.colliders[at].solid) > 1;
            // Pieces of a pair of single ones touch or do not: there is nothing to count.
            let (before, now) = if shapes.into_iter().any(several) {
                let count = self.touching.entry(shapes).or_default();
                let before = *count > 0;
                *count = count.saturating_add_signed(gained);
                let now = *count > 0;
                if !now {
                    self.touching.remove(&shapes);
                }
                (before || was_told, now)
            } else {
                (was_told || gained < 0, gained > 0)
            };
            if now != before {
                events.push_touch(bodies, shapes, now, time);
            }
        }
    }

    /// Impacts that ended by `time`, the end of a sub-step.
    pub(crate) fn tell_impacts(
        &mut self,
        bodies: &Bodies,
        events: &mut Events,
        report: &mut StepReport,
        time: SimTime,
    ) {
        self.engine.impacts(&mut self.impacts);
        let are_some = !self.impacts.is_empty();
        report.impacts += self.impacts.len() as u64;
        for impact in self.impacts.drain(..) {
            let owner = |tag: u64| bodies.colliders[collider(tag)].body;
            let ids = impact.tags.map(|tag| bodies.get(owner(tag)).id);
            let at = (impact.place, impact.normal);
            let impulses = (impact.normal_impulse, impact.tangential_impulse);
            let told = EventKind::impact(ids, at, impulses, impact.speed);
            events.push(time + -impact.since, told);
        }
        if are_some {
            events.sort();
        }
    }

    /// Shapes with a piece that may be in `bounds`.
    pub(crate) fn shapes_in(&self, bodies: &Bodies, bounds: Aabb) -> Vec<ColliderIx> {
        let mut found = Vec::new();
        self.engine.query(bounds, |tag| found.push(collider(tag)));
        // What a caller changed since is not where the engine has it.
        let changed = bodies.touched.iter();
        let changed = changed.filter(|index| bodies.is_alive(**index));
        found.extend(changed.flat_map(|index| bodies.get(*index).colliders.iter()));
        found.sort_unstable();
        found.dedup();
        found
    }

    /// All contacts that push, in order of shapes; those of one body if one is asked for.
    pub(crate) fn contacts(&self, bodies: &Bodies, of: Option<BodyIx>) -> Vec<Contact> {
        let of_body = |index| self.engine.contacts_of(self.id(index)?).ok();
        let all: Vec<_> = match of {
            None => self.engine.contacts().collect(),
            Some(index) => of_body(index).into_iter().flatten().collect(),
        };
        let mut found: Vec<_> = all
            .into_iter()
            .filter(|contact| contact.touching)
            .map(|contact| (shapes_of(bodies, contact.tags), contact.pieces, contact))
            .collect();
        found.sort_unstable_by_key(|(shapes, pieces, _)| (*shapes, *pieces));
        found
            .into_iter()
            .map(|(shapes, _, contact)| read(bodies, shapes, &contact))
            .collect()
    }
}

/// Bodies and colliders of two pieces, in order.
fn shapes_of(bodies: &Bodies, tags: [u64; 2]) -> Shapes {
    let mut shapes = tags.map(|tag| {
        let at = collider(tag);
        (bodies.colliders[at].body, at)
    });
    shapes.sort_unstable();
    shapes
}

/// A contact of two shapes as a caller reads it.
fn read(bodies: &Bodies, shapes: Shapes, contact: &carom_stepped::Contact) -> Contact {
    let [a, b] = shapes.map(|shape| bodies.get(shape.0).id);
    let flipped = collider(contact.tags[0]) != shapes[0].1;
    let points = (0..contact.points).map(|k| ContactPoint {
        position: contact.places[k],
        separation: contact.gaps[k],
        normal_impulse: contact.impulses[k],
    });
    Contact {
        a,
        b,
        normal: if flipped {
            -contact.normal
        } else {
            contact.normal
        },
        points: points.collect(),
        // Both the normal and the body change sides: the impulse along the normal turned by +90° stays.
        tangent_impulse: contact.friction,
    }
}
