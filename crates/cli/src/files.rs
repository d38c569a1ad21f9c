//! Files beside the pictures: their place is looked at before a run, not after it.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use carom_render::Draft;
use serde::Serialize;

use crate::exit::{Failure, fail};

/// Makes the folder of a file to come, and refuses a place that is a folder itself, a pipe or a device: the file would take its place.
///
/// Gives the place where a link leads: what is renamed to a link's name would take the place of the link.
pub fn prepare(place: &Path) -> Result<PathBuf, Failure> {
    if is_stdout(place) {
        fail!("cannot write -: that is no stdout here, and ./- a file of that name");
    }
    refuse_other_than_file(place)?;
    let place = followed(place)?;
    if let Some(folder) = place.parent() {
        make_folder(folder)?;
    }
    Ok(place)
}

/// Whether a place is `-`, which means stdout where a command can write to it.
pub(crate) fn is_stdout(place: &Path) -> bool {
    place.as_os_str() == "-"
}

/// Refuses a place that is a folder, a pipe or a device; opening a pipe to look at it could wait for ever.
pub(crate) fn refuse_other_than_file(place: &Path) -> Result<(), Failure> {
    if let Ok(about) = fs::metadata(place)
        && !about.is_file()
    {
        let kind = if about.is_dir() {
            "a directory"
        } else {
            "a pipe or a device, not a file"
        };
        fail!("cannot write {}: it is {kind}", place.display());
    }
    Ok(())
}

/// Most links that lead to each other, as on Linux.
const MOST_LINKS: usize = 40;

/// Where a link leads, also to what is not there yet.
fn followed(place: &Path) -> Result<PathBuf, Failure> {
    let mut here = place.to_path_buf();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&here) {
            Ok(to) => here = here.with_file_name("").join(to),
            Err(_) => return Ok(here),
        }
    }
    fail!("cannot write {}: its links have no end", place.display())
}

/// Refuses a run of which one file would take the place of another: each is told as the flag that asks for it.
pub(crate) fn apart(files: &[(&str, &Path)]) -> Result<(), Failure> {
    for (k, (flag, place)) in files.iter().enumerate() {
        for (other, taken) in &files[..k] {
            if is_same(place, taken) {
                fail!("{flag} {} is {other}, too", place.display());
            }
        }
    }
    Ok(())
}

/// Whether two paths lead to one place, which need not be there.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| whole(&std::path::absolute(followed(path).ok()?).ok()?);
    place(a).is_some_and(|a| Some(a) == place(b))
}

/// An absolute path without links and `..`; folders on the way may be missing, and are yet to be made.
fn whole(path: &Path) -> Option<PathBuf> {
    if let Ok(path) = fs::canonicalize(path) {
        return Some(path);
    }
    let folder = whole(path.parent()?)?;
    match path.file_name() {
        Some(name) => Some(folder.join(name)),
        None => folder.parent().map(Path::to_path_buf),
    }
}

/// Makes a folder and those above it.
pub fn make_folder(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder).map_err(|error| {
        Failure::new(format!(
            "cannot make the folder {}: {error}",
            folder.display()
        ))
    })
}

/// A file for JSON that is to come: where it cannot be written a run does not begin.
#[derive(Debug)]
pub struct Json {
    place: PathBuf,
    draft: Draft,
}

impl Json {
    /// Opens the file that will become `place`.
    pub fn create(place: &Path) -> Result<Self, Failure> {
        let place = prepare(place)?;
        Ok(Self {
            draft: Draft::create(&place)?,
            place,
        })
    }

    /// Writes a value, whole or not at all.
    pub fn finish(mut self, value: &impl Serialize) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(value)? + "\n";
        self.draft.write_all(text.as_bytes()).map_err(|error| {
            Failure::new(format!("cannot write {}: {error}", self.place.display()))
        })?;
        Ok(self.draft.finish()?)
    }
}

/// Writes a value as JSON, whole or not at all.
pub fn write_json(place: &Path, value: &impl Serialize) -> Result<(), Failure> {
    Json::create(place)?.finish(value)
}
