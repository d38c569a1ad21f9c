//! Bodies that a caller changes within a sub-step in which they strike something.
//!
//! What was struck kept what the sub-step had done to it while the changed body went on as it was seen, before the blow; off a wall the
//! blow came on top of the velocity that was set: 57 J became 339 kJ.

use carom_dynamics::{BodyDef, BodyId, Material, Mode, Settings, World};
use carom_geometry::{Circle, ConvexPolygon, Shape};
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::checks::Moment;

fn under(gravity: Vec2) -> World {
    let settings = Settings {
        mode: Mode::Stepped,
        gravity,
        ..Settings::default()
    };
    World::new(settings).expect("valid")
}

fn put(world: &mut World, def: BodyDef, shape: impl Into<Shape>, density: f64) -> BodyId {
    let material = Material {
        density,
        restitution: 1.0,
        friction: 0.4,
        ..Material::default()
    };
    world.insert(def, shape.into(), material).expect("valid")
}

/// Asks `ask` of copies of a world at many instants of its sub-steps.
fn within_sub_steps(mut world: World, mut ask: impl FnMut(World)) {
    let part = world.settings().tick / 42.0;
    for _ in 0..200 {
        world.step(part);
        ask(world.clone());
    }
}

#[test]
fn a_ball_that_strikes_a_wall_has_the_velocity_that_it_is_given() {
    let mut world = under(Vec2::ZERO);
    let wall = ConvexPolygon::rectangle(1.0, 20.0).expect("a wall");
    put(&mut world, BodyDef::fixed().at(vec2(5.0, 0.0)), wall, 1.0);
    let def = BodyDef::dynamic().moving(vec2(325.0, 90.0));
    let ball = put(&mut world, def, Circle::new(0.3).expect("a ball"), 1.0);
    within_sub_steps(world, |mut world| {
        let given = vec2(-1.0, 0.5);
        world.set_velocity(ball, given, 0.0).expect("it is there");
        world.step(0.01);
        let velocity = world.body(ball).expect("it is there").velocity();
        assert!(velocity.distance(given) < 1e-9, "{velocity}");
    });
}

/// Goes on to where the third sub-step from now ends: overlaps that are parted are seen with less within one.
fn end_sub_steps(world: &mut World) {
    let h = world.settings().tick / 6.0;
    let now = world.time() - SimTime::ZERO;
    world.step(((now / h).floor() + 3.0) * h - now);
}

/// A heavy ball and light ones in a row, each with a gap to the next.
fn row(world: &mut World) -> Vec<BodyId> {
    let mut ids = Vec::new();
    for k in 0..5 {
        let def = BodyDef::dynamic().at(vec2(0.7 * f64::from(k), 0.05 * f64::from(k % 2)));
        let (def, density) = match k {
            0 => (def.moving(vec2(60.0, 0.0)), 100.0),
            _ => (def, 1.0),
        };
        let ball = Circle::new(0.3).expect("a ball");
        ids.push(put(world, def, ball, density));
    }
    ids
}

#[test]
fn balls_in_a_row_keep_energy_and_momentum() {
    let mut world = under(Vec2::ZERO);
    let ids = row(&mut world);
    let most = world.energy().kinetic;
    within_sub_steps(world, |world| {
        for &id in &ids {
            let mut world = world.clone();
            let body = world.body(id).expect("it is there");
            let (velocity, spin) = (body.velocity(), body.angular_velocity());
            world.set_velocity(id, velocity, spin).expect("it is there");
            let before = Moment::of(&world);
            end_sub_steps(&mut world);
            let kinetic = world.energy().kinetic;
            assert!(kinetic < most * (1.0 + 1e-9), "{kinetic} J of {most}");
            for (missing, of) in before.missing(&Moment::of(&world)) {
                assert!(missing < 1e-11 * of, "{missing:e} of {of:e}");
            }
        }
    });
}

#[test]
fn balls_that_fall_keep_no_blow_of_one_that_is_stopped() {
    let mut world = under(vec2(0.0, -9.81));
    let ids = row(&mut world);
    let most = world.energy().kinetic;
    within_sub_steps(world, |world| {
        for &id in &ids {
            let mut world = world.clone();
            world
                .set_velocity(id, Vec2::ZERO, 0.0)
                .expect("it is there");
            end_sub_steps(&mut world);
            let energy = world.energy();
            let more = energy.mechanical() - energy.external;
            assert!(more < 1e-3 * most, "{more} J more, of {most}");
        }
    });
}
