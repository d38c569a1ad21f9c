//! Box trees side by side: carom's `BoxTree` against the `Bvh` of parry2d in `f64`.
//!
//! Both get the same boxes, the same motion and the same questions in turn, and take turns in going
//! first. Every answer is compared, pairs with brute force as well; a row is the median CPU time of
//! its repetitions.

use carom_bench::CpuClock;
use carom_collision::{BoxTree, NodeId};
use carom_geometry::Aabb;
use carom_math::{Rot, Vec2, vec2};
use parry2d_f64::bounding_volume::{Aabb as Theirs, BoundingVolume};
use parry2d_f64::math::Vector;
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use parry2d_f64::query::Ray;

/// Questions a repetition.
const QUESTIONS: usize = 2000;

/// Room around a box that moves, in m.
const MARGIN: f64 = 0.125;

fn main() {
    println!("| boxes | what | carom µs | parry µs | ratio |");
    println!("|---:|---|---:|---:|---:|");
    for (count, repetitions) in [(1000, 41), (10_000, 21), (100_000, 9)] {
        let mut rows = Rows::default();
        for repetition in 0..repetitions {
            run(&mut rows, count, repetition);
        }
        rows.print(count);
    }
}

/// One repetition of every row.
fn run(rows: &mut Rows, count: usize, repetition: u64) {
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ (repetition << 32) ^ count as u64);
    let side = (count as f64).sqrt();
    let mut scene = Scene::new(&mut random, count, side);
    rows.ours_first = repetition.is_multiple_of(2);

    let boxes: Vec<Aabb> = scene.boxes.clone();
    let their_boxes: Vec<Theirs> = boxes.iter().copied().map(theirs).collect();
    let (mut tree, mut bvh) = rows.both(
        "build",
        || boxes.iter().copied().zip(0..).collect::<BoxTree>(),
        || Bvh::from_leaves(BvhBuildStrategy::Binned, &their_boxes),
    );
    rows.both(
        "insert one by one",
        || {
            let mut tree = BoxTree::new();
            for (data, bounds) in (0..).zip(&boxes) {
                tree.insert(*bounds, data);
            }
        },
        || {
            let mut bvh = Bvh::new();
            for (data, bounds) in (0..).zip(&their_boxes) {
                bvh.insert(*bounds, data);
            }
        },
    );
    let found = pairs(rows, "pairs, in order", &tree, &mut bvh);
    if repetition == 0 && count <= 10_000 {
        let after = |i: usize| boxes[i + 1..].iter();
        let brute = (0..count).map(|i| after(i).filter(|b| b.overlaps(boxes[i])).count());
        assert_eq!(found, brute.sum::<usize>(), "pairs by brute force");
    }
    ask(rows, &mut random, &boxes, side, &tree, &bvh);

    let ids: Vec<NodeId> = tree.ids().collect();
    let mut workspace = BvhWorkspace::default();
    for _ in 0..10 {
        scene.step(side);
        rows.both(
            "update, exact boxes, all move",
            || tree.update_all(ids.iter().copied().zip(scene.boxes.iter().copied())),
            || refit(&mut bvh, &mut workspace, &scene.boxes, 0.0),
        );
    }
    pairs(rows, "pairs after motion", &tree, &mut bvh);

    let wide = |b: &Aabb| b.grown(MARGIN);
    let mut tree: BoxTree = scene.boxes.iter().map(wide).zip(0..).collect();
    let ids: Vec<NodeId> = tree.ids().collect();
    let loose: Vec<Theirs> = scene
        .boxes
        .iter()
        .map(|b| theirs(*b).loosened(MARGIN))
        .collect();
    let mut bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &loose);
    for _ in 0..10 {
        scene.step(side);
        rows.both(
            "update, boxes with a margin, all move",
            || {
                let moves = ids.iter().zip(&scene.boxes);
                tree.follow_all(moves.map(|(id, b)| (*id, *b, Vec2::ZERO)), MARGIN)
            },
            || refit(&mut bvh, &mut workspace, &scene.boxes, MARGIN),
        );
    }
}

/// What their pipeline does with bodies that moved.
fn refit(bvh: &mut Bvh, workspace: &mut BvhWorkspace, boxes: &[Aabb], margin: f64) {
    for (data, bounds) in (0..).zip(boxes) {
        bvh.insert_or_update_partially(theirs(*bounds), data, margin);
    }
    bvh.refit(workspace);
    bvh.optimize_incremental(workspace);
}

/// All pairs, every pair once and in order: theirs are sorted as ours are.
fn pairs(rows: &mut Rows, row: &'static str, tree: &BoxTree, bvh: &mut Bvh) -> usize {
    let mut workspace = BvhWorkspace::default();
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    rows.both(
        row,
        || tree.pairs(&mut ours),
        || {
            bvh.traverse_bvtt_single_tree::<false>(&mut workspace, &mut |a, b| {
                theirs.push((a.min(b), a.max(b)));
            });
            theirs.sort_unstable_by_key(|(a, b)| u64::from(*a) << 32 | u64::from(*b));
        },
    );
    assert!(ours == theirs, "{row}: {} and {}", ours.len(), theirs.len());
    ours.len()
}

/// Boxes, rays that stop at their first hit, and nearest boxes.
fn ask(rows: &mut Rows, random: &mut Random, boxes: &[Aabb], side: f64, tree: &BoxTree, bvh: &Bvh) {
    let points: Vec<Vec2> = (0..QUESTIONS).map(|_| random.point(side)).collect();
    let seek = |p: &Vec2| Aabb::new(p.round(), p.round() + Vec2::splat(2.0));
    let (ours, their_sum) = rows.both(
        "2000 box queries",
        || {
            let mut sum = 0;
            for p in &points {
                tree.query(seek(p), |i| sum += 1 + u64::from(i));
            }
            sum
        },
        || {
            let all = points.iter().map(|p| {
                let found = theirs(seek(p));
                bvh.intersect_aabb(&found)
                    .map(|i| 1 + u64::from(i))
                    .sum::<u64>()
            });
            all.sum::<u64>()
        },
    );
    assert_eq!(ours, their_sum, "box queries");

    let rays: Vec<(Vec2, Vec2)> = points
        .iter()
        .map(|p| (*p, Rot::from_angle(6.3 * random.next()).x_axis()))
        .collect();
    // Every box stops a ray, or one in fifty.
    for (row, one_in) in [
        ("2000 rays, first hit", 1),
        ("2000 rays, one box in 50 hit", 50),
    ] {
        let entry = |i: u32, (origin, way): &(Vec2, Vec2), max: f64| {
            let stretch = if i.is_multiple_of(one_in) {
                clip(boxes[i as usize], *origin, *way)
            } else {
                None
            };
            stretch.filter(|t| *t <= max)
        };
        let answers = rows.both(
            row,
            || {
                let first = rays.iter().map(|ray| {
                    let mut best = f64::INFINITY;
                    tree.ray(ray.0, ray.1, side, |i| {
                        best = entry(i, ray, side).unwrap_or(f64::INFINITY).min(best);
                        best
                    });
                    best
                });
                first.collect::<Vec<f64>>()
            },
            || {
                let first = rays.iter().map(|ray| {
                    let line = Ray::new(vector(ray.0), vector(ray.1));
                    let hit = bvh.cast_ray(&line, side, |i, max| entry(i, ray, max));
                    hit.map_or(f64::INFINITY, |(_, t)| t)
                });
                first.collect::<Vec<f64>>()
            },
        );
        assert!(answers.0 == answers.1, "{row}");
    }

    let gap = |b: &Aabb, p: Vec2| (b.min - p).max(p - b.max).max(Vec2::ZERO).length();
    let around: Vec<Vec2> = points
        .iter()
        .map(|p| *p * 2.0 - Vec2::splat(0.5 * side))
        .collect();
    let answers = rows.both(
        "2000 nearest boxes",
        || {
            let nearest = around.iter().map(|p| {
                let mut best = f64::INFINITY;
                tree.nearest(Aabb::new(*p, *p), best, |i| {
                    best = best.min(gap(&boxes[i as usize], *p));
                    best
                });
                best
            });
            nearest.collect::<Vec<f64>>()
        },
        || {
            let nearest = around.iter().map(|p| {
                let hit = bvh.find_best(
                    f64::INFINITY,
                    |node, _| gap(&ours_of(node.aabb()), *p),
                    |i, _| Some(gap(&boxes[i as usize], *p)),
                );
                hit.map_or(f64::INFINITY, |(_, distance)| distance)
            });
            nearest.collect::<Vec<f64>>()
        },
    );
    assert!(answers.0 == answers.1, "nearest boxes");
}

/// Where a ray enters a box.
fn clip(b: Aabb, origin: Vec2, way: Vec2) -> Option<f64> {
    let (one, two) = ((b.min - origin) / way, (b.max - origin) / way);
    let (enter, leave) = (
        one.min(two).max_element().max(0.0),
        one.max(two).min_element(),
    );
    (enter <= leave).then_some(enter)
}

/// Boxes of 0.2 to 1 m, one to a square metre, that drift by up to 5 cm a step.
struct Scene {
    boxes: Vec<Aabb>,
    drift: Vec<Vec2>,
}

impl Scene {
    /// Corners are multiples of 2^-10 m, so that `f32` and `f64` keep the same boxes.
    fn new(random: &mut Random, count: usize, side: f64) -> Self {
        let grid = |v: Vec2| (v * 1024.0).round() / 1024.0;
        let mut boxes = Vec::with_capacity(count);
        let mut drift = Vec::with_capacity(count);
        for _ in 0..count {
            let min = grid(random.point(side));
            let size = grid(Vec2::splat(0.2) + random.point(0.8));
            boxes.push(Aabb::new(min, min + size));
            drift.push(grid(random.point(0.1) - Vec2::splat(0.05)));
        }
        Self { boxes, drift }
    }

    fn step(&mut self, side: f64) {
        for (bounds, drift) in self.boxes.iter_mut().zip(&mut self.drift) {
            bounds.min += *drift;
            bounds.max += *drift;
            for axis in [0, 1] {
                if bounds.min[axis] < 0.0 || bounds.min[axis] > side {
                    drift[axis] = -drift[axis];
                }
            }
        }
    }
}

/// Times of both, row by row.
#[derive(Default)]
struct Rows {
    rows: Vec<(&'static str, [Vec<f64>; 2])>,
    ours_first: bool,
}

impl Rows {
    fn both<A, B>(
        &mut self,
        row: &'static str,
        ours: impl FnOnce() -> A,
        theirs: impl FnOnce() -> B,
    ) -> (A, B) {
        let (a, b, times) = if self.ours_first {
            let (a, first) = timed(ours);
            let (b, second) = timed(theirs);
            (a, b, [first, second])
        } else {
            let (b, first) = timed(theirs);
            let (a, second) = timed(ours);
            (a, b, [second, first])
        };
        let place = self.rows.iter().position(|(name, _)| *name == row);
        let place = place.unwrap_or_else(|| {
            self.rows.push((row, Default::default()));
            self.rows.len() - 1
        });
        for (list, time) in self.rows[place].1.iter_mut().zip(times) {
            list.push(time);
        }
        (a, b)
    }

    fn print(&mut self, count: usize) {
        for (row, times) in &mut self.rows {
            let [ours, theirs] = times.each_mut().map(|list| {
                list.sort_unstable_by(f64::total_cmp);
                list[list.len() / 2] * 1e6
            });
            println!(
                "| {count} | {row} | {ours:.0} | {theirs:.0} | {:.2} |",
                ours / theirs
            );
        }
    }
}

fn timed<T>(run: impl FnOnce() -> T) -> (T, f64) {
    let clock = CpuClock::thread();
    let start = clock.seconds();
    let answer = core::hint::black_box(run());
    (answer, clock.seconds() - start)
}

/// Marsaglia's xorshift: the same boxes everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self, side: f64) -> Vec2 {
        vec2(side * self.next(), side * self.next())
    }
}

fn vector(v: Vec2) -> Vector {
    Vector::new(v.x, v.y)
}

fn theirs(b: Aabb) -> Theirs {
    Theirs::new(vector(b.min), vector(b.max))
}

fn ours_of(b: Theirs) -> Aabb {
    Aabb::new(vec2(b.mins.x, b.mins.y), vec2(b.maxs.x, b.maxs.y))
}
