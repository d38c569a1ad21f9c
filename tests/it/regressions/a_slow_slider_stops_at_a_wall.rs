//! What slid or rolled over a floor more slowly than counts as rest went through any wall in its way: its group knew
//! nothing of a touch to come, and its modes were not solved for again because no motion had changed.

use carom_dynamics::{BodyDef, Settings, World};
use carom_geometry::{Polygon, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::gas::deepest;
use carom_tests::scenes::{block, disc, put, surface};

#[test]
fn a_slow_slider_stops_at_a_wall() {
    let shapes = [
        (Shape::from(block(1.0, 1.0)), 0.0),
        (disc(0.5).into(), 0.0),
        (disc(0.5).into(), 0.3),
    ];
    for (shape, friction) in shapes {
        for speed in [0.005, 0.02, 0.05, 0.3] {
            for one_body in [true, false] {
                let ground = surface(0.0, friction);
                let mut world = World::new(Settings {
                    sleep: None,
                    ..Settings::default()
                })
                .expect("valid settings");
                if one_body {
                    let corners = [
                        (-5.0, -1.0),
                        (2.0, -1.0),
                        (2.0, 3.0),
                        (1.0, 3.0),
                        (1.0, 0.0),
                        (-5.0, 0.0),
                    ];
                    let corners = corners.map(|(x, y)| vec2(x, y)).to_vec();
                    put(
                        &mut world,
                        BodyDef::fixed(),
                        Polygon::new(corners).expect("an L"),
                        ground,
                    );
                } else {
                    put(
                        &mut world,
                        BodyDef::fixed().at(vec2(0.0, -0.5)),
                        block(10.0, 1.0),
                        ground,
                    );
                    put(
                        &mut world,
                        BodyDef::fixed().at(vec2(1.5, 1.5)),
                        block(1.0, 3.0),
                        ground,
                    );
                }
                let rolls = if friction > 0.0 { -speed / 0.5 } else { 0.0 };
                let def = BodyDef::dynamic()
                    .at(vec2(0.48, 0.5))
                    .moving(vec2(speed, 0.0))
                    .spinning(rolls);
                let id = put(&mut world, def, shape.clone(), ground);
                let what = format!("µ = {friction}, {speed} m/s, one body: {one_body}");
                let mut before = world.energy().mechanical();
                for _ in 0..600 {
                    world.step(1.0 / 120.0);
                    let (deep, now) = (deepest(&world), world.energy().mechanical());
                    assert!(deep < 1e-12, "{deep:e} of its size deep, {what}");
                    assert!(now <= before + 1e-14, "gained {:e} J, {what}", now - before);
                    before = now;
                }
                let body = world.body(id).expect("it is there");
                assert!((body.centre() - vec2(0.5, 0.5)).length() < 1e-12, "{what}");
                assert_eq!(body.velocity(), Vec2::ZERO, "{what}");
            }
        }
    }
}
