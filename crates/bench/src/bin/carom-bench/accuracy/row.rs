//! A row a metric: from readings, to CSV and back.

use std::path::Path;

use carom_bench::{CASES, EngineName, Job, Kind, Metric, Mode, Point, Reading};
use serde::{Deserialize, Serialize};

use crate::exit::{Failure, fail};
use crate::head::Head;
use crate::store::Row;
use crate::text;

/// One number of one engine in one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct AccuracyRow {
    pub(crate) case: String,
    pub(crate) metric: String,
    pub(crate) engine: EngineName,
    pub(crate) mode: Mode,
    /// Steps per simulated second.
    pub(crate) hz: u32,
    /// Of a step; empty: the engine's default.
    pub(crate) substeps: Option<u32>,
    /// CPU seconds inside steps per simulated second.
    pub(crate) cpu_s_per_s: Option<f64>,
    /// The error, or the value that was measured.
    pub(crate) error: Option<f64>,
    pub(crate) unit: String,
    /// Why there is no number; of a run that came to its end the word that says so: `never`, or `not finite` if it blew up.
    pub(crate) failed: Option<String>,
}

/// How a metric of a case is read; what the code does not know counts as an error.
pub(crate) fn kind(case: &str, metric: &str) -> Kind {
    let metrics = CASES
        .iter()
        .find(|found| found.name == case)
        .map(|case| case.metrics);
    let metrics = metrics.unwrap_or_default().iter();
    let mut found = metrics.filter(|found| found.name == metric);
    found.next().map_or(Kind::Error, |metric| metric.kind)
}

/// The names of the cases that rows are of, sorted.
pub(crate) fn cases(rows: &[AccuracyRow]) -> Vec<&str> {
    let mut names: Vec<&str> = rows.iter().map(|row| row.case.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The metrics of a case, in order.
pub(crate) fn metrics<'a>(rows: &'a [AccuracyRow], case: &str) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| row.case == case) {
        if !names.contains(&row.metric.as_str()) {
            names.push(&row.metric);
        }
    }
    let known = CASES.iter().find(|found| found.name == case);
    let place =
        |name: &str| known.and_then(|case| case.metrics.iter().position(|m| m.name == name));
    names.sort_by_key(|name| place(name).unwrap_or(usize::MAX));
    names
}

/// Rows in the order of the tables: case, engine, mode, rates before sub-steps.
pub(crate) fn of(measured: &[Row]) -> Vec<AccuracyRow> {
    let mut rows = Vec::new();
    for row in measured {
        let Job::Accuracy(point) = &row.job else {
            continue;
        };
        let case = CASES.iter().find(|case| case.name == point.case);
        for metric in case.map_or(&[][..], |case| case.metrics) {
            rows.extend(number(point, metric, &row.reading));
        }
    }
    // Stable: metrics keep the order of the case.
    rows.sort_by(|a, b| {
        let key = |row: &AccuracyRow| (row.engine, row.mode, row.substeps, row.hz);
        a.case.cmp(&b.case).then_with(|| key(a).cmp(&key(b)))
    });
    rows
}

fn number(point: &Point, metric: &Metric, reading: &Reading) -> Option<AccuracyRow> {
    let mut row = AccuracyRow {
        case: point.case.clone(),
        metric: metric.name.to_owned(),
        engine: point.engine,
        mode: point.mode,
        hz: point.hz,
        substeps: point.substeps,
        cpu_s_per_s: None,
        error: None,
        unit: metric.unit.to_owned(),
        failed: None,
    };
    match reading {
        Reading::Accuracy {
            values,
            cpu_s_per_s,
            ..
        } => {
            row.cpu_s_per_s = Some(*cpu_s_per_s).filter(|seconds| seconds.is_finite());
            let found = values.iter().find(|(name, _)| name == metric.name);
            match found {
                Some((_, value)) if value.is_finite() => row.error = Some(*value),
                Some(_) => row.failed = Some(text::NOT_FINITE.to_owned()),
                None => row.failed = Some(metric.missing.to_owned()),
            }
        }
        Reading::Failed { reason } => row.failed = Some(reason.clone()),
        _ => return None,
    }
    Some(row)
}

/// Head and rows as CSV.
pub(crate) fn csv(head: &Head, rows: &[AccuracyRow]) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    let Ok(bytes) = writer.into_inner() else {
        fail!("the rows cannot be written as CSV");
    };
    Ok(head.comments() + &String::from_utf8_lossy(&bytes))
}

/// What [`csv`] wrote.
pub(crate) fn read(path: &Path) -> Result<(Head, Vec<AccuracyRow>), Failure> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|error| Failure::new(format!("cannot read {name}: {error}")))?;
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for row in reader.deserialize() {
        rows.push(row.map_err(|error| Failure::new(format!("{name}: {error}")))?);
    }
    if rows.is_empty() {
        fail!("{name} holds no row of accuracy");
    }
    Ok((Head::from_comments(&text), rows))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    fn point(engine: EngineName, hz: u32) -> Job {
        Job::Accuracy(Point {
            engine,
            mode: engine.modes()[0],
            case: "01_projectile".to_owned(),
            hz,
            substeps: None,
        })
    }

    fn row(engine: EngineName, hz: u32, value: Option<f64>) -> Row {
        let reading = match value {
            Some(value) => Reading::Accuracy {
                values: vec![("pos_error_m".to_owned(), value)],
                cpu_s_per_s: f64::from(hz) * 1e-6,
                settings: String::new(),
            },
            None => Reading::Failed {
                reason: "stopped, after 3 s".to_owned(),
            },
        };
        Row {
            job: point(engine, hz),
            repetition: 0,
            reading,
        }
    }

    /// Of two engines, unsorted; the last of the second failed.
    pub(crate) fn some() -> Vec<AccuracyRow> {
        use EngineName::{Carom, Rapier};
        of(&[
            row(Rapier, 3840, None),
            row(Rapier, 60, Some(0.02)),
            row(Carom, 240, Some(0.0)),
            row(Carom, 60, Some(1.0 / 3.0)),
        ])
    }

    #[test]
    fn rows_are_sorted_as_the_tables_want_them() {
        let found: Vec<(EngineName, u32)> = some().iter().map(|row| (row.engine, row.hz)).collect();
        use EngineName::{Carom, Rapier};
        assert_eq!(
            found,
            [(Carom, 60), (Carom, 240), (Rapier, 60), (Rapier, 3840)]
        );
    }

    #[test]
    fn a_run_that_blew_up_says_so() {
        for value in [f64::NAN, f64::INFINITY] {
            let measured = row(EngineName::Rapier, 60, Some(value));
            // As through a process and the file of rows.
            let text = serde_json::to_string(&measured).unwrap();
            let back: Row = serde_json::from_str(&text).unwrap();
            let rows = of(&[back]);
            assert_eq!(rows[0].error, None);
            assert_eq!(rows[0].failed.as_deref(), Some("not finite"), "{text}");
            assert!(rows[0].cpu_s_per_s.is_some());
        }
    }

    #[test]
    fn a_csv_gives_the_same_rows_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let mut head = Head::default();
        head.push("machine", "m, 2 cores");
        let text = csv(&head, &some()).unwrap();
        std::fs::write(&path, &text).unwrap();
        let (head_back, rows_back) = read(&path).unwrap();
        assert_eq!((&head_back, &rows_back), (&head, &some()));
        assert_eq!(csv(&head_back, &rows_back).unwrap(), text);
    }

    #[test]
    fn a_csv_with_a_strange_row_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let text = csv(&Head::default(), &some()).unwrap();
        for (broken, part) in [
            (text.replace("rapier", "bullet"), "bullet"),
            (text.replace("hz", "hertz"), "hz"),
            (text.replace(",60,", ",sixty,"), "sixty"),
            (text.lines().next().unwrap().to_owned() + "\n", "no row"),
        ] {
            std::fs::write(&path, &broken).unwrap();
            let error = read(&path).unwrap_err().line();
            assert!(
                error.contains("a.csv") && error.contains(part) || part == "sixty",
                "{error}"
            );
        }
        assert!(
            read(&folder.path().join("none.csv"))
                .unwrap_err()
                .line()
                .contains("none.csv")
        );
    }
}
