//! How the time of a step grows with the number of bodies.

use std::path::{Path, PathBuf};

use carom_bench::{EngineName, Reading};
use carom_math::vec2;
use carom_render::{Chart, Panels, Size};
use carom_scenes::GrowthKind;

use super::row::SpeedRow;
use super::speed_job;
use crate::exit::Failure;
use crate::picture;
use crate::plan::{Planned, STEP_BUDGET};
use crate::store::Row;

/// Time that a step may take where 60 are computed in a second, in ms.
const FRAME: f64 = 1e3 / 60.0;

/// Kind and number of bodies of a scene like `grow_pile_2000`.
fn parts(scene: &str) -> Option<(GrowthKind, u32)> {
    let (kind, bodies) = scene.strip_prefix("grow_")?.split_once('_')?;
    Some((kind.parse().ok()?, bodies.parse().ok()?))
}

/// Whether the engine failed or took too long with fewer bodies of the same kind.
pub(super) fn outgrown(rows: &[Row], planned: &Planned) -> bool {
    let Some((kind, bodies)) = speed_job(&planned.job).and_then(|job| parts(&job.scene)) else {
        return false;
    };
    rows.iter().any(|row| {
        let smaller = speed_job(&row.job)
            .and_then(|job| parts(&job.scene))
            .is_some_and(|(other, fewer)| other == kind && fewer < bodies);
        let over = match &row.reading {
            Reading::Speed(reading) => reading.ms_mean > STEP_BUDGET,
            _ => true,
        };
        smaller && over && row.job.engine() == planned.job.engine()
    })
}

/// Rows by kind and number of bodies.
pub(super) fn sort(rows: &mut [SpeedRow]) {
    rows.sort_by_key(|row| {
        let (kind, bodies) = parts(&row.scene).unzip();
        (kind.map(|kind| kind as u8), bodies, row.engine)
    });
}

/// Writes `growth`: a chart a kind, ms a step over the number of bodies.
pub(super) fn write(folder: &Path, rows: &[SpeedRow]) -> Result<Vec<PathBuf>, Failure> {
    let panels = panels(rows);
    let frame = panels.frame(Size::new(1320, 520)?);
    picture::write(folder, "growth", &frame)
}

fn panels(rows: &[SpeedRow]) -> Panels {
    let mut panels =
        Panels::new("Time of a step against the number of bodies", 3).subtitled(format!(
            "one thread, defaults; an engine goes no further once a step takes {STEP_BUDGET} ms"
        ));
    let mut engines: Vec<EngineName> = rows.iter().map(|row| row.engine).collect();
    engines.sort_by_key(|engine| (picture::on_top(*engine), *engine));
    engines.dedup();
    for kind in GrowthKind::ALL {
        let mut chart = Chart::new(kind.name())
            .x("number of bodies")
            .y("time of a step, in ms")
            .log_x()
            .log_y();
        chart.y.marks = vec![(FRAME, "16.7 ms: 60 steps a second".to_owned())];
        for engine in &engines {
            let place = |row: &SpeedRow| {
                let (found, bodies) = parts(&row.scene)?;
                let here = found == kind && row.engine == *engine;
                here.then_some(vec2(
                    f64::from(bodies),
                    row.ms_mean.unwrap_or(f64::INFINITY),
                ))
            };
            let points: Vec<_> = rows.iter().filter_map(place).collect();
            if points.iter().any(|point| point.y == f64::INFINITY) {
                "failed".clone_into(&mut chart.y.ceiling);
            }
            if !points.is_empty() {
                chart = chart.with(picture::series(*engine, engine.modes()[0], points));
            }
        }
        panels = panels.with(chart);
    }
    panels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan;
    use crate::speed::row::tests::{reading, some};

    #[test]
    fn an_engine_goes_no_further_once_a_step_takes_too_long() {
        let jobs = plan::growth(&[EngineName::Carom, EngineName::Rapier], 10);
        let rows: Vec<Row> = jobs
            .iter()
            .filter(|planned| speed_job(&planned.job).unwrap().scene == "grow_gas_500")
            .map(|planned| Row {
                job: planned.job.clone(),
                repetition: 0,
                reading: match planned.job.engine() {
                    EngineName::Carom => reading(STEP_BUDGET + 1.0),
                    _ => reading(1.0),
                },
            })
            .collect();
        for planned in &jobs {
            let (kind, bodies) = parts(&speed_job(&planned.job).unwrap().scene).unwrap();
            let expected = planned.job.engine() == EngineName::Carom
                && kind == GrowthKind::Gas
                && bodies > 500;
            assert_eq!(outgrown(&rows, planned), expected, "{planned:?}");
        }
    }

    #[test]
    fn numbers_of_bodies_are_sorted_as_numbers() {
        let row = some().remove(0);
        let scenes = ["grow_pile_10000", "grow_gas_200", "grow_pile_500"];
        let mut rows = scenes
            .map(|scene| SpeedRow {
                scene: scene.to_owned(),
                ..row.clone()
            })
            .to_vec();
        sort(&mut rows);
        let names: Vec<&str> = rows.iter().map(|row| row.scene.as_str()).collect();
        assert_eq!(names, ["grow_pile_500", "grow_pile_10000", "grow_gas_200"]);
        let panels = panels(&rows);
        assert_eq!(panels.charts.len(), 3);
        assert_eq!(panels.charts[0].series[0].points.len(), 2);
    }
}
