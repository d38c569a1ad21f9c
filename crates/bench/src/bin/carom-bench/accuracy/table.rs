//! The table: a case after the other, a line an engine and mode.

use std::fmt::Write as _;

use carom_bench::{CASES, Kind, order};

use super::row::{self, AccuracyRow};
use crate::head::Head;
use crate::text;

/// The rates of the columns, steps per simulated second.
const COLUMNS: [u32; 4] = [60, 240, 960, 3840];

/// The rate of the cost shown, and of the sweep over sub-steps.
const COMMON: u32 = 60;

/// Head, and for each case its metrics.
pub(crate) fn markdown(head: &Head, rows: &[AccuracyRow]) -> String {
    let mut text = String::from("# Run time against error\n\n");
    text += &head.markdown();
    text += "\nErrors by steps per simulated second; 0 is exactly 0, – was not measured. \
             Order: p of error = C hz^-p, by least squares over the part of the sweep that falls. \
             CPU: ms inside steps per simulated second at 60 steps a second.\n";
    for case in row::cases(rows) {
        let of_case: Vec<&AccuracyRow> = rows.iter().filter(|row| row.case == case).collect();
        let about = CASES.iter().find(|found| found.name == case);
        let _ = write!(
            text,
            "\n## {case}\n\n{}\n",
            about.map_or("", |case| case.about)
        );
        let metrics = row::metrics(rows, case);
        rates(&mut text, case, &metrics, &of_case);
        substeps(&mut text, case, &metrics, &of_case);
        failures(&mut text, &of_case);
    }
    text
}

/// A table over the rates.
fn rates(text: &mut String, case: &str, metrics: &[&str], rows: &[&AccuracyRow]) {
    let rows: Vec<&AccuracyRow> = rows
        .iter()
        .copied()
        .filter(|row| row.substeps.is_none())
        .collect();
    let columns: Vec<u32> = COLUMNS
        .into_iter()
        .filter(|hz| rows.iter().any(|row| row.hz == *hz))
        .collect();
    let heads: String = columns.iter().map(|hz| format!(" {hz} |")).collect();
    let _ = write!(
        text,
        "\n| metric | engine | mode |{heads} order | CPU ms / s |\n|---|---|---|{}---|---|\n",
        "---|".repeat(columns.len())
    );
    for metric in metrics {
        for curve in curves(&rows, metric) {
            let first = curve[0];
            let value = row::kind(case, metric) == Kind::Value;
            let cells: String = columns
                .iter()
                .map(|hz| {
                    format!(
                        " {} |",
                        cell(curve.iter().find(|row| row.hz == *hz).copied(), value)
                    )
                })
                .collect();
            let cost = curve.iter().find(|row| row.hz == COMMON);
            let cost = cost
                .and_then(|row| row.cpu_s_per_s)
                .map(|seconds| 1e3 * seconds);
            let order = if value { None } else { observed(&curve) };
            let _ = writeln!(
                text,
                "| {} | {} | {} |{cells} {} | {} |",
                name(metric, &first.unit, value),
                first.engine,
                first.mode,
                order.map_or_else(|| "–".to_owned(), |order| format!("{order:.1}")),
                text::number(cost)
            );
        }
    }
}

/// A table over the sub-steps at one rate, if they were measured.
fn substeps(text: &mut String, case: &str, metrics: &[&str], rows: &[&AccuracyRow]) {
    let rows: Vec<&AccuracyRow> = rows
        .iter()
        .copied()
        .filter(|row| row.substeps.is_some())
        .collect();
    let mut columns: Vec<u32> = rows.iter().filter_map(|row| row.substeps).collect();
    columns.sort_unstable();
    columns.dedup();
    if columns.is_empty() {
        return;
    }
    let heads: String = columns.iter().map(|count| format!(" {count} |")).collect();
    let _ = write!(
        text,
        "\nSub-steps, or solver iterations, at {COMMON} steps a second:\n\n| metric | engine | mode |{heads}\n|---|---|---|{}\n",
        "---|".repeat(columns.len())
    );
    for metric in metrics {
        let value = row::kind(case, metric) == Kind::Value;
        for curve in curves(&rows, metric) {
            let cells: String = columns
                .iter()
                .map(|count| {
                    curve
                        .iter()
                        .find(|row| row.substeps == Some(*count))
                        .copied()
                })
                .map(|row| format!(" {} |", cell(row, value)))
                .collect();
            let first = curve[0];
            let _ = writeln!(
                text,
                "| {} | {} | {} |{cells}",
                name(metric, &first.unit, value),
                first.engine,
                first.mode
            );
        }
    }
}

/// Each reason once, with the first row that it befell.
fn failures(text: &mut String, rows: &[&AccuracyRow]) {
    let mut seen: Vec<(String, String)> = Vec::new();
    for row in rows {
        let Some(reason) = row.failed.as_ref().filter(|_| row.cpu_s_per_s.is_none()) else {
            continue;
        };
        let label = format!("{} {}", row.engine, row.mode);
        if !seen.contains(&(label.clone(), reason.clone())) {
            let _ = writeln!(
                text,
                "{}- failed: {label} from {} steps a second: {}",
                if seen.is_empty() { "\n" } else { "" },
                row.hz,
                text::cell(reason)
            );
            seen.push((label, reason.clone()));
        }
    }
}

fn name(metric: &str, unit: &str, value: bool) -> String {
    let unit = if unit == "1" { "–" } else { unit };
    let value = if value { ", value" } else { "" };
    format!("{metric} ({unit}{value})")
}

fn cell(row: Option<&AccuracyRow>, value: bool) -> String {
    match row {
        // The word for a number that never came up, else the reason stands below.
        Some(AccuracyRow {
            failed: Some(word),
            cpu_s_per_s: Some(_),
            ..
        }) => word.clone(),
        Some(row) if row.failed.is_some() => "failed".to_owned(),
        Some(row) if value => text::number(row.error),
        Some(row) => text::error(row.error),
        None => "–".to_owned(),
    }
}

/// The rows of a metric, those of an engine and mode together; the order of the rows stays.
pub(crate) fn curves<'a>(rows: &[&'a AccuracyRow], metric: &str) -> Vec<Vec<&'a AccuracyRow>> {
    let mut curves: Vec<Vec<&AccuracyRow>> = Vec::new();
    for row in rows.iter().copied().filter(|row| row.metric == metric) {
        let same = |curve: &&mut Vec<&AccuracyRow>| {
            (curve[0].engine, curve[0].mode) == (row.engine, row.mode)
        };
        match curves.iter_mut().find(same) {
            Some(curve) => curve.push(row),
            None => curves.push(vec![row]),
        }
    }
    curves
}

/// Observed order of convergence of a curve.
fn observed(curve: &[&AccuracyRow]) -> Option<f64> {
    let point = |row: &&AccuracyRow| Some((f64::from(row.hz), row.error?.abs()));
    order(&curve.iter().filter_map(point).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::row::tests::some;

    #[test]
    fn the_table_says_what_failed_and_what_is_exact() {
        let mut head = Head::default();
        head.push("machine", "m");
        let text = markdown(&head, &some());
        assert!(text.contains("- machine: m\n"), "{text}");
        assert!(
            text.contains("| metric | engine | mode | 60 | 240 | 3840 | order"),
            "{text}"
        );
        assert!(
            text.contains("| pos_error_m (m) | carom | hybrid | 3.3e-1 | 0 | – | – | 0.0600 |"),
            "{text}"
        );
        assert!(
            text.contains("| rapier | stock | 2.0e-2 | – | failed |"),
            "{text}"
        );
        assert!(
            text.contains("- failed: rapier stock from 3840 steps a second: stopped, after 3 s"),
            "{text}"
        );
    }

    #[test]
    fn a_csv_gives_the_same_table() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let mut head = Head::default();
        head.push("machine", "m");
        std::fs::write(&path, row::csv(&head, &some()).unwrap()).unwrap();
        let (head_back, rows_back) = row::read(&path).unwrap();
        assert_eq!(markdown(&head_back, &rows_back), markdown(&head, &some()));
    }
}
