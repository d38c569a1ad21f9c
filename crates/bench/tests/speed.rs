//! The answer of a speed job, for every engine.

use carom_bench::{EngineName, Job, Limits, Mode, Reading, SpeedJob, run};

fn job(scene: &str, limits: Limits) -> Job {
    Job::Speed(SpeedJob {
        engine: EngineName::Carom,
        mode: Mode::Hybrid,
        threads: 1,
        reads_poses: true,
        scene: scene.to_owned(),
        limits,
    })
}

#[test]
fn limits_shorten_a_run_and_the_reading_says_so() {
    let limits = Limits {
        warm_up_steps: Some(3),
        measured_steps: Some(5),
        cpu_s: None,
    };
    let Reading::Speed(reading) = run(&job("i_mostly_empty", limits)) else {
        panic!("a reading");
    };
    assert_eq!((reading.warm_up_steps, reading.measured_steps), (3, 5));
    assert_eq!((reading.bodies, reading.cut), (10_000, false));
    assert!(reading.ms_median <= reading.ms_p99);
    assert!(reading.ms_mean > 0.0);
    // All fall freely: nothing overlaps, the energy stays, and 10 m/s² throws them about.
    assert_eq!(reading.after.overlap_pairs, 0);
    assert!((reading.after.energy / reading.before.energy - 1.0).abs() < 1e-12);
    assert!((reading.rms_acceleration - 10.0).abs() < 1e-9);
    // 5 steps after 3: 10/2 ((8/60)² − (3/60)²) m downwards, plus what each was thrown with.
    assert!(reading.drift > 0.07);
}

#[test]
fn a_run_without_time_says_how_far_it_came() {
    let limits = Limits {
        cpu_s: Some(0),
        ..Limits::default()
    };
    let Reading::Failed { reason } = run(&job("i", limits)) else {
        panic!("no time for a reading");
    };
    assert!(
        reason.starts_with("carom was stopped after 1 steps"),
        "{reason}"
    );
}

#[test]
fn an_unknown_scene_is_answered_with_those_that_exist() {
    let Reading::Failed { reason } = run(&job("z", Limits::default())) else {
        panic!("there is no such scene");
    };
    assert!(reason.starts_with("z: unknown scene; there are a_large_pyramid, "));
}

#[test]
fn a_profile_has_the_stages_of_the_measured_steps() {
    let limits = Limits {
        warm_up_steps: Some(1),
        measured_steps: Some(2),
        cpu_s: None,
    };
    let Job::Speed(of_speed) = job("i_mostly_empty", limits) else {
        panic!("a speed job");
    };
    let Reading::Profile(reading) = run(&Job::Profile(of_speed)) else {
        panic!("carom tells its stages");
    };
    assert_eq!((reading.warm_up_steps, reading.measured_steps), (1, 2));
    let ms = |stage: &str| reading.stages.iter().find(|(name, _)| name == stage);
    // 10,000 bodies fly: what is ahead of them takes some time, and sub-steps take none.
    assert!(
        ms("impacts").is_some_and(|(_, ms)| *ms > 0.0),
        "{reading:?}"
    );
    for stage in ["contacts", "solver"] {
        assert!(ms(stage).is_some_and(|(_, ms)| *ms == 0.0), "{reading:?}");
    }
    assert!(reading.stages.iter().all(|(_, ms)| *ms >= 0.0));
}
