//! Momentum within a sub-step, as a caller sees it: of bodies that are met asleep, and of those that a removed body leaves. Up to a
//! hundredth of it was lost until the sub-step ended, or for ever: what a velocity lacked of its end went with the removed body,
//! and what woke was shown to get faster, while what met it had slowed down.

use carom_dynamics::{BodyDef, BodyId, Material, Mode, Settings, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Rot, Vec2, vec2};
use carom_tests::checks::Moment;

fn weightless() -> World {
    let settings = Settings {
        mode: Mode::Stepped,
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    World::new(settings).expect("valid")
}

/// Goes on for `dt` seconds, and asks that momentum and angular momentum stay.
fn step(world: &mut World, dt: f64, at: &str) {
    let before = Moment::of(world);
    world.step(dt);
    for (missing, of) in before.missing(&Moment::of(world)) {
        assert!(missing < 1e-12 * of, "{at}: {missing:e} of {of:e}");
    }
}

/// A ring of boxes and discs that run together, each with another mass.
fn ring(world: &mut World, count: u32, speed: f64) -> Vec<BodyId> {
    let mut ids = Vec::new();
    for k in 0..count {
        let out = Rot::from_angle(f64::from(k) * 6.0 / f64::from(count)) * Vec2::X;
        let material = Material {
            density: 1.0 + f64::from(k % 5),
            restitution: 0.25 * f64::from(k % 3),
            ..Material::default()
        };
        let def = BodyDef::dynamic()
            .at(out * (1.2 + 0.1 * f64::from(k % 4)))
            .turned(f64::from(k))
            .moving(out * (-speed * (4.0 + f64::from(k % 3))))
            .spinning(f64::from(k % 7) - 3.0);
        let shape = if k % 2 == 0 {
            Circle::new(0.15).expect("a disc").into()
        } else {
            carom_geometry::Shape::from(ConvexPolygon::rectangle(0.3, 0.2).expect("a box"))
        };
        ids.push(world.insert(def, shape, material).expect("valid"));
    }
    ids
}

#[test]
fn a_removed_body_takes_no_momentum_of_others() {
    for count in 8..20 {
        let mut world = weightless();
        let ids = ring(&mut world, count, 1.0);
        let mut ids = ids.into_iter();
        for time in 0..400 {
            if time % 40 == 39
                && let Some(id) = ids.next()
                && world.bodies().count() > 2
            {
                world.remove(id).expect("it is there");
            }
            step(&mut world, 1.1e-3, &format!("{count} {time}"));
        }
    }
}

#[test]
fn a_body_that_a_caller_moves_takes_no_momentum_of_others() {
    for count in 8..20 {
        let mut world = weightless();
        let ids = ring(&mut world, count, 1.0);
        let mut ids = ids.into_iter().cycle();
        for time in 0..400 {
            if time % 10 == 9
                && let Some(id) = ids.next()
            {
                let velocity = world.body(id).expect("it is there").velocity();
                world
                    .set_velocity(id, velocity * -0.5, 1.0)
                    .expect("it is there");
            }
            step(&mut world, 1.1e-3, &format!("{count} {time}"));
            let energy = world.energy();
            assert!(
                energy.residual().abs() < 1e-12 * energy.kinetic,
                "{count} {time}: {energy:?}"
            );
        }
    }
}

/// Bodies that continuous collision stops go elsewhere than their velocities tell: up to a hundredth of the angular momentum was missing
/// within the sub-step, and for ever if one of them was changed there.
#[test]
fn what_is_stopped_takes_no_momentum_with_it() {
    let mut stopped = 0;
    for count in 8..20 {
        let mut world = weightless();
        let mut ids = ring(&mut world, count, 40.0);
        for time in 0..200 {
            let at = format!("{count} {time}");
            stopped += world
                .bodies()
                .filter(|body| body.velocity().length() > 40.0)
                .count();
            step(&mut world, 1.1e-3, &at);
            if time % 20 == 19 && ids.len() > 2 {
                let (first, last) = (ids[0], ids.pop().expect("more than two"));
                let velocity = world.body(first).expect("it is there").velocity();
                world.remove(last).expect("it is there");
                world
                    .set_velocity(first, velocity * -0.5, 1.0)
                    .expect("it is there");
                // What is left of the sub-step, and more.
                step(&mut world, 3.3e-3, &at);
            }
        }
    }
    assert!(stopped > 100, "{stopped} fast bodies");
}

#[test]
fn what_is_met_asleep_gets_what_is_lost() {
    let mut world = weightless();
    for k in 0..5 {
        let disc = Circle::new(0.1).expect("a disc");
        let at = vec2(0.3 * f64::from(k), 0.02 * f64::from(k));
        let def = BodyDef::dynamic().at(at).asleep();
        let def = if k == 0 {
            BodyDef::dynamic().at(at).moving(vec2(7.0, 0.3))
        } else {
            def
        };
        world.insert(def, disc, Material::default()).expect("valid");
    }
    for time in 0..400 {
        step(&mut world, 7e-4, &time.to_string());
    }
}
