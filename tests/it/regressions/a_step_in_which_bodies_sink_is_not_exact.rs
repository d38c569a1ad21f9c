//! A step was called exact in which bodies sank 0.5 mm into each other between impacts at the start of each sub-step.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::elastic;
use carom_tests::scenes::{disc, put};

#[test]
fn a_step_in_which_bodies_sink_is_not_exact() {
    let settings = Settings {
        mode: Mode::Exact,
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    for (depth, sunken) in [(1e-6, true), (0.0, false)] {
        let mut world = World::new(settings).expect("valid settings");
        put(&mut world, BodyDef::fixed(), disc(0.5), elastic());
        let beside = BodyDef::dynamic()
            .at(vec2(1.0 - depth, 0.0))
            .moving(vec2(0.0, 0.1));
        put(&mut world, beside, disc(0.5), elastic());
        let report = world.step(1.0 / 60.0);
        assert_eq!(report.sunken > 0, sunken, "{report:?}");
        assert!(!(sunken && report.is_exact()), "{report:?}");
    }
}
