//! A polygon that rolls along a floor struck it up to 69 times within a tick: six bodies and fewer stayed with their exact
//! impacts, however many these were. No Zeno series with one restitution has more than 30 losses of speed until it ends.

use core::f64::consts::TAU;

use carom_dynamics::{BodyDef, EventKind, Mode, Settings, World};
use carom_geometry::{ConvexPolygon, HalfPlane};
use carom_math::trig::sin_cos;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::surface;

#[test]
fn few_bodies_that_rattle_join_the_engine() {
    let (e, friction, per_tick) = (0.2, 0.6, 1.0 / 60.0);
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -10.0),
        mode: Mode::Hybrid,
        ..Settings::default()
    })
    .expect("settings");
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
    let floor = world.insert(BodyDef::fixed(), floor, surface(e, friction));
    floor.expect("valid");
    for k in 0..1000_u32 {
        let (x, corners) = (f64::from(k), 3 + k % 6);
        let corner = |i: u32| {
            let uneven = f64::from((7 * k + 5 * i) % 11) / 14.0;
            let (sin, cos) = sin_cos(TAU * (f64::from(i) + uneven) / f64::from(corners));
            0.4 * vec2(cos, sin)
        };
        let polygon =
            ConvexPolygon::new((0..corners).map(corner).collect::<Vec<_>>()).expect("a polygon");
        let def = BodyDef::dynamic()
            .at(vec2(3.0 * x, 1.0 + 0.001 * x))
            .turned(0.37 * x)
            .moving(vec2(6.0 - 0.012 * x, 0.0))
            .spinning(5.0 - 0.01 * x);
        let thrown = world.insert(def, polygon, surface(e, friction));
        thrown.expect("valid");
    }
    let mut most = 0;
    for _ in 0..90 {
        world.step(per_tick);
        let (mut struck, mut last) = (vec![0_u32; 1001], vec![None; 1001]);
        for event in world.events().iter() {
            if let EventKind::Impact { a, b, .. } = event.kind {
                for id in [a, b] {
                    // What comes down on two corners strikes once.
                    let before = last[id.index()].replace(event.time);
                    struck[id.index()] += u32::from(before != Some(event.time));
                }
            }
        }
        most = struck[1..].iter().copied().fold(most, u32::max);
    }
    // 32 losses of 1 − e, and the one that exceeds them.
    assert!(most > 8, "{most}: nothing bounced");
    assert!(most <= 41, "{most} impacts of one body in a tick");
}
