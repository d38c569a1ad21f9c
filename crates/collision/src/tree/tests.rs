//! The tree against a plain list.

use super::bounds::Bounds;
use super::*;
use carom_math::{Vec2, vec2};
use proptest::prelude::*;

/// Every pair records its place, its box there is that of its children, and every leaf and every
/// pair is either in the tree once or free.
fn check(tree: &BoxTree) {
    let mut leaves = 0;
    let mut pairs = 0;
    let mut stack: Vec<u32> = (!tree.is_empty()).then_some(ROOT).into_iter().collect();
    while let Some(at) = stack.pop() {
        let pair = &tree.pairs[at as usize];
        pairs += 1;
        for side in [0, 1] {
            let (place, child) = (Place::new(at, side), pair.children[side]);
            if child.is_none() {
                assert!(at == ROOT && tree.len() < 2, "only the root has room");
                assert_eq!(pair.boxes[side], Bounds::EMPTY);
            } else if child.is_leaf() {
                let leaf = tree.leaves[child.index()];
                assert!(leaf.is_there() && leaf.place == place);
                assert_eq!(pair.heights[side], 0);
                leaves += 1;
            } else {
                let below = &tree.pairs[child.index()];
                assert_eq!(below.parent, place);
                assert_eq!(pair.boxes[side], below.bounds());
                assert_eq!(pair.heights[side], below.height());
                stack.push(child.0);
            }
        }
    }
    assert_eq!(leaves, tree.len());
    assert_eq!(tree.ids().count(), leaves);
    let mut free = 0;
    let mut next = tree.free_pair;
    while next != NONE {
        free += 1;
        let pair = &tree.pairs[next as usize];
        assert!(
            pair.boxes == [Bounds::EMPTY; 2],
            "a free pair is met by nothing"
        );
        next = pair.parent.0;
    }
    assert_eq!(pairs + free, tree.pairs.len());
    if tree.is_empty() {
        assert_eq!(tree.pairs.capacity(), 0, "an empty tree keeps no memory");
    }
}

#[derive(Clone, Debug)]
enum Op {
    Insert(Aabb),
    Extend(Vec<Aabb>),
    Update(usize, Aabb),
    Follow(usize, Vec2),
    UpdateAll(Vec<(usize, Aabb)>),
    FollowAll(Vec2),
    Remove(usize),
    Rebuild,
}

/// Boxes on a coarse grid, so that many touch: points and lines among them, large ones, tiny ones,
/// far ones, half-planes, everything and nothing.
fn bounds() -> impl Strategy<Value = Aabb> {
    let size = prop_oneof![
        4 => 0.0..1.0_f64,
        1 => Just(0.0),
        1 => 0.0..30.0_f64,
        1 => 0.0..1e-6_f64,
    ];
    let near = (-50i32..50, -50i32..50, size.clone(), size).prop_map(|(x, y, w, h)| {
        let min = vec2(f64::from(x) * 0.7, f64::from(y) * 0.7);
        Aabb::new(min, min + vec2(w, h))
    });
    let infinite = |b: Aabb| Aabb::new(b.min, vec2(f64::INFINITY, f64::INFINITY));
    let plane = |b: Aabb| {
        Aabb::new(
            vec2(f64::NEG_INFINITY, f64::NEG_INFINITY),
            vec2(f64::INFINITY, b.max.y),
        )
    };
    prop_oneof![
        20 => near.clone(),
        2 => near.clone().prop_map(|b| b.grown(1e6)),
        2 => near.clone().prop_map(|b| Aabb::new(b.min * 1e-6, b.max * 1e-6)),
        2 => near.clone().prop_map(|b| Aabb::new(b.min + Vec2::splat(FAR_OUT), b.max + Vec2::splat(FAR_OUT))),
        1 => near.clone().prop_map(infinite),
        1 => near.clone().prop_map(plane),
        1 => near.prop_map(|b| Aabb::new(b.min, vec2(f64::NAN, b.max.y))),
        1 => Just(Aabb::EMPTY),
    ]
}

const FAR_OUT: f64 = (1u64 << 30) as f64;

fn ops() -> impl Strategy<Value = Vec<Op>> {
    let op = prop_oneof![
        12 => bounds().prop_map(Op::Insert),
        1 => prop::collection::vec(bounds(), 0..100).prop_map(Op::Extend),
        8 => (any::<usize>(), bounds()).prop_map(|(i, b)| Op::Update(i, b)),
        8 => (any::<usize>(), (-2.0..2.0_f64, -2.0..2.0_f64)).prop_map(|(i, d)| Op::Follow(i, vec2(d.0, d.1))),
        1 => prop::collection::vec((any::<usize>(), bounds()), 0..60).prop_map(Op::UpdateAll),
        1 => (-2.0..2.0_f64, -2.0..2.0_f64).prop_map(|d| Op::FollowAll(d.into())),
        8 => any::<usize>().prop_map(Op::Remove),
        1 => Just(Op::Rebuild),
    ];
    prop::collection::vec(op, 1..300)
}

/// A leaf as a plain list has it.
#[derive(Clone, Copy, Debug)]
struct Entry {
    id: NodeId,
    data: u32,
    given: Aabb,
}

/// Runs the operations; the list of what must be there.
fn run(ops: &[Op]) -> (BoxTree, Vec<Entry>) {
    let mut tree = BoxTree::new();
    let mut list: Vec<Entry> = Vec::new();
    let mut data = 0..;
    for (step, op) in ops.iter().enumerate() {
        let len = list.len();
        let pick = |i: usize| i.checked_rem(len).unwrap_or(0);
        match op {
            Op::Insert(given) => {
                let data = data.next().unwrap();
                list.push(Entry {
                    id: tree.insert(*given, data),
                    data,
                    given: *given,
                });
            }
            Op::Extend(boxes) => {
                let many: Vec<(Aabb, u32)> = boxes.iter().copied().zip(&mut data).collect();
                let ids = tree.extend(many.iter().copied());
                let new = ids.into_iter().zip(many);
                list.extend(new.map(|(id, (given, data))| Entry { id, data, given }));
            }
            Op::Update(i, given) => {
                if let Some(entry) = list.get_mut(pick(*i)) {
                    tree.update(entry.id, *given);
                    entry.given = *given;
                }
            }
            Op::Follow(i, way) => {
                if let Some(entry) = list.get_mut(pick(*i)) {
                    let there = Aabb::new(entry.given.min + *way, entry.given.max + *way);
                    tree.follow(entry.id, there, *way * 4.0, 0.1);
                    entry.given = there;
                }
            }
            Op::UpdateAll(moves) => {
                if len > 0 {
                    let moves = moves.iter().map(|(i, given)| (pick(*i), *given));
                    let moves: Vec<(usize, Aabb)> = moves.collect();
                    // The last of several counts, or one with a box that has room for it.
                    tree.update_all(moves.iter().map(|(i, given)| (list[*i].id, *given)));
                    for (i, given) in moves {
                        list[i].given = given;
                    }
                }
            }
            Op::FollowAll(way) => {
                for entry in &mut list {
                    entry.given = Aabb::new(entry.given.min + *way, entry.given.max + *way);
                }
                let moves = list.iter().map(|entry| (entry.id, entry.given, *way * 4.0));
                tree.follow_all(moves, 0.1);
            }
            Op::Remove(i) => {
                if !list.is_empty() {
                    let gone = list.swap_remove(pick(*i));
                    assert_eq!(tree.remove(gone.id), Some(gone.data));
                    assert_eq!(tree.remove(gone.id), None);
                    assert_eq!((tree.data(gone.id), tree.fat_box(gone.id)), (None, None));
                }
            }
            Op::Rebuild => tree.rebuild(),
        }
        if step % 32 == 0 {
            check(&tree);
        }
    }
    check(&tree);
    for entry in &list {
        assert_eq!(tree.data(entry.id), Some(entry.data));
        let fat = tree.fat_box(entry.id).unwrap();
        assert!(contains(fat, entry.given), "{fat:?} {:?}", entry.given);
    }
    (tree, list)
}

/// A side that is no number is infinitely far out, and nothing is anywhere.
fn contains(fat: Aabb, given: Aabb) -> bool {
    let given = Bounds::around(given).widened();
    fat.contains(given) || given == Aabb::EMPTY
}

fn sorted(mut list: Vec<u32>) -> Vec<u32> {
    list.sort_unstable();
    list
}

/// Whether a ray meets a box that is larger by `slack` on every side: clipped by hand.
fn met(b: Aabb, origin: Vec2, direction: Vec2, max: f64, slack: f64) -> bool {
    if b.min.x > b.max.x {
        return false;
    }
    let mut stretch = (0.0_f64, max);
    for axis in [0, 1] {
        let (o, d) = (origin[axis], direction[axis]);
        let (low, high) = (b.min[axis] - slack, b.max[axis] + slack);
        if d == 0.0 {
            if o < low || o > high {
                return false;
            }
            continue;
        }
        let (p, q) = ((low - o) / d, (high - o) / d);
        stretch = (stretch.0.max(p.min(q)), stretch.1.min(p.max(q)));
    }
    stretch.0 <= stretch.1
}

fn direction() -> impl Strategy<Value = Vec2> {
    let part =
        prop_oneof![4 => -1.0..1.0_f64, 1 => Just(0.0), 1 => Just(1.0), 1 => -1e-9..1e-9_f64];
    (part.clone(), part, prop_oneof![Just(1.0), 1e-12..1e12_f64])
        .prop_map(|(x, y, length)| vec2(x, y) * length)
        .prop_filter("a way", |d| *d != Vec2::ZERO)
}

fn distance(a: Aabb, b: Aabb) -> f64 {
    let gap = (a.min - b.max).max(b.min - a.max).max(Vec2::ZERO);
    gap.length()
}

proptest! {
    #[test]
    fn boxes_and_points_find_what_a_plain_list_finds(ops in ops(), seek in bounds()) {
        let (tree, list) = run(&ops);
        for seek in [seek, Aabb::new(seek.min, seek.min)] {
            let mut found = Vec::new();
            tree.query(seek, |i| found.push(i));
            // The question is rounded outwards, too.
            let asked = Bounds::around(seek);
            let want = list.iter().filter(|l| Bounds::around(tree.fat_box(l.id).unwrap()).overlaps(asked));
            prop_assert_eq!(sorted(found), sorted(want.map(|l| l.data).collect()));
        }
    }

    #[test]
    fn rays_find_what_a_plain_list_finds(ops in ops(), from in bounds(), direction in direction(), max in 0.0..100.0_f64) {
        prop_assume!(from.min.is_finite());
        let (tree, list) = run(&ops);
        let origin = from.min;
        let max = max / direction.length();
        let mut found = Vec::new();
        tree.ray(origin, direction, max, |i| { found.push(i); f64::INFINITY });
        let missed = |l: &&Entry| met(l.given, origin, direction, max, 0.0) && !found.contains(&l.data);
        prop_assert!(list.iter().find(missed).is_none(), "missed {:?}", list.iter().find(missed));
        for l in list.iter().filter(|l| found.contains(&l.data)) {
            // The start is a box of `f32`, and the end of the way is rounded.
            let fat = tree.fat_box(l.id).unwrap();
            let slack = 1e-30 + 4e-7 * (origin.abs().max_element() + 100.0);
            prop_assert!(met(fat, origin, direction, max * (1.0 + 1e-5), slack), "invented {fat:?}");
        }
    }

    #[test]
    fn a_box_on_its_way_is_a_ray_among_boxes_grown_by_it(ops in ops(), moving in bounds(), direction in direction()) {
        prop_assume!(moving.is_finite());
        let (tree, list) = run(&ops);
        let max = 30.0 / direction.length();
        let mut found = Vec::new();
        tree.sweep(moving, direction, max, |i| { found.push(i); f64::INFINITY });
        let grown = |b: Aabb| Aabb::new(b.min - moving.extents(), b.max);
        let missed = |l: &&Entry| met(grown(l.given), moving.min, direction, max, -1e-7 * moving.min.length() * f64::EPSILON) && !found.contains(&l.data);
        prop_assert!(list.iter().find(missed).is_none(), "missed {:?}", list.iter().find(missed));
    }

    #[test]
    fn the_first_and_the_nearest_are_those_of_a_plain_list(ops in ops(), from in bounds(), direction in direction()) {
        prop_assume!(from.is_finite());
        let (tree, list) = run(&ops);
        let brute = |far: &dyn Fn(Aabb) -> f64| {
            let all = list.iter().map(|l| (far(tree.fat_box(l.id).unwrap()), l.data));
            all.filter(|f| f.0 < 1e20).min_by(|a, b| a.partial_cmp(b).unwrap())
        };
        let mut best: Option<(f64, u32)> = None;
        let keep = |best: &mut Option<(f64, u32)>, new: (f64, u32)| {
            if new.0 < 1e20 && best.is_none_or(|known| new < known) {
                *best = Some(new);
            }
            best.map_or(f64::INFINITY, |b| b.0)
        };
        let box_of = |data: u32| tree.fat_box(list.iter().find(|l| l.data == data).unwrap().id).unwrap();
        tree.nearest(from, f64::INFINITY, |i| keep(&mut best, (distance(box_of(i), from), i)));
        prop_assert_eq!(best, brute(&|b| distance(b, from)));

        let entry = |b: Aabb| if !met(b, from.min, direction, 1e9, 0.0) { f64::INFINITY } else {
            let along = |axis: usize| {
                let (o, d) = (from.min[axis], direction[axis]);
                if d == 0.0 { 0.0 } else { ((b.min[axis] - o) / d).min((b.max[axis] - o) / d) }
            };
            along(0).max(along(1)).max(0.0)
        };
        best = None;
        tree.ray(from.min, direction, 1e9, |i| keep(&mut best, (entry(box_of(i)), i)));
        prop_assert_eq!(best, brute(&entry));
    }

    #[test]
    fn pairs_are_those_of_a_plain_list(ops in ops(), others in ops()) {
        let (tree, list) = run(&ops);
        let fat = |tree: &BoxTree, l: &Entry| Bounds::around(tree.fat_box(l.id).unwrap());
        let mut found = Vec::new();
        tree.pairs(&mut found);
        let mut want = Vec::new();
        for a in &list {
            for b in &list {
                if a.data < b.data && fat(&tree, a).overlaps(fat(&tree, b)) {
                    want.push((a.data, b.data));
                }
            }
        }
        want.sort_unstable();
        prop_assert_eq!(&found, &want);

        let (fixed, fixed_list) = run(&others);
        found.truncate(1);
        let kept = found.len();
        tree.pairs_with(&fixed, &mut found);
        want.clear();
        for a in &list {
            for b in &fixed_list {
                if fat(&tree, a).overlaps(fat(&fixed, b)) {
                    want.push((a.data, b.data));
                }
            }
        }
        want.sort_unstable();
        prop_assert_eq!(&found[kept..], &want[..]);
    }

    #[test]
    fn the_history_of_a_tree_does_not_show(ops in ops(), seek in bounds()) {
        let (tree, list) = run(&ops);
        // The same boxes, one by one backwards, and all at once.
        let leaf = |l: &Entry| (tree.fat_box(l.id).unwrap(), l.data);
        let mut backwards = BoxTree::new();
        for (fat, data) in list.iter().rev().map(leaf) {
            backwards.insert(fat, data);
        }
        let bulk: BoxTree = list.iter().map(leaf).collect();
        check(&backwards);
        check(&bulk);
        let answers = |tree: &BoxTree| {
            let (mut pairs, mut found) = (Vec::new(), Vec::new());
            tree.pairs(&mut pairs);
            tree.query(seek, |i| found.push(i));
            (pairs, sorted(found))
        };
        prop_assert_eq!(answers(&tree), answers(&backwards));
        prop_assert_eq!(answers(&tree), answers(&bulk));
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
    assert_eq!(tree.fat_box(id), Some(big));
    let small = Aabb::new(Vec2::splat(1.0), Vec2::splat(2.0));
    tree.update(id, small);
    assert_eq!(tree.fat_box(id), Some(small));
    assert_eq!(tree.data(id), Some(7));
}

#[test]
fn a_removed_leaf_is_not_the_one_that_took_its_place() {
    let mut tree = BoxTree::new();
    let unit = Aabb::new(Vec2::ZERO, Vec2::ONE);
    let old = tree.insert(unit, 1);
    assert_eq!(tree.remove(old), Some(1));
    let new = tree.insert(unit, 2);
    assert_ne!(old, new);
    assert!(
        !tree.update(old, unit.grown(5.0)) && !tree.follow(old, unit.grown(5.0), Vec2::ONE, 1.0)
    );
    assert_eq!((tree.data(old), tree.remove(old)), (None, None));
    assert_eq!((tree.data(new), tree.fat_box(new)), (Some(2), Some(unit)));
}

#[test]
fn nan_and_infinity_are_asked_without_harm() {
    let tree: BoxTree = (0..50)
        .map(|i| {
            (
                Aabb::new(Vec2::splat(f64::from(i)), Vec2::splat(f64::from(i) + 0.5)),
                i,
            )
        })
        .collect();
    let bad = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN_POSITIVE / 8.0,
        0.0,
    ];
    for (x, y) in bad.iter().flat_map(|x| bad.map(|y| (*x, y))) {
        for max in bad {
            let mut count = 0;
            let p = vec2(x, y);
            tree.ray(p, Vec2::X, max, |_| 0.0);
            tree.ray(Vec2::ZERO, p, max, |_| {
                count += 1;
                f64::INFINITY
            });
            tree.sweep(Aabb::new(p, Vec2::ONE), p, max, |_| f64::NAN);
            tree.nearest(Aabb::new(Vec2::ZERO, p), max, |_| f64::NAN);
            tree.query(Aabb::new(p, vec2(y, x)), |_| {});
            if max.is_finite() && max > 0.0 && p == Vec2::ZERO {
                assert_eq!(count, 1, "a ray without direction stays at its start");
            }
        }
    }
}
