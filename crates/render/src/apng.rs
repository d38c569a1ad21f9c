//! Moving pictures as animated PNG, written frame by frame.
//!
//! A frame holds the smallest rectangle that changed, packed both ways that the format offers, and the shorter is kept: as it is
//! (*source*), or with every pixel that stayed the same transparent (*over*). A picture that is shown again only lasts longer.
//! Workers make the patches, one file collects them. The number of frames stands near the start of the file and is written at the end.

use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::output::Draft;
use crate::patch::{Blend, Patch};
use crate::png::chunk;
use crate::{FrameRate, Packing, Picture, RenderError, Size};

/// Place of the animation's control chunk: after the signature (8 bytes) and the header (25).
const CONTROL_AT: u64 = 33;

/// An animated PNG under construction; it plays forever at a constant rate.
///
/// Dropping it without [`Animation::finish`] leaves no file.
///
/// # Examples
/// ```
/// use carom_render::{Animation, Colour, FrameRate, Picture, Size};
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("film.png");
/// let size = Size::new(16, 16)?;
/// let mut film = Animation::create(&path, size, FrameRate::per_second(25)?)?;
/// film.push(&Picture::new(size, Colour::BLACK))?;
/// film.push(&Picture::new(size, Colour::WHITE))?;
/// assert_eq!(film.finish()?, 2);                                        // frames
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Animation {
    draft: Draft,
    path: PathBuf,
    size: Size,
    rate: FrameRate,
    packing: Packing,
    frames: u64,
    /// What [`Animation::push`] showed last.
    shown: Option<Picture>,
    /// The last patch, and for how many frames it has been shown: not in the file yet.
    waiting: Option<(Patch, u16)>,
    /// Patches in the file.
    stored: u32,
    /// Control and data chunks of an animation are numbered together.
    sequence: u32,
}

impl Animation {
    /// Opens the file, under a temporary name until it is finished.
    ///
    /// # Errors
    /// [`RenderError::Io`] if the folder cannot be written to.
    pub fn create(
        path: impl AsRef<Path>,
        size: Size,
        rate: FrameRate,
    ) -> Result<Self, RenderError> {
        let path = path.as_ref();
        let mut film = Self {
            draft: Draft::create(path)?,
            path: path.to_path_buf(),
            size,
            rate,
            packing: Packing::default(),
            frames: 0,
            shown: None,
            waiting: None,
            stored: 0,
            sequence: 0,
        };
        film.draft.append(&crate::png::SIGNATURE)?;
        let mut header = [0; 13];
        header[..4].copy_from_slice(&size.width().to_be_bytes());
        header[4..8].copy_from_slice(&size.height().to_be_bytes());
        header[8..].copy_from_slice(&[8, 6, 0, 0, 0]); // 8 bits, RGBA, deflate, adaptive filters, not interlaced
        film.draft.append(&whole(*b"IHDR", &[&header]))?;
        film.draft.append(&control(0))?;
        Ok(film)
    }

    /// The same, with what [`Animation::push`] appends packed like this.
    #[must_use]
    pub fn packed(self, packing: Packing) -> Self {
        Self { packing, ..self }
    }

    /// Appends a picture.
    ///
    /// # Errors
    /// [`RenderError::SizeChanged`] if its size is not the animation's, [`RenderError::Io`] if the disk is full.
    pub fn push(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let patch = Patch::between(self.shown.as_ref(), picture, self.packing);
        self.push_patch(patch)?;
        self.shown = Some(picture.clone());
        Ok(())
    }

    /// Appends what changed since the picture before, perhaps found on another thread.
    ///
    /// # Errors
    /// As [`Animation::push`]; [`RenderError::NoWhole`] if the first patch is no whole picture.
    pub fn push_patch(&mut self, patch: Patch) -> Result<(), RenderError> {
        if patch.canvas() != self.size {
            return Err(RenderError::SizeChanged {
                index: self.frames,
                expected: self.size,
                found: patch.canvas(),
            });
        }
        if self.frames == 0 && !patch.is_whole() {
            return Err(RenderError::NoWhole);
        }
        // A picture that comes next starts anew.
        self.shown = None;
        match &mut self.waiting {
            Some((_, shows)) if patch.is_empty() && *shows < u16::MAX => *shows += 1,
            _ => {
                self.store()?;
                self.waiting = Some((patch, 1));
            }
        }
        self.frames += 1;
        Ok(())
    }

    /// Frames so far.
    #[must_use]
    pub const fn frames(&self) -> u64 {
        self.frames
    }

    /// Writes the number of frames, gives the file its name and returns the number.
    ///
    /// # Errors
    /// [`RenderError::NoFrames`] if there is none (and no file then), [`RenderError::Io`] from the disk.
    pub fn finish(mut self) -> Result<u64, RenderError> {
        if self.frames == 0 {
            return Err(RenderError::NoFrames);
        }
        self.store()?;
        self.draft.append(&whole(*b"IEND", &[]))?;
        let count = self.stored;
        if let Some(file) = self.draft.file()? {
            file.seek(SeekFrom::Start(CONTROL_AT))
                .and_then(|_| file.write_all(&control(count)))
                .map_err(RenderError::io("write", &self.path))?;
        }
        self.draft.finish()?;
        Ok(self.frames)
    }

    /// The patch that waits: its frame control, then its data, IDAT in the first frame, fdAT with a number in the others.
    fn store(&mut self) -> Result<(), RenderError> {
        let Some((patch, shows)) = self.waiting.take() else {
            return Ok(());
        };
        let place = patch.place();
        let mut frame = [0; 26];
        frame[..4].copy_from_slice(&self.next_number());
        let corner = [
            place.right - place.left,
            place.bottom - place.top,
            place.left,
            place.top,
        ];
        for (bytes, value) in frame[4..20].chunks_exact_mut(4).zip(corner) {
            bytes.copy_from_slice(&value.to_be_bytes());
        }
        // Shown for so many times 1 / rate seconds, and left in place.
        frame[20..22].copy_from_slice(&shows.to_be_bytes());
        frame[22..24].copy_from_slice(&self.rate.get().to_be_bytes());
        frame[25] = u8::from(patch.blend() == Blend::Over);
        self.draft.append(&whole(*b"fcTL", &[&frame]))?;
        if self.stored == 0 {
            self.draft.append(&whole(*b"IDAT", &[patch.data()]))?;
        } else {
            let number = self.next_number();
            self.draft
                .append(&whole(*b"fdAT", &[&number, patch.data()]))?;
        }
        // 2^32 frames would take years to play.
        self.stored = self.stored.wrapping_add(1);
        Ok(())
    }

    fn next_number(&mut self) -> [u8; 4] {
        let number = self.sequence.to_be_bytes();
        self.sequence = self.sequence.wrapping_add(1);
        number
    }
}

/// The animation's control chunk: number of frames, played forever.
fn control(frames: u32) -> Vec<u8> {
    whole(*b"acTL", &[&frames.to_be_bytes(), &[0; 4]])
}

/// A chunk by itself.
fn whole(name: [u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let mut out = Vec::new();
    chunk(name, parts, &mut out);
    out
}

#[cfg(test)]
#[path = "apng_tests.rs"]
mod tests;
