//! A plank that is struck rests again at that instant, and what bounced off it more slowly than rest lands on it then. As many bodies
//! waited for their method as before, so none got one: the box flew on, unknown to all, through the plank, and the report said exact.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, disc, floor, put, surface};

#[test]
fn what_rests_again_is_landed_on_at_once() {
    for (mode, is_round) in [
        (Mode::Exact, false),
        (Mode::Exact, true),
        (Mode::Hybrid, false),
        (Mode::Hybrid, true),
    ] {
        for k in 1..=20_u8 {
            let mut world = World::new(Settings {
                mode,
                ..Settings::default()
            })
            .expect("settings");
            let (material, bouncy) = (surface(0.0, 0.5), surface(0.6, 0.5));
            floor(&mut world, material);
            let plank = BodyDef::dynamic().at(vec2(0.0, 0.05));
            put(&mut world, plank, block(1.0, 0.1), material);
            // It comes down at 0.06 to 0.3 m/s.
            let above = 1e-4 * f64::from(k) * f64::from(k).sqrt();
            let def = BodyDef::dynamic().at(vec2(0.0, 0.3 + above));
            let falls = if is_round {
                put(&mut world, def, disc(0.2), bouncy)
            } else {
                put(&mut world, def, block(0.4, 0.4), bouncy)
            };
            let mut is_exact = true;
            for _ in 0..120 {
                is_exact &= world.step(1.0 / 240.0).is_exact();
                let height = world.body(falls).expect("it is there").centre().y;
                let deep = if is_exact { 1e-9 } else { 1e-3 };
                assert!(height > 0.3 - deep, "{mode:?}, {above} m: at {height} m");
            }
        }
    }
}
