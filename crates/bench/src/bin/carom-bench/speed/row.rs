//! A row a setting: the median of its repetitions.

use carom_bench::{EngineName, Mode, Reading, SpeedJob, SpeedReading};
use serde::Serialize;

use super::speed_job;
use crate::exit::{Failure, fail};
use crate::head::Head;
use crate::store::Row;
use crate::text;

/// One engine on one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct SpeedRow {
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(crate) scene: String,
    pub(crate) engine: EngineName,
    pub(crate) mode: Mode,
    pub(crate) threads: u32,
    /// Whether all poses are read after each step.
    pub(crate) reads_poses: bool,
    /// Over the measured steps; median of the repetitions.
    pub(crate) ms_mean: Option<f64>,
    pub(crate) ms_median: Option<f64>,
    pub(crate) ms_p99: Option<f64>,
    pub(crate) ms_first: Option<f64>,
    /// Greatest less least mean of the repetitions, as a part of their median; none of a single one.
    pub(crate) ms_spread: Option<f64>,
    /// Of the mean, to the fastest peer with as many threads that reads as much.
    pub(crate) ratio_to_best_peer: Option<f64>,
    /// After the measured steps over before them.
    #[serde(serialize_with = "text::word_if_not_finite")]
    pub(crate) energy_ratio: Option<f64>,
    #[serde(serialize_with = "text::word_if_not_finite")]
    pub(crate) overlap_mean: Option<f64>,
    #[serde(serialize_with = "text::word_if_not_finite")]
    pub(crate) overlap_max: Option<f64>,
    #[serde(serialize_with = "text::word_if_not_finite")]
    pub(crate) rms_acceleration: Option<f64>,
    #[serde(serialize_with = "text::word_if_not_finite")]
    pub(crate) drift: Option<f64>,
    pub(crate) bodies_awake: Option<usize>,
    pub(crate) touching: Option<usize>,
    /// Impacts of a body in a simulated second, where the engine counts them.
    pub(crate) impact_rate: Option<f64>,
    pub(crate) escaped: Option<usize>,
    pub(crate) non_finite: Option<usize>,
    pub(crate) peak_mib: Option<f64>,
    /// Peak memory beyond the process's own, over the dynamic bodies.
    pub(crate) kib_per_body: Option<f64>,
    /// The same without the pages of the program itself.
    pub(crate) data_kib_per_body: Option<f64>,
    pub(crate) repetitions: u32,
    /// Whether time ran out before all steps were made.
    pub(crate) cut: bool,
    pub(crate) failed: Option<String>,
}

/// A row for each setting, in the order of scenes, threads, reading and time.
pub(crate) fn of(measured: &[Row]) -> Vec<SpeedRow> {
    let mut jobs: Vec<(&SpeedJob, Vec<&Reading>)> = Vec::new();
    for row in measured {
        let Some(job) = speed_job(&row.job) else {
            continue;
        };
        match jobs.iter_mut().find(|(found, _)| *found == job) {
            Some((_, readings)) => readings.push(&row.reading),
            None => jobs.push((job, vec![&row.reading])),
        }
    }
    let mut rows: Vec<SpeedRow> = jobs
        .into_iter()
        .map(|(job, readings)| row(job, &readings))
        .collect();
    for index in 0..rows.len() {
        let best = best_peer(&rows, &rows[index]);
        let row = &mut rows[index];
        row.ratio_to_best_peer = row.ms_mean.zip(best).map(|(own, best)| own / best);
    }
    rows.sort_by(|a, b| {
        let key = |row: &SpeedRow| (row.threads, row.reads_poses, row.engine, row.mode);
        a.scene.cmp(&b.scene).then_with(|| key(a).cmp(&key(b)))
    });
    rows
}

fn row(job: &SpeedJob, readings: &[&Reading]) -> SpeedRow {
    let mut good: Vec<&SpeedReading> = Vec::new();
    let mut failed = None;
    for reading in readings {
        match reading {
            Reading::Speed(reading) => good.push(reading),
            Reading::Failed { reason } => failed = Some(reason.clone()),
            _ => {
                failed = Some("answered another question".to_owned());
            }
        }
    }
    // One repetition that failed is a failure: the others were lucky.
    if failed.is_some() {
        good.clear();
    }
    let of =
        |pick: fn(&SpeedReading) -> f64| median(good.iter().map(|reading| pick(reading)).collect());
    let last = good.first();
    SpeedRow {
        scene: job.scene.clone(),
        engine: job.engine,
        mode: job.mode,
        threads: job.threads,
        reads_poses: job.reads_poses,
        ms_mean: of(|reading| reading.ms_mean),
        ms_median: of(|reading| reading.ms_median),
        ms_p99: of(|reading| reading.ms_p99),
        ms_first: of(|reading| reading.ms_first),
        ms_spread: spread(good.iter().map(|reading| reading.ms_mean).collect()),
        ratio_to_best_peer: None,
        energy_ratio: of(|reading| reading.after.energy / reading.before.energy),
        overlap_mean: of(|reading| reading.after.overlap_mean),
        overlap_max: of(|reading| reading.after.overlap_max),
        rms_acceleration: of(|reading| reading.rms_acceleration),
        drift: of(|reading| reading.drift),
        bodies_awake: last.map(|reading| reading.counters.awake),
        touching: last.map(|reading| reading.counters.touching),
        impact_rate: last.and_then(|reading| reading.impact_rate),
        escaped: good.iter().map(|reading| reading.after.escaped).max(),
        non_finite: good.iter().map(|reading| reading.after.non_finite).max(),
        peak_mib: median(good.iter().filter_map(|reading| reading.peak_mib).collect()),
        kib_per_body: median(
            good.iter()
                .filter_map(|reading| kib_per_body(reading))
                .collect(),
        ),
        data_kib_per_body: median(
            good.iter()
                .filter_map(|reading| data_kib_per_body(reading))
                .collect(),
        ),
        repetitions: u32::try_from(good.len()).unwrap_or(u32::MAX),
        cut: good.iter().any(|reading| reading.cut),
        failed,
    }
}

fn kib_per_body(reading: &SpeedReading) -> Option<f64> {
    shared(reading.peak_mib? - reading.own_mib?, reading)
}

fn data_kib_per_body(reading: &SpeedReading) -> Option<f64> {
    let data = reading.peak_mib? - reading.own_mib? - reading.program_mib?;
    shared(data, reading)
}

/// So many MiB over the dynamic bodies, in KiB.
#[expect(clippy::cast_precision_loss, reason = "a count of bodies")]
fn shared(mib: f64, reading: &SpeedReading) -> Option<f64> {
    let bodies = Some(reading.bodies).filter(|count| *count > 0)?;
    Some(1024.0 * mib / bodies as f64)
}

/// Time of the fastest peer in the same scene on as many threads that reads as much.
fn best_peer(rows: &[SpeedRow], row: &SpeedRow) -> Option<f64> {
    let peers = rows.iter().filter(|peer| {
        peer.engine != EngineName::Carom
            && (&peer.scene, peer.threads, peer.reads_poses)
                == (&row.scene, row.threads, row.reads_poses)
    });
    peers.filter_map(|peer| peer.ms_mean).min_by(f64::total_cmp)
}

/// The middle number, or the mean of the two in the middle; `None` of nothing. One that is not finite is the answer: the
/// other repetitions were lucky.
pub(crate) fn median(mut numbers: Vec<f64>) -> Option<f64> {
    if let Some(broken) = numbers.iter().find(|number| !number.is_finite()) {
        return Some(*broken);
    }
    numbers.sort_by(f64::total_cmp);
    let half = numbers.len() / 2;
    match numbers.len() {
        0 => None,
        n if n % 2 == 1 => Some(numbers[half]),
        _ => Some(0.5 * (numbers[half - 1] + numbers[half])),
    }
}

/// How far numbers lie apart, as a part of their median; `None` of fewer than two.
fn spread(numbers: Vec<f64>) -> Option<f64> {
    let least = numbers.iter().copied().min_by(f64::total_cmp)?;
    let most = numbers.iter().copied().max_by(f64::total_cmp)?;
    let several = numbers.len() > 1;
    let middle = median(numbers)?;
    several.then_some((most - least) / middle)
}

/// Head and rows as CSV.
pub(crate) fn csv<R: Serialize>(head: &Head, rows: &[R]) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    let Ok(bytes) = writer.into_inner() else {
        fail!("the rows cannot be written as CSV");
    };
    Ok(head.comments() + &String::from_utf8_lossy(&bytes))
}

/// The table for other programs.
#[derive(Debug, Serialize)]
pub(crate) struct Document<'a> {
    machine: &'a str,
    scenes: Vec<SceneRows<'a>>,
}

#[derive(Debug, Serialize)]
struct SceneRows<'a> {
    scene: &'a str,
    rows: Vec<SpeedRow>,
}

pub(crate) fn json<'a>(machine: &'a str, rows: &'a [SpeedRow]) -> Document<'a> {
    let unnamed = |row: &SpeedRow| SpeedRow {
        scene: String::new(),
        ..row.clone()
    };
    let rows_of = |scene: &str| {
        rows.iter()
            .filter(|row| row.scene == scene)
            .map(unnamed)
            .collect()
    };
    Document {
        machine,
        scenes: scenes(rows)
            .into_iter()
            .map(|scene| SceneRows {
                scene,
                rows: rows_of(scene),
            })
            .collect(),
    }
}

/// The scenes that rows are of, in the order of the rows.
pub(crate) fn scenes(rows: &[SpeedRow]) -> Vec<&str> {
    let mut names: Vec<&str> = rows.iter().map(|row| row.scene.as_str()).collect();
    names.dedup();
    names
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    use carom_bench::{Counters, Job, Limits, Quality};

    pub(crate) fn reading(ms: f64) -> Reading {
        let quality = |energy| Quality {
            energy,
            ..Quality::default()
        };
        Reading::Speed(SpeedReading {
            ms_mean: ms,
            ms_median: ms,
            ms_p99: 2.0 * ms,
            ms_first: 10.0 * ms,
            warm_up_steps: 1,
            measured_steps: 10,
            cut: false,
            bodies: 5,
            before: quality(4.0),
            after: quality(5.0),
            rms_acceleration: 0.1,
            drift: 0.2,
            impact_rate: None,
            counters: Counters {
                awake: 7,
                touching: 9,
            },
            peak_mib: None,
            own_mib: None,
            program_mib: None,
            settings: "s".to_owned(),
        })
    }

    fn measured(engine: EngineName, repetition: u32, reading: Reading) -> Row {
        Row {
            job: Job::Speed(SpeedJob {
                engine,
                mode: engine.modes()[0],
                threads: 1,
                reads_poses: false,
                scene: "a_large_pyramid".to_owned(),
                limits: Limits::default(),
            }),
            repetition,
            reading,
        }
    }

    /// carom at 6 ms, rapier at 2 ms, Box2D at 3 ms, Chipmunk failed once.
    pub(crate) fn some() -> Vec<SpeedRow> {
        use EngineName::{Box2dSse2, Carom, Chipmunk, Rapier};
        let late = Reading::Failed {
            reason: "stopped after 3 s".to_owned(),
        };
        of(&[
            measured(Rapier, 0, reading(2.0)),
            measured(Carom, 0, reading(50.0)),
            measured(Chipmunk, 0, reading(1.0)),
            measured(Box2dSse2, 0, reading(3.0)),
            measured(Carom, 1, reading(6.0)),
            measured(Carom, 2, reading(5.0)),
            measured(Chipmunk, 1, late),
        ])
    }

    #[test]
    fn a_row_is_the_median_of_its_repetitions() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0]), Some(2.0));
        assert!(median(vec![1.0, f64::NAN, 2.0]).is_some_and(f64::is_nan));
        let rows = some();
        assert_eq!(rows[0].engine, EngineName::Carom);
        assert_eq!((rows[0].ms_mean, rows[0].repetitions), (Some(6.0), 3));
        assert_eq!(rows[0].energy_ratio, Some(1.25));
        // 50, 6 and 5 ms.
        assert_eq!((rows[0].ms_spread, rows[1].ms_spread), (Some(7.5), None));
    }

    #[test]
    fn memory_is_shared_among_the_bodies() {
        let Reading::Speed(mut big) = reading(1.0) else {
            panic!("a reading");
        };
        // 5 bodies in 10 MiB beyond the 2 MiB of the process, 5 of them the program.
        (big.peak_mib, big.own_mib) = (Some(12.0), Some(2.0));
        big.program_mib = Some(5.0);
        let rows = of(&[measured(EngineName::Rapier, 0, Reading::Speed(big))]);
        assert_eq!(rows[0].kib_per_body, Some(2048.0));
        assert_eq!(rows[0].data_kib_per_body, Some(1024.0));
        assert_eq!(some()[0].kib_per_body, None);
    }

    #[test]
    fn a_run_that_blew_up_leaves_no_hole() {
        let Reading::Speed(mut broken) = reading(1.0) else {
            panic!("a reading");
        };
        broken.drift = f64::INFINITY;
        broken.after.energy = f64::NAN;
        broken.after.momentum[1] = f64::NEG_INFINITY;
        // As through a process and the file of rows.
        let measured = measured(EngineName::Rapier, 0, Reading::Speed(broken));
        let text = serde_json::to_string(&measured).unwrap();
        let rows = of(&[serde_json::from_str(&text).unwrap()]);
        assert_eq!(rows[0].failed, None);
        let value = serde_json::to_value(json("m", &rows)).unwrap();
        let row = &value["scenes"][0]["rows"][0];
        assert_eq!(
            (&row["energy_ratio"], &row["drift"]),
            (&"NaN".into(), &"inf".into())
        );
        let markdown = crate::speed::table::markdown(&Head::default(), &rows);
        assert_eq!(
            markdown.matches("| not finite |").count(),
            1 + 2,
            "{markdown}"
        );
        let text = csv(&Head::default(), &rows).unwrap();
        assert!(text.contains(",NaN,") && text.contains(",inf,"), "{text}");
    }

    #[test]
    fn ratios_are_to_the_fastest_peer_that_came_through() {
        let ratios: Vec<Option<f64>> = some().iter().map(|row| row.ratio_to_best_peer).collect();
        assert_eq!(ratios, [Some(3.0), Some(1.5), Some(1.0), None]);
        assert_eq!(some()[3].failed.as_deref(), Some("stopped after 3 s"));
    }

    #[test]
    fn the_json_has_its_shape() {
        let rows = some();
        let value = serde_json::to_value(json("m", &rows)).unwrap();
        assert_eq!(value["machine"], "m");
        assert_eq!(value["scenes"][0]["scene"], "a_large_pyramid");
        let first = &value["scenes"][0]["rows"][0];
        assert_eq!(first["engine"], "carom");
        for key in [
            "mode",
            "threads",
            "reads_poses",
            "ms_mean",
            "ms_median",
            "ms_p99",
            "ratio_to_best_peer",
            "energy_ratio",
            "overlap_mean",
            "overlap_max",
            "rms_acceleration",
            "bodies_awake",
            "peak_mib",
        ] {
            assert!(first.get(key).is_some(), "{key}: {first}");
        }
        assert!(first["peak_mib"].is_null());
    }

    #[test]
    fn the_csv_has_a_line_a_row() {
        let text = csv(&Head::default(), &some()).unwrap();
        let mut lines = text.lines();
        assert!(
            lines
                .next()
                .unwrap()
                .starts_with("scene,engine,mode,threads,reads_poses,ms_mean,ms_median")
        );
        assert!(
            lines
                .next()
                .unwrap()
                .starts_with("a_large_pyramid,carom,hybrid,1,false,6.0,6.0,12.0")
        );
        assert_eq!(lines.count(), 3);
    }
}
