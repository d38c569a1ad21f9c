//! What must hold of the graph between all calls.

use crate::LineIx;
use crate::bodies::Bodies;
use crate::rows::Quad;
use crate::rows::block::LANES;
use crate::rows::graph::{ASLEEP, Graph};

impl Graph {
    /// No body twice in a block, colours and places as the lanes are, warm starts the sum of impulses.
    pub(crate) fn check(&self, bodies: &Bodies) {
        let mut masks = vec![0u64; bodies.records.len()];
        let mut sums = vec![Quad::default(); bodies.lines.len()];
        let mut count = 0;
        for (c, colour) in self.colours.iter().enumerate() {
            let restitutions = colour.cold.iter().flat_map(|cold| cold.restitution);
            let bouncing = restitutions.filter(|e| *e > 0.0);
            assert_eq!(colour.bouncing, bouncing.count());
            for (k, (block, cold)) in colour.blocks.iter().zip(&colour.cold).enumerate() {
                let mut seen = Vec::new();
                for lane in 0..LANES {
                    if cold.used >> lane & 1 == 0 {
                        assert_eq!(block.lines(lane), [LineIx::EMPTY; 2]);
                        continue;
                    }
                    count += 1;
                    let contact = &self.contacts[cold.contact[lane]];
                    assert_eq!((contact.colour as usize, contact.place()), (c, (k, lane)));
                    assert_eq!(contact.pieces, cold.pieces[lane]);
                    let lines = block.lines(lane);
                    if c == ASLEEP {
                        assert_eq!(lines, [LineIx::EMPTY; 2]);
                        continue;
                    }
                    let pushes = block.push(lane, &bodies.lines);
                    for side in [0, 1] {
                        let slot = contact.bodies[side];
                        assert_eq!(bodies.records[slot].line, lines[side]);
                        sums[lines[side]].add(&pushes[side]);
                        if bodies.is_dynamic(slot) {
                            assert!(!seen.contains(&slot), "body {slot:?} twice in a block");
                            seen.push(slot);
                            masks[slot.at()] |= contact.mask();
                        }
                    }
                }
            }
        }
        assert_eq!(count, self.len());
        for (slot, record) in bodies.records.iter().enumerate() {
            assert!(!record.live || record.colours == masks[slot]);
        }
        for (line, sum) in sums.iter().enumerate() {
            let (v, start) = (&bodies.lines[line], &bodies.start[line]);
            let off = (v.v() - start.v() - sum.v()).length() + (v.w() - start.w() - sum.w()).abs();
            let scale = 1.0 + v.v().length() + v.w().abs() + sum.v().length();
            assert!(
                off <= 1e-10 * scale,
                "warm start of line {line} is off by {off}"
            );
        }
    }
}
