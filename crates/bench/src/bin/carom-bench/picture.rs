//! How engines look in every chart, and how charts become files.

use std::path::{Path, PathBuf};

use carom_bench::{EngineName, Mode};
use carom_math::Vec2;
use carom_render::{Frame, Ink, Marker, Series, Style, write_file};

use crate::exit::Failure;

/// A line of an engine in a mode: the colour is the engine, the dashes are the mode.
pub(crate) fn series(engine: EngineName, mode: Mode, points: Vec<Vec2>) -> Series {
    let series = Series::line(format!("{engine} {mode}"), points);
    let series = Series {
        width: if engine == EngineName::Carom {
            3.0
        } else {
            1.6
        },
        dash: match mode {
            Mode::Hybrid | Mode::Stock => None,
            Mode::Tuned | Mode::Stepped => Some(7.0),
            Mode::Exact
            | Mode::Fast
            | Mode::SteppedFast
            | Mode::Accurate
            | Mode::SteppedAccurate => Some(2.5),
        },
        ..series
    };
    let (turn, marker) = look(engine);
    series.marked(marker).inked(Ink::Series(turn))
}

/// Place in the style's palette, and marker: an engine is one colour in every chart, its builds are told by markers.
const fn look(engine: EngineName) -> (usize, Marker) {
    match engine {
        EngineName::Carom => (1, Marker::Circle),
        EngineName::Box2dSse2 => (0, Marker::Square),
        EngineName::Box2dAvx2 => (0, Marker::Diamond),
        EngineName::Rapier => (2, Marker::Triangle),
        EngineName::Rapier8 => (2, Marker::Diamond),
        EngineName::RapierF64 => (2, Marker::Square),
        EngineName::Chipmunk => (7, Marker::Diamond),
    }
}

/// carom last, so that it lies on top.
pub(crate) fn on_top(engine: EngineName) -> bool {
    engine == EngineName::Carom
}

/// Writes `NAME.png`, `NAME.svg`, `NAME-dark.png` and `NAME-dark.svg`.
pub(crate) fn write(folder: &Path, name: &str, frame: &Frame) -> Result<Vec<PathBuf>, Failure> {
    let mut written = Vec::new();
    for (name, bytes) in files(name, frame) {
        let path = folder.join(name);
        write_file(&path, &bytes)?;
        written.push(path);
    }
    Ok(written)
}

/// A chart's files, by name.
fn files(name: &str, frame: &Frame) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for (suffix, style) in [("", Style::light()), ("-dark", Style::dark())] {
        let png = frame.paint(&style).to_png();
        files.push((format!("{name}{suffix}.png"), png));
        let svg = frame.to_svg(&style).into_bytes();
        files.push((format!("{name}{suffix}.svg"), svg));
    }
    files
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The folder of committed measurements.
    pub(crate) fn results() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("results")
    }

    /// A committed file is what the committed rows give. `UPDATE=1` writes it.
    #[track_caller]
    pub(crate) fn same(path: &Path, bytes: &[u8]) {
        if std::env::var_os("UPDATE").is_some() {
            write_file(path, bytes).unwrap();
        }
        assert!(
            std::fs::read(path).unwrap() == bytes,
            "{} is not what its rows give: UPDATE=1 cargo test -p carom-bench committed",
            path.display()
        );
    }

    /// The same of a chart's four files.
    #[track_caller]
    pub(crate) fn committed(folder: &Path, name: &str, frame: &Frame) {
        for (name, bytes) in files(name, frame) {
            same(&folder.join(name), &bytes);
        }
    }
}
