//! From marks to paths, for tiny-skia to fill.
//!
//! Everything is cut in `f64` first ([`clip`](crate::clip)); strokes become outlines that are filled, whatever their
//! width, because tiny-skia's own hairlines jump in brightness at one pixel.

use carom_math::{Rot, Vec2};
use tiny_skia::{
    Color, FillRule, FilterQuality, GradientStop, LineCap, LineJoin, Path, PathBuilder,
    PathStroker, Pattern, PixmapMut, PixmapRef, Point, RadialGradient, Shader, SpreadMode, Stroke,
    Transform,
};

use crate::camera::narrow;
use crate::clip::{Cover, Window};
use crate::colour::round_u8;
use crate::op::{arrow_outline, box_ring};
use crate::path::{push, push_circle, push_dashes};
use crate::style::shade;
use crate::{Colour, Face, Ink, Label, Op, Size, Style, font};

/// Widest stroke, in pixels; wider ones are drawn as wide as this.
pub(crate) const MAX_STROKE: f64 = 256.0;

/// Room around the canvas that marks are cut to, in pixels: half the widest stroke, and as much again.
const MARGIN: f64 = 256.0;

/// Discs up to this radius, in pixels, go to the rasteriser as circles, larger ones as the arc that is seen.
const LARGE_DISC: f64 = 2048.0;

/// The shading of a ball, in radii: full colour up to `INNER` around a point moved by `SHIFT` in x and y, a third
/// of the colour at `OUTER` (the flying balls' own numbers).
pub(crate) const INNER: f64 = 0.2;
pub(crate) const OUTER: f64 = 1.3;
pub(crate) const SHIFT: f64 = -0.2;

/// What a path is filled with.
pub(crate) enum Fill<'a> {
    /// One colour.
    Flat(Colour),
    /// A disc shaded as a ball.
    Ball(Vec2, f64, Colour),
    /// A picture, placed.
    Face(PixmapRef<'a>, Transform),
}

/// What paths are filled on.
pub(crate) trait Ground {
    /// Fills what a path winds around.
    fn fill(&mut self, path: &Path, fill: &Fill<'_>);
}

impl Ground for PixmapMut<'_> {
    fn fill(&mut self, path: &Path, fill: &Fill<'_>) {
        let paint = tiny_skia::Paint {
            shader: match *fill {
                Fill::Flat(colour) => flat(colour),
                Fill::Ball(centre, radius, colour) => ball(centre, radius, colour),
                Fill::Face(pixels, place) => {
                    Pattern::new(pixels, SpreadMode::Pad, FilterQuality::Bilinear, 1.0, place)
                }
            },
            anti_alias: true,
            ..tiny_skia::Paint::default()
        };
        self.fill_path(path, &paint, FillRule::Winding, Transform::identity(), None);
    }
}

/// Memory for paths, used from mark to mark.
#[derive(Clone, Default)]
pub(crate) struct Paths {
    stroker: PathStroker,
    builder: PathBuilder,
    ring: Vec<Vec2>,
    spare: Vec<Vec2>,
    line: Vec<Vec2>,
}

impl core::fmt::Debug for Paths {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Paths").finish_non_exhaustive()
    }
}

/// Turns marks into paths and fills them on `ground`, a canvas of `size`.
pub(crate) struct Pen<'a, G> {
    paths: &'a mut Paths,
    style: &'a Style,
    window: Window,
    ground: G,
}

impl<'a, G: Ground> Pen<'a, G> {
    pub(crate) fn new(paths: &'a mut Paths, style: &'a Style, size: Size, ground: G) -> Self {
        Self {
            paths,
            style,
            window: Window::new(size.corner(), MARGIN),
            ground,
        }
    }

    pub(crate) fn op(&mut self, op: &Op) {
        match op {
            Op::Polygon { points, paint } => {
                self.fill_ring(points, paint.fill);
                let outline = self.style.outline_for(*paint);
                self.outline_ring(points, self.style.outline, outline);
            }
            Op::Region { rings, paint } => {
                self.fill_rings(rings, paint.fill);
                let outline = self.style.outline_for(*paint);
                for ring in rings {
                    self.outline_ring(ring, self.style.outline, outline);
                }
            }
            Op::Disc {
                centre,
                radius,
                paint,
            } => {
                if paint.shaded {
                    self.fill_disc(*centre, *radius, Fill::Ball(*centre, *radius, paint.fill));
                } else {
                    self.fill_disc(*centre, *radius, Fill::Flat(paint.fill));
                }
                let outline = self.style.rim_for(*paint);
                self.ring(*centre, *radius, self.style.outline, outline);
            }
            Op::Area { points, ink } => self.fill_ring(points, self.style.colour(*ink)),
            Op::Dot {
                centre,
                radius,
                ink,
            } => self.fill_disc(*centre, *radius, Fill::Flat(self.style.colour(*ink))),
            Op::Ring {
                centre,
                radius,
                width,
                ink,
            } => self.ring(*centre, *radius, *width, self.style.colour(*ink)),
            Op::Line {
                points,
                width,
                dash,
                ink,
            } => self.polyline(points, *width, *dash, self.style.colour(*ink)),
            Op::Arrow {
                from,
                to,
                width,
                ink,
            } => {
                if let Some(outline) = arrow_outline(*from, *to, *width) {
                    self.fill_ring(&outline, self.style.colour(*ink));
                }
            }
            Op::Face {
                centre,
                radius,
                turn,
                face,
            } => self.face(*centre, *radius, *turn, face),
            Op::Box {
                min,
                max,
                fill,
                border,
                width,
                dash,
            } => self.rectangle(*min, *max, *fill, *border, *width, *dash),
            Op::Label(label) => self.label(label),
        }
    }

    pub(crate) fn fill_ring(&mut self, points: &[Vec2], colour: Colour) {
        if self.add_ring(points) {
            self.fill(&Fill::Flat(colour));
        }
    }

    pub(crate) fn fill_rings(&mut self, rings: &[Vec<Vec2>], colour: Colour) {
        // All of them are one path: the winding rule takes the holes out.
        let added = rings.iter().map(|ring| self.add_ring(ring));
        if added.fold(false, |any, one| any | one) {
            self.fill(&Fill::Flat(colour));
        }
    }

    /// Adds what is seen of a closed ring to the path; whether that is anything.
    fn add_ring(&mut self, points: &[Vec2]) -> bool {
        self.window
            .polygon(points, &mut self.paths.ring, &mut self.paths.spare);
        let seen = self.paths.ring.len() > 2;
        if seen {
            push(&mut self.paths.builder, &self.paths.ring, true);
        }
        seen
    }

    pub(crate) fn outline_ring(&mut self, points: &[Vec2], width: f64, colour: Colour) {
        if !points.iter().all(|&p| crate::clip::is_near(p)) {
            return;
        }
        let mut line = core::mem::take(&mut self.paths.line);
        line.clear();
        line.extend_from_slice(points);
        line.extend(points.first());
        self.polyline(&line, width, None, colour);
        self.paths.line = line;
    }

    /// A line through points; one that ends where it began is closed without caps.
    pub(crate) fn polyline(
        &mut self,
        points: &[Vec2],
        width: f64,
        dash: Option<f64>,
        colour: Colour,
    ) {
        let Some(width) = usable_width(width) else {
            return;
        };
        let (builder, spare) = (&mut self.paths.builder, &mut self.paths.spare);
        let closed = points.len() > 3 && points.first() == points.last();
        self.window.polyline(points, spare, |part| match dash {
            Some(dash) => push_dashes(builder, part, dash),
            None if closed && part.len() == points.len() => push(builder, &part[1..], true),
            None => push(builder, part, false),
        });
        // Dashes end flat, everything else round.
        let cap = if dash.is_some() {
            LineCap::Butt
        } else {
            LineCap::Round
        };
        self.stroke(width, cap, colour);
    }

    fn fill_disc(&mut self, centre: Vec2, radius: f64, fill: Fill<'_>) {
        match self.window.disc(centre, radius) {
            Cover::None => return,
            Cover::All => push(&mut self.paths.builder, &self.window.ring(), true),
            Cover::Some if radius <= LARGE_DISC => {
                push_circle(&mut self.paths.builder, centre, radius, false);
            }
            Cover::Some => {
                let mut sector = core::mem::take(&mut self.paths.line);
                if !self.window.arc(centre, radius, &mut sector) {
                    sector.push(centre);
                }
                self.window
                    .polygon(&sector, &mut self.paths.ring, &mut self.paths.spare);
                self.paths.line = sector;
                push(&mut self.paths.builder, &self.paths.ring, true);
            }
        }
        self.fill(&fill);
    }

    fn ring(&mut self, centre: Vec2, radius: f64, width: f64, colour: Colour) {
        let (Cover::Some, Some(width)) = (self.window.disc(centre, radius), usable_width(width))
        else {
            return;
        };
        if radius <= LARGE_DISC {
            let (width, colour) = at_least_a_pixel(width, colour);
            // The inner rim runs the other way round, so that the inside stays empty.
            push_circle(&mut self.paths.builder, centre, radius + 0.5 * width, false);
            if radius > 0.5 * width {
                push_circle(&mut self.paths.builder, centre, radius - 0.5 * width, true);
            }
            self.fill(&Fill::Flat(colour));
        } else {
            let mut arc = core::mem::take(&mut self.paths.line);
            self.window.arc(centre, radius, &mut arc);
            self.polyline(&arc, width, None, colour);
            self.paths.line = arc;
        }
    }

    fn rectangle(
        &mut self,
        min: Vec2,
        max: Vec2,
        fill: Option<Ink>,
        border: Option<Ink>,
        width: f64,
        dash: Option<f64>,
    ) {
        if let (Some(ink), Some((min, max))) = (fill, self.window.rectangle(min, max)) {
            push(&mut self.paths.builder, &box_ring(min, max)[..4], true);
            self.fill(&Fill::Flat(self.style.colour(ink)));
        }
        if let Some(ink) = border {
            self.polyline(&box_ring(min, max), width, dash, self.style.colour(ink));
        }
    }

    /// A picture on a disc, at the level of detail that suits its size.
    fn face(&mut self, centre: Vec2, radius: f64, turn: Rot, face: &Face) {
        if self.window.disc(centre, radius) == Cover::None {
            return;
        }
        let (level, scale) = face.level(radius);
        let Some(pixels) = PixmapRef::from_bytes(&level.rgba, level.width, level.height) else {
            return;
        };
        // The picture's middle comes to the centre, scaled and turned: p = c + s R (q - m).
        let middle = 0.5 * Vec2::new(f64::from(level.width), f64::from(level.height));
        let (x, y) = (turn.x_axis() * scale, turn.y_axis() * scale);
        let origin = centre - x * middle.x - y * middle.y;
        let place = Transform::from_row(
            narrow(x.x),
            narrow(x.y),
            narrow(y.x),
            narrow(y.y),
            narrow(origin.x),
            narrow(origin.y),
        );
        self.fill_disc(centre, radius, Fill::Face(pixels, place));
    }

    fn label(&mut self, label: &Label) {
        if !(label.height > 0.0 && label.height <= MAX_STROKE) {
            return;
        }
        let weight = font::weight(label.height);
        let seam = weight + font::seam(label.height);
        if label.halo {
            let ground = self.style.background;
            self.label_strokes(label);
            self.stroke(seam, LineCap::Round, ground);
        }
        self.label_strokes(label);
        self.stroke(weight, LineCap::Round, self.style.colour(label.ink));
    }

    fn label_strokes(&mut self, label: &Label) {
        let (window, builder, spare) =
            (self.window, &mut self.paths.builder, &mut self.paths.spare);
        label.strokes(|stroke| window.polyline(stroke, spare, |part| push(builder, part, false)));
    }

    /// Fills the path under construction.
    fn fill(&mut self, fill: &Fill<'_>) {
        let Some(path) = core::mem::take(&mut self.paths.builder).finish() else {
            return;
        };
        self.ground.fill(&path, fill);
        self.paths.builder = path.clear();
    }

    /// Strokes the path under construction, as the filling of its outline.
    fn stroke(&mut self, width: f64, line_cap: LineCap, colour: Colour) {
        let Some(path) = core::mem::take(&mut self.paths.builder).finish() else {
            return;
        };
        let (width, colour) = at_least_a_pixel(width, colour);
        let stroke = Stroke {
            width: narrow(width),
            line_cap,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        if let Some(outline) = self.paths.stroker.stroke(&path, &stroke, 1.0) {
            self.ground.fill(&outline, &Fill::Flat(colour));
        }
        self.paths.builder = path.clear();
    }
}

/// A width that draws something: positive, and cut at [`MAX_STROKE`].
pub(crate) fn usable_width(width: f64) -> Option<f64> {
    let cut = if width < MAX_STROKE {
        width
    } else {
        MAX_STROKE
    };
    (width > 0.0).then_some(cut)
}

/// A line thinner than a pixel becomes a pixel wide and as much fainter: between the rasteriser's four rows a pixel
/// it would come and go.
fn at_least_a_pixel(width: f64, colour: Colour) -> (f64, Colour) {
    if width >= 1.0 {
        return (width, colour);
    }
    (
        1.0,
        colour.with_alpha(round_u8(f64::from(colour.alpha) * width)),
    )
}

fn flat(colour: Colour) -> Shader<'static> {
    Shader::SolidColor(skia(colour))
}

fn ball(centre: Vec2, radius: f64, colour: Colour) -> Shader<'static> {
    let focus = centre + Vec2::splat(SHIFT * radius);
    let stops = vec![
        GradientStop::new(narrow(INNER / OUTER), skia(colour)),
        GradientStop::new(1.0, skia(shade(colour))),
    ];
    let at = Point::from_xy(narrow(focus.x), narrow(focus.y));
    let outer = narrow(OUTER * radius);
    // Too large or too small to have a gradient: flat.
    if !(radius > 0.01 && radius < 1e6) {
        return flat(shade(colour));
    }
    RadialGradient::new(
        at,
        0.0,
        at,
        outer,
        stops,
        SpreadMode::Pad,
        Transform::identity(),
    )
    .unwrap_or_else(|| flat(colour))
}

fn skia(colour: Colour) -> Color {
    Color::from_rgba8(colour.red, colour.green, colour.blue, colour.alpha)
}
