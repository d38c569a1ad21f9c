//! `demo`: the main job on the thesis's own scene and on the flying balls.

mod chart;

use std::path::Path;
use std::sync::Arc;

use carom_render::{
    Animation, Existing, Frame, OutputFolder, Packing, Patch, Picture, Sequence, Sheet, Size,
};
use carom_scenes::Built;

use crate::clock::Clock;
use crate::exit::{End, Failure, Outcome};
use crate::film::{Easel, Footage, Plan, shoot};
use crate::flags::DemoArgs;
use crate::interrupt;
use crate::out::say;
use crate::parallel;
use crate::relay::Relay;
use crate::render::{caption, resized, tiles};
use crate::scene;
use crate::summary::Summary;

/// The scenes that are shown, a folder each.
pub(crate) const SCENES: [&str; 2] = ["thesis", "flying-balls"];

/// What lies in each folder beside the numbered frames.
pub(crate) const FILES: [&str; 5] = [FILM, SHEET, CHART_PNG, CHART_SVG, SUMMARY];

const FILM: &str = "film.png";
const SHEET: &str = "sheet.png";
const CHART_PNG: &str = "energy.png";
const CHART_SVG: &str = "energy.svg";
const SUMMARY: &str = "summary.json";

/// How many tiles of a contact sheet stand in a row.
const COLUMNS: u32 = 4;

/// Length and size of the demo.
#[derive(Clone, Copy, Debug)]
struct Format {
    seconds: u32,
    /// Part of the scene's own size.
    shrink: u32,
}

const FULL: Format = Format {
    seconds: 10,
    shrink: 1,
};

const QUICK: Format = Format {
    seconds: 1,
    shrink: 2,
};

pub(crate) fn run(args: &DemoArgs) -> Outcome {
    let format = if args.quick { QUICK } else { FULL };
    interrupt::watch("finishing the frame")?;
    let clock = Clock::start();
    for name in SCENES {
        if show(name, &args.out.join(name), format)? {
            return Ok(End::Interrupted);
        }
        say!("");
    }
    say!(
        "all of it in {:.1} s; open {} in a browser",
        clock.seconds(),
        args.out.join(SCENES[0]).join(FILM).display()
    );
    Ok(End::Done)
}

/// One scene into one folder; `true` if Ctrl-C ended it early.
fn show(name: &str, folder: &Path, format: Format) -> Result<bool, Failure> {
    let mut built = scene::open(name, &[], None)?.build()?;
    let size = built.camera.size();
    let size = Size::new(size.width() / format.shrink, size.height() / format.shrink)?;
    built.camera = resized(&built.camera, size)?;
    let rate = built.rate;
    let frames = u64::from(format.seconds) * u64::from(rate.get());
    let folder = OutputFolder::open(folder, Existing::Replace, &format!("demo {name}"))?;
    say!(
        "{name}: {} frames of {} px, {} s",
        frames,
        built.camera.size(),
        format.seconds
    );

    let plan = Plan {
        rate,
        frames,
        slice: 0..frames,
        threads: parallel::cores(),
    };
    let footage = draw(&mut built, name, &plan, &folder)?;
    let summary = footage.watch.finish(&built.world, name);
    folder.save(
        SUMMARY,
        (serde_json::to_string_pretty(&summary)? + "\n").as_bytes(),
    )?;
    chart::save(&folder, name, &footage.energy, [CHART_PNG, CHART_SVG])?;
    report(&summary, &footage, &folder);
    folder.close()?;
    Ok(footage.interrupted)
}

/// Frames, film and contact sheet.
fn draw(
    built: &mut Built,
    name: &str,
    plan: &Plan,
    folder: &OutputFolder,
) -> Result<Footage, Failure> {
    let size = built.camera.size();
    let style = built.look.style.clone();
    let mut film = Animation::create(folder.claim(FILM)?, size, plan.rate)?;
    let mut sheet = Sheet::new(COLUMNS, size.width() / 3).titled(name);
    let tiles = tiles(plan.frames);
    let relay = Relay::from(0);
    let draw = |easel: &mut Easel, index: u64, frame: Frame| {
        let turn = relay.turn(index);
        folder.save(&Sequence::name(index), easel.png(&frame, Packing::Fast))?;
        let (before, now) = turn.pass(easel.picture().clone());
        let patch = Patch::between(before.as_deref(), &now, Packing::Fast);
        Ok((patch, tiles.contains(&index).then_some(now)))
    };
    let take = |index: u64, (patch, tile): (Patch, Option<Arc<Picture>>)| {
        film.push_patch(patch)?;
        if let Some(tile) = tile {
            sheet.push(&tile, caption(index, plan))?;
        }
        Ok(())
    };
    let footage = shoot(built, plan, name, |_| true, draw, take)?;
    // Interrupted before the first frame: nothing to show.
    if footage.drawn > 0 {
        film.finish()?;
        folder.seal(FILM)?;
        folder.save(SHEET, &sheet.paint(&style)?.to_png())?;
    }
    Ok(footage)
}

fn report(summary: &Summary, footage: &Footage, folder: &OutputFolder) {
    summary.print();
    say!("physics      {}", footage.physics);
    say!("drawing      {}", footage.drawing);
    let place = |file: &str| folder.path().join(file).display().to_string();
    say!("frames       {} in {}", footage.drawn, place("frame_*.png"));
    say!("film         {}", place(FILM));
    say!("sheet        {}", place(SHEET));
    say!("energy       {} and {CHART_SVG}", place(CHART_PNG));
    if footage.interrupted {
        say!("INTERRUPTED  the film ends early");
    }
}
