//! A body of up to 1e9 times its weight lands on a plate that lies on the floor. One sweep a sub-step let the plate stop it
//! by its own weight only, so that the heavy one sank into the plate, and pushed it out through the floor, by 1.3 of its
//! size; and from mass ratios of 1e7 on the impact itself found no impulses that stop both where there is friction. With
//! some restitution the plate rattles between both, ever faster: when the budget of these impacts was spent the two were
//! left alone until the next sub-step, and the plate was driven out by 0.7 of its size.

use carom_dynamics::{BodyDef, Material, Mode, World};
use carom_geometry::ConvexPolygon;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, outside, put, surface, walled};

const HALF: Vec2 = Vec2::ONE;

/// A pentagon of `mass` kg falls on a plate of 1 kg.
fn falls_on_a_plate(mode: Mode, material: Material, mass: f64, turned: (f64, f64)) -> World {
    let mut world = walled(mode, HALF, material);
    let plate = BodyDef::dynamic().at(vec2(0.0, -0.94)).with_mass(1.0);
    put(&mut world, plate, block(0.5, 0.1), material);
    let falls = BodyDef::dynamic().at(vec2(0.1, 0.2)).turned(turned.0);
    let falls = falls
        .moving(vec2(0.0, -2.0))
        .spinning(turned.1)
        .with_mass(mass);
    let pentagon = ConvexPolygon::regular(5, 0.5).expect("a pentagon");
    put(&mut world, falls, pentagon, material);
    world
}

#[test]
fn a_light_body_keeps_a_heavy_one_off_the_floor() {
    for mode in [Mode::Exact, Mode::Hybrid] {
        for friction in [0.0, 0.5] {
            for mass in [1e2, 1e4, 1e6, 1e9] {
                for turned in [(2.2, -3.0), (-2.8, 2.0), (0.3, 0.0)] {
                    let mut world = falls_on_a_plate(mode, surface(0.0, friction), mass, turned);
                    for _ in 0..240 {
                        world.step(1.0 / 120.0);
                        let deep = outside(&world, HALF);
                        let what = (mode, friction, mass, turned, world.time());
                        assert!(deep < 5e-3, "{deep} m outside: {what:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_light_body_that_bounces_keeps_a_heavy_one_off_the_floor() {
    let mut collapsed = 0;
    for mode in [Mode::Exact, Mode::Hybrid] {
        for (e, friction) in [(0.3, 0.0), (0.7, 0.5)] {
            for mass in [1e2, 1e6] {
                for turned in [(-2.7, 5.0), (1.0, -1.0), (-2.4, 4.0)] {
                    let mut world = falls_on_a_plate(mode, surface(e, friction), mass, turned);
                    // Above what it has where all lies on the floor.
                    let energy = |world: &World| world.energy().mechanical() + 10.0 * mass;
                    let mut before = energy(&world);
                    let scale = before;
                    for _ in 0..80 {
                        collapsed += world.step(1.0 / 120.0).collapsed;
                        let deep = outside(&world, HALF);
                        let what = (mode, e, friction, mass, turned, world.time());
                        assert!(deep < 5e-3, "{deep} m outside: {what:?}");
                        let now = energy(&world);
                        // What sinks in by 1/256 of the plate is pushed out: 1 mm.
                        let gain = (now - before) / scale;
                        assert!(gain < 1e-3, "gains {gain} of its energy: {what:?}");
                        before = now;
                    }
                }
            }
        }
    }
    assert!(collapsed > 0, "no series outran its budget");
}

#[test]
fn what_spins_beside_a_heavy_disc_stays_within_its_walls() {
    // The solver held the pair as it was when the sub-step began; a third of a radian later another corner was in the wall.
    for (angle, velocity, spin) in [
        (-0.1, vec2(-4.0, 0.0), 28.0),
        (-0.9, vec2(4.0, 2.0), -114.0),
        (-0.1, vec2(4.0, 1.0), 173.0),
        (1.2, Vec2::ZERO, -143.0),
    ] {
        let mut world = walled(Mode::Exact, HALF, surface(0.0, 0.0));
        let material = surface(0.0, 0.0);
        let spins = BodyDef::dynamic().at(vec2(-0.2, -0.1)).turned(angle);
        let spins = spins.moving(velocity).spinning(spin).with_mass(1.0);
        let triangle = ConvexPolygon::regular(3, 0.5).expect("a triangle");
        put(&mut world, spins, triangle, material);
        let heavy = BodyDef::dynamic()
            .at(vec2(0.8, 0.8))
            .moving(vec2(-3.0, -2.0));
        put(&mut world, heavy.with_mass(1000.0), disc(0.15), material);
        for _ in 0..480 {
            world.step(1.0 / 240.0);
            let deep = outside(&world, HALF);
            assert!(
                deep < 5e-3,
                "{deep} m outside: {spin} rad/s, {:?}",
                world.time()
            );
        }
    }
}
