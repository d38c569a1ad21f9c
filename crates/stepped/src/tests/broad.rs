//! Fat boxes, late pieces and sorts decide what a search costs, and nothing of what it finds.

use carom_geometry::ConvexPolygon;
use carom_math::vec2;

use super::{Random, floor};
use crate::{BodyId, BodyInput, Engine, Mixed, PieceInput, Settings};

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
