//! Laws of the wide solver, on synthetic stacks, without a world.

use carom_math::{Vec2, vec2};
use fearless_simd::Level;
use proptest::prelude::*;

use super::kernel::{Pass, sweep};
use super::rig::{Member, NOBODY, Pull};
use super::{Law, Rig, Row, plain};
use crate::Softness;

const G: f64 = 10.0;

/// A column of unit boxes, 1 kg each, on ground; rows between neighbours.
fn column(count: u32) -> (Rig, Vec<u32>, Vec<super::RowId>) {
    let mut rig = Rig::default();
    let ground = rig.admit(&Member {
        velocity: Vec2::ZERO,
        spin: 0.0,
        inverse_mass: 0.0,
        inverse_inertia: 0.0,
        pull: Pull::default(),
    });
    let mut slots = vec![ground];
    let mut rows = Vec::new();
    for _ in 0..count {
        let slot = rig.admit(&Member {
            velocity: Vec2::ZERO,
            spin: 0.0,
            inverse_mass: 1.0,
            inverse_inertia: 6.0,
            pull: Pull {
                acceleration: vec2(0.0, -G),
                angular: 0.0,
            },
        });
        let below = slots[slots.len() - 1];
        let half = if below == ground { 0.0 } else { 0.5 };
        let arms = [-0.5, 0.5].map(|x| (vec2(x, half), vec2(x, -0.5)));
        let mut row = Row::new((below, slot), vec2(0.0, 1.0), &arms, 0.6);
        row.gap = [0.0; 2];
        rows.push(rig.insert(&row));
        slots.push(slot);
    }
    (rig, slots, rows)
}

#[test]
fn a_column_comes_to_rest_and_carries_its_weight() {
    let law = Law::new(&Softness::default(), 1.0 / 360.0);
    let (mut rig, slots, rows) = column(10);
    for _ in 0..3600 {
        rig.step(&law, NOBODY);
    }
    rig.lanes.check(&rig.lines);
    for (i, (slot, id)) in slots[1..].iter().zip(&rows).enumerate() {
        let line = rig.lines[*slot as usize];
        assert!(line.v().length() < 1e-6, "box {i} moves at {}", line.v());
        let row = rig.row(*id);
        let carried = f64::from(u32::try_from(10 - i).expect("few")) * G / 360.0;
        assert!(
            (row.j[0] + row.j[1] - carried).abs() < 1e-6,
            "box {i}: {:?} of {carried}",
            row.j
        );
    }
    let top = rig.lines[slots[10] as usize].d().y;
    assert!((-5e-3..0.0).contains(&top), "the top sank by {top} m");
}

#[test]
fn free_flight_is_the_parabola() {
    let law = Law::new(&Softness::default(), 1.0 / 240.0);
    let mut rig = Rig::default();
    let slot = rig.admit(&Member {
        velocity: vec2(3.0, 4.0),
        spin: 2.0,
        inverse_mass: 1.0,
        inverse_inertia: 1.0,
        pull: Pull {
            acceleration: vec2(0.0, -G),
            angular: 0.0,
        },
    });
    for _ in 0..240 {
        rig.step(&law, NOBODY);
    }
    let line = rig.lines[slot as usize];
    assert!(
        (line.d() - vec2(3.0, -1.0)).length() < 1e-12,
        "{}",
        line.d()
    );
    assert!((line.turn() - 2.0).abs() < 1e-12);
}

/// Every width that the machine has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let levels = [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let levels = [Some(best)];
    levels.into_iter().flatten().collect()
}

/// Numbers in 0..1 from one seed.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 33).expect("31 bits")) / f64::from(1u32 << 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }

    fn pick(&mut self, count: usize) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 ≤ x < count"
        )]
        let i = (self.roll() * count as f64) as usize;
        i
    }

    fn member(&mut self) -> Member {
        let (m, i) = match self.pick(6) {
            0 => (0.0, 0.0),
            1 => (1.0, 0.0),
            _ => (self.between(0.1, 3.0), self.between(0.1, 20.0)),
        };
        let moves = if m > 0.0 { 1.0 } else { 0.0 };
        Member {
            velocity: moves * vec2(self.between(-1.0, 1.0), self.between(-1.0, 1.0)),
            spin: if i > 0.0 {
                self.between(-2.0, 2.0)
            } else {
                0.0
            },
            inverse_mass: m,
            inverse_inertia: i,
            pull: Pull {
                acceleration: moves * vec2(0.0, -G),
                angular: 0.0,
            },
        }
    }

    /// A row between two bodies of which one moves, with impulses inside the cone.
    fn row(&mut self, rig: &Rig, slots: &[u32]) -> Option<Row> {
        let (a, b) = (slots[self.pick(slots.len())], slots[self.pick(slots.len())]);
        let moves = |i: u32| rig.lines[i as usize].inverse_mass() > 0.0;
        if a == b || !(moves(a) || moves(b)) {
            return None;
        }
        Some(self.row_of(a, b))
    }

    fn row_of(&mut self, a: u32, b: u32) -> Row {
        let n = carom_math::Rot::from_angle(self.between(-3.0, 3.0)).x_axis();
        let (ra, rb) = (n * 0.5, n * -0.5);
        let t = carom_math::perp(n) * self.between(0.1, 0.5);
        let two = [(ra - t, rb - t), (ra + t, rb + t)];
        let points = 1 + self.pick(2);
        let mu = if self.pick(4) == 0 {
            0.0
        } else {
            self.between(0.0, 1.0)
        };
        let mut row = Row::new((a, b), n, &two[..points], mu);
        for i in 0..points {
            row.gap[i] = self.between(-0.01, 0.01);
            row.j[i] = self.between(0.0, 0.1);
        }
        if self.pick(4) == 0 {
            row.belt = self.between(-2.0, 2.0);
        }
        row.jt = mu * (row.j[0] + row.j[1]) * self.between(-1.0, 1.0);
        row
    }
}

/// A random heap of rows; some bodies stand still, some cannot turn.
fn heap(seed: u64, bodies: usize, rows: usize) -> (Rig, Vec<u32>, Vec<super::RowId>) {
    let mut dice = Dice(seed);
    let mut rig = Rig::default();
    let slots: Vec<u32> = (0..bodies).map(|_| rig.admit(&dice.member())).collect();
    let mut ids = Vec::new();
    for _ in 0..rows {
        if let Some(row) = dice.row(&rig, &slots) {
            ids.push(rig.insert(&row));
        }
    }
    (rig, slots, ids)
}

/// How far the warm start is from what the impulses say, in units of the velocities.
fn warmth_error(rig: &Rig, slots: &[u32]) -> f64 {
    let mut exact = rig.clone();
    exact.refresh();
    slots
        .iter()
        .map(|slot| {
            let (kept, fresh) = (rig.warm_start(*slot), exact.warm_start(*slot));
            (kept.0 - fresh.0).length() + (kept.1 - fresh.1).abs()
        })
        .fold(0.0, f64::max)
}

fn momentum(rig: &Rig, slots: &[u32]) -> Vec2 {
    let moving = slots.iter().map(|i| rig.lines[*i as usize]);
    moving
        .filter(|line| line.inverse_mass() > 0.0)
        .map(|line| line.v() / line.inverse_mass())
        .sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_width_gives_the_bits_of_the_plain_sweep(seed in any::<u64>()) {
        let law = Law::new(&Softness::default(), 1.0 / 240.0);
        let (rig, ..) = heap(seed, 12, 40);
        for pass in [Pass::Solve, Pass::Relax, Pass::RelaxBelts] {
            let mut plain = rig.clone();
            let colours = &mut plain.lanes.zones[0].colours;
            let heat = plain::sweep(pass, &law, &mut plain.lines, colours);
            for level in levels() {
                let mut wide = rig.clone();
                let same = sweep(
                    level,
                    pass,
                    &law,
                    &mut wide.lines,
                    &mut wide.lanes.zones[0].colours,
                    &mut false,
                );
                prop_assert_eq!(same.to_bits(), heat.to_bits());
                for (x, y) in wide.lines.iter().zip(&plain.lines) {
                    prop_assert_eq!(x.0.map(f64::to_bits), y.0.map(f64::to_bits));
                }
                let blocks = wide.lanes.zones[0].colours.iter().flatten();
                for (x, y) in blocks.zip(plain.lanes.zones[0].colours.iter().flatten()) {
                    for (x, y) in [(x.j1, y.j1), (x.j2, y.j2), (x.jt, y.jt)] {
                        prop_assert_eq!(x.map(f64::to_bits), y.map(f64::to_bits));
                    }
                }
            }
        }
    }

    /// Blocks in which nothing pushes, and no gap closes, may be left out.
    #[test]
    fn idle_blocks_change_nothing(seed in any::<u64>(), open in 0.0..0.05_f64) {
        let law = Law::new(&Softness::default(), 1.0 / 240.0);
        let (mut rig, ..) = heap(seed, 12, 40);
        for wide in rig.lanes.zones[0].colours.iter_mut().flatten().step_by(2) {
            (wide.j1, wide.j2, wide.jt) = Default::default();
            wide.s1.iter_mut().chain(&mut wide.s2).for_each(|gap| *gap = gap.abs() + open);
        }
        for pass in [Pass::Solve, Pass::Relax, Pass::RelaxBelts] {
            let [mut some, mut all] = [rig.clone(), rig.clone()];
            plain::sweep(pass, &law, &mut some.lines, &mut some.lanes.zones[0].colours);
            plain::sweep_all(pass, &law, &mut all.lines, &mut all.lanes.zones[0].colours);
            prop_assert_eq!(&some.lines, &all.lines);
            let blocks = some.lanes.zones[0].colours.iter().flatten();
            for (x, y) in blocks.zip(all.lanes.zones[0].colours.iter().flatten()) {
                prop_assert_eq!((x.j1, x.j2, x.jt), (y.j1, y.j2, y.jt));
            }
        }
    }

    #[test]
    fn the_warm_start_is_kept_whatever_changes(seed in any::<u64>()) {
        let mut dice = Dice(seed);
        let law = Law::new(&Softness::default(), 1.0 / 240.0);
        let (mut rig, mut slots, mut ids) = heap(seed, 10, 20);
        for _ in 0..60 {
            let op = dice.pick(9);
            match op {
                0 => {
                    if let Some(row) = dice.row(&rig, &slots) {
                        ids.push(rig.insert(&row));
                    }
                }
                1 if !ids.is_empty() => rig.remove(ids.swap_remove(dice.pick(ids.len()))),
                2 if !ids.is_empty() => {
                    let id = ids[dice.pick(ids.len())];
                    let (a, b) = rig.row(id).bodies;
                    rig.rewrite(id, &dice.row_of(a, b));
                }
                3 => {
                    let slot = slots[dice.pick(slots.len())];
                    if rig.lines[slot as usize].inverse_mass() > 0.0 {
                        rig.set_velocity(slot, vec2(dice.between(-1.0, 1.0), 0.5), 0.0);
                    }
                }
                4 => rig.rescale(dice.between(0.5, 1.5)),
                5 => {
                    // A body goes, with its rows, and the lines close up.
                    let slot = slots.swap_remove(dice.pick(slots.len()));
                    let (mine, others): (Vec<_>, Vec<_>) = ids.iter().partition(|id| {
                        let (a, b) = rig.row(**id).bodies;
                        a == slot || b == slot
                    });
                    mine.into_iter().for_each(|id| rig.remove(id));
                    ids = others;
                    rig.dismiss(slot);
                    let new = rig.compact();
                    slots.iter_mut().for_each(|slot| *slot = new[*slot as usize]);
                    slots.push(rig.admit(&dice.member()));
                }
                6 => {
                    let slot = slots[dice.pick(slots.len())];
                    let (m, i) = (dice.between(0.1, 3.0), dice.between(0.1, 3.0));
                    if rig.lines[slot as usize].inverse_inertia() > 0.0 {
                        rig.set_mass(slot, m, i);
                    }
                }
                7 => {
                    let before: Vec<[f64; 2]> = ids.iter().map(|id| rig.row(*id).j).collect();
                    rig.lanes.turned(&mut Vec::new());
                    rig.lanes.part_idle();
                    let after: Vec<[f64; 2]> = ids.iter().map(|id| rig.row(*id).j).collect();
                    prop_assert_eq!(before, after);
                }
                _ => rig.step(&law, NOBODY),
            }
            rig.lanes.check(&rig.lines);
            prop_assert!(warmth_error(&rig, &slots) < 1e-10, "after {op}: {:e}", warmth_error(&rig, &slots));
            for slot in &slots {
                if rig.lanes.degree(*slot) == 0 {
                    prop_assert_eq!(rig.warm_start(*slot), (Vec2::ZERO, 0.0));
                }
            }
        }
    }

    #[test]
    fn momentum_is_kept_and_the_cone_is_never_left(seed in any::<u64>()) {
        let law = Law::new(&Softness::default(), 1.0 / 240.0);
        let mut dice = Dice(seed);
        let mut rig = Rig::default();
        let slots: Vec<u32> = (0..10)
            .map(|_| rig.admit(&Member { inverse_mass: dice.between(0.1, 3.0), pull: Pull::default(), ..dice.member() }))
            .collect();
        let rows: Vec<_> = (0..30).filter_map(|_| dice.row(&rig, &slots)).collect();
        let ids: Vec<_> = rows.iter().map(|row| rig.insert(row)).collect();
        // The impulses that the rows came with are not part of the velocities yet.
        let before = momentum(&rig, &slots);
        for _ in 0..20 {
            rig.step(&law, NOBODY);
            for id in &ids {
                let row = rig.row(*id);
                prop_assert!(row.j[0] >= 0.0 && row.j[1] >= 0.0);
                prop_assert!(row.jt.abs() <= row.mu * (row.j[0] + row.j[1]));
            }
        }
        let drift = (momentum(&rig, &slots) - before).length();
        prop_assert!(drift < 1e-11, "{drift:e}");
    }
}

/// One corner recedes from the surface while the other closes in: it must be stopped, though both
/// alone would ask for no impulse of the first.
#[test]
fn a_rocking_face_is_stopped_at_the_corner_that_comes_down() {
    let law = Law::new(&Softness::default(), 1.0 / 360.0);
    let (mut rig, slots, rows) = column(1);
    let half = 2.0;
    let arms = [-half, half].map(|x| (vec2(x, 0.0), vec2(x, -0.5)));
    let mut row = Row::new((slots[0], slots[1]), vec2(0.0, 1.0), &arms, 0.0);
    row.gap = [0.06, 0.0];
    rig.rewrite(rows[0], &row);
    rig.set_velocity(slots[1], vec2(0.0, -0.5), -1.0);
    rig.step(&law, NOBODY);
    let [_, opening, _] = rig.seen(&rig.row(rows[0]));
    // Pushed out softly: it may open a little, by no more than the push-out of its travel. It closes by no more
    // than rounding.
    assert!(
        (-1e-15..0.01).contains(&opening),
        "the corner opens at {opening} m/s"
    );
}

#[test]
fn a_body_of_a_hundred_contacts_finds_room() {
    let law = Law::new(&Softness::default(), 1.0 / 240.0);
    let mut dice = Dice(7);
    let mut rig = Rig::default();
    let hub = Member {
        velocity: Vec2::ZERO,
        spin: 0.0,
        inverse_mass: 0.01,
        inverse_inertia: 0.01,
        pull: Pull::default(),
    };
    let centre = rig.admit(&hub);
    let ids: Vec<_> = (0..100)
        .map(|_| {
            let slot = rig.admit(&Member {
                inverse_mass: 1.0,
                inverse_inertia: 6.0,
                ..hub
            });
            rig.insert(&dice.row_of(centre, slot))
        })
        .collect();
    rig.lanes.check(&rig.lines);
    rig.step(&law, NOBODY);
    for id in ids.into_iter().step_by(3) {
        rig.remove(id);
        rig.lanes.check(&rig.lines);
    }
    assert_eq!(rig.lanes.len(), 66);
}

/// How zones lie says nothing about how many threads sweep them.
#[cfg(feature = "parallel")]
#[test]
fn the_number_of_threads_changes_no_bit() {
    let law = Law::new(&Softness::default(), 1.0 / 360.0);
    let (mut heap, ..) = heap(11, 200, 500);
    heap.compact();
    assert!(heap.lanes.zones.len() > 8, "too few zones to tell");
    let swept = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let mut rig = heap.clone();
        let mut run = || (0..50).for_each(|_| rig.step(&law, NOBODY));
        match threads {
            0 => run(),
            _ => pool.expect("threads").install(run),
        }
        let bits = rig.lines.iter().map(|line| line.0.map(f64::to_bits));
        (bits.collect::<Vec<_>>(), rig.heat.to_bits())
    };
    let alone = swept(0);
    for threads in [1, 2, 3] {
        assert!(swept(threads) == alone, "{threads} threads give other bits");
    }
}

/// A row keeps its impulses, its gaps and its bodies wherever zones put it.
#[test]
fn zones_leave_rows_as_they_are() {
    for seed in 0..40 {
        let (mut rig, slots, ids) = heap(seed, 30, 60);
        let before: Vec<Row> = ids.iter().map(|id| rig.row(*id)).collect();
        let degrees: Vec<u32> = slots.iter().map(|slot| rig.lanes.degree(*slot)).collect();
        let new = rig.compact();
        rig.lanes.check(&rig.lines);
        assert!(rig.lanes.zones.len() > 1);
        for (slot, degree) in slots.iter().zip(degrees) {
            assert_eq!(rig.lanes.degree(new[*slot as usize]), degree);
        }
        for (id, before) in ids.iter().zip(before) {
            let after = rig.row(*id);
            let (a, b) = before.bodies;
            assert_eq!(after.bodies, (new[a as usize], new[b as usize]));
            assert_eq!((after.j, after.jt), (before.j, before.jt));
            for (x, y) in after.gap.iter().zip(before.gap) {
                assert!((x - y).abs() <= 1e-12 * y.abs().max(1.0), "{x} for {y}");
            }
        }
    }
}
