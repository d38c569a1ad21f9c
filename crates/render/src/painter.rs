//! Painting frame after frame: what did not change is not painted again.

use crate::diff::{self, Found};
use crate::paint::{Base, Sheets};
use crate::tiles::Tiles;
use crate::{Colour, Frame, Picture, PixelBox, Size, Style};

/// Rows of pixels in a band, the unit in which [`Changes`] tells an encoder what to write again.
pub const BAND: u32 = 16;

/// Which rasteriser turns marks into pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// The crate's own exact-area rasteriser; text, dashes, lines with corners and self-intersecting outlines go to
    /// tiny-skia.
    #[default]
    Own,
    /// tiny-skia for every mark: an independent picture to compare with.
    TinySkia,
}

/// Paints one frame after another into a picture, and leaves alone what did not change.
///
/// Marks at the beginning of the list with a [`Source`](crate::Source) that is not awake are painted once, into a layer
/// of their own. Of the rest, the tiles that changed are painted again over the layer. The picture is byte for byte the
/// one that [`Frame::paint`] makes, and [`Painter::checking`] shows it.
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
/// frame.push(Op::Dot { centre: vec2(150.0, 50.0), radius: 10.0, ink: Ink::Text });
/// let changes = painter.paint(&frame, &mut picture);
/// assert_eq!(changes.bounds().map(|bounds| bounds.left >= 128), Some(true));
/// # Ok::<(), carom_render::RenderError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Painter {
    style: Style,
    engine: Engine,
    redraw: bool,
    /// How many pixels differed from frames painted in full; `None`: unchecked.
    check: Option<u64>,
    /// What the picture shows now, and how many of its marks lie in the layer.
    shown: Option<(Frame, usize)>,
    layer: Vec<u8>,
    sheets: Sheets,
    /// Tiles of the layer and of the picture that are painted again.
    below: Tiles,
    tiles: Tiles,
    changes: Changes,
    /// How the frame differs from the one shown.
    found: Found,
    /// Frames that are painted in full before the next comparison, and how many the last such stretch had.
    busy: (u32, u32),
}

/// Most frames painted in full without a look at what they have in common.
const BUSY: u32 = 16;

impl Painter {
    /// A painter that has painted nothing yet.
    #[must_use]
    pub fn new(style: Style) -> Self {
        Self {
            style,
            engine: Engine::Own,
            redraw: false,
            check: None,
            shown: None,
            layer: Vec::new(),
            sheets: Sheets::default(),
            below: Tiles::default(),
            tiles: Tiles::default(),
            changes: Changes::default(),
            found: Found::default(),
            busy: (0, 0),
        }
    }

    /// The same with another engine; [`Engine::TinySkia`] paints every frame in full.
    #[must_use]
    pub fn with_engine(mut self, engine: Engine) -> Self {
        self.engine = engine;
        self.shown = None;
        self
    }

    /// The same, painting every frame in full.
    #[must_use]
    pub fn redrawing(mut self) -> Self {
        self.redraw = true;
        self
    }

    /// The same, painting every frame a second time in full to compare: see [`Painter::differing`].
    #[must_use]
    pub fn checking(mut self) -> Self {
        self.check = Some(0);
        self
    }

    /// Its style.
    #[must_use]
    pub const fn style(&self) -> &Style {
        &self.style
    }

    /// Pixels so far that differed from the frame painted in full. Anything but 0 is a fault of this crate; only a painter
    /// that is [`checking`](Painter::checking) counts them.
    #[must_use]
    pub fn differing(&self) -> u64 {
        self.check.unwrap_or(0)
    }

    /// Paints `frame` into `picture`, which holds what this painter painted last, and says what may have changed.
    ///
    /// A picture of another size than the frame's is taken for a new one.
    pub fn paint(&mut self, frame: &Frame, picture: &mut Picture) -> &Changes {
        if self.engine == Engine::TinySkia {
            crate::paint::paint(frame, &self.style, self.engine, picture);
            self.changes.all(frame.size());
            return &self.changes;
        }
        let known = picture.size() == frame.size();
        let beneath = frame.beneath();
        picture.shape(frame.size());
        match self.shown.take() {
            Some((mut shown, sunk)) if known && !self.redraw && shown.size() == frame.size() => {
                self.update((&shown, sunk), (frame, beneath), picture.rgba_mut());
                // Where nearly all moves a comparison finds little: the next frames do without, twice as many each time.
                let most = self.tiles.most() && 4 * beneath < frame.ops().len();
                let stretch = if most {
                    BUSY.min(2 * self.busy.1 + 1)
                } else {
                    0
                };
                self.busy = (stretch, stretch);
                if !most {
                    self.found.renew(&mut shown, frame);
                    self.shown = Some((shown, beneath));
                }
            }
            _ => {
                self.anew((frame, beneath), picture.rgba_mut());
                self.busy.0 = self.busy.0.saturating_sub(1);
                let keep = !self.redraw && self.busy.0 == 0;
                self.shown = keep.then(|| (frame.snapshot(), beneath));
            }
        }
        self.compare(frame, picture);
        &self.changes
    }

    /// Paints all of a frame; its first `beneath` marks are not awake.
    fn anew(&mut self, (frame, beneath): (&Frame, usize), bytes: &mut [u8]) {
        let ground = Base::Colour(self.ground());
        let all = frame.ops().len();
        let (style, sheets) = (&self.style, &mut self.sheets);
        if self.redraw || beneath == 0 || self.busy.0 > 1 {
            sheets.paint(frame, 0..all, style, ground, bytes);
        } else {
            self.layer.resize(bytes.len(), 0);
            sheets.paint(frame, 0..beneath, style, ground, &mut self.layer);
            sheets.paint(frame, beneath..all, style, Base::Layer(&self.layer), bytes);
        }
        self.changes.all(frame.size());
    }

    /// Paints what differs from the frame shown; beside each frame stands how many of its first marks are not awake.
    fn update(
        &mut self,
        (old, sunk): (&Frame, usize),
        (frame, beneath): (&Frame, usize),
        bytes: &mut [u8],
    ) {
        let all = frame.ops().len();
        let ground = Base::Colour(self.ground());
        // Without marks there was no layer, and marks of which nothing is seen make none.
        if sunk == 0 {
            self.layer.clear();
        }
        let (style, sheets) = (&self.style, &mut self.sheets);
        let (below, tiles) = (&mut self.below, &mut self.tiles);
        below.start(frame.size());
        tiles.start(frame.size());
        let found = &mut self.found;
        found.start(frame.common(old));
        diff::mark((old, 0..sunk), (frame, 0..beneath), style, below, found);
        let rest = (old, sunk..old.ops().len());
        diff::mark(rest, (frame, beneath..all), style, tiles, found);
        tiles.unite(below);
        if found.is_same() || tiles.is_empty() {
            self.changes.none(frame.size());
            return;
        }
        let base = if beneath == 0 {
            ground
        } else {
            if self.layer.is_empty() || below.most() {
                self.layer.resize(bytes.len(), 0);
                sheets.paint(frame, 0..beneath, style, ground, &mut self.layer);
            } else {
                sheets.repaint(frame, 0..beneath, style, ground, (below, &mut self.layer));
            }
            Base::Layer(&self.layer)
        };
        if tiles.most() {
            sheets.paint(frame, beneath..all, style, base, bytes);
        } else {
            sheets.repaint(frame, beneath..all, style, base, (tiles, bytes));
        }
        self.changes.bounds = tiles.bands(&mut self.changes.bands);
    }

    const fn ground(&self) -> Colour {
        self.style.background.with_alpha(255)
    }

    /// Counts the pixels that differ from the frame painted in full, if that is checked.
    fn compare(&mut self, frame: &Frame, picture: &Picture) {
        if let Some(differing) = &mut self.check {
            let full = frame.paint(&self.style);
            let (ours, theirs) = (picture.rgba().chunks_exact(4), full.rgba().chunks_exact(4));
            *differing += ours
                .zip(theirs)
                .map(|(a, b)| u64::from(a != b))
                .sum::<u64>();
        }
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

#[cfg(test)]
#[path = "painter_tests.rs"]
mod tests;
