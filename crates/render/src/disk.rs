//! The one door to what changes the disk, so that a test can let any single change fail.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

/// An open file of ours.
#[derive(Debug)]
pub(crate) struct DiskFile(File);

/// Makes a file that is not there yet: no other one is emptied, and no link is followed.
pub(crate) fn create(path: &Path) -> io::Result<DiskFile> {
    fault::next()?;
    File::create_new(path).map(DiskFile)
}

/// Opens a file to append to; made if it is missing.
pub(crate) fn open(path: &Path) -> io::Result<DiskFile> {
    fault::next()?;
    let mut options = OpenOptions::new();
    options
        .create(true)
        .append(true)
        .read(true)
        .open(path)
        .map(DiskFile)
}

/// Makes a folder and those above it.
pub(crate) fn make_folder(path: &Path) -> io::Result<()> {
    fault::next()?;
    fs::create_dir_all(path)
}

/// Gives a file another name, in place of the one that has it.
pub(crate) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    fault::next()?;
    fs::rename(from, to)
}

/// Removes a file; one that is not there is no error. A full disk lets it.
pub(crate) fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

impl DiskFile {
    /// Whether another run holds the file; a file system without locks is no reason to refuse.
    pub(crate) fn is_taken(&self) -> bool {
        matches!(self.0.try_lock(), Err(TryLockError::WouldBlock))
    }

    /// Lets go of the lock at once: closing the file would not, while a process that was just started still shares it.
    pub(crate) fn release(&self) {
        // Closing it does the rest.
        let _gone = self.0.unlock();
    }

    /// Appends a text whole or not at all.
    pub(crate) fn append(&mut self, text: &str) -> io::Result<()> {
        let before = self.0.metadata()?.len();
        let written = self.write_all(text.as_bytes());
        if written.is_err() {
            // A full disk lets a file become shorter. If not, the next reader leaves half a line out.
            let _cut = self.0.set_len(before);
        }
        written
    }
}

impl Write for DiskFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // A disk that fills up takes a part of what it is given.
        if let Err(full) = fault::next() {
            self.0.write_all(&bytes[..bytes.len() / 2])?;
            return Err(full);
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Seek for DiskFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

/// Nothing fails but what the system lets fail.
#[cfg(not(test))]
mod fault {
    #[expect(clippy::unnecessary_wraps, reason = "the twin of what tests let fail")]
    pub(super) const fn next() -> std::io::Result<()> {
        Ok(())
    }
}

/// A disk that is full from the n-th change of a thread on.
#[cfg(test)]
pub(crate) mod fault {
    use std::cell::Cell;
    use std::io;

    thread_local! {
        /// Changes that the disk still takes, and whether it refused one.
        static LEFT: Cell<(Option<u32>, bool)> = const { Cell::new((None, false)) };
    }

    /// Runs `work` on a disk that takes `changes` changes and then none, but for removals; says whether it refused one.
    pub(crate) fn after<T>(changes: u32, work: impl FnOnce() -> T) -> (T, bool) {
        LEFT.set((Some(changes), false));
        let done = work();
        let (_, refused) = LEFT.take();
        (done, refused)
    }

    pub(super) fn next() -> io::Result<()> {
        match LEFT.get() {
            (Some(0), _) => {
                LEFT.set((Some(0), true));
                Err(io::ErrorKind::StorageFull.into())
            }
            (left, refused) => {
                LEFT.set((left.map(|left| left - 1), refused));
                Ok(())
            }
        }
    }
}
