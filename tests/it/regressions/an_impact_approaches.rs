//! Two that touch may be struck together because of a third, or by a rounding: the speed of approach of such an impact was told as
//! below 0, by up to 2.4e-5 m/s.

use carom_dynamics::{BodyDef, EventKind, Material, Mode, Settings, World};
use carom_geometry::{Compound, Shape};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

/// An L of two blocks, and two discs in a row that lie against both of its legs.
fn against_an_l(mode: Mode) -> World {
    let settings = Settings {
        mode,
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let size = 0.630_219_016_091_465_7;
    let leg = |w, h, at| (Shape::from(block(w * size, h * size)), Pose::at(at * size));
    let legs = [
        leg(1.0, 0.3, vec2(0.5, 0.15)),
        leg(0.3, 0.7, vec2(0.15, 0.65)),
    ];
    let angle = Compound::new(legs).expect("an L");
    let fixed = BodyDef::fixed().at(vec2(1.5, -2.0));
    put(&mut world, fixed, angle, surface(0.0, 0.5));
    let size = 0.818_996_740_470_259;
    let end = |x: f64| {
        let end = disc(0.4 * size).translated(vec2(x * size, 0.0));
        (end.into(), surface(1.0, 0.0))
    };
    let ends: Vec<(Shape, Material)> = vec![end(-0.5), end(0.5)];
    let loose = BodyDef::dynamic().at(vec2(1.5, -1.5));
    world.insert_compound(loose, ends).expect("valid");
    world
}

#[test]
fn an_impact_approaches() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let mut world = against_an_l(mode);
        let mut impacts = 0;
        for parts in [1284.0, 1024.0, 1024.0] {
            world.step(parts / 65_536.0);
            for event in world.events() {
                if let EventKind::Impact { speed, .. } = event.kind {
                    assert!(speed >= 0.0, "{speed:e} m/s, {mode:?}");
                    impacts += 1;
                }
            }
        }
        // The engine, which the default mode leaves them to, sees no approach at all.
        assert!(impacts > 0 || mode == Mode::Hybrid, "nothing was struck");
    }
}
