//! How many times the best peer's time every engine takes: a line a scene, a dot an engine.

use std::path::{Path, PathBuf};

use carom_math::vec2;
use carom_render::{Chart, Size};

use super::row::{self, SpeedRow};
use crate::exit::Failure;
use crate::picture;

/// Writes `ratios`; nothing if no peer ran.
pub(super) fn write(folder: &Path, rows: &[SpeedRow]) -> Result<Vec<PathBuf>, Failure> {
    let Some(chart) = ratios(rows) else {
        return Ok(Vec::new());
    };
    let lines = u32::try_from(chart.y.names.len()).unwrap_or(1);
    let frame = chart.frame(Size::new(900, 170 + 34 * lines)?);
    picture::write(folder, "ratios", &frame)
}

fn ratios(rows: &[SpeedRow]) -> Option<Chart> {
    let compared = |row: &&SpeedRow| {
        row.threads == 1
            && !row.reads_poses
            && row.mode == row.engine.modes()[0]
            && row.ratio_to_best_peer.is_some()
    };
    let rows: Vec<SpeedRow> = rows.iter().filter(compared).cloned().collect();
    if rows.is_empty() {
        return None;
    }
    let mut scenes = row::scenes(&rows);
    // The first scene on top.
    scenes.reverse();
    let mut chart = Chart::new("Time of a step, as a multiple of the best peer's")
        .subtitled("one thread, defaults, stepping only; left is faster")
        .x("times the best peer")
        .log_x();
    chart.y.names = scenes.iter().map(|scene| (*scene).to_owned()).collect();
    let mut engines: Vec<_> = rows.iter().map(|row| row.engine).collect();
    engines.sort_by_key(|engine| (picture::on_top(*engine), *engine));
    engines.dedup();
    for engine in engines {
        let of_engine = rows.iter().filter(|row| row.engine == engine);
        #[expect(clippy::cast_precision_loss, reason = "a count of scenes")]
        let place = |row: &SpeedRow| {
            let line = scenes.iter().position(|scene| *scene == row.scene)?;
            Some(vec2(row.ratio_to_best_peer?, line as f64))
        };
        let points = of_engine.filter_map(place).collect();
        let mut series = picture::series(engine, engine.modes()[0], points);
        engine.name().clone_into(&mut series.name);
        series.width = 0.0;
        chart = chart.with(series);
    }
    Some(chart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::speed::row::tests::some;

    #[test]
    fn a_scene_is_a_line_and_an_engine_a_dot() {
        let chart = ratios(&some()).unwrap();
        assert_eq!(chart.y.names, ["a_large_pyramid"]);
        let names: Vec<&str> = chart
            .series
            .iter()
            .map(|series| series.name.as_str())
            .collect();
        assert_eq!(
            names,
            ["box2d-sse2", "rapier", "carom"],
            "who failed has no ratio"
        );
        assert_eq!(chart.series[2].points, [vec2(3.0, 0.0)]);
        assert!(ratios(&[]).is_none());
    }
}
