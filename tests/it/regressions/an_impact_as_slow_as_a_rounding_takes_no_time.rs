//! What one impact counts as its instant is longer the slower it is: all searches of others within it were done first, at
//! 1e-30 m/s those of 1e18 s. A body of no more speed than rounding left it hung the step of the whole world.

use carom_dynamics::{BodyDef, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

#[test]
fn an_impact_as_slow_as_a_rounding_takes_no_time() {
    for e in [0.0, 0.5, 1.0] {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            sleep: None,
            ..Settings::default()
        })
        .expect("valid settings");
        let material = surface(e, 0.2);
        for side in [-1.0, 1.0] {
            let wall = BodyDef::fixed().at(vec2(5.5 * side, 0.0));
            put(&mut world, wall, block(1.0, 20.0), material);
        }
        let creeps = BodyDef::dynamic().moving(vec2(-1e-30, 0.0));
        put(&mut world, creeps.at(vec2(-4.5, 0.0)), disc(0.5), material);
        for height in [2.0, 4.0, 6.0] {
            let flies = BodyDef::dynamic().at(vec2(0.0, height));
            let flies = flies.moving(vec2(3.0, 0.0));
            put(&mut world, flies, disc(0.5), material);
        }
        let report = world.step(10.0);
        assert!(report.impacts < 1000, "{} impacts, e = {e}", report.impacts);
    }
}
