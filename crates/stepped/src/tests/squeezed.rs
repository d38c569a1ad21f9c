//! Hard rows of bodies that are squeezed, struck or wedged: nothing is thrown, and no energy comes.

use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Vec2, vec2};

use super::hard::{MUST_STAY, at, column, off, put};
use super::{Random, floor, unit_box, without_sleep};
use crate::narrow::collide_any;
use crate::{BodyId, BodyInput, BodyKind, Engine, Material, Mixed, PieceInput};

/// A press goes down on a heavy box on a light one: no velocities hold it. Soft rows take over, and give way.
#[test]
fn what_nothing_holds_takes_soft_rows() {
    let (mut engine, ids) = column(without_sleep(), 1, 1e3);
    let plate = PieceInput::new(ConvexPolygon::rectangle(3.0, 1.0).unwrap());
    let mut press = BodyInput::new(BodyKind::Kinematic).at(vec2(0.0, 2.5));
    press.velocity = vec2(0.0, -0.1);
    engine.insert(press, &[plate]).unwrap();
    for _ in 0..30 {
        engine.tick();
        engine.graph.check(&engine.bodies);
    }
    assert!(engine.failed_hard_solves() > 0);
    assert!(
        ids.iter()
            .all(|id| engine.velocity(*id).unwrap().0.length() < 1.0)
    );
}

/// Mixed columns that buckle under what falls on them leave hard rows, in which they pushed by up to 1e6 N·s. As the warm start of
/// soft rows these threw light bodies at up to 7e5 m/s; from no impulses soft rows reach 2e3 m/s.
#[test]
fn what_a_column_pushed_by_does_not_throw_it_when_it_buckles() {
    let mut fastest = 0.0_f64;
    for seed in 0..300 {
        let mut random = Random::new(seed);
        let mut engine = Engine::new(without_sleep()).unwrap();
        floor(&mut engine);
        let (friction, restitution) = (
            [0.0, 0.3, 1.0][random.below(3)],
            [0.0, 0.3, 0.9][random.below(3)],
        );
        let material = Material {
            friction,
            restitution,
        };
        let disc = PieceInput::new(Circle::new(0.5).unwrap());
        let pieces = [unit_box(), disc].map(|piece| [piece.with_material(material)]);
        let count = 2 + random.below(8);
        for k in 0..count {
            #[expect(clippy::cast_precision_loss, reason = "below ten")]
            let row = k as f64;
            let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 0.5 + row));
            engine.insert(body, &pieces[random.below(2)]).unwrap();
        }
        let mass = [1e4, 3e4, 1e5, 3e5, 1e6][random.below(5)];
        #[expect(clippy::cast_precision_loss, reason = "at most ten")]
        let at = vec2(
            0.3 * random.signed(),
            count as f64 + 1.5 + 3.0 * random.next(),
        );
        let load = BodyInput::dynamic(mass, mass / 6.0).at(at);
        engine.insert(load, &pieces[random.below(2)]).unwrap();
        let ids: Vec<BodyId> = engine.bodies().collect();
        for _ in 0..120 {
            engine.tick();
            for id in &ids {
                let speed = engine.velocity(*id).unwrap().0.length();
                fastest = fastest.max(speed);
            }
        }
    }
    assert!(fastest < 1e4, "{fastest} m/s");
}

/// A press goes down on boxes of which the lowest bear the heaviest: no velocities hold them. No body is thrown out: sweeps alone make one of them 42 m/s fast.
#[test]
fn a_press_on_a_heavy_load_throws_no_body() {
    for (light, load) in [
        (1, 20.0),
        (1, 1e3),
        (3, 20.0),
        (3, 1e3),
        (8, 20.0),
        (8, 1e3),
    ] {
        for speed in [0.05, 0.3, 2.0] {
            for x in [0.0, 0.3] {
                let mut engine = Engine::new(without_sleep()).unwrap();
                floor(&mut engine);
                let height = |row: u32| 0.5 + f64::from(row);
                let mut ids: Vec<_> = (0..light)
                    .map(|row| {
                        let at = vec2(0.05 * f64::from(row % 2), height(row));
                        put(&mut engine, 1.0, at)
                    })
                    .collect();
                ids.push(put(&mut engine, load, vec2(x, height(light))));
                let plate = PieceInput::new(ConvexPolygon::rectangle(5.0, 1.0).unwrap());
                let at = vec2(0.0, height(light) + 1.01);
                let mut press = BodyInput::new(BodyKind::Kinematic).at(at);
                press.velocity = vec2(0.0, -speed);
                engine.insert(press, &[plate]).unwrap();
                let mut fastest = 0.0_f64;
                for _ in 0..120 {
                    engine.tick();
                    engine.graph.check(&engine.bodies);
                    let speeds = ids
                        .iter()
                        .map(|id| engine.velocity(*id).unwrap().0.length());
                    fastest = speeds.fold(fastest, f64::max);
                }
                assert!(
                    fastest < 45.0,
                    "{fastest} m/s: {light} boxes under {load} kg, off by {x} m, pressed at {speed} m/s"
                );
            }
        }
    }
}

/// A light box is jammed in a slot that is too narrow for it, and a heavy one was put 0.1 m into it.
#[test]
fn an_overlap_parts_beside_one_that_cannot() {
    for jam in [1e-9, 1e-6, 1e-4, 5e-3] {
        let mut engine = Engine::new(without_sleep()).unwrap();
        floor(&mut engine);
        let wall = PieceInput::new(ConvexPolygon::rectangle(1.0, 0.9).unwrap());
        for side in [-1.0, 1.0] {
            let body = BodyInput::fixed().at(vec2(side * (1.0 - jam), 0.45));
            engine.insert(body, std::slice::from_ref(&wall)).unwrap();
        }
        let light = put(&mut engine, 1.0, vec2(0.0, 0.5));
        let heavy = put(&mut engine, 100.0, vec2(0.0, 1.4));
        for _ in 0..300 {
            engine.tick();
        }
        let overlap = 1.0 - (at(&engine, heavy).y - at(&engine, light).y);
        println!(
            "jam {jam}: {overlap} {:?} {:?} failed {}",
            at(&engine, heavy),
            at(&engine, light),
            engine.failed_hard_solves()
        );
        assert!(overlap < 1e-3, "jammed by {jam} m: {overlap} m are left");
    }
}

#[test]
fn strong_damping_leaves_numbers_finite() {
    for rate in [1.0, 1e2, 1e3, 1e4, 2e4, 1e5, 1e6, 1e9] {
        for damping in [[rate, rate], [rate, 0.0], [0.0, rate]] {
            let mut engine = Engine::new(without_sleep()).unwrap();
            floor(&mut engine);
            let mut put = |mass: f64, x: f64, y: f64| {
                let mut body = BodyInput::dynamic(mass, mass / 6.0).at(vec2(x, y));
                body.damping = damping;
                engine.insert(body, &[unit_box()]).unwrap()
            };
            // In hard rows, in soft ones, and in free fall.
            let ids = [
                (1.0, 0.0, 0.5),
                (1e3, 0.0, 1.5),
                (1.0, 5.0, 0.5),
                (1.0, 9.0, 9.0),
            ];
            let ids = ids.map(|(mass, x, y)| put(mass, x, y));
            for _ in 0..60 {
                engine.tick();
                engine.graph.check(&engine.bodies);
            }
            let fallen = at(&engine, ids[3]).y - 9.0;
            assert!(
                fallen <= 0.0 && fallen > -5.0,
                "{damping:?}: fell by {fallen}"
            );
            let off = off(&engine, &ids[..2]);
            assert!(off < MUST_STAY, "{damping:?}: {off} m");
            let off = (at(&engine, ids[2]) - vec2(5.0, 0.5)).length();
            assert!(off < 1e-4, "{damping:?}: {off} m in soft rows");
        }
    }
}

/// What falls on a light body, however lively, and a column that rocks have no more energy than they began with.
#[test]
fn hard_rows_add_no_energy() {
    let energy = |engine: &Engine| engine.energy().0 + engine.energy().1;
    let gain = |engine: &mut Engine, ticks: u32| {
        let first = energy(engine);
        let most = (0..ticks).map(|_| {
            engine.tick();
            energy(engine)
        });
        most.fold(first, f64::max) / first - 1.0
    };
    for load in [20.0, 1e3, 1e5] {
        for restitution in [0.0, 0.5, 1.0] {
            for x in [0.0, 0.3] {
                let mut engine = Engine::new(without_sleep()).unwrap();
                floor(&mut engine);
                let piece = unit_box().with_material(Material {
                    restitution,
                    friction: 0.5,
                });
                let mut put = |mass: f64, at: Vec2| {
                    let body = BodyInput::dynamic(mass, mass / 6.0).at(at);
                    let turned = body.moving(vec2(0.2, 0.0), 0.3);
                    engine.insert(turned, std::slice::from_ref(&piece)).unwrap()
                };
                let light = put(1.0, vec2(0.0, 0.5));
                put(load, vec2(x, 2.5));
                let gain = gain(&mut engine, 240);
                assert!(gain < 1e-9, "{load} kg, e = {restitution}, {x} m: {gain}");
                let bottom = at(&engine, light).y - 0.5;
                assert!(bottom > -1e-4, "{load} kg, e = {restitution}: {bottom} m");
            }
        }
    }
    for (light, load) in [(10, 1e3), (5, 1e5)] {
        let (mut engine, ids) = column(without_sleep(), light, load);
        engine.tick();
        let top = ids[light as usize];
        engine.set_velocity(top, vec2(0.1, 0.0), 0.0).unwrap();
        let gain = gain(&mut engine, 300);
        assert!(gain < 1e-9, "{light} boxes under {load} kg: {gain}");
    }
}

/// Discs, polygons and L shapes in a room, 4 to 12 m/s, one in ten heavy. What was wedged was turned by up to 0.44 rad in a sub-step to
/// gain a little room, since only its way was bounded, and came to lie half of its extent deep in others.
#[test]
fn what_is_parted_turns_no_faster_than_it_goes() {
    let (mut looks, mut deepest) = (0, 0.0_f64);
    for seed in [270, 274, 278, 282] {
        let mut random = Random::new(seed);
        let mut engine = Engine::new(without_sleep()).unwrap();
        let smooth = |piece| PieceInput::new(piece).with_material(SMOOTH);
        for inwards in [Vec2::Y, -Vec2::Y, Vec2::X, -Vec2::X] {
            let plane = HalfPlane::new(inwards * -3.0, inwards).unwrap();
            engine
                .insert(BodyInput::fixed(), &[smooth(plane.into())])
                .unwrap();
        }
        let ids: Vec<_> = (0..16)
            .map(|k| {
                let place = vec2(f64::from(k % 4), f64::from(k / 4)) * 1.4 - Vec2::splat(2.2);
                let size = 0.2 + 0.4 * random.next();
                let shapes = any_shape(&mut random, size);
                let mass = 3.0 * size * size * [1.0, 30.0][usize::from(random.next() < 0.1)];
                let body = BodyInput::dynamic(mass, 0.5 * mass * size * size).at(place);
                let speed = vec2(random.signed(), random.signed()) * 20.0 * size;
                let body = body.moving(speed, 20.0 * random.signed());
                let pieces: Vec<_> = shapes.into_iter().map(smooth).collect();
                engine.insert(body, &pieces).unwrap()
            })
            .collect();
        for _ in 0..360 {
            if random.next() < 0.05 {
                let id = ids[random.below(16)];
                let speed = vec2(random.signed(), random.signed()) * 8.0;
                engine
                    .set_velocity(id, speed, 20.0 * random.signed())
                    .unwrap();
            }
            engine.substep(&Mixed);
            for contact in engine.graph.hard_ids() {
                let [a, b] = engine.graph.contacts[contact].pieces.map(|number| {
                    let piece = &engine.pieces.list[number];
                    (piece, engine.bodies.pose_of(piece.body))
                });
                let extent = a.0.extent.min(b.0.extent);
                let gap = collide_any(a, b, 0.0).map_or(0.0, |found| found.gap());
                looks += 1;
                deepest = deepest.max(-gap / extent);
            }
        }
    }
    assert!(looks > 1_000, "{looks} contacts in hard rows");
    assert!(deepest < 0.3, "{deepest} of an extent");
}

const SMOOTH: Material = Material {
    friction: 0.0,
    restitution: 0.0,
};

/// Pieces of a disc, polygon, plate or L shape.
fn any_shape(random: &mut Random, size: f64) -> Vec<Shape> {
    let block = |low: Vec2, high: Vec2| {
        let corners = [low, vec2(high.x, low.y), high, vec2(low.x, high.y)];
        ConvexPolygon::new(corners.map(|corner| corner * size)).unwrap()
    };
    match random.below(4) {
        0 => vec![Circle::new(size).unwrap().into()],
        1 => vec![
            ConvexPolygon::regular(3 + random.below(6), size)
                .unwrap()
                .into(),
        ],
        2 => vec![
            ConvexPolygon::rectangle(2.0 * size, 0.2 + 0.5 * size * random.next())
                .unwrap()
                .into(),
        ],
        _ => vec![
            block(vec2(-1.0, -1.0), vec2(1.0, 0.0)).into(),
            block(vec2(-1.0, 0.0), vec2(0.0, 1.0)).into(),
        ],
    }
}
