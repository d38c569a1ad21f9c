//! Where rows lie: colours, so that no block moves a body twice, and lanes that rows keep.

use super::Row;
use super::wide::{LANES, Line, Wide};

/// Colours of a mask; rows of a body with more contacts than that get a block each.
const COLOURS: usize = 64;

/// Rows against what cannot be moved take the highest free colour below this one, so that the
/// ground has the last word. Piles of boxes need 6 to 10 colours.
const GROUND: usize = 12;

/// Name of a row, for as long as the row is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct RowId(pub(crate) u32);

/// The lane of a row.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    colour: u32,
    index: u32,
}

impl Place {
    const fn block(self) -> (usize, usize) {
        let index = self.index as usize;
        (index / LANES, index % LANES)
    }
}

/// All rows. Adding and removing moves one lane at most.
#[derive(Clone, Debug)]
pub(crate) struct Lanes {
    /// One list of blocks a colour; the last list holds one row a block.
    pub(super) colours: Vec<Vec<Wide>>,
    /// Whose the lanes of each colour are, in order.
    owners: Vec<Vec<RowId>>,
    /// Lanes that pushed when they were last asked, a bit each, block by block.
    acts: Vec<Vec<u8>>,
    places: Vec<Place>,
    free: Vec<RowId>,
    /// Colours that each body has rows in.
    masks: Vec<u64>,
    /// Rows of each body.
    degrees: Vec<u32>,
}

impl Default for Lanes {
    fn default() -> Self {
        Self {
            colours: vec![Vec::new(); COLOURS + 1],
            owners: vec![Vec::new(); COLOURS + 1],
            acts: vec![Vec::new(); COLOURS + 1],
            places: Vec::new(),
            free: Vec::new(),
            masks: Vec::new(),
            degrees: Vec::new(),
        }
    }
}

impl Lanes {
    /// Makes room for a body at `slot`.
    pub(super) fn admit(&mut self, slot: u32) {
        let count = slot as usize + 1;
        if self.masks.len() < count {
            self.masks.resize(count, 0);
            self.degrees.resize(count, 0);
        }
        self.masks[slot as usize] = 0;
        self.degrees[slot as usize] = 0;
    }

    pub(crate) fn degree(&self, slot: u32) -> u32 {
        self.degrees[slot as usize]
    }

    pub(crate) fn len(&self) -> usize {
        self.places.len() - self.free.len()
    }

    /// Gives a row a lane.
    pub(super) fn insert(&mut self, row: &Row, lines: &[Line]) -> RowId {
        let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
        let moves = [a, b].map(|i| lines[i].inverse_mass() > 0.0);
        let mask = |i: usize, moved: bool| if moved { self.masks[i] } else { 0 };
        let taken = mask(a, moves[0]) | mask(b, moves[1]);
        let colour = colour_for(taken, moves == [true, true]);
        let id = self.free.pop().unwrap_or_else(|| {
            #[expect(clippy::cast_possible_truncation, reason = "120 bytes each")]
            let id = RowId(self.places.len() as u32);
            self.places.push(Place::default());
            id
        });
        let (blocks, owners) = (&mut self.colours[colour], &mut self.owners[colour]);
        let acts = &mut self.acts[colour];
        let index = if colour == COLOURS {
            acts.push(0);
            blocks.push(Wide::EMPTY);
            (blocks.len() - 1) * LANES
        } else {
            if owners.len().is_multiple_of(LANES) {
                acts.push(0);
                blocks.push(Wide::EMPTY);
            }
            owners.len()
        };
        owners.push(id);
        if row.acts() {
            acts[index / LANES] |= 1 << (index % LANES);
        }
        blocks[index / LANES].put(index % LANES, row, &lines[a], &lines[b]);
        #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 rows")]
        {
            self.places[id.0 as usize] = Place {
                colour: colour as u32,
                index: index as u32,
            };
        }
        for (i, moved) in [(a, moves[0]), (b, moves[1])] {
            self.degrees[i] += 1;
            if moved && colour < COLOURS {
                self.masks[i] |= 1 << colour;
            }
        }
        id
    }

    /// Takes a row out; the last lane of its colour moves into the hole.
    pub(super) fn remove(&mut self, id: RowId, lines: &[Line]) {
        let place = self.places[id.0 as usize];
        let colour = place.colour as usize;
        let (block, lane) = place.block();
        let blocks = &mut self.colours[colour];
        for i in [blocks[block].a[lane], blocks[block].b[lane]] {
            let i = i as usize;
            self.degrees[i] -= 1;
            if lines[i].inverse_mass() > 0.0 && colour < COLOURS {
                self.masks[i] &= !(1 << colour);
            }
        }
        let owners = &mut self.owners[colour];
        let acts = &mut self.acts[colour];
        let owner = if colour == COLOURS {
            acts.swap_remove(block);
            blocks.swap_remove(block);
            owners.swap_remove(block);
            owners.get(block).copied()
        } else {
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
        };
        if let Some(owner) = owner {
            self.places[owner.0 as usize].index = place.index;
        }
        self.free.push(id);
    }

    /// The block and lane of a row.
    pub(super) fn at(&self, id: RowId) -> (&Wide, usize) {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        (&self.colours[place.colour as usize][block], lane)
    }

    pub(super) fn at_mut(&mut self, id: RowId) -> (&mut Wide, usize) {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        (&mut self.colours[place.colour as usize][block], lane)
    }

    /// Whether a row pushed when [`Self::turned`] was last asked, or came with impulses since.
    pub(crate) fn acted(&self, id: RowId) -> bool {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        self.acts[place.colour as usize][block] >> lane & 1 == 1
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

    /// Whether a row of this name is in a lane.
    pub(super) fn holds(&self, id: RowId) -> bool {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        self.owner(place.colour as usize, block, lane) == Some(id)
    }

    /// Rows that began or ceased to push since this was last asked.
    pub(crate) fn turned(&mut self, changed: &mut Vec<RowId>) {
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

    /// Bodies of all rows that push.
    pub(crate) fn links(&self) -> impl Iterator<Item = (u32, u32)> + use<'_> {
        self.colours.iter().flatten().flat_map(|wide| {
            (0..LANES)
                .filter(|lane| wide.j1[*lane] + wide.j2[*lane] > 0.0)
                .map(|lane| (wide.a[lane], wide.b[lane]))
        })
    }

    /// All rows, in the order in which they are solved for.
    pub(super) fn rows<'a>(&'a self, lines: &'a [Line]) -> impl Iterator<Item = Row> + use<'a> {
        self.colours
            .iter()
            .enumerate()
            .flat_map(move |(c, blocks)| {
                let count = self.owners[c].len();
                let used = move |k: usize| {
                    if c == COLOURS {
                        1
                    } else {
                        (count - k * LANES).min(LANES)
                    }
                };
                blocks
                    .iter()
                    .enumerate()
                    .flat_map(move |(k, wide)| (0..used(k)).map(move |lane| wide.row(lane, lines)))
            })
    }

    /// Tells every row that the bodies have moved to other lines.
    pub(super) fn renumber(&mut self, new: &[u32]) {
        for wide in self.colours.iter_mut().flatten() {
            for i in wide.a.iter_mut().chain(&mut wide.b) {
                *i = new[*i as usize];
            }
        }
        let count = new.iter().filter(|i| **i != u32::MAX).count();
        let mut masks = vec![0; count];
        let mut degrees = vec![0; count];
        for (old, &i) in new.iter().enumerate() {
            if i != u32::MAX {
                masks[i as usize] = self.masks[old];
                degrees[i as usize] = self.degrees[old];
            }
        }
        (self.masks, self.degrees) = (masks, degrees);
    }
}

/// The colour for a row whose bodies have rows in the colours of `taken`.
fn colour_for(taken: u64, between_moving: bool) -> usize {
    let lowest = (!taken).trailing_zeros() as usize;
    if between_moving {
        return lowest;
    }
    let below = !taken & ((1 << GROUND) - 1);
    if below == 0 {
        lowest
    } else {
        63 - below.leading_zeros() as usize
    }
}

#[cfg(test)]
impl Lanes {
    /// No body twice among the moving ones of a block, masks and places as the lanes are.
    pub(super) fn check(&self, lines: &[Line]) {
        let mut masks = vec![0u64; self.masks.len()];
        let mut degrees = vec![0u32; self.masks.len()];
        for (c, blocks) in self.colours.iter().enumerate() {
            for (k, wide) in blocks.iter().enumerate() {
                let mut seen = Vec::new();
                for lane in 0..LANES {
                    let (index, alone) = (k * LANES + lane, c == COLOURS);
                    let owner = if alone {
                        (lane == 0).then(|| self.owners[c][k])
                    } else {
                        self.owners[c].get(index).copied()
                    };
                    let Some(owner) = owner else {
                        assert_eq!((wide.a[lane], wide.b[lane]), (0, 0));
                        continue;
                    };
                    let place = self.places[owner.0 as usize];
                    assert_eq!((place.colour as usize, place.index as usize), (c, index));
                    for i in [wide.a[lane], wide.b[lane]] {
                        degrees[i as usize] += 1;
                        if lines[i as usize].inverse_mass() > 0.0 {
                            assert!(!seen.contains(&i), "body {i} twice in a block");
                            seen.push(i);
                            if !alone {
                                masks[i as usize] |= 1 << c;
                            }
                        }
                    }
                }
            }
        }
        assert_eq!(masks, self.masks);
        assert_eq!(degrees, self.degrees);
    }
}
