//! Contacts change colours when they fall asleep, wake, or go into hard rows and back: all their fields go with them.

use super::block::LANES;
use super::graph::{ASLEEP, COLOURS, Contact, FIRST_HARD, Graph, HARD};
use crate::bodies::{Bodies, BodyKind, number};
use crate::{ContactIx, LineIx};

impl Contact {
    pub(crate) const fn sleeps(&self) -> bool {
        self.colour as usize == ASLEEP
    }

    /// Whether its island is in hard rows.
    pub(crate) const fn is_hard(&self) -> bool {
        self.colour >= FIRST_HARD && !self.sleeps()
    }

    /// Its bit in the masks of its bodies: none in the overflow colour, or asleep.
    pub(crate) const fn mask(&self) -> u64 {
        if self.sleeps() { 0 } else { bit(self.colour) }
    }
}

/// The colour that a contact which is awake has in soft rows.
const fn soft(colour: u32) -> u32 {
    if colour >= FIRST_HARD {
        colour - FIRST_HARD
    } else {
        colour
    }
}

const fn bit(colour: u32) -> u64 {
    match 1u64.checked_shl(soft(colour)) {
        Some(bit) => bit,
        None => 0,
    }
}

impl Graph {
    /// Moves a contact between the colours and what sleeps; its bodies have their lines if it wakes.
    pub(crate) fn shift(&mut self, bodies: &mut Bodies, id: ContactIx, sleeps: bool) {
        let contact = self.contacts[id];
        let (to, lines, home) = if sleeps {
            (ASLEEP, [LineIx::EMPTY; 2], contact.colour)
        } else {
            let lines = contact.bodies.map(|slot| bodies.records[slot].line);
            (contact.home as usize, lines, contact.home)
        };
        for slot in contact.bodies {
            let record = &mut bodies.records[slot];
            if record.kind == BodyKind::Dynamic {
                record.colours = if sleeps {
                    record.colours & !bit(home)
                } else {
                    record.colours | bit(home)
                };
            }
        }
        self.contacts[id].home = home;
        self.transfer(id, to, lines);
    }

    /// Whether an island is in hard rows.
    pub(crate) const fn has_hard(&self) -> bool {
        self.hard > 0
    }

    /// Moves a contact that is awake, and not in the overflow colour, into hard rows or back.
    pub(crate) fn set_hard(&mut self, id: ContactIx, hard: bool) {
        let contact = self.contacts[id];
        if contact.is_hard() != hard {
            let (block, _, lane) = self.lane(id);
            let lines = block.lines(lane);
            let to = soft(contact.colour) as usize + if hard { HARD } else { 0 };
            self.transfer(id, to, lines);
        }
    }

    /// Moves a contact to another colour, with all its fields.
    fn transfer(&mut self, id: ContactIx, to: usize, lines: [LineIx; 2]) {
        let contact = self.contacts[id];
        let (from, (k, lane)) = (contact.colour as usize, contact.place());
        let row = self.colours[from].copy(k, lane);
        self.vacate(from, k, lane);
        let index = self.colours[to].push(to == COLOURS, id, contact.pieces);
        let (other, place) = (&mut self.colours[to], (index / LANES, index % LANES));
        other.paste(place.0, place.1, &row);
        let block = &mut other.blocks[place.0];
        (block.a[place.1], block.b[place.1]) = (lines[0], lines[1]);
        let contact = &mut self.contacts[id];
        (contact.colour, contact.index) = (number(to), number(index));
        self.hard += usize::from(contact.is_hard());
    }
}
