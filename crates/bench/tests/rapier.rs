//! Rapier in this laboratory does what it did in another harness, which published how deep its bodies overlapped and
//! what became of their energy: same bodies, same settings, same assessment, or one of these numbers is off.
//!
//! `cargo test -p carom-bench --features rapier,rapier-f64 --test rapier`
#![cfg(any(feature = "rapier", feature = "rapier-f64"))]

use carom_bench::{EngineName, Job, Limits, Mode, Reading, SpeedJob, SpeedReading, run};

/// Of the state after the last measured step.
struct Published {
    overlap_max: f64,
    overlap_mean: f64,
    overlap_pairs: usize,
    energy_ratio: f64,
    touching: usize,
}

fn reading(engine: EngineName, scene: &str, limits: Limits) -> Result<SpeedReading, String> {
    let job = Job::Speed(SpeedJob {
        engine,
        mode: Mode::Stock,
        threads: 1,
        reads_poses: false,
        scene: scene.to_owned(),
        limits,
    });
    match run(&job) {
        Reading::Speed(reading) => Ok(reading),
        other => Err(format!("{other:?}")),
    }
}

/// Equal to the digits that were published: four behind the point.
fn check(engine: EngineName, scene: &str, published: &Published) -> Result<(), String> {
    let found = reading(engine, scene, Limits::default())?;
    let after = found.after;
    let near = |what: &str, found: f64, published: f64| {
        if (found - published).abs() <= 0.5e-4 {
            Ok(())
        } else {
            Err(format!(
                "{engine}, {scene}: {what} {found}, published {published}"
            ))
        }
    };
    near("deepest overlap", after.overlap_max, published.overlap_max)?;
    near("mean overlap", after.overlap_mean, published.overlap_mean)?;
    let ratio = after.energy / found.before.energy;
    near("energy after / before", ratio, published.energy_ratio)?;
    let pairs = [after.overlap_pairs, found.counters.touching];
    assert_eq!(
        pairs,
        [published.overlap_pairs, published.touching],
        "{engine}, {scene}: pairs that overlap and pairs that touch"
    );
    assert!(!found.cut && after.escaped == 0 && after.non_finite == 0);
    Ok(())
}

#[cfg(all(feature = "rapier", not(feature = "rapier-8")))]
#[test]
fn single_precision_stacks_and_bounces_as_published() -> Result<(), String> {
    let pyramid = Published {
        overlap_max: 0.0179,
        overlap_mean: 0.0075,
        overlap_pairs: 11508,
        energy_ratio: 1.0017,
        touching: 14950,
    };
    check(EngineName::Rapier, "a", &pyramid)?;
    let gas = Published {
        overlap_max: 0.3400,
        overlap_mean: 0.0738,
        overlap_pairs: 309,
        energy_ratio: 0.9025,
        touching: 379,
    };
    check(EngineName::Rapier, "e", &gas)
}

#[cfg(feature = "rapier-f64")]
#[test]
fn double_precision_stacks_and_bounces_as_published() -> Result<(), String> {
    let pyramid = Published {
        overlap_max: 0.0192,
        overlap_mean: 0.0076,
        overlap_pairs: 11468,
        energy_ratio: 1.0017,
        touching: 14950,
    };
    check(EngineName::RapierF64, "a", &pyramid)?;
    let gas = Published {
        overlap_max: 0.3278,
        overlap_mean: 0.0662,
        overlap_pairs: 331,
        energy_ratio: 0.9199,
        touching: 388,
    };
    check(EngineName::RapierF64, "e", &gas)
}
