//! What a caller changes of a body after it was inserted acts as if it had been inserted so, in each mode.

use carom_dynamics::{
    BodyDef, BodyError, BodyId, BodyKind, EventKind, Material, Mode, PairMaterial, Settings, World,
};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

pub(crate) const MODES: [Mode; 3] = [Mode::Hybrid, Mode::Exact, Mode::Stepped];

pub(crate) fn world(mode: Mode, gravity: Vec2) -> World {
    let settings = Settings {
        mode,
        gravity,
        ..Settings::default()
    };
    World::new(settings).expect("valid settings")
}

pub(crate) fn run(world: &mut World, steps: usize) {
    for _ in 0..steps {
        world.step(1.0 / 60.0);
    }
}

fn height(world: &World, id: BodyId) -> f64 {
    world.body(id).expect("it is there").centre().y
}

#[test]
fn gravity_that_is_changed_acts_from_then_on() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let ball = put(&mut world, BodyDef::dynamic(), disc(0.1), surface(0.0, 0.0));
        run(&mut world, 60);
        world.set_gravity(vec2(0.0, 10.0)).expect("finite");
        run(&mut world, 60);
        // 10/2 m down and as fast as 10 m/s, then that way less 10/2 m.
        let y = height(&world, ball);
        assert!((y + 10.0).abs() < 1e-9, "{mode:?}: {y}");
        let energy = world.energy();
        assert!(
            energy.residual().abs() < 1e-9 * energy.kinetic.max(1.0),
            "{energy:?}"
        );
        assert!(world.set_gravity(vec2(0.0, f64::NAN)).is_err());
    }
}

#[test]
fn a_sleeping_pile_falls_up_when_gravity_turns() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
        put(&mut world, BodyDef::fixed(), floor, surface(0.0, 0.5));
        let boxes: Vec<_> = (0..3)
            .map(|k| {
                let at = BodyDef::dynamic().at(vec2(0.0, 0.5 + f64::from(k)));
                put(&mut world, at, block(1.0, 1.0), surface(0.0, 0.5))
            })
            .collect();
        run(&mut world, 120);
        assert!(
            boxes
                .iter()
                .all(|id| world.body(*id).is_some_and(|b| b.is_asleep())),
            "{mode:?}"
        );
        world.set_gravity(vec2(0.0, 10.0)).expect("finite");
        run(&mut world, 30);
        for (k, id) in boxes.iter().enumerate() {
            let y = height(&world, *id) - (0.5 + k as f64);
            assert!((y - 1.25).abs() < 0.03, "{mode:?}: box {k} rose by {y} m");
        }
    }
}

#[test]
fn a_mass_that_is_changed_shares_impulses_anew() {
    for mode in MODES {
        let mut world = world(mode, Vec2::ZERO);
        let at = |x: f64, v: f64| BodyDef::dynamic().at(vec2(x, 0.0)).moving(vec2(v, 0.0));
        let smooth = surface(1.0, 0.0);
        let one = put(&mut world, at(0.0, 1.0), disc(0.5), smooth);
        let other = put(&mut world, at(1.5, 0.0), disc(0.5), smooth);
        world.set_mass(other, 3.0, 1.0).expect("valid");
        world.set_mass(one, 1.0, 1.0).expect("valid");
        run(&mut world, 60);
        let v = world.body(one).expect("it is there").velocity().x;
        // (m − M)/(m + M) of the speed.
        let bound = if mode == Mode::Stepped { 0.02 } else { 1e-12 };
        assert!((v + 0.5).abs() < bound, "{mode:?}: {v}");
        let refused = world.set_mass(one, 0.0, 1.0);
        assert!(
            matches!(refused, Err(BodyError::NotPositive { field: "mass", .. })),
            "{refused:?}"
        );
    }
}

#[test]
fn material_scale_lock_and_tag_are_those_that_were_set() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
        put(&mut world, BodyDef::fixed(), floor, surface(0.0, 0.0));
        let slider = BodyDef::dynamic().at(vec2(0.0, 0.5)).moving(Vec2::X);
        let slider = put(&mut world, slider, block(1.0, 1.0), surface(0.0, 0.0));
        let balloon = BodyDef::dynamic().at(vec2(9.0, 5.0)).spinning(3.0);
        let balloon = put(&mut world, balloon, block(1.0, 1.0), surface(0.0, 0.0));
        world.set_gravity_scale(balloon, 0.0).expect("finite");
        world
            .set_locked_rotation(balloon, true)
            .expect("it is there");
        world.set_tag(balloon, 7).expect("it is there");
        run(&mut world, 60);
        let body = world.body(balloon).expect("it is there");
        assert_eq!(
            (body.centre().y, body.angular_velocity(), body.tag()),
            (5.0, 0.0, 7)
        );
        let x = world.body(slider).expect("it is there").centre().x;
        assert!((x - 1.0).abs() < 1e-6, "{mode:?}: {x}");
        // Materials mix by the root of the product.
        let rough = Material {
            friction: 1.0,
            restitution: 0.0,
            ..Material::default()
        };
        world.set_material(slider, 0, rough).expect("it is there");
        run(&mut world, 6);
        let v = world.body(slider).expect("it is there").velocity().x;
        assert!((v - 1.0).abs() < 1e-6, "{mode:?}: the floor is smooth, {v}");
        let ids: Vec<_> = world.bodies().map(|body| body.id()).collect();
        world.set_material(ids[0], 0, rough).expect("it is there");
        run(&mut world, 60);
        let v = world.body(slider).expect("it is there").velocity().x;
        assert!(v.abs() < 1e-6, "{mode:?}: it slides on at {v} m/s");
        assert!(world.set_material(slider, 1, rough).is_err());
    }
}

#[test]
fn shapes_that_are_changed_collide() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
        put(&mut world, BodyDef::fixed(), floor, surface(0.0, 0.5));
        let body = BodyDef::dynamic().at(vec2(0.0, 0.5));
        let body = put(&mut world, body, block(1.0, 1.0), surface(0.0, 0.5));
        run(&mut world, 90);
        let small: Shape = ConvexPolygon::square(0.5).expect("a square").into();
        world
            .set_shapes(body, vec![(small, surface(0.0, 0.5))])
            .expect("valid");
        run(&mut world, 90);
        let known = world.body(body).expect("it is there");
        assert!(
            (known.centre().y - 0.25).abs() < 2e-3,
            "{mode:?}: {}",
            known.centre()
        );
        assert!((known.mass() - 0.25).abs() < 1e-15);
        assert_eq!(world.set_shapes(body, Vec::new()), Err(BodyError::NoShape));
        let energy = world.energy();
        assert!(energy.residual().abs() < 1e-9, "{mode:?}: {energy:?}");
    }
}

#[test]
fn two_bodies_that_do_not_collide_pass_and_collide_again() {
    for mode in MODES {
        let mut world = world(mode, Vec2::ZERO);
        let smooth = surface(1.0, 0.0);
        let ball = BodyDef::dynamic()
            .at(vec2(-2.0, 0.0))
            .moving(vec2(4.0, 0.0));
        let ball = put(&mut world, ball, disc(0.25), smooth);
        let wall = put(&mut world, BodyDef::fixed(), block(0.5, 5.0), smooth);
        world
            .set_pair_collides(ball, wall, false)
            .expect("both are there");
        run(&mut world, 60);
        let x = world.body(ball).expect("it is there").centre().x;
        assert!((x - 2.0).abs() < 1e-12, "{mode:?}: {x}");
        world
            .set_pair_collides(ball, wall, true)
            .expect("both are there");
        world
            .set_velocity(ball, vec2(-4.0, 0.0), 0.0)
            .expect("finite");
        run(&mut world, 60);
        let x = world.body(ball).expect("it is there").centre().x;
        assert!(x > 0.5 - 1e-3, "{mode:?}: it went through, {x}");
        assert_eq!(
            world.set_pair_collides(ball, ball, true),
            Err(BodyError::SameBody(ball))
        );
    }
}

#[test]
fn a_material_of_a_pair_is_taken_back() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
        let floor = put(&mut world, BodyDef::fixed(), floor, surface(0.0, 1.0));
        let slider = BodyDef::dynamic().at(vec2(0.0, 0.5)).moving(Vec2::X);
        let slider = put(&mut world, slider, block(1.0, 1.0), surface(0.0, 1.0));
        let smooth = PairMaterial {
            friction: 0.0,
            restitution: 0.0,
            tangent_speed: 0.0,
        };
        world
            .set_pair_material(slider, floor, smooth)
            .expect("both are there");
        run(&mut world, 30);
        let speed = |world: &World| world.body(slider).expect("it is there").velocity().x;
        assert!((speed(&world) - 1.0).abs() < 1e-6, "{mode:?}");
        world
            .clear_pair_material(slider, floor)
            .expect("both are there");
        run(&mut world, 30);
        assert!(speed(&world).abs() < 1e-6, "{mode:?}: {}", speed(&world));
    }
}

#[test]
fn a_sleeper_is_woken_by_hand_and_its_contacts_are_its_own() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
        let floor = put(&mut world, BodyDef::fixed(), floor, surface(0.0, 0.5));
        let [lower, upper] = [0.5, 1.5].map(|y| {
            let at = BodyDef::dynamic().at(vec2(0.0, y));
            put(&mut world, at, block(1.0, 1.0), surface(0.0, 0.5))
        });
        let mut begun = Vec::new();
        for _ in 0..120 {
            world.step(1.0 / 60.0);
            begun.extend(world.events().iter().filter_map(|event| match event.kind {
                EventKind::Begin { a, b, shapes } => Some(([a, b], shapes)),
                _ => None,
            }));
        }
        assert!(
            begun.contains(&([floor, lower], (0, 0))),
            "{mode:?}: {begun:?}"
        );
        assert!(
            begun.contains(&([lower, upper], (0, 0))),
            "{mode:?}: {begun:?}"
        );
        let touched = |id| {
            world
                .contacts_of(id)
                .map(|c| [c.a, c.b])
                .collect::<Vec<_>>()
        };
        assert_eq!(touched(floor), [[floor, lower]]);
        assert_eq!(touched(lower), [[floor, lower], [lower, upper]]);
        assert!(world.body(upper).is_some_and(|body| body.is_asleep()));
        world.wake_up(lower).expect("it is there");
        for id in [lower, upper] {
            assert!(
                world.body(id).is_some_and(|body| !body.is_asleep()),
                "{mode:?}"
            );
        }
        run(&mut world, 120);
        assert!(
            world.body(upper).is_some_and(|body| body.is_asleep()),
            "{mode:?}"
        );
    }
}

/// Boxes on a floor, on each other or as a pyramid: a tower of three is moved in closed form or by the engine (damped), a pyramid
/// of 21 by the engine.
pub(crate) fn boxes(world: &mut World, rows: u32, is_pyramid: bool, damping: f64) -> Vec<BodyId> {
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
    put(world, BodyDef::fixed(), floor, surface(0.0, 0.5));
    let mut ids = Vec::new();
    for row in 0..rows {
        let columns = if is_pyramid { rows - row } else { 1 };
        for column in 0..columns {
            let x = 1.1 * (f64::from(column) - 0.5 * f64::from(columns));
            let at = vec2(x, 0.5 + f64::from(row));
            let def = BodyDef::dynamic().at(at).damped(damping, damping);
            ids.push(put(world, def, block(1.0, 1.0), surface(0.0, 0.5)));
        }
    }
    ids
}

#[test]
fn a_body_that_may_not_sleep_keeps_its_island_awake() {
    for mode in MODES {
        for (rows, is_pyramid, damping) in [(3, false, 0.0), (3, false, 0.1), (6, true, 0.0)] {
            let case = format!("{mode:?}, {rows} rows, pyramid: {is_pyramid}, {damping}/s");
            let mut world = world(mode, vec2(0.0, -10.0));
            let pile = boxes(&mut world, rows, is_pyramid, damping);
            let beside = BodyDef::dynamic().at(vec2(-20.0, 0.5));
            let beside = put(&mut world, beside, block(1.0, 1.0), surface(0.0, 0.5));
            let asleep =
                |world: &World, id: BodyId| world.body(id).is_some_and(|body| body.is_asleep());
            let sleepers = |world: &World| pile.iter().filter(|id| asleep(world, **id)).count();
            let top = pile[pile.len() - 1];
            run(&mut world, 180);
            assert_eq!(sleepers(&world), pile.len(), "{case}");
            world.set_sleep_allowed(top, false).expect("it is there");
            assert_eq!(sleepers(&world), 0, "{case}: forbidding wakes");
            let mut slept = 0;
            for _ in 0..180 {
                world.step(1.0 / 60.0);
                let told = world.events().iter();
                slept += told
                    .filter(|event| matches!(event.kind, EventKind::Asleep(id) if id != beside))
                    .count();
            }
            assert_eq!((sleepers(&world), slept), (0, 0), "{case}");
            assert!(asleep(&world, beside), "{case}: another island sleeps");
            assert!(world.body(top).is_some_and(|body| !body.is_sleep_allowed()));
            world.set_sleep_allowed(top, true).expect("it is there");
            run(&mut world, 180);
            assert_eq!(sleepers(&world), pile.len(), "{case}: allowed again");
            let before = world.state_hash();
            world.set_sleep_allowed(top, true).expect("it is there");
            assert_eq!((world.state_hash(), sleepers(&world)), (before, pile.len()));
        }
    }
}

#[test]
fn a_body_that_may_not_sleep_does_not_start_asleep_nor_lets_others() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
        put(&mut world, BodyDef::fixed(), floor, surface(0.0, 0.5));
        let lower = BodyDef::dynamic().at(vec2(0.0, 0.5)).asleep();
        let lower = lower.with_sleep_allowed(false);
        let lower = put(&mut world, lower, block(1.0, 1.0), surface(0.0, 0.5));
        let upper = BodyDef::dynamic().at(vec2(0.0, 1.5));
        let upper = put(&mut world, upper, block(1.0, 1.0), surface(0.0, 0.5));
        let sleeps = |world: &World, id| world.body(id).is_some_and(|body| body.is_asleep());
        assert!(!sleeps(&world, lower), "{mode:?}");
        run(&mut world, 120);
        assert_eq!([lower, upper].map(|id| sleeps(&world, id)), [false; 2]);
        // What is not dynamic holds no island together, and keeps none awake.
        world.set_kind(lower, BodyKind::Fixed).expect("it is there");
        run(&mut world, 120);
        assert!(sleeps(&world, upper), "{mode:?}");
    }
}

#[test]
fn the_kind_that_a_body_has_changes_nothing() {
    for mode in MODES {
        let [asked, other] = [true, false].map(|asks| {
            let mut world = world(mode, vec2(0.0, -10.0));
            let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
            let floor = put(&mut world, BodyDef::fixed(), floor, surface(0.0, 0.5));
            // They land askew, one on the other.
            let ids = [0.7, 1.9, 3.1].map(|y| {
                let def = BodyDef::dynamic().at(vec2(0.1 * y, y)).turned(0.1 * y);
                put(&mut world, def, block(1.0, 1.0), surface(0.0, 0.5))
            });
            for _ in 0..200 {
                world.step(1.0 / 500.0);
                if asks {
                    let kinds = [
                        world.set_kind(floor, BodyKind::Fixed),
                        world.set_kind(ids[1], BodyKind::Dynamic),
                    ];
                    assert_eq!(kinds, [Ok(()), Ok(())]);
                }
            }
            world.state_hash()
        });
        assert_eq!(asked, other, "{mode:?}");
    }
}

#[test]
fn queries_name_all_that_is_asked_for() {
    let mut world = world(Mode::Hybrid, Vec2::ZERO);
    let ids: Vec<_> = (0..5)
        .map(|k| {
            let def = if k % 2 == 0 {
                BodyDef::fixed()
            } else {
                BodyDef::dynamic()
            };
            put(
                &mut world,
                def.at(vec2(2.0 * f64::from(k), 0.0)),
                disc(0.5),
                surface(0.0, 0.0),
            )
        })
        .collect();
    let hits = world.cast_ray_all(vec2(-1.0, 0.0), Vec2::X, 6.0);
    let met: Vec<_> = hits.iter().map(|hit| (hit.body, hit.distance)).collect();
    assert_eq!(met, [(ids[0], 0.5), (ids[1], 2.5), (ids[2], 4.5)]);
    let long: Shape = ConvexPolygon::rectangle(4.0, 0.1).expect("a box").into();
    let under = world.bodies_overlapping(&long, Pose::at(vec2(3.0, 0.0)));
    assert_eq!(under, [ids[1], ids[2]]);
    let disc: Shape = Circle::new(0.2).expect("a disc").into();
    assert!(
        world
            .bodies_overlapping(&disc, Pose::at(vec2(1.0, 0.0)))
            .is_empty()
    );
    let near = world.nearest(vec2(4.0, 2.0), 10.0).expect("some body");
    assert_eq!(
        (near.body, near.distance, near.point),
        (ids[2], 1.5, vec2(4.0, 0.5))
    );
    assert_eq!(world.nearest(vec2(4.0, 2.0), 1.0), None);
    let inside = world.nearest(vec2(6.1, 0.0), 1.0).expect("some body");
    assert_eq!((inside.body, inside.distance), (ids[3], 0.0));
}

/// The end was told with the next sub-step: for the body that had got the place meanwhile, or after a second begin.
#[test]
fn a_touch_ends_where_its_body_leaves_before_the_engine_knows_it() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let mut world = world(mode, vec2(0.0, -10.0));
        put(
            &mut world,
            BodyDef::fixed().at(vec2(0.0, -0.5)),
            block(20.0, 1.0),
            surface(0.5, 0.0),
        );
        let sunken = |world: &mut World, x: f64| {
            let def = BodyDef::dynamic().at(vec2(x, 0.45));
            put(world, def, block(1.0, 1.0), surface(0.5, 0.0))
        };
        let member = sunken(&mut world, 5.0);
        world.step(1e-3);
        let [goes, stays] = [0.0, 2.0].map(|x| sunken(&mut world, x));
        world.step(1e-4);
        let told = |world: &World| {
            let mut found = Vec::new();
            for event in world.events() {
                match event.kind {
                    EventKind::Begin { b, .. } => found.push((b, true)),
                    EventKind::End { b, .. } => found.push((b, false)),
                    _ => {}
                }
            }
            found
        };
        assert_eq!(told(&world), [(goes, true), (stays, true)], "{mode:?}");
        world.remove(goes).expect("it is there");
        world.remove(member).expect("it is there");
        world.step(1e-4);
        let mut ends = told(&world);
        ends.sort_unstable();
        assert_eq!(ends, [(member, false), (goes, false)], "{mode:?}");
        world.step(0.05);
        assert_eq!(told(&world), [], "{mode:?}: the last one goes on to touch");
    }
}
