//! Files that are read: plain ones alone, and of each no more than its reader has room for.
//!
//! To open a pipe waits for a writer, and a device may never end: what a path leads to is asked first.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::Path;

/// Why a file was not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// What the system answered.
    #[error("{0}")]
    Io(io::Error),
    /// The path leads to a pipe, a device or a socket.
    #[error("it is a pipe or a device, not a file")]
    NotAFile,
    /// The file is larger than what is read.
    #[error("{bytes} bytes are over the limit of {limit} bytes")]
    TooLarge {
        /// Size of the file, in bytes.
        bytes: u64,
        /// Largest accepted size, in bytes.
        limit: u64,
    },
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<ReadError> for io::Error {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Io(error) => error,
            other => Self::other(other.to_string()),
        }
    }
}

/// Opens a plain file, or a link to one, and says how long it is.
///
/// # Errors
/// [`ReadError::NotAFile`] for what may wait or have no end, else what the system answers; a folder is
/// [`io::ErrorKind::IsADirectory`].
pub fn open_file(path: impl AsRef<Path>) -> Result<(File, u64), ReadError> {
    let path = path.as_ref();
    plain(&fs::metadata(path)?)?;
    let file = File::open(path)?;
    // Another one may have taken its name since.
    let length = plain(&file.metadata()?)?;
    Ok((file, length))
}

pub(crate) fn plain(about: &fs::Metadata) -> Result<u64, ReadError> {
    if about.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory).into());
    }
    if about.is_file() {
        Ok(about.len())
    } else {
        Err(ReadError::NotAFile)
    }
}

/// All bytes of a plain file that has at most `limit` of them.
///
/// # Errors
/// As [`open_file`], and [`ReadError::TooLarge`].
///
/// # Examples
/// ```
/// use carom_render::{ReadError, read_file};
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("note.txt");
/// std::fs::write(&path, "hello")?;
/// assert_eq!(read_file(&path, 5)?, b"hello");
/// assert!(matches!(read_file(&path, 4), Err(ReadError::TooLarge { bytes: 5, limit: 4 })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_file(path: impl AsRef<Path>, limit: u64) -> Result<Vec<u8>, ReadError> {
    let (file, length) = open_file(path)?;
    let too_large = |bytes| ReadError::TooLarge { bytes, limit };
    if length > limit {
        return Err(too_large(length));
    }
    let mut bytes = Vec::new();
    // A file that grows, and those of /proc, are longer than they say.
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a");
        let said = |limit| read_file(&place, limit).unwrap_err().to_string();
        assert!(said(9).contains("o such file"), "{}", said(9));
        fs::write(&place, b"123").unwrap();
        assert_eq!(read_file(&place, 3).unwrap(), b"123");
        assert_eq!(said(2), "3 bytes are over the limit of 2 bytes");
        let error = read_file(folder.path(), 9).unwrap_err();
        let ReadError::Io(error) = error else {
            panic!("{error}");
        };
        assert_eq!(error.kind(), io::ErrorKind::IsADirectory);
    }

    #[cfg(unix)]
    #[test]
    fn what_may_never_end_is_not_opened() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        for place in [&pipe, &link, Path::new("/dev/urandom")] {
            let error = read_file(place, 9).unwrap_err();
            assert!(matches!(error, ReadError::NotAFile), "{error}");
        }
        // A file with a reported length of 0.
        if let Ok(status) = fs::read("/proc/self/status") {
            let error = read_file("/proc/self/status", 9).unwrap_err();
            assert!(
                matches!(error, ReadError::TooLarge { bytes: 10, .. }),
                "{error}, {} bytes",
                status.len()
            );
        }
    }
}
