//! The blocks of one colour, and which lanes are in use.

use super::block::{Block, Cold, LANES};

/// The blocks of one colour; a block and its cold part have the same number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Colour {
    pub(crate) blocks: Vec<Block>,
    pub(crate) cold: Vec<Cold>,
    /// How many contacts of each block have restitution, and all of them.
    pub(crate) bounces: Vec<u8>,
    pub(crate) bouncing: usize,
    /// How many contacts have a belt.
    pub(crate) belts: usize,
    /// Lanes in use; all but the last block are full.
    len: usize,
}

impl Colour {
    /// Contacts there are, but for those that have a block each.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    /// Gives the next lane to a contact, or a block of its own.
    pub(super) fn push(&mut self, alone: bool, id: u32, pieces: [u32; 2]) -> usize {
        let index = if alone {
            self.blocks.len() * LANES
        } else {
            self.len
        };
        let (k, lane) = (index / LANES, index % LANES);
        if k == self.blocks.len() {
            self.blocks.push(Block::EMPTY);
            self.cold.push(Cold::EMPTY);
            self.bounces.push(0);
        }
        let cold = &mut self.cold[k];
        cold.used |= 1 << lane;
        (cold.contact[lane], cold.pieces[lane]) = (id, pieces);
        self.len = index + 1;
        index
    }

    /// A lane came that may have restitution or a belt.
    pub(super) fn count(&mut self, k: usize, lane: usize) {
        let bounces = self.cold[k].restitution[lane] > 0.0;
        self.bounces[k] += u8::from(bounces);
        self.bouncing += usize::from(bounces);
        self.belts += usize::from(self.cold[k].belt[lane].abs() > 0.0);
    }

    /// A lane that may have restitution or a belt goes.
    pub(super) fn discount(&mut self, k: usize, lane: usize) {
        let bounces = self.cold[k].restitution[lane] > 0.0;
        self.bounces[k] -= u8::from(bounces);
        self.bouncing -= usize::from(bounces);
        self.belts -= usize::from(self.cold[k].belt[lane].abs() > 0.0);
    }

    /// Fills a hole with the last lane; which contact moved.
    pub(super) fn pull(&mut self, k: usize, lane: usize) -> Option<u32> {
        self.len -= 1;
        self.discount(k, lane);
        let (last, from) = (self.len / LANES, self.len % LANES);
        let moves = (last, from) != (k, lane);
        if moves {
            let (block, cold) = (self.blocks[last], self.cold[last]);
            self.discount(last, from);
            self.blocks[k].copy_lane(lane, &block, from);
            self.cold[k].copy_lane(lane, &cold, from);
            self.count(k, lane);
        }
        self.blocks[last].copy_lane(from, &Block::EMPTY, 0);
        self.cold[last].copy_lane(from, &Cold::EMPTY, 0);
        self.cold[last].used &= !(1 << from);
        if from == 0 {
            self.blocks.pop();
            self.cold.pop();
            self.bounces.pop();
        }
        moves.then(|| self.cold[k].contact[lane])
    }
}
