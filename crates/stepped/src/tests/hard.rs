//! Hard rows: loads that sweeps do not carry.

use carom_geometry::ConvexPolygon;
use carom_math::{Pose, Rot, Vec2, perp, vec2};

use super::{Random, floor, levels, pyramid, unit_box, without_sleep};
use crate::{
    BodyId, BodyInput, BodyKind, Engine, Material, Mixed, PairRules, PieceInput, Settings, Surface,
};

pub(super) const MUST_STAY: f64 = 1e-6;

/// A box of 1 m and of `mass` kg.
pub(super) fn put(engine: &mut Engine, mass: f64, at: Vec2) -> BodyId {
    let body = BodyInput::dynamic(mass, mass / 6.0).at(at);
    engine.insert(body, &[unit_box()]).unwrap()
}

/// Boxes of 1 kg on what is there, and one of `load` kg on top.
pub(super) fn stack(engine: &mut Engine, x: f64, light: u32, load: f64) -> Vec<BodyId> {
    let mass = |row| if row == light { load } else { 1.0 };
    let mut put = |row| put(engine, mass(row), vec2(x, 0.5 + f64::from(row)));
    (0..=light).map(&mut put).collect()
}

pub(super) fn column(settings: Settings, light: u32, load: f64) -> (Engine, Vec<BodyId>) {
    let mut engine = Engine::new(settings).unwrap();
    floor(&mut engine);
    let ids = stack(&mut engine, 0.0, light, load);
    (engine, ids)
}

pub(super) fn at(engine: &Engine, id: BodyId) -> Vec2 {
    engine.pose(id).unwrap().position
}

/// How far the farthest body of a column is from where it was put, in m.
pub(super) fn off(engine: &Engine, ids: &[BodyId]) -> f64 {
    let way =
        |(row, id): (u32, &BodyId)| (at(engine, *id) - vec2(0.0, 0.5 + f64::from(row))).length();
    (0..).zip(ids).map(way).fold(0.0, f64::max)
}

/// The positions of bodies, bit by bit.
fn bits(engine: &Engine, ids: &[BodyId], from: Vec2) -> Vec<[u64; 2]> {
    let of = |id: &BodyId| at(engine, *id) - from;
    ids.iter()
        .map(of)
        .map(|p| [p.x.to_bits(), p.y.to_bits()])
        .collect()
}

#[test]
fn a_column_stands_under_a_heavy_box() {
    for (light, load) in [(10, 1e3), (24, 1e3), (5, 1e5), (1, 1e9)] {
        for settings in [Settings::default(), without_sleep()] {
            let (mut engine, ids) = column(settings, light, load);
            for _ in 0..600 {
                engine.tick();
            }
            let off = off(&engine, &ids);
            assert!(off < MUST_STAY, "{light} boxes under {load} kg: {off} m");
            assert_eq!(engine.failed_hard_solves(), 0);
            assert_eq!(engine.is_asleep(ids[0]).unwrap(), settings.sleep.is_some());
        }
    }
}

#[test]
fn a_column_stands_when_its_top_was_nudged() {
    for (light, load) in [(10, 1e3), (24, 1e3), (5, 1e5)] {
        let (mut engine, ids) = column(without_sleep(), light, load);
        let top = ids[light as usize];
        engine.tick();
        engine.set_velocity(top, vec2(0.1, 0.0), 0.0).unwrap();
        for _ in 0..600 {
            engine.tick();
            engine.graph.check(&engine.bodies);
        }
        let way = at(&engine, top) - vec2(0.0, 0.5 + f64::from(light));
        // A column of 24 still rocks, about its lower corners: that lifts it.
        assert!(
            way.y > -MUST_STAY,
            "{light} boxes under {load} kg sink by {} m",
            -way.y
        );
        assert!(
            way.x.abs() < 0.02,
            "{light} boxes under {load} kg lean by {} m",
            way.x
        );
        assert_eq!(engine.failed_hard_solves(), 0);
    }
}

#[test]
fn a_heavy_box_that_falls_on_a_light_one_does_not_bounce() {
    for load in [20.0, 1e2, 1e3, 1e5] {
        let (mut engine, ids) = column(Settings::default(), 0, 1.0);
        let falls = put(&mut engine, load, vec2(0.0, 2.5));
        let mut highest = f64::NEG_INFINITY;
        for _ in 0..60 {
            engine.tick();
            engine.graph.check(&engine.bodies);
            highest = highest.max(engine.velocity(falls).unwrap().0.y);
        }
        assert!(highest < 1e-9, "{load} kg come back at {highest} m/s");
        let off = off(&engine, &[ids[0], falls]);
        assert!(off < MUST_STAY, "{load} kg: {off} m");
    }
}

/// Nothing here bears a body of more than 16 times its mass: no island takes hard rows.
#[test]
fn light_loads_take_soft_rows() {
    let mut engine = Engine::new(without_sleep()).unwrap();
    floor(&mut engine);
    pyramid(&mut engine, 5, vec2(50.0, 0.0));
    stack(&mut engine, 0.0, 3, 16.0);
    // Light boxes on a heavy one.
    for (row, mass) in (0u32..).zip([1e3, 1.0, 1.0]) {
        put(&mut engine, mass, vec2(10.0, 0.5 + f64::from(row)));
    }
    // A heavy box flies through light ones.
    let ram = put(&mut engine, 1e3, vec2(20.0, 30.0));
    engine.set_velocity(ram, vec2(0.0, -20.0), 0.0).unwrap();
    for k in 0..3u32 {
        put(&mut engine, 1.0, vec2(20.0, 26.0 - 1.1 * f64::from(k)));
    }
    for _ in 0..60 {
        engine.tick();
        assert!(!engine.graph.has_hard());
    }
}

#[test]
fn a_column_wakes_as_it_slept() {
    let (mut engine, ids) = column(Settings::default(), 10, 1e3);
    for round in 0..3 {
        for _ in 0..120 {
            engine.tick();
            engine.graph.check(&engine.bodies);
        }
        assert!(engine.is_asleep(ids[0]).unwrap());
        // In the middle of a tick, too.
        for _ in 0..round {
            engine.substep(&Mixed);
        }
        engine.wake(ids[3]).unwrap();
        engine.graph.check(&engine.bodies);
    }
    assert!(off(&engine, &ids) < MUST_STAY);
}

/// Rows that had fallen asleep as hard ones woke as soft ones, and kept impulses that sweeps cannot take back.
#[test]
fn what_bore_a_load_is_not_thrown_when_it_has_gone() {
    let (mut engine, ids) = column(Settings::default(), 10, 1e3);
    for _ in 0..120 {
        engine.tick();
    }
    assert!(engine.is_asleep(ids[0]).unwrap());
    engine.remove(ids[10]).unwrap();
    for _ in 0..10 {
        engine.tick();
    }
    // Springs give way a little as they come to bear; the boxes jumped by 1.3 m.
    let off = off(&engine, &ids[..10]);
    assert!(off < 0.02, "{off} m");
}

/// A chip that a heavy box presses went by 10 mm a sub-step, past the end of what it slid along, for the 1 mm that it was too deep.
#[test]
fn what_is_wedged_in_goes_no_farther_than_its_faces() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let chip = PieceInput::new(ConvexPolygon::rectangle(0.004, 0.003).unwrap());
    let body = BodyInput::dynamic(1e-5, 1e-10).at(vec2(0.48, 0.0015));
    let chip = engine.insert(body, &[chip]).unwrap();
    let tilt = 0.002;
    let mut body = BodyInput::dynamic(1e3, 1e3 / 6.0);
    body.pose = Pose::new(vec2(0.0, 0.5 + 0.5 * tilt), Rot::from_angle(tilt));
    engine.insert(body, &[unit_box()]).unwrap();
    let mut before = at(&engine, chip);
    for _ in 0..60 {
        engine.substep(&Mixed);
        let now = at(&engine, chip);
        let way = (now - before).length();
        assert!(way < 1e-3, "{way} m");
        before = now;
    }
}

#[test]
fn an_island_in_hard_rows_has_the_bits_that_it_has_alone() {
    let nudged = |alone: bool, level| {
        let mut engine = Engine::new(without_sleep()).unwrap();
        engine.level = level;
        floor(&mut engine);
        let others = if alone {
            Vec::new()
        } else {
            stack(&mut engine, 64.0, 6, 300.0)
        };
        let ids = stack(&mut engine, 0.0, 4, 1e3);
        if !alone {
            pyramid(&mut engine, 4, vec2(128.0, 0.0));
            engine.set_velocity(others[2], vec2(0.3, 0.0), 0.1).unwrap();
        }
        engine.set_velocity(ids[4], vec2(0.1, 0.0), 0.0).unwrap();
        for _ in 0..120 {
            engine.tick();
        }
        bits(&engine, &ids, Vec2::ZERO)
    };
    let first = nudged(true, levels()[0]);
    for level in levels() {
        assert_eq!(nudged(false, level), first);
    }
}

/// Random calls among bodies of 1 kg to a ton keep lanes and warm starts.
#[test]
fn random_calls_among_hard_rows_keep_the_graph() {
    let mut hard = 0;
    for seed in 0..8 {
        let mut engine = Engine::new(Settings::default()).unwrap();
        let ground = floor(&mut engine);
        let mut random = Random::new(4000 + seed);
        let mut ids = vec![ground];
        for step in 0..400 {
            let pick = ids[random.below(ids.len())];
            match random.below(60) {
                0..5 if step < 200 => {
                    let piece = random.piece();
                    let mut body = random.body(&piece, 1.0);
                    body.pose.position.y += 4.0;
                    let times = [1.0, 1.0, 30.0, 1000.0][random.below(4)];
                    (body.mass, body.inertia) = (body.mass * times, body.inertia * times);
                    ids.push(engine.insert(body, &[piece]).unwrap());
                }
                5 if pick != ground => {
                    engine.remove(pick).unwrap();
                    ids.retain(|id| *id != pick);
                }
                6 => engine
                    .set_velocity(pick, vec2(random.signed(), 2.0), 0.0)
                    .unwrap(),
                7 if pick != ground => engine.set_pose(pick, random.pose(5.0)).unwrap(),
                8 => engine.wake(pick).unwrap(),
                _ => {}
            }
            if step % 7 == 0 {
                engine.substep(&Mixed);
            } else {
                engine.tick();
            }
            engine.graph.check(&engine.bodies);
            hard += u32::from(engine.graph.has_hard());
        }
    }
    assert!(hard > 500, "{hard} ticks with hard rows");
}
/// Pieces of tag 1 are belts.
struct Belt(f64);

impl PairRules for Belt {
    fn surface(&self, tags: [u64; 2], materials: [Material; 2]) -> Option<Surface> {
        let surface = Mixed.surface(tags, materials)?;
        let tangent_speed = if tags.contains(&1) { self.0 } else { 0.0 };
        Some(Surface {
            tangent_speed,
            ..surface
        })
    }
}

/// What carries a column along is no press: it is held.
#[test]
fn a_column_rides_a_platform_and_a_belt() {
    for (velocity, spin, belt) in [
        (vec2(0.0, 0.5), 0.0, 0.0),
        (vec2(0.3, -0.2), 0.0, 0.0),
        (Vec2::ZERO, 0.005, 0.0),
        (Vec2::ZERO, 0.0, 1.0),
    ] {
        let mut engine = Engine::new(without_sleep()).unwrap();
        let plate = PieceInput::new(ConvexPolygon::rectangle(60.0, 1.0).unwrap()).tagged(1);
        let mut platform = BodyInput::new(BodyKind::Kinematic).at(vec2(0.0, -0.5));
        (platform.velocity, platform.spin) = (velocity, spin);
        let platform = engine.insert(platform, &[plate]).unwrap();
        let ids = stack(&mut engine, 5.0, 4, 1e3);
        for id in &ids {
            let along = velocity + perp(at(&engine, *id) + vec2(0.0, 0.5)) * spin - Vec2::X * belt;
            engine.set_velocity(*id, along, spin).unwrap();
        }
        for _ in 0..300 {
            engine.tick_by(&Belt(belt));
            engine.graph.check(&engine.bodies);
        }
        assert!(engine.graph.has_hard());
        assert_eq!(engine.failed_hard_solves(), 0, "{velocity} {spin} {belt}");
        // As seen from the platform.
        let from = engine.pose(platform).unwrap();
        for (row, id) in (0..).zip(&ids) {
            let seen = from.rotation.inverse() * (at(&engine, *id) - from.position);
            let off = seen.y - 1.0 - f64::from(row);
            assert!(
                off.abs() < 1e-4,
                "box {row} is off by {off} m: {velocity} {spin} {belt}"
            );
        }
    }
}

/// Random calls at some place.
struct Scene {
    random: Random,
    ids: Vec<BodyId>,
    x: f64,
}

impl Scene {
    fn call(&mut self, engine: &mut Engine) {
        let Self { random, ids, x } = self;
        match random.below(40) {
            0..2 if ids.len() < 20 => {
                let piece = random.piece();
                let mut body = random.body(&piece, 1.5);
                body.pose.position += vec2(*x, 4.0);
                let times = [1.0, 1.0, 30.0, 1000.0][random.below(4)];
                (body.mass, body.inertia) = (body.mass * times, body.inertia * times);
                ids.push(engine.insert(body, &[piece]).unwrap());
            }
            2 if ids.len() > 3 => {
                let k = random.below(ids.len());
                engine.remove(ids.swap_remove(k)).unwrap();
            }
            3 if !ids.is_empty() => {
                let velocity = vec2(5.0 * random.signed(), 2.0);
                let id = ids[random.below(ids.len())];
                engine.set_velocity(id, velocity, 0.0).unwrap();
            }
            4 if !ids.is_empty() && random.below(4) == 0 => {
                let mut pose = random.pose(1.0);
                pose.position += vec2(*x, 3.0);
                let id = ids[random.below(ids.len())];
                engine.set_pose(id, pose).unwrap();
            }
            _ => {}
        }
    }
}

#[test]
fn far_scenes_do_not_feel_each_others_heavy_bodies() {
    let mut hard = 0;
    for seed in 0..12 {
        let mut run = |both: bool| {
            let mut engine = Engine::new(Settings::default()).unwrap();
            floor(&mut engine);
            let scene = |first: u64, x| Scene {
                random: Random::new(first + seed),
                ids: Vec::new(),
                x,
            };
            let (mut first, mut other) = (scene(900, 0.0), scene(7000, 1024.0));
            let mut trace = Vec::new();
            for _ in 0..1500 {
                first.call(&mut engine);
                if both {
                    other.call(&mut engine);
                }
                engine.substep(&Mixed);
                trace.push(bits(&engine, &first.ids, Vec2::ZERO));
                hard += u32::from(engine.graph.has_hard());
            }
            trace
        };
        let (alone, beside) = (run(false), run(true));
        let differs = alone
            .iter()
            .zip(&beside)
            .position(|(one, other)| one != other);
        assert_eq!(differs, None, "scene {seed} in this sub-step");
    }
    assert!(hard > 2000, "{hard} sub-steps with hard rows");
}

/// An island that has no answer remembers it by itself: what else changes in the middle of ticks is not asked.
#[test]
fn a_pressed_island_does_not_feel_a_body_far_away() {
    let run = |both: bool| {
        let (mut engine, ids) = column(without_sleep(), 1, 1e3);
        let plate = PieceInput::new(ConvexPolygon::rectangle(3.0, 1.0).unwrap());
        let mut press = BodyInput::new(BodyKind::Kinematic).at(vec2(0.0, 2.5));
        press.velocity = vec2(0.0, -0.1);
        engine.insert(press, &[plate]).unwrap();
        let far = both.then(|| put(&mut engine, 1.0, vec2(1024.0, 50.0)));
        let mut side = 60.0;
        for _ in 0..30 {
            for substep in 0..5 {
                if let Some(id) = far.filter(|_| substep == 2) {
                    side = -side;
                    engine.set_velocity(id, vec2(side, 0.0), 0.0).unwrap();
                }
                engine.substep(&Mixed);
            }
        }
        bits(&engine, &ids, Vec2::ZERO)
    };
    assert_eq!(run(true), run(false));
}

/// A slab is put under falling boxes in the middle of a tick: their rows go from extra sweeps to the solve.
#[test]
fn extra_sweeps_leave_hard_rows_alone() {
    let mut engine = Engine::new(without_sleep()).unwrap();
    let light = put(&mut engine, 1.0, vec2(0.0, 0.5));
    put(&mut engine, 1e3, vec2(0.3, 1.5));
    engine.tick();
    engine.substep(&Mixed);
    let slab = PieceInput::new(ConvexPolygon::rectangle(6.0, 1.0).unwrap());
    let under = vec2(0.0, at(&engine, light).y - 1.0);
    engine
        .insert(BodyInput::fixed().at(under), &[slab])
        .unwrap();
    for _ in 0..8 {
        engine.substep(&Mixed);
        assert!(engine.graph.has_hard());
    }
}

/// Bodies that are pulled one by one rest as those under gravity do.
#[test]
fn a_column_stands_without_gravity_of_the_engine() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..without_sleep()
    };
    let (mut engine, ids) = column(settings, 10, 1e3);
    for &id in &ids {
        engine.set_pull(id, vec2(0.0, -9.81), 0.0).unwrap();
    }
    for _ in 0..300 {
        engine.tick();
    }
    let off = off(&engine, &ids);
    assert!(off < MUST_STAY, "{off} m");
}
