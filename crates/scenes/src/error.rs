//! What can be wrong with a scene, on one line that names file, line, column and field.

use core::fmt;
use std::io;

/// Why a scene was not read, not changed or not built.
///
/// Its text is one line: `scenes/bad.toml:12:5: body.radiuss: unknown field, did you mean "radius"?`.
#[derive(Debug)]
pub struct SceneError {
    pub(crate) origin: String,
    pub(crate) place: Place,
    pub(crate) field: String,
    pub(crate) problem: Box<Problem>,
}

/// Where in a scene something is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole.
    File,
    /// A place in the text, both counted from 1; the column counts characters.
    At {
        /// Line, from 1.
        line: usize,
        /// Column, from 1, in characters.
        column: usize,
    },
    /// A setting that was laid over the file, as `key=value`.
    Set(String),
}

/// What is wrong.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Io(io::Error),
    /// There is no such file.
    #[error("no such file")]
    Missing,
    /// The path is a folder.
    #[error("is a folder, not a scene file")]
    Folder,
    /// The file has no content.
    #[error("the file is empty: a scene starts with `version = 1`")]
    Empty,
    /// The file is larger than what is read.
    #[error("{bytes} bytes are over the limit of {limit} bytes")]
    TooLarge {
        /// Size of the file, in bytes.
        bytes: u64,
        /// Largest accepted size, in bytes.
        limit: u64,
    },
    /// The file is not text.
    #[error("not UTF-8 text: byte {offset} of the file is 0x{byte:02x}")]
    NotText {
        /// Offset of the first wrong byte, from 0.
        offset: usize,
        /// The byte there.
        byte: u8,
    },
    /// The text is not TOML.
    #[error("not valid TOML: {0}")]
    Syntax(String),
    /// A field that scenes do not have.
    #[error("unknown {what}{}", hint(nearest.as_deref(), expected))]
    Unknown {
        /// `field`, `shape`, `scene`, `material`, or what else the name should be.
        what: &'static str,
        /// The nearest known name.
        nearest: Option<String>,
        /// All known names.
        expected: Vec<String>,
    },
    /// A field that must be given is not.
    #[error("missing: {0}")]
    MissingField(String),
    /// A value has another type than the field, or does not fit into it.
    #[error("{0}")]
    Type(String),
    /// A number is NaN or infinite, or too large for a 64-bit float.
    #[error("{0} is not a finite number")]
    NotFinite(String),
    /// The file was written for a later program.
    #[error("version {found} is from the future: this program reads version {known}")]
    Version {
        /// Version of the file.
        found: i128,
        /// Latest version that is read.
        known: u32,
    },
    /// Two bodies have one name.
    #[error("\"{name}\" is already the name of {first}")]
    DuplicateName {
        /// The name.
        name: String,
        /// Where the first body of that name is.
        first: String,
    },
    /// Bodies of a population find no free place.
    #[error(
        "only {placed} of {wanted} bodies of population \"{name}\" fit without overlap (gave up after {tries} tries)"
    )]
    DoesNotFit {
        /// Name of the population.
        name: String,
        /// How many have a place.
        placed: u64,
        /// How many were wanted.
        wanted: u64,
        /// How many places were tried for the last one.
        tries: u64,
    },
    /// A value that a scene does not accept.
    #[error("{0}")]
    Refused(String),
}

fn hint(nearest: Option<&str>, expected: &[String]) -> String {
    match nearest {
        Some(name) => format!(", did you mean \"{name}\"?"),
        None if expected.is_empty() => String::new(),
        None => format!(", expected one of {}", expected.join(", ")),
    }
}

impl SceneError {
    /// The file or the built-in scene.
    #[must_use]
    pub fn origin(&self) -> &str {
        &self.origin
    }

    /// Where in it.
    #[must_use]
    pub const fn place(&self) -> &Place {
        &self.place
    }

    /// Line in the file, from 1, where there is one.
    #[must_use]
    pub const fn line(&self) -> Option<usize> {
        match self.place {
            Place::At { line, .. } => Some(line),
            Place::File | Place::Set(_) => None,
        }
    }

    /// The field, as a dotted path; empty if the error is not about one.
    #[must_use]
    pub fn field(&self) -> &str {
        &self.field
    }

    /// What is wrong.
    #[must_use]
    pub const fn problem(&self) -> &Problem {
        &self.problem
    }

    pub(crate) fn file(origin: &str, problem: Problem) -> Self {
        Self {
            origin: origin.to_owned(),
            place: Place::File,
            field: String::new(),
            problem: Box::new(problem),
        }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&one_line(&self.origin))?;
        match &self.place {
            Place::File => f.write_str(": ")?,
            Place::At { line, column } => write!(f, ":{line}:{column}: ")?,
            Place::Set(text) => write!(f, ": --set {}: ", one_line(text))?,
        }
        if !self.field.is_empty() {
            write!(f, "{}: ", one_line(&self.field))?;
        }
        f.write_str(&one_line(&self.problem.to_string()))
    }
}

impl core::error::Error for SceneError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &*self.problem {
            Problem::Io(error) => Some(error),
            _ => None,
        }
    }
}

/// Control characters, line breaks among them, written out: an error is one line.
fn one_line(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
    }
    line
}

/// The known name nearest to `name`, if it is near enough to be meant.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = name.to_lowercase();
    known
        .into_iter()
        .map(|candidate| {
            (
                strsim::damerau_levenshtein(&wanted, &candidate.to_lowercase()),
                candidate,
            )
        })
        // One slip in three letters still reads as the same word.
        .filter(|&(slips, candidate)| slips <= (candidate.len().max(name.len()) / 3).max(1))
        .min_by_key(|&(slips, _)| slips)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_near() {
        let known = ["radius", "restitution", "v", "n"];
        assert_eq!(nearest("radiuss", known), Some("radius"));
        assert_eq!(nearest("Radius", known), Some("radius"));
        assert_eq!(nearest("resitution", known), Some("restitution"));
        assert_eq!(nearest("colour", known), None);
    }

    #[test]
    fn an_error_is_one_line() {
        let error = SceneError::file("a\nb.toml", Problem::Syntax("two\nlines".to_owned()));
        assert_eq!(error.to_string(), "a\\nb.toml: not valid TOML: two\\nlines");
    }
}
