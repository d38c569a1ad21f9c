//! From marks to pixels, by exact areas; what is general goes through tiny-skia's masks.

use carom_math::{Rot, Vec2, vec2};

use crate::clip::{FAR, Window};
use crate::colour::round_u8;
use crate::op::{arrow_outline, box_ring};
use crate::raster::{
    Canvas, Cells, Flat, Outliner, Place, Radial, Raster, Textured, greater, is_convex, is_simple,
    lesser,
};
use crate::skia::{INNER, OUTER, Paths, Pen, SHIFT, usable_width};
use crate::stencil::{Masks, OnMask};
use crate::style::shade;
use crate::{Colour, Face, Ink, Mark, Op, Paint, Size, Style};

/// Room left and right of the canvas that polygons are cut to, in pixels.
const MARGIN: f64 = 1.0;

/// Memory of the painter, used from mark to mark.
#[derive(Clone, Debug, Default)]
pub(crate) struct Own {
    raster: Raster,
    outliner: Outliner,
    colours: Vec<u32>,
    paths: Paths,
    masks: Masks,
    rings: Vec<Vec<Vec2>>,
    spare: Vec<Vec2>,
}

impl Own {
    /// Forgets what was kept of the marks of another frame.
    pub(crate) fn start(&mut self) {
        self.masks.start();
    }

    /// Paints the part of mark number `index` that lies in the canvas's clip.
    pub(crate) fn mark(
        &mut self,
        (index, mark): (usize, Mark<'_>),
        style: &Style,
        canvas: &mut Canvas<'_>,
        size: Size,
    ) {
        self.hand((index, mark.is_sound()), style, canvas, size)
            .op(mark.op);
    }

    /// What paints mark number `index`; `sound` says that its rings do not cross themselves.
    pub(crate) fn hand<'a, 'c>(
        &'a mut self,
        (index, sound): (usize, bool),
        style: &'a Style,
        canvas: &'a mut Canvas<'c>,
        size: Size,
    ) -> Hand<'a, 'c> {
        self.masks.mark(index);
        Hand {
            own: self,
            style,
            canvas,
            size,
            sound,
        }
    }
}

/// Everything that painting one mark needs.
pub(crate) struct Hand<'a, 'c> {
    own: &'a mut Own,
    style: &'a Style,
    canvas: &'a mut Canvas<'c>,
    size: Size,
    sound: bool,
}

impl Hand<'_, '_> {
    /// Paints a mark.
    pub(crate) fn op(&mut self, op: &Op) {
        match op {
            Op::Polygon { points, paint } => self.polygon(points, *paint),
            Op::Region { rings, paint } => {
                if self.sound {
                    self.fill(rings.iter().map(Vec::as_slice), paint.fill);
                } else {
                    self.general(|pen| pen.fill_rings(rings, paint.fill));
                }
                let outline = self.style.outline_for(*paint);
                for ring in rings {
                    self.outline(ring, self.style.outline, outline);
                }
            }
            Op::Disc {
                centre,
                radius,
                paint,
            } => self.round(*centre, *radius, *paint),
            Op::Area { points, ink } => self.area(points, *ink),
            Op::Dot {
                centre,
                radius,
                ink,
            } => self.dot(*centre, *radius, *ink),
            Op::Ring {
                centre,
                radius,
                width,
                ink,
            } => self.circle(*centre, *radius, *width, self.style.colour(*ink)),
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
                    self.fill_one(&outline, self.style.colour(*ink));
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
            } => {
                let corners = box_ring(*min, *max);
                if let Some(ink) = fill
                    && max.cmpgt(*min).all()
                {
                    self.fill_one(&corners[..4], self.style.colour(*ink));
                }
                if let Some(ink) = border {
                    self.polyline(&corners, *width, *dash, self.style.colour(*ink));
                }
            }
            Op::Label(_) => self.general(|pen| pen.op(op)),
        }
    }

    /// [`Op::Polygon`].
    pub(crate) fn polygon(&mut self, points: &[Vec2], paint: Paint) {
        self.ring(points, paint.fill);
        let outline = self.style.outline_for(paint);
        self.outline(points, self.style.outline, outline);
    }

    /// [`Op::Area`].
    pub(crate) fn area(&mut self, points: &[Vec2], ink: Ink) {
        self.ring(points, self.style.colour(ink));
    }

    /// [`Op::Disc`].
    pub(crate) fn round(&mut self, centre: Vec2, radius: f64, paint: Paint) {
        if paint.shaded {
            self.ball(centre, radius, paint.fill);
        } else {
            self.disc(centre, radius, paint.fill);
        }
        let outline = self.style.rim_for(paint);
        self.circle(centre, radius, self.style.outline, outline);
    }

    /// [`Op::Dot`].
    pub(crate) fn dot(&mut self, centre: Vec2, radius: f64, ink: Ink) {
        self.disc(centre, radius, self.style.colour(ink));
    }

    /// Fills a ring of any shape.
    fn ring(&mut self, points: &[Vec2], colour: Colour) {
        if self.sound || is_simple(points) {
            self.fill_one(points, colour);
        } else {
            self.general(|pen| pen.fill_ring(points, colour));
        }
    }

    /// Fills rings that do not cross.
    fn fill<'r>(&mut self, rings: impl Iterator<Item = &'r [Vec2]>, colour: Colour) {
        if colour.alpha == 0 {
            return;
        }
        let window = Window::new(self.size.corner(), MARGIN);
        let own = &mut *self.own;
        let (mut min, mut max) = (Vec2::splat(FAR), Vec2::splat(-FAR));
        let mut count = 0;
        for ring in rings {
            if own.rings.len() == count {
                own.rings.push(Vec::new());
            }
            window.polygon(ring, &mut own.rings[count], &mut own.spare);
            for &point in &own.rings[count] {
                min = min.min(point);
                max = max.max(point);
            }
            count += 1;
        }
        if let Some(place) = Place::new(self.canvas, min, max) {
            let edges = |cells: &mut Cells| {
                for ring in &own.rings[..count] {
                    add_ring(cells, ring, place.left());
                }
            };
            let mut flat = Flat(packed(colour));
            own.raster.draw(self.canvas, place, edges, &mut flat);
        }
    }

    /// Fills a ring that does not cross itself.
    fn fill_one(&mut self, ring: &[Vec2], colour: Colour) {
        let Some(&first) = ring.first() else { return };
        let (mut min, mut max) = (first, first);
        for &point in ring {
            min = vec2(lesser(point.x, min.x), lesser(point.y, min.y));
            max = vec2(greater(point.x, max.x), greater(point.y, max.y));
        }
        // Sums are finite only if all numbers are.
        let sum = ring.iter().fold(Vec2::ZERO, |sum, &point| sum + point);
        let corner = self.size.corner();
        let inside = sum.is_finite() && min.cmpge(Vec2::ZERO).all() && max.cmple(corner).all();
        if !inside {
            self.fill([ring].into_iter(), colour);
            return;
        }
        if let Some(place) = Place::new(self.canvas, min, max) {
            let edges = |cells: &mut Cells| add_ring(cells, ring, place.left());
            let mut flat = Flat(packed(colour));
            self.own.raster.draw(self.canvas, place, edges, &mut flat);
        }
    }

    /// The line around a ring, which is left out where one of its points is.
    fn outline(&mut self, points: &[Vec2], width: f64, colour: Colour) {
        let Some(width) = usable_width(width) else {
            return;
        };
        if !points.iter().all(|&p| crate::clip::is_near(p)) {
            return;
        }
        let mut outliner = core::mem::take(&mut self.own.outliner);
        match outliner.band(points, 0.5 * width) {
            Some(borders) => self.fill(borders.into_iter(), colour),
            None => self.general(|pen| pen.outline_ring(points, width, colour)),
        }
        self.own.outliner = outliner;
    }

    fn polyline(&mut self, points: &[Vec2], width: f64, dash: Option<f64>, colour: Colour) {
        let Some(usable) = usable_width(width) else {
            return;
        };
        match *points {
            [a, b] if dash.is_none() && crate::clip::is_near(a) && crate::clip::is_near(b) => {
                // A long line is cut before its width is added: that is exact, and ends lie beyond the canvas.
                let room = Window::new(self.size.corner(), usable + MARGIN);
                if let Some((first, last)) = room.segment(a, b) {
                    let along = b - a;
                    self.stick(a + along * first, a + along * last, 0.5 * usable, colour);
                }
            }
            // Of a ring with a corner that is nowhere the other sides are drawn, as of any line.
            [first, .., last]
                if dash.is_none()
                    && first == last
                    && points.iter().all(|&p| crate::clip::is_near(p))
                    && is_convex(&points[1..]) =>
            {
                self.outline(&points[1..], usable, colour);
            }
            _ => self.general(|pen| pen.polyline(points, width, dash, colour)),
        }
    }

    /// A straight line with round ends.
    fn stick(&mut self, a: Vec2, b: Vec2, half: f64, colour: Colour) {
        let reach = Vec2::splat(half);
        if let Some(place) = Place::new(self.canvas, a.min(b) - reach, a.max(b) + reach) {
            let left = vec2(place.left(), 0.0);
            let limit = place.limit();
            let mut flat = Flat(packed(colour));
            let edges = |cells: &mut Cells| cells.stick(a - left, b - left, half, limit);
            self.own.raster.draw(self.canvas, place, edges, &mut flat);
        }
    }

    fn disc(&mut self, centre: Vec2, radius: f64, colour: Colour) {
        if let Some(place) = self.place(centre, radius) {
            let at = centre - vec2(place.left(), 0.0);
            let limit = place.limit();
            let mut flat = Flat(packed(colour));
            let edges = |cells: &mut Cells| cells.circle(at, radius, 1.0, limit);
            self.own.raster.draw(self.canvas, place, edges, &mut flat);
        }
    }

    /// A disc that is lit from its upper left.
    fn ball(&mut self, centre: Vec2, radius: f64, colour: Colour) {
        // Too large or too small to have a gradient: flat.
        if !(radius > 0.01 && radius < 1e6) {
            self.disc(centre, radius, shade(colour));
            return;
        }
        if let Some(place) = self.place(centre, radius) {
            let at = centre - vec2(place.left(), 0.0);
            let reach = (INNER * radius, OUTER * radius);
            let (inner, outer) = (packed(colour), packed(shade(colour)));
            let own = &mut *self.own;
            let focus = at + Vec2::splat(SHIFT * radius);
            let mut shade = Radial::new(focus, reach, inner, outer, &mut own.colours);
            let limit = place.limit();
            let edges = |cells: &mut Cells| cells.circle(at, radius, 1.0, limit);
            own.raster.draw(self.canvas, place, edges, &mut shade);
        }
    }

    /// A circle line.
    fn circle(&mut self, centre: Vec2, radius: f64, width: f64, colour: Colour) {
        let Some(width) = usable_width(width) else {
            return;
        };
        if !(radius > 0.0 && radius <= FAR) {
            return;
        }
        let (inner, outer) = (radius - 0.5 * width, radius + 0.5 * width);
        if let Some(place) = self.place(centre, outer) {
            let at = centre - vec2(place.left(), 0.0);
            let limit = place.limit();
            let mut flat = Flat(packed(colour));
            let edges = |cells: &mut Cells| {
                cells.circle(at, outer, 1.0, limit);
                if inner > 0.0 {
                    cells.circle(at, inner, -1.0, limit);
                }
            };
            self.own.raster.draw(self.canvas, place, edges, &mut flat);
        }
    }

    /// Where a disc is seen; `None` if nothing of it is.
    fn place(&self, centre: Vec2, radius: f64) -> Option<Place> {
        let sound = crate::clip::is_near(centre) && radius > 0.0 && radius <= 2.0 * FAR;
        let reach = Vec2::splat(radius);
        sound
            .then(|| Place::new(self.canvas, centre - reach, centre + reach))
            .flatten()
    }

    /// A picture on a disc, at the level of detail that suits its size.
    fn face(&mut self, centre: Vec2, radius: f64, turn: Rot, face: &Face) {
        let Some(place) = self.place(centre, radius) else {
            return;
        };
        let (level, scale) = face.level(radius);
        // The picture's middle comes to the centre, scaled and turned: p = c + s R (q - m), q = m + R⁻¹ (p - c) / s.
        let middle = 0.5 * vec2(f64::from(level.width), f64::from(level.height));
        let back = turn.inverse();
        let (right, down) = (back.x_axis() / scale, back.y_axis() / scale);
        let at = centre - vec2(place.left(), 0.0);
        let origin = middle - right * at.x - down * at.y;
        let own = &mut *self.own;
        let mut shade = Textured::new(level, origin, (right, down), &mut own.colours);
        let limit = place.limit();
        let edges = |cells: &mut Cells| cells.circle(at, radius, 1.0, limit);
        own.raster.draw(self.canvas, place, edges, &mut shade);
    }

    /// What tiny-skia turns into masks.
    fn general(&mut self, draw: impl FnOnce(&mut Pen<'_, OnMask<'_, '_>>)) {
        let own = &mut *self.own;
        if own.masks.again(self.canvas) {
            return;
        }
        let ground = OnMask::new(self.canvas, &mut own.masks);
        draw(&mut Pen::new(&mut own.paths, self.style, self.size, ground));
    }
}

/// Adds the sides of a ring; x counts from `left`.
fn add_ring(cells: &mut Cells, ring: &[Vec2], left: f64) {
    let left = vec2(left, 0.0);
    let Some(&last) = ring.last() else { return };
    let mut before = last - left;
    for &point in ring {
        let here = point - left;
        cells.line(before, here);
        before = here;
    }
}

/// A colour as a pixel: premultiplied, red in the lowest byte.
pub(crate) fn packed(colour: Colour) -> u32 {
    let Colour {
        red,
        green,
        blue,
        alpha,
    } = colour;
    if alpha == 255 {
        return u32::from_le_bytes([red, green, blue, alpha]);
    }
    let part = f64::from(alpha) / 255.0;
    let [red, green, blue] = [red, green, blue].map(|c| round_u8(f64::from(c) * part));
    u32::from_le_bytes([red, green, blue, alpha])
}
