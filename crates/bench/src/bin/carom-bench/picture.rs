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

/// Place in the style's palette, and marker.
const fn look(engine: EngineName) -> (usize, Marker) {
    match engine {
        EngineName::Carom => (1, Marker::Circle),
        EngineName::Box2dSse2 => (0, Marker::Square),
        EngineName::Box2dAvx2 => (5, Marker::Square),
        EngineName::Rapier => (2, Marker::Triangle),
        EngineName::Rapier8 => (4, Marker::Triangle),
        EngineName::RapierF64 => (3, Marker::Triangle),
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
    for (suffix, style) in [("", Style::light()), ("-dark", Style::dark())] {
        let png = folder.join(format!("{name}{suffix}.png"));
        frame.paint(&style).save_png(&png)?;
        let svg = folder.join(format!("{name}{suffix}.svg"));
        write_file(&svg, frame.to_svg(&style).as_bytes())?;
        written.extend([png, svg]);
    }
    Ok(written)
}
