//! Contacts without friction as a polyhedron: velocities scaled by √m, in which the nearest point is Gauss's principle.

use carom_math::{Vec2, cross, vec2};

use super::body::ImpactBody;
use super::project::{Basis, nearest};
use super::several::{SharedContact, SharedOutcome};

/// Velocities scaled by √m and √I, and how each contact's opening speed is made of them.
pub(super) struct Scaled {
    /// 1/√m and 1/√I of every body.
    roots: Vec<(f64, f64)>,
    velocities: Vec<f64>,
    rows: Vec<Vec<f64>>,
    /// Opening speed that the velocities of immovable bodies give.
    given: Vec<f64>,
}

impl Scaled {
    pub(super) fn of(bodies: &[ImpactBody], contacts: &[SharedContact]) -> Self {
        let root = |body: &ImpactBody| (body.inverse_mass.sqrt(), body.inverse_inertia.sqrt());
        let roots: Vec<(f64, f64)> = bodies.iter().map(root).collect();
        let over = |speed: f64, root: f64| if root > 0.0 { speed / root } else { 0.0 };
        let velocities = bodies
            .iter()
            .zip(&roots)
            .flat_map(|(body, &(mass, inertia))| {
                let v = body.velocity;
                [over(v.x, mass), over(v.y, mass), over(body.spin, inertia)]
            });
        let velocities: Vec<f64> = velocities.collect();
        let (mut rows, mut given) = (Vec::new(), Vec::new());
        for shared in contacts {
            let (mut row, mut rest) = (vec![0.0; velocities.len()], 0.0);
            let normal = shared.contact.normal;
            for (index, normal) in [(shared.a, -normal), (shared.b, normal)] {
                let (body, (mass, inertia)) = (&bodies[index], roots[index]);
                let turn = cross(shared.contact.point - body.centre, normal);
                row[3 * index] += normal.x * mass;
                row[3 * index + 1] += normal.y * mass;
                row[3 * index + 2] += turn * inertia;
                if mass == 0.0 {
                    rest += body.velocity.dot(normal);
                }
                if inertia == 0.0 {
                    rest += body.spin * turn;
                }
            }
            rows.push(row);
            given.push(rest);
        }
        Self {
            roots,
            velocities,
            rows,
            given,
        }
    }

    /// Orthonormal directions of the momenta, linear and about the common centre; none where a body is immovable.
    fn momenta(&self, bodies: &[ImpactBody]) -> Vec<Vec<f64>> {
        let free = |body: &&ImpactBody| body.inverse_mass > 0.0 && body.inverse_inertia > 0.0;
        if self.rows.len() < 2 || !bodies.iter().all(|body| free(&body)) {
            return Vec::new();
        }
        let mass: f64 = bodies.iter().map(|body| body.inverse_mass.recip()).sum();
        let moments = bodies.iter().map(|body| body.centre / body.inverse_mass);
        let centre = moments.sum::<Vec2>() / mass;
        let mut momenta = vec![Vec::new(); 3];
        for (body, (m, i)) in bodies.iter().zip(&self.roots) {
            let arm = body.centre - centre;
            momenta[0].extend([m.recip(), 0.0, 0.0]);
            momenta[1].extend([0.0, m.recip(), 0.0]);
            momenta[2].extend([-arm.y / m, arm.x / m, i.recip()]);
        }
        Basis::independent(momenta, 0.0).into_directions()
    }

    /// The bodies, moved as little as lets every contact open with at least its wanted speed.
    pub(super) fn reach(
        &self,
        bodies: &[ImpactBody],
        wanted: &[f64],
        tolerance: f64,
    ) -> SharedOutcome {
        let bounds: Vec<f64> = wanted.iter().zip(&self.given).map(|(w, g)| w - g).collect();
        let found = nearest(
            &self.momenta(bodies),
            &self.rows,
            &self.velocities,
            &bounds,
            tolerance,
        );
        let mut after = bodies.to_vec();
        for (k, (body, &(mass, inertia))) in after.iter_mut().zip(&self.roots).enumerate() {
            let place = 3 * k;
            let moved = |i: usize, root: f64, was: f64| {
                #[expect(clippy::float_cmp, reason = "what nothing touched keeps its bits")]
                if found.point[i] == self.velocities[i] {
                    was
                } else {
                    found.point[i] * root
                }
            };
            body.velocity = vec2(
                moved(place, mass, body.velocity.x),
                moved(place + 1, mass, body.velocity.y),
            );
            body.spin = moved(place + 2, inertia, body.spin);
        }
        SharedOutcome {
            bodies: after,
            impulses: found.multipliers.into_iter().map(|j| (j, 0.0)).collect(),
            exhausted: false,
            operations: found.operations,
        }
    }
}
