//! A scene: the text of a file and what was set over it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use carom_render::{ReadError, read_file};

use crate::Built;
use crate::document::{Document, MAX_BYTES};
use crate::error::{Problem, SceneError};
use crate::model::SceneFile;
use crate::path::FieldPath;

/// A scene that was read: all its fields are known and of the right type.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) document: Document,
    pub(crate) file: SceneFile,
    /// The folder that faces are looked up in.
    pub(crate) folder: Option<PathBuf>,
}

impl Scene {
    /// Reads a scene from text; `origin` names it in errors.
    ///
    /// # Errors
    /// Everything that can be said without building it: bytes that are no TOML, unknown fields, wrong types, numbers
    /// that are not finite, a version from the future.
    pub fn from_toml(text: &str, origin: impl AsRef<Path>) -> Result<Self, SceneError> {
        let document = Document::new(&origin.as_ref().to_string_lossy(), text)?;
        let file = document.read()?;
        Ok(Self {
            document,
            file,
            folder: None,
        })
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// If the file is missing, a folder, unreadable, over [`MAX_BYTES`] or not UTF-8, and as [`Self::from_toml`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let origin = path.to_string_lossy();
        let text = read_text(path).map_err(|problem| SceneError::file(&origin, problem))?;
        let mut scene = Self::from_toml(&text, path)?;
        scene.folder = path.parent().map(Path::to_path_buf);
        Ok(scene)
    }

    /// Lays one setting over the file: any dotted path of it, tables of a list by number from 0 or by name.
    ///
    /// The value is TOML; what is no TOML counts as a string, so `settings.pairs=none` needs no quotes. A parameter of
    /// the original program needs no table: `n=50` is `parameters.n=50`.
    ///
    /// # Errors
    /// As for a file, with the setting in place of line and column; the scene is as it was.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), SceneError> {
        self.set_all(&[(key, value)])
    }

    /// Lays several settings over the file, as [`Self::set`] does one after the other, and reads it once.
    ///
    /// # Errors
    /// As for [`Self::set`]; the scene is as it was.
    pub fn set_all(&mut self, settings: &[(&str, &str)]) -> Result<(), SceneError> {
        let mut document = self.document.clone();
        for (key, value) in settings {
            document.lay_over(key, value);
        }
        self.file = document.read()?;
        self.document = document;
        Ok(())
    }

    /// Makes the world and its look.
    ///
    /// # Errors
    /// Values that geometry, dynamics or pictures refuse, names of materials that are not there, populations that do not
    /// fit: with the place in the file.
    pub fn build(&self) -> Result<Built, SceneError> {
        crate::build::build(self)
    }

    /// An error about the longest stretch between two looks at the world, with its place in the file.
    #[must_use]
    pub fn tick_error(&self, reason: impl Into<String>) -> SceneError {
        let field = if self.file.parameters.delta.is_some() {
            FieldPath::root("parameters").key("delta")
        } else {
            FieldPath::root("settings").key("tick")
        };
        self.document.error(&field, Problem::Refused(reason.into()))
    }

    /// The scene's name: the file's `name`, else what it was read from.
    #[must_use]
    pub fn name(&self) -> &str {
        self.file.name.as_deref().unwrap_or(&self.document.origin)
    }

    /// What the scene shows, in a sentence or two; may be empty.
    #[must_use]
    pub fn description(&self) -> &str {
        &self.file.description
    }
}

fn read_text(path: &Path) -> Result<String, Problem> {
    String::from_utf8(read_bytes(path)?).map_err(|error| {
        let offset = error.utf8_error().valid_up_to();
        Problem::NotText {
            offset,
            byte: error.as_bytes().get(offset).copied().unwrap_or_default(),
        }
    })
}

/// A whole file of at most [`MAX_BYTES`].
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    read_file(path, MAX_BYTES).map_err(|error| match error {
        ReadError::Io(error) => match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory => Problem::Missing,
            ErrorKind::IsADirectory => Problem::Folder,
            _ => Problem::Io(error),
        },
        ReadError::TooLarge { bytes, limit } => Problem::TooLarge { bytes, limit },
        other => Problem::Io(other.into()),
    })
}
