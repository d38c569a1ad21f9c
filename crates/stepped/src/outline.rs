//! Outlines of pieces: what pairs are computed from.

use carom_geometry::Aabb;
use carom_math::{Pose, Vec2, vec2};

use crate::rows::Numbers;

/// Corners of an outline.
pub(crate) const CORNERS: usize = 8;

/// Opposite edges of a box are parallel and equal but for so much of their length: rounding.
const BOX: f64 = 1e-14;

/// At most eight corners, counter-clockwise, relative to the centre of mass, in m; grown by a radius.
///
/// ```text
/// x y reach extent | radius corners 1/l 1/m | x x x x | y y y y
/// nx nx nx nx | ny ny ny ny                                      normals of edges 0 to 3
/// x x x x | y y y y | nx nx nx nx | ny ny ny ny                  corners 4 to 7 and the edges from them
/// ```
/// x, y is where the centre of mass is in space; corners 0 to 3 follow. 1/l and 1/m are inverse lengths of edges 0 and 1 if
/// the outline is a parallelogram, a *box*: its normals follow from them, and only the first two of five cache lines are read and turned.
/// Otherwise 1/l is 0, and instead of 1/m stands the sum of 2ⁱ over all edges i that are cuts through a concave polygon.
/// Edge i goes from corner i to the next; a disc has one corner and no edge, a segment two of both. What is not there
/// repeats the first, and so is never nearer, nor separates better.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Outline([f64; 40]);

impl Numbers for Outline {
    fn numbers(&self) -> &[f64] {
        &self.0
    }
}

/// The outline of these corners, of which there are at most eight, with reach, extent and radius, in m; edge i is a cut if
/// `cuts` has bit i.
pub(crate) fn outline_of(
    vertices: &[Vec2],
    normals: &[Vec2],
    cuts: u8,
    [reach, extent, radius]: [f64; 3],
) -> Outline {
    let mut outline = Outline([0.0; 40]);
    let head = [reach, extent, radius, vertices.len() as f64];
    outline.0[2..6].copy_from_slice(&head);
    // What repeats a cut is one, too.
    let repeats = (vertices.len()..CORNERS).fold(0, |repeats, i| repeats | 1 << i);
    outline.0[7] = f64::from(if cuts & 1 == 1 { cuts | repeats } else { cuts });
    if let [p, q, r, s] = vertices
        && cuts == 0
    {
        let (edge, next) = (*q - *p, *r - *q);
        let off = (edge + *s - *r).abs() + (next + *p - *s).abs();
        if off.x.max(off.y) <= BOX * edge.length().min(next.length()) {
            outline.0[6..8].copy_from_slice(&[edge.length().recip(), next.length().recip()]);
        }
    }
    for i in 0..CORNERS {
        let k = if i < vertices.len() { i } else { 0 };
        let corner = vertices.get(k).copied().unwrap_or(Vec2::ZERO);
        let normal = normals.get(k).copied().unwrap_or(Vec2::ZERO);
        let (corners, normals) = if i < 4 {
            (8 + i, 16 + i)
        } else {
            (20 + i, 28 + i)
        };
        (outline.0[corners], outline.0[corners + 4]) = (corner.x, corner.y);
        (outline.0[normals], outline.0[normals + 4]) = (normal.x, normal.y);
    }
    outline
}

impl Outline {
    /// Leaves a half-plane no sides: its corner and normal turn with its body.
    pub(crate) const fn leave_no_sides(&mut self) {
        self.0[5] = 0.0;
    }

    /// Becomes that of a body with this pose.
    pub(crate) fn pose(&mut self, of_body: &Self, pose: Pose) {
        self.0[2..8].copy_from_slice(&of_body.0[2..8]);
        (self.0[0], self.0[1]) = (pose.position.x, pose.position.y);
        let vectors = if self.is_box() { 8..16 } else { 8..40 };
        for k in vectors.step_by(8) {
            turn(&mut self.0[k..], &of_body.0[k..], pose);
        }
    }

    /// Where the centre of mass of its body is.
    pub(crate) const fn centre(&self) -> Vec2 {
        vec2(self.0[0], self.0[1])
    }

    /// Distance of its farthest point from the centre of mass, in m.
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

    pub(crate) fn is_box(&self) -> bool {
        self.0[6] > 0.0
    }

    pub(crate) fn has_cuts(&self) -> bool {
        self.0[7] > 0.0 && !self.is_box()
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
        if i < 4 {
            vec2(self.0[8 + i], self.0[12 + i])
        } else {
            vec2(self.0[20 + i], self.0[24 + i])
        }
    }

    pub(crate) fn normal(&self, i: usize) -> Vec2 {
        if self.is_box() {
            let inverse = self.0[6 + i % 2];
            let edge = (self.corner(i % 2 + 1) - self.corner(i % 2)) * inverse;
            let n = vec2(edge.y, -edge.x);
            if i < 2 { n } else { -n }
        } else {
            let at = if i < 4 { 16 + i } else { 28 + i };
            vec2(self.0[at], self.0[at + 4])
        }
    }

    /// `normal · point` of all points of an edge.
    #[inline]
    pub(crate) fn off(&self, i: usize) -> f64 {
        self.normal(i).dot(self.corner(i))
    }

    /// Whether a point in space is more than `distance` metres beyond a side.
    pub(crate) fn is_beyond_side(&self, point: Vec2, distance: f64) -> bool {
        let (way, far) = (point - self.centre(), distance + self.radius());
        let sides = if self.corners() > 1 {
            self.corners()
        } else {
            0
        };
        (0..sides).any(|i| self.normal(i).dot(way) - self.off(i) > far)
    }

    /// Whether a point in space is more than `distance` metres beyond a half-plane, which has no sides.
    pub(crate) fn is_beyond_plane(&self, point: Vec2, distance: f64) -> bool {
        let height = self.normal(0).dot(point - self.centre()) - self.off(0);
        height > distance + self.radius()
    }

    /// The box around it.
    pub(crate) fn aabb(&self) -> Aabb {
        let (mut low, mut high) = (self.corner(0), self.corner(0));
        let last = if self.count() > 4.0 { CORNERS } else { 4 };
        for i in 1..last {
            low = low.min(self.corner(i));
            high = high.max(self.corner(i));
        }
        Aabb::new(self.centre() + low, self.centre() + high).grown(self.radius())
    }
}

/// Turns four vectors, given as four x and four y.
fn turn(to: &mut [f64], from: &[f64], pose: Pose) {
    let (c, s) = (pose.rotation.cos(), pose.rotation.sin());
    let (to, from) = (&mut to[..8], &from[..8]);
    for i in 0..4 {
        let (x, y) = (from[i], from[i + 4]);
        (to[i], to[i + 4]) = (c * x - s * y, s * x + c * y);
    }
}

/// For [`crate::narrow::naive`].
#[cfg(test)]
impl Outline {
    /// Whether edge `i` is a cut through a concave polygon, beyond which another piece goes on.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "eight bits"
    )]
    pub(crate) fn is_cut(&self, i: usize) -> bool {
        !self.is_box() && self.0[7] as u8 >> i & 1 == 1
    }

    pub(crate) const fn next(&self, i: usize) -> usize {
        if i + 1 == self.corners() { 0 } else { i + 1 }
    }
}
