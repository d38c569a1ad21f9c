//! Which islands take hard rows: where a body bears one of more than 16 times its mass, or goes far in a sub-step, and all rows are few
//! enough.
//!
//! Whether an island does is a pure function of its bodies and contacts.

use crate::bodies::Bodies;
use crate::rows::Graph;
use crate::{BodyIx, ContactIx, PieceIx, Settings};

/// Which islands a rule admits: by points of contact, as matrices are dense, and by bodies.
#[derive(Clone, Copy)]
struct Admits {
    /// So many points as an island comes into hard rows, at most.
    comes: usize,
    /// While it is in them: points come and go where bodies rock.
    stays: usize,
    bodies: usize,
    /// So many if all of them are discs about their centres.
    discs: usize,
}

impl Admits {
    const fn points(comes: usize, stays: usize) -> Self {
        Self {
            comes,
            stays,
            bodies: usize::MAX,
            discs: usize::MAX,
        }
    }

    fn bodies(settings: &Settings) -> Self {
        Self {
            comes: usize::MAX,
            stays: usize::MAX,
            bodies: settings.hard_bodies,
            discs: settings.hard_discs.max(settings.hard_bodies),
        }
    }
}

/// Of islands with a load that sweeps cannot carry.
const UNDER_LOAD: Admits = Admits::points(64, 80);

/// Of islands with a fast body: turning presses what a ring carries at 14.7 rad/s by 35 g, and soft rows let it sink in by 28 mm, hard
/// ones by 0.7. 64: the debris of a wall takes them, too.
const WITH_FAST: Admits = Admits::points(16, 20);

/// Cosine of the angle between a load and what may bear it, at least.
const ALONG: f64 = 1e-3;

/// A contact, as long as its bodies are there: births and pieces of both. Numbers of contacts are given anew.
pub(super) type Key = ([u64; 2], [PieceIx; 2]);

pub(super) fn keys(graph: &Graph, bodies: &Bodies, ids: &[ContactIx]) -> Vec<Key> {
    ids.iter().map(|id| graph.order(bodies, *id)).collect()
}

/// An island that takes hard rows.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// In the order of their bodies.
    pub(super) contacts: Vec<ContactIx>,
    /// It is swept: it bears no load that sweeps cannot carry.
    pub(super) is_swept: bool,
}

/// What is known of a body's component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Known {
    Nothing,
    /// It is too large.
    Large,
    /// It was asked.
    Asked,
}

/// What a search uses: scratch.
#[derive(Clone, Debug, Default)]
pub(super) struct Search {
    /// By slot.
    known: Vec<Known>,
    /// Bodies and contacts of a component.
    slots: Vec<BodyIx>,
    contacts: Vec<ContactIx>,
}

/// The islands that take hard rows in a sub-step, in the order of their bodies.
pub(super) fn find(
    graph: &Graph,
    bodies: &Bodies,
    settings: &Settings,
    search: &mut Search,
) -> Vec<Found> {
    let mut found: Vec<Found> = Vec::new();
    search.known.clear();
    for id in graph.unequal_awake(bodies) {
        search.known.resize(bodies.records.len(), Known::Nothing);
        let first = graph.contacts[id].bodies[0];
        if search.known[first.at()] == Known::Nothing
            && search.component(graph, bodies, first, UNDER_LOAD)
            && search
                .contacts
                .iter()
                .any(|id| is_borne(graph, bodies, *id))
        {
            found.push(search.found(false));
        }
    }
    find_fast(graph, bodies, settings.substep(), search, &mut found);
    find_small(graph, bodies, Admits::bodies(settings), search, &mut found);
    for island in &mut found {
        graph.sort(bodies, &mut island.contacts);
    }
    found.sort_unstable_by_key(|island| graph.order(bodies, island.contacts[0]));
    found
}

/// Adds the islands with a fast body that are not there yet.
fn find_fast(graph: &Graph, bodies: &Bodies, h: f64, search: &mut Search, found: &mut Vec<Found>) {
    let mut fast = bodies.fast(h).peekable();
    if fast.peek().is_none() {
        return;
    }
    search.begin(graph, bodies, found);
    let mut ask = |first: BodyIx| {
        if search.known[first.at()] == Known::Nothing
            && search.component(graph, bodies, first, WITH_FAST)
        {
            found.push(search.found(false));
        }
    };
    for slot in fast {
        if bodies.is_dynamic(slot) {
            if graph.of_body(bodies, slot).next().is_some() {
                ask(slot);
            }
        } else {
            let others = graph.neighbours(bodies, slot);
            others
                .filter(|other| bodies.is_dynamic(*other))
                .for_each(&mut ask);
        }
    }
}

/// Adds the islands of few bodies that are not there yet.
fn find_small(
    graph: &Graph,
    bodies: &Bodies,
    admits: Admits,
    search: &mut Search,
    found: &mut Vec<Found>,
) {
    if admits.discs == 0 {
        return;
    }
    search.begin(graph, bodies, found);
    for &slot in &bodies.slot_of {
        let is_asked = slot != BodyIx::NONE
            && search.known[slot.at()] == Known::Nothing
            && bodies.is_dynamic(slot)
            && (admits.bodies > 0 || bodies.is_disc(slot));
        if is_asked
            && graph.of_body(bodies, slot).next().is_some()
            && search.component(graph, bodies, slot, admits)
        {
            found.push(search.found(true));
        }
    }
}

impl Search {
    fn found(&self, is_swept: bool) -> Found {
        Found {
            contacts: self.contacts.clone(),
            is_swept,
        }
    }

    /// Knows of the bodies of islands that were found, and of no others.
    fn begin(&mut self, graph: &Graph, bodies: &Bodies, found: &[Found]) {
        self.known.clear();
        self.known.resize(bodies.records.len(), Known::Nothing);
        let contacts = found.iter().flat_map(|island| &island.contacts);
        for slot in contacts.flat_map(|id| graph.contacts[*id].bodies) {
            self.known[slot.at()] = Known::Asked;
        }
    }

    /// Finds the contacts of the component of a body: what hangs together by rows, whether these push or not, as hard and soft rows
    /// share no body that moves. False if it is too large, or a contact of it is in the overflow colour.
    fn component(&mut self, graph: &Graph, bodies: &Bodies, first: BodyIx, admits: Admits) -> bool {
        let Self {
            known,
            slots,
            contacts,
        } = self;
        slots.clear();
        slots.push(first);
        contacts.clear();
        let (mut next, mut points, mut hard, mut discs) = (0, 0, false, true);
        let mut fits = true;
        known[first.at()] = Known::Asked;
        while let Some(&slot) = slots.get(next).filter(|_| fits) {
            next += 1;
            discs &= bodies.is_disc(slot);
            for (id, side) in graph.of_body(bodies, slot) {
                let contact = &graph.contacts[id];
                let other = contact.bodies[1 - side];
                let moves = bodies.is_dynamic(other);
                // Once for both of its bodies.
                if !moves || side == 0 {
                    let (block, _, lane) = graph.lane(id);
                    points += block.points(lane);
                    contacts.push(id);
                }
                hard |= contact.is_hard();
                fits &= contact.mask() != 0;
                if moves && known[other.at()] != Known::Asked {
                    fits &= known[other.at()] != Known::Large;
                    known[other.at()] = Known::Asked;
                    slots.push(other);
                }
                // All but the first body have a contact each.
                fits &= points.max(slots.len() - 1) <= admits.stays;
                fits &= slots.len() <= if discs { admits.discs } else { admits.bodies };
                if !fits {
                    break;
                }
            }
        }
        let fits = fits && (hard || points <= admits.comes);
        if !fits {
            for slot in slots {
                known[slot.at()] = Known::Large;
            }
        }
        fits
    }
}

/// Whether a contact is one of a heavy body with a light one that bears it: pressed along the normal the light one leans on what
/// leads, without the heavy one, to a body that cannot be moved.
fn is_borne(graph: &Graph, bodies: &Bodies, id: ContactIx) -> bool {
    let ends = graph.contacts[id].bodies;
    if !Graph::is_unequal(bodies, ends) {
        return false;
    }
    let mass = |slot: BodyIx| bodies.records[slot].mass;
    let side = usize::from(mass(ends[1]) < mass(ends[0]));
    let (light, heavy) = (ends[side], ends[1 - side]);
    // Normals away from the body on `side`.
    let away = |id: ContactIx, side: usize| {
        let (block, _, lane) = graph.lane(id);
        block.normal(lane) * if side == 0 { 1.0 } else { -1.0 }
    };
    let load = -away(id, side);
    let mut leans = vec![light];
    for (id, side) in graph.of_body(bodies, light) {
        let other = graph.contacts[id].bodies[1 - side];
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
        for other in graph.neighbours(bodies, slot) {
            if other != heavy && !leans.contains(&other) {
                leans.push(other);
            }
        }
    }
    false
}
