//! Fat boxes, late pieces and sorts decide what a search costs, and nothing of what it finds.

use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Rot, Vec2, vec2};

use super::{Random, floor, weightless};
use crate::{BodyId, BodyInput, BodyKind, Engine, Mixed, PieceInput, PieceIx, Settings};

#[test]
fn finds_the_pairs_that_asking_all_finds() {
    let mut count = 0;
    for seed in 0..6 {
        let mut random = Random::new(50 + seed);
        let mut engine = Engine::new(Settings::default()).unwrap();
        let spread = [3.0, 9.0][random.below(2)];
        if seed % 2 == 0 {
            floor(&mut engine);
        }
        let ground = PieceInput::new(ConvexPolygon::rectangle(40.0, 1.0).unwrap());
        let below = BodyInput::fixed().at(vec2(0.0, -12.0));
        engine.insert(below, &[ground]).unwrap();
        let mut ids: Vec<BodyId> = Vec::new();
        for step in 0..700 {
            match random.below(30) {
                0..6 if ids.len() < 40 => {
                    let pieces = [random.piece(), random.piece()];
                    let body = random.body(&pieces[0], spread);
                    let pieces = &pieces[..1 + random.below(2)];
                    ids.push(engine.insert(body, pieces).unwrap());
                }
                6 if ids.len() > 30 => {
                    engine
                        .remove(ids.swap_remove(random.below(ids.len())))
                        .unwrap();
                }
                7 if !ids.is_empty() => {
                    let id = ids[random.below(ids.len())];
                    engine
                        .set_velocity(id, vec2(30.0 * random.signed(), 2.0), 0.0)
                        .unwrap();
                }
                8 if !ids.is_empty() => {
                    let id = ids[random.below(ids.len())];
                    engine.set_pose(id, random.pose(spread)).unwrap();
                }
                9 if !ids.is_empty() => engine.sleep(ids[random.below(ids.len())]).unwrap(),
                10 => {
                    let piece = random.piece();
                    let body = BodyInput::fixed().at(random.pose(spread).position);
                    ids.push(engine.insert(body, &[piece]).unwrap());
                }
                11 => engine.prepare_queries(),
                _ => {}
            }
            engine.pose_boxes();
            let tick = engine.settings.tick;
            let all = engine.broad.all_pairs(&engine.bodies, &engine.pieces, tick);
            engine.broad.found.clear();
            engine.find_contacts(&Mixed);
            let found = engine.broad.found.iter();
            let mut found: Vec<_> = found.map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
            found.sort_unstable();
            assert_eq!(found, all, "seed {seed}, step {step}");
            count += all.len();
            engine.advance();
            engine.finish(&Mixed);
        }
    }
    assert!(count > 10_000, "{count}");
}

/// Fast bodies touch nothing of what is left out of their search.
#[test]
fn what_a_fast_body_is_not_searched_against_it_does_not_touch() {
    let (mut left_out, mut stopped) = (0, 0);
    for seed in 0..40 {
        let mut random = Random::new(900 + seed);
        let mut engine = Engine::new(weightless()).unwrap();
        let spread = [2.0, 4.0, 8.0][random.below(3)];
        let mut ids: Vec<BodyId> = Vec::new();
        for step in 0..200 {
            match random.below(12) {
                0..4 if ids.len() < 30 => {
                    let piece = random.piece();
                    let mut body = random.body(&piece, spread);
                    if random.below(4) == 0 {
                        body.kind = BodyKind::Fixed;
                    }
                    ids.push(engine.insert(body, &[piece]).unwrap());
                }
                4..8 if !ids.is_empty() => {
                    let velocity = vec2(random.signed(), random.signed()) * 60.0;
                    let spin = 100.0 * random.signed();
                    let id = ids[random.below(ids.len())];
                    engine.set_velocity(id, velocity, spin).unwrap();
                }
                8 if !ids.is_empty() => {
                    let id = ids.swap_remove(random.below(ids.len()));
                    engine.remove(id).unwrap();
                }
                9 if !ids.is_empty() => {
                    let id = ids[random.below(ids.len())];
                    engine.set_pose(id, random.pose(spread)).unwrap();
                }
                10 if !ids.is_empty() => engine.sleep(ids[random.below(ids.len())]).unwrap(),
                _ => {}
            }
            engine.find_contacts(&Mixed);
            engine.advance();
            // What comes before the search is in no list yet.
            if random.below(4) == 0 && ids.len() < 30 {
                let piece = random.piece();
                let mut body = random.body(&piece, spread);
                body.kind = [BodyKind::Fixed, BodyKind::Dynamic][random.below(2)];
                ids.push(engine.insert(body, &[piece]).unwrap());
            }
            let [others, touches] = engine.left_out(&Mixed);
            assert_eq!(touches, 0, "seed {seed}, step {step}");
            left_out += others;
            stopped += engine.stop_fast(engine.law.h, &Mixed).len();
            engine.finish(&Mixed);
        }
    }
    assert!(left_out > 100_000 && stopped > 100, "{left_out}, {stopped}");
}

/// Where a disc is beside a plank, it stays a margin away from it in the whole tick.
#[test]
fn what_is_beside_a_plank_stays_off_it() {
    let mut random = Random::new(17);
    let (mut beside, mut overlapping) = (0, 0);
    for _ in 0..4000 {
        let mut engine = Engine::new(weightless()).unwrap();
        let half = vec2(1.0 + 4.0 * random.next(), 0.1 + 0.3 * random.next());
        let shape = ConvexPolygon::rectangle(2.0 * half.x, 2.0 * half.y).unwrap();
        let mut plank = BodyInput::new(BodyKind::Kinematic);
        (plank.pose, plank.spin) = (random.pose(1.0), 5.0 * random.signed());
        plank.velocity = vec2(random.signed(), random.signed()) * 10.0;
        engine.insert(plank, &[PieceInput::new(shape)]).unwrap();
        let radius = 0.05 + 0.2 * random.next();
        let piece = PieceInput::new(Circle::new(radius).unwrap());
        let mut disc = random.body(&piece, 4.0);
        disc.velocity *= 10.0;
        engine.insert(disc, &[piece]).unwrap();
        engine.pose_boxes();
        let Settings { tick, margin, .. } = engine.settings;
        let boxes = &engine.pieces.boxes;
        overlapping += u32::from(boxes[0].overlaps(boxes[1]));
        if !engine.pieces.are_beside(PieceIx(0), PieceIx(1), tick) {
            continue;
        }
        beside += u32::from(boxes[0].overlaps(boxes[1]));
        for k in 0..=16 {
            let time = tick * f64::from(k) / 16.0;
            let rotation = plank.pose.rotation * Rot::from_angle(plank.spin * time);
            let way = disc.pose.position - plank.pose.position;
            let way = rotation.inverse() * (way + (disc.velocity - plank.velocity) * time);
            let out = (way.abs() - half).max(Vec2::ZERO).length() - radius;
            let extent = 2.0 * radius.min(half.y);
            assert!(out >= margin * extent, "{out} m after {time} s");
        }
    }
    assert!(10 * beside > overlapping, "{beside} of {overlapping}");
}
