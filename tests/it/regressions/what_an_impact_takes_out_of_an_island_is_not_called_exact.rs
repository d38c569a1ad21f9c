//! Bodies of an island that an impact in the midst of a sub-step takes apart went on by the accelerations that its contacts had given
//! them, without gravity where they had rested, until the sub-step ended: their energy rose in steps that were called exact, by 6e-4
//! of 1,305 J in script 2939 of exact mode, and by 3e-4 J here.

use carom_dynamics::{BodyDef, Impulse, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::checks::Closed;
use carom_tests::scenes::{block, disc, floor, put, surface};

/// Length of a sub-step, in s.
const H: f64 = 1.0 / 360.0;

#[test]
fn what_an_impact_takes_out_of_an_island_is_not_called_exact() {
    let smooth = surface(0.0, 0.0);
    for mode in [Mode::Hybrid, Mode::Exact] {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        floor(&mut world, smooth);
        let plate = BodyDef::dynamic().at(vec2(0.0, 0.25));
        let plate = put(&mut world, plate, block(2.0, 0.5), smooth);
        let spins = BodyDef::dynamic().at(vec2(0.2, 1.5)).spinning(5.0);
        put(&mut world, spins, disc(1.0), smooth);
        world.step(20.25 * H);
        let mass = world.body(plate).expect("it is there").mass();
        let kick = Impulse::at(vec2(0.9, 0.3), vec2(1.0, 0.3) * mass);
        world.apply(plate, kick).expect("a kick");
        for step in 0..20 {
            let before = Closed::of(&world);
            let report = world.step(0.03 * H);
            let kept = before.fell(&world, &report);
            assert_eq!(kept, Ok(()), "{mode:?}, step {step}: {report:?}");
        }
    }
}
