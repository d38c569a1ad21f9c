//! Islands and their sleep.

use carom_geometry::ConvexPolygon;
use carom_math::{Rot, Vec2, vec2};

use super::{Random, floor, pyramid, unit_box};
use crate::{BodyInput, BodyKind, Engine, Material, PieceInput, Settings};

#[test]
fn a_pyramid_falls_asleep_and_wakes_as_it_was() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let ids = pyramid(&mut engine, 6, Vec2::ZERO);
    let far = pyramid(&mut engine, 3, vec2(50.0, 0.0));
    for _ in 0..120 {
        engine.tick();
        engine.graph.check(&engine.bodies);
    }
    assert!(
        ids.iter()
            .chain(&far)
            .all(|id| engine.is_asleep(*id).unwrap())
    );
    assert_eq!(engine.bodies.lines.len(), 2);
    let poses: Vec<_> = ids.iter().map(|id| engine.pose(*id).unwrap()).collect();
    for _ in 0..60 {
        engine.tick();
    }
    engine.wake(ids[3]).unwrap();
    engine.graph.check(&engine.bodies);
    assert!(ids.iter().all(|id| !engine.is_asleep(*id).unwrap()));
    assert!(far.iter().all(|id| engine.is_asleep(*id).unwrap()));
    for _ in 0..10 {
        engine.tick();
        engine.graph.check(&engine.bodies);
    }
    for (id, pose) in ids.iter().zip(poses) {
        // Impulses were kept: nothing jumps.
        let way = (engine.pose(*id).unwrap().position - pose.position).length();
        assert!(way < 1e-4, "{way}");
    }
}

/// A box that came to rest a hair beside sleepers woke them, was laid beside them while they were awake, and woke with them: for
/// ever.
#[test]
fn what_rests_beside_sleepers_lets_them_sleep() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let first = pyramid(&mut engine, 1, Vec2::ZERO);
    for _ in 0..20 {
        engine.tick();
    }
    let at = engine.pose(first[0]).unwrap().position + vec2(1.0 + 1e-5, 0.0);
    let beside = BodyInput::dynamic(1.0, 1.0 / 6.0).at(at);
    let beside = engine.insert(beside, &[unit_box()]).unwrap();
    for _ in 0..120 {
        engine.tick();
        engine.graph.check(&engine.bodies);
    }
    assert!(
        [first[0], beside]
            .iter()
            .all(|id| engine.is_asleep(*id).unwrap())
    );
}

/// Their pieces kept the rotation of the last base pose: whatever lay beside them met or missed them by up to a tolerance.
#[test]
fn the_pieces_of_sleepers_are_turned_as_their_bodies() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let mut tilted = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 0.505));
    tilted.pose.rotation = Rot::from_angle(0.004);
    let id = engine.insert(tilted, &[unit_box()]).unwrap();
    let corner = |engine: &Engine| {
        let piece = engine.bodies.records[id.slot].first_piece;
        engine.pieces.outline(piece).corner(0)
    };
    for _ in 0..120 {
        engine.tick();
    }
    assert!(engine.is_asleep(id).unwrap());
    let laid = corner(&engine);
    engine.wake(id).unwrap();
    let based = corner(&engine);
    let angle = engine.bodies.lines[engine.bodies.line_of(id.slot)].turn();
    assert!(
        angle.abs() > 1e-3,
        "nothing to see: {angle:e} rad since the base pose"
    );
    let off = (Rot::from_angle(angle) * based - laid).length();
    assert!(off < 1e-9, "{off:e} m");
}

/// The least gap of two points and the least way of two points were added, whichever point each belonged to: of two boxes that
/// had turned by little each woke the other when it fell asleep, half a second later the other way round, for ever.
#[test]
fn the_gap_ahead_is_that_of_a_point_and_its_own_way() {
    let mut random = Random::new(7);
    for _ in 0..200 {
        let mut engine = Engine::new(Settings::default()).unwrap();
        let gap = 3e-3 * random.next();
        let mut put = |y: f64| {
            let input = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, y));
            engine.insert(input, &[unit_box()]).unwrap()
        };
        let (low, high) = (put(0.0), put(1.0 + gap));
        engine.rebase();
        let line = engine.bodies.line_of(high.slot);
        let (way, turn) = (1e-3 * random.signed(), 4e-3 * random.signed());
        engine.bodies.lines[line].set_displacement(vec2(0.0, way), turn);
        let pair = [low, high].map(|id| engine.bodies.records[id.slot].first_piece);
        let scene = engine.scene();
        let found = scene.contact(pair, 1.0).expect("near");
        let right = gap + way - 0.5 * turn.abs();
        let ahead = scene.gap_ahead(pair, &found, false);
        // Of second order in the angle.
        assert!((ahead - right).abs() <= turn * turn, "{ahead:e} {right:e}");
    }
}

#[test]
fn what_is_hit_wakes_and_what_is_missed_does_not() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let ids = pyramid(&mut engine, 3, Vec2::ZERO);
    for _ in 0..120 {
        engine.tick();
    }
    assert!(engine.is_asleep(ids[0]).unwrap());
    let at = |x: f64, y: f64| BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(x, y));
    // Slides past the top, 0.3 m above it.
    let past = at(-3.0, 3.8).moving(vec2(30.0, 0.0), 0.0);
    engine.insert(past, &[unit_box()]).unwrap();
    for _ in 0..12 {
        engine.tick();
        engine.graph.check(&engine.bodies);
    }
    assert!(engine.is_asleep(ids[0]).unwrap());
    let top = *ids.last().unwrap();
    let before = engine.pose(top).unwrap().position;
    engine.insert(at(1.0, 5.0), &[unit_box()]).unwrap();
    for _ in 0..40 {
        engine.tick();
        engine.graph.check(&engine.bodies);
    }
    assert!(!engine.is_asleep(top).unwrap());
    assert!((engine.pose(top).unwrap().position - before).length() < 0.1);
}

#[test]
fn a_floor_taken_away_wakes_what_lay_on_it() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let ground = floor(&mut engine);
    let ids = pyramid(&mut engine, 3, Vec2::ZERO);
    for _ in 0..120 {
        engine.tick();
    }
    assert!(engine.is_asleep(ids[0]).unwrap());
    engine.remove(ground).unwrap();
    engine.graph.check(&engine.bodies);
    for _ in 0..30 {
        engine.tick();
    }
    assert!(engine.pose(ids[0]).unwrap().position.y < -0.5);
}

/// Sleep or not, random calls keep lanes and warm starts.
#[test]
fn random_calls_among_sleepers_keep_the_graph() {
    let mut total = 0;
    for seed in 0..12 {
        let mut engine = Engine::new(Settings::default()).unwrap();
        let ground = floor(&mut engine);
        let mut random = Random::new(900 + seed);
        let mut ids = vec![ground];
        let mut slept = 0;
        for step in 0..600 {
            let pick = ids[random.below(ids.len())];
            match random.below(60) {
                0..6 if step < 200 => {
                    let surface = Material {
                        friction: random.next(),
                        restitution: [0.0, 0.0, 0.5, 1.0][random.below(4)],
                    };
                    let piece = random.piece().with_material(surface);
                    let mut body = random.body(&piece, 5.0);
                    body.pose.position.y += 7.0;
                    body.kind = [BodyKind::Dynamic, BodyKind::Kinematic, BodyKind::Fixed]
                        [random.below(12).saturating_sub(9)];
                    if body.kind == BodyKind::Kinematic {
                        (body.velocity, body.spin) = (body.velocity * 0.2, 0.0);
                    }
                    ids.push(engine.insert(body, &[piece]).unwrap());
                }
                6 if pick != ground => {
                    engine.remove(pick).unwrap();
                    ids.retain(|id| *id != pick);
                }
                7 => engine
                    .set_velocity(pick, vec2(random.signed(), 2.0), 0.0)
                    .unwrap(),
                8 if pick != ground => engine.set_pose(pick, random.pose(5.0)).unwrap(),
                _ => {}
            }
            engine.tick();
            engine.graph.check(&engine.bodies);
            slept += ids
                .iter()
                .filter(|id| engine.is_asleep(**id).unwrap())
                .count();
        }
        total += slept;
    }
    assert!(total > 100, "{total}");
}

/// What drifts slowly in space fell asleep there: half the momentum of three bodies of a centimetre was gone.
#[test]
fn what_nothing_holds_sleeps_only_if_it_does_not_move() {
    let mut engine = Engine::new(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    })
    .unwrap();
    let mut put = |x: f64, speed: f64, damping: f64| {
        let mut body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(x, 0.0));
        body.velocity = vec2(0.0, speed);
        body.damping = [damping; 2];
        engine.insert(body, &[unit_box()]).unwrap()
    };
    let drifts = put(0.0, 1e-4, 0.0);
    let rests = put(5.0, 0.0, 0.0);
    let stops = put(10.0, 1e-4, 1.0);
    // Two that touch each other alone.
    let pair = [put(15.0, 1e-4, 0.0), put(16.0, 1e-4, 0.0)];
    for _ in 0..120 {
        engine.tick();
    }
    for id in [drifts, pair[0], pair[1]] {
        assert!(!engine.is_asleep(id).unwrap());
        assert_eq!(engine.velocity(id).unwrap().0, vec2(0.0, 1e-4));
    }
    for id in [rests, stops] {
        assert!(engine.is_asleep(id).unwrap());
    }
}

/// What leans on a kinematic body that stands still falls asleep, and goes on to sleep: it was woken at the next tick.
#[test]
fn what_leans_on_a_kinematic_body_at_rest_sleeps() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let post = PieceInput::new(ConvexPolygon::rectangle(1.0, 3.0).unwrap());
    let body = BodyInput::new(BodyKind::Kinematic).at(vec2(0.0, 1.5));
    let post = engine.insert(body, &[post]).unwrap();
    let plank = PieceInput::new(ConvexPolygon::rectangle(0.2, 2.0).unwrap());
    let mut body = BodyInput::dynamic(1.0, 0.34).at(vec2(1.0, 1.05));
    body.pose.rotation = Rot::from_angle(0.35);
    let leans = engine.insert(body, &[plank]).unwrap();
    for _ in 0..300 {
        engine.tick();
    }
    for _ in 0..120 {
        assert!(engine.is_asleep(leans).unwrap());
        engine.tick();
    }
    assert!(engine.pose(leans).unwrap().position.y > 0.8, "it fell");
    engine.set_velocity(post, vec2(0.5, 0.0), 0.0).unwrap();
    engine.tick();
    engine.tick();
    assert!(!engine.is_asleep(leans).unwrap(), "it is driven");
}

/// A box that lies 0.1 mm from a sleeper has no contact with it. Struck from the other side the sleeper came 5 mm deep into it.
#[test]
fn what_lies_near_a_sleeper_is_met_once_it_wakes() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let slides = Material {
        friction: 0.0,
        ..Material::default()
    };
    let box_at = |x: f64, y: f64| BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(x, y));
    let mut put = |body: BodyInput| {
        let piece = unit_box().with_material(slides);
        engine.insert(body, &[piece]).unwrap()
    };
    let struck = put(box_at(0.0, 0.5));
    let beside = put(box_at(1.0001, 0.5));
    // It keeps the box below it awake.
    let mut top = box_at(1.4, 1.5);
    top.sleep_allowed = false;
    put(top);
    for _ in 0..120 {
        engine.tick();
    }
    assert!(engine.is_asleep(struck).unwrap());
    assert!(!engine.is_asleep(beside).unwrap());
    let strikes = box_at(-1.002, 0.5).moving(vec2(0.3, 0.0), 0.0);
    let piece = unit_box().with_material(slides);
    engine.insert(strikes, &[piece]).unwrap();
    for tick in 0..60 {
        engine.tick();
        let x = |id| engine.pose(id).unwrap().position.x;
        let apart = x(beside) - x(struck);
        assert!(apart > 0.999, "{apart} m at tick {tick}");
    }
}

/// It was 0 while it slept, and what a caller set then was forgotten.
#[test]
fn what_sleeps_has_turned_as_far_as_before() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let mut still = BodyInput::fixed();
    still.turned = 3.0;
    let still = engine.insert(still, &[]).unwrap();
    let mut body = BodyInput::dynamic(1.0, 1.0).moving(Vec2::ZERO, 5.0);
    body.turned = 7.0;
    let body = engine.insert(body, &[unit_box()]).unwrap();
    engine.tick();
    let of = |engine: &Engine, id| engine.state(id).unwrap().turned;
    let is = |engine: &Engine, wanted: f64| {
        let off = of(engine, body) - wanted;
        assert!(off.abs() < 1e-12, "{off} rad off {wanted}");
    };
    let before = 7.0 + 5.0 / 60.0;
    is(&engine, before);
    engine.sleep(body).unwrap();
    is(&engine, before);
    engine.wake(body).unwrap();
    is(&engine, before);
    engine.sleep(body).unwrap();
    engine.set_turned(body, 20.0).unwrap();
    is(&engine, 20.0);
    engine.wake(body).unwrap();
    is(&engine, 20.0);
    assert!((of(&engine, still) - 3.0).abs() < 1e-12);
}

#[test]
fn a_pull_that_is_set_on_a_sleeper_acts_once_it_wakes() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    let mut engine = Engine::new(settings).unwrap();
    let input = BodyInput::dynamic(1.0, 1.0 / 6.0);
    let body = engine.insert(input, &[unit_box()]).unwrap();
    engine.tick();
    engine.sleep(body).unwrap();
    engine.set_pull(body, vec2(0.0, 6.0), 0.0).unwrap();
    engine.tick();
    assert!(engine.is_asleep(body).unwrap());
    engine.wake(body).unwrap();
    engine.tick();
    // 6 m/s² for 1/60 s.
    let rise = engine.state(body).unwrap().velocity.0.y;
    assert!((rise - 0.1).abs() < 1e-9, "{rise} m/s");
}
