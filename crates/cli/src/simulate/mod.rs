//! `simulate`: a scene without pictures, its trajectories as CSV.

mod table;

use std::path::Path;

use carom_dynamics::{Body, BodyKind, World};
use carom_math::SimTime;

use crate::clock::Clock;
use crate::exit::{End, Failure, Outcome, fail};
use crate::files::{self, Json};
use crate::flags::SimulateArgs;
use crate::interrupt;
use crate::out::{say, tell};
use crate::progress::Progress;
use crate::reach::{Reached, reach};
use crate::scene;
use crate::summary::{Summary, Watch};

use table::Table;

/// Most samples of a run.
const MAX_SAMPLES: f64 = 1e9;

/// Most rows, samples times bodies: a terabyte.
const MAX_ROWS: f64 = 1e10;

/// Seconds between samples where nothing else is asked for.
const EVERY: f64 = 1.0 / 60.0;

pub(crate) fn run(args: &SimulateArgs) -> Outcome {
    let seconds = args.seconds.0;
    let every = args.every.map_or(EVERY, |every| every.0);
    if every <= 0.0 {
        fail!("--every is {every} s, not above 0");
    }
    if seconds / every > MAX_SAMPLES {
        fail!("--seconds {seconds} every {every} s are more than {MAX_SAMPLES:e} samples");
    }
    let scene = scene::open(&args.scene, &args.set, args.mode)?;
    let mut built = scene.build()?;
    scene::check_step(&scene, &built.world, every.min(seconds))?;
    let steps = whole_steps(seconds, every);
    let samples = steps + 1;
    let moving = |body: &Body<'_>| body.kind() != BodyKind::Fixed;
    let bodies = built.world.bodies().filter(moving).count();
    #[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
    let rows = samples as f64 * bodies as f64;
    if rows > MAX_ROWS {
        fail!(
            "--seconds {seconds} every {every} s are {samples} samples of {bodies} bodies: {rows:e} rows, more than {MAX_ROWS:e}"
        );
    }
    let (out, json) = (args.out.as_deref(), args.json.as_deref());
    let out = out.filter(|place| !files::is_stdout(place));
    let scene_file = ("the scene", Path::new(&args.scene));
    let asked = [("--out", out), ("--json", json)];
    let asked = asked
        .iter()
        .filter_map(|(flag, place)| Some((*flag, (*place)?)));
    files::apart(&[scene_file].into_iter().chain(asked).collect::<Vec<_>>())?;
    let json = json.map(Json::create).transpose()?;
    interrupt::watch("finishing the sample")?;
    let mut table = Table::open(out, &built)?;
    let run = sample(&mut built.world, (seconds, every, steps), &mut table)?;
    table.finish()?;

    let summary = run.watch.finish(&built.world, scene.name());
    report(out, &summary, &run);
    json.map_or(Ok(()), |json| json.finish(&summary))?;
    Ok(if run.interrupted {
        End::Interrupted
    } else {
        End::Done
    })
}

struct Run {
    watch: Watch,
    physics: f64,
    interrupted: bool,
}

/// Samples at 0, `every`, 2 `every`, … and at the end, which is the last of `count` after the first.
fn sample(
    world: &mut World,
    (seconds, every, count): (f64, f64, u64),
    table: &mut Table,
) -> Result<Run, Failure> {
    let end = SimTime::from_secs(seconds);
    let mut progress = Progress::new("simulate", count, "samples");
    let mut run = Run {
        watch: Watch::start(world),
        physics: 0.0,
        interrupted: false,
    };
    let mut reader_left = !table.write(world)?;
    for k in 1..=count {
        run.interrupted = interrupt::asked();
        if run.interrupted || reader_left {
            break;
        }
        let target = if k == count {
            end
        } else {
            SimTime::multiple(k, every)
        };
        let clock = Clock::start();
        let watch = &mut run.watch;
        let reached = reach(world, target, |world, report| watch.saw(world, report));
        run.physics += clock.seconds();
        match reached {
            Reached::There => {}
            // No sample: it is no instant that was asked for.
            Reached::Interrupted => {
                run.interrupted = true;
                break;
            }
            Reached::Refused(why) => {
                progress.finish();
                fail!("the step to {} s was refused: {why}", target.as_secs());
            }
        }
        reader_left = !table.write(world)?;
        progress.advance();
    }
    progress.finish();
    Ok(run)
}

/// How many samples follow the first: the last one is at the end, even where `every` does not divide it.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 0 and 1e9"
)]
fn whole_steps(seconds: f64, every: f64) -> u64 {
    // 10 s over 1/60 s may come out a rounding above 600.
    (seconds / every * (1.0 - 1e-12)).ceil() as u64
}

/// To stdout where the table has its own file, else to stderr.
fn report(out: Option<&Path>, summary: &Summary, run: &Run) {
    let mut lines = summary.lines();
    lines.push(format!("physics      {:.3} s", run.physics));
    if run.interrupted {
        lines.push("INTERRUPTED  the run ended early".to_owned());
    }
    match out {
        Some(path) => {
            lines.iter().for_each(|line| say!("{line}"));
            say!("trajectories {}", path.display());
        }
        None => lines.iter().for_each(|line| tell!("{line}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_sample_is_at_the_end() {
        assert_eq!(whole_steps(10.0, 1.0 / 60.0), 600);
        assert_eq!(whole_steps(1.0, 0.3), 4);
        assert_eq!(whole_steps(0.0, 0.3), 0);
        assert_eq!(whole_steps(0.1, 0.3), 1);
    }
}
