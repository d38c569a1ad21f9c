//! `speed`: milliseconds a step, and what they bought.

mod chart;
mod counts;
mod crossing;
mod growth;
mod row;
mod stages;
mod table;

use std::path::{Path, PathBuf};

use carom_bench::{EngineName, Job, Limits, Reading};
use carom_render::write_file;
use carom_scenes::{PlainInfo, lively_scenes, plain_scenes};

use crate::builds::{self, Profile};
use crate::exit::{End, Failure, Outcome, fail};
use crate::files;
use crate::flags::SpeedArgs;
use crate::interrupt;
use crate::measure::{self, Run};
use crate::out::say;
use crate::plan::{self, Planned, Speed};
use crate::store::{Row, Store};

pub(crate) fn run(args: &SpeedArgs) -> Outcome {
    let what = What::of(args);
    let scenes = match what {
        What::Crossing => crossing::scenes(),
        _ if args.lively => lively_scenes().iter().map(name).collect(),
        _ => scenes(&args.scene)?,
    };
    if what == What::Instructions && !builds::answers("valgrind", &["--version"]) {
        fail!("--instructions needs valgrind, which cannot be started (apt install valgrind)");
    }
    let mut engines = measure::engines(&args.chosen);
    if what == What::Profile {
        engines.retain(|engine| stages::tells(*engine));
        if engines.is_empty() {
            fail!(
                "--profile: of these engines none tells the stages of a step; carom and Box2D do"
            );
        }
    }
    let folder = if args.lively { "lively" } else { what.name() };
    let folder = || PathBuf::from("out").join(folder);
    let out = args.out.clone().unwrap_or_else(folder);
    let run = Run {
        command: what.name(),
        profile: if args.quick {
            Profile::Dev
        } else {
            Profile::Bench
        },
        engines: &engines,
        threads: &args.threads,
        out: &out,
        how: &args.how,
    };
    let skip = match what {
        What::Growth => growth::outgrown,
        _ => failed_before,
    };
    let store = run.rows(|engines| plan(args, what, &scenes, engines), skip)?;
    write(args, what, &out, &store)?;
    Ok(if interrupt::asked() {
        End::Interrupted
    } else {
        End::Done
    })
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    Times,
    Growth,
    Crossing,
    Instructions,
    Profile,
}

impl What {
    const fn of(args: &SpeedArgs) -> Self {
        match args {
            SpeedArgs { growth: true, .. } => Self::Growth,
            SpeedArgs { crossing: true, .. } => Self::Crossing,
            SpeedArgs {
                instructions: true, ..
            } => Self::Instructions,
            SpeedArgs { profile: true, .. } => Self::Profile,
            _ => Self::Times,
        }
    }

    /// Of the files, and of the folder.
    const fn name(self) -> &'static str {
        match self {
            Self::Times => "speed",
            Self::Growth => "growth",
            Self::Crossing => "crossing",
            Self::Instructions => "instructions",
            Self::Profile => "profile",
        }
    }
}

fn plan(args: &SpeedArgs, what: What, scenes: &[String], engines: &[EngineName]) -> Vec<Planned> {
    let cpu_s = (args.how.limit / 3).max(1);
    let in_time = Limits {
        cpu_s: Some(cpu_s),
        ..Limits::default()
    };
    match what {
        What::Times => plan::speed(&Speed {
            scenes,
            engines,
            threads: &args.threads,
            repeat: args.repeat,
            cpu_s,
        }),
        What::Growth => plan::growth(engines, cpu_s),
        What::Crossing => plan::once(scenes, engines, in_time, Job::Speed),
        What::Instructions => {
            let few = Limits {
                warm_up_steps: Some(args.warm_up),
                measured_steps: Some(args.steps),
                ..in_time
            };
            plan::once(scenes, engines, few, Job::Bare)
        }
        What::Profile => plan::once(scenes, engines, in_time, Job::Profile),
    }
}

/// Rows, table, charts.
fn write(args: &SpeedArgs, what: What, out: &Path, store: &Store) -> Result<(), Failure> {
    let (head, json) = (&store.head, args.how.json.as_deref());
    let (csv, markdown, charts) = match what {
        What::Instructions => {
            let rows = counts::of(&store.rows);
            json.map_or(Ok(()), |path| files::write_json(path, &rows))?;
            (
                row::csv(head, &rows)?,
                counts::markdown(head, &rows),
                Vec::new(),
            )
        }
        What::Profile => {
            let rows = stages::of(&store.rows);
            json.map_or(Ok(()), |path| files::write_json(path, &rows))?;
            (
                row::csv(head, &rows)?,
                stages::markdown(head, &rows),
                Vec::new(),
            )
        }
        What::Crossing => {
            let rows = row::of(&store.rows);
            json.map_or(Ok(()), |path| files::write_json(path, &rows))?;
            (
                row::csv(head, &rows)?,
                crossing::markdown(head, &rows),
                Vec::new(),
            )
        }
        What::Times | What::Growth => {
            let mut rows = row::of(&store.rows);
            let charts = if what == What::Growth {
                growth::sort(&mut rows);
                growth::write(out, &rows)?
            } else {
                chart::write(out, &rows)?
            };
            let document = row::json(head.get("machine"), &rows);
            json.map_or(Ok(()), |path| files::write_json(path, &document))?;
            (row::csv(head, &rows)?, table::markdown(head, &rows), charts)
        }
    };
    let rows = out.join(what.name()).with_extension("csv");
    write_file(&rows, csv.as_bytes())?;
    let table = rows.with_extension("md");
    write_file(&table, markdown.as_bytes())?;
    say!("{}", markdown.trim_end());
    say!("");
    say!("{:<12} {}", "rows", rows.display());
    say!("{:<12} {}", "table", table.display());
    for path in charts {
        say!("{:<12} {}", "chart", path.display());
    }
    if let Some(path) = json {
        say!("{:<12} {}", "json", path.display());
    }
    Ok(())
}

/// Whether the same job failed in an earlier repetition: it would fail again, after as long a wait.
fn failed_before(rows: &[Row], planned: &Planned) -> bool {
    rows.iter()
        .any(|row| row.job == planned.job && matches!(row.reading, Reading::Failed { .. }))
}

fn name(info: &PlainInfo) -> String {
    info.name.to_owned()
}

/// The scenes asked for, or the nine and the two thinner ones.
fn scenes(asked: &[String]) -> Result<Vec<String>, Failure> {
    let published = plain_scenes().iter().map(name);
    let mut names: Vec<String> = published.filter(|name| !name.starts_with("case")).collect();
    if asked.is_empty() {
        return Ok(names);
    }
    names.extend(lively_scenes().iter().map(name));
    let mut found = Vec::new();
    for name in asked {
        // A letter alone is the first scene that begins with it: e is the peers' own, not a thinner one.
        let letter = |scene: &&String| name.len() == 1 && scene.starts_with(&format!("{name}_"));
        let own = names.iter().find(|scene| *scene == name);
        let mut lettered: Vec<&String> = names.iter().filter(letter).collect();
        lettered.sort_by_key(|scene| matches!(scene.as_str(), "e_medium" | "e_dilute"));
        let Some(scene) = own.or(lettered.first().copied()) else {
            fail!("{name}: unknown scene; there are {}", names.join(", "));
        };
        found.push(scene.clone());
    }
    Ok(found)
}

/// The scene and the rest of a job.
fn speed_job(job: &Job) -> Option<&carom_bench::SpeedJob> {
    match job {
        Job::Speed(job) => Some(job),
        Job::Bare(_) | Job::Profile(_) | Job::Accuracy(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_answers_to_its_letter() {
        let found = |name: &str| scenes(&[name.to_owned()]).map(|names| names[0].clone());
        assert_eq!(found("a").unwrap(), "a_large_pyramid");
        assert_eq!(found("e").unwrap(), "e_flying_polygons");
        assert_eq!(found("e_medium").unwrap(), "e_medium");
        assert_eq!(found("lively_wall").unwrap(), "lively_wall");
        assert_eq!(scenes(&[]).unwrap().len(), 11);
        for name in ["z", "", "e_", "pyramid"] {
            let error = found(name).unwrap_err().line();
            assert!(
                error.contains("unknown scene; there are a_large_pyramid"),
                "{error}"
            );
        }
    }
}
