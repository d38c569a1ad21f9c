//! Surfaces that run, and bodies that go where they are told.

use carom_dynamics::{BodyDef, BodyError, BodyId, Material, Mode, PairMaterial, Settings, World};
use carom_geometry::{Circle, ConvexPolygon, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use carom_tests::run;

const MODES: [Mode; 3] = [Mode::Hybrid, Mode::Exact, Mode::Stepped];

const G: f64 = 9.81;

fn world(mode: Mode) -> World {
    World::new(Settings {
        mode,
        ..Settings::default()
    })
    .expect("valid")
}

fn rough(friction: f64) -> Material {
    Material {
        friction,
        ..Material::default()
    }
}

/// A floor with an upper side that runs to the right at `speed`.
fn belt(world: &mut World, speed: f64, friction: f64) -> BodyId {
    let belt = Material {
        tangent_speed: -speed,
        ..rough(friction)
    };
    let floor = ConvexPolygon::rectangle(60.0, 2.0).expect("a floor");
    let def = BodyDef::fixed().at(vec2(0.0, -1.0));
    world.insert(def, floor, belt).expect("valid")
}

fn put(world: &mut World, at: Vec2, shape: impl Into<Shape>, friction: f64) -> BodyId {
    world
        .insert(BodyDef::dynamic().at(at), shape, rough(friction))
        .expect("valid")
}

fn square() -> ConvexPolygon {
    ConvexPolygon::square(1.0).expect("a box")
}

#[test]
fn a_belt_takes_a_box_up_to_its_speed() {
    for mode in MODES {
        let (mut world, speed, mu) = (world(mode), 3.0, 0.3);
        belt(&mut world, speed, mu);
        let id = put(&mut world, vec2(-10.0, 0.5), square(), mu);
        run(&mut world, 3.0, |_| {});
        let body = world.body(id).expect("it stays");
        // µ g t up to the belt's speed, then along with it.
        let exact = -10.0 + speed * 3.0 - speed * speed / (2.0 * mu * G);
        let error = body.centre().x - exact;
        assert!(error.abs() < 5e-3, "{mode:?}: {error:.1e} m off");
        assert!((body.velocity().x - speed).abs() < 1e-6, "{mode:?}");
        assert!(!body.is_asleep(), "{mode:?}: it moves");
        assert!(body.angle().abs() < 1e-3, "{mode:?}: turned");
    }
}

#[test]
fn a_wheel_on_a_belt_ends_up_rolling_on_it() {
    for mode in MODES {
        let (mut world, speed) = (world(mode), 2.0);
        belt(&mut world, speed, 0.5);
        let disc = Circle::new(0.5).expect("a disc");
        let id = put(&mut world, vec2(-5.0, 0.5), disc, 0.5);
        run(&mut world, 2.0, |_| {});
        let body = world.body(id).expect("it stays");
        // Angular momentum about the belt's surface stays 0: m v r = I ω, I = m r²/2, v + ω r = speed.
        let v = speed / 3.0;
        assert!(
            (body.velocity().x - v).abs() < 1e-3,
            "{mode:?}: {}",
            body.velocity()
        );
        let spin = body.angular_velocity();
        assert!((spin - 2.0 * v / 0.5).abs() < 1e-2, "{mode:?}: {spin}");
    }
}

#[test]
fn what_falls_on_a_belt_is_struck_by_its_surface() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let (mut world, speed) = (world(mode), 20.0);
        let id = belt(&mut world, speed, 0.2);
        let disc = Circle::new(0.5).expect("a disc");
        let ball = put(&mut world, vec2(0.0, 3.0), disc, 0.2);
        world
            .set_pair_material(
                id,
                ball,
                PairMaterial {
                    friction: 0.2,
                    restitution: 0.5,
                    tangent_speed: -speed,
                },
            )
            .expect("valid");
        let mut first = None;
        run(&mut world, 1.0, |world| {
            let v = world.body(ball).expect("it stays").velocity();
            if v.y > 0.0 && first.is_none() {
                first = Some(v);
            }
        });
        // It slips throughout: Δvx = µ Δvy = µ (1 + e) √(2 g h).
        let fall = (2.0_f64 * G * 2.5).sqrt();
        let gained = 0.2 * 1.5 * fall;
        let v = first.expect("it bounced");
        assert!(
            (v.x - gained).abs() < 1e-9,
            "{mode:?}: {v}, expected {gained}"
        );
        let ledger = world.energy();
        assert!(
            ledger.residual().abs() < 1e-9 * ledger.kinetic.max(1.0),
            "{mode:?}: {:.1e} J unaccounted for",
            ledger.residual()
        );
    }
}

#[test]
fn a_pair_of_its_own_does_not_feel_the_belt() {
    for mode in MODES {
        let mut world = world(mode);
        let floor = belt(&mut world, 3.0, 0.5);
        let carried = put(&mut world, vec2(0.0, 0.5), square(), 0.5);
        let stays = put(&mut world, vec2(-8.0, 0.5), square(), 0.5);
        let still = PairMaterial {
            friction: 0.5,
            ..PairMaterial::default()
        };
        world.set_pair_material(floor, stays, still).expect("valid");
        run(&mut world, 2.0, |_| {});
        let x = |id| world.body(id).expect("it stays").centre().x;
        assert!(x(carried) > 4.0, "{mode:?}: carried to {}", x(carried));
        assert!((x(stays) + 8.0).abs() < 1e-6, "{mode:?}: {}", x(stays));
    }
}

#[test]
fn tracks_of_a_vehicle_drive_it() {
    // A box with an outline that runs: on the ground the lower side runs to the right, so it goes left.
    for mode in MODES {
        let mut world = world(mode);
        belt(&mut world, 0.0, 0.8);
        let tracks = Material {
            tangent_speed: 1.5,
            ..rough(0.8)
        };
        let def = BodyDef::dynamic().at(vec2(0.0, 0.5));
        let id = world.insert(def, square(), tracks).expect("valid");
        run(&mut world, 2.0, |_| {});
        let v = world.body(id).expect("it stays").velocity();
        assert!((v.x + 1.5).abs() < 1e-3, "{mode:?}: {v}");
    }
}

#[test]
fn a_kinematic_body_goes_where_it_is_told_and_takes_along_what_it_holds() {
    for mode in MODES {
        let mut world = world(mode);
        let lift = ConvexPolygon::rectangle(3.0, 0.5).expect("a lift");
        let def = BodyDef::kinematic().at(vec2(0.0, -0.25));
        let lift = world.insert(def, lift, rough(0.6)).expect("valid");
        let load = put(&mut world, vec2(0.0, 0.5), square(), 0.6);
        run(&mut world, 0.5, |_| {});
        // Up by a smooth path, pose by pose.
        for k in 1..=120 {
            let s = f64::from(k) / 120.0;
            let y = 3.0 * s * s * (3.0 - 2.0 * s);
            let pose = Pose::new(vec2(0.5 * s, y - 0.25), Rot::from_angle(0.05 * s));
            world.drive_to(lift, pose, 1.0 / 60.0).expect("valid");
            world.step(1.0 / 60.0);
            let at = world.body(lift).expect("it stays").pose();
            assert!(
                (at.position - pose.position).length() < 1e-12,
                "{mode:?}: {} instead of {}",
                at.position,
                pose.position
            );
            let off = (at.rotation * pose.rotation.inverse()).angle();
            assert!(off.abs() < 1e-12, "{mode:?}: turned by {off:.1e} beside");
        }
        world.set_velocity(lift, Vec2::ZERO, 0.0).expect("valid");
        run(&mut world, 1.0, |_| {});
        let at = world.body(load).expect("it stays").centre();
        assert!(
            (at - vec2(0.5 - 0.025, 3.5)).length() < 0.03,
            "{mode:?}: the load is at {at}"
        );
        let here = Pose::IDENTITY;
        assert_eq!(
            world.drive_to(load, here, 1.0),
            Err(BodyError::NotKinematic(load))
        );
        let never = world.drive_to(lift, here, 0.0).expect_err("no time");
        assert_eq!(never.to_string(), "seconds is 0, not above 0");
    }
}
