//! Gases in a box: what single impacts keep, and what a minute of them does.
//!
//! Ten thousand seconds of the same gases, measured: `cargo run --release -p carom-tests --example gases -- docs/pictures/exact_energy.png`.

use carom_dynamics::World;
use carom_math::{Pose, vec2};
use carom_tests::gas::{Molecule, Watch, gas, kinetic, numbers, size};

/// A minute of a gas, sampled every `sample` seconds.
fn a_minute_keeps_everything(molecule: Molecule, side: u32, sample: f64) {
    let mut world = gas(molecule, side, 7);
    let start = kinetic(&world);
    let mut worst = 0.0_f64;
    let mut watch = Watch::default();
    watch.run(&mut world, 60.0, sample, |_, energy| {
        worst = worst.max((energy / start - 1.0).abs());
    });
    let (mean, chance) = watch.bias();
    assert!(watch.report.is_exact(), "{:?}", watch.report);
    assert!(
        watch.collisions > 10 * u64::from(side * side),
        "too quiet: {watch:?}"
    );
    assert!(worst < 1e-12, "energy is off by {worst:.2e} of itself");
    assert!(
        mean.abs() < 4.0 * chance,
        "errors lean to one side: {mean:.2e}, by chance ± {chance:.2e}"
    );
    assert!(watch.linear < 1e-15, "momentum {:.2e}", watch.linear);
    assert!(watch.angular < 1e-15, "turning {:.2e}", watch.angular);
    assert!(watch.deepest < 1e-12, "overlap {:.2e}", watch.deepest);
}

#[test]
fn a_minute_of_sixteen_elastic_discs_keeps_everything() {
    a_minute_keeps_everything(Molecule::Disc, 4, 1.0 / 60.0);
}

#[test]
fn a_minute_of_sixteen_elastic_boxes_keeps_everything() {
    a_minute_keeps_everything(Molecule::Box, 4, 1.0 / 60.0);
}

#[test]
fn a_minute_of_a_hundred_elastic_polygons_keeps_everything() {
    a_minute_keeps_everything(Molecule::Polygon, 10, 0.1);
}

/// Displacement of every body where it turns back, in sizes, to see how much a difference grows on its way.
const NUDGE: f64 = 1e-13;

/// What roundings come to at the turn, in sizes: a few of the shape and the place each.
const ROUNDING: f64 = 1e-14;

/// Poses of all bodies after `seconds` backwards, from places that are up to `nudge` of a size off.
fn backwards(world: &World, seconds: f64, nudge: f64, seed: u64) -> Vec<Pose> {
    let mut next = numbers(seed);
    let mut world = world.clone();
    let moving: Vec<_> = world.bodies().filter(|b| b.mass().is_finite()).collect();
    let moving: Vec<_> = moving
        .iter()
        .map(|b| {
            let aside = (vec2(next(), next()) - 0.5) * (2.0 * nudge * size(b));
            let pose = Pose {
                position: b.pose().position + aside,
                ..b.pose()
            };
            (b.id(), -b.velocity(), -b.angular_velocity(), pose)
        })
        .collect();
    for (id, velocity, spin, pose) in moving {
        if nudge > 0.0 {
            world.teleport(id, pose).expect("it is there");
        }
        world.set_velocity(id, velocity, spin).expect("it is there");
    }
    world.step(seconds);
    world.bodies().map(|b| b.pose()).collect()
}

/// Largest distance of two bodies' places, in sizes, or of their angles, in radians.
fn farthest(world: &World, one: &[Pose], two: &[Pose]) -> f64 {
    let mut worst = 0.0_f64;
    for ((body, a), b) in world.bodies().zip(one).zip(two) {
        let moved = (a.position - b.position).length() / size(&body);
        let turned = (a.rotation * b.rotation.inverse()).angle().abs();
        worst = worst.max(moved).max(turned);
    }
    worst
}

/// Elastic motion is its own inverse, so all that is left at the start are roundings, grown by what impacts make of any
/// difference. How much that is, another way back tells, from places a hair off: it goes beyond 10⁸ where one body has a
/// dozen of the impacts, and there nothing computed in doubles comes back to 1e-6.
#[test]
fn elastic_gases_run_backwards_to_where_they_began() {
    for (molecule, side) in [
        (Molecule::Disc, 4),
        (Molecule::Box, 4),
        (Molecule::Polygon, 10),
    ] {
        let mut chaotic = 0;
        for seed in 0..8 {
            let mut world = gas(molecule, side, seed);
            let start: Vec<Pose> = world.bodies().map(|b| b.pose()).collect();
            let bodies = u64::from(side * side);
            // Five impacts a body: one of two bodies counts for both.
            let mut watch = Watch::default();
            while watch.impacts + watch.collisions < 5 * bodies {
                watch.next(&mut world, 60.0);
            }
            // Half the way to the next impact: no two bodies touch.
            let turn = world.time();
            let mut ahead = world.clone();
            ahead.step_to_next_event(60.0);
            world.step(0.5 * (ahead.time() - turn));
            let way = world.time().as_secs();
            let back = backwards(&world, way, 0.0, 0);
            let off = farthest(&world, &back, &start);
            let deviations =
                (0..4).map(|k| farthest(&world, &backwards(&world, way, NUDGE, k), &back));
            let growth = deviations.fold(0.0, f64::max) / NUDGE;
            assert!(
                off < ROUNDING * growth,
                "{molecule:?} {seed}: {off:.2e} of a size off, and differences grow {growth:.1e} times"
            );
            assert!(
                off < 1e-6 || growth > 1e9,
                "{molecule:?} {seed}: {off:.2e} of a size off"
            );
            chaotic += u32::from(off >= 1e-6);
        }
        assert!(
            chaotic <= 1,
            "{molecule:?}: {chaotic} of 8 are off by more than 1e-6"
        );
    }
}
