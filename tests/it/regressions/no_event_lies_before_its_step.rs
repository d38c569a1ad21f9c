//! Where sums of `dt` round past the grid of sub-steps, what was seen at its next instant was told for before the step began in
//! which it was seen, by up to 1e-9 of a sub-step; and the end of impacts that come ever faster for before the last of them.

use carom_dynamics::{BodyDef, EventKind, Mode, Settings, World};
use carom_math::{SimTime, vec2};
use carom_tests::scenes::{block, disc, floor, put, surface};

#[test]
fn no_event_lies_before_its_step_or_the_event_before() {
    let mut told = 0;
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        for dt in [1.0 / 60.0, 1.0 / 360.0, 0.1 / 3.0, 0.0123] {
            for e in [0.0, 0.4] {
                let settings = Settings {
                    mode,
                    ..Settings::default()
                };
                let mut world = World::new(settings).expect("valid settings");
                floor(&mut world, surface(e, 0.5));
                let mut last = world.time();
                for step in 0..200_u32 {
                    if step % 10 == 0 {
                        let at = vec2(0.7 * f64::from(step % 70) / 10.0 - 2.0, 2.0);
                        let def = BodyDef::dynamic().at(at).moving(vec2(0.3, -3.0));
                        if step % 20 == 0 {
                            put(&mut world, def, disc(0.3), surface(e, 0.5));
                        } else {
                            put(&mut world, def, block(0.6, 0.4), surface(e, 0.5));
                        }
                    }
                    last = last.max(world.time());
                    if step % 3 == 2 {
                        world.step_to_next_event(dt);
                    } else {
                        world.step(dt);
                    }
                    assert!(world.time() >= last, "time does not run back");
                    for event in world.events() {
                        assert!(
                            event.time >= last && event.time <= world.time(),
                            "{mode:?}, steps of {dt} s: {event:?} lies {:.1e} s before",
                            last - event.time
                        );
                        last = event.time;
                        told += 1;
                    }
                }
            }
        }
    }
    assert!(told > 1000, "{told} events");
}

/// A large island that fell asleep was told so at the beginning of the sub-step, with the time of its end.
#[test]
fn no_sleep_lies_after_its_step() {
    for dt in [0.007, 0.01, 1.0 / 60.0] {
        let mut world = World::new(Settings::default()).expect("valid settings");
        put(
            &mut world,
            BodyDef::fixed().at(vec2(0.0, -0.5)),
            block(40.0, 1.0),
            surface(0.0, 0.5),
        );
        for row in 0..8 {
            for column in 0..8 - row {
                let (x, y) = (f64::from(column) + 0.5 * f64::from(row), f64::from(row));
                let def = BodyDef::dynamic()
                    .at(vec2(x, 0.5 + y))
                    .moving(vec2(0.01 * y, 0.0));
                put(&mut world, def, block(1.0, 1.0), surface(0.0, 0.5));
            }
        }
        let mut slept = 0;
        for k in 0.. {
            if world.time() > SimTime::ZERO + 6.0 {
                break;
            }
            if k % 2 == 0 {
                world.step(dt);
            } else {
                world.step_to_next_event(dt);
            }
            for event in world.events() {
                assert!(
                    event.time <= world.time(),
                    "{event:?} at {:?}",
                    world.time()
                );
                slept += usize::from(matches!(event.kind, EventKind::Asleep(_)));
            }
        }
        assert!(slept >= 36, "{slept}");
    }
}
