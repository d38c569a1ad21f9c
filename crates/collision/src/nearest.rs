//! The nearest two parts of two shapes: boxes tell which pairs need not be looked at.

use carom_geometry::Shape;
use carom_math::{Pose, Vec2};

use crate::parts::{Node, Nodes, turned};
use crate::{Distance, distance, part};

/// The shortest way between two shapes and the parts it belongs to.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    way: Distance,
    parts: (u32, u32),
}

/// The least distance of two parts; that of the first of equals, by A's part, then by B's.
pub(crate) fn nearest_parts(a: &Shape, b: &Shape, b_in_a: Pose) -> Option<Distance> {
    let (nodes_a, nodes_b) = (Nodes::of(a), Nodes::of(b));
    let mut best: Option<Nearest> = None;
    let mut waiting: Vec<Waiting> = Vec::new();
    for i in nodes_a.roots() {
        waiting.extend(nodes_b.roots().map(|j| Waiting::new(i, j, b_in_a)));
    }
    while let Some(next) = waiting.pop() {
        if best.is_some_and(|known| next.least > known.way.distance) {
            continue;
        }
        let (i, j) = (next.a, next.b);
        let mut below = match i.split_before(&j) {
            Some(true) => nodes_a.children(&i).map(|i| Waiting::new(i, j, b_in_a)),
            Some(false) => nodes_b.children(&j).map(|j| Waiting::new(i, j, b_in_a)),
            None => {
                let Some(parts) = i.part().zip(j.part()) else {
                    continue;
                };
                let beaten = |known: Nearest| known.way.distance <= 0.0 && known.parts < parts;
                if best.is_some_and(beaten) {
                    continue;
                }
                let (part_a, part_b) = (part(a, parts.0 as usize), part(b, parts.1 as usize));
                let way = distance(&part_a, &part_b, b_in_a);
                let key = |nearest: &Nearest| (nearest.way.distance.max(0.0), nearest.parts);
                let found = Nearest { way, parts };
                if best.is_none_or(|known| key(&found) < key(&known)) {
                    best = Some(found);
                }
                continue;
            }
        };
        // The nearer one is looked at first.
        if below[0].least < below[1].least {
            below.swap(0, 1);
        }
        waiting.extend(below);
    }
    best.map(|found| found.way)
}

/// Two boxes, and what the parts in them are at least apart.
struct Waiting {
    a: Node,
    b: Node,
    least: f64,
}

impl Waiting {
    fn new(a: Node, b: Node, b_in_a: Pose) -> Self {
        if !(a.bounds.is_finite() && b.bounds.is_finite()) {
            let least = f64::NEG_INFINITY;
            return Self { a, b, least };
        }
        let around = turned(b.bounds, b_in_a);
        let gap = (around.min - a.bounds.max)
            .max(a.bounds.min - around.max)
            .max(Vec2::ZERO);
        // Less what the rounding of a distance can hide, as a fraction of the lengths in play.
        let size = a.bounds.extents().max_element() + b.bounds.extents().max_element();
        let length = gap.length();
        let least = length - 1e-13 * (length + size);
        Self { a, b, least }
    }
}
