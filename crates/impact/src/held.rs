//! Contacts that are held: what opens at a given speed at least, against Coulomb's friction, by a common stop.

use carom_math::{Vec2, perp};

use super::body::ImpactBody;
use super::coulomb::{Stop, stop, stop_near};
use super::rows::{Bound, Normals, Row, Rows};
use super::several::SharedContact;

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

/// What holds contacts.
#[derive(Clone, Debug)]
pub struct Held {
    /// The bodies after it, in their order.
    pub bodies: Vec<ImpactBody>,
    /// Impulses on B along the normal and along the normal turned by +90 degrees, for each contact, in N·s.
    pub impulses: Vec<(f64, f64)>,
    /// Whether all of it holds: bodies may be squeezed so that nothing meets all conditions.
    pub sure: bool,
}

/// What holds faces.
#[derive(Clone, Debug)]
pub struct HeldFaces {
    /// The bodies after it, in their order.
    pub bodies: Vec<ImpactBody>,
    /// Impulses on B of both points along the normal, and along the normal turned by +90 degrees, for each face, in N·s.
    pub impulses: Vec<[f64; 3]>,
    /// As [`Held::sure`].
    pub sure: bool,
}

/// The least impulses after which every contact opens by what is `asked` of it at least, and slips by what is asked of it
/// if friction can do it; both in m/s.
pub fn held(bodies: &[ImpactBody], contacts: &[SharedContact], asked: &[(f64, f64)]) -> Held {
    let mut all = Asked::default();
    let asked = asked.iter().chain(core::iter::repeat(&(0.0, 0.0)));
    for (shared, &(opens, slips)) in contacts.iter().zip(asked) {
        let (ends, at) = ((shared.a, shared.b), shared.contact.point);
        let point = HeldPoint {
            on: (at, at),
            opens,
        };
        let friction = Friction::Coulomb(shared.contact.friction);
        all.add(
            bodies,
            ends,
            shared.contact.normal,
            &[point],
            (friction, slips),
        );
    }
    let (after, found, sure) = all.stop(bodies, stop);
    let mut impulses: Vec<(f64, f64)> = Vec::with_capacity(contacts.len());
    for (bound, impulse) in found {
        match (bound, impulses.last_mut()) {
            (Bound::Friction(..), Some(last)) => last.1 = impulse,
            _ => impulses.push((impulse, 0.0)),
        }
    }
    Held {
        bodies: after,
        impulses,
        sure,
    }
}

/// The same for faces. Their impulses are those of both points along the normal, and that of friction.
#[must_use]
pub fn held_faces(bodies: &[ImpactBody], faces: &[HeldFace]) -> HeldFaces {
    let mut all = Asked::default();
    let mut near = Vec::new();
    for face in faces {
        let rubs = (face.friction, face.slips);
        let first = all.rows.len();
        all.add(bodies, face.bodies, face.normal, &face.points, rubs);
        near.extend(&face.before[..face.points.len()]);
        if all.rows.len() > first + face.points.len() {
            near.push(face.before[2]);
        }
    }
    let (after, found, sure) = all.stop(bodies, |rows| stop_near(rows, Some(&near)));
    let mut found = found.into_iter().peekable();
    let impulses = faces.iter().map(|face| {
        let mut of_face = [0.0; 3];
        for (j, (_, impulse)) in of_face
            .iter_mut()
            .zip(found.by_ref().take(face.points.len()))
        {
            *j = impulse;
        }
        if let Some((_, impulse)) = found.next_if(|(bound, _)| *bound != Bound::Push) {
            of_face[2] = impulse;
        }
        of_face
    });
    HeldFaces {
        impulses: impulses.collect(),
        bodies: after,
        sure,
    }
}

/// Rows, and the speeds that are asked of them.
#[derive(Default)]
struct Asked {
    rows: Vec<Row>,
    speeds: Vec<f64>,
}

impl Asked {
    /// A push row for each point, then one of friction, if there is some.
    fn add(
        &mut self,
        bodies: &[ImpactBody],
        ends: (usize, usize),
        normal: Vec2,
        points: &[HeldPoint],
        (friction, slips): (Friction, f64),
    ) {
        let first = self.rows.len();
        for point in points {
            let row = Row::between(bodies, ends, point.on, normal, Bound::Push);
            self.rows.push(row);
            self.speeds.push(point.opens);
        }
        let (limit, bound) = match friction {
            Friction::Coulomb(mu) => (mu, Bound::Friction(Normals::new(first, points.len()), mu)),
            Friction::Given(limit) => (limit, Bound::Limit(limit)),
        };
        if let Some(point) = points.first().filter(|_| limit > 0.0) {
            let row = Row::between(bodies, ends, point.on, perp(normal), bound);
            self.rows.push(row);
            self.speeds.push(slips);
        }
    }

    /// The bodies after the impulses that do it, those of the rows, and whether they do.
    fn stop(
        self,
        bodies: &[ImpactBody],
        stop: impl Fn(&Rows) -> Stop,
    ) -> (Vec<ImpactBody>, Vec<(Bound, f64)>, bool) {
        let mut rows = Rows::new(bodies, self.rows);
        rows.ask(&self.speeds);
        let Stop { impulses, sure, .. } = stop(&rows);
        let mut after = bodies.to_vec();
        let bounds = rows.rows.iter().zip(impulses);
        let push = |(row, impulse): (&Row, f64)| {
            row.push(&mut after, impulse);
            (row.bound, impulse)
        };
        let impulses = bounds.map(push).collect();
        (after, impulses, sure)
    }
}
