//! What can go wrong between a world and a file.

use std::io;
use std::path::{Path, PathBuf};

use crate::{MAX_PIXELS, MAX_RATE, MAX_SIDE};

/// Why a camera, a picture, a face or an output was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A number that places something is NaN or infinite.
    #[error("{name} is {value}: it must be finite")]
    NotFinite {
        /// Which number.
        name: &'static str,
        /// What it was.
        value: f64,
    },

    /// A camera scale, in pixels per metre, is zero, negative or not finite.
    #[error("camera scale is {value} px/m: it must be positive and finite")]
    Scale {
        /// What it was, in pixels per metre.
        value: f64,
    },

    /// A camera was asked to show a box without extent.
    #[error("camera cannot fit an empty box of {width} m x {height} m")]
    EmptyBounds {
        /// Width of the box, in metres.
        width: f64,
        /// Height of the box, in metres.
        height: f64,
    },

    /// A canvas has no pixels.
    #[error("canvas of {width} x {height} px has no pixels")]
    NoPixels {
        /// Width, in pixels.
        width: u32,
        /// Height, in pixels.
        height: u32,
    },

    /// A canvas is larger than what is drawn.
    #[error(
        "canvas of {width} x {height} px is over the limit of {MAX_SIDE} px a side and {MAX_PIXELS} px in all"
    )]
    TooLarge {
        /// Width, in pixels.
        width: u32,
        /// Height, in pixels.
        height: u32,
    },

    /// A frame rate is zero or higher than what an animation can hold.
    #[error("frame rate is {value} per second: it must lie in 1..={MAX_RATE}")]
    FrameRate {
        /// What it was, in frames per second.
        value: u32,
    },

    /// A text is no colour.
    #[error("'{text}' is no colour: write #rrggbb or #rrggbbaa")]
    Colour {
        /// The text.
        text: String,
    },

    /// An animation or a sheet was finished without a picture.
    #[error("no frame was added")]
    NoFrames,

    /// An animation began with a patch of a picture that it has not seen.
    #[error("the first frame of an animation must be a whole picture")]
    NoWhole,

    /// A picture does not have the size of those before it.
    #[error("frame {index} is {found} px, the frames before it are {expected} px")]
    SizeChanged {
        /// Number of the frame, from 0.
        index: u64,
        /// Size of the frames before it.
        expected: crate::Size,
        /// Size of this frame.
        found: crate::Size,
    },

    /// A world does not know where a body was at an instant.
    #[error(
        "where a body was at {time} s is not known: that is to come, or before its last change and no history is kept"
    )]
    Instant {
        /// The instant, in seconds.
        time: f64,
    },

    /// Bytes are no PNG that can be read.
    #[error("not a readable PNG: {reason}")]
    Decode {
        /// What the decoder found.
        reason: String,
    },

    /// A picture given as bytes has another number of bytes than its size says.
    #[error("a picture of {size} px takes {expected} bytes of RGBA, not {found}")]
    Bytes {
        /// Size of the picture.
        size: crate::Size,
        /// Bytes that it takes.
        expected: usize,
        /// Bytes that were given.
        found: usize,
    },

    /// A file or a folder could not be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried, as a verb.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system answered.
        source: io::Error,
    },

    /// The output folder is a file.
    #[error("{} is a file, not a folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },

    /// The output folder holds frames already.
    #[error("{} already holds {what}: choose another folder or force the replacement", folder.display())]
    Occupied {
        /// The folder.
        folder: PathBuf,
        /// The first thing found there.
        what: String,
    },

    /// A file that we did not write stands where an output would go.
    #[error("{} was not written by carom: move it away or choose another folder", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },

    /// A file that we wrote was changed since.
    #[error("{} is not as carom wrote it: move it away or choose another folder", path.display())]
    Edited {
        /// The file.
        path: PathBuf,
    },

    /// The folder belongs to a run with other parameters.
    #[error("{} holds another run ('{found}', not '{wanted}'): it cannot be resumed", folder.display())]
    OtherRun {
        /// The folder.
        folder: PathBuf,
        /// How the run there describes itself.
        found: String,
        /// How this run describes itself.
        wanted: String,
    },

    /// Another process writes into the folder.
    #[error("{} is in use by another run", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
    },

    /// An output name is no plain file name.
    #[error("'{name}' is no plain file name")]
    Name {
        /// The name.
        name: String,
    },
}

impl RenderError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |source| Self::Io {
            action,
            path,
            source,
        }
    }
}
