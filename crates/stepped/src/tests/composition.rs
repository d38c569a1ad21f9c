//! Two scenes far apart in one engine have the bits of each alone.

use carom_geometry::{Circle, ConvexPolygon, Shape};
use carom_math::{Pose, Rot, vec2};

use super::laws::bits;
use super::{Random, floor};
use crate::{BodyId, BodyInput, Engine, Material, Mixed, PieceInput, Settings};

/// Calls between sub-steps, and what they change of contacts, are felt by no other scene: extra sweeps of all groups were gathered
/// anew when a contact of a heavy body came anywhere.
#[test]
fn far_scenes_do_not_feel_each_others_calls() {
    let act = |engine: &mut Engine, random: &mut Random, ids: &mut Vec<BodyId>, x: f64| match random
        .below(40)
    {
        0 | 1 if ids.len() < 20 => {
            let piece = random.piece();
            let mut body = random.body(&piece, 1.5);
            body.pose.position += vec2(x, 4.0);
            let times = [1.0, 1.0, 30.0, 1000.0][random.below(4)];
            (body.mass, body.inertia) = (times * body.mass, times * body.inertia);
            ids.push(engine.insert(body, &[piece]).unwrap());
        }
        2 if ids.len() > 3 => {
            let id = ids.swap_remove(random.below(ids.len()));
            engine.remove(id).unwrap();
        }
        3 if !ids.is_empty() => {
            let id = ids[random.below(ids.len())];
            let velocity = vec2(5.0 * random.signed(), 2.0);
            engine.set_velocity(id, velocity, 0.0).unwrap();
        }
        4 if !ids.is_empty() && random.below(4) == 0 => {
            let pose = Pose::new(
                vec2(x + random.signed(), 3.0),
                Rot::from_angle(random.signed()),
            );
            let id = ids[random.below(ids.len())];
            engine.set_pose(id, pose).unwrap();
        }
        _ => {}
    };
    for seed in 0..12 {
        let run = |beside: bool| {
            let mut engine = Engine::new(Settings::default()).unwrap();
            floor(&mut engine);
            let mut random = [900, 7000].map(|first| Random::new(first + seed));
            let mut ids = [Vec::new(), Vec::new()];
            let mut seen = Vec::new();
            for _ in 0..600 {
                act(&mut engine, &mut random[0], &mut ids[0], 0.0);
                if beside {
                    act(&mut engine, &mut random[1], &mut ids[1], 1024.0);
                }
                engine.substep(&Mixed);
                seen.push(bits(&engine, &ids[0]));
            }
            seen
        };
        let [alone, beside] = [false, true].map(run);
        let part = alone.iter().zip(&beside).position(|(a, b)| a != b);
        assert_eq!(part, None, "seed {seed}");
    }
}

/// Two scenes a kilometre apart differed by where restitution was looked for (blocks of eight contacts), by the order of a sum
/// over bodies that bounce together, by rounding wherever some body was damped, and by one tolerance of all fixed bodies.
#[test]
fn far_scenes_do_not_feel_each_others_bodies() {
    let heap = |random: &mut Random, e: f64, damping: f64| {
        let bodies = (0..4 + random.below(12)).map(|k| {
            let piece = random.piece();
            let mut body = random.body(&piece, 2.0);
            body.pose.position.y = 0.8 + 1.3 * k as f64;
            body.damping = [damping * random.below(2) as f64; 2];
            let restitution = e * random.below(2) as f64;
            let material = Material {
                restitution,
                ..Material::default()
            };
            (body, piece.with_material(material))
        });
        bodies.collect::<Vec<_>>()
    };
    let single = |random: &mut Random, shape: Shape, height: f64| {
        let piece = PieceInput::new(shape);
        let mut body = random.body(&piece, 1.0);
        body.pose.position.y = height;
        vec![(body, piece)]
    };
    let scenes = |case: usize, seed: u64| {
        let random = &mut Random::new(1000 * (1 + case as u64) + seed);
        match case {
            0 => [0; 2].map(|_| heap(random, 0.6, 0.0)),
            1 => [0.0, 0.5].map(|damping| heap(random, 0.0, damping)),
            _ => {
                let small = ConvexPolygon::regular(3, 0.1).unwrap();
                let large = Circle::new(0.75).unwrap();
                [
                    single(random, small.into(), 2.5),
                    single(random, large.into(), 0.9),
                ]
            }
        }
    };
    let run = |scenes: &[Vec<(BodyInput, PieceInput)>], substeps: u32| {
        let settings = Settings {
            substeps,
            ..Settings::default()
        };
        let mut engine = Engine::new(settings).unwrap();
        let ground = PieceInput::new(ConvexPolygon::rectangle(30.0, 1.0).unwrap());
        let mut first = Vec::new();
        for (scene, x) in scenes.iter().zip([0.0, 1024.0]) {
            let floor = BodyInput::fixed().at(vec2(x, -0.5));
            engine
                .insert(floor, core::slice::from_ref(&ground))
                .unwrap();
            for (mut body, piece) in scene.iter().cloned() {
                body.pose.position.x += x;
                let id = engine.insert(body, &[piece]).unwrap();
                if x == 0.0 {
                    first.push(id);
                }
            }
        }
        let mut seen = Vec::new();
        for _ in 0..120 {
            engine.tick();
            seen.push(bits(&engine, &first));
        }
        seen
    };
    for (case, name) in ["restitution", "damping", "fixed bodies"]
        .iter()
        .enumerate()
    {
        for seed in 0..40 {
            let (scenes, substeps) = (scenes(case, seed), if seed % 2 == 0 { 2 } else { 5 });
            let [alone, beside] = [1, 2].map(|count| run(&scenes[..count], substeps));
            let part = alone.iter().zip(&beside).position(|(a, b)| a != b);
            assert_eq!(part, None, "{name}, seed {seed}");
        }
    }
}

/// Two heaps a kilometre apart in one engine have the bits of each alone, inserted in turn or one after the other.
#[test]
fn far_scenes_do_not_know_each_other() {
    let corner = |which: usize| vec2(1000.0 * which as f64, 0.0);
    let body = |random: &mut Random, which: usize| {
        let piece = random.piece();
        let mut body = random.body(&piece, 2.0);
        body.pose.position += corner(which) + vec2(0.0, 3.0);
        (body, piece)
    };
    let fill = |engine: &mut Engine, order: &[usize]| {
        let ground = PieceInput::new(ConvexPolygon::rectangle(30.0, 1.0).unwrap());
        for which in [0, 1] {
            if order.contains(&which) {
                let at = corner(which) - vec2(0.0, 0.5);
                engine
                    .insert(BodyInput::fixed().at(at), core::slice::from_ref(&ground))
                    .unwrap();
            }
        }
        let mut randoms = [Random::new(11), Random::new(12)];
        let mut ids = [Vec::new(), Vec::new()];
        for &which in order {
            let (body, piece) = body(&mut randoms[which], which);
            ids[which].push(engine.insert(body, &[piece]).unwrap());
        }
        ids
    };
    let run = |order: &[usize]| {
        let mut engine = Engine::new(Settings::default()).unwrap();
        let ids = fill(&mut engine, order);
        for tick in 0..200 {
            engine.tick();
            if tick == 100 {
                for ids in &ids {
                    if let Some(id) = ids.get(3) {
                        engine.set_velocity(*id, vec2(0.0, 8.0), 1.0).unwrap();
                    }
                }
            }
        }
        ids.map(|ids| bits(&engine, &ids))
    };
    let [left, _] = run(&[0; 40]);
    let [_, right] = run(&[1; 40]);
    let in_turn: Vec<usize> = (0..80).map(|k| k % 2).collect();
    let one_by_one: Vec<usize> = (0..80).map(|k| 1 - k / 40).collect();
    for order in [in_turn, one_by_one] {
        let both = run(&order);
        assert_eq!(both[0], left);
        assert_eq!(both[1], right);
    }
}
