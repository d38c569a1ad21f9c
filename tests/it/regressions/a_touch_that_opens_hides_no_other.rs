//! A disc and a pentagon of one body bounce in a corner until the disc touches as slowly as a rounding and is pulled off its
//! wall. The pair was not searched again before its window ended: the pentagon fell 3.4 m through the floor, and the report
//! said exact.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_geometry::{Circle, Compound, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::scenes::put;

const FAR: f64 = 5.442619620964402;

#[test]
fn a_touch_that_opens_hides_no_other() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let settings = Settings {
            gravity: vec2(0.0, -10.0),
            mode,
            sleep: None,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let smooth = Material {
            friction: 0.0,
            restitution: 0.0,
            ..Material::default()
        };
        for inward in [Vec2::Y, Vec2::X, -Vec2::X] {
            let wall = HalfPlane::new(-inward * FAR, inward).expect("a unit normal");
            put(&mut world, BodyDef::fixed(), wall, smooth);
        }
        let body = BodyDef::dynamic()
            .at(vec2(-3.3, -1.1))
            .moving(vec2(-2.9121953116172326, -0.7604750559318627))
            .spinning(3.4915236591340033)
            .turned(-3.2561735180108);
        let material = Material {
            density: 4.174542215106872,
            restitution: 0.118909448039207,
            ..smooth
        };
        let id = put(&mut world, body, disc_and_pentagon(), material);
        world.step(2.0);
        let lowest = world.body(id).expect("it stays").aabb().min.y;
        assert!(
            lowest > -FAR - 1e-3,
            "{mode:?}: it reaches down to {lowest}"
        );
    }
}

fn disc_and_pentagon() -> Compound {
    let disc: Shape = Circle::new(0.3158938768296714)
        .expect("a radius")
        .translated(vec2(-0.3509931964774127, 0.0))
        .into();
    let pentagon: Shape = ConvexPolygon::new([
        vec2(0.15729657391481033, 0.20467092333370052),
        vec2(0.26899883708662803, -0.12780758653165833),
        vec2(0.49867963506760865, -0.1719736023566568),
        vec2(0.508259334406369, 0.05527945499488824),
        vec2(0.4101448843962809, 0.28889123966257535),
    ])
    .expect("convex")
    .into();
    Compound::new([(disc, Pose::IDENTITY), (pentagon, Pose::IDENTITY)]).expect("two parts")
}
