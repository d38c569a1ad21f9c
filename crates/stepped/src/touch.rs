//! Which pieces touch: begins and ends, as a caller asks for them.

use crate::Engine;
use crate::rows::lanes;

/// Two convex pieces began or ceased to touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Touch {
    /// Tags of the pieces: that of the body that was inserted first comes first.
    pub tags: [u64; 2],
    /// Whether it began.
    pub begins: bool,
}

impl Engine {
    /// Adds what began and ceased to touch since this was last asked, in no order that means anything; pieces touch
    /// while a point of theirs pushes, or they are deep in each other. Contacts of what sleeps stay as they are.
    pub fn touches(&mut self, found: &mut Vec<Touch>) {
        found.extend(self.ended.drain(..).map(|tags| Touch {
            tags,
            begins: false,
        }));
        let pieces = &self.pieces;
        for colour in self.graph.awake() {
            for (block, cold) in colour.blocks.iter().zip(&mut colour.cold) {
                // What is too deep for the sweeps touches as well: hard rows part it without impulses.
                let now = (block.pushing() | cold.deep) & cold.used;
                let changed = now ^ cold.touching;
                cold.touching = now;
                found.extend(lanes(changed).map(|lane| Touch {
                    tags: pieces.tags(cold.pieces[lane]),
                    begins: now >> lane & 1 == 1,
                }));
            }
        }
    }
}
