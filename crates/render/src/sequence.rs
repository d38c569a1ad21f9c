//! Numbered frames in a folder.

use std::path::{Path, PathBuf};

use crate::{Existing, OutputFolder, Picture, RenderError};

/// A folder of frames `frame_00000.png`, `frame_00001.png`, … and the other outputs of a run.
///
/// Frames may be saved from several threads and in any order; each appears whole or not at all.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Existing, Picture, Sequence, Size};
/// # let root = tempfile::tempdir()?;
/// # let folder = root.path().join("frames");
/// let picture = Picture::new(Size::new(8, 8)?, Colour::WHITE);
/// let frames = Sequence::create(&folder, Existing::Refuse, "white 8x8")?;
/// frames.save(0, &picture)?;
/// assert!(folder.join("frame_00000.png").exists());
/// drop(frames);
/// assert!(Sequence::create(&folder, Existing::Refuse, "white 8x8").is_err());
/// assert!(Sequence::create(&folder, Existing::Resume, "white 8x8")?.has(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Sequence {
    folder: OutputFolder,
}

impl Sequence {
    /// Opens the folder for frames of the run that `about` describes in one line.
    ///
    /// # Errors
    /// As [`OutputFolder::open`].
    pub fn create(
        path: impl AsRef<Path>,
        existing: Existing,
        about: &str,
    ) -> Result<Self, RenderError> {
        let folder = OutputFolder::open(path, existing, about)?;
        Ok(Self { folder })
    }

    /// The folder, for charts and films beside the frames.
    #[must_use]
    pub const fn folder(&self) -> &OutputFolder {
        &self.folder
    }

    /// File name of frame `index`: five digits, more from 100,000 on.
    #[must_use]
    pub fn name(index: u64) -> String {
        format!("frame_{index:05}.png")
    }

    /// File name of frame `index` as a drawing.
    #[must_use]
    pub fn svg_name(index: u64) -> String {
        format!("frame_{index:05}.svg")
    }

    /// Path of frame `index`.
    #[must_use]
    pub fn path(&self, index: u64) -> PathBuf {
        self.folder.path().join(Self::name(index))
    }

    /// Whether frame `index` is there and whole.
    #[must_use]
    pub fn has(&self, index: u64) -> bool {
        self.folder.has(&Self::name(index))
    }

    /// Saves a picture as frame `index`.
    ///
    /// # Errors
    /// As [`OutputFolder::save`].
    pub fn save(&self, index: u64, picture: &Picture) -> Result<(), RenderError> {
        self.save_png(index, &picture.to_png())
    }

    /// Saves a picture that was encoded before.
    ///
    /// # Errors
    /// As [`OutputFolder::save`].
    pub fn save_png(&self, index: u64, png: &[u8]) -> Result<(), RenderError> {
        self.folder.save(&Self::name(index), png)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Colour, Size};
    use std::fs;

    fn picture() -> Picture {
        Picture::new(Size::new(4, 4).unwrap(), Colour::BLACK)
    }

    #[test]
    fn frames_of_others_are_never_replaced() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("frame_00003.png"), "a photograph").unwrap();
        for existing in [Existing::Refuse, Existing::Replace, Existing::Resume] {
            let error = Sequence::create(root.path(), existing, "run").unwrap_err();
            assert!(
                error.to_string().contains("frame_00003.png"),
                "{existing:?}: {error}"
            );
        }
        assert_eq!(
            fs::read_to_string(root.path().join("frame_00003.png")).unwrap(),
            "a photograph"
        );
    }

    #[test]
    fn a_run_goes_on_where_it_stopped() {
        let root = tempfile::tempdir().unwrap();
        let frames = Sequence::create(root.path(), Existing::Refuse, "run").unwrap();
        for index in [0, 1, 4] {
            frames.save(index, &picture()).unwrap();
        }
        // Killed in the middle of frame 2: listed, but only its temporary file is there.
        let place = frames.folder().claim(&Sequence::name(2)).unwrap();
        let torn = crate::output::temporary_name(&place);
        drop(frames);
        fs::write(&torn, "half").unwrap();

        let error = Sequence::create(root.path(), Existing::Resume, "another run").unwrap_err();
        assert!(matches!(error, RenderError::OtherRun { .. }), "{error}");
        let frames = Sequence::create(root.path(), Existing::Resume, "run").unwrap();
        let there: Vec<u64> = (0..6).filter(|&i| frames.has(i)).collect();
        assert_eq!(there, [0, 1, 4]);
        frames.save(2, &picture()).unwrap();
        assert!(!torn.exists());
        assert_eq!(
            fs::read(frames.path(2)).unwrap(),
            fs::read(frames.path(0)).unwrap()
        );
    }

    #[test]
    fn many_threads_save_into_one_folder() {
        let root = tempfile::tempdir().unwrap();
        let frames = Sequence::create(root.path(), Existing::Refuse, "run").unwrap();
        std::thread::scope(|scope| {
            for thread in 0..4_u64 {
                let frames = &frames;
                scope.spawn(move || {
                    for i in 0..10 {
                        frames.save(4 * i + thread, &picture()).unwrap();
                    }
                });
            }
        });
        assert!((0..40).all(|i| frames.has(i)));
        assert_eq!(frames.folder().names().len(), 40);
    }

    #[test]
    fn a_frame_that_fails_leaves_nothing() {
        let root = tempfile::tempdir().unwrap();
        let frames = Sequence::create(root.path(), Existing::Refuse, "run").unwrap();
        frames.save(0, &picture()).unwrap();
        fs::create_dir(frames.path(1)).unwrap();
        assert!(frames.save(1, &picture()).is_err());
        let mut names: Vec<_> = fs::read_dir(root.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(
            names,
            ["frame_00000.png", "frame_00001.png", "manifest.txt"]
        );
    }

    #[test]
    fn names_sort_like_numbers() {
        assert_eq!(Sequence::name(7), "frame_00007.png");
        assert_eq!(Sequence::name(123_456), "frame_123456.png");
        assert!(crate::folder::is_frame(&Sequence::name(123_456)));
        assert!(
            !crate::folder::is_frame("frame_1.png") && !crate::folder::is_frame("frame_abcde.png")
        );
    }
}
