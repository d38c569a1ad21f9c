//! Momentum, energy, friction, the warm start, and what equal bits are made of.

use carom_geometry::ConvexPolygon;
use carom_math::{Pose, Rot, Vec2, cross, vec2};

use super::{Random, floor, pyramid, unit_box, weightless, with_friction, without_sleep};
use crate::{BodyId, BodyInput, Engine, EngineError, PieceInput, Settings};

fn cloud(settings: Settings, seed: u64, count: usize, spread: f64) -> (Engine, Vec<BodyId>) {
    let mut random = Random::new(seed);
    let mut engine = Engine::new(settings).unwrap();
    let mut ids = Vec::new();
    for _ in 0..count {
        let piece = random.piece();
        let body = random.body(&piece, spread);
        ids.push(engine.insert(body, &[piece]).unwrap());
    }
    (engine, ids)
}

/// Momentum and angular momentum about the origin.
fn momentum(engine: &Engine, ids: &[BodyId]) -> (Vec2, f64) {
    let mut sum = (Vec2::ZERO, 0.0);
    for id in ids {
        let record = engine.bodies.get(*id).unwrap();
        let (v, w) = engine.velocity(*id).unwrap();
        let p = v * record.mass;
        sum.0 += p;
        sum.1 += cross(engine.pose(*id).unwrap().position, p) + record.inertia * w;
    }
    sum
}

/// How far momentum and angular momentum of 60 free bodies drift within a second, for a tick of so many: they begin apart, and run
/// into each other.
fn drift(seed: u64, ticks: u32) -> (f64, f64) {
    let settings = Settings {
        tick: 1.0 / f64::from(ticks),
        ..weightless()
    };
    let mut random = Random::new(seed);
    let mut engine = Engine::new(settings).unwrap();
    let mut ids = Vec::new();
    for k in 0..60 {
        let piece = random.piece();
        let mut body = random.body(&piece, 1.0);
        // 2 m apart, which is more than any of them is long.
        body.pose.position = vec2(f64::from(k % 8), f64::from(k / 8)) * 2.0 - Vec2::splat(7.0);
        body.velocity -= body.pose.position;
        ids.push(engine.insert(body, &[piece]).unwrap());
    }
    let before = momentum(&engine, &ids);
    for _ in 0..ticks {
        engine.tick();
    }
    let after = momentum(&engine, &ids);
    assert!(engine.contact_count() > 0);
    ((after.0 - before.0).length(), (after.1 - before.1).abs())
}

#[test]
fn momentum_is_kept_to_rounding() {
    for seed in 0..6 {
        let (drift, _) = drift(seed, 60);
        assert!(drift < 1e-11, "momentum drifts by {drift}");
    }
}

/// The arms of contacts were as old as the tick, and what overlaps was pushed apart once velocities had been found: it drifted with the
/// tick.
#[test]
fn angular_momentum_is_kept_to_rounding() {
    for seed in 0..12 {
        let (_, drift) = drift(seed, 60);
        assert!(drift < 1e-10, "angular momentum drifts by {drift}");
    }
}

/// The arms of its impulses were those of the tick: two bodies that bounced off each other lost or gained 0.037 kg m²/s in the mean.
#[test]
fn a_bounce_turns_both_bodies_about_one_point() {
    let drifts = (0..200).map(|seed| {
        let mut random = Random::new(seed);
        let mut engine = Engine::new(weightless()).unwrap();
        let ids = [-1.0, 1.0].map(|side| {
            let mut piece = random.piece();
            (piece.material.restitution, piece.material.friction) = (0.9, 0.0);
            let mut body = random.body(&piece, 1.0);
            body.pose.position = vec2(1.5 * side, 0.3 * random.signed());
            body.velocity = vec2(-3.0 * side, random.signed());
            engine.insert(body, &[piece]).unwrap()
        });
        let before = momentum(&engine, &ids).1;
        for _ in 0..60 {
            engine.tick();
        }
        (momentum(&engine, &ids).1 - before).abs()
    });
    let mean = drifts.sum::<f64>() / 200.0;
    assert!(mean < 5e-3, "{mean} kg m²/s");
}

#[test]
fn energy_does_not_rise_without_restitution() {
    for seed in 0..4 {
        let mut engine = Engine::new(without_sleep()).unwrap();
        floor(&mut engine);
        let mut random = Random::new(seed);
        for k in 0..50 {
            let piece = random.piece();
            let mut body = random.body(&piece, 1.0);
            body.pose.position = vec2(1.8 * f64::from(k % 7), 1.5 + 1.8 * f64::from(k / 7));
            engine.insert(body, &[piece]).unwrap();
        }
        let energy = |engine: &Engine| engine.energy().0 + engine.energy().1;
        let first = energy(&engine);
        let mut before = first;
        for tick in 0..240 {
            engine.tick();
            let after = energy(&engine);
            // Overlaps that are pushed out lift bodies: springs are no part of the sum.
            let gain = (after - before) / first;
            assert!(
                gain < 2e-3,
                "tick {tick} of seed {seed} gains {gain} of the energy"
            );
            before = after;
        }
        assert!(before < 0.9 * first);
    }
}

#[test]
fn friction_stays_in_its_cone() {
    let (mut engine, _) = cloud(weightless(), 3, 80, 3.0);
    for _ in 0..40 {
        engine.tick();
        for contact in engine.contacts() {
            let [j1, j2] = contact.impulses;
            assert!(j1 >= 0.0 && j2 >= 0.0);
            assert!(contact.friction.abs() <= 0.6 * (j1 + j2) * (1.0 + 1e-12));
        }
    }
}

/// Random insertions, removals, kicks and teleports keep `v − start = Σ M⁻¹ Jᵀ j`, colours and lanes.
#[test]
fn warm_start_is_kept_by_every_change() {
    for seed in 0..8u32 {
        let mut engine = Engine::new(without_sleep()).unwrap();
        let ground = floor(&mut engine);
        let mut random = Random::new(u64::from(100 + seed));
        let mut ids = Vec::new();
        for step in 0..300 {
            let piece = random.piece();
            match random.below(8) {
                0..3 => {
                    let mut body = random.body(&piece, 4.0);
                    body.pose.position.y += 5.0;
                    ids.push(engine.insert(body, &[piece]).unwrap());
                }
                3 if !ids.is_empty() => {
                    let id = ids.swap_remove(random.below(ids.len()));
                    engine.remove(id).unwrap();
                    assert_eq!(engine.pose(id), Err(EngineError::Stale(id)));
                }
                4 if !ids.is_empty() => {
                    let id = ids[random.below(ids.len())];
                    engine
                        .set_velocity(id, vec2(random.signed(), 3.0), random.signed())
                        .unwrap();
                }
                5 if !ids.is_empty() => {
                    let pose = random.pose(4.0);
                    engine.set_pose(ids[random.below(ids.len())], pose).unwrap();
                }
                6 if step % 5 == 0 => {
                    let pose = Pose::new(vec2(0.0, random.signed()), Rot::IDENTITY);
                    engine.set_pose(ground, pose).unwrap();
                }
                _ => {}
            }
            engine.tick();
            engine.graph.check(&engine.bodies);
        }
        assert!(engine.contact_count() > 20);
        for id in ids {
            engine.remove(id).unwrap();
            engine.graph.check(&engine.bodies);
        }
        assert_eq!(engine.contact_count(), 0);
    }
}

/// Poses and velocities as bits.
pub(super) fn bits(engine: &Engine, ids: &[BodyId]) -> Vec<[u64; 7]> {
    let all = ids.iter().map(|id| {
        let (pose, (v, w)) = (engine.pose(*id).unwrap(), engine.velocity(*id).unwrap());
        let (at, rot) = (pose.position, pose.rotation);
        [at.x, at.y, rot.cos(), rot.sin(), v.x, v.y, w].map(f64::to_bits)
    });
    all.collect()
}

#[test]
fn equal_calls_give_equal_bits() {
    let run = |four: bool| {
        let (mut engine, ids) = cloud(Settings::default(), 5, 70, 4.0);
        floor(&mut engine);
        if four {
            engine.hold_to_four_lanes();
        }
        for _ in 0..100 {
            engine.tick();
        }
        bits(&engine, &ids)
    };
    assert_eq!(run(false), run(false));
    assert_eq!(run(false), run(true));
}

#[test]
fn pyramid_stands_still() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let ids = pyramid(&mut engine, 12, Vec2::ZERO);
    let first: Vec<_> = ids
        .iter()
        .map(|id| engine.pose(*id).unwrap().position)
        .collect();
    for _ in 0..300 {
        engine.tick();
    }
    for (id, first) in ids.iter().zip(first) {
        let way = (engine.pose(*id).unwrap().position - first).length();
        assert!(way < 0.01, "a box moved by {way} m");
    }
}

/// Free flight is the parabola to rounding.
#[test]
fn a_body_flies_its_parabola() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let body = BodyInput::dynamic(2.0, 1.0).moving(vec2(3.0, 4.0), 2.0);
    let id = engine.insert(body, &[unit_box()]).unwrap();
    for _ in 0..120 {
        engine.tick();
    }
    let pose = engine.pose(id).unwrap();
    let right = vec2(6.0, 8.0 - 0.5 * 9.81 * 4.0);
    assert!((pose.position - right).length() < 1e-12);
    assert!((pose.rotation.inverse_mul(Rot::from_angle(4.0).x_axis()) - Vec2::X).length() < 1e-12);
}

/// A box slides down a slope with g (sin α − µ cos α), or stays where µ > tan α.
#[test]
fn friction_is_that_of_coulomb() {
    let angle = 0.4;
    let rot = Rot::from_angle(angle);
    for friction in [0.0, 0.2, 0.35, 0.6] {
        let mut engine = Engine::new(without_sleep()).unwrap();
        let slope = PieceInput::new(ConvexPolygon::rectangle(200.0, 2.0).unwrap());
        let mut fixed = BodyInput::fixed().at(rot * vec2(0.0, -1.0));
        fixed.pose.rotation = rot;
        engine
            .insert(fixed, &[with_friction(slope, friction)])
            .unwrap();
        let mut body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(rot * vec2(0.0, 0.5));
        body.pose.rotation = rot;
        let id = engine
            .insert(body, &[with_friction(unit_box(), friction)])
            .unwrap();
        for _ in 0..120 {
            engine.tick();
        }
        let way = -rot.inverse_mul(engine.pose(id).unwrap().position).x;
        let pull = (rot.sin() - friction * rot.cos()).max(0.0) * 9.81;
        assert!(
            (way - 0.5 * pull * 4.0).abs() < 0.02,
            "µ = {friction}: {way} m"
        );
    }
}

#[test]
fn bad_values_are_refused_by_name() {
    let refused = Engine::new(Settings {
        tick: -1.0,
        ..Settings::default()
    })
    .unwrap_err();
    assert_eq!(
        refused.to_string(),
        "Settings::tick is -1: it must be finite and above 0"
    );
    let mut engine = Engine::new(Settings::default()).unwrap();
    let refused = engine
        .insert(BodyInput::dynamic(0.0, 1.0), &[unit_box()])
        .unwrap_err();
    assert_eq!(
        refused.to_string(),
        "BodyInput::mass is 0: it must be finite and above 0"
    );
    let plane = carom_geometry::HalfPlane::new(Vec2::ZERO, Vec2::Y).unwrap();
    let refused = engine.insert(BodyInput::dynamic(1.0, 1.0), &[PieceInput::new(plane)]);
    assert_eq!(refused.unwrap_err(), EngineError::Unbounded { piece: 0 });
}

/// A column of boxes that falls as one, a gap wider than any margin between them: the lowest stops in the midst of a tick.
#[test]
fn what_stops_within_a_tick_is_not_run_over() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let mut ids = Vec::new();
    for k in 0..6 {
        let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 0.7 + 1.1 * f64::from(k)));
        ids.push(
            engine
                .insert(body.moving(vec2(0.0, -20.0), 0.0), &[unit_box()])
                .unwrap(),
        );
    }
    let mut deepest = 0.0f64;
    for _ in 0..60 {
        engine.tick();
        engine.graph.check(&engine.bodies);
        for pair in ids.windows(2) {
            let [low, high] = [pair[0], pair[1]].map(|id| engine.pose(id).unwrap().position.y);
            deepest = deepest.max(1.0 - (high - low));
        }
    }
    assert!(deepest < 0.05, "{deepest} m");
}
