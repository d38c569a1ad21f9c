//! Pictures of rigid bodies without a screen.

#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        clippy::cast_possible_truncation,
        reason = "tests compare exact results"
    )
)]

mod apng;
mod axis;
mod camera;
mod chart;
mod clip;
mod colour;
mod error;
mod face;
mod folder;
mod font;
mod frame;
mod glyphs;
mod output;
mod paint;
mod picture;
mod png;
mod sequence;
mod sheet;
mod size;
mod style;
mod svg;
mod y4m;

pub use apng::Animation;
pub use axis::{Axis, Scale};
pub use camera::Camera;
pub use chart::{Chart, Marker, Series};
pub use colour::{BODY_COLOURS, Colour};
pub use error::RenderError;
pub use face::{Face, MAX_FACE_SIDE};
pub use folder::{Existing, MANIFEST, OutputFolder};
pub use frame::{Frame, Label, Op, Paint};
pub use output::write_file;
pub use picture::Picture;
pub use png::Packing;
pub use sequence::Sequence;
pub use sheet::Sheet;
pub use size::{FrameRate, MAX_PIXELS, MAX_RATE, MAX_SIDE, Size};
pub use style::{Ink, Style};
pub use y4m::{Chroma, Film};
