//! Sleepers wake with what they touch.

use carom_math::SimTime;

use crate::Events;
use crate::model::graph::neighbours;
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
use crate::values::event::EventKind;

/// Wakes a body and all sleepers that it touches, and so on; those that the engine has are for the engine to wake.
pub(crate) fn wake(
    bodies: &mut Bodies,
    pairs: &Pairs,
    index: u32,
    time: SimTime,
    events: &mut Events,
    woken: &mut Vec<u32>,
) {
    let mut waking = vec![index];
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
}

/// Wakes all sleepers that touch a body: what held them has changed.
pub(crate) fn wake_around(
    bodies: &mut Bodies,
    pairs: &Pairs,
    index: u32,
    time: SimTime,
    events: &mut Events,
    woken: &mut Vec<u32>,
) {
    wake(bodies, pairs, index, time, events, woken);
    let around: Vec<u32> = neighbours(bodies, pairs, index).collect();
    for other in around {
        wake(bodies, pairs, other, time, events, woken);
    }
}
