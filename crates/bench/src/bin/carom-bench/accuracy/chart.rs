//! Error against run time, both logarithmic: down and to the left is better.

use std::path::{Path, PathBuf};

use carom_bench::{CASES, EngineName, Kind, Mode};
use carom_math::{Vec2, vec2};
use carom_render::{Chart, Frame, Ink, Marker, Panels, Series, Size};

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

/// Curves of the overview: every engine as it comes, carom also without closed forms; the tables have the others.
const SHOWN: [(EngineName, Mode, &str); 6] = [
    (EngineName::Box2dSse2, Mode::Stock, "Box2D"),
    (EngineName::Rapier, Mode::Stock, "Rapier"),
    (EngineName::RapierF64, Mode::Stock, "Rapier, f64"),
    (EngineName::Chipmunk, Mode::Stock, "Chipmunk"),
    (EngineName::Carom, Mode::Stepped, "carom, stepped"),
    (EngineName::Carom, Mode::Hybrid, "carom"),
];

/// The rate that points are ringed at, in steps per simulated second: what games and most simulations run at.
const USUAL: u32 = 60;

/// Writes a chart for every case, by its first error, and the overview.
pub(super) fn write(folder: &Path, rows: &[AccuracyRow]) -> Result<Vec<PathBuf>, Failure> {
    let mut written = Vec::new();
    for case in row::cases(rows) {
        if let Some(chart) = of_case(rows, case) {
            let frame = chart.frame(Size::new(860, 560)?);
            written.extend(picture::write(folder, case, &frame)?);
        }
    }
    if let Some(frame) = overview(rows)? {
        written.extend(picture::write(folder, "overview", &frame)?);
    }
    Ok(written)
}

/// Six cases, an engine a curve, in words; `None` if none of them was measured.
fn overview(rows: &[AccuracyRow]) -> Result<Option<Frame>, Failure> {
    let shown: Vec<AccuracyRow> = rows
        .iter()
        .filter(|row| name(row.engine, row.mode).is_some())
        .cloned()
        .collect();
    let mut panels = Panels::new("Error against computing time", 2);
    panels.subtitle = "Down and to the left is better. Each engine with its defaults, from 30 to 3840 steps a second along its curve; ringed: 60.\n\
         \"carom, stepped\" does without closed forms (Mode::Stepped); \"Rapier, f64\" is Rapier built for double precision."
        .to_owned();
    for (number, title) in TELLING {
        let case = row::cases(&shown)
            .into_iter()
            .find(|case| case.split('_').next() == Some(number));
        let Some(mut chart) = case.and_then(|case| of_case(&shown, case)) else {
            continue;
        };
        title.clone_into(&mut chart.title);
        chart.subtitle.clear();
        panels = panels.with(chart.named_at_ends());
    }
    if panels.charts.is_empty() {
        return Ok(None);
    }
    let has = |strip: fn(&Chart) -> &String| panels.charts.iter().any(|c| !strip(c).is_empty());
    let mut strips = Vec::new();
    if has(|chart| &chart.y.floor) {
        strips.push("\"exact\": no error at all.");
    }
    if has(|chart| &chart.y.ceiling) {
        strips.push("\"failed\": something fell, passed through, or blew up.");
    }
    panels.subtitle = format!("{}\n{}", panels.subtitle, strips.join(" "));
    let lines = u32::try_from(panels.charts.len().div_ceil(2)).unwrap_or(1);
    Ok(Some(panels.frame(Size::new(1000, 116 + 330 * lines)?)))
}

/// What the overview calls a curve; `None` if it is not there.
fn name(engine: EngineName, mode: Mode) -> Option<&'static str> {
    let found = SHOWN
        .iter()
        .find(|shown| (shown.0, shown.1) == (engine, mode));
    found.map(|(_, _, name)| *name)
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
        .x("CPU time for a simulated second, in ms")
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
    let mut ringed = Vec::new();
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
        let usual = curve.iter().position(|row| row.hz == USUAL);
        ringed.extend(usual.map(|index| points[index]));
        let (engine, mode) = (curve[0].engine, curve[0].mode);
        let mut series = picture::series(engine, mode, points);
        if let Some(name) = name(engine, mode) {
            name.clone_into(&mut series.name);
        }
        chart = chart.with(series);
    }
    let rings = Series::line("", ringed).scattered(Marker::Ring);
    let chart = chart.with(rings.inked(Ink::Text));
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
        assert_eq!(chart.series.len(), 3, "two curves and the rings");
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
    fn the_committed_overview_and_table_are_those_of_the_committed_rows() {
        let folder = picture::tests::results().join("accuracy");
        let (head, rows) = row::read(&folder.join("accuracy.csv")).unwrap();
        picture::tests::committed(&folder, "overview", &overview(&rows).unwrap().unwrap());
        picture::tests::same(
            &folder.join("accuracy.md"),
            table::markdown(&head, &rows).as_bytes(),
        );
    }

    #[test]
    fn every_engine_of_the_overview_is_one_colour_and_rings_its_usual_rate() {
        let folder = picture::tests::results().join("accuracy");
        let (_, rows) = row::read(&folder.join("accuracy.csv")).unwrap();
        let shown: Vec<AccuracyRow> = rows
            .into_iter()
            .filter(|row| name(row.engine, row.mode).is_some())
            .collect();
        let chart = of_case(&shown, "01_projectile").unwrap();
        let ink = |name: &str| {
            let found = chart.series.iter().find(|series| series.name == name);
            found.unwrap_or_else(|| panic!("no {name}")).ink
        };
        assert_eq!(ink("carom"), ink("carom, stepped"));
        assert_eq!(ink("Rapier"), ink("Rapier, f64"));
        assert!(ink("carom") != ink("Box2D") && ink("Box2D") != ink("Rapier"));
        let rings = chart.series.last().unwrap();
        assert_eq!(
            (rings.marker, rings.points.len()),
            (Some(Marker::Ring), SHOWN.len())
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
