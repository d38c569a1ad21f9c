//! Leaves come, go and move: where to put one, and how the boxes above follow.

use super::bounds::Bounds;
use super::{BoxTree, Child, NONE, Pair, Place, ROOT};

impl BoxTree {
    /// Puts a leaf where it costs least.
    pub(super) fn attach(&mut self, leaf: u32, bounds: Bounds, data: u32) {
        self.ordered = false;
        let new = Content {
            bounds,
            child: Child::leaf(leaf),
            data,
            height: 0,
        };
        if self.pairs.is_empty() {
            self.pairs.push(Pair::EMPTY);
        }
        let root = &self.pairs[ROOT as usize];
        if let Some(side) = root.children.iter().position(|child| child.is_none()) {
            self.put(Place::new(ROOT, side), new);
            return;
        }
        let pair = self.allocate();
        match self.best_sibling(bounds) {
            Some(place) => {
                let sibling = self.content(place);
                self.put(Place::new(pair, 0), sibling);
                self.put(Place::new(pair, 1), new);
                self.hang(place, pair);
                self.refit(place.pair());
            }
            None => {
                // The root stays where it is: what it held goes one down.
                self.take_over(ROOT, pair);
                self.hang(Place::new(ROOT, 0), pair);
                self.put(Place::new(ROOT, 1), new);
                self.refit(ROOT);
            }
        }
    }

    /// Takes a leaf out; its sibling goes one up.
    pub(super) fn detach(&mut self, place: Place) {
        self.ordered = false;
        let pair = place.pair();
        let sibling = Place::new(pair, place.other_side());
        let content = self.content(sibling);
        if pair != ROOT {
            let above = self.pairs[pair as usize].parent;
            self.put(above, content);
            self.release(pair);
            self.refit(above.pair());
        } else if content.child.is_leaf() {
            self.clear(sibling);
            self.clear(place);
            if !content.child.is_none() {
                self.put(Place::new(ROOT, 0), content);
            }
        } else {
            #[expect(clippy::cast_possible_truncation, reason = "it was a u32")]
            let below = content.child.index() as u32;
            self.take_over(below, ROOT);
            self.release(below);
        }
    }

    /// Gives a leaf a new box where it is, or elsewhere if it has gone away from its neighbours.
    pub(super) fn displace(&mut self, leaf: u32, place: Place, bounds: Bounds) {
        let pair = self.pair(place);
        let (old, sibling) = (pair.bounds(), pair.boxes[place.other_side()]);
        let stays =
            place.pair() == ROOT || bounds.union(sibling).perimeter() <= STRETCH * old.perimeter();
        if stays {
            self.pairs[place.pair() as usize].boxes[place.side()] = bounds;
            self.refit(place.pair());
        } else {
            let data = pair.data[place.side()];
            self.detach(place);
            self.attach(leaf, bounds, data);
        }
    }

    /// Gives a leaf a new box and leaves all above as they were: see [`Self::displace_all`].
    pub(super) fn exchange(&mut self, place: Place, bounds: Bounds) -> Bounds {
        let old = &mut self.pairs[place.pair() as usize].boxes[place.side()];
        core::mem::replace(old, bounds)
    }

    /// Follows leaves that were given new boxes: leaf and old box of each, in order.
    pub(super) fn displace_all(&mut self, mut moved: Vec<(u32, Bounds)>) -> usize {
        if moved.len() < self.len / 16 {
            // Few: they get their old boxes back, and the new ones one after the other.
            for (leaf, bounds) in moved.iter_mut().rev() {
                let place = self.leaves[*leaf as usize].place;
                *bounds = self.exchange(place, *bounds);
            }
            for (leaf, bounds) in &moved {
                self.displace(*leaf, self.leaves[*leaf as usize].place, *bounds);
            }
            return moved.len();
        }
        let around = self.refit_all();
        if self.built == 0.0 {
            self.built = around;
        } else if around > WORN * self.built {
            self.rebuild();
        }
        moved.len()
    }

    /// All boxes from the leaves up; the sum of the ways around them.
    fn refit_all(&mut self) -> f64 {
        let mut around = 0.0;
        if self.pairs.is_empty() {
            return around;
        }
        if self.ordered {
            for at in (1..self.pairs.len()).rev() {
                around += self.refit_one(at);
            }
            return around;
        }
        let mut order = Vec::with_capacity(self.pairs.len());
        order.push(ROOT);
        let mut i = 0;
        while i < order.len() {
            let pair = &self.pairs[order[i] as usize];
            order.extend(pair.children.iter().filter(|c| !c.is_leaf()).map(|c| c.0));
            i += 1;
        }
        for at in order[1..].iter().rev() {
            around += self.refit_one(*at as usize);
        }
        around
    }

    fn refit_one(&mut self, at: usize) -> f64 {
        let pair = &self.pairs[at];
        let (place, bounds) = (pair.parent, pair.bounds());
        self.pairs[place.pair() as usize].boxes[place.side()] = bounds;
        // What reaches to infinity hides nothing of the rest.
        let around = bounds.perimeter();
        if around < 1e18 {
            f64::from(around)
        } else {
            0.0
        }
    }

    /// Where a leaf costs least beside what is there; `None` if beside everything.
    ///
    /// The cost of a place is the way around the new pair and what every box above it grows. Below
    /// a node no place costs less than its growth and the leaf itself: that ends the way down.
    fn best_sibling(&self, leaf: Bounds) -> Option<Place> {
        let own = leaf.perimeter();
        let root = &self.pairs[ROOT as usize];
        let around = root.bounds();
        let joined = around.union(leaf).perimeter();
        let (mut best, mut best_height, mut found) = (joined, root.height(), None);
        let mut inherited = joined - around.perimeter();
        let mut at = ROOT;
        loop {
            let pair = &self.pairs[at as usize];
            let mut next: Option<(f32, u32, u32)> = None;
            for side in [0, 1] {
                let (bounds, height) = (pair.boxes[side], pair.heights[side]);
                let joined = bounds.union(leaf).perimeter();
                let cost = inherited + joined;
                // Boxes that cost the same go to the lower side: many at one place stay a tree.
                if cost < best || (cost <= best && height < best_height) {
                    (best, best_height, found) = (cost, height, Some(Place::new(at, side)));
                }
                if height == 0 {
                    continue;
                }
                let growth = inherited + (joined - bounds.perimeter());
                if next.is_none_or(|(least, lower, _)| {
                    growth < least || (growth <= least && height < lower)
                }) {
                    next = Some((growth, height, pair.children[side].0));
                }
            }
            match next {
                Some((growth, _, below)) if growth + own <= best => {
                    (inherited, at) = (growth, below);
                }
                _ => return found,
            }
        }
    }

    /// Boxes and heights above a pair, with a rotation at each where it helps, as far as they change.
    pub(super) fn refit(&mut self, from: u32) {
        let mut at = from;
        loop {
            self.rotate(at);
            let pair = &self.pairs[at as usize];
            let (parent, bounds, height) = (pair.parent, pair.bounds(), pair.height());
            if at == ROOT {
                return;
            }
            let above = &mut self.pairs[parent.pair() as usize];
            let side = parent.side();
            if above.boxes[side] == bounds && above.heights[side] == height {
                return;
            }
            above.boxes[side] = bounds;
            above.heights[side] = height;
            at = parent.pair();
        }
    }

    /// Swaps a child with a grandchild on the other side, where that makes the inner box smaller.
    fn rotate(&mut self, at: u32) {
        let pair = &self.pairs[at as usize];
        let mut best: (f32, u32, Option<(usize, usize)>) = (0.0, 0, None);
        for side in [0, 1] {
            let (own, other) = (side, 1 - side);
            // A box that takes in a larger one does not become smaller.
            let now = pair.boxes[other].perimeter();
            if pair.heights[other] == 0 || now < pair.boxes[own].perimeter() {
                continue;
            }
            let inner = &self.pairs[pair.children[other].index()];
            for grandchild in [0, 1] {
                let stays = 1 - grandchild;
                let gain = now - pair.boxes[own].union(inner.boxes[stays]).perimeter();
                // Equal boxes rotate for the sake of height.
                let lower = inner.heights[grandchild]
                    .saturating_sub(pair.heights[own].max(inner.heights[stays]));
                if gain > best.0 || (gain >= best.0 && lower > best.1) {
                    best = (gain, lower, Some((side, grandchild)));
                }
            }
        }
        if let (_, _, Some((side, grandchild))) = best {
            self.ordered = false;
            let pair = &self.pairs[at as usize];
            let inner = pair.children[1 - side].0;
            let (up, down) = (Place::new(inner, grandchild), Place::new(at, side));
            let (rises, sinks) = (self.content(up), self.content(down));
            self.put(down, rises);
            self.put(up, sinks);
            self.hang(Place::new(at, 1 - side), inner);
        }
    }

    fn content(&self, place: Place) -> Content {
        let (pair, side) = (self.pair(place), place.side());
        Content {
            bounds: pair.boxes[side],
            child: pair.children[side],
            data: pair.data[side],
            height: pair.heights[side],
        }
    }

    /// Puts a leaf or a pair into a place and notes there where it is.
    pub(super) fn put(&mut self, place: Place, content: Content) {
        let (pair, side) = (&mut self.pairs[place.pair() as usize], place.side());
        pair.boxes[side] = content.bounds;
        pair.children[side] = content.child;
        pair.data[side] = content.data;
        pair.heights[side] = content.height;
        let index = content.child.index();
        if content.child.is_leaf() {
            self.leaves[index].place = place;
        } else {
            self.pairs[index].parent = place;
        }
    }

    fn clear(&mut self, place: Place) {
        let (pair, side) = (&mut self.pairs[place.pair() as usize], place.side());
        pair.boxes[side] = Bounds::EMPTY;
        pair.children[side] = Child(NONE);
        pair.heights[side] = 0;
    }

    /// Puts a pair that is complete into a place.
    fn hang(&mut self, place: Place, pair: u32) {
        let content = &self.pairs[pair as usize];
        let content = Content {
            bounds: content.bounds(),
            child: Child(pair),
            data: 0,
            height: content.height(),
        };
        self.put(place, content);
    }

    /// Moves both children of a pair to another one.
    fn take_over(&mut self, from: u32, to: u32) {
        for side in [0, 1] {
            let content = self.content(Place::new(from, side));
            self.put(Place::new(to, side), content);
        }
    }

    fn allocate(&mut self) -> u32 {
        if self.free_pair == NONE {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "there are fewer pairs than leaves"
            )]
            let place = self.pairs.len() as u32;
            self.pairs.push(Pair::EMPTY);
            return place;
        }
        let place = self.free_pair;
        self.free_pair = self.pairs[place as usize].parent.0;
        place
    }

    fn release(&mut self, pair: u32) {
        self.pairs[pair as usize] = Pair {
            parent: Place(self.free_pair),
            ..Pair::EMPTY
        };
        self.free_pair = pair;
    }
}

/// A leaf that moves stays beside its neighbour as long as that does not make the box around both
/// longer by more than this.
const STRETCH: f32 = 1.25;

/// A tree is built anew when all ways around its boxes together are this much longer than they were.
const WORN: f64 = 1.5;

/// What is in a place.
#[derive(Clone, Copy)]
pub(super) struct Content {
    pub(super) bounds: Bounds,
    pub(super) child: Child,
    pub(super) data: u32,
    pub(super) height: u32,
}
