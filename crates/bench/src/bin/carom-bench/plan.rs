//! Which jobs there are, and in which order: engines take turns, so that a slow minute of the machine hits all alike.

use carom_bench::{Case, EngineName, Job, Limits, Mode, Point, Reading, SpeedJob, points};
use carom_scenes::GrowthKind;

use crate::store::Row;

/// A job and the repetition that it belongs to, from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Planned {
    pub(crate) job: Job,
    pub(crate) repetition: u32,
}

/// All points of the work–precision curves: case by case, setting by setting, the engines in turn.
pub(crate) fn accuracy(cases: &[&Case], engines: &[EngineName], quick: bool) -> Vec<Planned> {
    let mut jobs = Vec::new();
    for case in cases {
        let mut settings: Vec<(Option<u32>, u32, Vec<Point>)> = Vec::new();
        for point in engines
            .iter()
            .flat_map(|engine| points(case, *engine, quick))
        {
            let same = |found: &&mut (Option<u32>, u32, _)| {
                (found.0, found.1) == (point.substeps, point.hz)
            };
            match settings.iter_mut().find(same) {
                Some((_, _, entries)) => entries.push(point),
                None => settings.push((point.substeps, point.hz, vec![point])),
            }
        }
        for (turn, (_, _, entries)) in settings.into_iter().enumerate() {
            jobs.extend(rotated(entries, turn).into_iter().map(|point| Planned {
                job: Job::Accuracy(point),
                repetition: 0,
            }));
        }
    }
    jobs
}

/// Whether a run with fewer steps on the same curve was stopped for the time it took.
pub(crate) fn hopeless(rows: &[Row], planned: &Planned) -> bool {
    let Job::Accuracy(point) = &planned.job else {
        return false;
    };
    rows.iter().any(|row| match (&row.job, &row.reading) {
        (Job::Accuracy(found), Reading::Failed { reason }) => {
            let curve = |p: &Point| (p.engine, p.mode, p.case.clone(), p.substeps.is_some());
            reason.starts_with("stopped after")
                && curve(found) == curve(point)
                && (found.hz, found.substeps) < (point.hz, point.substeps)
        }
        _ => false,
    })
}

/// How scenes are measured.
#[derive(Clone, Debug)]
pub(crate) struct Speed<'a> {
    pub(crate) scenes: &'a [String],
    pub(crate) engines: &'a [EngineName],
    pub(crate) threads: &'a [u32],
    pub(crate) repeat: u32,
    /// CPU seconds after which a job measures no more steps.
    pub(crate) cpu_s: u32,
}

/// In each repetition, scene by scene, the engines in an order that rotates from repetition to repetition.
///
/// Defaults without reading are repeated; reading all poses, and the other modes, are measured once.
pub(crate) fn speed(speed: &Speed<'_>) -> Vec<Planned> {
    let mut jobs = Vec::new();
    for repetition in 0..speed.repeat {
        for scene in speed.scenes {
            let entries = entries(speed, repetition > 0);
            for (engine, mode, threads, reads_poses) in rotated(entries, repetition as usize) {
                jobs.push(Planned {
                    job: Job::Speed(SpeedJob {
                        engine,
                        mode,
                        threads,
                        reads_poses,
                        scene: scene.clone(),
                        limits: Limits {
                            cpu_s: Some(speed.cpu_s.max(1)),
                            ..Limits::default()
                        },
                    }),
                    repetition,
                });
            }
        }
    }
    jobs
}

/// Each engine once with its defaults on each scene, as the kind of job that `job` makes.
pub(crate) fn once(
    scenes: &[String],
    engines: &[EngineName],
    limits: Limits,
    job: fn(SpeedJob) -> Job,
) -> Vec<Planned> {
    let one = |scene: &String, engine: EngineName| Planned {
        job: job(SpeedJob {
            engine,
            mode: engine.modes()[0],
            threads: 1,
            reads_poses: false,
            scene: scene.clone(),
            limits,
        }),
        repetition: 0,
    };
    let mut jobs = Vec::new();
    for (turn, scene) in scenes.iter().enumerate() {
        let engines = rotated(engines.to_vec(), turn).into_iter();
        jobs.extend(engines.map(|engine| one(scene, engine)));
    }
    jobs
}

/// Numbers of bodies of the growth curves.
pub(crate) const SIZES: [u32; 10] = [
    200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000, 100_000, 200_000,
];

/// A step that takes longer, in ms, is the last of an engine's growth curve.
pub(crate) const STEP_BUDGET: f64 = 250.0;

/// Growth scenes from small to large, each engine with its defaults, in turn.
pub(crate) fn growth(engines: &[EngineName], cpu_s: u32) -> Vec<Planned> {
    let mut jobs = Vec::new();
    for (turn, bodies) in SIZES.into_iter().enumerate() {
        for kind in GrowthKind::ALL {
            for engine in rotated(engines.to_vec(), turn) {
                jobs.push(Planned {
                    job: Job::Speed(SpeedJob {
                        engine,
                        mode: engine.modes()[0],
                        threads: 1,
                        reads_poses: false,
                        scene: format!("grow_{}_{bodies}", kind.name()),
                        limits: Limits {
                            cpu_s: Some(cpu_s.max(1)),
                            ..Limits::default()
                        },
                    }),
                    repetition: 0,
                });
            }
        }
    }
    jobs
}

fn entries(speed: &Speed<'_>, defaults_only: bool) -> Vec<(EngineName, Mode, u32, bool)> {
    let mut entries = Vec::new();
    for threads in speed.threads {
        for engine in speed.engines {
            for mode in engine.modes() {
                let default = *mode == engine.modes()[0];
                for reads in [false, true] {
                    // Reading costs the same in every mode, and as much on any number of threads.
                    let once = !default || reads;
                    let wanted = (default || !reads) && (*threads == 1 || !once);
                    if wanted && !(once && defaults_only) {
                        entries.push((*engine, *mode, *threads, reads));
                    }
                }
            }
        }
    }
    entries
}

/// The same, begun `turn` entries later.
fn rotated<T>(mut entries: Vec<T>, turn: usize) -> Vec<T> {
    let count = entries.len().max(1);
    entries.rotate_left(turn % count);
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    use EngineName::{Box2dSse2, Carom, Rapier};

    fn plan(repeat: u32, threads: &[u32]) -> Vec<SpeedJob> {
        let scenes = ["a".to_owned(), "b".to_owned()];
        let speed = Speed {
            scenes: &scenes,
            engines: &[Carom, Box2dSse2, Rapier],
            threads,
            repeat,
            cpu_s: 60,
        };
        let jobs = super::speed(&speed).into_iter();
        jobs.map(|planned| match planned.job {
            Job::Speed(job) => job,
            _ => panic!("speed jobs only"),
        })
        .collect()
    }

    #[test]
    fn engines_take_turns_scene_by_scene() {
        let jobs = plan(3, &[1]);
        // First repetition: carom has 7 modes, a peer 2, each reads poses once.
        let first = 2 * (8 + 3 + 3);
        let repeated: Vec<(&str, EngineName)> = jobs[first..]
            .iter()
            .map(|job| (job.scene.as_str(), job.engine))
            .collect();
        assert_eq!(
            repeated,
            [
                ("a", Box2dSse2),
                ("a", Rapier),
                ("a", Carom),
                ("b", Box2dSse2),
                ("b", Rapier),
                ("b", Carom),
                ("a", Rapier),
                ("a", Carom),
                ("a", Box2dSse2),
                ("b", Rapier),
                ("b", Carom),
                ("b", Box2dSse2),
            ]
        );
        assert!(
            jobs[first..]
                .iter()
                .all(|job| !job.reads_poses && job.mode == job.engine.modes()[0])
        );
        assert!(jobs[..first / 2].iter().all(|job| job.scene == "a"));
    }

    #[test]
    fn no_job_is_planned_twice() {
        let jobs = plan(1, &[1, 2]);
        for (i, job) in jobs.iter().enumerate() {
            assert!(!jobs[..i].contains(job), "{job:?}");
        }
        assert_eq!(jobs.iter().filter(|job| job.threads == 2).count(), 2 * 3);
    }

    #[test]
    fn what_was_too_slow_is_not_tried_with_more_steps() {
        let point = |hz, substeps| Point {
            engine: Carom,
            mode: Mode::Hybrid,
            case: "01_projectile".to_owned(),
            hz,
            substeps,
        };
        let planned = |hz, substeps| Planned {
            job: Job::Accuracy(point(hz, substeps)),
            repetition: 0,
        };
        let stopped = |reason: &str| {
            [Row {
                job: Job::Accuracy(point(240, None)),
                repetition: 0,
                reading: Reading::Failed {
                    reason: reason.to_owned(),
                },
            }]
        };
        let rows = stopped("stopped after 30 s");
        assert!(hopeless(&rows, &planned(480, None)));
        assert!(!hopeless(&rows, &planned(120, None)));
        assert!(!hopeless(&rows, &planned(60, Some(64))));
        assert!(!hopeless(
            &stopped("crashed: signal 6"),
            &planned(480, None)
        ));
    }

    #[test]
    fn engines_take_turns_setting_by_setting() {
        let case = &carom_bench::CASES[0];
        let jobs = accuracy(&[case], &[Carom, Rapier], false);
        let all = points(case, Carom, false).len() + points(case, Rapier, false).len();
        assert_eq!(jobs.len(), all);
        let swept =
            |planned: &Planned| matches!(&planned.job, Job::Accuracy(p) if p.substeps.is_some());
        // The first rate begins with carom, the second with the entry after it.
        let at = |job: &Job| match job {
            Job::Accuracy(point) => (point.hz, point.engine, point.mode),
            _ => panic!("accuracy jobs only"),
        };
        let first = at(&jobs[0].job);
        let count = jobs.iter().filter(|planned| at(&planned.job).0 == first.0);
        let second = at(&jobs[count.filter(|planned| !swept(planned)).count()].job);
        assert_eq!(first.1, Carom);
        assert!(
            first.0 < second.0 && second.2 == Carom.modes()[1],
            "{second:?}"
        );
    }
}
