//! Temporary folders that go when they are no longer needed.

use std::fs;
use std::path::{Path, PathBuf};

use crate::exit::Failure;

/// A new, empty folder in the system's temporary folder, removed with all in it at the end.
#[derive(Debug)]
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    /// `purpose` becomes part of its name.
    pub(crate) fn new(purpose: &str) -> Result<Self, Failure> {
        let base = std::env::temp_dir();
        for attempt in 0..1000 {
            let path = base.join(format!("carom-{purpose}-{}-{attempt}", std::process::id()));
            match fs::create_dir(&path) {
                Ok(()) => return Ok(Self(path)),
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
                Err(error) => {
                    return Err(Failure::new(format!(
                        "cannot make {}: {error}",
                        path.display()
                    )));
                }
            }
        }
        Err(Failure::new(format!(
            "no free name for a folder in {}",
            base.display()
        )))
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // What cannot be removed is left to the system's own cleaning.
        let _ = fs::remove_dir_all(&self.0);
    }
}
