//! A disc of 1000 kg rests analytically in a corner, and a thin box comes near it slower than rest. The solver held the two across their
//! gap, and gave the disc a motion with gravity, but had not woken it: it fell through the floor, and on for ever.

use carom_dynamics::{BodyDef, Mode};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface, walled};

#[test]
fn a_sleeper_that_is_neared_does_not_fall() {
    for (angle, velocity, spin) in [
        (1.0, vec2(0.0, -4.0), -149.0),
        (-2.3, vec2(-1.0, -3.0), -197.0),
        (-2.8, vec2(0.0, -4.0), 97.0),
    ] {
        let material = surface(0.0, 0.0);
        let mut world = walled(Mode::Hybrid, Vec2::ONE, material);
        let spins = BodyDef::dynamic().at(vec2(-0.2, -0.1)).turned(angle);
        let spins = spins.moving(velocity).spinning(spin).with_mass(1.0);
        put(&mut world, spins, block(0.8, 0.2), material);
        let heavy = BodyDef::dynamic().at(vec2(0.8, 0.8));
        let heavy = heavy.moving(vec2(-3.0, -2.0)).with_mass(1000.0);
        let disc = put(&mut world, heavy, disc(0.15), material);
        for _ in 0..480 {
            world.step(1.0 / 240.0);
            let low = world.body(disc).expect("it stays").centre().y;
            assert!(low > -0.851, "at {low} m, {:?}", world.time());
        }
    }
}
