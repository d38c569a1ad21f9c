//! Error against run time, both logarithmic: down and to the left is better.

use std::path::{Path, PathBuf};

use carom_bench::{CASES, Kind};
use carom_math::{Vec2, vec2};
use carom_render::{Chart, Panels, Size};

use super::row::{self, AccuracyRow};
use super::table;
use crate::exit::Failure;
use crate::picture;

/// Cases of the overview, in words.
const TELLING: [(&str, &str); 6] = [
    ("01", "A throw: place after 1 s"),
    ("03", "A bouncing ball: height of its bounces"),
    ("06", "An elastic blow off centre: velocities"),
    ("08", "A sliding block: distance after 2 s"),
    ("12", "Elastic polygons in a box: energy"),
    ("13", "A stack of 20 boxes: deepest overlap"),
];

/// Writes a chart for every case, by its first error, and the overview.
pub(super) fn write(folder: &Path, rows: &[AccuracyRow]) -> Result<Vec<PathBuf>, Failure> {
    let mut written = Vec::new();
    let mut overview = Panels::new("Error against run time", 3)
        .subtitled("down and to the left is better; a curve runs from few steps a second to many; exact: no error; failed: fell, tunnelled or blew up");
    let mut charts: Vec<(&str, Chart)> = Vec::new();
    for case in row::cases(rows) {
        let Some(chart) = of_case(rows, case) else {
            continue;
        };
        written.extend(picture::write(
            folder,
            case,
            &chart.frame(Size::new(860, 560)?),
        )?);
        charts.push((case, chart));
    }
    for (case, chart) in charts {
        let number = case.split('_').next();
        if let Some((_, title)) = TELLING.iter().find(|(known, _)| number == Some(known)) {
            overview = overview.with(Chart {
                title: (*title).to_owned(),
                subtitle: String::new(),
                ..chart
            });
        }
    }
    if !overview.charts.is_empty() {
        let lines = u32::try_from(overview.charts.len().div_ceil(3)).unwrap_or(1);
        let size = Size::new(1320, 120 + 380 * lines)?;
        written.extend(picture::write(folder, "overview", &overview.frame(size))?);
    }
    Ok(written)
}

/// The chart of a case's first error; `None` if it has none.
fn of_case(rows: &[AccuracyRow], case: &str) -> Option<Chart> {
    let rows: Vec<&AccuracyRow> = rows
        .iter()
        .filter(|row| row.case == case && row.substeps.is_none())
        .collect();
    let owned: Vec<AccuracyRow> = rows.iter().map(|row| (*row).clone()).collect();
    let metrics = row::metrics(&owned, case);
    let metric = *metrics
        .iter()
        .find(|metric| row::kind(case, metric) == Kind::Error)?;
    let about = CASES.iter().find(|found| found.name == case);
    let mut chart = Chart::new(format!("{case}: {metric}"))
        .subtitled(about.map_or("", |case| case.about))
        .x("CPU ms per simulated second")
        .log_x()
        .log_y();
    let mut curves = table::curves(&rows, metric);
    // Stable: carom is drawn last, the others keep the order of the tables.
    curves.sort_by_key(|curve| picture::on_top(curve[0].engine));
    let left = curves
        .iter()
        .flatten()
        .filter_map(|row| row.cpu_s_per_s)
        .fold(f64::INFINITY, f64::min);
    let mut unit = "";
    for curve in curves {
        unit = &curve[0].unit;
        let points: Vec<Vec2> = curve.iter().map(|row| place(row, &curve, left)).collect();
        // Nothing is hidden: a strip is there as soon as a point needs it.
        if points.iter().any(|point| point.y == 0.0) {
            chart.y.floor = "exact".to_owned();
        }
        if points.iter().any(|point| point.y == f64::INFINITY) {
            chart.y.ceiling = "failed".to_owned();
        }
        chart = chart.with(picture::series(curve[0].engine, curve[0].mode, points));
    }
    Some(chart.y(match unit {
        "1" => "error, as a part of the right value".to_owned(),
        unit => format!("error, in {unit}"),
    }))
}

/// CPU time in ms and error; a failed run is infinitely wrong.
///
/// One that was stopped has no time of its own: it stands where the curve's nearest rate would put it, else at the left edge.
fn place(row: &AccuracyRow, curve: &[&AccuracyRow], left: f64) -> Vec2 {
    let near = || {
        let timed = curve.iter().filter(|other| other.cpu_s_per_s.is_some());
        let nearest = timed.min_by_key(|other| other.hz.abs_diff(row.hz))?;
        Some(nearest.cpu_s_per_s? * f64::from(row.hz) / f64::from(nearest.hz))
    };
    let seconds = row.cpu_s_per_s.or_else(near).unwrap_or(left);
    let seconds = if seconds.is_finite() { seconds } else { 1e-3 };
    vec2(1e3 * seconds, row.error.map_or(f64::INFINITY, f64::abs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::row::tests::some;

    #[test]
    fn what_failed_stands_at_the_top_and_what_is_exact_at_the_bottom() {
        let rows = some();
        let chart = of_case(&rows, "01_projectile").unwrap();
        assert_eq!(chart.series.len(), 2);
        let [rapier, carom] = [0, 1].map(|i| &chart.series[i]);
        assert!(
            carom.name.starts_with("carom"),
            "carom on top: {}",
            carom.name
        );
        assert_eq!(carom.points[1].y, 0.0);
        assert_eq!(
            (chart.y.floor.as_str(), chart.y.ceiling.as_str()),
            ("exact", "failed")
        );
        // 60 steps a second cost 0.06 ms, 3840 are put at 64 times that.
        assert_eq!(rapier.points[1].y, f64::INFINITY);
        assert!(
            (rapier.points[1].x - 64.0 * 0.06).abs() < 1e-9,
            "{}",
            rapier.points[1]
        );
    }

    #[test]
    fn every_case_has_its_pictures_light_and_dark() {
        let folder = tempfile::tempdir().unwrap();
        let written = write(folder.path(), &some()).unwrap();
        let names: Vec<String> = written
            .iter()
            .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
            .collect();
        for name in [
            "01_projectile.png",
            "01_projectile-dark.svg",
            "overview.svg",
            "overview-dark.png",
        ] {
            assert!(names.iter().any(|found| found == name), "{names:?}");
        }
    }
}
