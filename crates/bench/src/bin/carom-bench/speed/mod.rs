//! `speed`: milliseconds a step, and what they bought.

mod chart;
mod growth;
mod row;
mod table;

use std::path::{Path, PathBuf};

use carom_bench::{Job, Reading};
use carom_render::write_file;
use carom_scenes::plain_scenes;

use crate::builds::Profile;
use crate::exit::{End, Failure, Outcome, fail};
use crate::files;
use crate::flags::SpeedArgs;
use crate::interrupt;
use crate::measure::{self, Run};
use crate::out::say;
use crate::plan::{self, Planned, Speed};
use crate::store::Row;

pub(crate) fn run(args: &SpeedArgs) -> Outcome {
    let scenes = scenes(&args.scene)?;
    let engines = measure::engines(&args.who);
    let run = Run {
        command: if args.growth { "growth" } else { "speed" },
        profile: Profile::Bench,
        engines: &engines,
        threads: &args.threads,
        out: &args.out,
        how: &args.how,
    };
    let cpu_s = args.how.limit / 3;
    let plan = |engines: &[_]| {
        if args.growth {
            return plan::growth(engines, cpu_s);
        }
        plan::speed(&Speed {
            scenes: &scenes,
            engines,
            threads: &args.threads,
            repeat: args.repeat,
            cpu_s,
        })
    };
    let skip = if args.growth {
        growth::outgrown
    } else {
        failed_before
    };
    let store = run.rows(plan, skip)?;
    let mut rows = row::of(&store.rows);
    if args.growth {
        growth::sort(&mut rows);
    }
    let name = if args.growth { "growth" } else { "speed" };
    let csv = args.out.join(format!("{name}.csv"));
    write_file(&csv, row::csv(&store.head, &rows)?.as_bytes())?;
    let markdown = table::markdown(&store.head, &rows);
    let table = args.out.join(format!("{name}.md"));
    write_file(&table, markdown.as_bytes())?;
    say!("{}", markdown.trim_end());
    say!("");
    let told: [(&str, &Path); 2] = [("rows", &csv), ("table", &table)];
    for (what, path) in told {
        say!("{what:<12} {}", path.display());
    }
    let charts = if args.growth {
        growth::write(&args.out, &rows)?
    } else {
        chart::write(&args.out, &rows)?
    };
    for path in charts {
        say!("chart        {}", path.display());
    }
    if let Some(path) = &args.how.json {
        files::write_json(path, &row::json(store.head.get("machine"), &rows))?;
        say!("json         {}", PathBuf::from(path).display());
    }
    Ok(if interrupt::asked() {
        End::Interrupted
    } else {
        End::Done
    })
}

/// Whether the same job failed in an earlier repetition: it would fail again, after as long a wait.
fn failed_before(rows: &[Row], planned: &Planned) -> bool {
    rows.iter()
        .any(|row| row.job == planned.job && matches!(row.reading, Reading::Failed { .. }))
}

/// The scenes asked for, or the nine and the two thinner ones.
fn scenes(asked: &[String]) -> Result<Vec<String>, Failure> {
    let names: Vec<&str> = plain_scenes()
        .iter()
        .map(|info| info.name)
        .filter(|name| !name.starts_with("case"))
        .collect();
    if asked.is_empty() {
        return Ok(names.into_iter().map(str::to_owned).collect());
    }
    let mut found = Vec::new();
    for name in asked {
        // A letter alone is the first scene that begins with it: e is the peers' own, not a thinner one.
        let letter = |scene: &&&str| name.len() == 1 && scene.starts_with(&format!("{name}_"));
        let own = names.iter().find(|scene| **scene == name);
        let mut lettered: Vec<&&str> = names.iter().filter(letter).collect();
        lettered.sort_by_key(|scene| matches!(**scene, "e_medium" | "e_dilute"));
        let Some(scene) = own.or(lettered.first().copied()) else {
            fail!("{name}: unknown scene; there are {}", names.join(", "));
        };
        found.push((*scene).to_owned());
    }
    Ok(found)
}

/// The scene and the rest of a job.
fn speed_job(job: &Job) -> Option<&carom_bench::SpeedJob> {
    match job {
        Job::Speed(job) => Some(job),
        Job::Bare(_) | Job::Accuracy(_) => None,
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
