//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::RenderError;
use crate::disk::{self, DiskFile};

/// A file under a temporary name beside its place: [`Draft::finish`] gives it its name, dropping it removes it.
///
/// # Examples
/// ```
/// use carom_render::Draft;
/// use std::io::Write;
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("energy.csv");
/// let mut draft = Draft::create(&path)?;
/// writeln!(draft, "time,energy")?;
/// assert!(!path.exists());
/// draft.finish()?;
/// assert_eq!(std::fs::read_to_string(&path)?, "time,energy\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Draft {
    place: PathBuf,
    temporary: PathBuf,
    writer: Option<BufWriter<DiskFile>>,
}

/// The name that a file has until it is whole: hidden, in the same folder.
pub(crate) fn temporary_name(place: &Path) -> PathBuf {
    let mut hidden = OsString::from(".");
    hidden.push(place.file_name().unwrap_or_default());
    hidden.push(".part");
    place.with_file_name(hidden)
}

impl Draft {
    /// Opens the file that will become `place`.
    ///
    /// # Errors
    /// [`RenderError::Io`] if the folder cannot be written to or a folder has the name, [`RenderError::Name`] if there is no name.
    pub fn create(place: impl AsRef<Path>) -> Result<Self, RenderError> {
        let place = place.as_ref();
        if place.file_name().is_none() {
            return Err(RenderError::Name {
                name: place.display().to_string(),
            });
        }
        let temporary = temporary_name(place);
        if place.is_dir() {
            let source = io::Error::from(io::ErrorKind::IsADirectory);
            return Err(RenderError::io("write", place)(source));
        }
        let file = disk::create(&temporary).map_err(RenderError::io("write", place))?;
        Ok(Self {
            place: place.to_path_buf(),
            temporary,
            writer: Some(BufWriter::with_capacity(1 << 16, file)),
        })
    }

    /// Appends bytes, with an error that names the file.
    pub(crate) fn append(&mut self, bytes: &[u8]) -> Result<(), RenderError> {
        self.write_all(bytes)
            .map_err(RenderError::io("write", &self.place))
    }

    /// Hands over the file with everything written so far in it, to change what lies behind.
    pub(crate) fn file(&mut self) -> Result<Option<&mut DiskFile>, RenderError> {
        let Some(writer) = &mut self.writer else {
            return Ok(None);
        };
        writer
            .flush()
            .map_err(RenderError::io("write", &self.place))?;
        Ok(Some(writer.get_mut()))
    }

    /// Closes the file and gives it its name, in place of a file that had it before.
    ///
    /// # Errors
    /// [`RenderError::Io`]; nothing is left of the draft then.
    pub fn finish(mut self) -> Result<(), RenderError> {
        self.file()?;
        // Closed before it is renamed: some systems ask for it.
        drop(self.writer.take());
        let renamed = disk::rename(&self.temporary, &self.place);
        if renamed.is_err() {
            let _gone = disk::remove(&self.temporary);
        }
        renamed.map_err(RenderError::io("write", &self.place))
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.writer {
            Some(writer) => writer.write(bytes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if self.writer.take().is_some() {
            // Nobody is left to hear of a failure; a hidden file may stay.
            let _gone = disk::remove(&self.temporary);
        }
    }
}

/// Writes a whole file under a temporary name first.
///
/// # Errors
/// [`RenderError::Io`] with the path; nothing is left behind then, and what was there before is untouched.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), RenderError> {
    let mut draft = Draft::create(path)?;
    draft.append(bytes)?;
    draft.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_dropped_draft_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a.txt");
        write_file(&place, b"old").unwrap();
        let mut draft = Draft::create(&place).unwrap();
        draft.append(b"half of the n").unwrap();
        assert_eq!(names(folder.path()), [".a.txt.part", "a.txt"]);
        drop(draft);
        assert_eq!(names(folder.path()), ["a.txt"]);
        assert_eq!(fs::read(&place).unwrap(), b"old");
        write_file(&place, b"new").unwrap();
        assert_eq!(fs::read(&place).unwrap(), b"new");
    }

    #[test]
    fn a_folder_in_the_place_of_a_file_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("film.png");
        fs::create_dir(&place).unwrap();
        let error = write_file(&place, b"x").unwrap_err().to_string();
        assert!(error.contains("film.png"), "{error}");
        assert_eq!(names(folder.path()), ["film.png"]);
    }
}
