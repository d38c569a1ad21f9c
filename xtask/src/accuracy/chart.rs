//! Error against run time, both logarithmic: down and to the left is better.

use std::path::{Path, PathBuf};

use carom_math::{Vec2, vec2};
use carom_render::{Chart, Series, Size, Style, write_file};

use super::{CASES, Row};
use crate::exit::Failure;

/// An error of 0 has no logarithm: it is drawn here, below every rounding, in m.
const FLOOR: f64 = 1e-17;

/// Writes `accuracy.png` and `accuracy.svg`.
pub(super) fn write(folder: &Path, rows: &[Row]) -> Result<[PathBuf; 2], Failure> {
    let mut chart = Chart::new("Error against run time")
        .subtitled("ticks of 1/60 to 1/480 s; fastest of at least three runs on one thread")
        .x("ms per simulated second")
        .y("error (m)")
        .log_x()
        .log_y();
    for (index, case) in CASES.iter().enumerate() {
        let of_case = rows.iter().filter(|row| row.case == case.name);
        let points: Vec<Vec2> = of_case
            .map(|row| vec2(row.ms_per_second, row.error_m.max(FLOOR)))
            .collect();
        if !points.is_empty() {
            chart = chart.with(Series::line(case.name, points).marked(Chart::marker(index)));
        }
    }
    let (size, style) = (Size::new(800, 520)?, Style::light());
    let (png, svg) = (folder.join("accuracy.png"), folder.join("accuracy.svg"));
    chart.paint(size, &style).save_png(&png)?;
    write_file(&svg, chart.frame(size).to_svg(&style).as_bytes())?;
    Ok([png, svg])
}
