//! Random bodies and contacts between them, for the tests of impacts that several share.

use carom_math::{Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::{ImpactBody, ImpactContact, SharedContact, SharedOutcome};

/// Bodies and fewer than `most` contacts, masses of 10^±`decades` kg, the first body perhaps immovable;
/// restitution and friction as `material` has them.
pub(crate) fn heap(
    decades: f64,
    most: usize,
    material: impl Strategy<Value = (f64, f64)>,
) -> impl Strategy<Value = (Vec<ImpactBody>, Vec<SharedContact>)> {
    let number = || -2.0..2.0_f64;
    let body = (
        -decades..=decades,
        0.1..3.0_f64,
        [number(), number(), number(), number(), number()],
    );
    let contact = (
        any::<prop::sample::Index>(),
        1..5_usize,
        -3.2..3.2_f64,
        [number(), number()],
        material,
    );
    let bodies = prop::collection::vec(body, 2..6);
    (
        any::<bool>(),
        bodies,
        prop::collection::vec(contact, 1..most),
    )
        .prop_map(|(floor, bodies, contacts)| {
            let body = |(exponent, gyration, [x, y, vx, vy, spin]): (f64, f64, [f64; 5])| {
                let mass = carom_math::trig::pow(10.0, exponent);
                ImpactBody {
                    inverse_mass: mass.recip(),
                    inverse_inertia: (mass * gyration).recip(),
                    centre: vec2(x, y),
                    velocity: vec2(vx, vy),
                    spin,
                }
            };
            let mut bodies: Vec<ImpactBody> = bodies.into_iter().map(body).collect();
            if floor {
                bodies[0] = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
            }
            let count = bodies.len();
            let contacts = contacts.into_iter().map(
                |(first, offset, angle, [x, y], (restitution, friction))| {
                    let a = first.index(count);
                    SharedContact {
                        a,
                        b: (a + 1 + offset % (count - 1)) % count,
                        contact: ImpactContact {
                            point: vec2(x, y),
                            normal: Rot::from_angle(angle).x_axis(),
                            restitution,
                            friction,
                        },
                    }
                },
            );
            let contacts = contacts.collect();
            (bodies, contacts)
        })
}

/// A body by all its numbers: 1/m, 1/I, centre, velocity, spin.
pub(crate) const fn body(
    inverse_mass: f64,
    inverse_inertia: f64,
    centre: Vec2,
    velocity: Vec2,
    spin: f64,
) -> ImpactBody {
    ImpactBody {
        inverse_mass,
        inverse_inertia,
        centre,
        velocity,
        spin,
    }
}

pub(crate) fn energy(bodies: &[ImpactBody]) -> f64 {
    bodies.iter().map(ImpactBody::kinetic_energy).sum()
}

/// How fast a contact's second body moves away from its first, in m/s.
pub(crate) fn velocity(bodies: &[ImpactBody], shared: &SharedContact) -> Vec2 {
    let point = shared.contact.point;
    bodies[shared.b].velocity_of(point) - bodies[shared.a].velocity_of(point)
}

/// The slowest opening of all contacts, in m/s: below 0 something closes.
pub(crate) fn least_opening(after: &SharedOutcome, contacts: &[SharedContact]) -> f64 {
    let opening = |shared| velocity(&after.bodies, shared).dot(shared.contact.normal);
    contacts.iter().map(opening).fold(f64::INFINITY, f64::min)
}
