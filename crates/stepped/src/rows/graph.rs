//! The constraint graph: contacts, the colour and lane of each, and the list of each body's contacts.

use super::block::Block;
use super::block::{LANES, Pressed};
use super::colour::Colour;
use crate::bodies::{Bodies, BodyKind, number};
use crate::ghost::Suspects;
use crate::narrow::Manifold;
use crate::{BodyIx, ContactIx, Entry, LineIx, PieceIx, Surface};

/// Colours of a mask. Contacts that find none of them free take the overflow colour, a block each, one after the other.
pub(crate) const COLOURS: usize = 64;

/// Behind the overflow colour, contacts of islands in hard rows: those of a mask's colour c are in colour `HARD + c`, which no
/// sweep reads.
pub(crate) const HARD: usize = COLOURS + 1;

/// The same number.
pub(super) const FIRST_HARD: u32 = number(HARD);

/// Where contacts of sleeping islands lie, with all their fields: no pass reads it.
pub(crate) const ASLEEP: usize = HARD + COLOURS;

/// Contacts with what cannot be moved take the highest free colour below this one, so that the ground acts last. Piles of
/// boxes need 6 to 10 colours.
const GROUND: u64 = 12;

/// Where a contact is, and its place in the lists of its two bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// Slots of A and B: A was inserted first.
    pub(crate) bodies: [BodyIx; 2],
    pub(crate) pieces: [PieceIx; 2],
    pub(crate) colour: u32,
    /// The colour that it had awake.
    pub(super) home: u32,
    /// Lane, counted through all blocks of the colour.
    pub(crate) index: u32,
    /// The neighbours in the lists of A and of B.
    next: [Entry; 2],
    previous: [Entry; 2],
}

/// All contacts. Adding and removing moves one lane at most.
#[derive(Clone, Debug, Default)]
pub(crate) struct Graph {
    pub(crate) contacts: Vec<Contact>,
    /// Bodies that may have ghosts.
    pub(crate) suspects: Suspects,
    free: Vec<ContactIx>,
    /// Contacts that are too deep for the sweeps, and some that were, in no order.
    pub(crate) deep: Vec<ContactIx>,
    /// Contacts of two bodies of very different mass, and some that were, in no order.
    pub(super) unequal: Vec<ContactIx>,
    /// Behind those of masks the overflow colour, then those of hard rows, and last what sleeps.
    pub(super) colours: Vec<Colour>,
    /// Contacts in hard rows.
    pub(super) hard: usize,
}

/// A block with contacts of moved bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touched {
    pub(crate) colour: usize,
    pub(crate) block: usize,
    /// A bit for each lane with such a contact.
    pub(crate) lanes: u8,
}

impl Contact {
    /// Block and lane.
    pub(crate) const fn place(&self) -> (usize, usize) {
        (self.index as usize / LANES, self.index as usize % LANES)
    }
}

impl Graph {
    pub(crate) fn new() -> Self {
        Self {
            colours: vec![Colour::default(); ASLEEP + 1],
            ..Self::default()
        }
    }

    /// Contacts there are.
    pub(crate) fn len(&self) -> usize {
        self.contacts.len() - self.free.len()
    }

    /// Contacts of what is awake.
    pub(crate) fn awake_len(&self) -> usize {
        self.len() - self.colours[ASLEEP].len()
    }

    /// The colours of what is awake: those that are swept come first, in their order.
    pub(crate) fn awake(&mut self) -> &mut [Colour] {
        let end = self.awake_end();
        &mut self.colours[..end]
    }

    /// The colours of soft rows, in the order in which they are swept.
    pub(crate) fn soft(&mut self) -> &mut [Colour] {
        &mut self.colours[..HARD]
    }

    pub(super) const fn awake_end(&self) -> usize {
        if self.hard > 0 { ASLEEP } else { HARD }
    }

    /// Blocks that have contacts of moved bodies, colour by colour.
    pub(crate) fn touched(&self, bodies: &Bodies) -> Vec<Touched> {
        let mut touched = Vec::new();
        for (colour, number) in self.colours[..self.awake_end()].iter().zip(0..) {
            for (Block { a, b, .. }, block) in colour.blocks.iter().zip(0..) {
                let moved = |line: LineIx| bodies.moved[line];
                let lanes = a.iter().zip(b).zip(0..).fold(0, |lanes, ((a, b), lane)| {
                    lanes | u8::from(moved(*a) | moved(*b)) << lane
                });
                if lanes != 0 {
                    touched.push(Touched {
                        colour: number,
                        block,
                        lanes,
                    });
                }
            }
        }
        touched
    }

    /// The colours of what is awake, and the bodies that may have ghosts.
    pub(crate) fn awake_and_suspects(&mut self) -> (&mut [Colour], &mut Suspects) {
        let end = self.awake_end();
        (&mut self.colours[..end], &mut self.suspects)
    }

    /// Gives a contact of two bodies a number and a lane, without impulses.
    pub(crate) fn insert(
        &mut self,
        bodies: &mut Bodies,
        ends: [BodyIx; 2],
        pieces: [PieceIx; 2],
        (manifold, deepest, (by, is_whole)): (&Manifold, f64, (Pressed, bool)),
        surface: Surface,
    ) -> ContactIx {
        let id = self
            .free
            .pop()
            .unwrap_or(ContactIx::new(self.contacts.len()));
        let mut contact = Contact {
            bodies: ends,
            pieces,
            colour: 0,
            home: 0,
            index: 0,
            next: [Entry::NONE; 2],
            previous: [Entry::NONE; 2],
        };
        for side in [0, 1] {
            let head = &mut bodies.records[ends[side]].contacts;
            contact.next[side] = *head;
            if let Some((other, its)) = head.end() {
                self.contacts[other].previous[its] = Entry::of(id, side);
            }
            *head = Entry::of(id, side);
        }
        if id.at() == self.contacts.len() {
            self.contacts.push(contact);
        } else {
            self.contacts[id] = contact;
        }
        self.colour(bodies, id, (manifold, deepest, (by, is_whole)), surface);
        if Self::is_unequal(bodies, ends) {
            self.unequal.push(id);
        }
        id
    }

    /// Takes the colour that suits a new contact, and a lane there.
    fn colour(
        &mut self,
        bodies: &mut Bodies,
        id: ContactIx,
        (manifold, deepest, (by, is_whole)): (&Manifold, f64, (Pressed, bool)),
        surface: Surface,
    ) {
        let contact = &mut self.contacts[id];
        let ends = contact.bodies;
        let dynamic = ends.map(|slot| bodies.is_dynamic(slot));
        let mut taken = 0;
        for side in [0, 1] {
            if dynamic[side] {
                taken |= bodies.records[ends[side]].colours;
            }
        }
        let colour = colour_for(taken, dynamic == [true, true]);
        for side in [0, 1] {
            if dynamic[side] && colour < COLOURS {
                bodies.records[ends[side]].colours |= 1 << colour;
            }
        }
        let index = self.colours[colour].push(colour == COLOURS, id, contact.pieces);
        (contact.colour, contact.index) = (number(colour), number(index));
        let (k, lane) = contact.place();
        let colour = &mut self.colours[colour];
        let block = &mut colour.blocks[k];
        block.a[lane] = bodies.records[ends[0]].line;
        block.b[lane] = bodies.records[ends[1]].line;
        block.mu[lane] = surface.friction;
        block.put(lane, manifold);
        let records = ends.map(|slot| &bodies.records[slot]);
        let are_free = records.iter().all(|record| bodies.is_free(record.line));
        let cold = &mut colour.cold[k];
        if cold.note_depth((block, lane), &bodies.lines, deepest, (by, are_free)) {
            self.deep.push(id);
        }
        colour.cold[k].restitution[lane] = surface.restitution;
        colour.cold[k].belt[lane] = surface.tangent_speed;
        colour.cold[k].whole &= !(1 << lane);
        colour.cold[k].whole |= u8::from(is_whole) << lane;
        colour.count(k, lane);
    }

    /// Takes a contact out, and its impulses out of the warm start of its bodies.
    pub(crate) fn remove(&mut self, bodies: &mut Bodies, id: ContactIx) {
        let contact = self.contacts[id];
        let (colour, (k, lane)) = (contact.colour as usize, contact.place());
        let block = &self.colours[colour].blocks[k];
        let [a, b] = block.lines(lane);
        self.clear_warm_start(bodies, id);
        self.unlink(bodies, id);
        for (slot, line) in contact.bodies.into_iter().zip([a, b]) {
            let record = &mut bodies.records[slot];
            if record.kind == BodyKind::Dynamic {
                record.colours &= !contact.mask();
                if record.contacts == Entry::NONE {
                    // Nothing acts on it: free flight has no leftovers of rounding.
                    let (v, w) = (bodies.lines[line].v(), bodies.lines[line].w());
                    bodies.start[line].0[..3].copy_from_slice(&[v.x, v.y, w]);
                }
            }
        }
        self.vacate(colour, k, lane);
        self.free.push(id);
    }

    /// Empties a lane; the last one of the colour moves there.
    pub(super) fn vacate(&mut self, colour: usize, k: usize, lane: usize) {
        self.hard -= usize::from((HARD..ASLEEP).contains(&colour));
        if colour == COLOURS {
            // Here order matters to the bits: it stays.
            if self.colours[colour].empty(k) {
                self.close_up();
            }
        } else if let Some(moved) = self.colours[colour].pull(k, lane) {
            self.contacts[moved].index = number(k * LANES + lane);
        }
    }

    /// Takes blocks without a contact out of the overflow colour; the others keep their order.
    fn close_up(&mut self) {
        let contacts = &mut self.contacts;
        self.colours[COLOURS].close_up(|id, k| contacts[id].index = number(k * LANES));
    }

    /// Takes a contact out of the lists of its bodies.
    fn unlink(&mut self, bodies: &mut Bodies, id: ContactIx) {
        let contact = self.contacts[id];
        for side in [0, 1] {
            let (next, previous) = (contact.next[side], contact.previous[side]);
            match previous.end() {
                Some((other, its)) => self.contacts[other].next[its] = next,
                None => bodies.records[contact.bodies[side]].contacts = next,
            }
            if let Some((other, its)) = next.end() {
                self.contacts[other].previous[its] = previous;
            }
        }
    }

    /// Numbers of a body's contacts, the newest first, each with the side on which the body is.
    pub(crate) fn of_body(
        &self,
        bodies: &Bodies,
        slot: BodyIx,
    ) -> impl Iterator<Item = (ContactIx, usize)> {
        let mut at = bodies.records[slot].contacts;
        core::iter::from_fn(move || {
            let (id, side) = at.end()?;
            at = self.contacts[id].next[side];
            Some((id, side))
        })
    }

    /// The other bodies of its contacts, in their order: once for each.
    pub(crate) fn neighbours(&self, bodies: &Bodies, slot: BodyIx) -> impl Iterator<Item = BodyIx> {
        let contacts = self.of_body(bodies, slot);
        contacts.map(|(id, side)| self.contacts[id].bodies[1 - side])
    }

    /// Tells the rows of a body that it has another line.
    pub(crate) fn renumber(&mut self, bodies: &Bodies, slot: BodyIx) {
        let line = bodies.records[slot].line;
        let mut at = bodies.records[slot].contacts;
        while let Some((id, side)) = at.end() {
            let contact = self.contacts[id];
            let (block, lane) = self.block_mut(id);
            let end = if side == 0 {
                &mut block.a
            } else {
                &mut block.b
            };
            end[lane] = if contact.sleeps() {
                LineIx::EMPTY
            } else {
                line
            };
            at = contact.next[side];
        }
    }
}

/// The lowest free colour; against what cannot be moved the highest free one below [`GROUND`].
fn colour_for(taken: u64, both: bool) -> usize {
    let free = !taken;
    let low = free & ((1 << GROUND) - 1);
    if free == 0 {
        COLOURS
    } else if !both && low != 0 {
        63 - low.leading_zeros() as usize
    } else {
        free.trailing_zeros() as usize
    }
}
