//! A body that was removed, or turned to another kind, between the instant at which its impact was
//! foreseen and the impact itself: the event queue still named its pair, and the step panicked.

use carom_dynamics::{BodyDef, BodyKind, Material, Settings, World};
use carom_geometry::Circle;
use carom_math::vec2;

#[test]
fn a_removed_body_strikes_nothing() {
    for seconds in [0.0, 1e-4, 3e-4, 1e-3, 0.1] {
        for removed in [true, false] {
            let settings = Settings {
                gravity: vec2(0.0, 0.0),
                ..Settings::default()
            };
            let mut world = World::new(settings).expect("settings");
            let disc = Circle::new(1.0).expect("a disc");
            let material = Material::default();
            let [first, second] = [-1.0, 1.0].map(|x| {
                // They meet 0.5 ms later: within the first sub-step.
                let def = BodyDef::dynamic().at(vec2(1.0005 * x, 0.0));
                let def = def.moving(vec2(-x, 0.0));
                world.insert(def, disc, material).expect("a disc")
            });
            world.step(seconds);
            if removed {
                world.remove(first).expect("it is there");
            } else {
                world.set_kind(first, BodyKind::Fixed).expect("a kind");
                world.set_kind(second, BodyKind::Fixed).expect("a kind");
            }
            let report = world.step(0.5);
            let late = seconds > 5e-4;
            assert!(report.impacts == 0 || late, "{seconds} s: {report:?}");
            let x = world.body(second).expect("it is there").centre().x;
            assert!(x.is_finite(), "{seconds} s: {x} m");
        }
    }
}
