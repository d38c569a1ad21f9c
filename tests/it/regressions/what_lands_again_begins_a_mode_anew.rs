//! A block that slid, was knocked up and landed was told as sliding twice, and never as open.

use carom_dynamics::{BodyDef, ContactMode, EventKind, Impulse, Mode, Settings, World};
use carom_geometry::{ConvexPolygon, HalfPlane};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::surface;

#[test]
fn what_lands_again_begins_a_mode_anew() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("settings");
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
        let smooth = surface(0.0, 0.0);
        world
            .insert(BodyDef::fixed(), floor, smooth)
            .expect("valid");
        let def = BodyDef::dynamic().at(vec2(0.0, 0.5)).moving(Vec2::X);
        let block = ConvexPolygon::square(1.0).expect("a block");
        let id = world.insert(def, block, smooth).expect("valid");
        let mut modes = Vec::new();
        for tick in 0..60 {
            if tick == 10 {
                let up = Impulse::central(vec2(0.0, 1.0));
                world.apply(id, up).expect("it is there");
            }
            world.step(1.0 / 60.0);
            let told = world.events().iter();
            modes.extend(told.filter_map(|event| match event.kind {
                EventKind::Mode { mode, .. } => Some(mode),
                _ => None,
            }));
        }
        let slides = [ContactMode::Slide, ContactMode::Open, ContactMode::Slide];
        assert_eq!(modes, slides, "{mode:?}");
    }
}
