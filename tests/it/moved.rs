//! `World::moved` lists every body that is elsewhere than after the step before, in every mode, and none that sleeps.

use std::collections::BTreeMap;

use carom_dynamics::{BodyDef, BodyId, Impulse, Mode, Settings, World};
use carom_math::{Pose, vec2};
use carom_tests::scenes::{block, disc, put, surface};

fn poses(world: &World) -> BTreeMap<BodyId, Pose> {
    world
        .bodies()
        .map(|body| (body.id(), body.pose()))
        .collect()
}

fn moved(world: &World) -> Vec<BodyId> {
    let mut ids: Vec<BodyId> = world.moved().map(|body| body.id()).collect();
    ids.sort_unstable();
    let all = ids.len();
    ids.dedup();
    assert_eq!(ids.len(), all, "a body is listed twice");
    ids
}

/// A floor, stacks, balls that bounce on it, and a platform, the last of the list.
fn yard(mode: Mode) -> (World, Vec<BodyId>) {
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -9.81),
        mode,
        ..Settings::default()
    })
    .expect("valid settings");
    put(
        &mut world,
        BodyDef::fixed().at(vec2(0.0, -1.0)),
        block(80.0, 2.0),
        surface(0.0, 0.5),
    );
    let mut ids = Vec::new();
    for k in 0..24 {
        let at = vec2(2.0 * f64::from(k % 6) - 10.0, 0.5 + f64::from(k / 6));
        ids.push(put(
            &mut world,
            BodyDef::dynamic().at(at),
            block(1.0, 1.0),
            surface(0.0, 0.5),
        ));
    }
    for k in 0..6 {
        let at = vec2(8.0 + 2.0 * f64::from(k), 2.0 + f64::from(k));
        ids.push(put(
            &mut world,
            BodyDef::dynamic().at(at),
            disc(0.4),
            surface(0.5, 0.2),
        ));
    }
    let platform = BodyDef::kinematic()
        .at(vec2(-20.0, 3.0))
        .moving(vec2(1.0, 0.0));
    ids.push(put(
        &mut world,
        platform,
        block(4.0, 0.5),
        surface(0.0, 0.5),
    ));
    (world, ids)
}

#[test]
fn a_body_that_is_elsewhere_is_listed() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        let (mut world, mut ids) = yard(mode);
        assert_eq!(moved(&world), [], "nothing has moved yet");
        world.step(1.0 / 60.0);
        assert_eq!(moved(&world).len(), ids.len() + 1, "all are new");
        let mut most = 0;
        for step in 0..900 {
            let before = poses(&world);
            match step {
                200 => world
                    .apply(ids[23], Impulse::central(vec2(1.5, 0.0)))
                    .expect("it is there"),
                300 => world
                    .teleport(ids[0], Pose::at(vec2(-30.0, 0.5)))
                    .expect("it is there"),
                350 => world.remove(ids.remove(5)).expect("it is there"),
                400 => ids.push(put(
                    &mut world,
                    BodyDef::dynamic().at(vec2(-25.0, 2.0)),
                    disc(0.3),
                    surface(0.3, 0.2),
                )),
                450 => world
                    .set_velocity(ids[29], vec2(0.0, 0.0), 0.0)
                    .expect("it is there"),
                _ => {}
            }
            // Uneven steps, some of which end within a sub-step.
            world.step(if step % 3 == 0 { 0.011 } else { 0.02 });
            let listed = moved(&world);
            most = most.max(listed.len());
            for (id, pose) in poses(&world) {
                let same = before.get(&id) == Some(&pose);
                assert!(
                    same || listed.binary_search(&id).is_ok(),
                    "{id} at {pose:?} is not listed in step {step}, {mode:?}"
                );
            }
            assert!(listed.iter().all(|id| world.body(*id).is_some()));
        }
        assert!(most > 5);
        // A kinematic body at rest is awake in the engine.
        let awake = |id: &BodyId| world.body(*id).is_some_and(|body| !body.is_asleep());
        let listed = moved(&world);
        assert!(
            listed.iter().all(awake) && listed.len() <= 1,
            "{listed:?} in {mode:?}"
        );
    }
}
