//! Convex pieces of bodies, and their outlines.

use std::sync::Arc;

use carom_collision::{Hull, part, part_count};
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, Vec2};

use crate::bodies::number;
use crate::error::{check, finite, not_negative};
use crate::outline::{CORNERS, Outline, outline_of};
use crate::{BodyIx, EngineError, PairRules, PieceIx, Surface};

/// What a surface is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Coefficient of friction; [`Mixed`](crate::Mixed) takes the root of the product.
    pub friction: f64,
    /// Coefficient of restitution: 0 sticks, 1 returns all normal speed; [`Mixed`](crate::Mixed) takes the larger one.
    pub restitution: f64,
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
    /// In the frame of the body, with its origin at the centre of mass, in m. A concave polygon becomes its convex pieces.
    pub shape: Arc<Shape>,
    /// The shape is grown by so much, with rounded corners, in m.
    pub radius: f64,
    /// Its surface.
    pub material: Material,
    /// The caller's own: [`PairRules`](crate::PairRules) and [`Touch`](crate::Touch) name pieces by it.
    pub tag: u64,
}

impl PieceInput {
    /// A shape with sharp corners and the default material.
    pub fn new(shape: impl Into<Shape>) -> Self {
        Self::shared(Arc::new(shape.into()))
    }

    /// The same with a shape that others have, too.
    #[must_use]
    pub fn shared(shape: Arc<Shape>) -> Self {
        Self {
            shape,
            radius: 0.0,
            material: Material::default(),
            tag: 0,
        }
    }

    /// The same with this tag.
    #[must_use]
    pub const fn tagged(mut self, tag: u64) -> Self {
        self.tag = tag;
        self
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

/// A convex piece of a body.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Slot of its body.
    pub(crate) body: BodyIx,
    /// Index among the pieces of its body: part of the order in which contacts are created.
    pub(crate) ordinal: u32,
    shape: Arc<Shape>,
    /// Which convex part of its shape.
    pub(crate) part: usize,
    /// What the shape is grown by, in m.
    pub(crate) rounding: f64,
    pub(crate) material: Material,
    pub(crate) tag: u64,
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
    /// How far from its outline the piece may reach within the tick but for its velocity, in m.
    pub(crate) beyond: f64,
}

impl Disc {
    /// Of what stands, and has no circle.
    pub(crate) const fn endless(beyond: f64) -> Self {
        Self {
            centre: Vec2::ZERO,
            velocity: Vec2::ZERO,
            radius: f64::INFINITY,
            beyond,
        }
    }

    /// Whether two may meet within `time` seconds.
    pub(crate) fn may_meet(&self, other: &Self, time: f64) -> bool {
        let reach = self.radius + other.radius + self.nears(other, time);
        (other.centre - self.centre).length_squared() <= reach * reach
    }

    /// How far two go against each other in `time` seconds, at most.
    fn nears(&self, other: &Self, time: f64) -> f64 {
        let speed = other.velocity - self.velocity;
        (speed.x.abs() + speed.y.abs()) * time
    }
}

/// Slot of the body of a piece, and the index that it has there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Owner {
    pub(crate) body: BodyIx,
    pub(crate) ordinal: u32,
    /// The body has other pieces.
    pub(crate) several: bool,
}

/// All pieces; those of a body have consecutive numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    pub(crate) list: Vec<Piece>,
    /// What is asked of a piece most often.
    pub(crate) owners: Vec<Owner>,
    /// Outlines as the bodies have them.
    of_body: Vec<Outline>,
    /// Outlines in the base poses of their bodies; no corners: the piece has no outline.
    pub(crate) outlines: Vec<Outline>,
    /// Boxes around what a piece may reach within the tick, each with half a margin.
    pub(crate) boxes: Vec<Aabb>,
    /// Circles around movers, and their velocities.
    pub(crate) discs: Vec<Disc>,
    /// First and count of numbers in use no more.
    free: Vec<(PieceIx, u32)>,
    /// Of contacts, as a part of the smaller piece's extent.
    margin: f64,
}

impl Pieces {
    pub(crate) fn new(margin: f64) -> Self {
        Self {
            margin,
            ..Self::default()
        }
    }

    /// Whether a piece comes nearer to one that stands than its own margin. Boxes have half of their own each, and that of a long floor
    /// is tens of metres.
    #[inline]
    pub(crate) fn is_near(&self, piece: PieceIx, stands: PieceIx) -> bool {
        let [own, theirs] = [piece, stands].map(|piece| self.outlines[piece].extent());
        let spare = 0.5 * self.margin * (theirs - own);
        let bounds = self.boxes[piece].grown(-spare);
        bounds.overlaps(self.boxes[stands])
    }

    /// Whether a piece that moves stays beyond a half-plane that stands, by more than the margin, for `time` seconds.
    pub(crate) fn is_beyond_plane(&self, piece: PieceIx, plane: PieceIx, time: f64) -> bool {
        let [disc, standing] = [piece, plane].map(|piece| &self.discs[piece]);
        let half_margin = 0.5 * self.margin * self.outlines[piece].extent();
        let far = disc.radius + half_margin + disc.nears(standing, time);
        self.outline(plane).is_beyond_plane(disc.centre, far)
    }

    /// Numbers the pieces of a body; gives the first number.
    pub(crate) fn insert(&mut self, pieces: Vec<Piece>) -> PieceIx {
        let (end, count) = (PieceIx::new(self.list.len()), number(pieces.len()));
        let again = self.free.iter().rposition(|free| free.1 == count);
        let first = again.map_or(end, |k| self.free.swap_remove(k).0);
        for (number, piece) in (first.at()..).zip(pieces) {
            let outline = outline(&piece);
            let owner = Owner {
                body: piece.body,
                ordinal: piece.ordinal,
                several: count > 1,
            };
            if number == self.list.len() {
                self.of_body.push(outline);
                self.owners.push(owner);
                self.list.push(piece);
                self.outlines.push(outline);
                self.boxes.push(Aabb::EMPTY);
                self.discs.push(Disc::endless(f64::INFINITY));
            } else {
                self.of_body[number] = outline;
                self.owners[number] = owner;
                self.list[number] = piece;
            }
        }
        first
    }

    /// How two pieces meet, if they do.
    pub(crate) fn surface(&self, pair: [PieceIx; 2], rules: &dyn PairRules) -> Option<Surface> {
        let [a, b] = pair.map(|piece| &self.list[piece]);
        rules.surface([a.tag, b.tag], [a.material, b.material])
    }

    /// Slots of the bodies of two pieces.
    pub(crate) fn bodies(&self, pair: [PieceIx; 2]) -> [BodyIx; 2] {
        pair.map(|piece| self.owners[piece].body)
    }

    /// Whether they belong to two bodies.
    pub(crate) fn are_of_two(&self, a: PieceIx, b: PieceIx) -> bool {
        self.owners[a].body != self.owners[b].body
    }

    /// Whether one of two pieces stays beyond a side of the other one for `time` seconds, as beside a plank that is askew, the circle of
    /// which is wide. Where no circle is more than twice as wide as the other, circles alone tell.
    #[inline]
    pub(crate) fn are_beside(&self, a: PieceIx, b: PieceIx, time: f64) -> bool {
        let radius = |piece: PieceIx| self.discs[piece].radius;
        let (large, small) = if radius(a) > radius(b) {
            (a, b)
        } else {
            (b, a)
        };
        radius(large) > 2.0 * radius(small) && self.is_beside(large, small, time)
    }

    fn is_beside(&self, large: PieceIx, small: PieceIx, time: f64) -> bool {
        let [disc, small] = [large, small].map(|piece| &self.discs[piece]);
        let far = small.radius + disc.beyond + disc.nears(small, time);
        self.outline(large).is_beyond_side(small.centre, far)
    }

    /// Tags of two pieces.
    pub(crate) fn tags(&self, pair: [PieceIx; 2]) -> [u64; 2] {
        pair.map(|piece| self.list[piece].tag)
    }

    /// Their numbers are free again, and in no box.
    pub(crate) fn remove(&mut self, first: PieceIx, count: u32) {
        self.boxes[first.at()..][..count as usize].fill(Aabb::EMPTY);
        self.free.push((first, count));
    }

    /// Takes over the pose of a body, and gives the box that the piece is in.
    pub(crate) fn pose(&mut self, number: PieceIx, pose: Pose) -> Aabb {
        let outline = &mut self.outlines[number];
        outline.pose(&self.of_body[number], pose);
        if outline.count() > 0.0 {
            outline.aabb()
        } else {
            let piece = &self.list[number];
            piece.hull().aabb(pose).grown(piece.rounding)
        }
    }

    /// The outline of a piece in the base pose of its body.
    pub(crate) fn outline(&self, piece: PieceIx) -> &Outline {
        &self.outlines[piece]
    }
}

/// The outline of a piece; without corners if it has none: a half-plane, too many corners.
fn outline(piece: &Piece) -> Outline {
    let hull = piece.hull();
    let (vertices, normals) = if hull.vertices.len() > CORNERS {
        (&[][..], &[][..])
    } else {
        (hull.vertices, hull.normals)
    };
    let cuts = (0..normals.len()).filter(|i| !hull.is_boundary(*i));
    let cuts = cuts.fold(0, |cuts, i| cuts | 1 << i);
    let radius = hull.radius + piece.rounding;
    let mut outline = outline_of(vertices, normals, cuts, [piece.reach, piece.extent, radius]);
    if hull.is_half_plane() {
        outline.leave_no_sides();
    }
    outline
}

impl Piece {
    /// The convex pieces of an input.
    pub(crate) fn of(input: &PieceInput, body: BodyIx, first: u32) -> impl Iterator<Item = Self> {
        let shape = Arc::clone(&input.shape);
        let (rounding, material, tag) = (input.radius, input.material, input.tag);
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
                    let (width, least) = widths(&hull);
                    (reach, width.max(least) + 2.0 * rounding)
                };
                Self {
                    body,
                    ordinal,
                    part: i,
                    rounding,
                    material,
                    tag,
                    extent,
                    reach,
                    shape: Arc::clone(&shape),
                }
            })
    }

    /// The shape that it is, or is a part of.
    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    pub(crate) fn hull(&self) -> Hull<'_> {
        part(&self.shape, self.part)
    }

    /// How thick it is, in m: the extent, but of what is thin.
    pub(crate) fn width(&self) -> f64 {
        widths(&self.hull()).0 + 2.0 * self.rounding
    }
}

/// Twice the distance from the middle of the corners to the nearest side, and an eighth of twice that to the farthest corner, in m.
fn widths(hull: &Hull<'_>) -> (f64, f64) {
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
    let (inner, outer) = if hull.normals.is_empty() {
        (0.0, 0.0)
    } else {
        (inner, 0.125 * outer)
    };
    let round = 2.0 * hull.radius;
    (2.0 * inner + round, 2.0 * outer + round)
}
