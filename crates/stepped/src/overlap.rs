//! Overlaps of what goes far in a sub-step.

use crate::narrow::collide_any;
use crate::rows::{LANES, OPEN};
use crate::{BodyId, Engine};

/// As many times as far as a fast body goes at least. 1: a smash takes 1.04 of the time; 2: 1.00 to 1.02, and the second order of a
/// turn by that is 3 % of an extent.
const FAR: f64 = 2.0;

impl Engine {
    /// Rows know gaps to first order in how their bodies turn, and as if faces had no ends. Of bodies that went or turned by more than
    /// half of their least half width, or that continuous collision `stopped`, gaps are those of their pieces instead, where it left
    /// them: rows that rotated are those of where it found them.
    pub(crate) fn measure_far(&mut self, stopped: &[BodyId]) {
        let Self {
            bodies,
            pieces,
            graph,
            far,
            ..
        } = self;
        if self.least_gap >= 0.0 || far.is_empty() && stopped.is_empty() {
            return;
        }
        let mut is_far = vec![false; bodies.lines.len()];
        for &(line, before) in &*far {
            let (went, limit) = (&bodies.lines[line], &bodies.limits[line]);
            let way = went.d() - before.v();
            let turn = went.turn() - before.w();
            is_far[line] = limit.is_far(way.length_squared() / (FAR * FAR), turn / FAR)
                && graph.of_body(bodies, bodies.slot_of[line]).next().is_some();
        }
        for id in stopped {
            is_far[bodies.line_of(id.slot)] = true;
        }
        if !is_far.contains(&true) {
            return;
        }
        let mut least = OPEN;
        for colour in graph.awake() {
            for (block, cold) in colour.blocks.iter().zip(&colour.cold) {
                for lane in 0..LANES {
                    let ends = block.lines(lane);
                    let [first, second] = cold.gaps(block, lane, &bodies.lines);
                    let gap = first.min(second);
                    if gap >= least {
                        continue;
                    }
                    if !(is_far[ends[0]] || is_far[ends[1]]) {
                        least = gap;
                        continue;
                    }
                    let [a, b] = cold.pieces[lane].map(|number| {
                        let piece = &pieces.list[number];
                        (piece, bodies.pose_of(piece.body))
                    });
                    if let Some(found) = collide_any(a, b, 0.0) {
                        least = least.min(found.gap());
                    }
                }
            }
        }
        self.least_gap = least;
    }
}
