//! The scene that all painters draw: walls, a bar, a field, and balls and polygons that fly on straight lines.

use core::f64::consts::TAU;

use carom_math::{Rot, Vec2, vec2};
use carom_render::{Colour, Frame, Ink, Op, Paint, Size, Source};

/// One thing to draw, in pixels.
#[derive(Clone, Debug)]
pub(crate) enum Thing {
    /// A filled ring of points.
    Area(Vec<Vec2>, Colour),
    /// A disc from its colour within 0.2 r of a point moved by −0.2 r to a third of it at 1.3 r.
    Ball(Vec2, f64, Colour),
    /// A flat disc.
    Dot(Vec2, f64, Colour),
    /// A circle line of a width.
    Ring(Vec2, f64, f64, Colour),
    /// A straight line of a width with flat ends.
    Stroke(Vec2, Vec2, f64, Colour),
}

/// How an arrow is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Arrows {
    /// By three strokes.
    Strokes,
    /// By one outline.
    Outlines,
}

/// A body: a ball, or a polygon with so many corners.
#[derive(Clone, Debug)]
struct Body {
    corners: usize,
    radius: f64,
    at: Vec2,
    turn: Rot,
    velocity: Vec2,
    /// Turn of a step, and from corner to corner.
    by: Rot,
    corner: Rot,
    colour: Colour,
}

/// The state that frames are drawn from.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) size: Size,
    bodies: Vec<Body>,
    /// How many of them move.
    awake: usize,
    /// From an arrow backwards to the ends of its head.
    barbs: [Rot; 2],
}

/// `xorshift64*` (Vigna 2016).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 40;
        f64::from(u32::try_from(bits).unwrap_or(0)) / f64::from(1_u32 << 24)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

const WALL: Colour = Colour::rgb(128, 128, 128);
const BAR: Colour = Colour::rgb(255, 255, 0);

impl Scene {
    /// `count` bodies that cover about a third of the canvas, the first `awake` of them moving.
    pub(crate) fn new(size: Size, count: usize, awake: usize) -> Self {
        let mut random = Random(0x9E37_79B9_7F4A_7C15 ^ count as u64);
        let corner = size.corner();
        let mean = (0.35 * corner.x * corner.y / (count as f64 * core::f64::consts::PI)).sqrt();
        let bodies = (0..count).map(|i| {
            let corners = if i % 2 == 0 { 3 + (i / 2) % 6 } else { 0 };
            Body {
                corners,
                radius: mean * random.between(0.7, 1.3),
                at: vec2(random.between(0.0, corner.x), random.between(0.0, corner.y)),
                turn: Rot::from_angle(random.between(0.0, TAU)),
                velocity: vec2(random.between(-40.0, 40.0), random.between(-40.0, 40.0)),
                by: Rot::from_angle(random.between(-3.0, 3.0) / 60.0),
                corner: Rot::from_angle(TAU / corners.max(1) as f64),
                colour: Colour::hsv(random.unit(), 0.7, random.between(0.6, 1.0)),
            }
        });
        Self {
            size,
            bodies: bodies.collect(),
            awake,
            barbs: [0.5, -0.5].map(Rot::from_angle),
        }
    }

    /// A sixtieth of a second on; a body that leaves comes in on the other side.
    pub(crate) fn step(&mut self) {
        let corner = self.size.corner();
        for body in &mut self.bodies[..self.awake] {
            body.at += body.velocity / 60.0;
            body.turn = body.by * body.turn;
            body.at -= corner * (body.at / corner).floor();
        }
    }

    /// Hands over what does not move, lowest first.
    fn still(&self, arrows: Arrows, sink: &mut impl Sink) {
        let Vec2 { x: w, y: h } = self.size.corner();
        let triangle = |points: [Vec2; 3]| Thing::Area(points.to_vec(), WALL);
        sink.draw(
            triangle([vec2(0.0, h), vec2(0.3 * w, h), vec2(0.0, 0.7 * h)]),
            false,
        );
        sink.draw(
            triangle([vec2(w, h), vec2(0.7 * w, h), vec2(w, 0.7 * h)]),
            false,
        );
        sink.draw(
            Thing::Stroke(
                vec2(0.05 * w, 0.95 * h),
                vec2(0.35 * w, 0.95 * h),
                10.0,
                BAR,
            ),
            false,
        );
        sink.draw(
            Thing::Stroke(
                vec2(0.9 * w, 0.05 * h),
                vec2(0.9 * w, 0.15 * h),
                2.0,
                Colour::WHITE,
            ),
            false,
        );
        sink.draw(
            Thing::Dot(vec2(0.9 * w, 0.15 * h), 4.0, Colour::WHITE),
            false,
        );
        sink.draw(
            Thing::Ring(
                vec2(0.5 * w, 0.45 * h),
                0.3 * h,
                3.0,
                Colour::rgb(90, 140, 255),
            ),
            false,
        );
        for body in &self.bodies[self.awake..] {
            body.draw(arrows, self.barbs, false, sink);
        }
    }

    /// Hands over what moves, which lies above.
    fn moving(&self, arrows: Arrows, sink: &mut impl Sink) {
        for body in &self.bodies[..self.awake] {
            body.draw(arrows, self.barbs, true, sink);
        }
    }

    /// All things.
    pub(crate) fn things(&self, arrows: Arrows) -> Vec<Thing> {
        let mut things = Vec::new();
        self.still(arrows, &mut things);
        self.moving(arrows, &mut things);
        things
    }

    /// The scene as carom's display list; the number of marks that do not move.
    pub(crate) fn frame_into(&self, arrows: Arrows, frame: &mut Frame) -> usize {
        frame.clear(self.size);
        self.still(arrows, frame);
        let still = frame.ops().len();
        self.moving(arrows, frame);
        still
    }

    /// The same once more, where the first `still` marks do not move.
    pub(crate) fn frame_again(&self, arrows: Arrows, still: usize, frame: &mut Frame) {
        frame.truncate(still);
        self.moving(arrows, frame);
    }
}

/// Takes things; `points` gives the memory to make one.
trait Sink {
    fn points(&mut self) -> Vec<Vec2>;
    fn draw(&mut self, thing: Thing, awake: bool);
}

impl Sink for Vec<Thing> {
    fn points(&mut self) -> Vec<Vec2> {
        Vec::new()
    }

    fn draw(&mut self, thing: Thing, _: bool) {
        self.push(thing);
    }
}

impl Sink for Frame {
    fn points(&mut self) -> Vec<Vec2> {
        Self::points(self)
    }

    fn draw(&mut self, thing: Thing, awake: bool) {
        let op = op(thing, self);
        self.push_from(Source { body: None, awake }, op);
    }
}

impl Body {
    fn draw(&self, arrows: Arrows, barbs: [Rot; 2], awake: bool, sink: &mut impl Sink) {
        let shape = self.shape(sink);
        sink.draw(shape, awake);
        sink.draw(Thing::Dot(self.at, 1.0, Colour::WHITE), awake);
        self.arrow(arrows, barbs, awake, sink);
    }

    fn shape(&self, sink: &mut impl Sink) -> Thing {
        if self.corners == 0 {
            return Thing::Ball(self.at, self.radius, self.colour);
        }
        let mut arm = self.radius * self.turn.x_axis();
        let corner = |_| {
            arm = self.corner * arm;
            self.at + arm
        };
        let mut points = sink.points();
        points.extend((0..self.corners).map(corner));
        Thing::Area(points, self.colour)
    }

    /// Half a second of its way.
    fn arrow(&self, arrows: Arrows, barbs: [Rot; 2], awake: bool, sink: &mut impl Sink) {
        let way = 0.5 * self.velocity;
        let length = way.length();
        let tip = self.at + way;
        let back = -way / length.max(1e-9) * length.min(10.0);
        let barbs = barbs.map(|turn| tip + turn * back);
        match arrows {
            Arrows::Strokes => {
                sink.draw(Thing::Stroke(self.at, tip, 2.0, Colour::WHITE), awake);
                for barb in barbs {
                    sink.draw(Thing::Stroke(tip, barb, 2.0, Colour::WHITE), awake);
                }
            }
            Arrows::Outlines => {
                let across = vec2(-way.y, way.x) / length.max(1e-9);
                let neck = tip + 0.8 * back;
                let outline = [
                    self.at + across,
                    neck + across,
                    barbs[1],
                    tip,
                    barbs[0],
                    neck - across,
                    self.at - across,
                ];
                let mut points = sink.points();
                points.extend(outline);
                sink.draw(Thing::Area(points, Colour::WHITE), awake);
            }
        }
    }
}

/// A thing as a mark.
fn op(thing: Thing, frame: &mut Frame) -> Op {
    match thing {
        Thing::Area(points, colour) => Op::Area {
            points,
            ink: Ink::Of(colour),
        },
        Thing::Ball(centre, radius, colour) => Op::Disc {
            centre,
            radius,
            paint: Paint::flat(colour).shaded(),
        },
        Thing::Dot(centre, radius, colour) => Op::Dot {
            centre,
            radius,
            ink: Ink::Of(colour),
        },
        Thing::Ring(centre, radius, width, colour) => Op::Ring {
            centre,
            radius,
            width,
            ink: Ink::Of(colour),
        },
        Thing::Stroke(a, b, width, colour) => {
            let mut points = frame.points();
            points.extend(quad(a, b, width));
            Op::Area {
                points,
                ink: Ink::Of(colour),
            }
        }
    }
}

/// What a stroke with flat ends covers.
pub(crate) fn quad(a: Vec2, b: Vec2, width: f64) -> [Vec2; 4] {
    let along = (b - a).normalize_or_zero();
    let across = vec2(-along.y, along.x) * (0.5 * width);
    [a + across, b + across, b - across, a - across]
}
