//! Where bodies lie in each other.

use carom_dynamics::{Body, BodyId};
use carom_geometry::Shape;
use carom_math::{Pose, Rot, Vec2, cross, vec2};

use super::{Overlaid, TEXT};
use crate::{Ink, Label, Op};

/// Corners of a disc that is cut.
const CORNERS: u32 = 96;
/// Radius of the ring around the deepest place, in pixels of the overlay.
const RING: f64 = 9.0;
/// Depth from which every overlap has its size beside it, in pixels.
const DEEP: f64 = 2.0;

/// The deepest point of a pair of bodies.
#[derive(Clone, Copy, Debug)]
struct Deepest {
    bodies: (BodyId, BodyId),
    point: Vec2,
    /// In m, positive.
    depth: f64,
}

impl Overlaid<'_> {
    pub(super) fn overlaps(&mut self) {
        if !self.look.overlay.overlaps {
            return;
        }
        let pairs = self.overlapping();
        for pair in &pairs {
            self.shade(pair.bodies);
        }
        let deepest = pairs.iter().map(|pair| pair.depth).fold(0.0, f64::max);
        let mut ringed = false;
        for pair in &pairs {
            let is_deepest = !ringed && pair.depth >= deepest;
            ringed |= is_deepest;
            let at = self.camera.point(pair.point);
            if is_deepest {
                self.frame.push(Op::Ring {
                    centre: at,
                    radius: RING * self.unit,
                    width: 1.4 * self.unit,
                    ink: Ink::Contact,
                });
            }
            if is_deepest || self.camera.length(pair.depth) > DEEP {
                let beside = at + vec2(1.0, -1.0) * (RING * self.unit);
                let text = Label::new(beside, length(pair.depth), TEXT * self.unit, Ink::Contact);
                self.frame.push(text.with_halo());
            }
        }
    }

    /// Every pair of bodies that overlaps, with its deepest point.
    fn overlapping(&self) -> Vec<Deepest> {
        let mut pairs: Vec<Deepest> = Vec::new();
        for contact in self.world.contacts() {
            let bodies = (contact.a, contact.b);
            for point in &contact.points {
                let found = Deepest {
                    bodies,
                    point: point.position,
                    depth: -point.separation,
                };
                if found.depth <= 0.0 {
                    continue;
                }
                match pairs.last_mut().filter(|last| last.bodies == bodies) {
                    Some(last) if last.depth >= found.depth => {}
                    Some(last) => *last = found,
                    None => pairs.push(found),
                }
            }
        }
        pairs
    }

    /// The area that two bodies share.
    fn shade(&mut self, (a, b): (BodyId, BodyId)) {
        let (Some(a), Some(b)) = (self.world.body(a), self.world.body(b)) else {
            return;
        };
        let (a, b) = (self.convex(&a), self.convex(&b));
        for one in &a {
            for other in &b {
                let common = cut(one, other);
                if common.len() > 2 {
                    self.frame.push(Op::Area {
                        points: common,
                        ink: Ink::Contact,
                    });
                }
            }
        }
    }

    /// A body as convex rings, in pixels.
    fn convex(&self, body: &Body<'_>) -> Vec<Vec<Vec2>> {
        let mut rings = Vec::new();
        for (shape, _) in body.shapes() {
            self.add_convex(shape, body.pose(), &mut rings);
        }
        rings
    }

    fn add_convex(&self, shape: &Shape, pose: Pose, rings: &mut Vec<Vec<Vec2>>) {
        let place = |points: &[Vec2]| {
            let placed = points.iter().map(|&p| self.camera.point(pose.point(p)));
            placed.collect::<Vec<_>>()
        };
        match shape {
            Shape::Circle(circle) => {
                let step = 360.0 / f64::from(CORNERS);
                let rim = (0..CORNERS).map(|k| {
                    let along = Rot::from_degrees(step * f64::from(k)).x_axis();
                    circle.centre() + circle.radius() * along
                });
                rings.push(place(&rim.collect::<Vec<_>>()));
            }
            Shape::Convex(polygon) => rings.push(place(polygon.vertices())),
            Shape::Polygon(polygon) => {
                rings.extend(polygon.pieces().iter().map(|piece| place(piece.vertices())));
            }
            Shape::Compound(compound) => {
                for part in compound.parts() {
                    self.add_convex(part, pose, rings);
                }
            }
            Shape::HalfPlane(half_plane) => {
                rings.push(self.behind(
                    pose.point(half_plane.point()),
                    pose.vector(half_plane.normal()),
                ));
            }
            // A segment has no inside.
            _ => {}
        }
    }

    /// What the picture can show of a half-plane: a square behind its line.
    fn behind(&self, point: Vec2, normal: Vec2) -> Vec<Vec2> {
        let view = self.camera.view();
        let reach = 2.0 * view.extents().length();
        let foot = view.centre() - normal * normal.dot(view.centre() - point);
        let (along, deep) = (vec2(normal.y, -normal.x) * reach, normal * (2.0 * reach));
        [
            foot + along,
            foot - along,
            foot - along - deep,
            foot + along - deep,
        ]
        .map(|p| self.camera.point(p))
        .to_vec()
    }
}

/// What two convex rings share: one side after the other cut off (Sutherland and Hodgman 1974).
fn cut(ring: &[Vec2], by: &[Vec2]) -> Vec<Vec2> {
    let mut left = ring.to_vec();
    let turn = area(by);
    for (k, &from) in by.iter().enumerate() {
        let along = by[(k + 1) % by.len()] - from;
        // Positive inside, whichever way round the ring runs.
        let side = |p: Vec2| cross(along, p - from) * turn;
        let mut kept = Vec::with_capacity(left.len() + 1);
        for (i, &p) in left.iter().enumerate() {
            let q = left[(i + 1) % left.len()];
            let (s, t) = (side(p), side(q));
            if s >= 0.0 {
                kept.push(p);
            }
            if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
                kept.push(p + (q - p) * (s / (s - t)));
            }
        }
        left = kept;
    }
    left
}

/// Twice the area of a ring, with the sign of the way it runs.
fn area(ring: &[Vec2]) -> f64 {
    let first = ring.first().copied().unwrap_or_default();
    let pairs = ring.windows(2);
    pairs
        .map(|pair| cross(pair[0] - first, pair[1] - first))
        .sum()
}

/// A short length, in a unit that suits it.
fn length(metres: f64) -> String {
    let (value, unit) = match metres {
        m if m >= 1.0 => (m, "m"),
        m if m >= 1e-2 => (1e2 * m, "cm"),
        m if m >= 1e-3 => (1e3 * m, "mm"),
        m if m >= 1e-6 => (1e6 * m, "µm"),
        m => return format!("{m:.0e} m"),
    };
    let decimals = usize::from(value < 10.0);
    format!("{value:.decimals$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_share_their_corner() {
        let square = |x: f64, y: f64| {
            let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
            corners.map(|(a, b)| vec2(x + a, y + b)).to_vec()
        };
        let mut other = square(3.0, 2.0);
        for _ in 0..2 {
            let common = cut(&square(0.0, 0.0), &other);
            assert!(
                (area(&common).abs() - 2.0 * 2.0).abs() < 1e-12,
                "{common:?}"
            );
            other.reverse();
        }
        assert!(cut(&square(0.0, 0.0), &square(9.0, 0.0)).is_empty());
        // One inside the other is all of it.
        let small = [vec2(1.0, 1.0), vec2(2.0, 1.0), vec2(2.0, 2.0)];
        assert_eq!(cut(&small, &square(0.0, 0.0)), small);
    }

    #[test]
    fn lengths_have_two_digits_and_a_fitting_unit() {
        for (metres, text) in [
            (2.34, "2.3 m"),
            (0.234, "23 cm"),
            (0.0234, "2.3 cm"),
            (0.00234, "2.3 mm"),
            (0.000_234, "234 µm"),
            (2.34e-6, "2.3 µm"),
            (2.34e-11, "2e-11 m"),
        ] {
            assert_eq!(length(metres), text);
        }
    }
}
