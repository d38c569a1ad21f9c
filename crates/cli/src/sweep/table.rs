//! The table of a sweep while it grows: `FILE.part`, which a later run goes on with, and which gets its name when it is whole.

use std::fmt::Display;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};

use carom_render::read_file;

use crate::exit::{Failure, fail};
use crate::files;
use crate::out::is_closed_pipe;

pub(super) enum Table {
    Stdout(BufWriter<Stdout>),
    File {
        place: PathBuf,
        part: PathBuf,
        rows: BufWriter<File>,
        /// Bytes in the file.
        length: u64,
    },
}

/// What is done with what an earlier run left behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Earlier {
    Refuse,
    Resume,
    Replace,
}

/// What a table has already, and what a row of it must begin with.
pub(super) struct Rows<'a> {
    pub(super) heading: &'a str,
    /// What the k-th row of the table, from 0, begins with; `None` beyond its end.
    pub(super) begins: &'a dyn Fn(u64) -> Option<String>,
}

/// Rows that an earlier run left: how many, and the last of them.
pub(super) type Known = (u64, Option<String>);

impl Table {
    /// A table at `place`, or on stdout, with its heading, and the rows that it has already.
    pub(super) fn open(
        place: Option<&Path>,
        expected: &Rows<'_>,
        earlier: Earlier,
    ) -> Result<(Self, Known), Failure> {
        let heading = expected.heading;
        let Some(place) = place else {
            let mut rows = BufWriter::new(io::stdout());
            writeln!(rows, "{heading}").or_else(|error| lost(&error))?;
            return Ok((Self::Stdout(rows), (0, None)));
        };
        let place = files::prepare(place)?;
        let mut name = place.as_os_str().to_owned();
        name.push(".part");
        let part = PathBuf::from(name);
        files::refuse_other_than_file(&part)?;
        let (file, known) = match earlier {
            Earlier::Resume if part.exists() => kept(&part, expected)?,
            Earlier::Refuse if part.exists() => {
                fail!(
                    "{} is there from an earlier sweep: --resume goes on with it, --force begins anew",
                    part.display()
                )
            }
            Earlier::Replace if part.exists() => {
                // Held until the new file has the name: a sweep that goes on would give its rows the other's name.
                let held = lock(&part, File::open(&part))?;
                fs::remove_file(&part).map_err(|error| cannot("replace", &part, &error))?;
                let begun = begin(&part, heading)?;
                drop(held);
                (begun, (0, None))
            }
            _ => (begin(&part, heading)?, (0, None)),
        };
        let length = file.metadata();
        let table = Self::File {
            length: length.map_err(|error| cannot("read", &part, &error))?.len(),
            place,
            part,
            rows: BufWriter::new(file),
        };
        Ok((table, known))
    }

    /// Writes a row; `false` where the reader of stdout went away.
    pub(super) fn write(&mut self, row: &str) -> Result<bool, Failure> {
        match self {
            Self::Stdout(rows) => match writeln!(rows, "{row}") {
                Ok(()) => Ok(true),
                Err(error) if is_closed_pipe(&error) => Ok(false),
                Err(error) => Err(Failure::new(format!("cannot write to stdout: {error}"))),
            },
            Self::File {
                part, rows, length, ..
            } => {
                unchanged(part, *length)?;
                *length += row.len() as u64 + 1;
                // A run may take hours: each row is there when it is done.
                let written = writeln!(rows, "{row}").and_then(|()| rows.flush());
                written.map_err(|error| cannot("write", part, &error))?;
                Ok(true)
            }
        }
    }

    /// Whether this sweep wrote what was there: `row` is what it makes of the run of the last row there.
    pub(super) fn check(&self, last: &str, row: &str) -> Result<(), Failure> {
        match self {
            Self::File { part, .. } if last != row => Err(other_sweep(part)),
            _ => Ok(()),
        }
    }

    /// Ends the table: where all rows are there it gets its name.
    pub(super) fn finish(self, whole: bool) -> Result<(), Failure> {
        match self {
            Self::Stdout(mut rows) => rows.flush().or_else(|error| lost(&error)),
            Self::File {
                place,
                part,
                rows,
                length,
            } => {
                drop(rows);
                unchanged(&part, length)?;
                if whole {
                    fs::rename(&part, &place).map_err(|error| cannot("write", &place, &error))?;
                }
                Ok(())
            }
        }
    }
}

/// Largest table that is gone on with, in bytes.
const LARGEST: u64 = 1 << 32;

/// A new file with a heading, locked.
fn begin(part: &Path, heading: &str) -> Result<File, Failure> {
    // Appended to: over a table that was cut behind its back a row would leave a hole of the length that is expected.
    let begun = OpenOptions::new().append(true).create_new(true).open(part);
    let mut file = lock(part, begun)?;
    writeln!(file, "{heading}").map_err(|error| cannot("write", part, &error))?;
    Ok(file)
}

/// The file, if no other sweep holds it; a file system without locks is no reason to refuse.
fn lock(part: &Path, opened: io::Result<File>) -> Result<File, Failure> {
    let file = opened.map_err(|error| cannot("write", part, &error))?;
    let shown = part.display();
    if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
        fail!("{shown} is in use by another sweep");
    }
    // Between the two it may have got its name.
    if !part.exists() {
        fail!("{shown} was just finished by another sweep");
    }
    Ok(file)
}

/// Refuses to go on where the name leads to another file than the one of so many bytes: rows would be lost without a word.
fn unchanged(part: &Path, length: u64) -> Result<(), Failure> {
    match fs::metadata(part) {
        Ok(about) if about.is_file() && about.len() == length => Ok(()),
        _ => fail!(
            "{} was removed or changed by something else while the sweep wrote it",
            part.display()
        ),
    }
}

/// What an interrupted sweep left behind, cut after its last whole row.
fn kept(part: &Path, expected: &Rows<'_>) -> Result<(File, Known), Failure> {
    let opened = OpenOptions::new().append(true).open(part);
    let file = lock(part, opened)?;
    let text = read_file(part, LARGEST).map_err(|error| cannot("read", part, &error))?;
    let whole = text
        .iter()
        .rposition(|byte| *byte == b'\n')
        .map_or(0, |at| at + 1);
    let mut lines = text[..whole].split_inclusive(|byte| *byte == b'\n');
    let mut next = || Some(lines.next()?.strip_suffix(b"\n").unwrap_or_default());
    let other = || other_sweep(part);
    if next() != Some(expected.heading.as_bytes()) {
        return Err(other());
    }
    let (mut rows, mut last) = (0, None);
    while let Some(row) = next() {
        let begins = (expected.begins)(rows).ok_or_else(other)?;
        if !row.starts_with(begins.as_bytes()) {
            return Err(other());
        }
        rows += 1;
        last = Some(row);
    }
    let last = last.map(|row| String::from_utf8_lossy(row).into_owned());
    file.set_len(whole as u64)
        .map_err(|error| cannot("write", part, &error))?;
    Ok((file, (rows, last)))
}

/// What is said of rows that this sweep would not have written.
fn other_sweep(part: &Path) -> Failure {
    Failure::new(format!(
        "{} belongs to another sweep: --force begins anew",
        part.display()
    ))
}

fn lost(error: &io::Error) -> Result<(), Failure> {
    if is_closed_pipe(error) {
        Ok(())
    } else {
        Err(Failure::new(format!("cannot write to stdout: {error}")))
    }
}

fn cannot(what: &str, place: &Path, error: &impl Display) -> Failure {
    Failure::new(format!("cannot {what} {}: {error}", place.display()))
}
