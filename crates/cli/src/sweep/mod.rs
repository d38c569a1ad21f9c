//! `sweep`: all combinations of settings of a scene, a row a run.

mod axis;
mod column;
pub(crate) mod join;
mod table;

use std::path::Path;

use carom_dynamics::StepReport;
use carom_math::SimTime;
use carom_scenes::{Built, Scene};

use crate::exit::{End, Failure, Outcome, fail};
use crate::field::field;
use crate::files;
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
use table::{Earlier, Rows, Table};

pub(crate) fn run(args: &SweepArgs) -> Outcome {
    let scene = scene::open(&args.scene, &[], args.mode)?;
    let plan = Plan::new(args, &scene)?;
    let out = args.out.as_deref();
    let out = out.filter(|place| !files::is_stdout(place));
    if args.out.is_some() && out.is_none() && (args.resume || args.force) {
        fail!("--out - keeps nothing: neither --resume nor --force can be given");
    }
    if let Some(out) = out {
        files::apart(&[("the scene", Path::new(&args.scene)), ("--out", out)])?;
    }
    let earlier = match (args.resume, args.force) {
        (true, _) => Earlier::Resume,
        (_, true) => Earlier::Replace,
        _ => Earlier::Refuse,
    };
    // Before anything is written.
    let jobs = args.jobs.map_or_else(cores, usize::from);
    plan.check(jobs)?;
    let expected = Rows {
        heading: &plan.heading(),
        begins: &|row| plan.begins(row),
    };
    let (mut table, (known, last)) = Table::open(out, &expected, earlier)?;
    interrupt::watch("finishing the runs in hand")?;
    let left = plan.mine.start + known..plan.mine.end;
    if let Some(last) = last {
        // Scene, seconds and mode are in no row, but in what comes of them.
        let Some(row) = plan.play(left.start - 1)? else {
            return Ok(End::Interrupted);
        };
        table.check(&last, &row)?;
    }
    let mut progress = Progress::new("sweep", left.end - left.start, "runs");
    let (mut next, mut written, mut ended) = (left.start, known, false);
    let produced = || {
        let more = next < left.end && !interrupt::asked();
        let job = more.then_some(next);
        next += u64::from(more);
        Ok(job)
    };
    let all = in_order(
        jobs,
        produced,
        |k| plan.play(k),
        |row| {
            // What Ctrl-C cut short has no row, nor has what comes after it.
            let Some(row) = row.filter(|_| !ended) else {
                ended = true;
                return Ok(());
            };
            ended = !table.write(&row)?;
            written += 1;
            progress.advance();
            Ok(())
        },
    );
    progress.finish();
    // Of a failure the table keeps the rows before it.
    all?;
    let whole = written == plan.mine.end - plan.mine.start;
    table.finish(whole)?;
    if let Some(place) = out {
        say!(
            "{written} of {} runs in {}{}",
            plan.mine.end - plan.mine.start,
            place.display(),
            if whole { "" } else { ".part" }
        );
    }
    // With the last run in hand it came too late.
    if interrupt::asked() && !whole {
        let hint = out.map_or("", |_| "; --resume goes on");
        tell!("INTERRUPTED  {written} runs are done{hint}");
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
        for (k, Axis { key, .. }) in args.set.iter().enumerate() {
            if args.set[..k].iter().any(|other| other.key == *key) {
                fail!("--set {key} is given twice: its values go into one list, with commas");
            }
            if key == "seed" && args.seeds.is_some() {
                fail!("--set seed and --seeds both say what the seed is");
            }
        }
        for (k, column) in args.report.iter().enumerate() {
            if args.report[..k].contains(column) {
                fail!("--report {} is given twice", column.name());
            }
        }
        let seeds = args.seeds.unwrap_or(1);
        let runs = axis::runs(&args.set, seeds).map_err(Failure::new)?;
        let mine = args.shard.unwrap_or(Shard::WHOLE).range(runs);
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
        names.map(field).collect::<Vec<_>>().join(",")
    }

    /// What is set in run `k`: the values of `--set`, and the seed.
    fn settings(&self, k: u64) -> (Vec<&str>, Option<String>) {
        let (values, seed) = axis::values(&self.args.set, self.seeds, k);
        (values, self.args.seeds.map(|_| seed.to_string()))
    }

    /// The cells of run `k` that are known before it: its number, `runs`, what is set, and the seed.
    fn cells(&self, k: u64) -> Vec<String> {
        let (values, seed) = self.settings(k);
        let mut cells = vec![k.to_string(), self.runs.to_string()];
        cells.extend(values.into_iter().map(field));
        cells.extend(seed);
        cells
    }

    /// What the row of this shard's `row`-th run begins with; `None` if there is none.
    fn begins(&self, row: u64) -> Option<String> {
        let run = self.mine.start.checked_add(row)?;
        let cells = self.mine.contains(&run).then(|| self.cells(run))?;
        Some(cells.join(",") + ",")
    }

    /// Run `k` at its start.
    fn build(&self, k: u64) -> Result<Built, Failure> {
        let (values, seed) = self.settings(k);
        let keys = self.args.set.iter().map(|axis| axis.key.as_str());
        let mut settings: Vec<(&str, &str)> = keys.zip(values).collect();
        settings.extend(seed.iter().map(|seed| ("seed", seed.as_str())));
        let mut scene = self.scene.clone();
        scene.set_all(&settings)?;
        let built = scene.build()?;
        scene::check_step(&scene, &built.world, self.seconds)?;
        Ok(built)
    }

    /// Says what is wrong with a value of any key, or with the name of a column.
    ///
    /// Each value is built in one run; some pairs of values may still not go together.
    fn check(&self, jobs: usize) -> Result<(), Failure> {
        let mut samples = axis::samples(&self.args.set, self.seeds, &self.mine).into_iter();
        let check = |k| {
            let built = self.build(k)?;
            for column in &self.args.report {
                column.read(&built, &StepReport::default())?;
            }
            Ok(())
        };
        in_order(jobs, || Ok(samples.next()), check, Ok)
    }

    /// The row of run `k`; `None` if it was interrupted.
    fn play(&self, k: u64) -> Result<Option<String>, Failure> {
        let mut built = self.build(k)?;
        let mut report = StepReport::default();
        let end = SimTime::from_secs(self.seconds);
        match reach(&mut built.world, end, |_, part| report += part) {
            Reached::There => {}
            Reached::Interrupted => return Ok(None),
            Reached::Refused(why) => fail!("run {k} was refused: {why}"),
        }
        let mut row = self.cells(k);
        for column in &self.args.report {
            row.push(column.read(&built, &report)?);
        }
        Ok(Some(row.join(",")))
    }
}
