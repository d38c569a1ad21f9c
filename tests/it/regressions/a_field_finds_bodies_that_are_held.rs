//! A field that came while a contact was held in closed form left that form in charge, found without it, and the contact was
//! not looked at again: a box that had fallen on its corner and lay down on ice fell through it, by 0.45 m in 0.3 s.

use carom_dynamics::{BodyDef, Mode, RadialField, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, floor, put, surface};

#[test]
fn a_field_finds_bodies_that_are_held() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let settings = Settings {
            gravity: vec2(0.0, -10.0),
            mode,
            sleep: None,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let ice = surface(0.0, 0.0);
        floor(&mut world, ice);
        let def = BodyDef::dynamic().at(vec2(0.0, 0.8)).turned(0.3);
        let id = put(&mut world, def, block(1.0, 1.0), ice);
        world.step(0.3);
        // A field without strength is as good as none.
        world.add_field(RadialField::new(vec2(0.0, 5.0), 0.0, 1.0).expect("valid"));
        world.step(0.3);
        let sunk = 0.5 - world.body(id).expect("it stays").centre().y;
        assert!(sunk.abs() < 1e-3, "{sunk} m, {mode:?}");
    }
}
