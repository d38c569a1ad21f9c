//! How many times the best peer's time every engine takes: a line a scene, a dot an engine.

use std::path::{Path, PathBuf};

use carom_bench::{EngineName, Mode};
use carom_math::vec2;
use carom_render::{Chart, Frame, Size};
use serde::Deserialize;

use super::row::SpeedRow;
use crate::exit::Failure;
use crate::picture;

/// What the chart shows of a row.
#[derive(Debug, Deserialize)]
struct Dot {
    scene: String,
    engine: EngineName,
    mode: Mode,
    threads: u32,
    reads_poses: bool,
    ratio_to_best_peer: Option<f64>,
}

impl From<&SpeedRow> for Dot {
    fn from(row: &SpeedRow) -> Self {
        Self {
            scene: row.scene.clone(),
            engine: row.engine,
            mode: row.mode,
            threads: row.threads,
            reads_poses: row.reads_poses,
            ratio_to_best_peer: row.ratio_to_best_peer,
        }
    }
}

/// Writes `ratios`; nothing if no peer ran.
pub(super) fn write(folder: &Path, rows: &[SpeedRow]) -> Result<Vec<PathBuf>, Failure> {
    match frame(rows.iter().map(Dot::from).collect())? {
        Some(frame) => picture::write(folder, "ratios", &frame),
        None => Ok(Vec::new()),
    }
}

fn frame(dots: Vec<Dot>) -> Result<Option<Frame>, Failure> {
    let Some(chart) = ratios(dots) else {
        return Ok(None);
    };
    let lines = u32::try_from(chart.y.names.len()).unwrap_or(1);
    Ok(Some(chart.frame(Size::new(900, 170 + 34 * lines)?)))
}

fn ratios(mut dots: Vec<Dot>) -> Option<Chart> {
    dots.retain(|dot| {
        dot.threads == 1
            && !dot.reads_poses
            && dot.mode == dot.engine.modes()[0]
            && dot.ratio_to_best_peer.is_some()
    });
    // The scene on which carom, or else an engine, is slowest on top.
    dots.sort_by(|a, b| {
        let key = |dot: &Dot| (picture::on_top(dot.engine), dot.ratio_to_best_peer);
        let ((own_a, a), (own_b, b)) = (key(a), key(b));
        own_b
            .cmp(&own_a)
            .then(a.unwrap_or(0.0).total_cmp(&b.unwrap_or(0.0)))
    });
    let mut scenes: Vec<&str> = Vec::new();
    for dot in &dots {
        if !scenes.contains(&dot.scene.as_str()) {
            scenes.push(&dot.scene);
        }
    }
    if scenes.is_empty() {
        return None;
    }
    let mut chart = Chart::new("Time of a step")
        .subtitled("one thread, defaults, stepping alone")
        .x("time of a step, as a multiple of that of the fastest other engine")
        .log_x();
    chart.x.marks = vec![(1.0, "faster | slower".to_owned())];
    chart.y.names = scenes.iter().map(|scene| title(scene).to_owned()).collect();
    let mut engines: Vec<_> = dots.iter().map(|dot| dot.engine).collect();
    engines.sort_by_key(|engine| (picture::on_top(*engine), *engine));
    engines.dedup();
    for engine in engines {
        let of_engine = dots.iter().filter(|dot| dot.engine == engine);
        #[expect(clippy::cast_precision_loss, reason = "a count of scenes")]
        let place = |dot: &Dot| {
            let line = scenes.iter().position(|scene| *scene == dot.scene)?;
            Some(vec2(dot.ratio_to_best_peer?, line as f64))
        };
        let points = of_engine.filter_map(place).collect();
        let mut series = picture::series(engine, engine.modes()[0], points);
        engine.name().clone_into(&mut series.name);
        series.width = 0.0;
        chart = chart.with(series);
    }
    Some(chart)
}

/// A scene in words; one of a run of growing scenes keeps its name.
fn title(scene: &str) -> &str {
    let published = carom_scenes::plain_scenes().iter();
    let mut known = published.chain(carom_scenes::lively_scenes());
    let found = known.find(|info| info.name == scene);
    found.map_or(scene, |info| info.title)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::speed::row::tests::some;

    #[test]
    fn a_scene_is_a_line_and_an_engine_a_dot() {
        let chart = ratios(some().iter().map(Dot::from).collect()).unwrap();
        assert_eq!(chart.y.names, ["5,050 boxes in a pyramid"]);
        let names: Vec<&str> = chart
            .series
            .iter()
            .map(|series| series.name.as_str())
            .collect();
        assert_eq!(
            names,
            ["box2d-sse2", "rapier", "carom"],
            "a failed engine has no ratio"
        );
        assert_eq!(chart.series[2].points, [vec2(3.0, 0.0)]);
        assert!(ratios(Vec::new()).is_none());
    }

    #[test]
    fn the_committed_chart_is_that_of_the_committed_rows() {
        let folder = picture::tests::results().join("speed");
        let text = std::fs::read_to_string(folder.join("speed.csv")).unwrap();
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let dots = reader.deserialize().collect::<Result<_, _>>().unwrap();
        picture::tests::committed(&folder, "ratios", &frame(dots).unwrap().unwrap());
    }
}
