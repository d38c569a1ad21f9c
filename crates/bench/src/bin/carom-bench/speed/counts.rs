//! Instructions a step: the one comparison that a busy machine does not disturb.

use std::fmt::Write as _;

use carom_bench::{EngineName, Job, Mode, Reading};
use serde::Serialize;

use crate::head::Head;
use crate::store::Row;
use crate::text;

/// One engine on one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct CountRow {
    pub(crate) scene: String,
    pub(crate) engine: EngineName,
    pub(crate) mode: Mode,
    pub(crate) warm_up_steps: Option<u32>,
    pub(crate) measured_steps: Option<u32>,
    /// Mean over the counted steps.
    pub(crate) instructions: Option<f64>,
    /// To the peer with the fewest.
    pub(crate) ratio_to_best_peer: Option<f64>,
    pub(crate) failed: Option<String>,
}

/// Rows by scene and engine.
pub(crate) fn of(measured: &[Row]) -> Vec<CountRow> {
    let mut rows: Vec<CountRow> = measured.iter().filter_map(row).collect();
    for index in 0..rows.len() {
        let best = rows
            .iter()
            .filter(|row| row.engine != EngineName::Carom && row.scene == rows[index].scene)
            .filter_map(|row| row.instructions)
            .min_by(f64::total_cmp);
        let own = rows[index].instructions;
        rows[index].ratio_to_best_peer = own.zip(best).map(|(own, best)| own / best);
    }
    rows.sort_by(|a, b| (&a.scene, a.engine).cmp(&(&b.scene, b.engine)));
    rows
}

fn row(measured: &Row) -> Option<CountRow> {
    let Job::Bare(job) = &measured.job else {
        return None;
    };
    let counted = match &measured.reading {
        Reading::Instructions(counted) => Ok(*counted),
        Reading::Failed { reason } => Err(reason.clone()),
        _ => Err("answered another question".to_owned()),
    };
    let good = counted.as_ref().ok();
    Some(CountRow {
        scene: job.scene.clone(),
        engine: job.engine,
        mode: job.mode,
        warm_up_steps: good.map(|counted| counted.warm_up_steps),
        measured_steps: good.map(|counted| counted.measured_steps),
        instructions: good.map(|counted| counted.per_step()),
        ratio_to_best_peer: None,
        failed: counted.err(),
    })
}

/// Head and one table.
pub(crate) fn markdown(head: &Head, rows: &[CountRow]) -> String {
    let mut text = String::from("# Instructions a step\n\n");
    text += &head.markdown();
    text += "\nCounted by valgrind's callgrind: mean over the counted steps after those of the warm-up, in millions. They do not depend \
             on what else the machine does, and do not say how long an instruction takes: lanes, caches and branches count alike. \
             Ratio: to the peer with the fewest.\n\n\
             | scene | engine | mode | warm-up | steps | million instructions a step | ratio |\n|---|---|---|---|---|---|---|\n";
    for row in rows {
        let _ = write!(text, "| {} | {} | {} |", row.scene, row.engine, row.mode);
        let steps = |count: Option<u32>| count.map_or("–".to_owned(), |count| count.to_string());
        let _ = match &row.failed {
            Some(reason) => writeln!(text, " – | – | failed: {} | – |", text::cell(reason)),
            None => writeln!(
                text,
                " {} | {} | {} | {} |",
                steps(row.warm_up_steps),
                steps(row.measured_steps),
                text::number(row.instructions.map(|count| 1e-6 * count)),
                text::number(row.ratio_to_best_peer),
            ),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    use carom_bench::{Instructions, Limits};

    #[test]
    fn counts_are_compared_with_the_peer_that_has_the_fewest() {
        use EngineName::{Carom, Chipmunk, Rapier};
        let counted = |total| {
            Reading::Instructions(Instructions {
                warm_up_steps: 5,
                measured_steps: 2,
                total,
            })
        };
        let failed = Reading::Failed {
            reason: "no | valgrind".to_owned(),
        };
        let jobs = crate::plan::once(
            &["i_mostly_empty".to_owned()],
            &[Rapier, Carom, Chipmunk],
            Limits::default(),
            Job::Bare,
        );
        let readings = [counted(4_000_000), counted(6_000_000), failed];
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
        let ratios: Vec<_> = rows.iter().map(|row| row.ratio_to_best_peer).collect();
        assert_eq!(ratios, [Some(1.5), Some(1.0), None]);
        let text = markdown(&Head::default(), &rows);
        for line in [
            "| i_mostly_empty | carom | hybrid | 5 | 2 | 3.00 | 1.50 |\n",
            "| chipmunk | stock | – | – | failed: no / valgrind | – |\n",
        ] {
            assert!(text.contains(line), "{text}");
        }
    }
}
