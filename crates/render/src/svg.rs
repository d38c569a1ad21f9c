//! A frame as SVG: the same marks, for print and for browsers.

use core::fmt::Write;

use carom_math::{Rot, Vec2};

use crate::clip::{FAR, Window, is_near};
use crate::op::{arrow_outline, box_ring};
use crate::path::usable_dash;
use crate::skia::{INNER, OUTER, SHIFT, usable_width};
use crate::style::shade;
use crate::{Colour, Face, Ink, Label, Op, Packing, Size, Style, font, png};

/// The document. Coordinates have two digits after the point, so equal frames are equal bytes.
pub(crate) fn write(size: Size, ops: &[Op], style: &Style) -> String {
    let (width, height) = (size.width(), size.height());
    let mut svg = Svg {
        text: String::new(),
        style,
        defined: 0,
        faces: Vec::new(),
    };
    svg.line(format_args!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">"#
    ));
    svg.line(format_args!(
        r#"<rect width="{width}" height="{height}" fill="{}"/>"#,
        style.background.with_alpha(255)
    ));
    for op in ops {
        svg.op(op);
    }
    svg.line(format_args!("</svg>"));
    if svg.defined == 0 {
        return svg.text;
    }
    // Names hold in the whole page that a drawing is put into: those of another drawing must differ.
    let own = format!("g{:08x}-", crc32fast::hash(svg.text.as_bytes()));
    svg.text.replace(NAME, &own)
}

/// What names begin with until the rest is written; in no other text, which has no control characters.
const NAME: char = '\u{1}';

struct Svg<'a> {
    text: String,
    style: &'a Style,
    /// Gradients, clips and faces so far, for their names.
    defined: usize,
    /// The faces that were written, with their numbers.
    faces: Vec<(&'a Face, usize)>,
}

impl<'a> Svg<'a> {
    fn op(&mut self, op: &'a Op) {
        match op {
            Op::Polygon { points, paint } => {
                let outline = self.style.outline_for(*paint);
                if let Some(path) = path(points, true) {
                    let (fill, stroke) = (fill(paint.fill), stroke(outline, self.style.outline));
                    self.line(format_args!(r#"<path d="{path}" {fill} {stroke}/>"#));
                }
            }
            Op::Region { rings, paint } => {
                let outline = self.style.outline_for(*paint);
                let all: String = rings.iter().filter_map(|ring| path(ring, true)).collect();
                if !all.is_empty() {
                    let (fill, stroke) = (fill(paint.fill), stroke(outline, self.style.outline));
                    self.line(format_args!(r#"<path d="{all}" {fill} {stroke}/>"#));
                }
            }
            Op::Disc {
                centre,
                radius,
                paint,
            } => {
                let outline = self.style.rim_for(*paint);
                if let Some(circle) = circle(*centre, *radius) {
                    let inside = if paint.shaded {
                        self.gradient(*centre, *radius, paint.fill)
                    } else {
                        fill(paint.fill)
                    };
                    let stroke = stroke(outline, self.style.outline);
                    self.line(format_args!("<circle {circle} {inside} {stroke}/>"));
                }
            }
            Op::Area { points, ink } => {
                if let Some(path) = path(points, true) {
                    let inside = fill(self.style.colour(*ink));
                    self.line(format_args!(r#"<path d="{path}" {inside}/>"#));
                }
            }
            Op::Dot {
                centre,
                radius,
                ink,
            } => {
                if let Some(circle) = circle(*centre, *radius) {
                    let inside = fill(self.style.colour(*ink));
                    self.line(format_args!("<circle {circle} {inside}/>"));
                }
            }
            Op::Ring {
                centre,
                radius,
                width,
                ink,
            } => {
                if let Some(circle) = circle(*centre, *radius) {
                    let stroke = stroke(self.style.colour(*ink), *width);
                    self.line(format_args!(r#"<circle {circle} fill="none" {stroke}/>"#));
                }
            }
            Op::Line {
                points,
                width,
                dash,
                ink,
            } => self.polyline(points, *width, *dash, *ink),
            Op::Arrow {
                from,
                to,
                width,
                ink,
            } => {
                let outline = arrow_outline(*from, *to, *width);
                if let Some(path) = outline.and_then(|points| path(&points, true)) {
                    let inside = fill(self.style.colour(*ink));
                    self.line(format_args!(r#"<path d="{path}" {inside}/>"#));
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
                fill: inside,
                border,
                width,
                dash,
            } => {
                let corners = box_ring(*min, *max);
                let inside = inside.as_ref().filter(|_| max.cmpgt(*min).all());
                if let (Some(ink), Some(path)) = (inside, path(&corners[..4], true)) {
                    let inside = fill(self.style.colour(*ink));
                    self.line(format_args!(r#"<path d="{path}" {inside}/>"#));
                }
                if let Some(ink) = border {
                    self.polyline(&corners, *width, *dash, *ink);
                }
            }
            Op::Label(label) => self.label(label),
        }
    }

    fn polyline(&mut self, points: &[Vec2], width: f64, dash: Option<f64>, ink: Ink) {
        let closed = points.len() > 3 && points.first() == points.last();
        let mut path = String::new();
        // Without a point that is not finite the rest of the line is drawn.
        let all = Window::between(Vec2::splat(-FAR), Vec2::splat(FAR));
        all.polyline(points, &mut Vec::new(), |part| {
            if closed && part.len() == points.len() {
                extend(&mut path, &part[1..], true);
            } else {
                extend(&mut path, part, false);
            }
        });
        if path.is_empty() {
            return;
        }
        let stroke = stroke(self.style.colour(ink), width);
        let dash = match dash {
            // A dash without an end is the whole line, cut off straight as dashes are.
            Some(dash) if dash == f64::INFINITY => String::new(),
            Some(dash) => format!(r#" stroke-dasharray="{:.2}""#, usable_dash(dash)),
            None => r#" stroke-linecap="round""#.to_owned(),
        };
        self.line(format_args!(
            r#"<path d="{path}" fill="none" stroke-linejoin="round" {stroke}{dash}/>"#
        ));
    }

    /// The strokes of the font: the same picture everywhere. The text itself is the group's label.
    fn label(&mut self, label: &Label) {
        let mut path = String::new();
        let mut near = label.height > 0.0;
        label.strokes(|stroke| {
            near &= stroke.iter().all(|&p| is_near(p));
            extend(&mut path, stroke, false);
        });
        if !near || path.is_empty() {
            return;
        }
        let weight = font::weight(label.height);
        let name = escaped(&label.text);
        self.line(format_args!(
            r#"<g role="img" aria-label="{name}" fill="none" stroke-linecap="round" stroke-linejoin="round">"#
        ));
        if label.halo {
            let seam = weight + font::seam(label.height);
            let stroke = stroke(self.style.background, seam);
            self.line(format_args!(r#"<path d="{path}" {stroke}/>"#));
        }
        let stroke = stroke(self.style.colour(label.ink), weight);
        self.line(format_args!(r#"<path d="{path}" {stroke}/></g>"#));
    }

    fn gradient(&mut self, centre: Vec2, radius: f64, colour: Colour) -> String {
        let focus = centre + Vec2::splat(SHIFT * radius);
        self.defined += 1;
        let name = self.defined;
        self.line(format_args!(
            r#"<radialGradient id="{NAME}{name}" gradientUnits="userSpaceOnUse" cx="{:.2}" cy="{:.2}" r="{:.2}"><stop offset="{:.4}" {}/><stop offset="1" {}/></radialGradient>"#,
            focus.x,
            focus.y,
            OUTER * radius,
            INNER / OUTER,
            stop(colour),
            stop(shade(colour)),
        ));
        format!(r#"fill="url(#{NAME}{name})""#)
    }

    fn face(&mut self, centre: Vec2, radius: f64, turn: Rot, face: &'a Face) {
        let Some(circle) = circle(centre, radius) else {
            return;
        };
        let picture = self.picture(face);
        let (width, height) = (f64::from(face.width()), f64::from(face.height()));
        let scale = 2.0 * radius / width.min(height);
        let (x, y) = (turn.x_axis() * scale, turn.y_axis() * scale);
        let origin = centre - 0.5 * (x * width + y * height);
        self.defined += 1;
        let name = self.defined;
        self.line(format_args!(
            r#"<clipPath id="{NAME}{name}"><circle {circle}/></clipPath>"#
        ));
        self.line(format_args!(
            r##"<g clip-path="url(#{NAME}{name})"><use href="#{NAME}{picture}" transform="matrix({:.6} {:.6} {:.6} {:.6} {:.2} {:.2})"/></g>"##,
            x.x,
            x.y,
            y.x,
            y.y,
            origin.x,
            origin.y,
        ));
    }

    /// The number of a face's picture, which is written once, however many discs wear it.
    fn picture(&mut self, face: &'a Face) -> usize {
        if let Some(&(_, number)) = self.faces.iter().find(|(known, _)| *known == face) {
            return number;
        }
        let (size, rgba) = face.straight();
        let packed = base64(&png::encode(
            size,
            &rgba,
            ::png::ColorType::Rgba,
            Packing::Small,
        ));
        self.defined += 1;
        let number = self.defined;
        self.faces.push((face, number));
        self.line(format_args!(
            r#"<defs><image id="{NAME}{number}" width="{}" height="{}" href="data:image/png;base64,{packed}"/></defs>"#,
            size.width(),
            size.height(),
        ));
        number
    }

    fn line(&mut self, line: core::fmt::Arguments<'_>) {
        // Writing to a string has no error.
        let _done = writeln!(self.text, "{line}");
    }
}

fn path(points: &[Vec2], closed: bool) -> Option<String> {
    let enough = points.len() > 1 && points.iter().all(|&p| is_near(p));
    enough.then(|| {
        let mut path = String::new();
        extend(&mut path, points, closed);
        path
    })
}

fn extend(path: &mut String, points: &[Vec2], closed: bool) {
    for (i, point) in points.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        let _done = write!(path, "{command}{:.2} {:.2}", point.x, point.y);
    }
    if closed {
        path.push('Z');
    }
}

fn circle(centre: Vec2, radius: f64) -> Option<String> {
    let sound = is_near(centre) && radius > 0.0 && radius <= FAR;
    sound.then(|| {
        format!(
            r#"cx="{:.2}" cy="{:.2}" r="{radius:.2}""#,
            centre.x, centre.y
        )
    })
}

fn fill(colour: Colour) -> String {
    coloured("fill", "fill-opacity", colour)
}

fn stroke(colour: Colour, width: f64) -> String {
    match usable_width(width) {
        Some(width) => format!(
            r#"{} stroke-width="{width:.2}""#,
            coloured("stroke", "stroke-opacity", colour)
        ),
        None => r#"stroke="none""#.to_owned(),
    }
}

fn stop(colour: Colour) -> String {
    coloured("stop-color", "stop-opacity", colour)
}

fn coloured(name: &str, opacity: &str, colour: Colour) -> String {
    let solid = colour.with_alpha(255);
    if colour.alpha == 255 {
        return format!(r#"{name}="{solid}""#);
    }
    let part = f64::from(colour.alpha) / 255.0;
    format!(r#"{name}="{solid}" {opacity}="{part:.3}""#)
}

fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            // XML 1.0 has no name for control characters.
            c if c.is_control() => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= group.len() {
                char::from(letter)
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
#[path = "svg_tests.rs"]
mod tests;
