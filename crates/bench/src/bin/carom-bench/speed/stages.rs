//! Where the time of a step goes, by the engine's own clock.

use std::fmt::Write as _;

use carom_bench::{EngineName, Job, Mode, Reading};
use serde::Serialize;

use crate::head::Head;
use crate::store::Row;
use crate::text;

/// What the laboratory's clock saw and no stage names.
const OTHER: &str = "other";

/// Whether an engine says where its time goes.
pub(crate) const fn tells(engine: EngineName) -> bool {
    matches!(
        engine,
        EngineName::Carom | EngineName::Box2dSse2 | EngineName::Box2dAvx2
    )
}

/// One stage of one engine on one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct StageRow {
    pub(crate) scene: String,
    pub(crate) engine: EngineName,
    pub(crate) mode: Mode,
    pub(crate) stage: String,
    /// Mean over the measured steps.
    pub(crate) ms: Option<f64>,
    /// Of the whole step.
    pub(crate) share: Option<f64>,
    pub(crate) measured_steps: Option<u32>,
    /// Whether time ran out before all steps were made.
    pub(crate) cut: bool,
    pub(crate) failed: Option<String>,
}

/// Rows by scene and engine, the stages in their order in the step, what is left over last.
pub(crate) fn of(measured: &[Row]) -> Vec<StageRow> {
    let mut rows: Vec<StageRow> = measured.iter().flat_map(stages).collect();
    // Stable: stages keep their order.
    rows.sort_by(|a, b| (&a.scene, a.engine).cmp(&(&b.scene, b.engine)));
    rows
}

fn stages(measured: &Row) -> Vec<StageRow> {
    let Job::Profile(job) = &measured.job else {
        return Vec::new();
    };
    let row = StageRow {
        scene: job.scene.clone(),
        engine: job.engine,
        mode: job.mode,
        stage: String::new(),
        ms: None,
        share: None,
        measured_steps: None,
        cut: false,
        failed: None,
    };
    let reading = match &measured.reading {
        Reading::Profile(reading) => reading,
        other => {
            let reason = match other {
                Reading::Failed { reason } => reason,
                _ => "answered another question",
            };
            return vec![StageRow {
                failed: Some(reason.to_owned()),
                ..row
            }];
        }
    };
    let named: f64 = reading.stages.iter().map(|(_, ms)| ms).sum();
    // Two clocks, two grains: less than nothing is nothing.
    let other = (OTHER.to_owned(), (reading.ms_step - named).max(0.0));
    let stages = reading.stages.iter().chain([&other]);
    stages
        .map(|(stage, ms)| StageRow {
            stage: stage.clone(),
            ms: Some(*ms),
            share: Some(ms / reading.ms_step).filter(|share| share.is_finite()),
            measured_steps: Some(reading.measured_steps),
            cut: reading.cut,
            ..row.clone()
        })
        .collect()
}

/// Head, and a table a scene.
pub(crate) fn markdown(head: &Head, rows: &[StageRow]) -> String {
    let mut text = String::from("# Where the time of a step goes\n\n");
    text += &head.markdown();
    text += "\nms: mean over the measured steps, by the engine's own clock (carom: CPU time, Box2D: time on the wall); share: of the step \
             as the laboratory's clock has it; other: what no stage names. cut: time ran out before all steps were made.\n";
    let mut scene = "";
    for row in rows {
        if row.scene != scene {
            scene = &row.scene;
            let _ = write!(
                text,
                "\n## {scene}\n\n| engine | mode | steps | stage | ms | share |\n|---|---|---|---|---|---|\n"
            );
        }
        let _ = match &row.failed {
            Some(reason) => writeln!(
                text,
                "| {} | {} | – | failed: {} | – | – |",
                row.engine,
                row.mode,
                text::cell(reason)
            ),
            None => writeln!(
                text,
                "| {} | {} | {}{} | {} | {} | {} |",
                row.engine,
                row.mode,
                row.measured_steps.unwrap_or(0),
                if row.cut { " (cut)" } else { "" },
                row.stage,
                text::number(row.ms),
                row.share
                    .map_or("–".to_owned(), |share| format!("{:.1} %", 100.0 * share)),
            ),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    use carom_bench::{Limits, StageReading};

    #[test]
    fn what_no_stage_names_is_a_line_of_its_own() {
        let jobs = crate::plan::once(
            &["a_large_pyramid".to_owned()],
            &[EngineName::Carom, EngineName::Box2dSse2],
            Limits::default(),
            Job::Profile,
        );
        let readings = [
            Reading::Profile(StageReading {
                warm_up_steps: 1,
                measured_steps: 10,
                cut: true,
                ms_step: 4.0,
                stages: vec![("pairs".to_owned(), 1.0), ("solver".to_owned(), 2.0)],
            }),
            Reading::Failed {
                reason: "gone".to_owned(),
            },
        ];
        let rows: Vec<Row> = jobs
            .into_iter()
            .zip(readings)
            .map(|(planned, reading)| Row {
                job: planned.job,
                repetition: 0,
                reading,
            })
            .collect();
        let rows = of(&rows);
        let shares: Vec<_> = rows
            .iter()
            .map(|row| (row.stage.as_str(), row.share))
            .collect();
        assert_eq!(
            shares,
            [
                ("pairs", Some(0.25)),
                ("solver", Some(0.5)),
                ("other", Some(0.25)),
                ("", None)
            ]
        );
        let text = markdown(&Head::default(), &rows);
        for line in [
            "| carom | hybrid | 10 (cut) | other | 1.00 | 25.0 % |\n",
            "| box2d-sse2 | stock | – | failed: gone | – | – |\n",
        ] {
            assert!(text.contains(line), "{text}");
        }
    }
}
