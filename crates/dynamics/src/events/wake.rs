//! Sleepers wake with what they touch.

use carom_math::SimTime;

use crate::Events;
use crate::model::graph::neighbours;
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
use crate::values::event::EventKind;

/// Wakes these bodies, the last one first, and all sleepers that they touch, and so on; those that the engine has are for the engine to
/// wake. All of them.
pub(crate) fn wake(
    bodies: &mut Bodies,
    pairs: &Pairs,
    mut waking: Vec<u32>,
    time: SimTime,
    events: &mut Events,
) -> Vec<u32> {
    let mut woken = Vec::new();
    while let Some(index) = waking.pop() {
        let state = bodies.get_mut(index);
        if !state.is_asleep() {
            continue;
        }
        woken.push(index);
        if state.in_engine() {
            continue;
        }
        let id = state.id;
        if bodies.wake(index) {
            events.push(time, EventKind::Awake(id));
        }
        waking.extend(neighbours(bodies, pairs, index));
    }
    woken
}
