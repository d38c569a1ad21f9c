//! What wakes in the engine, or joins it, in the midst of a sub-step lies where it is until the next one. A step that ended before that
//! said that every motion came from a closed form: a box stood in the air, and what fell on it sank in.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, floor, put, surface};

/// A column of boxes falls asleep; the lowest is taken out in the midst of a sub-step.
fn column(mode: Mode, count: u32, damping: f64) {
    let settings = Settings {
        mode,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    floor(&mut world, surface(0.0, 0.5));
    let ids: Vec<_> = (0..count)
        .map(|k| {
            let def = BodyDef::dynamic().at(vec2(0.0, 0.5 + f64::from(k)));
            let def = def.damped(damping, damping);
            put(&mut world, def, block(1.0, 1.0), surface(0.0, 0.5))
        })
        .collect();
    world.step(20.0);
    let asleep = ids
        .iter()
        .all(|id| world.body(*id).is_some_and(|b| b.is_asleep()));
    assert!(asleep, "{mode:?}, {count} boxes");
    world.step(1e-3);
    world.remove(ids[0]).expect("it is there");
    let above = world.body(ids[1]).expect("it is there").centre();
    let report = world.step(1e-3);
    let now = world.body(ids[1]).expect("it is there").centre();
    assert!(
        now.y < above.y || !report.is_exact(),
        "{mode:?}, {count} boxes: {report:?}"
    );
}

#[test]
fn what_waits_for_the_engine_is_not_called_exact() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for count in [2, 20, 80] {
            for damping in [0.0, 0.5] {
                column(mode, count, damping);
            }
        }
    }
}
