//! Large piles: neither threads nor how steps are cut change a bit.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, boxed, put};

/// A pyramid of 78 rows, 3,081 boxes of 1 m with some 9,000 contacts, and a box that strikes it.
fn struck_pyramid(settings: Settings) -> World {
    let mut world = pyramid(settings);
    let thrown = BodyDef::dynamic()
        .at(vec2(-45.0, 20.0))
        .moving(vec2(30.0, 0.0));
    put(&mut world, thrown, block(1.0, 1.0), Material::default());
    world
}

fn pyramid(settings: Settings) -> World {
    pyramids(settings, 1, 78)
}

/// So many pyramids side by side, of so many rows.
fn pyramids(settings: Settings, count: u32, rows: u32) -> World {
    let mut world = World::new(settings).expect("valid");
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    put(&mut world, floor, block(4000.0, 2.0), Material::default());
    for number in 0..count {
        let left = 1.25 * f64::from(rows * number) - 0.5 * f64::from(rows);
        for row in 0..rows {
            for k in 0..rows - row {
                let x = left + f64::from(k) + 0.5 * f64::from(row);
                let at = vec2(x, 0.5 + f64::from(row));
                boxed(&mut world, at, Material::default());
            }
        }
    }
    world
}

fn settings(mode: Mode, threads: usize) -> Settings {
    Settings {
        mode,
        threads,
        sleep: None,
        ..Settings::default()
    }
}

// It cannot fail until the engine has threads.
#[test]
fn the_number_of_threads_changes_no_bit_of_a_large_pile() {
    for mode in [Mode::Stepped, Mode::Hybrid] {
        let ends = [1, 2, 3].map(|threads| {
            let mut world = struck_pyramid(settings(mode, threads));
            let ends = (0..40).map(|_| {
                world.step(1.0 / 60.0);
                world.state_hash()
            });
            ends.collect::<Vec<_>>()
        });
        assert!(ends[1] == ends[0], "two threads give other bits than one");
        assert!(ends[2] == ends[0], "three threads give other bits than one");
    }
}

#[test]
fn how_a_step_is_cut_changes_no_bit_of_a_large_pile() {
    for mode in [Mode::Stepped, Mode::Hybrid] {
        let mut whole = struck_pyramid(settings(mode, 1));
        let mut cut = struck_pyramid(settings(mode, 1));
        whole.step(0.5);
        for _ in 0..64 {
            cut.step(1.0 / 128.0);
        }
        assert!(whole.state_hash() == cut.state_hash(), "{mode:?}");
    }
}

#[test]
fn how_a_tick_is_cut_changes_no_bit_of_many_piles() {
    for mode in [Mode::Stepped, Mode::Hybrid] {
        let mut worlds = [1, 2].map(|_| pyramids(settings(mode, 1), 62, 10));
        // In hybrid mode it takes the calendar queue 46 ticks to forget that they were free.
        for tick in 0..72 {
            for (world, cuts) in worlds.iter_mut().zip([1, 2]) {
                if tick == 60 {
                    let top = world.bodies().nth(55).expect("the top of the first").id();
                    let thrown = world.set_velocity(top, vec2(1.0, -2.0), 0.0);
                    thrown.expect("it moves");
                }
                (0..cuts).for_each(|_| {
                    world.step(1.0 / 60.0 / f64::from(cuts));
                });
            }
            let [whole, cut] = &worlds;
            assert!(
                whole.state_hash() == cut.state_hash(),
                "{mode:?}, tick {tick}"
            );
            let [whole, cut] = [whole, cut].map(World::energy);
            assert_eq!(whole.friction.to_bits(), cut.friction.to_bits());
        }
    }
}
