//! Random shapes and poses for both libraries.

use carom_geometry::{Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use parry2d_f64::math::{Pose as TheirPose, Vector};
use parry2d_f64::shape::SharedShape;

use crate::naive::Solid;

/// SplitMix64 (Steele, Lea, Flood 2014): the same questions everywhere.
#[derive(Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(number: u64) -> Self {
        Self(number.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(1))
    }

    /// Below 1, not below 0.
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub(crate) fn turn(&mut self) -> Rot {
        Rot::from_angle(self.between(-4.0, 4.0))
    }
}

/// Kinds of shapes, each of about a metre.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Box,
    Regular(usize),
    Disc,
    L,
    Star(usize),
}

impl Kind {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Box => "box".to_owned(),
            Self::Regular(6) => "hexagon".to_owned(),
            Self::Regular(n) => format!("{n}-gon"),
            Self::Disc => "disc".to_owned(),
            Self::L => "L".to_owned(),
            Self::Star(points) => format!("star of {points}"),
        }
    }

    pub(crate) const fn is_convex_polygon(self) -> bool {
        matches!(self, Self::Box | Self::Regular(_))
    }

    pub(crate) fn make(self, random: &mut Random) -> Shape {
        const GOOD: &str = "lengths above 0";
        match self {
            Self::Box => {
                let (width, height) = (random.between(0.5, 1.5), random.between(0.5, 1.5));
                ConvexPolygon::rectangle(width, height).expect(GOOD).into()
            }
            Self::Regular(n) => {
                let polygon = ConvexPolygon::regular(n, random.between(0.5, 1.0));
                polygon.expect(GOOD).into()
            }
            Self::Disc => Circle::new(random.between(0.3, 0.8)).expect(GOOD).into(),
            Self::L => {
                let (w, t) = (random.between(0.8, 1.2), random.between(0.2, 0.4));
                let ring = [
                    (-w, -w),
                    (w, -w),
                    (w, t - w),
                    (t - w, t - w),
                    (t - w, w),
                    (-w, w),
                ];
                Polygon::new(ring.map(Vec2::from)).expect(GOOD).into()
            }
            Self::Star(points) => {
                let star = Polygon::star(points, random.between(0.8, 1.2), 0.5);
                star.expect(GOOD).into()
            }
        }
    }
}

/// Two shapes and B in A's frame, for both libraries.
#[derive(Debug)]
pub(crate) struct Pair {
    pub(crate) a: Shape,
    pub(crate) b: Shape,
    pub(crate) pose: Pose,
    pub(crate) their_a: SharedShape,
    pub(crate) their_b: SharedShape,
    pub(crate) their_pose: TheirPose,
}

impl Pair {
    /// `count` pairs of two kinds, up to `reach` metres apart along each axis.
    pub(crate) fn some(count: u64, kinds: (Kind, Kind), reach: f64) -> Vec<Self> {
        let one = |number| {
            let mut random = Random::new(number + 77);
            let (a, b) = (kinds.0.make(&mut random), kinds.1.make(&mut random));
            let place = vec2(random.between(-reach, reach), random.between(-reach, reach));
            let pose = Pose::new(place, random.turn());
            Self {
                their_a: theirs(&a),
                their_b: theirs(&b),
                their_pose: their_pose(pose),
                a,
                b,
                pose,
            }
        };
        (0..count).map(one).collect()
    }
}

/// What the brute force sees.
pub(crate) fn solid(shape: &Shape, pose: Pose) -> Solid {
    match shape {
        Shape::Circle(disc) => Solid::Disc(pose.point(disc.centre()), disc.radius()),
        other => Solid::Ring(other.vertices().iter().map(|v| pose.point(*v)).collect()),
    }
}

pub(crate) fn vector(v: Vec2) -> Vector {
    Vector::new(v.x, v.y)
}

pub(crate) fn their_pose(pose: Pose) -> TheirPose {
    TheirPose::new(vector(pose.position), pose.rotation.angle())
}

/// A convex polygon of parry's, corners as they are.
pub(crate) fn their_convex(vertices: &[Vec2]) -> SharedShape {
    let points = vertices.iter().copied().map(vector).collect();
    SharedShape::convex_polyline_unmodified(points).expect("strictly convex")
}

/// Concave polygons are compounds of the same pieces: parry has no polygon of its own.
fn theirs(shape: &Shape) -> SharedShape {
    match shape {
        Shape::Circle(disc) => SharedShape::ball(disc.radius()),
        Shape::Polygon(polygon) => {
            let pieces = polygon.pieces().iter();
            let placed = |vertices| (TheirPose::IDENTITY, their_convex(vertices));
            SharedShape::compound(pieces.map(|piece| placed(piece.vertices())).collect())
        }
        convex => their_convex(convex.vertices()),
    }
}
