//! `sweep`: all combinations of settings of a scene, a row a run.

mod axis;
mod column;
pub(crate) mod join;
mod table;

use carom_dynamics::StepReport;
use carom_math::SimTime;
use carom_scenes::Scene;

use crate::exit::{End, Failure, Outcome, fail};
use crate::flags::SweepArgs;
use crate::interrupt;
use crate::out::{say, tell};
use crate::parallel::{cores, in_order};
use crate::progress::Progress;
use crate::reach::{Reached, reach};
use crate::scene;
use crate::values::Shard;

pub use axis::Axis;
pub use column::Column;
use table::{Earlier, Table};

pub(crate) fn run(args: &SweepArgs) -> Outcome {
    let scene = scene::open(&args.scene, &[], args.mode)?;
    let plan = Plan::new(args, &scene)?;
    let earlier = match (args.resume, args.force) {
        (true, _) => Earlier::Resume,
        (_, true) => Earlier::Replace,
        _ => Earlier::Refuse,
    };
    // Whatever is wrong with all runs alike is said before anything is written.
    plan.play(plan.mine.start)?;
    let (mut table, known) = Table::open(args.out.as_deref(), &plan.heading(), earlier)?;
    interrupt::watch("finishing the runs in hand")?;
    let left = plan.mine.start + known..plan.mine.end;
    if left.start > left.end {
        fail!("there are more rows than runs: --force begins anew");
    }
    let mut progress = Progress::new("sweep", left.end - left.start, "runs");
    let (mut next, mut written, mut reader_left) = (left.start, known, false);
    let produced = || {
        let more = next < left.end && !interrupt::asked();
        let job = more.then_some(next);
        next += u64::from(more);
        Ok(job)
    };
    let jobs = args.jobs.map_or_else(cores, usize::from);
    let all = in_order(
        jobs,
        produced,
        |k| plan.play(k),
        |row| {
            // What Ctrl-C cut short has no row, nor has what comes after it.
            let Some(row) = row.filter(|_| !reader_left) else {
                reader_left = true;
                return Ok(());
            };
            reader_left = !table.write(&row)?;
            written += 1;
            progress.advance();
            Ok(())
        },
    );
    progress.finish();
    let whole = all.is_ok() && written == plan.mine.end - plan.mine.start;
    table.finish(whole)?;
    all?;
    if let Some(place) = &args.out {
        say!(
            "{written} of {} runs in {}{}",
            plan.mine.end - plan.mine.start,
            place.display(),
            if whole { "" } else { ".part" }
        );
    }
    if interrupt::asked() {
        tell!("INTERRUPTED  {written} runs are done; --resume goes on");
        return Ok(End::Interrupted);
    }
    Ok(End::Done)
}

/// All that the runs have in common.
struct Plan<'a> {
    args: &'a SweepArgs,
    scene: &'a Scene,
    seeds: u64,
    runs: u64,
    /// Runs of this shard.
    mine: std::ops::Range<u64>,
    seconds: f64,
}

impl<'a> Plan<'a> {
    fn new(args: &'a SweepArgs, scene: &'a Scene) -> Result<Self, Failure> {
        let seeds = args.seeds.unwrap_or(1);
        let runs = axis::runs(&args.set, seeds).map_err(Failure::new)?;
        let mine = args.shard.unwrap_or(Shard::WHOLE);
        let mine = mine.index * runs / mine.count..(mine.index + 1) * runs / mine.count;
        if mine.is_empty() {
            fail!(
                "slice {} of {runs} runs has none",
                args.shard.unwrap_or(Shard::WHOLE)
            );
        }
        let seconds = match args.seconds {
            Some(seconds) => seconds.0,
            None => scene.build()?.duration,
        };
        Ok(Self {
            args,
            scene,
            seeds,
            runs,
            mine,
            seconds,
        })
    }

    /// `run` and `runs`, what is set, the seed, what is reported.
    fn heading(&self) -> String {
        let keys = self.args.set.iter().map(|axis| axis.key.as_str());
        let seed = self.args.seeds.map(|_| "seed");
        let columns = self.args.report.iter().map(Column::name);
        let names = ["run", "runs"]
            .into_iter()
            .chain(keys)
            .chain(seed)
            .chain(columns);
        names.map(quoted).collect::<Vec<_>>().join(",")
    }

    /// The row of run `k`; `None` if it was interrupted.
    fn play(&self, k: u64) -> Result<Option<String>, Failure> {
        let (values, seed) = axis::values(&self.args.set, self.seeds, k);
        let keys = self.args.set.iter().map(|axis| axis.key.as_str());
        let mut settings: Vec<(&str, &str)> = keys.zip(values.iter().copied()).collect();
        let seed = self.args.seeds.map(|_| seed.to_string());
        settings.extend(seed.iter().map(|seed| ("seed", seed.as_str())));
        let mut scene = self.scene.clone();
        scene.set_all(&settings)?;
        let mut built = scene.build()?;
        scene::check_step(&scene, &built.world, self.seconds)?;
        let mut report = StepReport::default();
        let end = SimTime::from_secs(self.seconds);
        match reach(&mut built.world, end, |_, part| report += part) {
            Reached::There => {}
            Reached::Interrupted => return Ok(None),
            Reached::Refused(why) => fail!("run {k} was refused: {why}"),
        }
        let mut row = vec![k.to_string(), self.runs.to_string()];
        row.extend(values.into_iter().map(quoted));
        row.extend(seed);
        for column in &self.args.report {
            row.push(column.read(&built, &report)?);
        }
        Ok(Some(row.join(",")))
    }
}

/// A cell, in quotes where it has a comma, a quote or the end of a line (RFC 4180).
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}
