//! What stands in an output folder and is ours: the text of its manifest.
//!
//! ```text
//! carom output 2
//! thesis … the run in one line
//! frame_00000.png                      listed: from here on a file of this name is ours
//! frame_00000.png⇥1f3c90aa⇥20481       whole: CRC-32 and length in bytes
//! ```
//!
//! A run only ever appends whole lines, so a manifest that was cut short is right up to its last line feed.

use core::fmt::Write as _;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{self, Read as _};
use std::path::Path;

use crate::{ReadError, RenderError, open_file, read_file};

/// Name of the manifest inside an output folder.
pub const MANIFEST: &str = "manifest.txt";

/// Largest manifest that is read, in bytes: a film of a million frames, the longest, has lines of 40 bytes, two each
/// until it is closed. With less it could not be resumed; more is memory for what is no manifest.
const MAX_BYTES: u64 = 1 << 27;

/// First line of a manifest; the number is that of the format.
const HEADING: &str = "carom output 2";
/// What the first lines of all formats have in common.
const HEADINGS: &str = "carom output ";

/// What a whole file is known by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checksum {
    /// CRC-32 of its bytes, as in PNG and zip.
    pub crc: u32,
    /// Its length, in bytes.
    pub length: u64,
}

impl Checksum {
    /// The checksum of these bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        Self {
            crc: crc32fast::hash(bytes),
            length: bytes.len() as u64,
        }
    }

    /// The checksum of a file, read piece by piece.
    ///
    /// # Errors
    /// [`RenderError::Io`] with the path.
    pub fn of_file(path: impl AsRef<Path>) -> Result<Self, RenderError> {
        let path = path.as_ref();
        Self::read(path).map_err(RenderError::io("read", path))
    }

    /// Whether a file is the one that has this checksum; one of another length is not read.
    ///
    /// # Errors
    /// [`RenderError::Io`] with the path: it is not there, cannot be read, or is no plain file.
    pub fn is_of(&self, path: impl AsRef<Path>) -> Result<bool, RenderError> {
        let path = path.as_ref();
        let (_, length) = open_file(path)
            .map_err(io::Error::from)
            .map_err(RenderError::io("read", path))?;
        Ok(length == self.length && Self::of_file(path)? == *self)
    }

    fn read(path: &Path) -> io::Result<Self> {
        let (mut file, _) = open_file(path)?;
        let mut hasher = crc32fast::Hasher::new();
        let (mut piece, mut length) = (vec![0; 1 << 16], 0);
        loop {
            match file.read(&mut piece) {
                Ok(0) => break,
                Ok(count) => {
                    hasher.update(&piece[..count]);
                    length += count as u64;
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Self {
            crc: hasher.finalize(),
            length,
        })
    }
}

/// The manifest of an output folder.
///
/// # Examples
/// ```
/// use carom_render::{Existing, Manifest, Checksum, OutputFolder};
/// # let root = tempfile::tempdir()?;
/// # let path = root.path();
/// let folder = OutputFolder::open(path, Existing::Refuse, "an example")?;
/// folder.save("note.txt", b"hello")?;
/// let manifest = Manifest::read(path)?.expect("it is there");
/// assert_eq!(manifest.about, "an example");
/// assert_eq!(manifest.files["note.txt"], Some(Checksum::of(b"hello")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Manifest {
    /// The run, in one line.
    pub about: String,
    /// Every file that is ours, by name, with its checksum once it is whole.
    pub files: BTreeMap<String, Option<Checksum>>,
}

impl Manifest {
    /// The manifest of a folder, or `None` if it has none.
    ///
    /// # Errors
    /// [`RenderError::Foreign`] if the file of that name is no manifest, [`RenderError::Io`] if it cannot be read.
    pub fn read(folder: impl AsRef<Path>) -> Result<Option<Self>, RenderError> {
        let place = folder.as_ref().join(MANIFEST);
        let bytes = match read_file(&place, MAX_BYTES) {
            Err(ReadError::Io(error)) if error.kind() == io::ErrorKind::NotFound => {
                return Ok(None);
            }
            read => read
                .map_err(io::Error::from)
                .map_err(RenderError::io("read", &place))?,
        };
        let text = String::from_utf8(bytes).unwrap_or_else(|_| "binary".to_owned());
        Self::parse(&text)
            .map(Some)
            .ok_or(RenderError::Foreign { path: place })
    }

    /// `None` if the text is no manifest. An empty one is that of a run that ended before it began.
    fn parse(text: &str) -> Option<Self> {
        // What stands behind the last line feed was cut short.
        let mut lines = text[..text.rfind('\n').unwrap_or(0)].lines();
        let heading = lines.next().unwrap_or_default();
        if !(heading.starts_with(HEADINGS) || text.is_empty()) {
            return None;
        }
        let mut manifest = Self {
            about: lines.next().unwrap_or_default().to_owned(),
            files: BTreeMap::new(),
        };
        for line in lines {
            let (name, sum) = read_line(line);
            // A manifest is no licence to remove files elsewhere.
            if is_plain(name) {
                manifest.files.insert(name.to_owned(), sum);
            }
        }
        Some(manifest)
    }

    /// The shortest text that says all of it, in order of names.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("{HEADING}\n{}\n", self.about);
        for (name, sum) in &self.files {
            text.push_str(&line(name, *sum));
        }
        text
    }
}

/// One line of a manifest, with its line feed.
pub(crate) fn line(name: &str, sum: Option<Checksum>) -> String {
    let mut line = name.to_owned();
    if let Some(Checksum { crc, length }) = sum {
        // Writing to a string does not fail.
        let _written = write!(line, "\t{crc:08x}\t{length}");
    }
    line.push('\n');
    line
}

fn read_line(line: &str) -> (&str, Option<Checksum>) {
    let mut words = line.split('\t');
    let name = words.next().unwrap_or_default();
    let sum = words.next().zip(words.next()).and_then(|(sum, length)| {
        Some(Checksum {
            crc: u32::from_str_radix(sum, 16).ok()?,
            length: length.parse().ok()?,
        })
    });
    (name, sum)
}

/// Whether a name is that of a file in the folder itself, and not the manifest's.
pub(crate) fn is_plain(name: &str) -> bool {
    Path::new(name).file_name() == Some(OsStr::new(name))
        && !name.chars().any(char::is_control)
        && name != MANIFEST
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn manifest() -> Manifest {
        let mut manifest = Manifest {
            about: "a run".to_owned(),
            ..Manifest::default()
        };
        for (name, sum) in [
            ("a b.png", None),
            ("frame_00000.png", Some(Checksum::of(b"zero"))),
            ("frame_00001.png", Some(Checksum::of(b"one"))),
        ] {
            manifest.files.insert(name.to_owned(), sum);
        }
        manifest
    }

    #[test]
    fn a_manifest_comes_back() {
        assert_eq!(
            Manifest::parse(&manifest().text()).as_ref(),
            Some(&manifest())
        );
        // A later line about the same file counts.
        let text = manifest().text() + &line("a b.png", Some(Checksum::of(b"")));
        let read = Manifest::parse(&text).unwrap();
        assert_eq!(read.files["a b.png"], Some(Checksum::of(b"")));
    }

    #[test]
    fn a_manifest_cut_anywhere_is_right_as_far_as_it_goes() {
        let text = manifest().text();
        for cut in HEADING.len() + 1..text.len() {
            let read = Manifest::parse(&text[..cut]).expect("still ours");
            let lines = text[..cut].matches('\n').count();
            assert_eq!(read.files.len(), lines.saturating_sub(2), "{cut} bytes");
            for (name, sum) in &read.files {
                assert_eq!(*sum, manifest().files[name], "{cut} bytes");
            }
        }
    }

    #[test]
    fn lists_of_others_are_no_manifests() {
        for text in ["apples\npears\n", "carrots", "carom\n", "\n", "binary"] {
            assert_eq!(Manifest::parse(text), None, "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_without_harm(text: String) {
            if let Some(read) = Manifest::parse(&text) {
                prop_assert!(read.files.keys().all(|name| is_plain(name)));
            }
        }
    }
}
