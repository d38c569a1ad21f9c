//! Scenes as plain data: bodies that any engine can be given, the same bits for all.

#[cfg(test)]
mod digest_tests;
mod gas;
mod grow;
#[cfg(test)]
mod grow_tests;
mod harness;
mod list;
mod lively;
mod nearest;
mod pairs;
mod piles;
mod resting;
mod sparse;
mod world;

pub use gas::spaced_scene;
pub use grow::{GrowthKind, MAX_GROWTH, growth_scene};
pub use list::{PlainInfo, plain_scene, plain_scenes};
pub use lively::lively_scenes;
pub use world::PlainError;
pub(crate) use {grow::growth_of, list::full_name};

use carom_math::{StateHash, Vec2, vec2};

/// A scene that says nothing about how it is computed or drawn.
///
/// SI units, radians, counter-clockwise; a table of shapes and one of materials, which bodies name by index.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainScene {
    /// What a list shows.
    pub name: String,
    /// Uniform acceleration, in m/s².
    pub gravity: Vec2,
    /// Length of a step, in s.
    pub dt: f64,
    /// Steps before measuring begins.
    pub warm_up_steps: u32,
    /// Steps that are measured.
    pub measured_steps: u32,
    /// Whether bodies may fall asleep.
    pub sleeping: bool,
    /// Low and high corner of what a dynamic body's centre must stay strictly inside, in m; `None`: open.
    pub region: Option<[Vec2; 2]>,
    /// What bodies are made of.
    pub materials: Vec<PlainMaterial>,
    /// In the frame of the body that names them, unturned.
    pub shapes: Vec<PlainShape>,
    /// Counter-clockwise rings around concave bodies.
    pub outlines: Vec<Vec<Vec2>>,
    /// In the order in which an engine gets them.
    pub bodies: Vec<PlainBody>,
}

/// What a body is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainMaterial {
    /// Mass per area, in kg/m².
    pub density: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
}

/// A shape that every engine has.
#[derive(Clone, Debug, PartialEq)]
pub enum PlainShape {
    /// A disc about the body's origin.
    Circle {
        /// In m.
        radius: f64,
    },
    /// A rectangle along the body's axes.
    Box {
        /// Half of width and height, in m.
        half: Vec2,
        /// Where its middle is, in m.
        offset: Vec2,
    },
    /// Three to eight corners, convex, counter-clockwise, in m.
    Polygon(Vec<Vec2>),
    /// A wall without thickness, both sides of it.
    Segment([Vec2; 2]),
}

/// How a body is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlainKind {
    /// Never.
    Fixed,
    /// By forces and contacts.
    Dynamic,
    /// By its own velocity, whatever it meets.
    Kinematic,
}

/// A body at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainBody {
    /// How it is moved.
    pub kind: PlainKind,
    /// Of the body's origin, which is its centre of mass, in m.
    pub position: Vec2,
    /// In rad.
    pub angle: f64,
    /// In m/s.
    pub velocity: Vec2,
    /// Angular velocity, in rad/s.
    pub spin: f64,
    /// Indices into the scene's shapes: convex pieces, if there is an outline.
    pub shapes: Vec<usize>,
    /// Index into the scene's outlines: one ring that is the union of the shapes.
    pub outline: Option<usize>,
    /// Index into the scene's materials.
    pub material: usize,
    /// Whether it starts asleep.
    pub asleep: bool,
    /// Whether engines that sweep only what they are told to sweep should sweep it.
    pub bullet: bool,
}

impl PlainScene {
    /// An empty scene of 60 steps a second.
    #[must_use]
    pub fn empty(name: &str, gravity: Vec2) -> Self {
        Self {
            name: name.to_owned(),
            gravity,
            dt: 1.0 / 60.0,
            warm_up_steps: 0,
            measured_steps: 0,
            sleeping: false,
            region: None,
            materials: Vec::new(),
            shapes: Vec::new(),
            outlines: Vec::new(),
            bodies: Vec::new(),
        }
    }

    /// With `warm_up` steps before `measured` ones.
    #[must_use]
    pub fn steps(self, warm_up: u32, measured: u32) -> Self {
        Self {
            warm_up_steps: warm_up,
            measured_steps: measured,
            ..self
        }
    }

    /// Adds a material and gives its index.
    pub fn material(&mut self, density: f64, friction: f64, restitution: f64) -> usize {
        self.materials.push(PlainMaterial {
            density,
            friction,
            restitution,
        });
        self.materials.len() - 1
    }

    /// Adds a shape and gives its index.
    pub fn shape(&mut self, shape: PlainShape) -> usize {
        self.shapes.push(shape);
        self.shapes.len() - 1
    }

    /// Adds a body of one shape and gives its index.
    pub fn add(&mut self, body: PlainBody, shape: PlainShape) -> usize {
        let shapes = vec![self.shape(shape)];
        self.bodies.push(PlainBody { shapes, ..body });
        self.bodies.len() - 1
    }

    /// Adds a body made of one shape of the table and gives its index.
    pub fn place(&mut self, body: PlainBody, shape: usize) -> usize {
        let shapes = vec![shape];
        self.bodies.push(PlainBody { shapes, ..body });
        self.bodies.len() - 1
    }

    /// Adds a bin of the first material: inner faces at ±`inner` and y = 0, walls `height` high, and all twice `half` thick, in m.
    fn bin(&mut self, inner: f64, half: f64, height: f64) {
        let floor = self.shape(PlainShape::rectangle(inner + 2.0 * half, half));
        let side = self.shape(PlainShape::rectangle(half, 0.5 * height));
        for (x, y, wall) in [
            (0.0, -half, floor),
            (-inner - half, 0.5 * height, side),
            (inner + half, 0.5 * height, side),
        ] {
            self.place(PlainBody::new(PlainKind::Fixed, vec2(x, y), 0), wall);
        }
    }

    /// A fingerprint of every bit but those of the name: equal scenes are equal for every engine.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let mut hash = Digest(StateHash::default());
        hash.point(self.gravity);
        hash.number(self.dt);
        hash.whole(self.warm_up_steps.into());
        hash.whole(self.measured_steps.into());
        hash.whole(self.sleeping.into());
        hash.points(self.region.as_ref().map_or(&[], |corners| &corners[..]));
        hash.count(self.materials.len());
        for material in &self.materials {
            hash.number(material.density);
            hash.number(material.friction);
            hash.number(material.restitution);
        }
        hash.count(self.shapes.len());
        for shape in &self.shapes {
            hash.shape(shape);
        }
        hash.count(self.outlines.len());
        for outline in &self.outlines {
            hash.points(outline);
        }
        hash.count(self.bodies.len());
        for body in &self.bodies {
            hash.body(body);
        }
        hash.0.finish()
    }
}

/// Bits as they are: unlike a state's, a scene's −0 is not its 0.
struct Digest(StateHash);

impl Digest {
    fn whole(&mut self, value: u64) {
        self.0.write_u64(value);
    }

    fn count(&mut self, value: usize) {
        self.whole(value as u64);
    }

    fn number(&mut self, value: f64) {
        self.whole(value.to_bits());
    }

    fn point(&mut self, point: Vec2) {
        self.number(point.x);
        self.number(point.y);
    }

    fn points(&mut self, points: &[Vec2]) {
        self.count(points.len());
        for &point in points {
            self.point(point);
        }
    }

    fn shape(&mut self, shape: &PlainShape) {
        match shape {
            PlainShape::Circle { radius } => {
                self.whole(0);
                self.number(*radius);
            }
            PlainShape::Box { half, offset } => {
                self.whole(1);
                self.points(&[*half, *offset]);
            }
            PlainShape::Polygon(corners) => {
                self.whole(2);
                self.points(corners);
            }
            PlainShape::Segment(ends) => {
                self.whole(3);
                self.points(ends);
            }
        }
    }

    fn body(&mut self, body: &PlainBody) {
        self.whole(match body.kind {
            PlainKind::Fixed => 0,
            PlainKind::Dynamic => 1,
            PlainKind::Kinematic => 2,
        });
        self.points(&[body.position, body.velocity]);
        self.number(body.angle);
        self.number(body.spin);
        self.count(body.shapes.len());
        for &shape in &body.shapes {
            self.count(shape);
        }
        self.whole(body.outline.map_or(0, |outline| outline as u64 + 1));
        self.count(body.material);
        self.whole(body.asleep.into());
        self.whole(body.bullet.into());
    }
}

impl PlainShape {
    /// A rectangle about the body's origin, by half of its width and height, in m.
    #[must_use]
    pub const fn rectangle(half_width: f64, half_height: f64) -> Self {
        Self::Box {
            half: vec2(half_width, half_height),
            offset: Vec2::ZERO,
        }
    }
}

impl PlainBody {
    /// A body at rest, without shapes.
    #[must_use]
    pub const fn new(kind: PlainKind, position: Vec2, material: usize) -> Self {
        Self {
            kind,
            position,
            angle: 0.0,
            velocity: Vec2::ZERO,
            spin: 0.0,
            shapes: Vec::new(),
            outline: None,
            material,
            asleep: false,
            bullet: false,
        }
    }

    /// Turned by `angle`, in rad.
    #[must_use]
    pub fn turned(self, angle: f64) -> Self {
        Self { angle, ..self }
    }

    /// Moving with `velocity`, in m/s.
    #[must_use]
    pub fn moving(self, velocity: Vec2) -> Self {
        Self { velocity, ..self }
    }

    /// Spinning with `spin`, in rad/s.
    #[must_use]
    pub fn spinning(self, spin: f64) -> Self {
        Self { spin, ..self }
    }
}
