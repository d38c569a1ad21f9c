//! A sleeping pile of more than 16 bodies that wakes joins the stepped engine, and the energies with which its members joined have
//! an account of their own. A body that was removed had its energy booked before the others woke, and then joined with them: its
//! energy stayed in that account for good, 3 J of 92.

use carom_dynamics::{BodyDef, BodyId, BodyKind, Settings, World};
use carom_geometry::HalfPlane;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

/// A wall of six layers of bricks, asleep.
fn wall() -> (World, Vec<BodyId>) {
    let mut world = World::new(Settings::default()).expect("valid settings");
    let rough = surface(0.2, 0.3);
    for (point, normal) in [
        (Vec2::ZERO, Vec2::Y),
        (vec2(-2.0, 0.0), Vec2::X),
        (vec2(2.0, 0.0), -Vec2::X),
    ] {
        let side = HalfPlane::new(point, normal).expect("a side");
        put(&mut world, BodyDef::fixed(), side, rough);
    }
    let mut bricks = Vec::new();
    for layer in 0..6 {
        for k in 0..6 {
            let x = -1.5 + 0.5 * f64::from(k) + 0.25 * f64::from(layer % 2);
            let def = BodyDef::dynamic().at(vec2(x, 0.23 + 0.45 * f64::from(layer)));
            bricks.push(put(&mut world, def, block(0.45, 0.45), rough));
        }
    }
    let asleep = |world: &World, id: &BodyId| world.body(*id).expect("there").is_asleep();
    for _ in 0..1200 {
        world.step(1.0 / 60.0);
        if bricks.iter().all(|id| asleep(&world, id)) {
            return (world, bricks);
        }
    }
    panic!("it never falls asleep");
}

#[test]
fn a_body_taken_out_of_a_sleeping_pile_keeps_the_ledger() {
    let (asleep, bricks) = wall();
    let before = asleep.energy();
    for place in [3, 20, 34] {
        for kind in [None, Some(BodyKind::Fixed), Some(BodyKind::Kinematic)] {
            let mut world = asleep.clone();
            match kind {
                None => world.remove(bricks[place]).expect("there"),
                Some(kind) => world.set_kind(bricks[place], kind).expect("there"),
            }
            for step in 0..60 {
                let off = world.energy().residual() - before.residual();
                assert!(
                    off.abs() < 1e-9 * before.potential,
                    "brick {place} became {kind:?}: {off} J after {step} steps"
                );
                world.step(1.0 / 60.0);
            }
        }
    }
}

/// What contacts with driven bodies do is booked for a whole sub-step: for a body that goes within it, not beyond.
#[test]
fn a_body_taken_off_a_belt_within_a_sub_step_keeps_the_ledger() {
    for part in [0.1, 0.5, 0.9] {
        for bodies in [1, 3, 6] {
            let mut world = World::new(Settings::default()).expect("valid settings");
            let belt = BodyDef::kinematic()
                .at(vec2(0.0, -0.5))
                .moving(vec2(0.5, 0.0));
            put(&mut world, belt, block(20.0, 1.0), surface(0.0, 0.3));
            let mut ids = Vec::new();
            for k in 0..bodies {
                let def = BodyDef::dynamic().at(vec2(0.0, 0.26 + 0.51 * f64::from(k)));
                ids.push(put(&mut world, def, block(0.5, 0.5), surface(0.0, 0.3)));
            }
            for _ in 0..20 {
                world.step(1.0 / 60.0);
            }
            world.step(part / 360.0);
            let before = world.energy().residual();
            world.remove(ids[0]).expect("there");
            for step in 0..30 {
                let off = world.energy().residual() - before;
                assert!(
                    off.abs() < 1e-9,
                    "{bodies} bodies, {part}: {off} J after {step}"
                );
                world.step(1.0 / 60.0);
            }
        }
    }
}
