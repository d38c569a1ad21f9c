//! The work of a call is bounded, and where it is used up changes no bit.

use carom_dynamics::{
    BodyDef, Material, Mode, Motion, RadialField, Settings, Several, StepReport, World,
};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane};
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::elastic;
use carom_tests::scenes::{self, any_disc, any_shape};

fn settings(mode: Mode, work: u64) -> Settings {
    Settings {
        mode,
        work,
        ..Settings::default()
    }
}

/// Motions of all bodies after each of `ticks` ticks, and the reports in one.
fn motions(world: &mut World, ticks: u64) -> (Vec<Vec<Motion>>, StepReport, u64) {
    let (mut all, mut calls) = (StepReport::default(), 0);
    let list = (1..=ticks).map(|tick| {
        let end = SimTime::multiple(tick, 1.0 / 60.0);
        while end - world.time() > 0.0 {
            all += world.step(end - world.time());
            calls += 1;
        }
        world.bodies().map(|body| *body.motion()).collect()
    });
    let list = list.collect();
    (list, all, calls)
}

#[test]
fn steps_that_run_out_of_work_go_on_with_the_bits_of_one_long_step() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        for seed in 1..=6 {
            let heap = |work| {
                let mut world = World::new(settings(mode, work)).expect("valid settings");
                let shape = if seed % 2 == 0 { any_shape } else { any_disc };
                scenes::heap(&mut world, seed, shape);
                world
            };
            let (whole, one, once) = motions(&mut heap(u64::MAX), 90);
            assert_eq!(once, 90, "{mode:?}, heap {seed}: no limit, one call a tick");
            // Every event has a call of its own.
            let (cut, many, calls) = motions(&mut heap(1), 90);
            assert!(calls > 90, "{mode:?}, heap {seed}: {calls} calls");
            assert_eq!(one.impacts, many.impacts, "{mode:?}, heap {seed}");
            for (tick, (one, other)) in (1..).zip(whole.iter().zip(&cut)) {
                assert!(one == other, "{mode:?}, heap {seed}, tick {tick}");
            }
        }
    }
}

#[test]
fn a_large_pile_that_runs_out_of_work_goes_on_with_the_same_bits() {
    for mode in [Mode::Hybrid, Mode::Stepped] {
        let pile = |work| {
            let mut world = World::new(settings(mode, work)).expect("valid settings");
            let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
            world
                .insert(BodyDef::fixed(), floor, Material::default())
                .expect("valid");
            for k in 0..120_u32 {
                let at = vec2(1.05 * f64::from(k % 12), 0.6 + 1.02 * f64::from(k / 12));
                let shape = ConvexPolygon::square(1.0).expect("a square");
                world
                    .insert(BodyDef::dynamic().at(at), shape, Material::default())
                    .expect("valid");
            }
            world
        };
        let (whole, ..) = motions(&mut pile(u64::MAX), 90);
        let (cut, _, calls) = motions(&mut pile(1), 90);
        assert!(calls > 90, "{mode:?}: {calls} calls");
        assert!(whole == cut, "{mode:?}");
    }
}

#[test]
fn a_heavy_ball_that_drives_a_light_one_against_a_wall_stops_the_call() {
    // π √(1e10) impacts, most of them in a hundredth of a second: 1 kg between 1e10 kg and a wall.
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        ..settings(Mode::Exact, 1000)
    })
    .expect("valid settings");
    let wall = HalfPlane::new(Vec2::ZERO, Vec2::X).expect("a wall");
    world
        .insert(BodyDef::fixed(), wall, elastic())
        .expect("valid");
    for (x, speed, mass) in [(1.0, 0.0, 1.0), (2.0, -1.0, 1e10)] {
        let ball = Circle::new(0.1).expect("a ball");
        let def = BodyDef::dynamic().at(vec2(x, 0.0)).moving(vec2(speed, 0.0));
        let material = Material {
            density: mass / (core::f64::consts::PI * 0.01),
            ..elastic()
        };
        world.insert(def, ball, material).expect("valid");
    }
    let (mut impacts, mut cut) = (0, 0);
    while world.time() < SimTime::from_secs(20.0) {
        let (before, report) = (world.time(), world.step(1.0));
        // 60 ticks of 1,000 each.
        assert!(report.impacts <= 60_000, "{report:?}");
        assert!((world.time() - before - report.advanced).abs() < 1e-15);
        impacts += report.impacts;
        cut += u32::from(report.advanced < 1.0);
    }
    assert_eq!(impacts, 314_159, "the first digits of π");
    assert!(cut >= 5, "{cut} calls stopped early");
}

/// Four rough boxes on a floor, and a light ball that bounces at 1e5 m/s between them and a ceiling: impacts of 9 contacts, each of
/// which takes some milliseconds.
fn hammered_pile(work: u64) -> World {
    let mut world = World::new(Settings {
        sleep: None,
        gravity: vec2(0.0, -10.0),
        several: Several::Reflections,
        ..settings(Mode::Exact, work)
    })
    .expect("valid settings");
    let rough = Material {
        friction: 0.5,
        restitution: 0.0,
        ..Material::default()
    };
    for (y, outward) in [(0.0, Vec2::Y), (4.2, -Vec2::Y)] {
        let wall = HalfPlane::new(vec2(0.0, y), outward).expect("a wall");
        world.insert(BodyDef::fixed(), wall, rough).expect("valid");
    }
    for y in [0.5, 1.5, 2.5, 3.5] {
        let def = BodyDef::dynamic().at(vec2(0.0, y));
        let shape = ConvexPolygon::square(1.0).expect("a square");
        world.insert(def, shape, rough).expect("valid");
    }
    let at_rest = SimTime::from_secs(0.3);
    while world.time() < at_rest {
        world.step(at_rest - world.time());
    }
    let def = BodyDef::dynamic()
        .at(vec2(0.1, 4.1))
        .moving(vec2(0.0, -1e5));
    let light = Material {
        density: 1e-5 / (core::f64::consts::PI * 0.0025),
        ..elastic()
    };
    world
        .insert(def, Circle::new(0.05).expect("a ball"), light)
        .expect("valid");
    world
}

#[test]
fn an_impact_of_many_contacts_is_charged_by_its_operations() {
    let tick = 1.0 / 60.0;
    let mut whole = hammered_pile(u64::MAX);
    assert!(whole.step(tick).advanced >= tick);
    // With impacts charged alike one call of a tick took 6.3 s in release.
    // Impacts and pairs alone would be 106.
    let mut cut = hammered_pile(500);
    let (end, mut calls) = (cut.time() + tick, 0);
    while end - cut.time() > 0.0 {
        let report = cut.step(end - cut.time());
        assert!(report.impacts < 10_000, "{report:?}");
        calls += 1;
    }
    assert!(calls > 1, "it took a single call");
    // The instants at which calls end are sums of others, and these two differ by their rounding.
    let late = (whole.time() - cut.time()).abs();
    assert!(late < 1e-17, "{late:e} s");
    for (one, other) in whole.bodies().zip(cut.bodies()) {
        let (off, speed) = (
            (one.centre() - other.centre()).length(),
            one.velocity().length(),
        );
        // A place rounds as well.
        let rounding = f64::EPSILON * one.centre().length();
        assert!(
            off <= 2.0 * late * speed + rounding,
            "{off:e} m at {speed:e} m/s"
        );
    }
}

#[test]
fn an_orbit_of_microseconds_stops_the_call() {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        ..settings(Mode::Hybrid, 1000)
    })
    .expect("valid settings");
    world.add_field(RadialField::new(Vec2::ZERO, 1e12, 1.0).expect("a centre"));
    let def = BodyDef::dynamic().at(vec2(3.0, 0.0));
    world
        .insert(def, Circle::new(0.1).expect("a disc"), elastic())
        .expect("valid");
    let report = world.step(1.0);
    assert!(report.advanced > 0.0 && report.advanced < 1.0, "{report:?}");
}

#[test]
fn a_step_to_the_next_event_ends_there_though_none_is_kept() {
    let mut world = World::new(Settings {
        events: 0,
        ..Settings::default()
    })
    .expect("valid settings");
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
    world
        .insert(BodyDef::fixed(), floor, elastic())
        .expect("valid");
    let def = BodyDef::dynamic().at(vec2(0.0, 5.005));
    world
        .insert(def, Circle::new(0.1).expect("a disc"), elastic())
        .expect("valid");
    // 4.905 m at 9.81 m/s²: 1 s.
    let report = world.step_to_next_event(10.0);
    assert!((report.advanced - 1.0).abs() < 1e-12, "{report:?}");
    assert_eq!((world.events().len(), world.events().dropped()), (0, 1));
}
