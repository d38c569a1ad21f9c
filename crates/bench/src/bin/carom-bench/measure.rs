//! From planned jobs to rows: builds, runs them in turn, keeps what is there.

use carom_bench::{CallgrindError, EngineName, Instructions, Job, Reading, count_instructions};

use crate::builds::{Executables, Probe, Profile};
use crate::exit::Failure;
use crate::files;
use crate::flags::{Chosen, How};
use crate::head::Head;
use crate::interrupt;
use crate::plan::Planned;
use crate::process;
use crate::progress::Progress;
use crate::store::{Row, Store};

use std::path::Path;

/// What a command wants measured.
#[derive(Debug)]
pub(crate) struct Run<'a> {
    pub(crate) command: &'static str,
    pub(crate) profile: Profile,
    pub(crate) engines: &'a [EngineName],
    pub(crate) threads: &'a [u32],
    pub(crate) out: &'a Path,
    pub(crate) how: &'a How,
}

/// The engines that the flags name: carom, or all, or those asked for.
pub(crate) fn engines(chosen: &Chosen) -> Vec<EngineName> {
    let runs = |engine: &EngineName| match (chosen.engine.is_empty(), chosen.peers) {
        (true, true) => true,
        (true, false) => *engine == EngineName::Carom,
        // carom beside the named ones only if it is named.
        (false, _) => chosen.engine.contains(engine),
    };
    EngineName::ALL.into_iter().filter(runs).collect()
}

impl Run<'_> {
    /// Builds, measures what `plan` makes of the engines that are there, and gives all rows.
    ///
    /// `skip` looks at the rows so far and may spare a job.
    pub(crate) fn rows(
        &self,
        plan: impl FnOnce(&[EngineName]) -> Vec<Planned>,
        skip: impl Fn(&[Row], &Planned) -> bool,
    ) -> Result<Store, Failure> {
        files::make_folder(self.out)?;
        self.how.json.as_deref().map(files::prepare).transpose()?;
        let executables =
            Executables::build(self.engines, self.threads, self.profile, Probe::machine())?;
        for (engine, why) in &executables.left_out {
            eprintln!("left out {engine}: {why}");
        }
        let there = |engine: &EngineName| {
            let threads = self.threads.iter();
            threads
                .clone()
                .any(|n| executables.path(*engine, *n).is_some())
        };
        let engines: Vec<EngineName> = self.engines.iter().copied().filter(there).collect();
        let head = Head::of(self.profile, &executables);
        let mut store = Store::open(self.out, self.command, head, self.how.resume)?;

        let jobs = plan(&engines);
        let mut missing = jobs;
        missing.retain(|planned| !store.has(&planned.job, planned.repetition));
        interrupt::watch("letting the job go, writing what is there")?;
        let mut progress = Progress::new(self.command, missing.len() as u64, "jobs");
        for planned in missing {
            if interrupt::asked() {
                break;
            }
            let (engine, threads) = (planned.job.engine(), planned.job.threads());
            if let Some(path) = executables.path(engine, threads)
                && !skip(&store.rows, &planned)
            {
                let limit = f64::from(self.how.limit);
                let reading = match &planned.job {
                    Job::Bare(job) => Some(counted(count_instructions(path, job))),
                    job => process::run(path, job, limit, interrupt::asked),
                };
                // Ctrl-C reaches valgrind too: what it says then is no reading.
                let Some(reading) = reading.filter(|_| !interrupt::asked()) else {
                    break;
                };
                store.add(Row {
                    job: planned.job,
                    repetition: planned.repetition,
                    reading,
                })?;
            }
            progress.advance();
        }
        progress.finish();
        if !interrupt::asked() {
            store.finish()?;
        }
        settle(&mut store);
        Ok(store)
    }
}

fn counted(answer: Result<Instructions, CallgrindError>) -> Reading {
    answer.map_or_else(
        |error| Reading::Failed {
            reason: error.to_string(),
        },
        Reading::Instructions,
    )
}

/// Adds to the head how every engine and mode was set, as itself says.
fn settle(store: &mut Store) {
    let mut lines: Vec<(String, String)> = Vec::new();
    for row in &store.rows {
        let Some(settings) = settings(&row.reading) else {
            continue;
        };
        let key = format!("settings {} {}", row.job.engine(), row.job.mode());
        if !lines.iter().any(|(found, _)| *found == key) {
            lines.push((key, settings.to_owned()));
        }
    }
    lines.sort();
    for (key, text) in lines {
        store.head.push(&key, text);
    }
}

fn settings(reading: &Reading) -> Option<&str> {
    match reading {
        Reading::Speed(reading) => Some(&reading.settings),
        Reading::Accuracy { settings, .. } => Some(settings),
        Reading::Bare { .. }
        | Reading::Instructions(_)
        | Reading::Profile(_)
        | Reading::Failed { .. } => None,
    }
    .map(String::as_str)
    .filter(|text| !text.is_empty())
}
