//! A floor bears any number of landings in a tick. The budget of impacts was charged to both bodies of an impact, fixed ones too: from
//! the 257th disc on each landing was no impact, but a collapse.

use carom_dynamics::{BodyDef, EventKind, Material, Settings, World};
use carom_geometry::{Circle, HalfPlane};
use carom_math::{Vec2, vec2};

#[test]
fn a_floor_bears_any_number_of_landings() {
    let mut world = World::new(Settings::default()).expect("valid settings");
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
    world
        .insert(BodyDef::fixed(), floor, Material::default())
        .expect("valid");
    for k in 0..300_u32 {
        let disc = Circle::new(0.1).expect("a disc");
        let def = BodyDef::dynamic().at(vec2(f64::from(k), 1.0));
        world.insert(def, disc, Material::default()).expect("valid");
    }
    // 0.9 m at 9.81 m/s²: 0.43 s.
    let report = world.step(0.5);
    let struck = world
        .events()
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Impact { .. }));
    assert_eq!((struck.count(), report.collapsed), (300, 0), "{report:?}");
}
