//! Where steps end changes no bit of a heap. It did, in exact mode: who left the path of a group that turns, in the midst of a
//! sub-step, was forgotten where a step ended. In hybrid mode, too: who looked at a member of a crowd in the midst of a sub-step saw
//! where it was when a step had last ended, and a step that ended after somebody had joined took the impact back that made it join;
//! and who fell asleep and woke at one look was moved back by a sub-step.

use carom_dynamics::{BodyDef, Mode, Motion, Settings, World};
use carom_geometry::{ConvexPolygon, Polygon};
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::gas::numbers;
use carom_tests::scenes::{block, disc, put, surface};

/// Ticks that are looked at.
const TICKS: u32 = 180;

fn corners(list: &[(f64, f64)]) -> Vec<Vec2> {
    list.iter().map(|(x, y)| vec2(*x, *y)).collect()
}

/// Discs, or discs and polygons, that fall between walls on a floor with bumps.
fn heap((seed, mixed, mode): (u64, bool, Mode)) -> World {
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -9.81),
        mode,
        ..Settings::default()
    })
    .expect("valid settings");
    let mut next = numbers(seed);
    let rough = surface(0.5 * next(), next());
    for (at, size) in [
        (vec2(0.0, -0.5), vec2(8.0, 1.0)),
        (vec2(-3.5, 4.0), vec2(1.0, 10.0)),
        (vec2(3.5, 4.0), vec2(1.0, 10.0)),
    ] {
        let def = BodyDef::fixed().at(at);
        put(&mut world, def, block(size.x, size.y), rough);
    }
    for k in 0..4 {
        let def = BodyDef::fixed().at(vec2(1.6 * f64::from(k) - 2.4, 0.4 * next()));
        put(&mut world, def, disc(0.3 + 0.3 * next()), rough);
    }
    let arrow = corners(&[
        (0.35, -0.3),
        (0.35, 0.3),
        (0.0, 0.05),
        (-0.35, 0.3),
        (-0.35, -0.3),
    ]);
    let arrow = Polygon::new(arrow).expect("an arrow");
    let kite = corners(&[(0.4, 0.0), (0.1, 0.35), (-0.4, 0.2), (-0.2, -0.4)]);
    let kite = ConvexPolygon::new(kite).expect("a quadrangle");
    for k in 0..24_u32 {
        let at = vec2(
            1.2 * f64::from(k % 5) - 2.4 + 0.2 * next(),
            1.8 + 1.1 * f64::from(k / 5),
        );
        let def = BodyDef::dynamic()
            .at(at)
            .moving(vec2(2.0 * next() - 1.0, -2.0 * next()))
            .spinning(6.0 * next() - 3.0);
        let material = surface(0.9 * next(), 1.2 * next());
        let kind = if mixed { 4.0 * next() } else { 0.0 };
        if kind < 1.0 {
            put(&mut world, def, disc(0.25 + 0.25 * next()), material);
        } else if kind < 2.0 {
            let size = (0.4 + 0.5 * next(), 0.3 + 0.6 * next());
            put(&mut world, def, block(size.0, size.1), material);
        } else if kind < 3.0 {
            put(&mut world, def, arrow.clone(), material);
        } else {
            put(&mut world, def, kite.clone(), material);
        }
    }
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
