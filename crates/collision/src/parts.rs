//! Which convex parts of two shapes are near each other: boxes, and trees of boxes where there are
//! many.
//!
//! The answer is the same with and without a tree, and so is its order: trees only leave out pairs
//! with separate boxes.

use arrayvec::ArrayVec;
use carom_geometry::{Aabb, PartBranch, PartTree, Shape};
use carom_math::{Pose, Vec2, vec2};

use crate::{Hull, hulls, part, part_count};

/// Visits the pairs of parts (of A, of B) with boxes that come within `margin` while A moves by `sweep`,
/// all in A's frame; in order of A's parts, then of B's.
pub(crate) fn near_parts(
    a: &Shape,
    b: &Shape,
    b_in_a: Pose,
    sweep: Vec2,
    margin: f64,
    mut visit: impl FnMut(usize, usize),
) {
    /// Boxes of B that fit on the stack: polygons with more pieces have a tree.
    const FEW: usize = 32;
    let reach = Reach {
        sweep,
        margin,
        b_in_a,
    };
    let mut pairs = Vec::new();
    match (tree(a), tree(b)) {
        (None, None) => {
            let of_b: ArrayVec<Aabb, FEW> =
                hulls(b).take(FEW).map(|hull| reach.box_b(&hull)).collect();
            for (i, hull_a) in hulls(a).enumerate() {
                let box_a = reach.box_a(&hull_a);
                for (j, box_b) in of_b.iter().enumerate() {
                    if box_a.overlaps(*box_b) {
                        visit(i, j);
                    }
                }
                for (j, hull_b) in hulls(b).enumerate().skip(FEW) {
                    if box_a.overlaps(reach.box_b(&hull_b)) {
                        visit(i, j);
                    }
                }
            }
            return;
        }
        _ => reach.both(&Nodes::of(a), &Nodes::of(b), |i, j| {
            pairs.push((i as usize, j as usize));
        }),
    }
    pairs.retain(|(i, j)| {
        reach
            .box_a(&part(a, *i))
            .overlaps(reach.box_b(&part(b, *j)))
    });
    pairs.sort_unstable();
    for (i, j) in pairs {
        visit(i, j);
    }
}

/// The box tree over the parts of a shape, if it has so many.
pub(crate) fn tree(shape: &Shape) -> Option<&PartTree> {
    match shape {
        Shape::Polygon(polygon) => polygon.part_tree(),
        Shape::Compound(compound) => compound.part_tree(),
        _ => None,
    }
}

/// Whether a shape is a single convex part.
pub(crate) fn is_single(shape: &Shape) -> bool {
    part_count(shape) == 1
}

/// The parts of a shape as a tree, or one by one.
pub(crate) enum Nodes<'a> {
    Tree(&'a PartTree),
    List(&'a Shape),
}

/// A box in the frame of its shape, and what is in it.
#[derive(Clone, Copy)]
pub(crate) struct Node {
    pub(crate) bounds: Aabb,
    below: PartBranch,
}

impl Node {
    /// The part, if it is one.
    pub(crate) const fn part(&self) -> Option<u32> {
        match self.below {
            PartBranch::Part(part) => Some(part),
            PartBranch::Boxes(..) => None,
        }
    }

    /// Whether this one is taken apart next, or the other one: the larger that can be.
    pub(crate) fn split_before(&self, other: &Self) -> Option<bool> {
        let size = |node: &Self| node.bounds.extents().element_sum();
        match (self.part(), other.part()) {
            (None, None) => Some(size(self) >= size(other)),
            (None, Some(_)) => Some(true),
            (Some(_), None) => Some(false),
            (Some(_), Some(_)) => None,
        }
    }
}

impl<'a> Nodes<'a> {
    pub(crate) fn of(shape: &'a Shape) -> Self {
        tree(shape).map_or(Self::List(shape), Self::Tree)
    }

    fn node(&self, index: u32) -> Node {
        match self {
            Self::Tree(tree) => {
                let (bounds, below) = tree.node(index);
                Node { bounds, below }
            }
            Self::List(shape) => Node {
                bounds: part(shape, index as usize).aabb(Pose::IDENTITY),
                below: PartBranch::Part(index),
            },
        }
    }

    /// What there is to start with.
    pub(crate) fn roots(&self) -> impl Iterator<Item = Node> {
        let count = match self {
            Self::Tree(tree) => usize::from(!tree.is_empty()),
            Self::List(shape) => part_count(shape),
        };
        (0..).take(count).map(|i| self.node(i))
    }

    /// Both halves of a box; a part is its own two halves.
    pub(crate) fn children(&self, node: &Node) -> [Node; 2] {
        match node.below {
            PartBranch::Boxes(low, high) => [low, high].map(|child| self.node(child)),
            PartBranch::Part(_) => [*node; 2],
        }
    }
}

/// What counts as near.
struct Reach {
    sweep: Vec2,
    margin: f64,
    b_in_a: Pose,
}

impl Reach {
    fn box_a(&self, hull: &Hull<'_>) -> Aabb {
        self.swept(hull.aabb(Pose::IDENTITY))
    }

    fn box_b(&self, hull: &Hull<'_>) -> Aabb {
        hull.aabb(self.b_in_a).grown(self.margin)
    }

    fn swept(&self, bounds: Aabb) -> Aabb {
        bounds.union(Aabb::new(bounds.min + self.sweep, bounds.max + self.sweep))
    }

    /// A box of B's tree in A's frame: it holds every [`Reach::box_b`] of the parts below it.
    fn around(&self, bounds: Aabb) -> Aabb {
        turned(bounds, self.b_in_a).grown(self.margin)
    }

    /// Every pair of parts in two trees with near boxes.
    fn both(&self, a: &Nodes<'_>, b: &Nodes<'_>, mut visit: impl FnMut(u32, u32)) {
        let mut waiting = vec![];
        for i in a.roots() {
            waiting.extend(b.roots().map(|j| (i, j)));
        }
        while let Some((i, j)) = waiting.pop() {
            if !self.swept(i.bounds).overlaps(self.around(j.bounds)) {
                continue;
            }
            match i.split_before(&j) {
                Some(true) => waiting.extend(a.children(&i).map(|i| (i, j))),
                Some(false) => waiting.extend(b.children(&j).map(|j| (i, j))),
                None => {
                    if let Some((i, j)) = i.part().zip(j.part()) {
                        visit(i, j);
                    }
                }
            }
        }
    }
}

/// A box around `bounds` at `pose`, with room for the rounding of points that are moved one by one.
///
/// One without end stays without end, on all sides.
pub(crate) fn turned(bounds: Aabb, pose: Pose) -> Aabb {
    if !bounds.is_finite() {
        return Aabb::new(Vec2::NEG_INFINITY, Vec2::INFINITY);
    }
    let (centre, half) = (bounds.centre(), bounds.extents() * 0.5);
    let (cos, sin) = (pose.rotation.cos().abs(), pose.rotation.sin().abs());
    let half = vec2(cos * half.x + sin * half.y, sin * half.x + cos * half.y);
    let centre = pose.point(centre);
    let size = bounds.min.abs().max(bounds.max.abs()).element_sum();
    let rounding = 8.0 * f64::EPSILON * (size + pose.position.abs().element_sum());
    Aabb::new(centre - half, centre + half).grown(rounding)
}
