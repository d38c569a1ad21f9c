//! A corner that slides beyond the foot of a ramp meets its face within the tick. Where the face ends as the tick begins there
//! was a contact of the edge behind the corner, which closes at half the rate: corners went 11 mm into the ramp of the thesis
//! scene.

use carom_dynamics::{BodyDef, Settings};
use carom_geometry::ConvexPolygon;
use carom_math::{Vec2, vec2};
use carom_tests::gas::numbers;
use carom_tests::overlaps;
use carom_tests::scenes::{floor, put, stepped, surface};

#[test]
fn a_corner_slides_onto_a_ramp() {
    let mut next = numbers(3);
    let mut between = |least: f64, most: f64| least + (most - least) * next();
    let mut deepest = 0.0_f64;
    for _ in 0..200 {
        let mut world = stepped(Settings {
            gravity: vec2(0.0, -9.81),
            ..Settings::default()
        });
        let material = surface(0.0, 0.2);
        floor(&mut world, material);
        let ramp = [Vec2::ZERO, vec2(4.5, 0.0), vec2(0.0, 3.0)];
        let ramp = ConvexPolygon::new(ramp).expect("a ramp");
        put(&mut world, BodyDef::fixed(), ramp, material);
        let def = BodyDef::dynamic()
            .at(vec2(6.0 + between(0.0, 0.1), between(0.9, 1.0)))
            .turned(between(0.0, 1.2))
            .moving(vec2(between(-6.0, -2.0), 0.0));
        let pentagon = ConvexPolygon::regular(5, 0.9).expect("a pentagon");
        put(&mut world, def, pentagon, material);
        for _ in 0..90 {
            world.step(1.0 / 60.0);
            deepest = deepest.max(overlaps(&world).0);
        }
    }
    // It was 12 mm.
    assert!(deepest < 2e-3, "{deepest:e} m deep");
}
