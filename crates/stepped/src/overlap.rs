//! Overlaps of what goes far in a sub-step.

use crate::Engine;
use crate::narrow::collide_any;
use crate::rows::{LANES, OPEN};

impl Engine {
    /// Rows know gaps to first order in how their bodies turn, and as if faces had no ends. Of bodies that go or turn as far as fast
    /// ones do gaps are those of their pieces instead, where continuous collision left them.
    pub(crate) fn measure_far(&mut self) {
        let Self {
            bodies,
            pieces,
            graph,
            far,
            ..
        } = self;
        let in_touch = |(line, _): &_| {
            let slot = bodies.slot_of[*line as usize];
            graph.of_body(bodies, slot).next().is_some()
        };
        if self.least_gap >= 0.0 || !far.iter().any(in_touch) {
            return;
        }
        let mut is_far = vec![false; bodies.lines.len()];
        for (line, _) in far {
            is_far[*line as usize] = true;
        }
        let mut least = OPEN;
        for colour in graph.awake() {
            for (block, cold) in colour.blocks.iter().zip(&colour.cold) {
                for lane in 0..LANES {
                    let ends = [block.a[lane], block.b[lane]].map(|line| line as usize);
                    let [a, b] = ends.map(|line| &bodies.lines[line]);
                    let [first, second] = cold.gaps(block, lane, [a, b]);
                    let gap = first.min(second);
                    if gap >= least {
                        continue;
                    }
                    if !(is_far[ends[0]] || is_far[ends[1]]) {
                        least = gap;
                        continue;
                    }
                    let [a, b] = cold.pieces[lane].map(|number| {
                        let piece = &pieces.list[number as usize];
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
