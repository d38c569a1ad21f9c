//! The tree against a plain list.

use super::*;
use carom_math::{Vec2, vec2};
use proptest::prelude::*;

/// Every parent knows its children, contains them and is one higher.
fn check(tree: &BoxTree) {
    let mut leaves = 0;
    let mut stack: Vec<(u32, u32)> = Vec::new();
    if tree.root != NONE {
        stack.push((tree.root, NONE));
    }
    while let Some((place, parent)) = stack.pop() {
        let node = tree.nodes[place as usize];
        assert_eq!(node.parent, parent);
        if node.is_leaf() {
            assert_eq!(node.height, 0);
            leaves += 1;
            continue;
        }
        let children = node.children.map(|c| tree.nodes[c as usize]);
        assert_eq!(node.bounds, children[0].bounds.union(children[1].bounds));
        assert_eq!(node.height, 1 + children[0].height.max(children[1].height));
        stack.extend(node.children.map(|c| (c, place)));
    }
    assert_eq!(leaves, tree.len());
    assert!(
        tree.nodes.len() <= 2 * 512.max(2 * leaves),
        "memory grew without leaves"
    );
}

#[derive(Clone, Debug)]
enum Op {
    Insert(Aabb),
    Update(usize, Aabb),
    Remove(usize),
}

fn bounds() -> impl Strategy<Value = Aabb> {
    let size = prop_oneof![4 => 0.0..1.0_f64, 1 => Just(0.0), 1 => 0.0..30.0_f64];
    (-50i32..50, -50i32..50, size.clone(), size).prop_map(|(x, y, w, h)| {
        let min = vec2(f64::from(x) * 0.7, f64::from(y) * 0.7);
        Aabb::new(min, min + vec2(w, h))
    })
}

fn ops() -> impl Strategy<Value = Vec<Op>> {
    let op = prop_oneof![
        3 => bounds().prop_map(Op::Insert),
        2 => (any::<usize>(), bounds()).prop_map(|(i, b)| Op::Update(i, b)),
        1 => any::<usize>().prop_map(Op::Remove),
    ];
    prop::collection::vec(op, 1..300)
}

/// Runs the operations; the list of what must be there.
fn run(ops: &[Op]) -> (BoxTree, Vec<(NodeId, u32)>) {
    let mut tree = BoxTree::new();
    let mut list: Vec<(NodeId, u32)> = Vec::new();
    for (data, op) in (0u32..).zip(ops) {
        match op {
            Op::Insert(b) => list.push((tree.insert(*b, data), data)),
            Op::Update(i, b) if !list.is_empty() => {
                let id = list[i % list.len()].0;
                tree.update(id, *b);
                assert!(tree.fat_box(id).contains(*b));
            }
            Op::Remove(i) if !list.is_empty() => {
                tree.remove(list.swap_remove(i % list.len()).0);
            }
            _ => {}
        }
    }
    (tree, list)
}

fn sorted(mut list: Vec<u32>) -> Vec<u32> {
    list.sort_unstable();
    list
}

proptest! {
    #[test]
    fn queries_find_what_a_plain_list_finds(ops in ops(), seek in bounds(), direction in (-1.0..1.0_f64, -1.0..1.0_f64)) {
        let (tree, list) = run(&ops);
        check(&tree);

        let mut found = Vec::new();
        tree.query(seek, |i| found.push(i));
        // The question is rounded outwards, too.
        let asked = Bounds::around(seek).widened();
        let want = list.iter().filter(|(id, _)| tree.fat_box(*id).overlaps(asked));
        prop_assert_eq!(sorted(found), sorted(want.map(|l| l.1).collect()));

        let (origin, direction) = (seek.min, vec2(direction.0, direction.1));
        let mut found = Vec::new();
        tree.ray(origin, direction, 40.0, |i| { found.push(i); f64::INFINITY });
        let met = |id: NodeId, slack: f64| {
            let b = tree.fat_box(id);
            // Clipped by hand: the ray's stretch inside each slab.
            let mut stretch = (0.0_f64, 40.0_f64);
            for (o, d, low, high) in [(origin.x, direction.x, b.min.x, b.max.x), (origin.y, direction.y, b.min.y, b.max.y)] {
                if d == 0.0 {
                    if o < low - slack || o > high + slack { return false; }
                    continue;
                }
                let (p, q) = ((low - slack - o) / d, (high + slack - o) / d);
                stretch = (stretch.0.max(p.min(q)), stretch.1.min(p.max(q)));
            }
            stretch.0 <= stretch.1
        };
        for (id, data) in &list {
            if met(*id, 0.0) { prop_assert!(found.contains(data), "missed {}", data); }
            if !met(*id, 1e-9) { prop_assert!(!found.contains(data), "invented {}", data); }
        }
    }

    #[test]
    fn same_calls_same_tree(ops in ops()) {
        let order = |tree: &BoxTree| {
            let mut seen = Vec::new();
            tree.query(Aabb::new(Vec2::splat(-1e3), Vec2::splat(1e3)), |i| seen.push(i));
            seen
        };
        prop_assert_eq!(order(&run(&ops).0), order(&run(&ops).0));
    }
}

#[test]
fn a_ray_that_is_cut_short_sees_nothing_behind_its_hit() {
    let mut tree = BoxTree::new();
    for i in 0..1000_u32 {
        let x = f64::from(i);
        tree.insert(Aabb::new(vec2(x, -1.0), vec2(x + 0.5, 1.0)), i);
    }
    let mut seen = 0;
    let mut nearest = u32::MAX;
    tree.ray(vec2(-1.0, 0.0), vec2(1.0, 0.0), f64::INFINITY, |i| {
        seen += 1;
        nearest = nearest.min(i);
        f64::from(i) + 1.0
    });
    assert_eq!(nearest, 0);
    assert_eq!(seen, 1, "the nearest comes first, the rest is behind it");
}

#[test]
fn rows_and_heaps_stay_shallow() {
    // What makes a careless tree a list: sorted insertion, and many boxes at one place.
    for (name, step) in [("a sorted row", 1.0), ("one place", 0.0)] {
        let mut tree = BoxTree::new();
        for i in 0..10_000_u32 {
            let x = step * f64::from(i);
            tree.insert(Aabb::new(vec2(x, 0.0), vec2(x + 1.5, 1.0)), i);
        }
        check(&tree);
        assert!(tree.height() <= 40, "{name}: height {}", tree.height());
    }
}

#[test]
fn a_leaf_that_stays_inside_is_not_touched_and_one_that_shrank_is() {
    let mut tree = BoxTree::new();
    let big = Aabb::new(Vec2::ZERO, Vec2::splat(4.0));
    let id = tree.insert(big, 7);
    tree.update(id, Aabb::new(Vec2::splat(1.0), Vec2::splat(3.5)));
    assert_eq!(tree.fat_box(id), big);
    let small = Aabb::new(Vec2::splat(1.0), Vec2::splat(2.0));
    tree.update(id, small);
    assert_eq!(tree.fat_box(id), small);
    assert_eq!(tree.data(id), 7);
}

#[test]
#[should_panic(expected = "was removed")]
fn a_removed_leaf_is_named() {
    let mut tree = BoxTree::new();
    let id = tree.insert(Aabb::new(Vec2::ZERO, Vec2::ONE), 1);
    tree.remove(id);
    tree.update(id, Aabb::new(Vec2::ZERO, Vec2::ONE));
}
