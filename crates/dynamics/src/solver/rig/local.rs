//! Sweeps over a part of the rows.

use super::{Rig, RowId};
use crate::solver::Law;
use crate::solver::kernel::{Pass, sweep};
use crate::solver::lanes::COLOURS;
use crate::solver::wide::{LANES, Wide};

/// Rows that are swept more often in a sub-step than the others, which are swept once with bias and once without.
#[derive(Clone, Debug, Default)]
pub(crate) struct Often {
    pub(crate) rows: Vec<RowId>,
    /// How many times more with bias.
    pub(crate) solve: usize,
    /// How many times more without.
    pub(crate) relax: usize,
}

/// Rows of one zone, close together, and where each of them lies in it: colour and lane there, then lane here.
struct Near {
    zone: usize,
    colours: Vec<Vec<Wide>>,
    lanes: Vec<((usize, usize), (usize, usize))>,
}

impl Rig {
    /// Sweeps over these rows alone so many times: zone by zone, in the order of their colours.
    pub(super) fn sweep_near(&mut self, law: &Law, pass: Pass, sweeps: usize, rows: &[RowId]) {
        if sweeps == 0 || rows.is_empty() {
            return;
        }
        let mut near = self.gathered(rows);
        let mut met = Vec::new();
        for _ in 0..sweeps {
            for part in &mut near {
                let zone = &self.lanes.zones[part.zone];
                // What crosses from zone to zone knows all lines.
                let lines = if part.zone == 0 {
                    &mut self.lines[..]
                } else {
                    let first = zone.first as usize;
                    &mut self.lines[first..first + zone.count as usize]
                };
                self.heat += sweep(self.level, pass, law, lines, &mut part.colours, &mut met);
            }
        }
        for part in &near {
            let theirs = &mut self.lanes.zones[part.zone].colours;
            for &((colour, from), (block, lane)) in &part.lanes {
                let mine = &part.colours[colour][block];
                theirs[colour][from / LANES].copy_lane(from % LANES, mine, lane);
            }
        }
    }

    /// Copies of rows, in zones from the second on, then in the first.
    fn gathered(&self, rows: &[RowId]) -> Vec<Near> {
        let place = |id: &RowId| {
            let (zone, colour, index) = self.lanes.place_of(*id);
            (zone.wrapping_sub(1), colour, index)
        };
        let mut places: Vec<(usize, usize, usize)> = rows.iter().map(place).collect();
        places.sort_unstable();
        places.dedup();
        let mut near: Vec<Near> = Vec::new();
        for (zone, colour, index) in places {
            let zone = zone.wrapping_add(1);
            if near.last().is_none_or(|part| part.zone != zone) {
                near.push(Near {
                    zone,
                    colours: vec![Vec::new(); COLOURS + 1],
                    lanes: Vec::new(),
                });
            }
            let Some(part) = near.last_mut() else {
                continue;
            };
            let blocks = &mut part.colours[colour];
            // No two rows of a colour move the same body; of the last list each is alone.
            let last = part.lanes.last().filter(|((c, _), _)| *c == colour);
            let lane = last.map_or(LANES, |(_, (_, lane))| lane + 1);
            let lane = if lane < LANES && colour < COLOURS {
                lane
            } else {
                blocks.push(Wide::EMPTY);
                0
            };
            let block = blocks.len() - 1;
            let theirs = &self.lanes.zones[zone].colours[colour][index / LANES];
            blocks[block].copy_lane(lane, theirs, index % LANES);
            part.lanes.push(((colour, index), (block, lane)));
        }
        near
    }
}
