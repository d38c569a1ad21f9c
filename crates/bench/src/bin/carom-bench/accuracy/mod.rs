//! `accuracy`: run time against error.

mod chart;
mod row;
mod table;

use std::path::{Path, PathBuf};

use carom_bench::{CASES, Case, EngineName};
use carom_render::write_file;
use serde::Serialize;

use crate::builds::Profile;
use crate::exit::{End, Failure, Outcome, fail};
use crate::files;
use crate::flags::AccuracyArgs;
use crate::head::Head;
use crate::interrupt;
use crate::measure::{self, Run};
use crate::out::say;
use crate::plan;

use row::AccuracyRow;

pub(crate) fn run(args: &AccuracyArgs) -> Outcome {
    let (head, rows) = match &args.from {
        Some(csv) => row::read(csv)?,
        None => measured(args)?,
    };
    if args.from.is_some() {
        files::make_folder(&args.out)?;
        args.how.json.as_deref().map(files::prepare).transpose()?;
    }
    write(args, &head, &rows)?;
    Ok(if interrupt::asked() {
        End::Interrupted
    } else {
        End::Done
    })
}

fn measured(args: &AccuracyArgs) -> Result<(Head, Vec<AccuracyRow>), Failure> {
    let cases = cases(&args.case)?;
    let engines = one_of_each(measure::engines(&args.chosen), &args.chosen.engine);
    let run = Run {
        command: "accuracy",
        profile: if args.quick {
            Profile::Dev
        } else {
            Profile::Bench
        },
        engines: &engines,
        threads: &[1],
        out: &args.out,
        how: &args.how,
    };
    let store = run.rows(
        |engines| plan::accuracy(&cases, engines, args.quick),
        plan::hopeless,
    )?;
    let rows = row::of(&store.rows);
    Ok((store.head, rows))
}

/// Engines of different answers: Box2D and Rapier give the same with four lanes as with eight, which stand in `speed`.
fn one_of_each(engines: Vec<EngineName>, asked: &[EngineName]) -> Vec<EngineName> {
    let wide = |engine: &EngineName| matches!(engine, EngineName::Box2dAvx2 | EngineName::Rapier8);
    let kept = |engine: &EngineName| !wide(engine) || asked.contains(engine);
    engines.into_iter().filter(kept).collect()
}

/// The cases asked for, or all.
fn cases(asked: &[String]) -> Result<Vec<&'static Case>, Failure> {
    if asked.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let mut found = Vec::new();
    for name in asked {
        let Some(case) = CASES.iter().find(|case| answers_to(case, name)) else {
            let names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
            fail!("{name}: unknown case; there are {}", names.join(", "));
        };
        found.push(case);
    }
    Ok(found)
}

/// `01_projectile` answers to its name, to `projectile`, `01` and `1`.
fn answers_to(case: &Case, name: &str) -> bool {
    let (number, word) = case.name.split_once('_').unwrap_or(("", case.name));
    name == case.name
        || name == word
        || (!number.is_empty() && (name == number || name == number.trim_start_matches('0')))
}

fn write(args: &AccuracyArgs, head: &Head, rows: &[AccuracyRow]) -> Result<(), Failure> {
    let csv = args.out.join("accuracy.csv");
    write_file(&csv, row::csv(head, rows)?.as_bytes())?;
    let markdown = table::markdown(head, rows);
    let table = args.out.join("accuracy.md");
    write_file(&table, markdown.as_bytes())?;
    say!("{}", markdown.trim_end());
    say!("");
    tell("rows", &[csv]);
    tell("table", &[table]);
    tell("charts", &chart::write(&args.out, rows)?);
    if let Some(path) = &args.how.json {
        files::write_json(path, &json(rows))?;
        tell("json", std::slice::from_ref(path));
    }
    Ok(())
}

/// A line about what was written: the first of many stands for all.
fn tell(what: &str, paths: &[PathBuf]) {
    let Some(first) = paths.first() else {
        return;
    };
    let place = |path: &Path| path.display().to_string();
    match paths.len() {
        1 => say!("{what:<12} {}", place(first)),
        count => say!("{what:<12} {} and {} more", place(first), count - 1),
    }
}

/// The table for other programs.
#[derive(Debug, Serialize)]
struct Document<'a> {
    cases: Vec<CaseRows<'a>>,
}

#[derive(Debug, Serialize)]
struct CaseRows<'a> {
    case: &'a str,
    rows: Vec<&'a AccuracyRow>,
}

fn json(rows: &[AccuracyRow]) -> Document<'_> {
    let cases = row::cases(rows).into_iter();
    Document {
        cases: cases
            .map(|case| CaseRows {
                case,
                rows: rows.iter().filter(|row| row.case == case).collect(),
            })
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_answers_to_name_word_and_number() {
        for name in ["01_projectile", "projectile", "01", "1"] {
            let found = cases(&[name.to_owned()]).unwrap();
            assert_eq!(found[0].name, "01_projectile");
            assert_eq!(found.len(), 1);
        }
        let error = cases(&["0".to_owned()]).unwrap_err().line();
        assert!(
            error.starts_with("0: unknown case; there are 01_projectile"),
            "{error}"
        );
    }

    #[test]
    fn the_json_has_its_shape() {
        let rows = row::tests::some();
        let value = serde_json::to_value(json(&rows)).unwrap();
        let first = &value["cases"][0]["rows"][0];
        assert_eq!(value["cases"][0]["case"], "01_projectile");
        for key in [
            "engine",
            "mode",
            "hz",
            "substeps",
            "cpu_s_per_s",
            "error",
            "unit",
        ] {
            assert!(first.get(key).is_some(), "{key}: {first}");
        }
        assert_eq!(first["engine"], "carom");
        assert!(first["substeps"].is_null());
        let failed = value["cases"][0]["rows"]
            .as_array()
            .unwrap()
            .last()
            .unwrap();
        assert!(failed["error"].is_null() && failed["failed"] == "stopped, after 3 s");
    }
}
