//! `rows.jsonl`: every finished reading is a line at once, so that an interrupted run loses nothing.

use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use carom_bench::{Job, Reading};
use serde::{Deserialize, Serialize};

use crate::exit::{Failure, fail};
use crate::head::Head;

/// One measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    pub(crate) job: Job,
    /// From 0.
    pub(crate) repetition: u32,
    pub(crate) reading: Reading,
}

/// A line of the file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "line", rename_all = "kebab-case")]
enum Line {
    /// The first: `carom_bench` marks the file as ours.
    Head { carom_bench: String, head: Head },
    /// A measurement.
    Row(Box<Row>),
    /// The last of a run that came to its end.
    Done,
}

/// The rows of a run, in memory and on disk.
#[derive(Debug)]
pub(crate) struct Store {
    path: PathBuf,
    file: File,
    pub(crate) head: Head,
    pub(crate) rows: Vec<Row>,
}

/// What a rows file holds.
struct Earlier {
    command: String,
    head: Head,
    rows: Vec<Row>,
    done: bool,
    /// Length of the part that is made of whole lines.
    whole: u64,
}

impl Store {
    /// Begins a run in `folder`, or goes on with the one there if `resume`.
    ///
    /// Without `resume` a finished file of ours is replaced, an unfinished one kept aside under another name.
    pub(crate) fn open(
        folder: &Path,
        command: &str,
        head: Head,
        resume: bool,
    ) -> Result<Self, Failure> {
        let path = folder.join("rows.jsonl");
        let earlier = if path.exists() {
            Some(read(&path)?)
        } else {
            None
        };
        match earlier {
            Some(earlier) if resume => go_on(path, earlier, command, &head),
            Some(earlier) if !earlier.done && !earlier.rows.is_empty() => {
                let aside = folder.join("rows.unfinished.jsonl");
                fs::rename(&path, &aside).map_err(|error| {
                    Failure::new(format!("cannot rename {}: {error}", path.display()))
                })?;
                eprintln!(
                    "{} unfinished rows of an earlier run are kept as {} (--resume goes on with them)",
                    earlier.rows.len(),
                    aside.display()
                );
                begin(path, command, head)
            }
            _ => begin(path, command, head),
        }
    }

    /// Whether a job was measured already.
    pub(crate) fn has(&self, job: &Job, repetition: u32) -> bool {
        let same = |row: &Row| row.repetition == repetition && row.job == *job;
        self.rows.iter().any(same)
    }

    /// Adds a measurement.
    pub(crate) fn add(&mut self, row: Row) -> Result<(), Failure> {
        self.write(&Line::Row(Box::new(row.clone())))?;
        self.rows.push(row);
        Ok(())
    }

    /// Marks the run as finished.
    pub(crate) fn finish(&mut self) -> Result<(), Failure> {
        self.write(&Line::Done)
    }

    fn write(&mut self, line: &Line) -> Result<(), Failure> {
        let mut text = serde_json::to_string(line)?;
        text.push('\n');
        // One write a line: what is torn can only be the last.
        self.file
            .write_all(text.as_bytes())
            .map_err(|error| Failure::new(format!("cannot write {}: {error}", self.path.display())))
    }
}

fn begin(path: PathBuf, command: &str, head: Head) -> Result<Store, Failure> {
    let file = File::create(&path)
        .map_err(|error| Failure::new(format!("cannot write {}: {error}", path.display())))?;
    let mut store = Store {
        path,
        file,
        head: head.clone(),
        rows: Vec::new(),
    };
    store.write(&Line::Head {
        carom_bench: command.to_owned(),
        head,
    })?;
    Ok(store)
}

fn go_on(path: PathBuf, earlier: Earlier, command: &str, head: &Head) -> Result<Store, Failure> {
    if earlier.command != command {
        fail!(
            "{} holds rows of {}, not of {command}: choose another --out",
            path.display(),
            earlier.command
        );
    }
    if let Some(key) = earlier.head.conflict(head) {
        fail!(
            "{}: {key} was {:?} and is {:?} now, which do not belong into one table: run without --resume",
            path.display(),
            earlier.head.get(key),
            head.get(key)
        );
    }
    let file = OpenOptions::new()
        .append(true)
        .open(&path)
        .and_then(|file| file.set_len(earlier.whole).map(|()| file))
        .map_err(|error| Failure::new(format!("cannot write {}: {error}", path.display())))?;
    Ok(Store {
        path,
        file,
        head: earlier.head,
        rows: earlier.rows,
    })
}

/// Reads a file of ours; a torn last line is left out, anything else that is wrong is named.
fn read(path: &Path) -> Result<Earlier, Failure> {
    let name = path.display();
    let text =
        fs::read(path).map_err(|error| Failure::new(format!("cannot read {name}: {error}")))?;
    let whole = text
        .iter()
        .rposition(|byte| *byte == b'\n')
        .map_or(0, |at| at + 1);
    let text = String::from_utf8_lossy(&text[..whole]).into_owned();
    let mut lines = text.lines().enumerate();
    let first = lines
        .next()
        .and_then(|(_, line)| serde_json::from_str(line).ok());
    let Some(Line::Head { carom_bench, head }) = first else {
        fail!("{name} was not written by carom-bench: choose another --out or move it away");
    };
    let mut earlier = Earlier {
        command: carom_bench,
        head,
        rows: Vec::new(),
        done: false,
        whole: whole as u64,
    };
    for (index, line) in lines {
        match serde_json::from_str(line) {
            Ok(Line::Row(row)) => earlier.rows.push(*row),
            Ok(Line::Done) => earlier.done = true,
            Ok(Line::Head { .. }) => fail!("{name}:{}: a second head", index + 1),
            Err(error) => fail!("{name}:{}: {error}", index + 1),
        }
    }
    Ok(earlier)
}

#[cfg(test)]
mod tests {
    use super::*;

    use carom_bench::{EngineName, Mode, Point};

    fn job(hz: u32) -> Job {
        Job::Accuracy(Point {
            engine: EngineName::Carom,
            mode: Mode::Hybrid,
            case: "01_projectile".to_owned(),
            hz,
            substeps: None,
        })
    }

    fn row(hz: u32) -> Row {
        Row {
            job: job(hz),
            repetition: 0,
            reading: Reading::Failed {
                reason: "x".to_owned(),
            },
        }
    }

    fn head(machine: &str) -> Head {
        let mut head = Head::default();
        head.push("machine", machine);
        head
    }

    fn open(folder: &Path, resume: bool) -> Result<Store, Failure> {
        Store::open(folder, "accuracy", head("m"), resume)
    }

    #[test]
    fn what_was_measured_is_not_measured_again() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = open(folder.path(), false).unwrap();
        store.add(row(60)).unwrap();
        store.add(row(120)).unwrap();
        let path = folder.path().join("rows.jsonl");
        // The power went while a line was written.
        let mut text = fs::read(&path).unwrap();
        text.truncate(text.len() - 20);
        fs::write(&path, &text).unwrap();

        let mut again = open(folder.path(), true).unwrap();
        assert!(again.has(&job(60), 0));
        assert!(!again.has(&job(60), 1) && !again.has(&job(120), 0));
        again.add(row(120)).unwrap();
        again.finish().unwrap();
        let last = open(folder.path(), true).unwrap();
        assert_eq!(last.rows, [row(60), row(120)]);
    }

    #[test]
    fn unfinished_rows_are_not_thrown_away() {
        let folder = tempfile::tempdir().unwrap();
        open(folder.path(), false).unwrap().add(row(60)).unwrap();
        let mut second = open(folder.path(), false).unwrap();
        assert!(second.rows.is_empty());
        let aside = read(&folder.path().join("rows.unfinished.jsonl")).unwrap();
        assert_eq!(aside.rows, [row(60)]);
        second.add(row(240)).unwrap();
        second.finish().unwrap();
        assert!(
            open(folder.path(), false).unwrap().rows.is_empty(),
            "a finished one is replaced"
        );
    }

    #[test]
    fn files_of_others_and_of_other_machines_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.jsonl");
        for text in ["{\"a\":1}\n", "hello", "{\"line\":\"done\"}\n"] {
            fs::write(&path, text).unwrap();
            for resume in [false, true] {
                let error = open(folder.path(), resume).unwrap_err().line();
                assert!(error.contains("not written by carom-bench"), "{error}");
            }
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        fs::remove_file(&path).unwrap();
        open(folder.path(), false).unwrap().add(row(60)).unwrap();
        let error = Store::open(folder.path(), "speed", head("m"), true)
            .unwrap_err()
            .line();
        assert!(error.contains("rows of accuracy"), "{error}");
        let error = Store::open(folder.path(), "accuracy", head("n"), true)
            .unwrap_err()
            .line();
        assert!(error.contains("machine was \"m\" and is \"n\""), "{error}");
    }

    #[test]
    fn a_broken_line_is_named() {
        let folder = tempfile::tempdir().unwrap();
        open(folder.path(), false).unwrap().add(row(60)).unwrap();
        let path = folder.path().join("rows.jsonl");
        let text = fs::read_to_string(&path).unwrap() + "{\"line\":\"row\"}\n";
        fs::write(&path, text).unwrap();
        let error = open(folder.path(), true).unwrap_err().line();
        assert!(error.contains("rows.jsonl:3:"), "{error}");
    }
}
