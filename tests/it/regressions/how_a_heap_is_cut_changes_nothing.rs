//! Where steps end changes no bit of a heap. It did, in exact mode: a body that left the path of a group that turns, in the
//! midst of a sub-step, was forgotten where a step ended. In hybrid mode, too: a member of a large island, read in the midst of a
//! sub-step, was where it had been when a step had last ended, and a step that ended after a body had joined took the impact back
//! that made it join; and a body that fell asleep and woke at one look was moved back by a sub-step.

use carom_dynamics::{Mode, Motion, Settings, World};
use carom_math::{SimTime, vec2};
use carom_tests::scenes::{self, any_disc, any_shape};

/// Ticks that are looked at.
const TICKS: u32 = 180;

fn heap((seed, mixed, mode): (u64, bool, Mode)) -> World {
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -9.81),
        mode,
        ..Settings::default()
    })
    .expect("valid settings");
    scenes::heap(&mut world, seed, if mixed { any_shape } else { any_disc });
    world
}

/// Motions of all bodies after each tick, with steps that end as `advance` says, which is told how long a tick has still to go.
fn motions(mut world: World, advance: impl Fn(&mut World, f64)) -> Vec<Vec<Motion>> {
    let ticks = 1..=TICKS;
    let after = |tick| {
        let end = SimTime::multiple(u64::from(tick), 1.0 / 60.0);
        while end - world.time() > 0.0 {
            let left = end - world.time();
            advance(&mut world, left);
        }
        world.bodies().map(|body| *body.motion()).collect()
    };
    ticks.map(after).collect()
}

#[test]
fn how_a_heap_is_cut_changes_nothing() {
    for which in [
        (2, false, Mode::Exact),
        (3, false, Mode::Exact),
        (9, false, Mode::Exact),
        (30, true, Mode::Exact),
        (7, true, Mode::Hybrid),
        (41, true, Mode::Hybrid),
    ] {
        let whole = motions(heap(which), |world, left| {
            world.step(left);
        });
        let at_events = motions(heap(which), |world, left| {
            world.step_to_next_event(left);
        });
        let in_parts = motions(heap(which), |world, left| {
            world.step(left.min(1.0 / 420.0));
        });
        for (tick, ((one, two), three)) in (1..).zip(whole.iter().zip(&at_events).zip(&in_parts)) {
            assert!(one == two && one == three, "heap {which:?}, tick {tick}");
        }
    }
}
