//! A cross that rocks on the ends of two of its arms: of the corners that come down next only those beside the corner on its own arm were
//! known. So the end of the series was not seen, and its landings went on until the engine took the body: 60 landings and 190 sub-steps.

use carom_dynamics::geometry::{Polygon, Shape};
use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, floor};

#[test]
fn concave_bodies_come_to_rest_by_rocking() {
    let (arm, half) = (0.8, 0.15);
    let quarter = [vec2(half, half), vec2(half, arm), vec2(-half, arm)];
    let ring = (0..4).flat_map(|turn| {
        let turned = move |corner: Vec2| (0..turn).fold(corner, |c, _| c.perp());
        quarter.map(turned)
    });
    let whole = Polygon::new(ring.collect::<Vec<_>>()).expect("a cross");
    for shapes in [
        vec![Shape::from(whole)],
        vec![
            block(2.0 * arm, 2.0 * half).into(),
            block(2.0 * half, 2.0 * arm).into(),
        ],
    ] {
        for angle in [-0.34, 0.5, 0.9, 1.2] {
            let mut world = World::new(Settings::default()).expect("valid settings");
            floor(&mut world, Material::default());
            let def = BodyDef {
                angle,
                ..BodyDef::dynamic().at(vec2(0.0, 1.2))
            };
            let parts = shapes
                .iter()
                .map(|shape| (shape.clone(), Material::default()));
            let id = world
                .insert_compound(def, parts.collect())
                .expect("a cross");
            let mut solved = 0;
            for _ in 0..360 {
                let report = world.step(1.0 / 60.0);
                assert!(report.is_exact(), "{angle}: {report:?}");
                solved += report.modes_solved;
            }
            assert!(solved < 30, "{angle}: {solved} mode solves");
            let body = world.body(id).expect("it stays");
            assert!(body.is_asleep(), "{angle}: {:?}", body.velocity());
        }
    }
}
