//! Where rows lie: colours, so that no block moves a body twice, and lanes that rows keep.

use super::Row;
use super::wide::{LANES, Line, Wide};
use super::zone::Zone;

/// Colours of a mask; rows of a body with more contacts than that get a block each.
pub(super) const COLOURS: usize = 64;

/// Rows against what cannot be moved take the highest free colour below this one, so that the
/// ground has the last word. Piles of boxes need 6 to 10 colours.
const GROUND: usize = 12;

/// Name of a row, for as long as the row is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct RowId(pub(crate) u32);

/// The lane of a row.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    zone: u32,
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
    /// The first holds rows over all lines; the others know those of their own zone alone.
    pub(super) zones: Vec<Zone>,
    places: Vec<Place>,
    free: Vec<RowId>,
    /// Zone of each line; 0: none.
    zone_of: Vec<u32>,
    /// Whose double a line is; most are their own.
    master: Vec<u32>,
    /// Colours that each body has rows in: within its zone, and over all lines.
    masks: Vec<[u64; 2]>,
    /// Rows of each body.
    degrees: Vec<u32>,
    /// Some row has, or had, surfaces that run along.
    belts: bool,
}

impl Default for Lanes {
    fn default() -> Self {
        Self {
            zones: vec![Zone::new(0, 0, Vec::new())],
            places: Vec::new(),
            free: Vec::new(),
            zone_of: Vec::new(),
            master: Vec::new(),
            masks: Vec::new(),
            degrees: Vec::new(),
            belts: false,
        }
    }
}

impl Lanes {
    /// Makes room for a body at `slot`.
    pub(super) fn admit(&mut self, slot: u32) {
        let count = slot as usize + 1;
        if self.masks.len() < count {
            self.masks.resize(count, [0; 2]);
            self.degrees.resize(count, 0);
            self.zone_of.resize(count, 0);
            self.master.resize(count, slot);
        }
        self.masks[slot as usize] = [0; 2];
        self.degrees[slot as usize] = 0;
    }

    pub(crate) fn degree(&self, slot: u32) -> u32 {
        self.degrees[slot as usize]
    }

    pub(crate) fn len(&self) -> usize {
        self.places.len() - self.free.len()
    }

    /// Whether relaxing sweeps must read at which slip surfaces run along with each other.
    pub(super) const fn has_belts(&self) -> bool {
        self.belts
    }

    /// Whether surfaces of some row run along is asked of all rows that come.
    pub(super) fn notes(&mut self, row: &Row) {
        self.belts |= row.belt != 0.0;
    }

    /// Gives a row a lane.
    pub(super) fn insert(&mut self, row: &Row, lines: &[Line]) -> RowId {
        let id = self.free.pop().unwrap_or_else(|| {
            #[expect(clippy::cast_possible_truncation, reason = "120 bytes each")]
            let id = RowId(self.places.len() as u32);
            self.places.push(Place::default());
            id
        });
        self.place(id, row, row.acts(), lines);
        id
    }

    fn place(&mut self, id: RowId, row: &Row, acts: bool, lines: &[Line]) {
        self.notes(row);
        let ends = [row.bodies.0, row.bodies.1];
        let moves = ends.map(|i| lines[i as usize].inverse_mass() > 0.0);
        let (zone, local) = self.home(ends, moves);
        let side = usize::from(zone == 0);
        let mut taken = 0;
        for (i, moved) in ends.into_iter().zip(moves) {
            self.degrees[i as usize] += 1;
            taken |= if moved {
                self.masks[i as usize][side]
            } else {
                0
            };
        }
        let colour = colour_for(taken, moves == [true, true]);
        for (i, moved) in ends.into_iter().zip(moves) {
            if moved && colour < COLOURS {
                self.masks[i as usize][side] |= 1 << colour;
            }
        }
        let index = self.zones[zone].push(colour, id, acts);
        let (block, lane) = (index / LANES, index % LANES);
        let wide = &mut self.zones[zone].colours[colour][block];
        (wide.a[lane], wide.b[lane]) = (local[0], local[1]);
        wide.put(
            lane,
            row,
            &lines[ends[0] as usize],
            &lines[ends[1] as usize],
        );
        #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 rows")]
        {
            self.places[id.0 as usize] = Place {
                zone: zone as u32,
                colour: colour as u32,
                index: index as u32,
            };
        }
    }

    /// The zone that knows both bodies, and their lines as it numbers them.
    fn home(&self, ends: [u32; 2], moves: [bool; 2]) -> (usize, [u32; 2]) {
        let [a, b] = ends.map(|i| self.zone_of[i as usize] as usize);
        let zone = match moves {
            [true, true] if a == b => a,
            [true, false] => a,
            [false, true] => b,
            _ => 0,
        };
        if zone == 0 {
            return (0, ends);
        }
        let known = &self.zones[zone];
        let line = |k: usize| {
            if moves[k] {
                Some(ends[k])
            } else {
                known.double(ends[k])
            }
        };
        match (line(0), line(1)) {
            (Some(a), Some(b)) => (zone, [a - known.first, b - known.first]),
            _ => (0, ends),
        }
    }

    /// Takes a row out; the last lane of its colour moves into the hole.
    pub(super) fn remove(&mut self, id: RowId, lines: &[Line]) {
        let place = self.places[id.0 as usize];
        let (zone, colour) = (place.zone as usize, place.colour as usize);
        let (a, b) = self.bodies(place);
        for i in [a as usize, b as usize] {
            self.degrees[i] -= 1;
            if lines[i].inverse_mass() > 0.0 && colour < COLOURS {
                self.masks[i][usize::from(zone == 0)] &= !(1 << colour);
            }
        }
        let (block, lane) = place.block();
        if let Some(owner) = self.zones[zone].pull(colour, block, lane) {
            self.places[owner.0 as usize].index = place.index;
        }
        self.free.push(id);
    }

    /// Lines of a row's bodies.
    fn bodies(&self, place: Place) -> (u32, u32) {
        let zone = &self.zones[place.zone as usize];
        let (block, lane) = place.block();
        let wide = &zone.colours[place.colour as usize][block];
        let line = |i: u32| self.master[(i + zone.first) as usize];
        (line(wide.a[lane]), line(wide.b[lane]))
    }

    /// Lines of a row's bodies: one cache line is read, and of a whole row twenty.
    pub(super) fn bodies_of(&self, id: RowId) -> (u32, u32) {
        self.bodies(self.places[id.0 as usize])
    }

    /// A row as it is now, with its gaps where the bodies are.
    pub(super) fn row(&self, id: RowId, lines: &[Line]) -> Row {
        let (wide, lane) = self.at(id);
        wide.row(lane, self.bodies_of(id), lines)
    }

    /// The block and lane of a row.
    pub(crate) fn at(&self, id: RowId) -> (&Wide, usize) {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        let zone = &self.zones[place.zone as usize];
        (&zone.colours[place.colour as usize][block], lane)
    }

    pub(super) fn at_mut(&mut self, id: RowId) -> (&mut Wide, usize) {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        let zone = &mut self.zones[place.zone as usize];
        (&mut zone.colours[place.colour as usize][block], lane)
    }

    /// Whether a row pushed when [`Self::turned`] was last asked, or came with impulses since.
    pub(crate) fn acted(&self, id: RowId) -> bool {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        self.zones[place.zone as usize].acts[place.colour as usize][block] >> lane & 1 == 1
    }

    /// Whether a row of this name is in a lane.
    pub(super) fn holds(&self, id: RowId) -> bool {
        let place = self.places[id.0 as usize];
        let (block, lane) = place.block();
        // A row that went keeps its last place, and the zone may be gone since.
        let zone = self.zones.get(place.zone as usize);
        zone.and_then(|zone| zone.owner(place.colour as usize, block, lane)) == Some(id)
    }

    /// Rows that began or ceased to push since this was last asked.
    pub(crate) fn turned(&mut self, changed: &mut Vec<RowId>) {
        for zone in &mut self.zones {
            zone.turned(changed);
        }
    }

    /// Rows that pushed when [`Self::turned`] was last asked lie side by side from now on. No sum depends on where a row of
    /// a colour lies, but for that of heat.
    pub(crate) fn part_idle(&mut self) {
        for zone in &mut self.zones {
            let places = &mut self.places;
            zone.part_idle(|id, index| {
                #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 rows")]
                {
                    places[id.0 as usize].index = index as u32;
                }
            });
        }
    }

    /// Bodies of all rows that push.
    pub(crate) fn links(&self) -> impl Iterator<Item = (u32, u32)> + use<'_> {
        self.zones.iter().flat_map(|zone| {
            let blocks = zone.colours.iter().flatten();
            blocks.flat_map(|wide| {
                let line = |i: u32| self.master[(i + zone.first) as usize];
                (0..LANES)
                    .filter(|lane| wide.j1[*lane] + wide.j2[*lane] > 0.0)
                    .map(move |lane| (line(wide.a[lane]), line(wide.b[lane])))
            })
        })
    }

    /// All rows, in the order in which they are solved for one after the other.
    pub(super) fn ids(&self) -> impl Iterator<Item = RowId> + use<'_> {
        let (over_all, zones) = self.zones.split_at(1);
        let zones = zones.iter().chain(over_all);
        zones.flat_map(|zone| zone.owners.iter().flatten().copied())
    }

    /// Rows over all lines.
    pub(super) fn loose(&self) -> usize {
        self.zones[0].owners.iter().map(Vec::len).sum()
    }

    /// Where the lines of zones begin and end; the same place if there are none.
    pub(super) fn zoned(&self) -> (usize, usize) {
        match (self.zones.get(1), self.zones.last()) {
            (Some(first), Some(last)) => (first.first as usize, (last.first + last.count) as usize),
            _ => (self.zone_of.len(), self.zone_of.len()),
        }
    }

    /// Tells every row that the bodies have moved to other lines; there are no zones.
    pub(super) fn renumber(&mut self, new: &[u32]) {
        for wide in self.zones[0].colours.iter_mut().flatten() {
            for i in wide.a.iter_mut().chain(&mut wide.b) {
                *i = new[*i as usize];
            }
        }
        let kept = |old: &usize| new[*old] != u32::MAX;
        let old: Vec<usize> = (0..new.len()).filter(kept).collect();
        self.masks = old.iter().map(|i| self.masks[*i]).collect();
        self.degrees = old.iter().map(|i| self.degrees[*i]).collect();
        self.zone_of = vec![0; old.len()];
        self.master = (0u32..).take(old.len()).collect();
    }

    /// Puts all rows into new zones: `new` is the line that each body moves to, `lines` those as they are then.
    pub(super) fn settle(&mut self, old: &[Line], new: &[u32], zones: Vec<Zone>, lines: &[Line]) {
        let rows = self.ids().map(|id| (id, self.row(id, old), self.acted(id)));
        let rows: Vec<(RowId, Row, bool)> = rows.collect();
        self.zones = zones;
        self.masks = vec![[0; 2]; lines.len()];
        self.degrees = vec![0; lines.len()];
        self.zone_of = vec![0; lines.len()];
        self.master = (0u32..).take(lines.len()).collect();
        for (number, zone) in (0u32..).zip(&self.zones) {
            for slot in zone.first..zone.first + zone.count {
                self.zone_of[slot as usize] = number;
            }
            for &(master, double) in &zone.doubles {
                self.master[double as usize] = master;
            }
        }
        for (id, mut row, acts) in rows {
            let (a, b) = row.bodies;
            row.bodies = (new[a as usize], new[b as usize]);
            self.place(id, &row, acts, lines);
        }
        // Blocks lie in memory as they are swept, and not as they grew.
        self.zones = self.zones.clone();
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
        let mut masks = vec![[0u64; 2]; self.masks.len()];
        let mut degrees = vec![0u32; self.masks.len()];
        for (z, zone) in self.zones.iter().enumerate() {
            for (c, blocks) in zone.colours.iter().enumerate() {
                for (k, wide) in blocks.iter().enumerate() {
                    let mut seen = Vec::new();
                    for lane in 0..LANES {
                        let Some(owner) = zone.owner(c, k, lane) else {
                            assert_eq!((wide.a[lane], wide.b[lane]), (0, 0));
                            continue;
                        };
                        let place = self.places[owner.0 as usize];
                        let index = if c == COLOURS {
                            k * LANES
                        } else {
                            k * LANES + lane
                        };
                        let there = (
                            place.zone as usize,
                            place.colour as usize,
                            place.index as usize,
                        );
                        assert_eq!(there, (z, c, index));
                        let (a, b) = self.bodies(place);
                        for i in [a, b] {
                            degrees[i as usize] += 1;
                            if lines[i as usize].inverse_mass() > 0.0 {
                                assert!(!seen.contains(&i), "body {i} twice in a block");
                                seen.push(i);
                                if c < COLOURS {
                                    masks[i as usize][usize::from(z == 0)] |= 1 << c;
                                }
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
