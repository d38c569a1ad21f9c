//! Impacts within a tick: bodies that strike each other too often join the engine.

use crate::store::slots::List;
use crate::{BodyIx, Ix};

/// So many bodies that strike each other stay with their exact impacts up to [`SERIES`].
const HANDFUL: f64 = 6.0;

/// More bodies than these join beyond [`LOSSES`]; fewer join beyond [`RATTLE`].
const MANY: f64 = 16.0;

/// Losses of relative speed a body and tick: with no restitution as many impacts, with e = 0.9 ten times as many. What loses nothing
/// is none.
const LOSSES: f64 = 1.0;

/// The same for fewer bodies: they rattle.
const RATTLE: f64 = 4.0;

/// The same for a [`HANDFUL`]: a Zeno series of impacts with one restitution ends within 30, since k of them leave `e^k` of the speed,
/// which is down to 1e-13. What goes on is no such series: without this limit bodies that fall into 200 cups take 1.19 times as many
/// instructions, and polygons that roll along a floor 1.17.
const SERIES: f64 = 32.0;

/// The same at which they join at once, not with the next sub-step; a handful always does.
const AT_ONCE: f64 = 16.0;

/// Bodies that struck each other within the present tick, as trees.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rush {
    tick: u64,
    /// By body; those of [`Self::known`] only.
    nodes: List<BodyIx, Node>,
    known: Vec<BodyIx>,
    /// Roots of trees with too many impacts.
    due: Vec<BodyIx>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    parent: BodyIx,
    /// Of a root: bodies of the tree, and what they lost.
    size: u32,
    spent: f64,
}

/// No tree.
const NONE: Node = Node {
    parent: BodyIx::NONE,
    size: 0,
    spent: 0.0,
};

impl Rush {
    /// Whether some tree has too many impacts.
    pub(crate) const fn is_due(&self) -> bool {
        !self.due.is_empty()
    }

    fn turn_to(&mut self, tick: u64) {
        if self.tick == tick {
            return;
        }
        self.tick = tick;
        for index in self.known.drain(..) {
            self.nodes[index] = NONE;
        }
        self.due.clear();
    }

    fn root(&mut self, index: BodyIx) -> BodyIx {
        let node = self.nodes.grown(index, NONE);
        if node.parent == BodyIx::NONE {
            self.known.push(index);
            *node = Node {
                parent: index,
                size: 1,
                ..NONE
            };
        }
        let mut at = index;
        while self.nodes[at].parent != at {
            let up = self.nodes[self.nodes[at].parent].parent;
            self.nodes[at].parent = up;
            at = up;
        }
        at
    }

    fn join(&mut self, a: BodyIx, b: BodyIx) -> BodyIx {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return a;
        }
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let lost = self.nodes[high];
        self.nodes[high].parent = low;
        let node = &mut self.nodes[low];
        node.size += lost.size;
        node.spent += lost.spent;
        low
    }

    /// Whether impacts of an earlier tick were counted last.
    pub(crate) const fn is_before(&self, tick: u64) -> bool {
        self.tick != tick
    }

    /// Counts an impact in a tick that changed the motions of `bodies`, at the price of `lost`: whether there are so many now among
    /// the bodies that struck each other that these are to join at once.
    pub(crate) fn count(&mut self, bodies: &[BodyIx], lost: f64, tick: u64) -> bool {
        let Some((&first, others)) = bodies.split_first() else {
            return false;
        };
        self.turn_to(tick);
        let mut root = self.root(first);
        for &other in others {
            root = self.join(root, other);
        }
        let node = &mut self.nodes[root];
        node.spent += lost;
        let (size, spent) = (f64::from(node.size), node.spent);
        let losses = if size > MANY {
            LOSSES
        } else if size > HANDFUL {
            RATTLE
        } else {
            SERIES
        };
        if spent <= losses * size {
            return false;
        }
        if !self.due.contains(&root) {
            self.due.push(root);
        }
        spent > AT_ONCE * size
    }

    /// Takes out the bodies that struck each other too often, in order.
    pub(crate) fn take_due(&mut self) -> Vec<BodyIx> {
        let due = core::mem::take(&mut self.due);
        let roots: Vec<BodyIx> = due.into_iter().map(|index| self.root(index)).collect();
        let mut members = self.known.clone();
        members.retain(|index| roots.contains(&self.root(*index)));
        members.sort_unstable();
        members
    }
}
