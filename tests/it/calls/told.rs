//! What a world tells, held against what it is.

use std::collections::BTreeMap;

use carom_dynamics::{BodyId, EventKind, World};
use carom_math::SimTime;

/// Bodies in touch, as told by events.
#[derive(Clone, Debug, Default)]
pub(crate) struct Told {
    /// How many pairs of shapes of two bodies touch.
    touch: BTreeMap<(BodyId, BodyId), usize>,
    /// How many shapes each body has, removed bodies too.
    shapes: BTreeMap<BodyId, usize>,
    /// Whether some events found no room.
    missed: bool,
}

impl Told {
    /// Hears the events of a step that began at `since`.
    pub(crate) fn hear(&mut self, world: &World, since: SimTime) -> Result<(), String> {
        for body in world.bodies() {
            self.shapes.insert(body.id(), body.shapes().count());
        }
        let events = world.events();
        // Once events were dropped the counts are void.
        self.missed |= events.dropped() > 0;
        let mut before = since;
        let mut last = None;
        for event in events {
            if event.time < before || event.time > world.time() {
                return Err(format!(
                    "{event:?} is told {:e} s early, after {last:?}, and {:e} s late",
                    before - event.time,
                    event.time - world.time(),
                ));
            }
            before = event.time;
            last = Some(event);
            match event.kind {
                EventKind::Begin { .. } | EventKind::End { .. } if self.missed => {}
                EventKind::Begin { a, b, .. } => {
                    let most = self.shapes(a) * self.shapes(b);
                    let count = self.touch.entry((a.min(b), a.max(b))).or_default();
                    *count += 1;
                    if *count > most {
                        return Err(format!("begins once more than shapes can touch: {event:?}"));
                    }
                }
                EventKind::End { a, b, .. } => {
                    let count = self.touch.entry((a.min(b), a.max(b))).or_default();
                    if *count == 0 {
                        return Err(format!("ends before it began: {event:?}"));
                    }
                    *count -= 1;
                }
                EventKind::Impact {
                    point,
                    normal,
                    normal_impulse,
                    tangential_impulse,
                    speed,
                    ..
                } => {
                    let finite = point.is_finite() && tangential_impulse.is_finite();
                    let unit = (normal.length() - 1.0).abs() < 1e-12;
                    if !(finite && unit && normal_impulse >= 0.0 && speed >= 0.0) {
                        return Err(format!("an odd impact: {event:?}"));
                    }
                }
                EventKind::Collapse { energy, .. } if energy < 0.0 || energy.is_nan() => {
                    return Err(format!("an odd collapse: {event:?}"));
                }
                _ => {}
            }
        }
        if self.missed {
            Ok(())
        } else {
            self.agrees(world)
        }
    }

    fn shapes(&self, id: BodyId) -> usize {
        // A body that came and went between two steps has two shapes at most.
        self.shapes.get(&id).copied().unwrap_or(2)
    }

    /// Whether contacts are those that began and did not end.
    fn agrees(&self, world: &World) -> Result<(), String> {
        for contact in world.contacts() {
            let pair = (contact.a.min(contact.b), contact.a.max(contact.b));
            if self.touch.get(&pair).is_none_or(|count| *count == 0) {
                return Err(format!("not told of {contact:?}"));
            }
            let sound = contact.points.iter().all(|point| {
                point.position.is_finite()
                    && point.separation.is_finite()
                    && point.normal_impulse >= 0.0
            });
            if !sound
                || (contact.normal.length() - 1.0).abs() > 1e-12
                || !contact.tangent_impulse.is_finite()
            {
                return Err(format!("an odd contact: {contact:?}"));
            }
        }
        for (pair, _) in self.touch.iter().filter(|(_, count)| **count > 0) {
            if world.body(pair.0).is_none() || world.body(pair.1).is_none() {
                return Err(format!("{} and {} touch, and one is gone", pair.0, pair.1));
            }
        }
        Ok(())
    }
}
