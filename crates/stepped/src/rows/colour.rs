//! The blocks of one colour, and which lanes are in use.

use super::block::{Block, Cold, LANES};
use crate::{ContactIx, PieceIx};

/// The blocks of one colour; a block and its cold part have the same number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Colour {
    pub(crate) blocks: Vec<Block>,
    pub(crate) cold: Vec<Cold>,
    /// A bit for each lane that pushes, as sweeps leave them.
    pub(crate) pushes: Vec<u8>,
    /// A bit for each lane that pushed when impacts were last looked for.
    pub(crate) pushed: Vec<u8>,
    /// How many contacts have restitution.
    pub(crate) bouncing: usize,
    /// How many contacts have a belt.
    pub(crate) belts: usize,
    /// Lanes in use; all but the last block are full.
    len: usize,
    /// Blocks without a contact, among those that have one each.
    holes: usize,
}

/// A lane that is copied.
pub(super) struct Lane {
    block: Block,
    cold: Cold,
    pushed: u8,
    lane: usize,
}

impl Lane {
    const EMPTY: Self = Self {
        block: Block::EMPTY,
        cold: Cold::EMPTY,
        pushed: 0,
        lane: 0,
    };
}

impl Colour {
    /// Contacts there are, but for those that have a block each.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    /// Gives the next lane to a contact, or a block of its own.
    pub(super) fn push(&mut self, alone: bool, id: ContactIx, pieces: [PieceIx; 2]) -> usize {
        let index = if alone {
            self.blocks.len() * LANES
        } else {
            self.len
        };
        let (k, lane) = (index / LANES, index % LANES);
        if k == self.blocks.len() {
            self.blocks.push(Block::EMPTY);
            self.cold.push(Cold::EMPTY);
            self.pushes.push(0);
            self.pushed.push(0);
        }
        let cold = &mut self.cold[k];
        cold.used |= 1 << lane;
        (cold.contact[lane], cold.pieces[lane]) = (id, pieces);
        self.len = index + 1;
        index
    }

    /// A lane came that may have restitution or a belt.
    pub(super) fn count(&mut self, k: usize, lane: usize) {
        self.bouncing += usize::from(self.cold[k].restitution[lane] > 0.0);
        self.belts += usize::from(self.cold[k].belt[lane].abs() > 0.0);
    }

    /// A lane that may have restitution or a belt goes.
    pub(super) fn discount(&mut self, k: usize, lane: usize) {
        self.bouncing -= usize::from(self.cold[k].restitution[lane] > 0.0);
        self.belts -= usize::from(self.cold[k].belt[lane].abs() > 0.0);
    }

    /// A lane of this or another colour, with all its fields.
    pub(super) fn copy(&self, k: usize, lane: usize) -> Lane {
        Lane {
            block: self.blocks[k],
            cold: self.cold[k],
            pushed: self.pushed[k],
            lane,
        }
    }

    /// Puts it into a lane.
    pub(super) fn paste(&mut self, k: usize, lane: usize, from: &Lane) {
        self.blocks[k].copy_lane(lane, &from.block, from.lane);
        self.cold[k].copy_lane(lane, &from.cold, from.lane);
        let pushed = (from.pushed >> from.lane & 1) << lane;
        self.pushed[k] = self.pushed[k] & !(1 << lane) | pushed;
        self.count(k, lane);
    }

    /// Empties a block that had one contact; whether a quarter of all are empty, and should go.
    ///
    /// An empty block moves nothing. Closing up at each removal took time by the square of the contacts: 400 discs at one
    /// point, 60,000 contacts here, took 190 s for a tenth of a second.
    pub(super) fn empty(&mut self, k: usize) -> bool {
        self.discount(k, 0);
        self.blocks[k] = Block::EMPTY;
        self.cold[k] = Cold::EMPTY;
        self.pushed[k] = 0;
        self.holes += 1;
        4 * self.holes > self.blocks.len()
    }

    /// Takes empty blocks out and tells of each contact that moved, with its new block; the order stays.
    pub(super) fn close_up(&mut self, mut moved: impl FnMut(ContactIx, usize)) {
        let mut count = 0;
        for k in 0..self.blocks.len() {
            if self.cold[k].used == 0 {
                continue;
            }
            if count < k {
                self.blocks[count] = self.blocks[k];
                self.cold[count] = self.cold[k];
                self.pushed[count] = self.pushed[k];
                moved(self.cold[count].contact[0], count);
            }
            count += 1;
        }
        self.blocks.truncate(count);
        self.cold.truncate(count);
        self.pushes.truncate(count);
        self.pushed.truncate(count);
        self.holes = 0;
    }

    /// Fills a hole with the last lane; which contact moved.
    pub(super) fn pull(&mut self, k: usize, lane: usize) -> Option<ContactIx> {
        self.len -= 1;
        self.discount(k, lane);
        let (last, from) = (self.len / LANES, self.len % LANES);
        let moves = (last, from) != (k, lane);
        if moves {
            let last_lane = self.copy(last, from);
            self.discount(last, from);
            self.paste(k, lane, &last_lane);
        }
        self.paste(last, from, &Lane::EMPTY);
        self.cold[last].used &= !(1 << from);
        if from == 0 {
            self.blocks.pop();
            self.cold.pop();
            self.pushes.pop();
            self.pushed.pop();
        }
        moves.then(|| self.cold[k].contact[lane])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_one_contact_keep_their_order_and_are_moved_few_times() {
        let mut colour = Colour::default();
        let count = 4000;
        for id in (0..count).map(ContactIx) {
            let _index = colour.push(true, id, [PieceIx(0); 2]);
        }
        let mut place: Vec<usize> = (0..count as usize).collect();
        let (mut left, mut moves) = ((0..count).map(ContactIx).collect::<Vec<_>>(), 0);
        // Every other one goes, then all but the last ten.
        let order = (0..count)
            .step_by(2)
            .chain((1..count - 10).step_by(2))
            .map(ContactIx);
        for id in order {
            left.retain(|&other| other != id);
            if colour.empty(place[id.at()]) {
                colour.close_up(|id, k| {
                    place[id.at()] = k;
                    moves += 1;
                });
            }
            let seen = colour.cold.iter().filter(|cold| cold.used > 0);
            assert!(seen.map(|cold| cold.contact[0]).eq(left.iter().copied()));
            assert!(
                left.iter()
                    .all(|&id| colour.cold[place[id.at()]].contact[0] == id)
            );
        }
        assert_eq!(left.len(), 5);
        assert!(moves <= 3 * count, "{moves} moves");
    }
}
