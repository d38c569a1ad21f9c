//! `render`: a scene to numbered frames, an APNG or a Y4M film.

mod sink;

use std::path::PathBuf;

use carom_render::{Camera, Existing, FrameRate, OutputFolder, Size};
use carom_scenes::Built;

use crate::exit::{End, Failure, Outcome, fail};
use crate::film::{Footage, Plan};
use crate::flags::{Format, RenderArgs};
use crate::interrupt;
use crate::out::say;
use crate::parallel;
use crate::scene;
use crate::values::Shard;

/// Most frames of a film: more than four hours at 60 frames per second.
const MAX_FRAMES: f64 = 1e6;

pub(crate) fn run(args: &RenderArgs) -> Outcome {
    let scene = scene::open(&args.scene, &args.set, args.mode)?;
    let mut built = scene.build()?;
    if let Some((width, height)) = args.size {
        built.camera = resized(&built.camera, Size::new(width, height)?)?;
    }
    let plan = plan(args, &built)?;
    let size = built.camera.size();
    let folder = match &args.out {
        Some(folder) => folder.clone(),
        None => PathBuf::from("out").join(scene::file_stem(scene.name())),
    };
    let existing = match (args.resume, args.force) {
        (true, _) => Existing::Resume,
        (_, true) => Existing::Replace,
        _ => Existing::Refuse,
    };
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    // Whatever decides the bytes of a frame; the slice and the threads do not.
    let about = format!(
        "{} scene {:016x} frames {} rate {} size {size} format {:?} slice {}/{}",
        scene.name(),
        scene::fingerprint(&scene),
        plan.frames,
        plan.rate.get(),
        args.format,
        shard.index + 1,
        shard.count
    );
    let folder = OutputFolder::open(folder, existing, &about)?;
    say!(
        "{} frames of {size} px at {} per second into {}",
        plan.slice.end - plan.slice.start,
        plan.rate.get(),
        folder.path().display()
    );
    interrupt::watch("finishing the frame")?;
    let stem = scene::file_stem(scene.name());
    let (footage, files) = match args.format {
        Format::Png => sink::frames(&mut built, &plan, &folder)?,
        Format::Apng => sink::apng(&mut built, &plan, &folder, &format!("{stem}.png"))?,
        Format::Y4m => sink::y4m(&mut built, &plan, &folder, &format!("{stem}.y4m"))?,
    };
    report(&built, scene.name(), &footage, &files);
    Ok(if footage.interrupted {
        End::Interrupted
    } else {
        End::Done
    })
}

/// All that can be wrong with the flags, before anything is written.
fn plan(args: &RenderArgs, built: &Built) -> Result<Plan, Failure> {
    let seconds = args.seconds.map_or(built.duration, |seconds| seconds.0);
    let rate = args.fps.map_or(Ok(built.rate), FrameRate::per_second)?;
    let count = (seconds * f64::from(rate.get())).round();
    if count > MAX_FRAMES {
        fail!(
            "{seconds} s at {} frames per second are {count:e} frames, more than {MAX_FRAMES:e}",
            rate.get()
        );
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 1e6"
    )]
    let frames = (count as u64).max(1);
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    if shard.count > frames {
        fail!(
            "{} slices of {frames} frames: some would be empty",
            shard.count
        );
    }
    Ok(Plan {
        rate,
        frames,
        slice: shard.frames(frames),
        threads: args.threads.map_or_else(parallel::cores, usize::from),
    })
}

/// The same view on another canvas: all that was seen is seen.
pub(crate) fn resized(camera: &Camera, size: Size) -> Result<Camera, Failure> {
    let ratio = size.corner() / camera.size().corner();
    let scale = camera.scale() * ratio.min_element();
    Ok(Camera::new(
        camera.centre(),
        scale,
        size.width(),
        size.height(),
    )?)
}

fn report(built: &Built, name: &str, footage: &Footage, files: &str) {
    footage.watch.finish(&built.world, name).print();
    say!("physics      {}", footage.physics);
    say!("drawing      {}", footage.drawing);
    say!("frames       {} drawn, {files}", footage.drawn);
    if footage.interrupted {
        say!("INTERRUPTED  go on with --resume");
    }
}
