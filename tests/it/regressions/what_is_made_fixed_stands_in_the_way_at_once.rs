//! A body was made fixed in the midst of a sub-step, and another one that was sub-stepped flew into it until the next one began.

use carom_dynamics::{BodyDef, BodyKind, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

#[test]
fn what_is_made_fixed_stands_in_the_way_at_once() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let settings = Settings {
            mode,
            gravity: vec2(0.0, -10.0),
            substep: 1.0 / 60.0,
            sleep: None,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let rough = surface(0.0, 0.5);
        put(&mut world, BodyDef::fixed(), block(20.0, 1.0), rough);
        // Two that roll after one another, so close that they meet within a sub-step once the first stands.
        let at = |x: f64| BodyDef::dynamic().at(vec2(x, 1.0)).moving(Vec2::X);
        let first = put(&mut world, at(1.001), disc(0.5), rough);
        let second = put(&mut world, at(0.0), disc(0.5), rough);
        world.step(2.0 / 60.0 + 0.001);
        world.set_kind(first, BodyKind::Fixed).expect("it is there");
        world.step(0.015);
        let x = |id| world.body(id).expect("it is there").centre().x;
        let gap = x(first) - x(second) - 1.0;
        assert!(gap > -1e-9, "{mode:?}: they overlap by {} m", -gap);
    }
}
