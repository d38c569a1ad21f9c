//! Files beside the pictures: their place is looked at before a run, not after it.

use std::fs;
use std::path::Path;

use carom_render::write_file;
use serde::Serialize;

use crate::exit::{Failure, fail};

/// Makes the folder of a file to come, and refuses a place that is a folder itself, a pipe or a device: the file would take its place.
pub fn prepare(place: &Path) -> Result<(), Failure> {
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
    match place.parent() {
        Some(folder) => make_folder(folder),
        None => Ok(()),
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

/// Writes a value as JSON, whole or not at all.
pub fn write_json(place: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)? + "\n";
    Ok(write_file(place, text.as_bytes())?)
}
