//! The rows of contacts that are there: where they lie, and what is asked and changed of them.

use carom_math::{Vec2, perp};

use super::block::{Block, Cold, OPEN, lanes};
use super::colour::Colour;
use super::graph::{ASLEEP, Graph, HARD};
use crate::bodies::Bodies;
use crate::narrow::Manifold;
use crate::{BodyIx, ContactIx, PieceIx, Surface};

impl Graph {
    /// The block and lane of a contact.
    pub(crate) fn lane(&self, id: ContactIx) -> (&Block, &Cold, usize) {
        let contact = &self.contacts[id];
        let (k, lane) = contact.place();
        let colour = &self.colours[contact.colour as usize];
        (&colour.blocks[k], &colour.cold[k], lane)
    }

    /// The cold part and lane of a contact, if there is one of this number and it is awake.
    pub(super) fn cold(&self, id: ContactIx) -> Option<(&Cold, usize)> {
        let contact = &self.contacts[id];
        let (k, lane) = contact.place();
        let cold = self.colours[contact.colour as usize].cold.get(k)?;
        let there = cold.used >> lane & 1 == 1 && cold.contact[lane] == id;
        (there && !contact.sleeps()).then_some((cold, lane))
    }

    /// Whether there is such a contact of these pieces, and it is awake.
    pub(crate) fn has(&self, id: ContactIx, pieces: [PieceIx; 2]) -> bool {
        self.cold(id).is_some() && self.contacts[id].pieces == pieces
    }

    /// The colour of a contact, and its block and lane there.
    pub(super) fn colour_mut(&mut self, id: ContactIx) -> (&mut Colour, usize, usize) {
        let contact = &self.contacts[id];
        let (k, lane) = contact.place();
        (&mut self.colours[contact.colour as usize], k, lane)
    }

    pub(crate) fn block_mut(&mut self, id: ContactIx) -> (&mut Block, usize) {
        let (colour, k, lane) = self.colour_mut(id);
        (&mut colour.blocks[k], lane)
    }

    /// Gaps of both points of a contact where its bodies are, in m.
    pub(crate) fn gaps(&self, bodies: &Bodies, id: ContactIx) -> [f64; 2] {
        let (block, cold, lane) = self.lane(id);
        cold.gaps(block, lane, &bodies.lines)
    }

    /// Slots of the bodies of each row of whole shapes: all of them are deep.
    pub(crate) fn whole(&self) -> impl Iterator<Item = [BodyIx; 2]> {
        self.deep_with(|cold| cold.whole)
    }

    /// Slots of bodies that were put into each other and are not apart.
    pub(crate) fn put(&self) -> impl Iterator<Item = [BodyIx; 2]> {
        self.deep_with(|cold| cold.put)
    }

    /// Slots of the bodies of each deep contact that has a bit.
    fn deep_with(&self, bits: fn(&Cold) -> u8) -> impl Iterator<Item = [BodyIx; 2]> {
        let has = move |(cold, lane): (&Cold, usize)| bits(cold) >> lane & 1 == 1;
        let deep = self.deep.iter();
        let deep = deep.filter(move |id| self.cold(**id).is_some_and(has));
        deep.map(|id| self.contacts[*id].bodies)
    }

    /// Both points of a contact, midway between the surfaces, in m.
    pub(crate) fn places(&self, bodies: &Bodies, id: ContactIx) -> [Vec2; 2] {
        let (block, _, lane) = self.lane(id);
        let normal = block.normal(lane);
        let slots = self.contacts[id].bodies;
        let centres = slots.map(|slot| bodies.pose_of(slot).position);
        [0.0, block.l[lane]].map(|back| {
            let on = |centre: Vec2, height: f64, arm: f64| {
                centre + normal * height - perp(normal) * (arm + back)
            };
            let on_a = on(centres[0], block.at[lane], block.a1[lane]);
            let on_b = on(centres[1], block.bt[lane], block.b1[lane]);
            0.5 * (on_a + on_b)
        })
    }

    /// Numbers of all contacts, colour by colour.
    pub(crate) fn ids(&self) -> impl Iterator<Item = ContactIx> {
        ids_in(&self.colours)
    }

    /// Those in hard rows.
    pub(crate) fn hard_ids(&self) -> impl Iterator<Item = ContactIx> {
        ids_in(&self.colours[HARD..ASLEEP])
    }

    /// Place of a contact in an order that memory does not change: by births of its bodies, then by pieces.
    pub(crate) fn order(&self, bodies: &Bodies, id: ContactIx) -> ([u64; 2], [PieceIx; 2]) {
        let contact = &self.contacts[id];
        let birth = |slot: BodyIx| bodies.records[slot].birth;
        (contact.bodies.map(birth), contact.pieces)
    }

    /// Puts contacts in [`Self::order`], each once.
    pub(crate) fn sort(&self, bodies: &Bodies, ids: &mut Vec<ContactIx>) {
        ids.sort_unstable();
        ids.dedup();
        ids.sort_by_cached_key(|id| self.order(bodies, *id));
    }

    /// By line: whether a body is displaced out of another one that it was put into; nothing if none is.
    pub(crate) fn displaced(&self, bodies: &Bodies) -> Vec<bool> {
        let mut displaced = Vec::new();
        for &id in &self.deep {
            if self.cold(id).is_some_and(|(cold, lane)| cold.was_put(lane)) {
                displaced.resize(bodies.lines.len(), false);
                let (block, _, lane) = self.lane(id);
                for line in block.lines(lane) {
                    displaced[line] = bodies.lines[line].inverse_mass() > 0.0;
                }
            }
        }
        displaced
    }

    /// Whether there is such a contact, and it is too deep for the sweeps.
    pub(super) fn is_deep(&self, id: ContactIx) -> bool {
        self.cold(id).is_some_and(|(cold, lane)| cold.is_deep(lane))
    }

    /// Contacts of two bodies of very different mass that are awake.
    pub(crate) fn unequal_awake(&self, bodies: &Bodies) -> impl Iterator<Item = ContactIx> {
        let is = |id: &ContactIx| {
            let ends = self.contacts[*id].bodies;
            self.cold(*id).is_some() && Self::is_unequal(bodies, ends)
        };
        self.unequal.iter().copied().filter(is)
    }

    /// What belts gave in the last sub-step, to bodies and as heat, in J: impulse × speed of the belt.
    pub(crate) fn belt_work(&self) -> f64 {
        let colours = &self.colours[..self.awake_end()];
        let running = colours.iter().filter(|colour| colour.belts > 0);
        let blocks = running.flat_map(|colour| colour.blocks.iter().zip(&colour.cold));
        let lanes = blocks.flat_map(|(block, cold)| block.jt.iter().zip(&cold.belt));
        lanes.map(|(jt, belt)| jt * belt).sum()
    }

    /// Whether a contact touched when it was last asked.
    pub(crate) fn is_touching(&self, id: ContactIx) -> bool {
        let (_, cold, lane) = self.lane(id);
        cold.touching >> lane & 1 == 1
    }

    /// Gives a contact another surface; its impulses stay.
    pub(crate) fn resurface(&mut self, id: ContactIx, surface: Surface) {
        let (colour, k, lane) = self.colour_mut(id);
        colour.discount(k, lane);
        colour.blocks[k].mu[lane] = surface.friction;
        colour.cold[k].restitution[lane] = surface.restitution;
        colour.cold[k].belt[lane] = surface.tangent_speed;
        colour.count(k, lane);
    }

    /// Lets a contact start the next sub-step without impulses; velocities stay.
    pub(crate) fn clear_warm_start(&mut self, bodies: &mut Bodies, id: ContactIx) {
        let (block, lane) = self.block_mut(id);
        let [a, b] = block.lines(lane);
        let [push_a, push_b] = block.push(lane, &bodies.lines);
        bodies.start[a].add(&push_a);
        bodies.start[b].add(&push_b);
        block.set_impulses(lane, [0.0; 3]);
    }

    /// Notes whether a contact pushes that other than the last sweep changed.
    pub(super) fn note_pushing(&mut self, id: ContactIx) {
        if self.cold(id).is_some() {
            let (colour, k, _) = self.colour_mut(id);
            colour.pushes[k] = colour.blocks[k].pushing();
        }
    }

    /// The same of all in hard rows, which no sweep sees.
    pub(crate) fn note_hard_pushing(&mut self) {
        let end = self.awake_end();
        for colour in &mut self.colours[HARD..end] {
            for (pushes, block) in colour.pushes.iter_mut().zip(&colour.blocks) {
                *pushes = block.pushing();
            }
        }
    }

    /// Gives a contact another place until it is computed anew; it starts without impulses.
    pub(crate) fn put_anew(&mut self, bodies: &mut Bodies, id: ContactIx, manifold: &Manifold) {
        self.clear_warm_start(bodies, id);
        let (colour, k, lane) = self.colour_mut(id);
        colour.blocks[k].put(lane, manifold);
        colour.cold[k].hidden[lane] = [0.0; 2];
    }

    /// Lets a contact do nothing until it is computed anew.
    pub(crate) fn hide(&mut self, bodies: &mut Bodies, id: ContactIx) {
        self.clear_warm_start(bodies, id);
        let (colour, k, lane) = self.colour_mut(id);
        let block = &mut colour.blocks[k];
        (block.s1[lane], block.s2[lane]) = (OPEN, OPEN);
        let cold = &mut colour.cold[k];
        (cold.deep, cold.put) = (cold.deep & !(1 << lane), cold.put & !(1 << lane));
        cold.hidden[lane] = [0.0; 2];
    }
}

fn ids_in(colours: &[Colour]) -> impl Iterator<Item = ContactIx> {
    let cold = colours.iter().flat_map(|colour| &colour.cold);
    cold.flat_map(|cold| lanes(cold.used).map(|lane| cold.contact[lane]))
}
