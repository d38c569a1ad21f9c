//! Painting frame after frame: what did not change is not painted again.

use crate::{Frame, Picture, PixelBox, Size, Style};

/// Rows of pixels in a band, the unit in which [`Changes`] tells an encoder what to write again.
pub const BAND: u32 = 16;

/// Who turns marks into pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// The crate's own scan converter, exact in coverage; what it has no business with goes to tiny-skia.
    #[default]
    Own,
    /// tiny-skia for every mark: an independent picture to compare with.
    TinySkia,
}

/// Paints one frame after another into a picture, and leaves alone what did not change.
///
/// The picture is byte for byte the one that [`Frame::paint`] makes.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Frame, Ink, Op, Painter, Picture, Size, Style};
/// use carom_math::vec2;
///
/// let size = Size::new(200, 100)?;
/// let mut picture = Picture::new(size, Colour::WHITE);
/// let mut painter = Painter::new(Style::light());
/// let mut frame = Frame::new(size);
/// frame.push(Op::Dot { centre: vec2(30.0, 50.0), radius: 10.0, ink: Ink::Text });
/// assert!(!painter.paint(&frame, &mut picture).is_empty());
/// assert!(painter.paint(&frame, &mut picture).is_empty());         // the same frame again
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Painter {
    style: Style,
    engine: Engine,
    redraw: bool,
    /// What the picture shows now.
    shown: Option<Frame>,
    changes: Changes,
}

impl Painter {
    /// A painter that has painted nothing yet.
    #[must_use]
    pub fn new(style: Style) -> Self {
        Self {
            style,
            engine: Engine::Own,
            redraw: false,
            shown: None,
            changes: Changes::default(),
        }
    }

    /// The same with another engine.
    #[must_use]
    pub fn with_engine(mut self, engine: Engine) -> Self {
        self.engine = engine;
        self
    }

    /// The same, painting every frame in full; for comparison.
    #[must_use]
    pub fn redrawing(mut self) -> Self {
        self.redraw = true;
        self
    }

    /// Its style.
    #[must_use]
    pub const fn style(&self) -> &Style {
        &self.style
    }

    /// Paints `frame` into `picture`, which holds what this painter painted last, and says what may have changed.
    ///
    /// A picture of another size than the frame's is taken for a new one.
    pub fn paint(&mut self, frame: &Frame, picture: &mut Picture) -> &Changes {
        let same = self.shown.as_ref() == Some(frame) && picture.size() == frame.size();
        if same && !self.redraw {
            self.changes.none(frame.size());
        } else {
            picture.reset(frame.size(), self.style.background);
            crate::paint::paint(frame, &self.style, self.engine, picture);
            self.changes.all(frame.size());
            self.shown = Some(frame.clone());
        }
        &self.changes
    }
}

/// Which parts of a picture may differ from the one before, in bands of [`BAND`] rows.
///
/// It never says too little; it may say too much.
///
/// # Examples
/// ```
/// use carom_render::Changes;
/// assert!(Changes::default().is_empty());
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    bounds: Option<PixelBox>,
    bands: Vec<bool>,
}

impl Changes {
    /// Whether the picture is the one before: its file can be written again as it is.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.bounds.is_none()
    }

    /// The smallest rectangle around everything that may have changed; `None` if nothing did.
    #[must_use]
    pub const fn bounds(&self) -> Option<PixelBox> {
        self.bounds
    }

    /// Whether each band of [`BAND`] rows, from above, may have changed; the last may be lower.
    #[must_use]
    pub fn bands(&self) -> &[bool] {
        &self.bands
    }

    /// Number of bands that may have changed.
    #[must_use]
    pub fn count(&self) -> usize {
        self.bands.iter().filter(|&&band| band).count()
    }

    fn none(&mut self, size: Size) {
        self.bounds = None;
        self.bands.clear();
        self.bands
            .resize(size.height().div_ceil(BAND) as usize, false);
    }

    fn all(&mut self, size: Size) {
        self.bounds = Some(PixelBox::of(size));
        self.bands.clear();
        self.bands
            .resize(size.height().div_ceil(BAND) as usize, true);
    }
}
