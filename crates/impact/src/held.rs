//! Contacts that are held: what opens at a given speed at least, against Coulomb's friction, by a common stop.

use carom_math::{Vec2, perp};

use super::body::ImpactBody;
use super::coulomb::stop_near;
use super::rows::{Bound, Normals, Row, Rows};

/// A face that is held: one or two points, at which friction acts along one line.
#[derive(Clone, Debug)]
pub struct HeldFace {
    /// Indices of A and B.
    pub bodies: (usize, usize),
    /// Unit normal from A to B.
    pub normal: Vec2,
    /// What limits its friction.
    pub friction: Friction,
    /// Speed of B along the normal turned by +90 degrees at which it slips, if friction can do it, in m/s.
    pub slips: f64,
    /// At most two.
    pub points: Vec<HeldPoint>,
    /// Impulses near which an answer is looked for first, as in [`HeldFaces::impulses`]: those of a moment ago.
    pub before: [f64; 3],
}

/// What limits the friction of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// Coulomb's law with this coefficient.
    Coulomb(f64),
    /// This impulse, in N·s, as long as the face is there. What pushes and rubs is a convex problem then: it has a solution wherever
    /// some motion keeps all points from closing.
    Given(f64),
}

/// A point of a face that is held. A face without such has no friction.
#[derive(Clone, Copy, Debug)]
pub struct HeldPoint {
    /// Where it pushes A, and where B, in m: a gap may lie between.
    pub on: (Vec2, Vec2),
    /// Speed at which it opens at least, in m/s.
    pub opens: f64,
}

/// What holds faces.
#[derive(Clone, Debug)]
pub struct HeldFaces {
    /// The bodies after it, in their order.
    pub bodies: Vec<ImpactBody>,
    /// Impulses on B of both points along the normal, and along the normal turned by +90 degrees, for each face, in N·s.
    pub impulses: Vec<[f64; 3]>,
    /// Whether all of it holds: bodies may be squeezed so that nothing meets all conditions.
    pub sure: bool,
}

/// The least impulses after which every point opens by what is asked of it at least, and every face slips by what is asked of it if
/// friction can do it.
#[must_use]
pub fn held_faces(bodies: &[ImpactBody], faces: &[HeldFace]) -> HeldFaces {
    let (mut all, mut speeds, mut near) = (Vec::new(), Vec::new(), Vec::new());
    for face in faces {
        let first = all.len();
        let mut add = |point: &HeldPoint, along: Vec2, bound: Bound, speed: f64, before: f64| {
            all.push(Row::between(bodies, face.bodies, point.on, along, bound));
            speeds.push(speed);
            near.push(before);
        };
        for (point, before) in face.points.iter().zip(face.before) {
            add(point, face.normal, Bound::Push, point.opens, before);
        }
        let normals = Normals::new(first, face.points.len());
        let (limit, bound) = match face.friction {
            Friction::Coulomb(mu) => (mu, Bound::Friction(normals, mu)),
            Friction::Given(limit) => (limit, Bound::Limit(limit)),
        };
        if let Some(point) = face.points.first().filter(|_| limit > 0.0) {
            add(point, perp(face.normal), bound, face.slips, face.before[2]);
        }
    }
    let mut rows = Rows::new(bodies, all);
    rows.ask(&speeds);
    let found = stop_near(&rows, Some(&near));
    let mut after = bodies.to_vec();
    let mut left = rows.rows.iter().zip(found.impulses).peekable();
    let impulses = faces.iter().map(|face| {
        let mut of_face = [0.0; 3];
        for j in &mut of_face[..face.points.len()] {
            *j = take(&mut after, left.next());
        }
        of_face[2] = take(
            &mut after,
            left.next_if(|(row, _)| row.bound != Bound::Push),
        );
        of_face
    });
    HeldFaces {
        impulses: impulses.collect(),
        bodies: after,
        sure: found.sure,
    }
}

/// Gives bodies the impulse of a row; how much that is.
fn take(bodies: &mut [ImpactBody], row: Option<(&Row, f64)>) -> f64 {
    row.map_or(0.0, |(row, impulse)| {
        row.push(bodies, impulse);
        impulse
    })
}
