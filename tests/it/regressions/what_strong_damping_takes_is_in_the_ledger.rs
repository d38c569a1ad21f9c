//! What damping takes was summed by four points over a piece of a flight, which is long against 1/c where c is large: of a disc of
//! 0.25 m at 3 m/s a third was missing at 1e6 per second, all of it at 1e9.

use carom_dynamics::{BodyDef, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::elastic;
use carom_tests::scenes::{disc, put};

#[test]
fn what_strong_damping_takes_is_in_the_ledger() {
    for c in [1.0, 1e2, 1e4, 1e6, 1e9] {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            sleep: None,
            ..Settings::default()
        })
        .expect("valid");
        let def = BodyDef::dynamic().moving(vec2(3.0, 1.0)).spinning(2.0);
        put(&mut world, def.damped(c, c), disc(0.25), elastic());
        let kinetic = world.energy().kinetic;
        world.step(1.0);
        let energy = world.energy();
        assert!(
            energy.scheme.abs() < 1e-9 * kinetic,
            "{c}/s: {energy:?} of {kinetic} J"
        );
    }
}
