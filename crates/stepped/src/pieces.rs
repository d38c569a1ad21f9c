//! Convex pieces of bodies, and their outlines.

use std::sync::Arc;

use carom_collision::{Hull, part, part_count};
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};

use crate::EngineError;
use crate::error::{check, finite, not_negative};

/// Corners of an outline.
pub(crate) const CORNERS: usize = 8;

/// What a surface is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Coefficient of friction; a pair has the root of the product.
    pub friction: f64,
    /// Coefficient of restitution: 0 sticks, 1 returns all normal speed; a pair has the larger one.
    pub restitution: f64,
}

impl Material {
    /// What two surfaces are to each other.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            friction: (self.friction * other.friction).sqrt(),
            restitution: self.restitution.max(other.restitution),
        }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            friction: 0.6,
            restitution: 0.0,
        }
    }
}

/// A shape of a body with its surface.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceInput {
    /// In the frame of the body, whose origin is the centre of mass, in m. A concave polygon becomes its convex pieces.
    pub shape: Shape,
    /// The shape is grown by so much, with rounded corners, in m.
    pub radius: f64,
    /// Its surface.
    pub material: Material,
}

impl PieceInput {
    /// A shape with sharp corners and the default material.
    pub fn new(shape: impl Into<Shape>) -> Self {
        Self {
            shape: shape.into(),
            radius: 0.0,
            material: Material::default(),
        }
    }

    /// The same with this surface.
    #[must_use]
    pub const fn with_material(mut self, material: Material) -> Self {
        self.material = material;
        self
    }

    /// The same, grown by `radius` metres.
    #[must_use]
    pub const fn rounded(mut self, radius: f64) -> Self {
        self.radius = radius;
        self
    }

    pub(crate) fn check(&self) -> Result<(), EngineError> {
        not_negative("PieceInput::radius", self.radius)?;
        not_negative("Material::friction", self.material.friction)?;
        let e = self.material.restitution;
        finite("Material::restitution", e)?;
        check(
            "Material::restitution",
            e,
            (0.0..=1.0).contains(&e),
            "from 0 to 1",
        )
    }
}

/// At most eight corners, counter-clockwise, relative to the centre of mass, in m; grown by a radius.
///
/// Edge i goes from corner i to the next; its points have `normal · point = off`. A disc has one corner and no edge, a
/// segment two of both. 336 bytes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct Outline {
    pub(crate) x: [f64; CORNERS],
    pub(crate) y: [f64; CORNERS],
    pub(crate) nx: [f64; CORNERS],
    pub(crate) ny: [f64; CORNERS],
    pub(crate) off: [f64; CORNERS],
    pub(crate) radius: f64,
    pub(crate) corners: usize,
}

impl Outline {
    /// Of a piece that has none.
    const NONE: Self = Self {
        x: [0.0; CORNERS],
        y: [0.0; CORNERS],
        nx: [0.0; CORNERS],
        ny: [0.0; CORNERS],
        off: [0.0; CORNERS],
        radius: 0.0,
        corners: 0,
    };

    /// The outline of a hull, if it has one: no half-plane, no cuts, not too many corners.
    fn of(hull: &Hull<'_>, radius: f64) -> Option<Self> {
        let corners = hull.vertices.len();
        if hull.is_half_plane() || hull.boundary.is_some() || corners > CORNERS {
            return None;
        }
        let first = hull.vertices[0];
        let mut outline = Self {
            // Corners that are not there repeat the first: they are never the deepest before it.
            x: [first.x; CORNERS],
            y: [first.y; CORNERS],
            // Edges that are not there separate nothing.
            nx: [0.0; CORNERS],
            ny: [0.0; CORNERS],
            off: [1e9; CORNERS],
            radius: hull.radius + radius,
            corners,
        };
        for (i, v) in hull.vertices.iter().enumerate() {
            (outline.x[i], outline.y[i]) = (v.x, v.y);
        }
        for (i, n) in hull.normals.iter().enumerate() {
            (outline.nx[i], outline.ny[i]) = (n.x, n.y);
            outline.off[i] = n.dot(hull.vertices[i]);
        }
        Some(outline)
    }

    /// The same outline of a body that is turned by `rot`.
    pub(crate) fn turned(&self, rot: Rot) -> Self {
        let mut turned = *self;
        let (c, s) = (rot.cos(), rot.sin());
        for i in 0..CORNERS {
            turned.x[i] = c * self.x[i] - s * self.y[i];
            turned.y[i] = s * self.x[i] + c * self.y[i];
            turned.nx[i] = c * self.nx[i] - s * self.ny[i];
            turned.ny[i] = s * self.nx[i] + c * self.ny[i];
        }
        turned
    }

    pub(crate) const fn corner(&self, i: usize) -> Vec2 {
        vec2(self.x[i], self.y[i])
    }

    pub(crate) const fn normal(&self, i: usize) -> Vec2 {
        vec2(self.nx[i], self.ny[i])
    }

    pub(crate) const fn next(&self, i: usize) -> usize {
        if i + 1 == self.corners { 0 } else { i + 1 }
    }

    /// The box around it with the centre of mass at `centre`.
    fn aabb(&self, centre: Vec2) -> Aabb {
        let (mut low, mut high) = (self.corner(0), self.corner(0));
        for i in 1..CORNERS {
            low = low.min(self.corner(i));
            high = high.max(self.corner(i));
        }
        Aabb::new(centre + low, centre + high).grown(self.radius)
    }
}

/// A convex piece of a body.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Slot of its body.
    pub(crate) body: u32,
    /// Index among the pieces of its body: part of the order in which contacts are created.
    pub(crate) ordinal: u32,
    shape: Arc<Shape>,
    part: usize,
    /// What the shape is grown by, in m.
    pub(crate) rounding: f64,
    outline: Option<Box<Outline>>,
    pub(crate) material: Material,
    /// Twice the distance from its middle to its nearest side, in m; of something without a width an eighth of its length.
    pub(crate) extent: f64,
    /// Distance of its farthest point from the centre of mass, in m.
    pub(crate) reach: f64,
}

/// A circle around what a piece may reach within the tick but for its velocity: bodies that go side by side do not meet,
/// though their swept boxes overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    pub(crate) centre: Vec2,
    /// In m/s.
    pub(crate) velocity: Vec2,
    pub(crate) radius: f64,
}

impl Disc {
    /// Of what has no circle.
    pub(crate) const ENDLESS: Self = Self {
        centre: Vec2::ZERO,
        velocity: Vec2::ZERO,
        radius: f64::INFINITY,
    };

    /// Whether two may meet within `time` seconds.
    pub(crate) fn may_meet(&self, other: &Self, time: f64) -> bool {
        let speed = other.velocity - self.velocity;
        let reach = self.radius + other.radius + (speed.x.abs() + speed.y.abs()) * time;
        (other.centre - self.centre).length_squared() <= reach * reach
    }
}

/// All pieces; those of a body have consecutive numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    pub(crate) list: Vec<Piece>,
    /// Outlines turned by the base poses of their bodies; no corners: the piece has no outline.
    pub(crate) turned: Vec<Outline>,
    /// Boxes around what a piece may reach within the tick, each with half a margin.
    pub(crate) boxes: Vec<Aabb>,
    /// Circles around movers, and their velocities.
    pub(crate) discs: Vec<Disc>,
    /// First and count of numbers in use no more.
    free: Vec<(u32, u32)>,
}

impl Pieces {
    /// Numbers the pieces of a body; gives the first number.
    pub(crate) fn insert(&mut self, pieces: Vec<Piece>) -> u32 {
        #[expect(clippy::cast_possible_truncation, reason = "hundreds of bytes each")]
        let (end, count) = (self.list.len() as u32, pieces.len() as u32);
        let again = self.free.iter().rposition(|free| free.1 == count);
        let first = again.map_or(end, |k| self.free.swap_remove(k).0);
        for (number, piece) in (first as usize..).zip(pieces) {
            if number == self.list.len() {
                self.list.push(piece);
                self.turned.push(Outline::NONE);
                self.boxes.push(Aabb::EMPTY);
                self.discs.push(Disc::ENDLESS);
            } else {
                self.list[number] = piece;
            }
        }
        first
    }

    pub(crate) fn remove(&mut self, first: u32, count: u32) {
        self.free.push((first, count));
    }

    /// Takes over the pose of a body, and gives the box that the piece is in.
    pub(crate) fn pose(&mut self, number: u32, pose: Pose) -> Aabb {
        let k = number as usize;
        let piece = &self.list[k];
        self.turned[k] = piece.turned(pose.rotation).unwrap_or(Outline::NONE);
        let turned = (self.turned[k].corners > 0).then_some(&self.turned[k]);
        piece.aabb(turned, pose)
    }
}

impl Piece {
    /// The convex pieces of an input.
    pub(crate) fn of(input: &PieceInput, body: u32, first: u32) -> impl Iterator<Item = Self> {
        let shape = Arc::new(input.shape.clone());
        let (rounding, material) = (input.radius, input.material);
        (first..)
            .zip(0..part_count(&shape))
            .map(move |(ordinal, i)| {
                let hull = part(&shape, i);
                let around = hull.vertices.iter().map(|v| v.length());
                let reach = around.fold(0.0, f64::max) + hull.radius + rounding;
                let half_plane = hull.is_half_plane();
                Self {
                    body,
                    ordinal,
                    part: i,
                    rounding,
                    outline: Outline::of(&hull, rounding).map(Box::new),
                    material,
                    extent: if half_plane {
                        f64::INFINITY
                    } else {
                        extent(&hull) + 2.0 * rounding
                    },
                    reach: if half_plane { f64::INFINITY } else { reach },
                    shape: Arc::clone(&shape),
                }
            })
    }

    /// What to collide: turned as the body is.
    fn turned(&self, rot: Rot) -> Option<Outline> {
        self.outline.as_ref().map(|outline| outline.turned(rot))
    }

    pub(crate) fn hull(&self) -> Hull<'_> {
        part(&self.shape, self.part)
    }

    /// The box around it, given its turned outline if it has one.
    fn aabb(&self, turned: Option<&Outline>, pose: Pose) -> Aabb {
        match turned {
            Some(outline) => outline.aabb(pose.position),
            None => self.hull().aabb(pose).grown(self.rounding),
        }
    }
}

/// Twice the distance from the middle of the corners to the nearest side.
fn extent(hull: &Hull<'_>) -> f64 {
    let mut middle = Vec2::ZERO;
    let mut count = 0.0;
    for v in hull.vertices {
        middle += *v;
        count += 1.0;
    }
    middle /= count;
    let sides = hull.normals.iter().zip(hull.vertices);
    let inner = sides.map(|(n, v)| n.dot(*v - middle));
    let inner = inner.fold(f64::INFINITY, f64::min);
    let around = hull.vertices.iter().map(|v| (*v - middle).length());
    let outer = around.fold(0.0, f64::max);
    if hull.normals.is_empty() {
        2.0 * hull.radius
    } else {
        2.0 * inner.max(0.125 * outer) + 2.0 * hull.radius
    }
}
