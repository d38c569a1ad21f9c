//! Convex pieces of bodies, and their outlines.

use std::sync::Arc;

use carom_collision::{Hull, part, part_count};
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, Vec2, vec2};

use crate::EngineError;
use crate::error::{check, finite, not_negative};
use crate::rows::Numbers;

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
/// ```text
/// x y reach extent | radius corners – – | – – – – | – – – –          x, y: where the centre of mass is in space
/// x x x x | y y y y | nx nx nx nx | ny ny ny ny                     corners 0 to 3, and the normals of edges 0 to 3
/// x x x x | y y y y | nx nx nx nx | ny ny ny ny                     corners 4 to 7
/// ```
/// Edge i goes from corner i to the next; a disc has one corner and no edge, a segment two of both. What is not there
/// repeats the first, and so is never nearer, nor separates better. Five cache lines, of which boxes have three.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Outline([f64; 40]);

impl Numbers for Outline {
    fn numbers(&self) -> &[f64] {
        &self.0
    }
}

impl Outline {
    /// Where the x of four corners begin; their y and their normals follow, four by four.
    pub(crate) const QUADS: [usize; 2] = [8, 24];

    const EMPTY: Self = Self([0.0; 40]);

    /// The outline of a piece; without corners if it has none: a half-plane, cuts, too many corners.
    fn of(piece: &Piece) -> Self {
        let hull = piece.hull();
        let corners = hull.vertices.len();
        let mut outline = Self::EMPTY;
        outline.0[2..4].copy_from_slice(&[piece.reach, piece.extent]);
        if hull.is_half_plane() || hull.boundary.is_some() || corners > CORNERS {
            return outline;
        }
        outline.0[4..6].copy_from_slice(&[hull.radius + piece.rounding, corners as f64]);
        for i in 0..CORNERS {
            let k = if i < corners { i } else { 0 };
            let at = Self::at(i);
            let n = hull.normals.get(k).copied().unwrap_or(Vec2::ZERO);
            (outline.0[at], outline.0[at + 4]) = (hull.vertices[k].x, hull.vertices[k].y);
            (outline.0[at + 8], outline.0[at + 12]) = (n.x, n.y);
        }
        outline
    }

    /// Becomes that of a body with this pose.
    fn pose(&mut self, of_body: &Self, pose: Pose) {
        self.0[..8].copy_from_slice(&of_body.0[..8]);
        (self.0[0], self.0[1]) = (pose.position.x, pose.position.y);
        let (c, s) = (pose.rotation.cos(), pose.rotation.sin());
        let mut turn = |from: usize| {
            let (x, y) = (&of_body.0[from..from + 4], &of_body.0[from + 4..from + 8]);
            let to = &mut self.0[from..from + 8];
            for i in 0..4 {
                to[i] = c * x[i] - s * y[i];
                to[i + 4] = s * x[i] + c * y[i];
            }
        };
        turn(8);
        turn(16);
        // Corners 4 to 7 of what has fewer are never read.
        if of_body.count() > 4.0 {
            turn(24);
            turn(32);
        }
    }

    /// Where the x of a corner is.
    const fn at(i: usize) -> usize {
        Self::QUADS[i / 4] + i % 4
    }

    /// Where the centre of mass of its body is.
    pub(crate) const fn centre(&self) -> Vec2 {
        vec2(self.0[0], self.0[1])
    }

    /// Of its piece, in m.
    pub(crate) const fn reach(&self) -> f64 {
        self.0[2]
    }

    /// Of its piece, in m.
    pub(crate) const fn extent(&self) -> f64 {
        self.0[3]
    }

    pub(crate) const fn radius(&self) -> f64 {
        self.0[4]
    }

    /// How many corners it has; 0 is no outline.
    pub(crate) const fn count(&self) -> f64 {
        self.0[5]
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most eight"
    )]
    pub(crate) const fn corners(&self) -> usize {
        self.0[5] as usize
    }

    pub(crate) const fn corner(&self, i: usize) -> Vec2 {
        let at = Self::at(i);
        vec2(self.0[at], self.0[at + 4])
    }

    pub(crate) const fn normal(&self, i: usize) -> Vec2 {
        let at = Self::at(i);
        vec2(self.0[at + 8], self.0[at + 12])
    }

    /// `normal · point` of all points of an edge.
    pub(crate) fn off(&self, i: usize) -> f64 {
        self.normal(i).dot(self.corner(i))
    }

    pub(crate) const fn next(&self, i: usize) -> usize {
        if i + 1 == self.corners() { 0 } else { i + 1 }
    }

    /// The box around it.
    fn aabb(&self) -> Aabb {
        let (mut low, mut high) = (self.corner(0), self.corner(0));
        let last = if self.count() > 4.0 { CORNERS } else { 4 };
        for i in 1..last {
            low = low.min(self.corner(i));
            high = high.max(self.corner(i));
        }
        let centre = self.centre();
        Aabb::new(centre + low, centre + high).grown(self.radius())
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

/// Slot of the body of a piece, and the index that it has there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Owner {
    pub(crate) body: u32,
    pub(crate) ordinal: u32,
}

/// All pieces; those of a body have consecutive numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    pub(crate) list: Vec<Piece>,
    /// What is asked of a piece most often.
    pub(crate) owners: Vec<Owner>,
    /// Outlines as the bodies have them.
    outlines: Vec<Outline>,
    /// Outlines in the base poses of their bodies; no corners: the piece has no outline.
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
            let outline = Outline::of(&piece);
            let owner = Owner {
                body: piece.body,
                ordinal: piece.ordinal,
            };
            if number == self.list.len() {
                self.outlines.push(outline);
                self.owners.push(owner);
                self.list.push(piece);
                self.turned.push(Outline::EMPTY);
                self.boxes.push(Aabb::EMPTY);
                self.discs.push(Disc::ENDLESS);
            } else {
                self.outlines[number] = outline;
                self.owners[number] = owner;
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
        self.turned[k].pose(&self.outlines[k], pose);
        if self.turned[k].count() > 0.0 {
            self.turned[k].aabb()
        } else {
            let piece = &self.list[k];
            piece.hull().aabb(pose).grown(piece.rounding)
        }
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
                let (reach, extent) = if half_plane {
                    (f64::INFINITY, f64::INFINITY)
                } else {
                    (reach, extent(&hull) + 2.0 * rounding)
                };
                Self {
                    body,
                    ordinal,
                    part: i,
                    rounding,
                    material,
                    extent,
                    reach,
                    shape: Arc::clone(&shape),
                }
            })
    }

    pub(crate) fn hull(&self) -> Hull<'_> {
        part(&self.shape, self.part)
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
