//! Which islands take hard rows: where a body bears one of more than 16 times its mass, and all rows are few enough.
//!
//! Whether an island does is a pure function of its bodies and contacts.

use crate::bodies::Bodies;
use crate::rows::Graph;

/// Points of contact of an island in hard rows, at most: its matrices are dense.
const MOST: usize = 64;

/// Cosine of the angle between a load and what may bear it, at least.
const ALONG: f64 = 1e-3;

/// What hangs together by rows, whether these push or not: hard and soft rows share no body that moves.
struct Component {
    slots: Vec<u32>,
    contacts: Vec<u32>,
}

/// What is known of a body's component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    Nothing,
    /// It is too large.
    Large,
    /// It was asked.
    Asked,
}

/// Contacts of each island that takes hard rows, in the order of their bodies. `known` is scratch, by slot.
pub(super) fn find(graph: &Graph, bodies: &Bodies, known: &mut Vec<Known>) -> Vec<Vec<u32>> {
    let mut found = Vec::new();
    known.clear();
    for id in graph.unequal_awake(bodies) {
        known.resize(bodies.records.len(), Known::Nothing);
        let first = graph.contacts[id as usize].bodies[0];
        if known[first as usize] != Known::Nothing {
            continue;
        }
        let (component, fits) = component(graph, bodies, first, known);
        let is = if fits { Known::Asked } else { Known::Large };
        for &slot in &component.slots {
            known[slot as usize] = is;
        }
        let bears = |id: &u32| is_borne(graph, bodies, *id);
        if fits && component.contacts.iter().any(bears) {
            found.push(component.contacts);
        }
    }
    for contacts in &mut found {
        contacts.sort_unstable_by_key(|id| graph.order(bodies, *id));
    }
    found.sort_unstable_by_key(|contacts| graph.order(bodies, contacts[0]));
    found
}

/// The component of a body; false, with a part of it, if it is too large, or a contact of it is in the overflow colour.
fn component(graph: &Graph, bodies: &Bodies, first: u32, known: &[Known]) -> (Component, bool) {
    let (mut slots, mut contacts) = (vec![first], Vec::new());
    let (mut next, mut points) = (0, 0);
    let mut fits = true;
    while let Some(&slot) = slots.get(next).filter(|_| fits) {
        next += 1;
        for (id, side) in graph.of_body(bodies, slot) {
            let other = graph.contacts[id as usize].bodies[1 - side];
            let moves = bodies.is_dynamic(other);
            // Once for both of its bodies.
            if !moves || side == 0 {
                let (block, _, lane) = graph.lane(id);
                points += block.points(lane);
                fits &= graph.contacts[id as usize].mask() != 0 && points <= MOST;
                contacts.push(id);
            }
            fits &= known[other as usize] != Known::Large;
            if moves && !slots.contains(&other) {
                slots.push(other);
            }
            if !fits {
                break;
            }
        }
    }
    (Component { slots, contacts }, fits)
}

/// Whether a contact is one of a heavy body with a light one that bears it: pressed along the normal the light one leans on what
/// leads, without the heavy one, to a body that cannot be moved.
fn is_borne(graph: &Graph, bodies: &Bodies, id: u32) -> bool {
    let ends = graph.contacts[id as usize].bodies;
    if !Graph::is_unequal(bodies, ends) {
        return false;
    }
    let mass = |slot: u32| bodies.records[slot as usize].mass;
    let side = usize::from(mass(ends[1]) < mass(ends[0]));
    let (light, heavy) = (ends[side], ends[1 - side]);
    // Normals away from the body on `side`.
    let away = |id: u32, side: usize| {
        let (block, _, lane) = graph.lane(id);
        block.normal(lane) * if side == 0 { 1.0 } else { -1.0 }
    };
    let load = -away(id, side);
    let mut leans = vec![light];
    for (id, side) in graph.of_body(bodies, light) {
        let other = graph.contacts[id as usize].bodies[1 - side];
        if other != heavy && away(id, side).dot(load) > ALONG {
            leans.push(other);
        }
    }
    let mut next = 1;
    while let Some(&slot) = leans.get(next) {
        next += 1;
        if !bodies.is_dynamic(slot) {
            return true;
        }
        for (id, side) in graph.of_body(bodies, slot) {
            let other = graph.contacts[id as usize].bodies[1 - side];
            if other != heavy && !leans.contains(&other) {
                leans.push(other);
            }
        }
    }
    false
}
