//! What a caller does between sub-steps, and what it asks for.

use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Segment};
use carom_math::{Pose, Rot, Vec2, vec2};

use super::{floor, pyramid, unit_box, weightless, without_sleep};
use crate::{
    BodyInput, Engine, EngineError, Material, Mixed, PairRules, PieceInput, Settings, Surface,
    Touch,
};

fn disc(radius: f64, restitution: f64) -> PieceInput {
    let material = Material {
        friction: 0.0,
        restitution,
    };
    PieceInput::new(Circle::new(radius).unwrap()).with_material(material)
}

#[test]
fn a_tick_is_its_sub_steps() {
    let mut engines = [0, 1].map(|_| {
        let mut engine = Engine::new(Settings::default()).unwrap();
        floor(&mut engine);
        pyramid(&mut engine, 4, Vec2::ZERO);
        engine
    });
    let [whole, cut] = &mut engines;
    for _ in 0..40 {
        whole.tick();
        for _ in 0..cut.settings().substeps {
            cut.substep(&Mixed);
        }
        assert!(cut.is_at_tick());
        assert_eq!(whole.bodies.lines, cut.bodies.lines);
    }
}

/// Pieces of tags 1 and 2 do not meet, and one of tag 3 is a belt that carries to the right.
struct Rules;

impl PairRules for Rules {
    fn surface(&self, tags: [u64; 2], materials: [Material; 2]) -> Option<Surface> {
        let surface = Mixed.surface(tags, materials)?;
        let belt = if tags.contains(&3) { -2.0 } else { 0.0 };
        let apart = tags == [1, 2] || tags == [2, 1];
        (!apart).then_some(Surface {
            tangent_speed: belt,
            ..surface
        })
    }
}

#[test]
fn rules_filter_pairs_and_set_belt_speeds() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let belt = PieceInput::new(HalfPlane::new(Vec2::ZERO, Vec2::Y).unwrap()).tagged(3);
    engine.insert(BodyInput::fixed(), &[belt]).unwrap();
    let lower = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 0.5));
    let lower = engine.insert(lower, &[unit_box().tagged(1)]).unwrap();
    let upper = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.1, 1.6));
    let upper = engine.insert(upper, &[unit_box().tagged(2)]).unwrap();
    for _ in 0..180 {
        engine.tick_by(&Rules);
    }
    for id in [lower, upper] {
        let (pose, (v, _)) = (engine.pose(id).unwrap(), engine.velocity(id).unwrap());
        assert!((pose.position.y - 0.5).abs() < 1e-3, "{pose:?}");
        assert!((v.x - 2.0).abs() < 1e-3, "{v}");
    }
    // A contact that they are let have takes the place of the overlap.
    engine.resurface(lower, &Mixed).unwrap();
    assert_eq!(engine.contacts_of(lower).unwrap().count(), 1);
}

/// `v' = g − c v` has `v = g/c + (v₀ − g/c) e^(−ct)`.
#[test]
fn damping_follows_its_law() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let mut input = BodyInput::dynamic(2.0, 1.0).moving(vec2(3.0, 0.0), 5.0);
    input.damping = [0.7, 0.4];
    let id = engine.insert(input, &[unit_box()]).unwrap();
    for _ in 0..120 {
        engine.tick();
    }
    let (v, w) = engine.velocity(id).unwrap();
    let left = carom_math::trig::exp(-1.4);
    let terminal = -9.81 / 0.7;
    assert!((v.x - 3.0 * left).abs() < 1e-12, "{v}");
    assert!((v.y - terminal * (1.0 - left)).abs() < 1e-12, "{v}");
    assert!((w - 5.0 * carom_math::trig::exp(-0.8)).abs() < 1e-12, "{w}");
    let x = 3.0 / 0.7 * (1.0 - left);
    let off = (engine.pose(id).unwrap().position.x - x).abs();
    assert!(off < 1e-5, "{off} m beside its law");
}

#[test]
fn begins_and_ends_of_touch_take_turns() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let ball = BodyInput::dynamic(1.0, 0.1).at(vec2(0.0, 1.0));
    let ball = engine.insert(ball, &[disc(0.2, 0.6).tagged(7)]).unwrap();
    let (mut touches, mut told) = (false, 0);
    let mut list = Vec::new();
    for k in 0..240 {
        engine.tick();
        if k == 200 {
            engine.set_pose(ball, Pose::at(vec2(0.0, 5.0))).unwrap();
        }
        list.clear();
        engine.touches(&mut list);
        for Touch { tags, begins } in &list {
            assert_eq!(*tags, [0, 7]);
            assert!(*begins != touches);
            (touches, told) = (*begins, told + 1);
        }
    }
    assert!(told >= 2 && !touches, "{told}");
}

#[test]
fn what_was_inserted_asleep_wakes_with_what_it_touches() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let at = |x: f64, y: f64| BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(x, y));
    let mut insert = |x, y| {
        let id = engine.insert(at(x, y), &[unit_box()]).unwrap();
        engine.sleep(id).unwrap();
        id
    };
    let pile: Vec<_> = (0..4).map(|k| insert(0.0, 0.5 + f64::from(k))).collect();
    let beside = insert(1.5, 0.5);
    engine.tick();
    assert_eq!(engine.awake_count(), 0);
    engine.wake(pile[2]).unwrap();
    assert!(pile.iter().all(|id| !engine.is_asleep(*id).unwrap()));
    assert!(engine.is_asleep(beside).unwrap());
    let mut woken = 0;
    engine.sleep_changes(|_, asleep| woken += usize::from(!asleep));
    assert_eq!(woken, 4);
    // A wall beside the sleeper lets it sleep, one in it does not.
    for (x, wakes) in [(2.6, false), (2.2, true)] {
        let wall = PieceInput::new(ConvexPolygon::rectangle(1.0, 1.0).unwrap());
        let wall = engine.insert(BodyInput::fixed().at(vec2(x, 0.5)), &[wall]);
        assert_eq!(engine.is_asleep(beside).unwrap(), !wakes);
        engine.remove(wall.unwrap()).unwrap();
    }
}

/// Struck within a sub-step, a body looks for what it may meet only at the next: a wall of 1 cm lay in between.
#[test]
fn what_is_struck_within_a_sub_step_passes_through_nothing() {
    for speed in [60.0, 365.0, 3e3] {
        let mut engine = Engine::new(weightless()).unwrap();
        let wall = PieceInput::new(ConvexPolygon::rectangle(0.01, 4.0).unwrap());
        engine.insert(BodyInput::fixed(), &[wall]).unwrap();
        let still = BodyInput::dynamic(1.0, 1e-4).at(vec2(-0.1, 0.0));
        let still = engine.insert(still, &[disc(0.01, 1.0)]).unwrap();
        let fast = BodyInput::dynamic(1.0, 1e-4).at(vec2(-2.0, 0.0));
        let fast = fast.moving(vec2(speed, 0.0), 0.0);
        let fast = engine.insert(fast, &[disc(0.01, 1.0)]).unwrap();
        for _ in 0..30 {
            engine.tick();
            for id in [still, fast] {
                let x = engine.pose(id).unwrap().position.x;
                assert!(x < -0.01, "{speed} m/s: {x}");
            }
        }
    }
}

/// A caller that sets a body moving in the middle of a sub-step carries it from there.
#[test]
fn what_is_carried_stops_at_what_is_in_its_way() {
    let mut engine = Engine::new(weightless()).unwrap();
    let wall = PieceInput::new(ConvexPolygon::rectangle(0.01, 4.0).unwrap());
    engine.insert(BodyInput::fixed(), &[wall]).unwrap();
    let ball = BodyInput::dynamic(1.0, 1e-4).at(vec2(0.5, 0.0));
    let ball = engine.insert(ball, &[disc(0.01, 0.0)]).unwrap();
    engine.carry(ball, Pose::at(vec2(-0.5, 0.0))).unwrap();
    assert_eq!(engine.stop_fast(1e-3, &Mixed), [ball]);
    let x = engine.pose(ball).unwrap().position.x;
    assert!((x + 0.015).abs() < 1e-6, "{x}");
}

/// What overlapped went on until its core touched, 5e-5 m deeper each time, and once that did so at the start, through the wall.
#[test]
fn what_is_carried_into_what_it_touches_stays_where_it_is() {
    for deep in [0.0, 1e-6, 1e-5, 1e-4, 1e-3] {
        let mut engine = Engine::new(weightless()).unwrap();
        let wall = PieceInput::new(ConvexPolygon::rectangle(0.01, 4.0).unwrap());
        engine.insert(BodyInput::fixed(), &[wall]).unwrap();
        let ball = BodyInput::dynamic(1.0, 1e-4).at(vec2(0.5, 0.3));
        let ball = engine.insert(ball, &[disc(0.01, 0.0)]).unwrap();
        let from = vec2(-0.015 + deep, 0.0);
        engine.carry(ball, Pose::at(from)).unwrap();
        assert_eq!(engine.stop_fast(1e-3, &Mixed), [ball]);
        let at = engine.pose(ball).unwrap().position;
        assert!((at.x - from.x).abs() < 1e-6, "{deep} m deep: {at}");
    }
}

/// A plate of 1 mm by 0.2 m that went by 2.4 mm went by less than an eighth of its extent, which is an eighth of its length.
#[test]
fn what_is_carried_by_more_than_it_is_thick_stops_too() {
    let mut engine = Engine::new(weightless()).unwrap();
    let wall = PieceInput::new(Segment::new(vec2(-1.0, 0.0), vec2(1.0, 0.0)).unwrap());
    engine.insert(BodyInput::fixed(), &[wall]).unwrap();
    let plate = PieceInput::new(ConvexPolygon::rectangle(0.2, 1e-3).unwrap());
    let body = BodyInput::dynamic(1.0, 1e-2).at(vec2(0.0, -1.9e-3));
    let plate = engine.insert(body, &[plate]).unwrap();
    engine.carry(plate, Pose::at(vec2(0.0, 5e-4))).unwrap();
    assert_eq!(engine.stop_fast(1e-4, &Mixed), [plate]);
    let y = engine.pose(plate).unwrap().position.y;
    assert!((y - 5e-4).abs() < 1e-6, "{y}");
}

/// One sweep a sub-step leaves 20/21 of the error: the load came back at 1.5 m/s of 4.4.
#[test]
fn a_heavy_load_comes_to_rest_on_a_light_box() {
    for ratio in [20.0, 100.0] {
        let mut engine = Engine::new(Settings::default()).unwrap();
        floor(&mut engine);
        let light = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 0.5));
        engine.insert(light, &[unit_box()]).unwrap();
        let heavy = BodyInput::dynamic(ratio, ratio / 6.0).at(vec2(0.0, 2.5));
        let heavy = engine.insert(heavy, &[unit_box()]).unwrap();
        for _ in 0..300 {
            engine.tick();
            let (v, _) = engine.velocity(heavy).unwrap();
            assert!(v.y < 0.01, "ratio {ratio}: up at {} m/s", v.y);
        }
        let y = engine.pose(heavy).unwrap().position.y;
        assert!((y - 1.5).abs() < 0.02, "ratio {ratio}: {y}");
    }
}

/// Restitution along the normal and friction together may give more than a blow took.
#[test]
fn a_spinning_elastic_box_gains_nothing_from_friction() {
    for k in 0..20 {
        let mut engine = Engine::new(without_sleep()).unwrap();
        floor(&mut engine);
        let material = Material {
            friction: 1.2,
            restitution: 1.0,
        };
        let spin = -2.0 - 0.3 * f64::from(k);
        let input = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 1.2));
        let input = input.moving(vec2(-1.1, 0.0), spin);
        let piece = unit_box().with_material(material);
        engine.insert(input, &[piece]).unwrap();
        let energy = |engine: &Engine| {
            let (kinetic, potential) = engine.energy();
            kinetic + potential
        };
        let first = energy(&engine);
        let mut before = first;
        for _ in 0..300 {
            engine.tick();
            let now = energy(&engine);
            assert!(now <= before + 2e-3 * first, "{spin}: {before} J, {now} J");
            before = now;
        }
        assert!(before <= first, "{spin}: {first} J became {before} J");
    }
}

/// A motion of the sub-step before was searched once more when a caller carried another body, though its own had been taken out.
#[test]
fn a_motion_is_searched_once() {
    let mut engine = Engine::new(weightless()).unwrap();
    floor(&mut engine);
    let fast = BodyInput::dynamic(1.0, 1e-4).at(vec2(0.0, 1.0));
    let fast = fast.moving(vec2(0.0, -300.0), 0.0);
    let fast = engine.insert(fast, &[disc(0.01, 0.0)]).unwrap();
    engine.substep(&Mixed);
    engine.remove(fast).unwrap();
    let wall = engine.insert(BodyInput::fixed(), &[unit_box()]).unwrap();
    assert_eq!(engine.stop_fast(1e-3, &Mixed), []);
    engine.tick();
    assert!(engine.pose(wall).unwrap().position == Vec2::ZERO);
}

/// A body with a velocity set after its rows were found crosses one that flies as foreseen, whichever was inserted first.
#[test]
fn a_motion_that_rows_do_not_know_meets_one_that_they_do() {
    for struck_first in [true, false] {
        let mut engine = Engine::new(weightless()).unwrap();
        let mut insert = |at: Vec2, velocity: Vec2| {
            let input = BodyInput::dynamic(1.0, 1e-3).at(at).moving(velocity, 0.0);
            engine.insert(input, &[disc(0.1, 0.0)]).unwrap()
        };
        let (flies, struck);
        if struck_first {
            struck = insert(vec2(-0.5, 0.0), Vec2::ZERO);
            flies = insert(vec2(0.0, -0.5), vec2(0.0, 300.0));
        } else {
            flies = insert(vec2(0.0, -0.5), vec2(0.0, 300.0));
            struck = insert(vec2(-0.5, 0.0), Vec2::ZERO);
        }
        engine.find_contacts(&Mixed);
        engine.set_velocity(struck, vec2(300.0, 0.0), 0.0).unwrap();
        engine.substeps();
        let x = engine.pose(flies).unwrap().position.x;
        assert!(x > 0.1, "it was not met: x = {x} m");
    }
}

/// The bound was infinite, so that each query went through all pieces.
#[test]
fn a_query_finds_what_is_near_and_not_what_is_far() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    for k in 0..100 {
        let at = vec2(3.0 * f64::from(k), 0.5);
        engine
            .insert(BodyInput::dynamic(1.0, 1.0 / 6.0).at(at), &[unit_box()])
            .unwrap();
    }
    engine.tick();
    let mut found = 0;
    let bounds = carom_geometry::Aabb::new(vec2(-1.0, 0.0), vec2(4.0, 1.0));
    engine.query(bounds, |_| found += 1);
    assert!((2..8).contains(&found), "{found} of 101 pieces");
}

#[test]
fn a_query_without_end_finds_nothing_that_was_removed() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let [kept, gone] = [0.0, 3.0].map(|x| {
        let input = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(x, 5.0));
        let tag = if x == 0.0 { 7 } else { 8 };
        engine.insert(input, &[unit_box().tagged(tag)]).unwrap()
    });
    engine.tick();
    engine.remove(gone).unwrap();
    let everywhere = carom_geometry::Aabb::new(Vec2::NEG_INFINITY, Vec2::INFINITY);
    let mut found = Vec::new();
    engine.query(everywhere, |tag| found.push(tag));
    assert_eq!(found, [7]);
    assert!(engine.pose(kept).is_ok());
}

/// Before, each of the queries after bodies came, went or woke looked at all bodies awake.
#[test]
fn prepared_queries_find_what_others_find() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let insert = |engine: &mut Engine, k: u32| {
        let at = vec2(1.5 * f64::from(k), 0.5);
        let input = BodyInput::dynamic(1.0, 1.0 / 6.0).at(at);
        engine.insert(input, &[unit_box()]).unwrap()
    };
    let first: Vec<_> = (0..20).map(|k| insert(&mut engine, k)).collect();
    engine.tick();
    engine.remove(first[4]).unwrap();
    for k in 20..25 {
        insert(&mut engine, k);
    }
    let found = |engine: &Engine| -> Vec<usize> {
        let windows = (0..40).map(|k| {
            let low = vec2(f64::from(k), 0.0);
            carom_geometry::Aabb::new(low, low + vec2(1.0, 1.0))
        });
        let count = |bounds| {
            let mut count = 0;
            engine.query_awake(bounds, |_| count += 1);
            count
        };
        windows.map(count).collect()
    };
    let unprepared = found(&engine);
    engine.prepare_queries();
    assert_eq!(found(&engine), unprepared);
    assert!(unprepared.iter().sum::<usize>() >= 24);
}

/// Before, a body that went elsewhere than was foreseen was compared with the boxes that others had at the tick.
#[test]
fn bodies_that_turn_to_each_other_in_different_sub_steps_of_a_tick_meet() {
    let mut engine = Engine::new(weightless()).unwrap();
    let mut insert = |at: Vec2| {
        let input = BodyInput::dynamic(1.0, 1.0 / 6.0).at(at);
        engine.insert(input, &[unit_box()]).unwrap()
    };
    let [a, b] = [vec2(0.0, 0.0), vec2(1.62, 0.0)].map(&mut insert);
    for k in 0..200 {
        insert(vec2(3.0 * f64::from(k), 50.0));
    }
    engine.tick();
    let speed = 30.0; // m/s
    engine.substep(&Mixed);
    engine.set_velocity(a, vec2(speed, 0.0), 0.0).unwrap();
    engine.substep(&Mixed);
    engine.set_velocity(b, vec2(-speed, 0.0), 0.0).unwrap();
    while !engine.is_at_tick() {
        engine.substep(&Mixed);
    }
    let [a, b] = [a, b].map(|id| engine.state(id).unwrap().pose.position.x);
    assert!(
        b - a > 0.99,
        "{} m deep in each other at the tick",
        1.0 - (b - a)
    );
}

/// Such a body was taken, and a tick did not end where a piece of it has more than twelve corners.
#[test]
fn a_pose_that_is_turned_by_no_number_is_refused() {
    let mut engine = Engine::new(weightless()).unwrap();
    let pose = Pose::new(Vec2::ZERO, Rot::from_angle(f64::NAN));
    let mut body = BodyInput::dynamic(1.0, 1.0);
    let id = engine.insert(body, &[unit_box()]).unwrap();
    body.pose = pose;
    let refused = [
        engine.insert(body, &[unit_box()]).map(|_| ()),
        engine.set_pose(id, pose),
        engine.shift(id, pose),
    ];
    for result in refused {
        assert!(matches!(result, Err(EngineError::Value { .. })));
    }
    engine.sleep(id).unwrap();
    assert!(engine.shift(id, pose).is_err());
    assert!(engine.is_asleep(id).unwrap());
    assert_eq!(engine.pose(id).unwrap(), Pose::IDENTITY);
}
