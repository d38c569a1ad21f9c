//! A group that turns was left by a contact that opened with nothing to take its bodies in: until the next sub-step they
//! were pushed along the arms of that instant, and gained angular momentum, while the report called the step exact.
//! Found by `conservation::two_bodies_in_empty_space_keep_both_momenta`.

use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::{Vec2, trig, vec2};

fn squeezed(sides: usize, radius: f64, by: f64) -> ConvexPolygon {
    let round = ConvexPolygon::regular(sides, radius).expect("a regular polygon");
    let points = round.vertices().iter().map(|v| vec2(v.x, v.y * by));
    ConvexPolygon::new(points.collect::<Vec<_>>()).expect("a squeezed polygon is convex")
}

#[test]
fn what_leaves_a_turning_group_is_not_called_exact() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        sleep: None,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let material = Material {
        friction: 0.008_727_556_938_829_27,
        restitution: 0.0,
        ..Material::default()
    };
    let heavy = Material {
        density: trig::pow(10.0, 0.578_918_104_469_957_6),
        ..material
    };
    let speed = 8.552_543_684_478_335;
    let sliver = squeezed(4, 0.370_614_795_163_569_54, 0.002_720_326_0);
    let other = squeezed(5, 1.671_299_791_081_688_5, 0.169_872_00);
    let comes = BodyDef::dynamic()
        .at(vec2(-4.5, -0.062_264_582_819_903_394))
        .moving(vec2(speed, -0.196_814_971_819_989_1 * speed))
        .spinning(3.591_902_063_589_397);
    world.insert(comes, sliver, material).expect("valid");
    let stands = BodyDef::dynamic().spinning(-7.420_787_676_236_943);
    world.insert(stands, other, heavy).expect("valid");
    let before = world.momentum().angular;
    let (mut exact, mut kept) = (true, true);
    for _ in 0..120 {
        exact &= world.step(1.0 / 60.0).is_exact();
        kept &= (world.momentum().angular - before).abs() < 1e-10 * 36.6;
        assert!(kept || !exact, "at {} s", world.time().as_secs());
    }
}
