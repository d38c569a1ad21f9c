//! A contact sheet of every built-in scene: nine frames from its start to its end.
//!
//! ```sh
//! cargo run -p carom-scenes --example sheets -- docs/pictures [SCENE]…
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use carom_math::SimTime;
use carom_render::{Frame, Picture, Sheet, Trace};
use carom_scenes::{find, list};

/// Tiles in a row and in a column, and the width of each in pixels.
const SIDE: u32 = 3;
const WIDTH: u32 = 300;

fn main() -> ExitCode {
    if let Err(error) = run() {
        eprintln!("error: {error}");
        return ExitCode::from(2);
    }
    ExitCode::SUCCESS
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: sheets FOLDER [SCENE]…")?);
    let mut names: Vec<String> = arguments.collect();
    if names.is_empty() {
        names = list().iter().map(|info| info.name.to_owned()).collect();
    }
    std::fs::create_dir_all(&folder)?;
    for name in names {
        sheet(&name)?.save_small_png(folder.join(format!("{name}.png")))?;
        println!("{name}");
    }
    Ok(())
}

/// The scene runs as a film does, frame by frame; nine of the frames are kept.
fn sheet(name: &str) -> Result<Picture, Box<dyn Error>> {
    let mut built = find(name)?.build()?;
    let tiles = u64::from(SIDE * SIDE);
    let last = frames(built.duration * f64::from(built.rate.get()));
    let mut kept = (0..tiles).map(|k| k * last / (tiles - 1)).peekable();
    let mut sheet = Sheet::new(SIDE, WIDTH).titled(name);
    let mut trace = Trace::new(&built.look.overlay);
    for index in 0..=last {
        let time = SimTime::multiple(index, built.rate.interval());
        built.world.step(time - built.world.time());
        trace.watch(&built.world);
        if kept.next_if_eq(&index).is_some() {
            let frame = Frame::capture_traced(&built.world, &built.look, &built.camera, &trace);
            let picture = frame.paint(&built.look.style);
            sheet.push(&picture, format!("{:.2} s", time.as_secs()))?;
        }
    }
    Ok(sheet.paint(&built.look.style)?)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a scene's duration is positive, and short"
)]
fn frames(count: f64) -> u64 {
    count.round() as u64
}
