//! Scenes as plain data: bodies that any engine can be given, the same bits for all.

use carom_math::Vec2;

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

/// Who moves a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlainKind {
    /// Nobody.
    Fixed,
    /// Forces and contacts.
    Dynamic,
    /// Its own velocity, whatever it meets.
    Kinematic,
}

/// A body at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainBody {
    /// Who moves it.
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

    /// Adds a material and gives its index.
    pub fn material(&mut self, density: f64, friction: f64, restitution: f64) -> usize {
        self.materials.push(PlainMaterial {
            density,
            friction,
            restitution,
        });
        self.materials.len() - 1
    }

    /// Adds a body of one shape and gives its index.
    pub fn add(&mut self, body: PlainBody, shape: PlainShape) -> usize {
        self.shapes.push(shape);
        let shapes = vec![self.shapes.len() - 1];
        self.bodies.push(PlainBody { shapes, ..body });
        self.bodies.len() - 1
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

/// The plain scene of a name: `a_large_pyramid` … `i_mostly_empty`, `e_medium`, `e_dilute`, `case12_polygon_gas`, …
#[must_use]
pub fn plain_scene(name: &str) -> Option<PlainScene> {
    let _ = name;
    None
}
