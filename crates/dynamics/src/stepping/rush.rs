//! Impacts within a tick: bodies that strike each other too often join the engine.

use carom_math::SimTime;

use crate::{Mode, World};

/// So many bodies that strike each other stay with their exact impacts, however many these are.
const HANDFUL: f64 = 6.0;

/// More bodies than these join beyond [`LOSSES`]; fewer join beyond [`RATTLE`].
const MANY: f64 = 16.0;

/// Losses of relative speed a body and tick: with no restitution as many impacts, with e = 0.9 ten times as many.
const LOSSES: f64 = 1.0;

/// The same for fewer bodies: they rattle.
const RATTLE: f64 = 4.0;

/// The same at which they are so at once, not with the next sub-step.
const AT_ONCE: f64 = 16.0;

/// Bodies that struck each other within the present tick, as trees.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rush {
    tick: i64,
    /// By body; those of [`Self::known`] only.
    nodes: Vec<Node>,
    known: Vec<u32>,
    /// Roots of trees with too many impacts.
    due: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    parent: u32,
    /// Of a root: bodies of the tree, and what they lost.
    size: u32,
    spent: f64,
}

/// No tree.
const NONE: Node = Node {
    parent: u32::MAX,
    size: 0,
    spent: 0.0,
};

impl Rush {
    /// Whether some tree has too many impacts.
    pub(crate) const fn is_due(&self) -> bool {
        !self.due.is_empty()
    }

    fn turn_to(&mut self, tick: i64) {
        if self.tick == tick {
            return;
        }
        self.tick = tick;
        for index in self.known.drain(..) {
            self.nodes[index as usize] = NONE;
        }
        self.due.clear();
    }

    fn root(&mut self, index: u32) -> u32 {
        if self.nodes.len() <= index as usize {
            self.nodes.resize(index as usize + 1, NONE);
        }
        if self.nodes[index as usize].parent == u32::MAX {
            self.known.push(index);
            self.nodes[index as usize] = Node {
                parent: index,
                size: 1,
                ..NONE
            };
        }
        let mut at = index;
        while self.nodes[at as usize].parent != at {
            let up = self.nodes[self.nodes[at as usize].parent as usize].parent;
            self.nodes[at as usize].parent = up;
            at = up;
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return a;
        }
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let lost = self.nodes[high as usize];
        self.nodes[high as usize].parent = low;
        let node = &mut self.nodes[low as usize];
        node.size += lost.size;
        node.spent += lost.spent;
        low
    }
}

impl World {
    /// Counts an impact that changed the motions of `bodies`, at the price of `lost`.
    pub(crate) fn rush(&mut self, bodies: &[u32], lost: f64, time: SimTime) {
        let Some(&first) = bodies.first() else {
            return;
        };
        if self.settings.mode != Mode::Hybrid {
            return;
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the cast saturates; a tick more or less in a budget is no matter"
        )]
        let tick = (time.as_secs() / self.settings.tick) as i64;
        if self.joins.rush.tick != tick {
            self.end_rush(time);
        }
        let rush = &mut self.joins.rush;
        rush.turn_to(tick);
        let mut root = rush.root(first);
        for &other in &bodies[1..] {
            root = rush.join(root, other);
        }
        let node = &mut rush.nodes[root as usize];
        node.spent += lost;
        let (size, spent) = (f64::from(node.size), node.spent);
        let losses = if size > MANY { LOSSES } else { RATTLE };
        if size <= HANDFUL || spent <= losses * size {
            return;
        }
        let was = self.is_substepping();
        if !self.joins.rush.due.contains(&root) {
            self.joins.rush.due.push(root);
        }
        if !was {
            self.clock.catch_up(time);
        }
        if spent > AT_ONCE * size {
            self.end_rush(time);
        }
    }

    /// Bodies that struck each other too often join the engine.
    pub(crate) fn end_rush(&mut self, time: SimTime) {
        let rush = &mut self.joins.rush;
        if rush.due.is_empty() {
            return;
        }
        let due = core::mem::take(&mut rush.due);
        let roots: Vec<u32> = due.into_iter().map(|index| rush.root(index)).collect();
        let known = rush.known.clone();
        let mut members: Vec<u32> = Vec::new();
        for index in known {
            if roots.contains(&rush.root(index)) {
                members.push(index);
            }
        }
        members.sort_unstable();
        for index in members {
            if self.bodies.is_alive(index) {
                self.join(index, time);
            }
        }
        self.lower_free_boxes_later();
    }
}
