//! The other painters.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use cairo::{Antialias, Context, Format, ImageSurface, RadialGradient};
use carom_math::Vec2;
use carom_render::{Colour, Size};
use tiny_skia::{
    Color, FillRule, GradientStop, Paint, PathBuilder, Pixmap, Point, Shader, SpreadMode, Stroke,
    Transform,
};
use vello_cpu::kurbo::{BezPath, Circle, Shape as _};
use vello_cpu::peniko::{
    Gradient,
    color::{DynamicColor, Srgb},
};
use vello_cpu::{RenderContext, Resources};

use crate::scene::Thing;

/// A picture, four bytes a pixel, and the number of the byte that is red.
pub(crate) type Bytes = (Vec<u8>, usize);

/// How Cairo is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// Every thing drawn anew.
    Direct,
    /// Balls painted from pictures of them, made once for each radius and colour.
    Cached,
    /// Anything goes, at the lowest quality.
    Fast,
}

pub(crate) struct Cairo {
    surface: ImageSurface,
    context: Context,
    way: Way,
    balls: BTreeMap<[u64; 2], ImageSurface>,
}

fn part(channel: u8) -> f64 {
    f64::from(channel) / 255.0
}

impl Cairo {
    pub(crate) fn new(size: Size, way: Way) -> Result<Self, cairo::Error> {
        let [width, height] = [size.width(), size.height()].map(u32::cast_signed);
        let surface = ImageSurface::create(Format::Rgb24, width, height)?;
        let context = Context::new(&surface)?;
        if way == Way::Fast {
            context.set_antialias(Antialias::Fast);
        }
        Ok(Self {
            surface,
            context,
            way,
            balls: BTreeMap::new(),
        })
    }

    pub(crate) fn draw(&mut self, things: &[Thing]) -> Result<(), cairo::Error> {
        ink(&self.context, Colour::BLACK);
        self.context.paint()?;
        for thing in things {
            self.thing(thing)?;
        }
        self.surface.flush();
        Ok(())
    }

    fn thing(&mut self, thing: &Thing) -> Result<(), cairo::Error> {
        let context = &self.context;
        match thing {
            Thing::Area(points, colour) => {
                for point in points {
                    context.line_to(point.x, point.y);
                }
                context.close_path();
                ink(context, *colour);
                context.fill()
            }
            Thing::Ball(at, radius, colour) if self.way == Way::Cached => {
                let side = (2.0 * radius).ceil() + 2.0;
                let key = [
                    radius.to_bits(),
                    u64::from(u32::from_le_bytes([
                        colour.red,
                        colour.green,
                        colour.blue,
                        0,
                    ])),
                ];
                let picture = match self.balls.entry(key) {
                    Entry::Occupied(known) => known.into_mut(),
                    Entry::Vacant(new) => new.insert(cached(side, *radius, *colour)?),
                };
                let corner = *at - Vec2::splat(0.5 * side);
                context.set_source_surface(&*picture, corner.x, corner.y)?;
                context.paint()
            }
            Thing::Ball(at, radius, colour) => ball(context, *at, *radius, *colour),
            Thing::Dot(at, radius, colour) => {
                circle(context, *at, *radius);
                ink(context, *colour);
                context.fill()
            }
            Thing::Ring(at, radius, width, colour) => {
                circle(context, *at, *radius);
                ink(context, *colour);
                context.set_line_width(*width);
                context.stroke()
            }
            Thing::Stroke(a, b, width, colour) => {
                context.move_to(a.x, a.y);
                context.line_to(b.x, b.y);
                ink(context, *colour);
                context.set_line_width(*width);
                context.stroke()
            }
        }
    }

    /// The picture as a PNG, by Cairo's own writer.
    pub(crate) fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let written = self.surface.write_to_png(&mut bytes);
        assert!(written.is_ok(), "cairo writes to memory: {written:?}");
        bytes
    }

    pub(crate) fn bytes(self) -> Bytes {
        let Self {
            surface, context, ..
        } = self;
        drop(context);
        let data = surface.take_data().map(|data| data.to_vec());
        (data.unwrap_or_default(), 2)
    }
}

/// A picture of a ball in the middle of a square.
fn cached(side: f64, radius: f64, colour: Colour) -> Result<ImageSurface, cairo::Error> {
    #[expect(clippy::cast_possible_truncation, reason = "a few hundred pixels")]
    let whole = side as i32;
    let picture = ImageSurface::create(Format::ARgb32, whole, whole)?;
    let context = Context::new(&picture)?;
    ball(&context, Vec2::splat(0.5 * side), radius, colour)?;
    drop(context);
    Ok(picture)
}

fn ink(context: &Context, colour: Colour) {
    context.set_source_rgb(part(colour.red), part(colour.green), part(colour.blue));
}

fn circle(context: &Context, at: Vec2, radius: f64) {
    context.new_sub_path();
    context.arc(at.x, at.y, radius, 0.0, core::f64::consts::TAU);
    context.close_path();
}

fn ball(context: &Context, at: Vec2, radius: f64, colour: Colour) -> Result<(), cairo::Error> {
    let focus = at - Vec2::splat(0.2 * radius);
    let gradient = RadialGradient::new(
        focus.x,
        focus.y,
        0.2 * radius,
        focus.x,
        focus.y,
        1.3 * radius,
    );
    let [red, green, blue] = [colour.red, colour.green, colour.blue].map(part);
    gradient.add_color_stop_rgb(0.0, red, green, blue);
    gradient.add_color_stop_rgb(1.0, red / 3.0, green / 3.0, blue / 3.0);
    context.set_source(&gradient)?;
    circle(context, at, radius);
    context.fill()
}

/// tiny-skia as its examples use it.
pub(crate) struct Skia {
    map: Pixmap,
}

#[expect(clippy::cast_possible_truncation, reason = "tiny-skia's numbers")]
fn f(x: f64) -> f32 {
    x as f32
}

fn skia(colour: Colour) -> Color {
    Color::from_rgba8(colour.red, colour.green, colour.blue, 255)
}

fn third(colour: Colour) -> Colour {
    Colour::rgb(colour.red / 3, colour.green / 3, colour.blue / 3)
}

impl Skia {
    pub(crate) fn new(size: Size) -> Option<Self> {
        Pixmap::new(size.width(), size.height()).map(|map| Self { map })
    }

    pub(crate) fn draw(&mut self, things: &[Thing]) {
        self.map.fill(Color::BLACK);
        for thing in things {
            self.thing(thing);
        }
    }

    fn thing(&mut self, thing: &Thing) {
        let mut builder = PathBuilder::new();
        match thing {
            Thing::Area(points, colour) => {
                for (i, point) in points.iter().enumerate() {
                    if i == 0 {
                        builder.move_to(f(point.x), f(point.y));
                    } else {
                        builder.line_to(f(point.x), f(point.y));
                    }
                }
                builder.close();
                self.fill(builder, Shader::SolidColor(skia(*colour)));
            }
            Thing::Ball(at, radius, colour) => {
                builder.push_circle(f(at.x), f(at.y), f(*radius));
                let focus = Point::from_xy(f(at.x - 0.2 * radius), f(at.y - 0.2 * radius));
                let stops = vec![
                    GradientStop::new(0.2 / 1.3, skia(*colour)),
                    GradientStop::new(1.0, skia(third(*colour))),
                ];
                let identity = Transform::identity();
                let outer = f(1.3 * radius);
                if let Some(shader) = tiny_skia::RadialGradient::new(
                    focus,
                    0.0,
                    focus,
                    outer,
                    stops,
                    SpreadMode::Pad,
                    identity,
                ) {
                    self.fill(builder, shader);
                }
            }
            Thing::Dot(at, radius, colour) => {
                builder.push_circle(f(at.x), f(at.y), f(*radius));
                self.fill(builder, Shader::SolidColor(skia(*colour)));
            }
            Thing::Ring(at, radius, width, colour) => {
                builder.push_circle(f(at.x), f(at.y), f(*radius));
                self.stroke(builder, *width, *colour);
            }
            Thing::Stroke(a, b, width, colour) => {
                builder.move_to(f(a.x), f(a.y));
                builder.line_to(f(b.x), f(b.y));
                self.stroke(builder, *width, *colour);
            }
        }
    }

    fn fill(&mut self, builder: PathBuilder, shader: Shader<'_>) {
        let paint = Paint {
            shader,
            ..Paint::default()
        };
        if let Some(path) = builder.finish() {
            let identity = Transform::identity();
            self.map
                .fill_path(&path, &paint, FillRule::Winding, identity, None);
        }
    }

    fn stroke(&mut self, builder: PathBuilder, width: f64, colour: Colour) {
        let paint = Paint {
            shader: Shader::SolidColor(skia(colour)),
            ..Paint::default()
        };
        let stroke = Stroke {
            width: f(width),
            ..Stroke::default()
        };
        if let Some(path) = builder.finish() {
            self.map
                .stroke_path(&path, &paint, &stroke, Transform::identity(), None);
        }
    }

    pub(crate) fn bytes(self) -> Bytes {
        (self.map.take(), 0)
    }

    /// The picture as a PNG, RGB by the png crate's fast way.
    pub(crate) fn png(&self) -> Vec<u8> {
        let data = self.map.data();
        let mut rgb = Vec::with_capacity(data.len() / 4 * 3);
        for pixel in data.chunks_exact(4) {
            rgb.extend_from_slice(&pixel[..3]);
        }
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.map.width(), self.map.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_filter(png::Filter::Up);
        let written = encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&rgb));
        assert!(written.is_ok(), "memory takes all: {written:?}");
        bytes
    }
}

/// `vello_cpu` on one thread.
pub(crate) struct Vello {
    context: RenderContext,
    resources: Resources,
    map: vello_cpu::Pixmap,
}

impl Vello {
    pub(crate) fn new(size: Size) -> Self {
        let [width, height] =
            [size.width(), size.height()].map(|side| u16::try_from(side).unwrap_or(1));
        Self {
            context: RenderContext::new(width, height),
            resources: Resources::new(),
            map: vello_cpu::Pixmap::new(width, height),
        }
    }

    pub(crate) fn draw(&mut self, things: &[Thing]) {
        let size = self.context.width();
        let height = self.context.height();
        self.context.reset();
        self.context.set_paint(vello(Colour::BLACK));
        let all = vello_cpu::kurbo::Rect::new(0.0, 0.0, f64::from(size), f64::from(height));
        self.context.fill_rect(&all);
        for thing in things {
            self.thing(thing);
        }
        self.context.flush();
        self.context.render(&mut self.map, &mut self.resources);
    }

    fn thing(&mut self, thing: &Thing) {
        let round = |at: &Vec2, radius: &f64| Circle::new((at.x, at.y), *radius).to_path(0.1);
        match thing {
            Thing::Area(points, colour) => {
                let mut path = BezPath::new();
                for (i, point) in points.iter().enumerate() {
                    if i == 0 {
                        path.move_to((point.x, point.y));
                    } else {
                        path.line_to((point.x, point.y));
                    }
                }
                path.close_path();
                self.context.set_paint(vello(*colour));
                self.context.fill_path(&path);
            }
            Thing::Ball(at, radius, colour) => {
                let focus = (at.x - 0.2 * radius, at.y - 0.2 * radius);
                let stops = [vello(*colour), vello(third(*colour))]
                    .map(DynamicColor::from_alpha_color::<Srgb>);
                let gradient =
                    Gradient::new_two_point_radial(focus, f(0.2 * radius), focus, f(1.3 * radius))
                        .with_stops(stops);
                self.context.set_paint(gradient);
                self.context.fill_path(&round(at, radius));
            }
            Thing::Dot(at, radius, colour) => {
                self.context.set_paint(vello(*colour));
                self.context.fill_path(&round(at, radius));
            }
            Thing::Ring(at, radius, width, colour) => {
                self.context.set_paint(vello(*colour));
                self.context
                    .set_stroke(vello_cpu::kurbo::Stroke::new(*width));
                self.context.stroke_path(&round(at, radius));
            }
            Thing::Stroke(a, b, width, colour) => {
                let mut path = BezPath::new();
                path.move_to((a.x, a.y));
                path.line_to((b.x, b.y));
                self.context.set_paint(vello(*colour));
                let stroke =
                    vello_cpu::kurbo::Stroke::new(*width).with_caps(vello_cpu::kurbo::Cap::Butt);
                self.context.set_stroke(stroke);
                self.context.stroke_path(&path);
            }
        }
    }

    pub(crate) fn bytes(self) -> Bytes {
        let data = self.map.data();
        (data.iter().flat_map(|p| [p.r, p.g, p.b, p.a]).collect(), 0)
    }
}

fn vello(colour: Colour) -> vello_cpu::color::AlphaColor<Srgb> {
    vello_cpu::color::AlphaColor::from_rgb8(colour.red, colour.green, colour.blue)
}
