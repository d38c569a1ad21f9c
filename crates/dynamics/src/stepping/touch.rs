//! What touches, as callers see it: begins, ends, and contacts read from the engine.

use carom_collision::part_count;
use carom_geometry::Aabb;
use carom_math::SimTime;

use super::{Shapes, Stepping, collider};
use crate::{Contact, ContactPoint, EventKind, World};

impl World {
    /// Begins and ends of touch since this was last called, in order of shapes.
    pub(super) fn tell_changed_touches(&mut self, stepping: &mut Stepping, time: SimTime) {
        let mut changes = core::mem::take(&mut stepping.changes);
        stepping.engine.touches(&mut changes);
        // What a shape pair's pieces gained in touches; told: it touched when one of its bodies joined.
        let mut changed: Vec<(Shapes, i32, bool)> = Vec::with_capacity(changes.len());
        for change in changes.drain(..) {
            let gained = if change.begins { 1 } else { -1 };
            changed.push((self.shapes_of(change.tags), gained, false));
        }
        stepping.changes = changes;
        changed.extend(self.joins.told.drain(..).map(|shapes| (shapes, 0, true)));
        changed.sort_unstable();
        for of_pair in changed.chunk_by(|one, other| one.0 == other.0) {
            let shapes = of_pair[0].0;
            let gained: i32 = of_pair.iter().map(|change| change.1).sum();
            let was_told = of_pair.iter().any(|change| change.2);
            let several = |(_, at): (u32, u32)| part_count(&self.colliders[at as usize].solid) > 1;
            // Pieces of a pair of single ones touch or do not: there is nothing to count.
            let (before, now) = if shapes.into_iter().any(several) {
                let count = stepping.touching.entry(shapes).or_default();
                let before = *count > 0;
                *count = count.saturating_add_signed(gained);
                let now = *count > 0;
                if !now {
                    stepping.touching.remove(&shapes);
                }
                (before || was_told, now)
            } else {
                (was_told || gained < 0, gained > 0)
            };
            if now != before {
                let [ends, colliders] = [shapes.map(|shape| shape.0), shapes.map(|shape| shape.1)];
                let bodies = &self.bodies;
                self.events.push_touch(bodies, ends, colliders, now, time);
            }
        }
    }

    /// Impacts that ended by `time`, the end of a sub-step.
    pub(super) fn tell_impacts(&mut self, stepping: &mut Stepping, time: SimTime) {
        let mut impacts = core::mem::take(&mut stepping.impacts);
        stepping.engine.impacts(&mut impacts);
        let are_some = !impacts.is_empty();
        self.report.impacts += impacts.len() as u64;
        for impact in impacts.drain(..) {
            let [a, b] = impact
                .tags
                .map(|tag| self.colliders[collider(tag) as usize].body);
            let [a, b] = [a, b].map(|index| self.bodies.get(index).id);
            self.events.push(
                time + -impact.since,
                EventKind::Impact {
                    a,
                    b,
                    point: impact.place,
                    normal: impact.normal,
                    normal_impulse: impact.normal_impulse,
                    tangential_impulse: impact.tangential_impulse,
                    speed: impact.speed,
                },
            );
        }
        if are_some {
            self.events.sort();
        }
        stepping.impacts = impacts;
    }

    /// Bodies and colliders of two pieces, in order.
    fn shapes_of(&self, tags: [u64; 2]) -> Shapes {
        let mut shapes = tags.map(|tag| {
            let at = collider(tag);
            (self.colliders[at as usize].body, at)
        });
        shapes.sort_unstable();
        shapes
    }

    /// How far all pieces of a shape in the engine may be from a box that the shape's own box overlaps, in m.
    pub(crate) fn beyond_pieces(&self) -> f64 {
        self.stepping.as_ref().map_or(0.0, |s| s.widest)
    }

    /// Shapes with a piece that may be in `bounds`.
    pub(crate) fn shapes_in_engine(&self, bounds: Aabb) -> Vec<u32> {
        let mut found = Vec::new();
        let Some(stepping) = &self.stepping else {
            return found;
        };
        stepping
            .engine
            .query(bounds, |tag| found.push(collider(tag)));
        // What a caller changed since is not where the engine has it.
        let changed = self.bodies.touched.iter();
        let changed = changed.filter(|index| self.bodies.is_alive(**index));
        found.extend(changed.flat_map(|index| self.bodies.get(*index).colliders.iter()));
        found.sort_unstable();
        found.dedup();
        found
    }

    /// All contacts that push, in order of shapes; those of one body if one is asked for.
    pub(crate) fn contacts_in(&self, stepping: &Stepping, of: Option<u32>) -> Vec<Contact> {
        let all = match of.map(|index| stepping.id(index)) {
            None => stepping.engine.contacts().collect(),
            Some(Some(id)) => stepping
                .engine
                .contacts_of(id)
                .map_or_else(|_| Vec::new(), Iterator::collect),
            Some(None) => Vec::new(),
        };
        let mut found: Vec<_> = all
            .into_iter()
            .filter(|contact| contact.touching)
            .map(|contact| (self.shapes_of(contact.tags), contact.pieces, contact))
            .collect();
        found.sort_unstable_by_key(|(shapes, pieces, _)| (*shapes, *pieces));
        found
            .into_iter()
            .map(|(shapes, _, contact)| self.contact_in(shapes, &contact))
            .collect()
    }

    fn contact_in(&self, shapes: Shapes, contact: &carom_stepped::Contact) -> Contact {
        let [a, b] = shapes.map(|shape| self.bodies.get(shape.0).id);
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
}
