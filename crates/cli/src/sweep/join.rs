//! The tables of a sweep's shards, joined by `merge`.

use std::path::{Path, PathBuf};

use carom_render::{read_file, write_file};

use crate::exit::{End, Failure, Outcome, fail};
use crate::out::say;

/// Largest table that is joined, in bytes.
const LARGEST: u64 = 1 << 36;

/// A shard's table: its heading, its rows, and the number of its first run.
struct Slice {
    path: PathBuf,
    heading: String,
    rows: String,
    first: u64,
    count: u64,
    runs: u64,
}

/// Joins tables into one, in the order of their runs, if they are all there, once each, and of one sweep.
pub(crate) fn run(tables: &[PathBuf], out: &Path) -> Outcome {
    let mut slices: Vec<Slice> = tables
        .iter()
        .map(|path| read(path))
        .collect::<Result<_, _>>()?;
    slices.sort_by_key(|slice| slice.first);
    let mut next = 0;
    let (heading, runs) = (slices[0].heading.clone(), slices[0].runs);
    for slice in &slices {
        let shown = slice.path.display();
        if slice.heading != heading || slice.runs != runs {
            fail!(
                "{shown} belongs to another sweep than {}",
                slices[0].path.display()
            );
        }
        if slice.first != next {
            fail!(
                "{shown} begins with run {}, and run {next} is next",
                slice.first
            );
        }
        next += slice.count;
    }
    if next != runs {
        fail!("the tables end before run {next} of {runs}: a slice is missing");
    }
    let mut text = format!("{heading}\n");
    for slice in &slices {
        text.push_str(&slice.rows);
    }
    write_file(out, text.as_bytes())?;
    say!(
        "{runs} runs of {} tables in {}",
        slices.len(),
        out.display()
    );
    Ok(End::Done)
}

fn read(path: &Path) -> Result<Slice, Failure> {
    let shown = path.display();
    let bytes = read_file(path, LARGEST)
        .map_err(|error| Failure::new(format!("cannot read {shown}: {error}")))?;
    let text = String::from_utf8(bytes)
        .map_err(|error| Failure::new(format!("{shown} is no text: {error}")))?;
    let broken = || Failure::new(format!("{shown} is no table of a sweep"));
    let (heading, rows) = text.split_once('\n').ok_or_else(broken)?;
    if !heading.starts_with("run,runs") || !rows.ends_with('\n') {
        return Err(broken());
    }
    let mut numbers = Vec::new();
    for row in rows.lines() {
        let mut cells = row.split(',').map(str::parse::<u64>);
        match (cells.next(), cells.next()) {
            (Some(Ok(run)), Some(Ok(runs))) => numbers.push((run, runs)),
            _ => return Err(broken()),
        }
    }
    let &(first, runs) = numbers.first().ok_or_else(broken)?;
    let in_order = numbers
        .iter()
        .zip(first..)
        .all(|(known, k)| *known == (k, runs));
    if !in_order {
        return Err(broken());
    }
    Ok(Slice {
        path: path.to_path_buf(),
        heading: heading.to_owned(),
        rows: rows.to_owned(),
        first,
        count: numbers.len() as u64,
        runs,
    })
}
