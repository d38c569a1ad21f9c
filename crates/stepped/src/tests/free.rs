//! Free bodies: without supports or external forces.

use carom_geometry::{Circle, ConvexPolygon, Shape};
use carom_math::{Pose, Vec2, vec2};

use super::{Random, levels, without_sleep};
use crate::rows::FreePairs;
use crate::{BodyId, BodyInput, Engine, Material, Mixed, PieceInput, Settings};

fn weightless(settings: Settings) -> Settings {
    Settings {
        gravity: Vec2::ZERO,
        ..settings
    }
}

/// Boxes and discs of random mass, some in each other, that go for the middle.
fn swarm(settings: Settings, seed: u64, (count, speed): (usize, f64)) -> (Engine, Vec<Moves>) {
    let mut random = Random::new(seed);
    let mut engine = Engine::new(weightless(settings)).unwrap();
    let mut swarm = Vec::new();
    for _ in 0..count {
        let size = 0.3 + 0.3 * random.next();
        let shape: Shape = match random.below(2) {
            0 => ConvexPolygon::rectangle(size, 0.5 * size).unwrap().into(),
            _ => Circle::new(0.5 * size).unwrap().into(),
        };
        let material = Material {
            friction: [0.0, 0.5][random.below(2)],
            restitution: [0.0, 0.5][random.below(2)],
        };
        let (mass, place) = (
            1.0 + 9.0 * random.next(),
            vec2(random.signed(), random.signed()),
        );
        let inertia = mass * size * size / 8.0;
        let velocity = place * -speed + vec2(random.signed(), random.signed()) * (0.2 * speed);
        let body = BodyInput::dynamic(mass, inertia).at(place);
        let body = body.moving(velocity, 4.0 * random.signed());
        let piece = PieceInput::new(shape).with_material(material);
        let id = engine.insert(body, &[piece]).unwrap();
        swarm.push(Moves { id, mass, inertia });
    }
    (engine, swarm)
}

struct Moves {
    id: BodyId,
    mass: f64,
    inertia: f64,
}

/// Momentum, angular momentum about the origin, and the size of the latter.
fn motion(engine: &Engine, bodies: &[Moves]) -> (Vec2, f64, f64) {
    let (mut linear, mut angular, mut size) = (Vec2::ZERO, 0.0, 0.0);
    for body in bodies {
        let (v, w) = engine.velocity(body.id).unwrap();
        let centre = engine.pose(body.id).unwrap().position;
        linear += v * body.mass;
        angular += body.mass * centre.perp_dot(v) + body.inertia * w;
        size += body.mass * centre.length() * v.length() + body.inertia * w.abs();
    }
    (linear, angular, size)
}

/// These swarms lost up to a fiftieth of their angular momentum: arms were those of the tick, and overlaps were parted, once velocities
/// had been found.
#[test]
fn a_free_island_keeps_its_angular_momentum() {
    let mut touched = 0;
    for (seed, count) in (0..60).zip([2, 3, 4, 5, 6, 7, 40].into_iter().cycle()) {
        let (mut engine, swarm) = swarm(without_sleep(), seed, (count, 2.0));
        let (_, turns, size) = motion(&engine, &swarm);
        for _ in 0..120 {
            engine.tick();
            engine.graph.check(&engine.bodies);
            touched += u32::from(engine.contacts().any(|at| at.impulses[0] > 0.0));
            let (_, now, _) = motion(&engine, &swarm);
            let off = (now - turns).abs() / size;
            assert!(off < 1e-12, "{off:e} of the angular momentum, seed {seed}");
        }
    }
    assert!(touched > 500, "{touched} ticks");
}

/// Bodies that go by up to three of their widths a sub-step, of masses 1 to 10. What continuous collision took of their ways was given back
/// to the first body that each had touched, as far as a turn of their velocities gives it: 18 of these 40 swarms lost up to a tenth.
#[test]
fn what_is_stopped_keeps_its_angular_momentum() {
    let mut fast = 0;
    for (seed, count) in (0..40).zip([2, 3, 5, 9, 17].into_iter().cycle()) {
        let (mut engine, swarm) = swarm(without_sleep(), seed, (count, 300.0));
        let (pushes, turns, size) = motion(&engine, &swarm);
        for _ in 0..60 {
            engine.tick();
            engine.graph.check(&engine.bodies);
            fast += engine.fast().count();
            let (linear, now, _) = motion(&engine, &swarm);
            let off = (now - turns).abs() / size;
            assert!(off < 1e-11, "{off:e} of the angular momentum, seed {seed}");
            let off = (linear - pushes).length() / size;
            assert!(off < 1e-11, "{off:e} of the momentum, seed {seed}");
        }
    }
    assert!(fast > 1_000, "{fast} fast bodies");
}

#[test]
fn registers_of_all_widths_turn_free_pairs_alike() {
    let ends = levels().into_iter().map(|level| {
        let (mut engine, swarm) = swarm(without_sleep(), 5, (40, 2.0));
        engine.level = level;
        for _ in 0..60 {
            engine.tick();
        }
        let end = |body: &Moves| {
            (
                engine.pose(body.id).unwrap(),
                engine.velocity(body.id).unwrap(),
            )
        };
        swarm.iter().map(end).collect::<Vec<_>>()
    });
    let ends: Vec<_> = ends.collect();
    assert!(ends.iter().all(|end| *end == ends[0]));
}

/// Momentum and angular momentum that a caller sees once three tenths of the sub-step have passed.
fn motion_within(engine: &Engine, bodies: &[Moves], from: &[Pose]) -> (Vec2, f64) {
    let (mut linear, mut angular) = (Vec2::ZERO, 0.0);
    for (body, from) in bodies.iter().zip(from) {
        let state = engine.state(body.id).unwrap();
        let [begin, end] = state.lack.unwrap();
        let v = state.velocity.0 - begin.0.lerp(end.0, 0.3);
        let w = state.velocity.1 - (0.7 * begin.1 + 0.3 * end.1);
        let centre = from.position.lerp(state.pose.position, 0.3);
        linear += v * body.mass;
        angular += body.mass * centre.perp_dot(v) + body.inertia * w;
    }
    (linear, angular)
}

fn poses(engine: &Engine, bodies: &[Moves]) -> Vec<Pose> {
    let pose = |body: &Moves| engine.pose(body.id).unwrap();
    bodies.iter().map(pose).collect()
}

/// Velocities within a sub-step are those with which bodies go through it.
#[test]
fn momentum_and_angular_momentum_are_kept_within_a_sub_step() {
    let mut asked = 0;
    for seed in 0..24 {
        let (mut engine, swarm) = swarm(without_sleep(), seed, (7, 2.0));
        engine.note_ways(true);
        let (pushes, turns, size) = motion(&engine, &swarm);
        for _ in 0..400 {
            let from = poses(&engine, &swarm);
            engine.substep(&Mixed);
            let (linear, angular) = motion_within(&engine, &swarm, &from);
            let off = (linear - pushes).length() / size;
            assert!(off < 1e-12, "{off:e} of the momentum, seed {seed}");
            // What parts deep overlaps does not turn.
            if engine.deep.least_gap == 0.0 {
                asked += 1;
                let off = (angular - turns).abs() / size;
                assert!(off < 1e-12, "{off:e} of the angular momentum, seed {seed}");
            }
        }
    }
    // The rest has bodies that were put into each other.
    assert!(asked > 7000, "{asked} of 9600");
}

/// Bodies that continuous collision stops go elsewhere than their velocities tell: spins answer for that.
#[test]
fn what_is_stopped_keeps_its_angular_momentum_within_a_sub_step() {
    let mut fast = 0;
    for (seed, count) in (0..40).zip([2, 3, 5, 9, 17].into_iter().cycle()) {
        let (mut engine, swarm) = swarm(without_sleep(), seed, (count, 300.0));
        engine.note_ways(true);
        let (pushes, turns, size) = motion(&engine, &swarm);
        for _ in 0..200 {
            let from = poses(&engine, &swarm);
            engine.substep(&Mixed);
            fast += engine.fast().count();
            let (linear, angular) = motion_within(&engine, &swarm, &from);
            let off = (linear - pushes).length() / size;
            assert!(off < 1e-11, "{off:e} of the momentum, seed {seed}");
            if engine.deep.least_gap == 0.0 {
                let off = (angular - turns).abs() / size;
                assert!(off < 1e-11, "{off:e} of the angular momentum, seed {seed}");
            }
        }
    }
    assert!(fast > 1_000, "{fast} fast bodies");
}

/// Impulses of free pairs act at one point of both bodies; gaps and warm starts are those of before, also of what is deeper than
/// sweeps see: that was 0.25 mm off.
#[test]
fn free_pairs_meet_at_one_point() {
    let (mut met, mut deep) = (0, 0);
    for (seed, substeps) in (0..20).zip([2, 40].into_iter().cycle()) {
        let (mut engine, _) = swarm(without_sleep(), seed, (40, 2.0));
        for _ in 0..substeps {
            engine.substep(&Mixed);
        }
        let before = engine.clone();
        let (graph, bodies) = (&mut engine.graph, &mut engine.bodies);
        FreePairs::default().meet(graph, bodies);
        graph.check(bodies);
        for id in graph.ids() {
            let (block, _, lane) = graph.lane(id);
            let ends = block.lines(lane).map(|line| line);
            let [a, b] = ends.map(|at| bodies.base[at].position + bodies.lines[at].d());
            let n = block.normal(lane);
            let lever = (a - b).perp_dot(n) - (block.b1[lane] - block.a1[lane]);
            let height = (a - b).dot(n) - (block.bt[lane] - block.at[lane]);
            assert!(
                lever.abs() + height.abs() < 1e-14,
                "{lever:e} and {height:e} m, seed {seed}"
            );
            let was = before.graph.gaps(bodies, id);
            for (gap, was) in graph.gaps(bodies, id).into_iter().zip(was) {
                let off = (gap - was).abs();
                assert!(off <= 1e-14 * was.abs().max(1.0), "{gap} for {was} m");
            }
            met += 1;
            deep += usize::from(graph.lane(id).1.is_deep(lane));
        }
    }
    assert!(met > 400 && deep > 50, "{met} contacts, {deep} deep ones");
}

/// What it lost in its contact was added again in each sub-step, to rounding: 4e-15 m/s, for ever.
#[test]
fn a_body_without_contacts_keeps_the_velocity_that_it_is_given_to_the_last_bit() {
    let mut engine = Engine::new(weightless(without_sleep())).unwrap();
    let piece = PieceInput::new(Circle::new(0.5).unwrap());
    let id = engine
        .insert(BodyInput::dynamic(1.3, 0.1), &[piece])
        .unwrap();
    for k in 1..50 {
        // Large and small in turn, and no multiples of a power of two: their differences round.
        let size = [1.0, 1e3][k % 2] * (k as f64).sqrt();
        let (velocity, spin) = (vec2(size / 3.0, -size / 7.0), size / 9.0);
        engine.set_velocity(id, velocity, spin).unwrap();
        engine.tick();
        assert_eq!(engine.velocity(id).unwrap(), (velocity, spin));
    }
}

/// A displacement gives no velocity, and what did not move fell asleep half a second later, as deep in each other as it was.
#[test]
fn bodies_that_are_parted_do_not_fall_asleep_in_each_other() {
    let mut engine = Engine::new(weightless(Settings::default())).unwrap();
    let sizes = [0.2, 0.3, 0.4, 0.2, 0.3, 0.4, 0.2, 0.3, 0.4, 0.2];
    for (k, size) in sizes.into_iter().enumerate() {
        let shape: Shape = match k % 2 {
            0 => ConvexPolygon::rectangle(size, size).unwrap().into(),
            _ => Circle::new(size).unwrap().into(),
        };
        let body = BodyInput::dynamic(size * size, 0.1 * size * size * size * size);
        engine.insert(body, &[PieceInput::new(shape)]).unwrap();
    }
    for _ in 0..600 {
        engine.tick();
    }
    let deepest = engine.contacts().map(|contact| {
        let gaps = &contact.gaps[..contact.points];
        -gaps.iter().copied().fold(0.0, f64::min)
    });
    let deepest = deepest.fold(0.0, f64::max);
    assert!(deepest < 5e-3, "{deepest} m deep");
}
