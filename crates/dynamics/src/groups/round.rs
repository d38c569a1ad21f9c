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
//! what slides or rolls on a plane loses by friction alone. So a group takes the least θ ≥ ½ that gains nothing. Where
//! a body lands, half of its old way would lead into the other one: there velocities are first made such that no gap
//! closes, by an impact that gives nothing back. Rolling on a disc is of first order: the normal turns on the way.
//!
//! An impact may cut a way short, so at no instant of it may there be more energy than at its start. After a part s of it
//!
//! ```text
//! s p·((1 − s/2) J v + s/2 J v')                                          θ = ½, along the parabola
//! s (p·J way/h − θ (v' − v)ᵀ M (v' − v) + s/2 (v' − v)ᵀ M (v' − v))      along an even way, the velocity going from v to v'
//! ```
//!
//! are gained: the second is at most s times the gain of all of it, the first where p·J v ≤ 0. Any other way is even.

use carom_math::Vec2;

use super::{Row, SolverBody};
use crate::impact::{Moving, Sweeper, Swept};

/// Sweeps before what is left stays.
const SWEEPS: usize = 1024;

/// Once a group gains nothing it is let go after so many rows or sweeps, whichever is more, or twice as many, and so on: few are
/// solved for to rounding. Sixty heaps of ten balls take 2.7 s with 1024 rows, 1.8 with 256, and 1.7 with 128 and 4 sweeps (2026-11-23).
const ENOUGH: (usize, usize) = (256, 16);

/// Speed that a contact has still to take away, as a part of the fastest, at which nothing changes any more.
const CONVERGED: f64 = 1e-14;

/// The same for bodies that land. Where each was to land to within a contact's touch, boxes full of lively balls took
/// 1.7 times the time, and no less with 1/64 than with this (2026-11-23).
const LANDED: f64 = 1.0 / 4096.0;

/// The same of a contact that may open or slip while it pushes: what is gained by it is rounding.
const ROUNDING: f64 = 1e-12;

/// Velocity in m/s and spin in rad/s of a body.
pub(crate) type Speed = (Vec2, f64);

/// A body's way through a sub-step, which ends with what the solver leaves it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub(crate) start: Speed,
    /// How it goes while its velocity changes evenly; `None` if as the velocity says.
    pub(crate) even: Option<Speed>,
}

/// Velocities of the bodies of a group after `h` seconds in which no row closes by more than its gap, from the impulses that the
/// rows carry, and the ways that lead there. Bodies come in as pulled without contacts, `ways` as they move. `deep` is how far a
/// disc may get into another one, in m.
pub(crate) fn hold(
    h: f64,
    bodies: &mut [SolverBody],
    ways: &mut [Way],
    rows: &mut [Row],
    deep: f64,
) {
    let members = members_of(rows);
    let mut before: Vec<Speed> = members.iter().map(|at| ways[*at as usize].start).collect();
    let speeds = members.iter().map(|at| bodies[*at as usize].v.length());
    let fastest = speeds.fold(0.0, f64::max);
    let down = sweeper_of(h, bodies, rows, &members);
    if let Some(landed) = land(down, &before, deep / h, fastest) {
        for ((member, start), after) in members.iter().zip(&mut before).zip(landed) {
            let body = &mut bodies[*member as usize];
            body.v += after.0 - start.0;
            body.w += after.1 - start.1;
            body.acted |= after != *start;
            *start = after;
        }
    }
    warm_start(bodies, rows);
    let mut sweeper = sweeper_of(h, bodies, rows, &members);
    let acted = |at: &u32| bodies[*at as usize].acted;
    let mut acted: Vec<bool> = members.iter().map(acted).collect();
    let work = |sweeper: &Sweeper| Work::of(sweeper, &before, &acted);
    let gains = |sweeper: &Sweeper| work(sweeper).gains(1.0, fastest);
    sweep(&mut sweeper, fastest, gains, |_| true);
    let (part, is_even) = work(&sweeper).way(fastest);
    for (row, contact) in rows.iter_mut().zip(&sweeper.contacts) {
        (row.j[0], row.jt) = (contact.j_n, contact.j_t);
    }
    mark(&mut acted, &sweeper);
    for (k, (member, start)) in members.into_iter().zip(before).enumerate() {
        let (body, way) = (&mut bodies[member as usize], &mut ways[member as usize]);
        (body.v, body.w) = sweeper.velocity(k);
        body.acted = acted[k];
        let mean = (
            body.v * part + start.0 * (1.0 - part),
            body.w * part + start.1 * (1.0 - part),
        );
        let even = is_even.then_some(mean);
        *way = Way { start, even };
        (body.d, body.turn) = (body.v * h, body.w * h);
    }
}

/// Velocities that the impulses of rows make.
fn warm_start(bodies: &mut [SolverBody], rows: &[Row]) {
    for row in rows {
        let (i, j) = (row.bodies.0 as usize, row.bodies.1 as usize);
        let (mut a, mut b) = (bodies[i], bodies[j]);
        row.push(&mut a, &mut b, row.j, row.jt);
        (bodies[i], bodies[j]) = (a, b);
    }
}

/// Bodies of the solver that rows join, in order.
pub(crate) fn members_of(rows: &[Row]) -> Vec<u32> {
    let ends = rows.iter().flat_map(|row| [row.bodies.0, row.bodies.1]);
    let mut members: Vec<u32> = ends.collect();
    members.sort_unstable();
    members.dedup();
    members
}

/// Velocities after an impact without restitution, where a gap closes by more than `slow` m/s beyond what it allows:
/// afterwards none does.
fn land(mut down: Sweeper, before: &[Speed], slow: f64, fastest: f64) -> Option<Vec<Speed>> {
    for (body, (velocity, spin)) in down.bodies.iter_mut().zip(before) {
        (body.velocity, body.spin) = (*velocity, *spin);
    }
    for contact in &mut down.contacts {
        (contact.j_n, contact.j_t) = (0.0, 0.0);
    }
    let comes_down = |sweeper: &Sweeper, slow: f64| {
        let comes = |contact: &Swept| {
            let opening = contact.opening(sweeper.velocity(contact.a), sweeper.velocity(contact.b));
            opening - contact.target < -slow
        };
        sweeper.contacts.iter().any(comes)
    };
    if !comes_down(&down, slow) {
        return None;
    }
    let acted = vec![false; before.len()];
    let gains = |down: &Sweeper| Work::of(down, before, &acted).gains(0.5, fastest);
    let near = slow.max(LANDED * fastest);
    sweep(&mut down, fastest, gains, |down| !comes_down(down, near));
    Some((0..before.len()).map(|k| down.velocity(k)).collect())
}

/// Sweeps until nothing changes any more, or what is there is `enough` and gains nothing, or [`SWEEPS`] times.
///
/// With µ above 1 sweeps may go round in circles, and gain wherever they stop. Without friction they descend: they gain nothing.
fn sweep(
    sweeper: &mut Sweeper,
    fastest: f64,
    gains: impl Fn(&Sweeper) -> bool,
    enough: impl Fn(&Sweeper) -> bool,
) {
    let every = (ENOUGH.0 / sweeper.contacts.len()).max(ENOUGH.1);
    let settles = |sweeper: &mut Sweeper| {
        (1..=SWEEPS).any(|k| {
            sweeper.sweep() <= CONVERGED * fastest
                || k % every == 0 && enough(sweeper) && !gains(sweeper)
        })
    };
    if !settles(sweeper) && gains(sweeper) {
        for contact in &mut sweeper.contacts {
            contact.friction = 0.0;
        }
        settles(sweeper);
    }
}

/// Marks the bodies that contacts push.
fn mark(acted: &mut [bool], sweeper: &Sweeper) {
    for contact in sweeper.contacts.iter().filter(|contact| contact.j_n > 0.0) {
        (acted[contact.a], acted[contact.b]) = (true, true);
    }
}

/// The contacts of a group, each of one point, and its bodies in the order of `members`.
fn sweeper_of(h: f64, bodies: &[SolverBody], rows: &[Row], members: &[u32]) -> Sweeper {
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
            target: -row.gap[0].max(0.0) / h,
            belt: row.belt,
            j_n: row.j[0],
            j_t: row.jt,
        }
    };
    Sweeper {
        bodies: members.iter().map(moving).collect(),
        contacts: rows.iter().map(swept).collect(),
        compliance: 0.0,
    }
}

/// What a sub-step does to the energy of a group, in J.
#[derive(Clone, Copy, Debug)]
struct Work {
    /// p·J v.
    by_old: f64,
    /// p·J v'.
    by_new: f64,
    /// (v' − v)ᵀ M (v' − v) of bodies that do not fly.
    change: f64,
    /// Σ pₙ, in N·s.
    pushes: f64,
}

impl Work {
    /// `acted`: bodies that do not fly even if no contact pushes them.
    fn of(sweeper: &Sweeper, before: &[Speed], acted: &[bool]) -> Self {
        let mut work = Self {
            by_old: 0.0,
            by_new: 0.0,
            change: 0.0,
            pushes: 0.0,
        };
        for contact in &sweeper.contacts {
            let (a, b) = (contact.a, contact.b);
            let by = |(opening, slip)| contact.j_n * opening + contact.j_t * slip;
            let seen = |a, b| (contact.opening(a, b), contact.slip(a, b));
            work.by_old += by(seen(before[a], before[b]));
            work.by_new += by(seen(sweeper.velocity(a), sweeper.velocity(b)));
            work.pushes += contact.j_n;
        }
        let mut acted = acted.to_vec();
        mark(&mut acted, sweeper);
        for ((body, (v, w)), _) in (sweeper.bodies.iter().zip(before))
            .zip(&acted)
            .filter(|(_, acted)| **acted)
        {
            let of = |square: f64, inverse: f64| if inverse > 0.0 { square / inverse } else { 0.0 };
            let turn = body.spin - w;
            work.change += of((body.velocity - *v).length_squared(), body.inverse_mass)
                + of(turn * turn, body.inverse_inertia);
        }
        work
    }

    fn gain(&self, part: f64) -> f64 {
        part * self.by_new + (1.0 - part) * self.by_old - (part - 0.5) * self.change
    }

    /// Whether a way of this part gains more than rounding does, where the fastest has so many m/s.
    fn gains(&self, part: f64, fastest: f64) -> bool {
        self.gain(part) > self.rounding(fastest)
    }

    fn rounding(&self, fastest: f64) -> f64 {
        ROUNDING * fastest * self.pushes
    }

    /// The least part of at least ½ with which nothing is gained, and whether the way is even lest something be gained on it.
    fn way(&self, fastest: f64) -> (f64, bool) {
        if !self.gains(0.5, fastest) {
            return (0.5, self.by_old > self.rounding(fastest));
        }
        // by_old + change/2 + θ (by_new − by_old − change) = 0
        let part = (self.by_old + 0.5 * self.change) / (self.by_old + self.change - self.by_new);
        (part.clamp(0.5, 1.0), true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::{ImpactBody, ImpactContact, SharedContact, held};
    use carom_math::vec2;
    use proptest::prelude::*;

    const H: f64 = 1.0 / 360.0;

    /// Discs of radius 0.5 in a row, which may overlap, on a floor, number 0, and the rows of those near each other.
    fn row_of_discs(
        places: &[Vec2],
        velocities: &[(Vec2, f64)],
        mu: f64,
    ) -> (Vec<SolverBody>, Vec<Way>, Vec<Row>) {
        let mut bodies = vec![SolverBody::default()];
        let way = |start| Way { start, even: None };
        let mut ways = vec![way((Vec2::ZERO, 0.0))];
        for (v, w) in velocities {
            bodies.push(SolverBody {
                v: *v - vec2(0.0, 9.81 * H),
                w: *w,
                inverse_mass: 1.0,
                inverse_inertia: 8.0,
                ..SolverBody::default()
            });
            ways.push(way((*v, *w)));
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
        (bodies, ways, rows)
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

    fn kinetic((v, w): Speed) -> f64 {
        0.5 * (v.length_squared() + w * w / 8.0)
    }

    /// With µ = 1.37 sweeps went to and fro between two answers, and 2.7e-3 J came of 2.1.
    #[test]
    fn sweeps_that_go_round_in_circles_gain_nothing() {
        let places = [vec2(0.0, 0.5), vec2(1.0, 0.5), vec2(2.0, 0.5)];
        let velocities = [
            (vec2(0.822_649_192_444_679_6, 0.0), 0.0),
            (
                vec2(0.748_175_626_960_073_7, 0.020_726_903_334_430_363),
                -2.904_243_213_480_147,
            ),
            (
                vec2(0.843_681_440_743_424_5, -0.022_177_799_410_381_796),
                2.984_043_105_743_952_5,
            ),
        ];
        let mu = 1.368_142_032_648_462_3;
        let (mut bodies, before, mut rows) = row_of_discs(&places, &velocities, mu);
        let mut ways = before.clone();
        hold(H, &mut bodies, &mut ways, &mut rows, 1e-9);
        let energy = |ways: &[Way]| ways[1..].iter().map(|way| kinetic(way.start)).sum::<f64>();
        let (was, is) = (energy(&before), energy(&ways));
        assert!(is <= was * (1.0 + 1e-13), "{is} J of {was} J");
    }

    proptest! {
        #[test]
        fn no_group_gains_at_any_instant((places, velocities) in group(), mu in 0.0..1.5_f64) {
            let (mut bodies, before, mut rows) = row_of_discs(&places, &velocities, mu);
            let mut ways = before.clone();
            hold(H, &mut bodies, &mut ways, &mut rows, 1e-9);
            for part in [0.0, 0.125, 0.5, 0.875, 1.0] {
                let (mut gain, mut scale) = (0.0, 0.0);
                for ((body, old), way) in bodies.iter().zip(&before).zip(&ways).skip(1) {
                    let to = |new: f64, old: f64| old + part * (new - old);
                    let now = (
                        vec2(to(body.v.x, way.start.0.x), to(body.v.y, way.start.0.y)),
                        to(body.w, way.start.1),
                    );
                    // A body that nothing pushes is left to free flight.
                    let even = way.even.filter(|_| body.acted);
                    let mean = even.map_or((way.start.0 + now.0) * 0.5, |even| even.0);
                    gain += kinetic(now) - kinetic(old.start) + 9.81 * part * H * mean.y;
                    scale += kinetic(old.start) + 9.81 * H;
                }
                prop_assert!(gain <= 1e-13 * scale, "{gain:e} J of {scale:e} at {part}");
            }
            for row in &rows {
                prop_assert!(row.j[0] >= 0.0 && row.jt.abs() <= mu * row.j[0]);
            }
        }

        #[test]
        fn without_friction_velocities_are_those_of_the_equations((places, velocities) in group()) {
            // More are let go before they are solved for to rounding.
            let few = places.len().min(3);
            let (places, velocities) = (&places[..few], &velocities[..few]);
            let (mut bodies, before, mut rows) = row_of_discs(places, velocities, 0.0);
            let mut ways = before.clone();
            let centres: Vec<Vec2> = [Vec2::ZERO].iter().chain(places).copied().collect();
            let mut twin = Vec::new();
            for ((body, way), centre) in bodies.iter().zip(&before).zip(&centres) {
                twin.push(ImpactBody {
                    inverse_mass: body.inverse_mass,
                    inverse_inertia: body.inverse_inertia,
                    centre: *centre,
                    velocity: way.start.0,
                    spin: way.start.1,
                });
            }
            let contact = |row: &Row| {
                let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
                let contact = ImpactContact {
                    point: centres[b] - row.n * 0.5,
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
            let comes_down = contacts.iter().zip(&asked).any(|(shared, asked)| {
                let opens = twin[shared.b].velocity - twin[shared.a].velocity;
                opens.dot(shared.contact.normal) < asked.0 - 1e-9 / H
            });
            if comes_down {
                let landed = held(&twin, &contacts, &asked);
                prop_assert!(landed.sure);
                twin = landed.bodies;
            }
            for body in &mut twin[1..] {
                body.velocity.y -= 9.81 * H;
            }
            let twin = held(&twin, &contacts, &asked);
            prop_assert!(twin.sure);
            hold(H, &mut bodies, &mut ways, &mut rows, 1e-9);
            for (body, twin) in bodies.iter().zip(&twin.bodies) {
                prop_assert!((body.v - twin.velocity).length() < 1e-9, "{:?} {:?}", body.v, twin.velocity);
            }
        }
    }

    #[test]
    fn sliding_on_a_floor_follows_the_trapezoidal_rule() {
        let (mut bodies, before, mut rows) =
            row_of_discs(&[vec2(0.0, 0.5)], &[(vec2(1.0, 0.0), 0.0)], 0.3);
        let mut ways = before.clone();
        hold(H, &mut bodies, &mut ways, &mut rows, 1e-9);
        assert_eq!((ways[1].start, ways[1].even), (before[1].start, None));
        assert!((bodies[1].v.x - (1.0 - 0.3 * 9.81 * H)).abs() < 1e-15);
        assert!(bodies[1].v.y.abs() < 1e-16);
    }
}
