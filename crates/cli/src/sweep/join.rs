//! The tables of a sweep's shards, joined by `merge`.

use std::fmt::Display;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use carom_render::{Draft, open_file};

use crate::exit::{End, Failure, Outcome, fail};
use crate::out::say;

/// Longest row, in bytes.
const LONGEST: u64 = 1 << 20;

/// A shard's table: its heading, and its rows by the numbers of their runs.
struct Slice {
    path: PathBuf,
    heading: String,
    first: u64,
    count: u64,
    runs: u64,
}

/// Joins tables into one, in the order of their runs, if they are all there, once each, and of one sweep.
///
/// Each is read twice, line by line: tables of a long sweep are larger than memory.
pub(crate) fn run(tables: &[PathBuf], out: &Path) -> Outcome {
    let mut slices: Vec<Slice> = tables
        .iter()
        .map(|path| look(path))
        .collect::<Result<_, _>>()?;
    slices.sort_by_key(|slice| slice.first);
    let (heading, runs) = (slices[0].heading.clone(), slices[0].runs);
    let mut next = 0;
    for slice in &slices {
        let shown = slice.path.display();
        if slice.heading != heading || slice.runs != runs {
            let first = slices[0].path.display();
            fail!("{shown} belongs to another sweep than {first}");
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
    let mut draft = Draft::create(out)?;
    writeln!(draft, "{heading}")?;
    for slice in &slices {
        let mut rows = open(&slice.path)?;
        let mut own = String::new();
        rows.read_line(&mut own)
            .map_err(|error| cannot(&slice.path, &error))?;
        io::copy(&mut rows, &mut draft)?;
    }
    draft.finish()?;
    say!(
        "{runs} runs of {} tables in {}",
        slices.len(),
        out.display()
    );
    Ok(End::Done)
}

/// What a table is, if its rows are whole and in order.
fn look(path: &Path) -> Result<Slice, Failure> {
    let broken = || Failure::new(format!("{} is no table of a sweep", path.display()));
    let mut rows = open(path)?;
    let mut line = String::new();
    let mut next = |line: &mut String| {
        line.clear();
        let read = (&mut rows).take(LONGEST).read_line(line);
        let read = read.map_err(|error| cannot(path, &error))?;
        // A row that was cut short has no end.
        if read > 0 && line.pop() != Some('\n') {
            return Err(broken());
        }
        Ok(read > 0)
    };
    if !next(&mut line)? || !line.starts_with("run,runs") {
        return Err(broken());
    }
    let heading = line.clone();
    let (mut first, mut count) = (None, 0);
    while next(&mut line)? {
        let mut cells = line.split(',').map(str::parse::<u64>);
        let (Some(Ok(run)), Some(Ok(runs))) = (cells.next(), cells.next()) else {
            return Err(broken());
        };
        let &mut (begin, all) = first.get_or_insert((run, runs));
        if (run, runs) != (begin + count, all) {
            return Err(broken());
        }
        count += 1;
    }
    let (first, runs) = first.ok_or_else(broken)?;
    Ok(Slice {
        path: path.to_path_buf(),
        heading,
        first,
        count,
        runs,
    })
}

fn open(path: &Path) -> Result<BufReader<File>, Failure> {
    let (file, _) = open_file(path).map_err(|error| cannot(path, &error))?;
    Ok(BufReader::new(file))
}

fn cannot(path: &Path, error: &impl Display) -> Failure {
    Failure::new(format!("cannot read {}: {error}", path.display()))
}
