//! Answers what a world of rigid bodies looks like, as PNG, animated PNG, SVG, film or chart, without a screen.
//!
//! Three stages, each of use alone. A [`Camera`] maps metres to pixels and a [`Look`] is the appearance of bodies;
//! [`Frame::capture`] turns a world into a plain list of marks, which can as well be built by hand; a [`Style`]
//! paints the list to a [`Picture`], which goes to a file. No window, no font file, no clock: the same
//! frame gives the same bytes.
//!
//! ```text
//! World ─ Camera, Look ─► Frame ─ Style ─► Picture ─► PNG, Sequence, Animation, Film, Sheet
//! Chart ────────────────► Frame ─ Style ─► SVG
//! ```
//!
//! A frame may hold any numbers. Points that are not finite are left out, and marks are clipped near the canvas before
//! rasterisation; canvas sizes are checked before memory is taken; files appear whole or not at all.
//!
//! # Examples
//! ```
//! use carom_render::{Camera, Colour, Frame, Op, Paint, Style};
//! use carom_math::vec2;
//!
//! let camera = Camera::new(vec2(0.0, 0.0), 100.0, 200, 200)?;              // m, px/m, px
//! let mut frame = Frame::new(camera.size());
//! frame.push(Op::Disc {
//!     centre: camera.point(vec2(0.5, 0.5)),                                 // up and right of the middle
//!     radius: camera.length(0.25),
//!     paint: Paint::flat(Colour::hex(0x3FA796)),
//! });
//! let picture = frame.paint(&Style::light());
//! assert_eq!(picture.pixel(150, 50), Some(Colour::hex(0x3FA796)));
//! assert_eq!(picture.pixel(50, 150), Some(Colour::WHITE));
//! # Ok::<(), carom_render::RenderError>(())
//! ```

#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        clippy::cast_possible_truncation,
        reason = "tests compare exact results"
    )
)]

#[cfg(test)]
mod agreement_tests;
mod apng;
mod axis;
mod bands;
mod buffer;
mod camera;
mod capture;
mod chart;
mod clip;
mod colour;
mod deflate;
mod diff;
mod disk;
mod ends;
mod error;
mod face;
mod folder;
mod font;
mod frame;
mod glyphs;
#[cfg(test)]
mod golden_overlay_tests;
#[cfg(test)]
mod golden_tests;
mod huffman;
mod input;
mod label;
mod layout;
mod look;
mod manifest;
mod mark;
mod op;
mod output;
mod overlay;
mod own;
mod packer;
mod paint;
mod painter;
mod panels;
mod patch;
mod path;
mod picture;
mod png;
mod raster;
#[cfg(test)]
mod second_reader;
mod sequence;
mod sheet;
mod size;
mod skia;
mod standing;
mod stencil;
mod style;
mod svg;
mod tiles;
mod y4m;

pub use apng::Animation;
pub use axis::{Axis, Scale};
pub use buffer::Ground;
pub use camera::Camera;
pub use carom_dynamics as dynamics;
pub use carom_math as math;
pub use chart::{Chart, Marker, Names, Series};
pub use colour::{BODY_COLOURS, Colour};
pub use error::RenderError;
pub use face::{Face, MAX_FACE_SIDE};
pub use folder::{Existing, OutputFolder};
pub use frame::Frame;
pub use input::{ReadError, open_file, read_file};
pub use label::Label;
pub use look::{FIXED_COLOUR, KINEMATIC_COLOUR, Look};
pub use manifest::{Checksum, MANIFEST, Manifest};
pub use mark::{Mark, PixelBox, Source};
pub use op::{Op, Paint};
pub use output::{Draft, write_file};
pub use overlay::{FieldMark, Overlay, Trace};
pub use packer::Packer;
pub use painter::{BAND, Changes, Engine, Painter};
pub use panels::Panels;
pub use patch::Patch;
pub use picture::Picture;
pub use png::Packing;
pub use sequence::Sequence;
pub use sheet::Sheet;
pub use size::{FrameRate, MAX_PIXELS, MAX_RATE, MAX_SIDE, Size};
pub use style::{Ink, Style};
pub use y4m::{Chroma, Film};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
