//! Moving pictures as animated PNG, written frame by frame.
//!
//! A frame of an APNG is the packed data of its PNG under another chunk name, so finished PNG frames are joined without being
//! packed again: workers encode, one file collects. The number of frames stands near the start of the file and is written there at the end.

use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

use crate::output::Draft;
use crate::{FrameRate, Packing, Picture, RenderError, Size};

/// Place of the animation's control chunk: after the signature (8 bytes) and the header (25).
const CONTROL_AT: u64 = 33;

const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

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
    path: std::path::PathBuf,
    size: Size,
    rate: FrameRate,
    frames: u64,
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
            frames: 0,
            sequence: 0,
        };
        film.draft.append(&SIGNATURE)?;
        let mut header = [0; 13];
        header[..4].copy_from_slice(&size.width().to_be_bytes());
        header[4..8].copy_from_slice(&size.height().to_be_bytes());
        header[8..].copy_from_slice(&[8, 2, 0, 0, 0]); // 8 bits, RGB, deflate, adaptive filters, not interlaced
        film.draft.append(&chunk(*b"IHDR", &[&header]))?;
        film.draft.append(&control(0))?;
        Ok(film)
    }

    /// Appends a picture.
    ///
    /// # Errors
    /// [`RenderError::SizeChanged`] if its size is not the animation's, [`RenderError::Io`] if the disk is full.
    pub fn push(&mut self, picture: &Picture) -> Result<(), RenderError> {
        self.check(picture.size())?;
        self.append(&picture.to_png_packed(Packing::Fast))
    }

    /// Appends a picture that [`Picture::to_png`] encoded before, perhaps on another thread.
    ///
    /// # Errors
    /// As [`Animation::push`]; [`RenderError::Decode`] if the bytes are no PNG in RGB with 8 bits.
    pub fn push_png(&mut self, png: &[u8]) -> Result<(), RenderError> {
        let wrong = |reason: &str| RenderError::Decode {
            reason: reason.to_owned(),
        };
        let header = png
            .strip_prefix(&SIGNATURE)
            .and_then(|rest| rest.get(8..21))
            .ok_or_else(|| wrong("no PNG header"))?;
        if header[8..] != [8, 2, 0, 0, 0] {
            return Err(wrong("an animation takes plain RGB with 8 bits"));
        }
        let side = |at: usize| {
            u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]])
        };
        self.check(Size::new(side(0), side(4))?)?;
        if image_data(png).next().is_none() {
            return Err(wrong("no image data"));
        }
        self.append(png)
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
        self.draft.append(&chunk(*b"IEND", &[]))?;
        // 2^32 frames would take years to play.
        let count = u32::try_from(self.frames).unwrap_or(u32::MAX);
        if let Some(file) = self.draft.file()? {
            file.seek(SeekFrom::Start(CONTROL_AT))
                .and_then(|_| file.write_all(&control(count)))
                .map_err(RenderError::io("write", &self.path))?;
        }
        self.draft.finish()?;
        Ok(self.frames)
    }

    fn check(&self, found: Size) -> Result<(), RenderError> {
        if found == self.size {
            return Ok(());
        }
        Err(RenderError::SizeChanged {
            index: self.frames,
            expected: self.size,
            found,
        })
    }

    /// Frame control, then the picture's data: IDAT in the first frame, fdAT with a number in the others.
    fn append(&mut self, png: &[u8]) -> Result<(), RenderError> {
        let mut out = Vec::with_capacity(png.len() + 64);
        let mut frame = [0; 26];
        frame[..4].copy_from_slice(&self.next_number());
        frame[4..8].copy_from_slice(&self.size.width().to_be_bytes());
        frame[8..12].copy_from_slice(&self.size.height().to_be_bytes());
        // Offsets stay 0; shown for 1 / rate seconds, left in place, replaced as a whole.
        frame[20..22].copy_from_slice(&1_u16.to_be_bytes());
        frame[22..24].copy_from_slice(&self.rate.get().to_be_bytes());
        out.extend(chunk(*b"fcTL", &[&frame]));
        for data in image_data(png) {
            if self.frames == 0 {
                out.extend(chunk(*b"IDAT", &[data]));
            } else {
                let number = self.next_number();
                out.extend(chunk(*b"fdAT", &[&number, data]));
            }
        }
        self.draft.append(&out)?;
        self.frames += 1;
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
    chunk(*b"acTL", &[&frames.to_be_bytes(), &[0; 4]])
}

/// A PNG chunk: length, name, data, checksum of name and data.
fn chunk(name: [u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let length: usize = parts.iter().map(|part| part.len()).sum();
    let mut out = Vec::with_capacity(length + 12);
    // A frame of 64 Mi pixels packs to less than 2^31 bytes.
    out.extend(u32::try_from(length).unwrap_or(u32::MAX).to_be_bytes());
    out.extend(name);
    for part in parts {
        out.extend_from_slice(part);
    }
    let sum = crc32fast::hash(&out[4..]);
    out.extend(sum.to_be_bytes());
    out
}

/// Data of the IDAT chunks of a PNG, in order.
fn image_data(png: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = png.get(8..).unwrap_or_default();
    core::iter::from_fn(move || {
        loop {
            let (head, body) = rest.split_at_checked(8)?;
            let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
            let (data, after) = body.split_at_checked(length)?;
            rest = after.get(4..).unwrap_or_default();
            if head[4..] == *b"IDAT" {
                return Some(data);
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Colour;
    use std::fs;

    fn size() -> Size {
        Size::new(20, 10).unwrap()
    }

    fn shade(i: u8) -> Picture {
        Picture::new(size(), Colour::rgb(i, 2 * i, 255 - i))
    }

    #[test]
    fn frames_and_delays_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.png");
        let mut film =
            Animation::create(&path, size(), FrameRate::per_second(30).unwrap()).unwrap();
        for i in 0..7 {
            if i % 2 == 0 {
                film.push(&shade(i)).unwrap();
            } else {
                film.push_png(&shade(i).to_png()).unwrap();
            }
        }
        assert!(
            !path.exists(),
            "the file has its name only when it is whole"
        );
        assert_eq!(film.finish().unwrap(), 7);

        let bytes = fs::read(&path).unwrap();
        let mut decoder = ::png::Decoder::new(std::io::Cursor::new(&bytes));
        decoder.set_ignore_text_chunk(true);
        let mut reader = decoder.read_info().unwrap();
        let control = *reader.info().animation_control().unwrap();
        assert_eq!((control.num_frames, control.num_plays), (7, 0));
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        for i in 0..7 {
            reader.next_frame(&mut rgb).unwrap();
            let frame = *reader.info().frame_control().unwrap();
            assert_eq!((frame.delay_num, frame.delay_den), (1, 30));
            assert_eq!(rgb, shade(i).to_rgb(), "frame {i}");
        }
        assert!(
            reader.next_frame(&mut rgb).is_err(),
            "seven frames and no more"
        );
        // The first frame alone is what a plain PNG reader sees.
        assert_eq!(Picture::from_png(&bytes).unwrap(), shade(0));
    }

    #[test]
    fn nothing_is_left_of_a_film_without_frames() {
        let folder = tempfile::tempdir().unwrap();
        let film = Animation::create(
            folder.path().join("film.png"),
            size(),
            FrameRate::per_second(1).unwrap(),
        );
        assert!(matches!(film.unwrap().finish(), Err(RenderError::NoFrames)));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn other_sizes_and_other_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.png");
        let mut film = Animation::create(&path, size(), FrameRate::per_second(1).unwrap()).unwrap();
        film.push(&shade(1)).unwrap();
        let other = Picture::new(Size::new(10, 20).unwrap(), Colour::WHITE);
        let error = film.push(&other).unwrap_err();
        assert_eq!(
            error.to_string(),
            "frame 1 is 10 x 20 px, the frames before it are 20 x 10 px"
        );
        assert!(film.push_png(&other.to_png()).is_err());
        for cut in [0, 8, 20, 33, 40] {
            assert!(
                film.push_png(&shade(1).to_png()[..cut]).is_err(),
                "{cut} bytes"
            );
        }
        drop(film);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
