//! The table: a scene after the other, a line an engine and setting.

use std::fmt::Write as _;

use super::row::{self, SpeedRow};
use crate::head::Head;
use crate::text;

/// Head, and for each scene its rows: stepping only first, then stepping and reading all poses.
pub(crate) fn markdown(head: &Head, rows: &[SpeedRow]) -> String {
    let mut text = String::from("# Milliseconds a step, and what they bought\n\n");
    text += &head.markdown();
    text += "\nms: CPU time of a step on one thread, wall time on several: mean, median and 99th percentile over the measured steps, \
             median of the repetitions. Spread: greatest less least mean of the repetitions, over their median; – of a single one. Ratio: of the means, to the fastest peer with as many threads that reads as much. Energy: after the measured \
             steps over before them. Overlap (m), rms acceleration (m/s²) and drift (m): computed by the same code for all. \
             MiB: peak memory of the process; KiB a body: beyond what it took before the scene, over the dynamic bodies; of data: without pages of the program itself. \
             – was not measured; cut: time ran out before all steps were made.\n";
    for scene in row::scenes(rows) {
        let of_scene: Vec<&SpeedRow> = rows.iter().filter(|row| row.scene == scene).collect();
        let _ = write!(text, "\n## {scene}\n");
        for reads_poses in [false, true] {
            let part: Vec<&SpeedRow> = of_scene
                .iter()
                .copied()
                .filter(|row| row.reads_poses == reads_poses)
                .collect();
            if !part.is_empty() {
                let what = if reads_poses {
                    "Stepping and reading all poses"
                } else {
                    "Stepping only"
                };
                let _ = write!(text, "\n{what}:\n\n");
                lines(&mut text, &part);
            }
        }
    }
    text
}

fn lines(text: &mut String, rows: &[&SpeedRow]) {
    let heads = [
        "engine",
        "mode",
        "threads",
        "ms",
        "median",
        "p99",
        "spread",
        "ratio",
        "energy",
        "overlap mean",
        "overlap max",
        "rms acceleration",
        "drift",
        "awake",
        "touching",
        "escaped",
        "not finite",
        "MiB",
        "KiB a body",
        "of data",
        "first step ms",
    ];
    let _ = write!(
        text,
        "| {} |\n|{}\n",
        heads.join(" | "),
        "---|".repeat(heads.len())
    );
    for row in rows {
        if let Some(reason) = &row.failed {
            let _ = writeln!(
                text,
                "| {} | {} | {} | failed: {} |{}",
                row.engine,
                row.mode,
                row.threads,
                text::cell(reason),
                " – |".repeat(heads.len() - 4)
            );
            continue;
        }
        let count = |number: Option<usize>| {
            number.map_or_else(|| "–".to_owned(), |number| number.to_string())
        };
        let cells = [
            row.engine.to_string(),
            format!("{}{}", row.mode, if row.cut { " (cut)" } else { "" }),
            row.threads.to_string(),
            text::number(row.ms_mean),
            text::number(row.ms_median),
            text::number(row.ms_p99),
            row.ms_spread
                .map_or_else(|| "–".to_owned(), |part| format!("{:.1} %", 100.0 * part)),
            text::number(row.ratio_to_best_peer),
            text::ratio(row.energy_ratio),
            text::error(row.overlap_mean),
            text::error(row.overlap_max),
            text::error(row.rms_acceleration),
            text::error(row.drift),
            count(row.bodies_awake),
            count(row.touching),
            count(row.escaped),
            count(row.non_finite),
            row.peak_mib
                .map_or_else(|| "–".to_owned(), |mib| format!("{mib:.0}")),
            text::number(row.kib_per_body),
            text::number(row.data_kib_per_body),
            text::number(row.ms_first),
        ];
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::speed::row::tests::some;

    #[test]
    fn a_failed_row_says_why_and_keeps_the_columns() {
        let text = markdown(&Head::default(), &some());
        let table: Vec<&str> = text.lines().filter(|line| line.starts_with('|')).collect();
        assert_eq!(table.len(), 2 + 4, "{text}");
        let columns = table[0].matches('|').count();
        assert!(
            table
                .iter()
                .all(|line| line.matches('|').count() == columns),
            "{text}"
        );
        assert!(
            text.contains("| carom | hybrid | 1 | 6.00 | 6.00 | 12.0 | 750.0 % | 3.00 | 1.2500 |"),
            "{text}"
        );
        assert!(
            text.contains("| chipmunk | stock | 1 | failed: stopped after 3 s |"),
            "{text}"
        );
    }
}
