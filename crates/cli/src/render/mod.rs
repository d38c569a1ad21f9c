//! `render`: a scene to numbered frames, an APNG or a Y4M film.

mod budget;
mod job;
mod look;
mod sink;

use std::path::PathBuf;

use carom_render::{Camera, Existing, FrameRate, OutputFolder, Packing, Size};
use carom_scenes::Built;

use crate::exit::{End, Failure, Outcome, fail};
use crate::files;
use crate::film::{Footage, Plan};
use crate::flags::{Format, PackingFlag, RenderArgs};
use crate::out::{self, say};
use crate::parallel;
use crate::scene;
use crate::values::Shard;
use crate::{interrupt, summary};

pub(crate) use budget::frames;
pub(crate) use job::Job;
pub use sink::{caption, tiles};

pub(crate) fn run(args: &RenderArgs) -> Outcome {
    let to_stdout = args.out.as_deref().is_some_and(files::is_stdout);
    check_flags(args, to_stdout)?;
    let scene = scene::open(&args.scene, &args.set, args.mode)?;
    let mut built = scene.build()?;
    if let Some((width, height)) = args.size {
        built.camera = resized(&built.camera, Size::new(width, height)?)?;
    }
    look::dress(&mut built, &args.overlay, args.style);
    let plan = plan(args, &built)?;
    scene::check_step(&scene, &built.world, plan.rate.interval())?;
    if args.format == Format::Sheet {
        sink::check_sheet(&built, &plan)?;
    }
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    if to_stdout {
        return stream(&mut built, &plan, scene.name());
    }
    let stem = scene::file_stem(scene.name());
    let folder = args.out.clone().unwrap_or_else(|| {
        PathBuf::from("out").join(match args.shard {
            Some(Shard { index, count }) => format!("{stem}-{}-of-{count}", index + 1),
            None => stem.clone(),
        })
    });
    let existing = match (args.resume, args.force) {
        (true, _) => Existing::Resume,
        (_, true) => Existing::Replace,
        _ => Existing::Refuse,
    };
    let job = Job {
        what: format!(
            "{} scene {:016x} carom {} rate {} size {} format {:?} packing {:?} {}",
            scene.name(),
            scene::fingerprint(&scene),
            env!("CARGO_PKG_VERSION"),
            plan.rate.get(),
            built.camera.size(),
            args.format,
            args.packing,
            look::line(&args.overlay, args.style),
        ),
        frames: plan.frames,
        shard,
    };
    let folder = OutputFolder::open(folder, existing, &job.to_string())?;
    announce(&plan, &built, &folder.path().display().to_string());
    interrupt::watch("finishing the frame")?;
    let packing = match args.packing {
        PackingFlag::Fast => Packing::Fast,
        PackingFlag::Small => Packing::Small,
    };
    let (footage, files) = match args.format {
        Format::Png => sink::frames(&mut built, &plan, &folder, packing)?,
        Format::Svg => sink::drawings(&mut built, &plan, &folder)?,
        Format::Apng => sink::apng(&mut built, &plan, &folder, &format!("{stem}.png"), packing)?,
        Format::Y4m => sink::y4m(&mut built, &plan, &folder, &format!("{stem}.y4m"))?,
        Format::Sheet => sink::sheet(&mut built, &plan, &folder, &stem, packing)?,
    };
    folder.close()?;
    report(&built, scene.name(), &footage, &files);
    Ok(end(&footage))
}

/// The film to stdout, everything else to stderr.
fn stream(built: &mut Built, plan: &Plan, name: &str) -> Outcome {
    out::step_aside();
    announce(plan, built, "stdout");
    interrupt::watch("finishing the frame")?;
    let Some(footage) = sink::y4m_to_stdout(built, plan)? else {
        say!("the reader went away");
        return Ok(End::Done);
    };
    report(built, name, &footage, "to stdout");
    Ok(end(&footage))
}

/// How much there will be, before anything is drawn.
fn announce(plan: &Plan, built: &Built, place: &str) {
    let count = plan.slice.end - plan.slice.start;
    let size = built.camera.size();
    #[expect(clippy::cast_precision_loss, reason = "for reading")]
    let megabytes = count as f64 * 3e-6 * size.pixels() as f64;
    let frames = if count == 1 { "frame" } else { "frames" };
    say!(
        "{count} {frames} of {size} px ({} MB unpacked) at {} per second into {place}",
        summary::short(megabytes),
        plan.rate.get()
    );
}

const fn end(footage: &Footage) -> End {
    if footage.interrupted {
        End::Interrupted
    } else {
        End::Done
    }
}

/// Flags that do not go together.
fn check_flags(args: &RenderArgs, to_stdout: bool) -> Result<(), Failure> {
    let numbered = matches!(args.format, Format::Png | Format::Svg);
    if args.shard.is_some() && !numbered {
        fail!("--shard draws numbered frames: --format png or svg");
    }
    if to_stdout && args.format != Format::Y4m {
        fail!("--out - is for a film: --format y4m");
    }
    if to_stdout && (args.resume || args.force) {
        fail!("--out - keeps nothing: neither --resume nor --force can be given");
    }
    Ok(())
}

/// All that can be wrong with the flags, before anything is written.
fn plan(args: &RenderArgs, built: &Built) -> Result<Plan, Failure> {
    let seconds = args.seconds.map_or(built.duration, |seconds| seconds.0);
    let rate = args.fps.map_or(Ok(built.rate), FrameRate::per_second)?;
    let size = built.camera.size();
    let frames = frames(seconds, rate, size)?;
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    if shard.count > frames {
        fail!(
            "{} slices of {frames} frames: some would be empty",
            shard.count
        );
    }
    let asked = args.threads.map_or_else(parallel::cores, usize::from);
    Ok(Plan {
        rate,
        frames,
        slice: shard.range(frames),
        threads: budget::threads(asked, frames, size),
    })
}

/// The same view on another canvas: all that was seen is seen.
pub fn resized(camera: &Camera, size: Size) -> Result<Camera, Failure> {
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
