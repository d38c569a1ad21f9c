//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs;
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::RenderError;
use crate::disk::{self, DiskFile};
use crate::input::plain;

/// A file under a temporary name beside its place: [`Draft::finish`] gives it its name, dropping it removes it.
///
/// The temporary name is drawn at random and belongs to no other file: of two drafts of one place each is whole, and the
/// one that is finished last stays.
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

/// A name that a file may have until it is whole: hidden, in the same folder, `.NAME.0123456789abcdef.part`.
///
/// One that can be told beforehand may be a user's file, or a link that leads to one.
pub(crate) fn temporary_name(place: &Path) -> PathBuf {
    // The standard library's only source of chance; no output depends on it.
    let chance = RandomState::new().build_hasher().finish();
    let mut hidden = OsString::from(".");
    hidden.push(place.file_name().unwrap_or_default());
    hidden.push(format!(".{chance:016x}{PART}"));
    place.with_file_name(hidden)
}

/// How temporary names end.
const PART: &str = ".part";

/// The name that a file with this temporary name was to have.
pub(crate) fn final_name(temporary: &str) -> Option<&str> {
    let (name, chance) = temporary
        .strip_prefix('.')?
        .strip_suffix(PART)?
        .rsplit_once('.')?;
    let ours = chance.len() == 16 && chance.bytes().all(|b| b"0123456789abcdef".contains(&b));
    ours.then_some(name)
}

impl Draft {
    /// Opens the file that will become `place`.
    ///
    /// # Errors
    /// [`RenderError::Io`] if the folder cannot be written to, or a folder, a pipe or a device has the name, [`RenderError::Name`] if
    /// there is no name.
    pub fn create(place: impl AsRef<Path>) -> Result<Self, RenderError> {
        let place = place.as_ref();
        if place.file_name().is_none() {
            return Err(RenderError::Name {
                name: place.display().to_string(),
            });
        }
        let temporary = temporary_name(place);
        // What is whole takes the place of what was there: of a pipe or a device nothing would be left.
        if let Ok(about) = fs::metadata(place) {
            let told = plain(&about).map_err(io::Error::from);
            told.map_err(RenderError::io("write", place))?;
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
            // A failure can no longer be reported; a hidden file may stay.
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
        let [hidden, whole] = &names(folder.path())[..] else {
            panic!("{:?}", names(folder.path()));
        };
        assert_eq!(
            (final_name(hidden), whole.as_str()),
            (Some("a.txt"), "a.txt")
        );
        drop(draft);
        assert_eq!(names(folder.path()), ["a.txt"]);
        assert_eq!(fs::read(&place).unwrap(), b"old");
        write_file(&place, b"new").unwrap();
        assert_eq!(fs::read(&place).unwrap(), b"new");
    }

    #[test]
    fn two_drafts_of_one_place_do_not_mix() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a.txt");
        let mut drafts = [(); 2].map(|()| Draft::create(&place).unwrap());
        for _ in 0..3 {
            for (draft, text) in drafts.iter_mut().zip([&b"first "[..], b"second "]) {
                draft.append(text).unwrap();
                draft.flush().unwrap();
            }
        }
        let [first, second] = drafts;
        first.finish().unwrap();
        assert_eq!(fs::read(&place).unwrap(), b"first first first ");
        second.finish().unwrap();
        assert_eq!(fs::read(&place).unwrap(), b"second second second ");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn hidden_files_of_others_are_not_written_into() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a.txt");
        let theirs = folder.path().join(".a.txt.part");
        fs::write(&theirs, b"theirs").unwrap();
        write_file(&place, b"ours").unwrap();
        assert_eq!(fs::read(&theirs).unwrap(), b"theirs");
        // A name that is taken all the same is refused, and so is a link of that name.
        let taken = temporary_name(&place);
        fs::write(&taken, b"theirs").unwrap();
        assert!(disk::create(&taken).is_err());
        assert_eq!(fs::read(&taken).unwrap(), b"theirs");
        #[cfg(unix)]
        {
            let link = temporary_name(&place);
            std::os::unix::fs::symlink(&theirs, &link).unwrap();
            assert!(disk::create(&link).is_err());
            assert_eq!(fs::read(&theirs).unwrap(), b"theirs");
        }
    }

    #[test]
    fn a_temporary_name_tells_the_final_one() {
        let place = Path::new("out/frame_00000.png");
        let (a, b) = (temporary_name(place), temporary_name(place));
        assert!(a != b);
        for name in [a, b] {
            let name = name.file_name().unwrap().to_str().unwrap();
            assert_eq!(final_name(name), Some("frame_00000.png"));
        }
        for other in [
            ".a.part",
            "a.0123456789abcdef.part",
            ".a.0123456789abcdeF.part",
            ".a.123.part",
        ] {
            assert_eq!(final_name(other), None, "{other}");
        }
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

    #[cfg(unix)]
    #[test]
    fn a_pipe_in_the_place_of_a_file_stays() {
        use std::os::unix::fs::FileTypeExt as _;
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&pipe, &link).unwrap();
        for place in [&pipe, &link] {
            let error = write_file(place, b"x").unwrap_err().to_string();
            assert!(error.contains("a pipe or a device"), "{error}");
        }
        assert_eq!(names(folder.path()), ["link", "pipe"]);
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    }
}
