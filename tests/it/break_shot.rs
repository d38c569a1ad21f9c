//! A break shot: one fast disc into resting ones far apart, in one long step.

use carom_dynamics::{BodyDef, EventKind, Settings, Sleep, World};
use carom_geometry::Circle;
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::elastic;
use carom_tests::gas::numbers;

/// Of every disc, in m.
const RADIUS: f64 = 1.0;

/// 200 discs at rest some 8 m apart, and one that comes in at 200 m/s.
fn table(sleep: Option<Sleep>) -> World {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        sleep,
        ..Settings::default()
    })
    .expect("valid settings");
    let disc = Circle::new(RADIUS).expect("a disc");
    let mut next = numbers(8);
    for k in 0..200_u32 {
        let at = vec2(f64::from(k % 20), f64::from(k / 20)) * 8.0 + vec2(next(), next()) * 4.0;
        world
            .insert(BodyDef::dynamic().at(at), disc, elastic())
            .expect("valid");
    }
    let cue = BodyDef::dynamic()
        .at(vec2(-20.0, 38.0))
        .moving(vec2(200.0, 3.0));
    world.insert(cue, disc, elastic()).expect("valid");
    world
}

/// Instants of all impacts.
fn instants(world: &World) -> impl Iterator<Item = SimTime> {
    assert_eq!(world.events().dropped(), 0);
    let impact = |event: &&carom_dynamics::Event| matches!(event.kind, EventKind::Impact { .. });
    world.events().iter().filter(impact).map(|event| event.time)
}

#[test]
fn a_break_shot_in_one_step_is_the_same_run_cut_by_chance() {
    for sleep in [None, Some(Sleep::default())] {
        let mut whole = table(sleep);
        let report = whole.step(30.0);
        assert!(report.is_exact() && report.substeps == 0, "{report:?}");
        let met: Vec<SimTime> = instants(&whole).collect();
        assert!(met.len() > 100, "only {} impacts", met.len());
        for seed in 0..4 {
            let mut cut = table(sleep);
            let mut next = numbers(seed);
            let mut found = Vec::new();
            let mut steps = 0;
            while cut.time() < whole.time() {
                // From picoseconds to seconds, and none at all; sums of such parts of a second are exact.
                let unit = carom_math::trig::pow(2.0, -40.0);
                let dt = (carom_math::trig::pow(2.0, 40.0 * next()) - 1.0).floor() * unit;
                cut.step(dt.min(whole.time() - cut.time()));
                found.extend(instants(&cut));
                steps += 1;
            }
            assert!(steps > 100);
            assert_eq!(cut.time(), whole.time());
            assert_eq!(found, met, "the same impacts at the same instants");
            assert_eq!(cut.state_hash(), whole.state_hash(), "sleep {sleep:?}");
        }
    }
}

#[test]
fn a_break_shot_misses_no_impact_that_the_densest_sampling_finds() {
    let mut world = table(None);
    let end = world.time() + 30.0;
    let mut impacts = 0;
    while world.time() < end {
        let then = world.time();
        let flights: Vec<(Vec2, Vec2)> =
            world.bodies().map(|b| (b.centre(), b.velocity())).collect();
        impacts += world.step_to_next_event(end - then).impacts;
        let span = world.time() - then;
        // Between events all fly straight: the nearest that two come, |d + v t| at t = −d·v / v², is
        // what sampling would find however dense it were.
        for (i, (at, velocity)) in flights.iter().enumerate() {
            for (other, its) in &flights[i + 1..] {
                let (d, v) = (*other - *at, *its - *velocity);
                let closest = (-d.dot(v) / v.length_squared()).clamp(0.0, span);
                if v != Vec2::ZERO {
                    let gap = (d + v * closest).length() - 2.0 * RADIUS;
                    assert!(gap > -1e-12, "passed through by {gap:e} m after {then:?}");
                }
            }
        }
        // And none is invented: bodies touch at an impact.
        for event in world.events() {
            if let EventKind::Impact { a, b, speed, .. } = event.kind {
                let centre = |id| world.body(id).expect("it struck").centre();
                let gap = (centre(b) - centre(a)).length() - 2.0 * RADIUS;
                assert!(gap.abs() < 1e-12 && speed > 0.0, "{gap:e} m, {speed} m/s");
            }
        }
    }
    let mut whole = table(None);
    assert_eq!(whole.step(30.0).impacts, impacts);
    assert!(impacts > 100, "only {impacts}");
}
