//! A bar with a disc at either end that rolls over one of them and falls flat: the touch passes from disc to bar without a blow, and a moment
//! later the far end comes down at several m/s. That was taken for the last of a series of rockings; the engine got the body, and took 10 J.

use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_geometry::{Circle, Shape};
use carom_math::vec2;
use carom_tests::scenes::{block, floor};

#[test]
fn the_far_end_of_a_capsule_strikes() {
    let disc = Shape::from(Circle::new(0.4).expect("a disc"));
    let shapes = [
        block(1.4, 0.8).into(),
        disc.translated(vec2(0.7, 0.0)),
        disc.translated(vec2(-0.7, 0.0)),
    ];
    for k in 0..12 {
        let mut world = World::new(Settings::default()).expect("valid settings");
        floor(&mut world, Material::default());
        let def = BodyDef {
            angle: 0.1 + 0.1 * f64::from(k),
            ..BodyDef::dynamic().at(vec2(0.0, 1.2))
        };
        let parts = shapes.clone().map(|shape| (shape, Material::default()));
        world
            .insert_compound(def, parts.to_vec())
            .expect("a capsule");
        for _ in 0..180 {
            let report = world.step(1.0 / 60.0);
            assert_eq!(report.unresolved, 0, "{k}: {report:?}");
        }
        let energy = world.energy();
        assert!(energy.impacts > 1.0, "{k}: {energy:?}");
        assert!(
            energy.scheme.abs() < 1e-2 * energy.impacts,
            "{k}: {energy:?}"
        );
    }
}
