//! Zones: stretches of lines with the rows between them, which are swept without a look at anything else.
//!
//! A zone knows its own lines alone, so that zones may be swept at the same time, and one after the other
//! without leaving the cache. What cannot be moved has a double in every zone that it touches.

use super::lanes::{COLOURS, RowId};
use super::rig::Ahead;
use super::wide::{LANES, Wide};

/// Rows that only know the lines of a stretch.
#[derive(Clone, Debug)]
pub(crate) struct Zone {
    /// One list of blocks a colour; the last list holds one row a block.
    pub(super) colours: Vec<Vec<Wide>>,
    /// Whose the lanes of each colour are, in order.
    pub(super) owners: Vec<Vec<RowId>>,
    /// Lanes that pushed when they were last asked, a bit each, block by block.
    pub(super) acts: Vec<Vec<u8>>,
    /// Its lines: the first one serves empty lanes.
    pub(super) first: u32,
    pub(super) count: u32,
    /// What cannot be moved: its line, and its double here; in order.
    pub(super) doubles: Vec<(u32, u32)>,
    /// What a sub-step tells: whether a contact closed with a speed, and what friction turned into heat, in J.
    pub(super) met: bool,
    pub(super) heat: f64,
    /// What it was before several sub-steps that were made at once.
    pub(super) ahead: Ahead,
}

impl Zone {
    pub(super) fn new(first: u32, count: u32, doubles: Vec<(u32, u32)>) -> Self {
        Self {
            colours: vec![Vec::new(); COLOURS + 1],
            owners: vec![Vec::new(); COLOURS + 1],
            acts: vec![Vec::new(); COLOURS + 1],
            first,
            count,
            doubles,
            met: false,
            heat: 0.0,
            ahead: Ahead::default(),
        }
    }

    /// The double of what cannot be moved.
    pub(super) fn double(&self, line: u32) -> Option<u32> {
        let at = self.doubles.binary_search_by_key(&line, |(line, _)| *line);
        at.ok().map(|at| self.doubles[at].1)
    }

    /// Makes room for a row; its index in its colour.
    pub(super) fn push(&mut self, colour: usize, id: RowId, acts: bool) -> usize {
        let (blocks, owners) = (&mut self.colours[colour], &mut self.owners[colour]);
        let bits = &mut self.acts[colour];
        let index = if colour == COLOURS {
            bits.push(0);
            blocks.push(Wide::EMPTY);
            (blocks.len() - 1) * LANES
        } else {
            if owners.len().is_multiple_of(LANES) {
                bits.push(0);
                blocks.push(Wide::EMPTY);
            }
            owners.len()
        };
        owners.push(id);
        if acts {
            bits[index / LANES] |= 1 << (index % LANES);
        }
        index
    }

    /// Takes a lane out; the last one of its colour moves into the hole, and its owner is told.
    pub(super) fn pull(&mut self, colour: usize, block: usize, lane: usize) -> Option<RowId> {
        let blocks = &mut self.colours[colour];
        let owners = &mut self.owners[colour];
        let acts = &mut self.acts[colour];
        if colour == COLOURS {
            acts.swap_remove(block);
            blocks.swap_remove(block);
            owners.swap_remove(block);
            return owners.get(block).copied();
        }
        let last = owners.len() - 1;
        let moved = blocks[last / LANES];
        blocks[block].copy_lane(lane, &moved, last % LANES);
        let bit = acts[last / LANES] >> (last % LANES) & 1;
        acts[block] = acts[block] & !(1 << lane) | bit << lane;
        acts[last / LANES] &= !(1 << (last % LANES));
        owners.swap_remove(block * LANES + lane);
        if last.is_multiple_of(LANES) {
            acts.pop();
            blocks.pop();
        } else {
            blocks[last / LANES].copy_lane(last % LANES, &Wide::EMPTY, 0);
        }
        owners.get(block * LANES + lane).copied()
    }

    /// The row of a block's lane, if there is one.
    pub(super) fn owner(&self, colour: usize, block: usize, lane: usize) -> Option<RowId> {
        let index = if colour == COLOURS {
            block
        } else {
            block * LANES + lane
        };
        let there = colour != COLOURS || lane == 0;
        self.owners[colour].get(index).copied().filter(|_| there)
    }

    /// Rows that began or ceased to push since this was last asked.
    pub(super) fn turned(&mut self, changed: &mut Vec<RowId>) {
        for (c, blocks) in self.colours.iter().enumerate() {
            for (k, (wide, acts)) in blocks.iter().zip(&mut self.acts[c]).enumerate() {
                let mut now = 0;
                for lane in 0..LANES {
                    now |= u8::from(wide.j1[lane] + wide.j2[lane] > 0.0) << lane;
                }
                let mut turned = now ^ *acts;
                *acts = now;
                while turned != 0 {
                    let lane = turned.trailing_zeros() as usize;
                    turned &= turned - 1;
                    let index = if c == COLOURS { k } else { k * LANES + lane };
                    changed.push(self.owners[c][index]);
                }
            }
        }
    }

    /// Brings rows that pushed when they were last asked into the first blocks of their colours: blocks in which nothing
    /// pushes are left alone. Calls `moved` with every row that lies elsewhere now, and its index in its colour.
    pub(super) fn part_idle(&mut self, mut moved: impl FnMut(RowId, usize)) {
        let all = self.colours.iter_mut().zip(&mut self.owners);
        for ((blocks, owners), acts) in all.zip(&mut self.acts).take(COLOURS) {
            let (mut first, mut last) = (0, blocks.len());
            // Blocks before `first` are full of rows that push, and those from `last` on have none.
            while first + 1 < last {
                let full = acts[first] == u8::MAX;
                if full {
                    first += 1;
                } else if acts[last - 1] == 0 {
                    last -= 1;
                } else {
                    let (lane, theirs) = (
                        acts[first].trailing_ones() as usize,
                        acts[last - 1].trailing_zeros() as usize,
                    );
                    let (head, tail) = blocks.split_at_mut(last - 1);
                    head[first].swap_lanes(lane, &mut tail[0], theirs);
                    acts[first] |= 1 << lane;
                    acts[last - 1] &= !(1 << theirs);
                    let (one, two) = (first * LANES + lane, (last - 1) * LANES + theirs);
                    owners.swap(one, two);
                    moved(owners[one], one);
                    moved(owners[two], two);
                }
            }
        }
    }
}
