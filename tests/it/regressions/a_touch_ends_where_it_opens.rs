//! What a contact mode opened was told to touch until its group changed for another reason: a disc that left a corner for
//! 0.25 s, the longest stretch of a path, and 0.18 m; a block that brakes less than the one behind it until one of them stopped.

use carom_collision::shape_distance;
use carom_dynamics::{BodyDef, BodyId, ContactMode, EventKind, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, disc, put, surface};

/// A pair that parts, in a world.
fn scenes(mode: Mode) -> [(World, [BodyId; 2]); 2] {
    let settings = Settings {
        mode,
        ..Settings::default()
    };
    let mut slides = World::new(settings).expect("valid settings");
    let square = put(
        &mut slides,
        BodyDef::fixed(),
        block(1.0, 1.0),
        surface(0.0, 0.0),
    );
    let def = BodyDef::dynamic().at(vec2(0.4, 1.2)).moving(vec2(1.0, 0.0));
    let round = put(&mut slides, def, disc(0.7), surface(0.0, 0.0));
    let mut brakes = World::new(settings).expect("valid settings");
    let floor = BodyDef::fixed().at(vec2(0.0, -0.5));
    put(&mut brakes, floor, block(100.0, 1.0), surface(0.0, 0.5));
    let blocks = [(0.0, 0.5), (1.0, 0.1)].map(|(x, friction)| {
        let def = BodyDef::dynamic().at(vec2(x, 0.5)).moving(vec2(3.0, 0.0));
        put(&mut brakes, def, block(1.0, 1.0), surface(0.0, friction))
    });
    [(slides, [square, round]), (brakes, blocks)]
}

fn gap(world: &World, ids: [BodyId; 2]) -> f64 {
    let [a, b] = ids.map(|id| world.body(id).expect("it stays"));
    let [one, two] = [a, b].map(|body| body.shapes().next().expect("a shape").0);
    shape_distance(one, two, b.pose().seen_from(a.pose())).distance
}

#[test]
fn a_touch_ends_where_it_opens() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for (mut world, ids) in scenes(mode) {
            let tick = world.settings().tick;
            let (mut opened, mut ended) = (None, None);
            while ended.is_none() && world.time().as_secs() < 1.0 {
                let report = world.step(1.0 / 1024.0);
                assert!(report.is_exact(), "{report:?}");
                let of_pair = |a: BodyId, b: BodyId| ids == [a, b] || ids == [b, a];
                for event in world.events() {
                    let at = event.time.as_secs();
                    match event.kind {
                        EventKind::Mode {
                            a,
                            b,
                            mode: ContactMode::Open,
                        } if of_pair(a, b) => opened = Some(at),
                        EventKind::End { a, b, .. } if of_pair(a, b) => ended = Some(at),
                        _ => {}
                    }
                }
                let touches = world
                    .contacts()
                    .any(|contact| of_pair(contact.a, contact.b));
                assert_eq!(touches, ended.is_none());
                let gap = gap(&world, ids);
                assert!(
                    ended.is_some() || gap < 1e-4,
                    "{mode:?}: told to touch at {gap} m"
                );
            }
            let late = ended.expect("it parts") - opened.expect("it opens");
            assert!(late < tick, "{mode:?}: told {late} s late");
        }
    }
}
