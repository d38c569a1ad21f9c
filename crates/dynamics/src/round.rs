//! Groups of discs: what holds them neither gives way nor pushes out, and no sub-step gains energy by it.
//!
//! Two discs that turn about their centres, or such a disc and what does not turn, are never closer after a sub-step than
//! the rate of their gap says: their surfaces curve away from each other. So rows without springs will do. With impulses p
//! that close no gap, v'ₙ ≥ −gap/h ⊥ pₙ ≥ 0, and friction within its cone,
//!
//! ```text
//! M (v' − v − h g) = Jᵀ p
//! way  = h (θ v' + (1 − θ) v)
//! gain = p·(θ J v' + (1 − θ) J v) − (θ − ½) (v' − v)ᵀ M (v' − v)      of kinetic energy, less the work of g on the way
//! ```
//!
//! At θ = 1 nothing is gained: pₙ v'ₙ = −pₙ gap/h, and friction opposes the slip. At θ = ½ the scheme is of second order, and
//! what slides or rolls on a plane loses by friction alone. So a group takes the least θ ≥ ½ that gains nothing, but 1 where
//! somebody comes down: half of the old way would lead into the other one. Rolling on a disc is of first order: the normal turns
//! on the way. An impact that cuts a way short is not counted with.

use carom_math::Vec2;

use crate::bodies::Bodies;
use crate::impact::{Moving, Sweeper, Swept};
use crate::pairs::Pair;
use crate::solver::{Law, Row, SolverBody, warm_start};
use crate::state::{BodyState, Collider};

/// Sweeps before what is left stays.
const SWEEPS: usize = 1024;

/// Once a group gains nothing it is let go after so many rows or sweeps, whichever is more, or twice as many, and so on: few are
/// solved for to rounding. Sixty heaps of ten balls take 2.7 s with 1024 rows, 1.8 with 256, and 1.7 with 128 and 4 sweeps (2026-11-23).
const ENOUGH: (usize, usize) = (256, 16);

/// Speed that a contact has still to take away, as a part of the fastest, at which nothing changes any more.
const CONVERGED: f64 = 1e-14;

/// Velocity and spin of a body as it begins its way through a sub-step.
pub(crate) type Start = (Vec2, f64);

/// Whether a pair is one of two discs, or of a disc and what does not turn, and nothing pushes it apart.
pub(crate) fn is_round(bodies: &Bodies, colliders: &[Collider], pair: &Pair) -> bool {
    let (a, b) = (bodies.get(pair.bodies.0), bodies.get(pair.bodies.1));
    let is_disc = |body: &BodyState| body.turns_in_place(colliders);
    let stands = |body: &BodyState| !body.is_dynamic() && body.motion.spin == 0.0;
    !pair.sunk && (is_disc(a) || stands(a)) && (is_disc(b) || stands(b))
}

/// Velocities of the bodies of a group after which no row closes by more than its gap, from the impulses that the rows carry;
/// and the velocities with which the ways there begin. Bodies come in as pulled without contacts, `starts` as they move. `deep` is
/// how far a disc may get into another one on its way, in m.
pub(crate) fn hold(
    law: &Law,
    bodies: &mut [SolverBody],
    starts: &mut [Start],
    rows: &mut [Row],
    deep: f64,
) {
    let ends = rows.iter().flat_map(|row| [row.bodies.0, row.bodies.1]);
    let mut members: Vec<u32> = ends.collect();
    members.sort_unstable();
    members.dedup();
    let speeds = members.iter().map(|at| bodies[*at as usize].v.length());
    let settled = CONVERGED * speeds.fold(0.0, f64::max);
    warm_start(bodies, rows);
    let mut sweeper = sweeper_of(law, bodies, rows, &members);
    let before: Vec<Start> = members.iter().map(|at| starts[*at as usize]).collect();
    let enough = (ENOUGH.0 / rows.len()).max(ENOUGH.1);
    for k in 1..=SWEEPS {
        let gains = |sweeper| Work::of(sweeper, &before).gain(1.0) > 0.0;
        if sweeper.sweep() <= settled || k % enough == 0 && !gains(&sweeper) {
            break;
        }
    }
    let comes_down = |contact: &Swept| {
        let opening = contact.opening(before[contact.a], before[contact.b]);
        contact.j_n > 0.0 && law.h() * (opening - contact.target) < -deep
    };
    let part = if sweeper.contacts.iter().any(comes_down) {
        1.0
    } else {
        Work::of(&sweeper, &before).least_part()
    };
    for (row, contact) in rows.iter_mut().zip(&sweeper.contacts) {
        (row.j[0], row.jt) = (contact.j_n, contact.j_t);
        for end in [row.bodies.0, row.bodies.1] {
            bodies[end as usize].acted |= row.acts();
        }
    }
    // A way of h (θ v' + (1 − θ) v) that ends with v', at an even acceleration.
    let (new, old) = (2.0 * part - 1.0, 2.0 * (1.0 - part));
    for (member, after) in members.into_iter().zip(&sweeper.bodies) {
        let (body, start) = (&mut bodies[member as usize], &mut starts[member as usize]);
        (body.v, body.w) = (after.velocity, after.spin);
        *start = (body.v * new + start.0 * old, body.w * new + start.1 * old);
        (body.d, body.turn) = (body.v * law.h(), body.w * law.h());
    }
}

/// The contacts of a group, each of one point, and its bodies in the order of `members`.
fn sweeper_of(law: &Law, bodies: &[SolverBody], rows: &[Row], members: &[u32]) -> Sweeper {
    let moving = |at: &u32| {
        let body = &bodies[*at as usize];
        Moving {
            velocity: body.v,
            spin: body.w,
            inverse_mass: body.inverse_mass,
            inverse_inertia: body.inverse_inertia,
        }
    };
    let swept = |row: &Row| {
        let [i, j] = [row.bodies.0, row.bodies.1];
        let (a, b) = (&bodies[i as usize], &bodies[j as usize]);
        let yields = |arm_a: f64, arm_b: f64| {
            let turns = arm_a * arm_a * a.inverse_inertia + arm_b * arm_b * b.inverse_inertia;
            a.inverse_mass + b.inverse_mass + turns
        };
        let place = |at: u32| members.binary_search(&at).expect("it is a member");
        Swept {
            a: place(i),
            b: place(j),
            normal: row.n,
            arms_n: (row.a[0], row.b[0]),
            arms_t: (row.at, row.bt),
            m_n: yields(row.a[0], row.b[0]).recip(),
            m_t: yields(row.at, row.bt).recip(),
            friction: row.mu,
            target: -row.gap[0].max(0.0) * law.inverse_h(),
            belt: row.belt,
            j_n: row.j[0],
            j_t: row.jt,
        }
    };
    Sweeper {
        bodies: members.iter().map(moving).collect(),
        contacts: rows.iter().map(swept).collect(),
    }
}

/// What a sub-step does to the energy of a group, in J.
#[derive(Clone, Copy, Debug)]
struct Work {
    /// p·J v.
    by_old: f64,
    /// p·J v'.
    by_new: f64,
    /// (v' − v)ᵀ M (v' − v).
    change: f64,
}

impl Work {
    fn of(sweeper: &Sweeper, before: &[Start]) -> Self {
        let (mut by_old, mut by_new) = (0.0, 0.0);
        for contact in &sweeper.contacts {
            let (a, b) = (contact.a, contact.b);
            let by = |(opening, slip)| contact.j_n * opening + contact.j_t * slip;
            let seen = |a, b| (contact.opening(a, b), contact.slip(a, b));
            by_old += by(seen(before[a], before[b]));
            by_new += by(seen(sweeper.velocity(a), sweeper.velocity(b)));
        }
        let change = |(body, (v, w)): (&Moving, &Start)| {
            let of = |square: f64, inverse: f64| if inverse > 0.0 { square / inverse } else { 0.0 };
            let turn = body.spin - w;
            of((body.velocity - *v).length_squared(), body.inverse_mass)
                + of(turn * turn, body.inverse_inertia)
        };
        Self {
            by_old,
            by_new,
            change: sweeper.bodies.iter().zip(before).map(change).sum(),
        }
    }

    fn gain(&self, part: f64) -> f64 {
        part * self.by_new + (1.0 - part) * self.by_old - (part - 0.5) * self.change
    }

    /// The least part of at least ½ with which nothing is gained.
    fn least_part(&self) -> f64 {
        if self.gain(0.5) <= 0.0 {
            return 0.5;
        }
        // by_old + change/2 + θ (by_new − by_old − change) = 0
        let part = (self.by_old + 0.5 * self.change) / (self.by_old + self.change - self.by_new);
        part.clamp(0.5, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Softness;
    use crate::impact::{ImpactBody, ImpactContact, SharedContact, held};
    use carom_math::vec2;
    use proptest::prelude::*;

    const H: f64 = 1.0 / 360.0;

    /// Discs of radius 0.5 in a row, which may overlap, on a floor, number 0, and the rows of those near each other.
    fn row_of_discs(
        places: &[Vec2],
        velocities: &[(Vec2, f64)],
        mu: f64,
    ) -> (Vec<SolverBody>, Vec<Start>, Vec<Row>) {
        let mut bodies = vec![SolverBody::default()];
        let mut starts = vec![(Vec2::ZERO, 0.0)];
        for (v, w) in velocities {
            bodies.push(SolverBody {
                v: *v - vec2(0.0, 9.81 * H),
                w: *w,
                inverse_mass: 1.0,
                inverse_inertia: 8.0,
                ..SolverBody::default()
            });
            starts.push((*v, *w));
        }
        let mut rows = Vec::new();
        let mut join = |bodies: (u32, u32), n: Vec2, arms: (Vec2, Vec2), gap: f64| {
            let mut row = Row::new(bodies, n, &[arms], mu);
            row.gap[0] = gap;
            rows.push(row);
        };
        for (i, a) in (1_u32..).zip(places) {
            for (j, b) in (1_u32..).zip(places).skip(i as usize) {
                let apart = *b - *a;
                let n = apart / apart.length();
                if apart.length() < 1.01 {
                    join((i, j), n, (n * 0.5, n * -0.5), apart.length() - 1.0);
                }
            }
            let n = vec2(0.0, 1.0);
            join((0, i), n, (*a, n * -0.5), a.y - 0.5);
        }
        (bodies, starts, rows)
    }

    fn law() -> Law {
        Law::new(&Softness::default(), H)
    }

    fn group() -> impl Strategy<Value = (Vec<Vec2>, Vec<(Vec2, f64)>)> {
        let place = (-1e-4..1e-4_f64, prop_oneof![Just(0.0), 0.0..1e-4_f64]);
        let velocity = (-1.0..1.0_f64, -0.05..0.05_f64, -3.0..3.0_f64);
        prop::collection::vec((place, velocity), 1..8).prop_map(|discs| {
            let discs = (0_u32..).zip(discs);
            discs
                .map(|(k, ((x, y), (vx, vy, w)))| {
                    let place = vec2(f64::from(k) + x, 0.5 + y);
                    (place, (vec2(vx, vy), w))
                })
                .unzip()
        })
    }

    proptest! {
        #[test]
        fn no_group_gains((places, velocities) in group(), mu in 0.0..1.5_f64) {
            let (mut bodies, starts, mut rows) = row_of_discs(&places, &velocities, mu);
            let mut ways = starts.clone();
            hold(&law(), &mut bodies, &mut ways, &mut rows, 1e-9);
            let (mut gain, mut scale) = (0.0, 0.0);
            for ((body, old), way) in bodies.iter().zip(&starts).zip(&ways).skip(1) {
                // An even acceleration from the velocity of the way to the new one.
                let d = (way.0 + body.v) * (0.5 * H);
                let kinetic = |v: Vec2, w: f64| 0.5 * (v.length_squared() + w * w / 8.0);
                gain += kinetic(body.v, body.w) - kinetic(old.0, old.1) + 9.81 * d.y;
                scale += kinetic(old.0, old.1) + 9.81 * H;
            }
            prop_assert!(gain <= 1e-13 * scale, "{gain:e} J");
            for row in &rows {
                prop_assert!(row.j[0] >= 0.0 && row.jt.abs() <= mu * row.j[0]);
            }
        }

        #[test]
        fn without_friction_velocities_are_those_of_the_equations((places, velocities) in group()) {
            // More are let go before they are solved for to rounding.
            let few = places.len().min(3);
            let (places, velocities) = (&places[..few], &velocities[..few]);
            let (mut bodies, mut starts, mut rows) = row_of_discs(places, velocities, 0.0);
            let before = bodies.clone();
            hold(&law(), &mut bodies, &mut starts, &mut rows, 1e-9);
            let impacts: Vec<ImpactBody> = before
                .iter()
                .zip([Vec2::ZERO].iter().chain(places))
                .map(|(body, centre)| ImpactBody {
                    inverse_mass: body.inverse_mass,
                    inverse_inertia: body.inverse_inertia,
                    centre: *centre,
                    velocity: body.v,
                    spin: body.w,
                })
                .collect();
            let contact = |row: &Row| {
                let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
                let contact = ImpactContact {
                    point: impacts[b].centre - row.n * 0.5,
                    normal: row.n,
                    restitution: 0.0,
                    friction: 0.0,
                };
                SharedContact { a, b, contact }
            };
            let contacts: Vec<SharedContact> = rows.iter().map(contact).collect();
            let asked: Vec<(f64, f64)> = rows
                .iter()
                .map(|row| (-row.gap[0].max(0.0) / H, 0.0))
                .collect();
            let twin = held(&impacts, &contacts, &asked);
            prop_assert!(twin.sure);
            for (body, twin) in bodies.iter().zip(&twin.bodies) {
                prop_assert!((body.v - twin.velocity).length() < 1e-9, "{:?} {:?}", body.v, twin.velocity);
            }
        }
    }

    #[test]
    fn who_slides_on_a_floor_goes_by_the_trapezoid() {
        let (mut bodies, starts, mut rows) =
            row_of_discs(&[vec2(0.0, 0.5)], &[(vec2(1.0, 0.0), 0.0)], 0.3);
        let mut ways = starts.clone();
        hold(&law(), &mut bodies, &mut ways, &mut rows, 1e-9);
        assert_eq!(ways, starts);
        assert!((bodies[1].v.x - (1.0 - 0.3 * 9.81 * H)).abs() < 1e-15);
        assert!(bodies[1].v.y.abs() < 1e-16);
    }
}
