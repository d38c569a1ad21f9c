//! A body that was put to sleep in the air falls in free flight once gravity is another one. It woke into free flight and was listed as
//! sub-stepped as well: the next step had 4 sub-steps in which nothing was held.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, put};

#[test]
fn a_sleeper_flies_under_another_gravity() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("settings");
        let def = BodyDef::dynamic().asleep();
        let body = put(&mut world, def, block(1.0, 1.0), Material::default());
        world.step(1.0);
        world.set_gravity(vec2(0.0, -2.0)).expect("valid");
        let report = world.step(1.0);
        assert_eq!(report.substeps, 0, "{mode:?}");
        let centre = world.body(body).expect("it is there").centre();
        assert_eq!(centre, vec2(0.0, -1.0), "{mode:?}");
    }
}
