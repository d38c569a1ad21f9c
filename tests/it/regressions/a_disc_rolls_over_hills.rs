//! Discs that roll over polylines, and leave them and land again where they bend too much for their speed.
//!
//! Both segments at a tip touch a disc that turns about it, with equal rows, and such islands had no path: the engine took them. So it
//! did with what took off from a tip, and came to the end of its path near to the next segment. A disc that touches something more as
//! its path begins had no path at all until the next event. And in the engine discs lost a fifth of their energy at each seam of two
//! segments, flush ones too: the end of the next one stopped them.

use carom_dynamics::{BodyDef, BodyId, Mode, Settings, World};
use carom_geometry::Segment;
use carom_math::trig::sin_cos;
use carom_math::{Vec2, perp, vec2};
use carom_tests::scenes::{disc, put, surface};

/// Segments from −3 to 3 m along a curve, and a disc that rolls at `speed` where it begins.
fn hills(mode: Mode, curve: fn(f64) -> f64, radius: f64, speed: f64) -> (World, BodyId) {
    let settings = Settings {
        mode,
        gravity: vec2(0.0, -10.0),
        sleep: None,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("settings");
    let rough = surface(0.0, 1.0);
    let at = |k: u32| {
        let x = -3.0 + 0.2 * f64::from(k);
        vec2(x, curve(x))
    };
    for k in 0..30 {
        let segment = Segment::new(at(k), at(k + 1)).expect("a segment");
        put(&mut world, BodyDef::fixed(), segment, rough);
    }
    let up = (at(1) - at(0)).normalize();
    let def = BodyDef::dynamic().at(at(0) + up * 0.12 + perp(up) * radius);
    let def = def.moving(up * speed).spinning(-speed / radius);
    let id = put(&mut world, def, disc(radius), rough);
    (world, id)
}

fn hill(x: f64) -> f64 {
    -0.05 * x * x
}

fn waves(x: f64) -> f64 {
    0.1 * sin_cos(2.0 * x).0
}

#[test]
fn a_disc_rolls_over_hills() {
    for curve in [hill, waves] {
        for (radius, speed) in [(0.1, 1.0), (0.1, 2.0), (0.3, 1.2), (0.02, 0.7), (0.02, 2.0)] {
            let (mut world, _) = hills(Mode::Exact, curve, radius, speed);
            let start = world.energy().mechanical();
            for _ in 0..240 {
                let report = world.step(1.0 / 60.0);
                let at = world.time().as_secs();
                assert!(
                    report.is_exact(),
                    "{radius} m, {speed} m/s, {at} s: {report:?}"
                );
            }
            let energy = world.energy();
            let off = start - energy.mechanical() - energy.impacts - energy.friction;
            assert!(
                off.abs() < 1e-10 * start.abs(),
                "{radius} m, {speed} m/s: {off} J"
            );
        }
    }
}

#[test]
fn a_disc_that_only_rolls_loses_nothing_on_a_hill() {
    let (mut world, id) = hills(Mode::Exact, hill, 0.1, 1.0);
    let start = world.energy().mechanical();
    let mut highest = Vec2::splat(f64::NEG_INFINITY);
    for _ in 0..60 {
        world.step(1.0 / 60.0);
        highest = highest.max(world.body(id).expect("it is there").centre());
        let lost = start - world.energy().mechanical();
        assert!(
            lost.abs() < 1e-9 * start.abs(),
            "{lost} J at {:?}",
            world.time()
        );
    }
    // 3/4 m v² lifts it by 7.5 cm.
    assert!(highest.x > -2.7, "it does not climb: {highest}");
}

#[test]
fn seams_of_segments_do_not_stop_discs_in_the_engine() {
    for bend in [0.0, 0.02] {
        for speed in [1.0, 2.0, 4.0] {
            let settings = Settings {
                mode: Mode::Stepped,
                gravity: vec2(0.0, -10.0),
                ..Settings::default()
            };
            let mut world = World::new(settings).expect("settings");
            let rough = surface(0.0, 1.0);
            for (from, to) in [(-3.0, 0.0), (0.0, 3.0)] {
                let at = |x: f64| vec2(x, -bend * f64::max(x, 0.0));
                let segment = Segment::new(at(from), at(to)).expect("a segment");
                put(&mut world, BodyDef::fixed(), segment, rough);
            }
            let def = BodyDef::dynamic().at(vec2(-0.35, 0.1));
            let def = def.moving(vec2(speed, 0.0)).spinning(-speed / 0.1);
            let id = put(&mut world, def, disc(0.1), rough);
            let kinetic = world.body(id).expect("it is there").kinetic_energy();
            let start = world.energy().mechanical();
            while world.body(id).expect("it is there").centre().x < 1.0 {
                world.step(1.0 / 60.0);
                assert!(world.time().as_secs() < 3.0, "stopped");
            }
            let lost = (start - world.energy().mechanical()) / kinetic;
            assert!(lost < 0.01, "{bend}, {speed} m/s: {lost} of its energy");
        }
    }
}
