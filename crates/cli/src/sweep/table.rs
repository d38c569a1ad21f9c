//! The table of a sweep while it grows: `FILE.part`, which a later run goes on with, and which gets its name when it is whole.

use std::fmt::Display;
use std::fs::{self, File, OpenOptions};
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
    },
}

/// What is done with what an earlier run left behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Earlier {
    Refuse,
    Resume,
    Replace,
}

impl Table {
    /// A table at `place`, or on stdout, with its heading; how many rows it has already.
    pub(super) fn open(
        place: Option<&Path>,
        heading: &str,
        earlier: Earlier,
    ) -> Result<(Self, u64), Failure> {
        let Some(place) = place else {
            let mut rows = BufWriter::new(io::stdout());
            writeln!(rows, "{heading}").or_else(|error| lost(&error))?;
            return Ok((Self::Stdout(rows), 0));
        };
        files::prepare(place)?;
        let mut name = place.as_os_str().to_owned();
        name.push(".part");
        let part = PathBuf::from(name);
        let shown = part.display();
        let (file, rows) = match earlier {
            Earlier::Resume if part.exists() => kept(&part, heading)?,
            Earlier::Refuse if part.exists() => {
                fail!(
                    "{shown} is there from an earlier sweep: --resume goes on with it, --force begins anew"
                )
            }
            _ => {
                if earlier == Earlier::Replace && part.exists() {
                    fs::remove_file(&part).map_err(|error| cannot("replace", &part, &error))?;
                }
                let begun = OpenOptions::new().write(true).create_new(true).open(&part);
                let mut file = begun.map_err(|error| cannot("write", &part, &error))?;
                writeln!(file, "{heading}").map_err(|error| cannot("write", &part, &error))?;
                (file, 0)
            }
        };
        let place = place.to_path_buf();
        let table = Self::File {
            place,
            part,
            rows: BufWriter::new(file),
        };
        Ok((table, rows))
    }

    /// Writes a row; `false` where the reader of stdout went away.
    pub(super) fn write(&mut self, row: &str) -> Result<bool, Failure> {
        match self {
            Self::Stdout(rows) => match writeln!(rows, "{row}") {
                Ok(()) => Ok(true),
                Err(error) if is_closed_pipe(&error) => Ok(false),
                Err(error) => Err(Failure::new(format!("cannot write to stdout: {error}"))),
            },
            Self::File { part, rows, .. } => {
                // A run may take hours: each row is there when it is done.
                let written = writeln!(rows, "{row}").and_then(|()| rows.flush());
                written.map_err(|error| cannot("write", part, &error))?;
                Ok(true)
            }
        }
    }

    /// Ends the table: where all rows are there it gets its name.
    pub(super) fn finish(self, whole: bool) -> Result<(), Failure> {
        match self {
            Self::Stdout(mut rows) => rows.flush().or_else(|error| lost(&error)),
            Self::File {
                place, part, rows, ..
            } => {
                drop(rows);
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

/// What an interrupted sweep left behind, cut after its last whole row.
fn kept(part: &Path, heading: &str) -> Result<(File, u64), Failure> {
    let text = read_file(part, LARGEST).map_err(|error| cannot("read", part, &error))?;
    let whole = text
        .iter()
        .rposition(|byte| *byte == b'\n')
        .map_or(0, |at| at + 1);
    let mut lines = text[..whole].split(|byte| *byte == b'\n');
    if lines.next() != Some(heading.as_bytes()) {
        fail!(
            "{} belongs to another sweep: --force begins anew",
            part.display()
        );
    }
    let rows = text[..whole].iter().filter(|byte| **byte == b'\n').count() - 1;
    let opened = OpenOptions::new().append(true).open(part);
    let file = opened.map_err(|error| cannot("write", part, &error))?;
    file.set_len(whole as u64)
        .map_err(|error| cannot("write", part, &error))?;
    Ok((file, rows as u64))
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
