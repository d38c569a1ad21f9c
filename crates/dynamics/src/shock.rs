//! An impact on a body that others hold: the contacts that it runs into are resolved with it.
//!
//! Without friction it is the [blend](crate::impact::blend) of several contacts, right to rounding.
//! With friction it is Newton's law for all of them at once, as one complementarity problem in velocities:
//! `v_n⁺ ≥ −e v_n⁻` and `j_n ≥ 0`, of which one holds with equality at every contact, and Coulomb's
//! cone for friction. Struck contacts have their approach to give back; contacts that lasted have
//! none and only must not close. Solved by projected Gauss–Seidel over accumulated impulses, from
//! the struck contact outwards: a contact joins when the shock reaches it.

use carom_math::{SimTime, Vec2, perp};

use crate::bodies::Bodies;
use crate::body::Collider;
use crate::impact::{ImpactBody, ImpactContact, Response, SharedContact, blend};
use crate::narrow::{Narrow, TOUCH, rest_speed};
use crate::pairs::Pairs;

/// Sweeps before the rest is left to the next look: what still closes then is struck again.
const SWEEPS: u32 = 300;

/// Contacts in one shock; what it reaches beyond them is struck in its turn.
const STRIKES: usize = 64;

/// Change of velocity in a sweep, as a fraction of the struck speed, at which it has converged.
const CONVERGED: f64 = 1e-12;

/// The same as a fraction of the slowest rest speed among the pairs: what is left then is rest, and the solver's.
/// Impacts of the scene `d_tumbler` take 185 ms a step with it and 270 ms without (100 steps, 2026-11-21).
const SETTLED: f64 = 0.01;

/// A contact in a shock.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strike {
    pub(crate) pair: u32,
    pub(crate) contact: ImpactContact,
    /// Places of A and B in the shock.
    ends: (usize, usize),
    /// Normal velocity to reach, in m/s, ≥ 0.
    target: f64,
    /// Normal speed of approach before, in m/s.
    pub(crate) speed: f64,
    response: Response,
    pub(crate) normal_impulse: f64,
    pub(crate) tangential_impulse: f64,
}

impl Strike {
    /// Takes on what another end of the same face pushed.
    fn join(&mut self, other: &Self) {
        let total = self.normal_impulse + other.normal_impulse;
        let share = other.normal_impulse / total;
        self.contact.point += (other.contact.point - self.contact.point) * share;
        self.normal_impulse = total;
        self.tangential_impulse += other.tangential_impulse;
        self.speed = self.speed.max(other.speed);
    }
}

/// A body in a shock.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shaken {
    pub(crate) index: u32,
    before: ImpactBody,
    pub(crate) after: ImpactBody,
}

/// All that an impact involves.
#[derive(Clone, Debug)]
pub(crate) struct Shock {
    time: SimTime,
    h: f64,
    pub(crate) strikes: Vec<Strike>,
    pub(crate) bodies: Vec<Shaken>,
    /// Pairs whose contacts are those of this instant, with the speeds that count as rest there, in m/s.
    looked: Vec<(u32, f64)>,
    /// Slowest rest speed of the pairs, in m/s.
    rest: f64,
}

impl Shock {
    pub(crate) fn new(time: SimTime, h: f64) -> Self {
        Self {
            time,
            h,
            strikes: Vec::new(),
            bodies: Vec::new(),
            looked: Vec::new(),
            rest: f64::INFINITY,
        }
    }

    /// Adds a contact of a pair of bodies; its approach is to be given back by its restitution
    /// where it is faster than `rest`.
    pub(crate) fn add(
        &mut self,
        bodies: &Bodies,
        pair: u32,
        (i, j): (u32, u32),
        contact: ImpactContact,
        rest: f64,
    ) {
        self.rest = self.rest.min(rest);
        let ends = (self.place(bodies, i), self.place(bodies, j));
        let (a, b) = (&self.bodies[ends.0].before, &self.bodies[ends.1].before);
        let response = Response::of(a, b, &contact);
        let speed = -response.u_n;
        let bounces = speed > rest;
        self.strikes.push(Strike {
            pair,
            contact,
            ends,
            target: if bounces {
                contact.restitution * speed
            } else {
                0.0
            },
            speed,
            response,
            normal_impulse: 0.0,
            tangential_impulse: 0.0,
        });
    }

    /// Velocities after a single impact, by whatever law gave them.
    pub(crate) fn set(&mut self, a: ImpactBody, b: ImpactBody, impulses: (f64, f64)) {
        let strike = &mut self.strikes[0];
        self.bodies[strike.ends.0].after = a;
        self.bodies[strike.ends.1].after = b;
        (strike.normal_impulse, strike.tangential_impulse) = impulses;
    }

    /// Adds every touching contact of the shaken bodies that the shock closes; whether there is one.
    pub(crate) fn spread(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        pairs: &mut Pairs,
        narrow: &mut Narrow,
    ) -> bool {
        let known = self.strikes.len();
        let mut k = 0;
        while k < self.bodies.len() && self.strikes.len() < STRIKES {
            let shaken = self.bodies[k];
            k += 1;
            if shaken.after.inverse_mass == 0.0 || shaken.after == shaken.before {
                continue;
            }
            for slot in 0..bodies.get(shaken.index).pairs.len() {
                let place = bodies.get(shaken.index).pairs[slot];
                self.spread_to(bodies, colliders, pairs, narrow, place);
            }
        }
        self.strikes.len() > known
    }

    fn spread_to(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        pairs: &mut Pairs,
        narrow: &mut Narrow,
        place: u32,
    ) {
        let pair = pairs.get_mut(place);
        // What bounces on its own will be struck in its turn; what lasts is part of this.
        let lasts = pair.lasting || pair.touching && pair.material.restitution == 0.0;
        if pair.buried || !lasts {
            return;
        }
        let looked = self.looked.iter().find(|(seen, _)| *seen == place);
        let rest = if let Some((_, rest)) = looked {
            *rest
        } else {
            narrow.look(bodies, colliders, pair, self.time, self.h);
            let rest = rest_speed(bodies, pair, self.h);
            self.looked.push((place, rest));
            rest
        };
        let size = bodies
            .get(pair.bodies.0)
            .reach
            .min(bodies.get(pair.bodies.1).reach);
        for contact in &pair.contacts {
            for point in contact
                .points
                .iter()
                .filter(|p| p.separation <= TOUCH * size)
            {
                let same = |strike: &Strike| {
                    strike.pair == place
                        && (strike.contact.point - point.position).length() <= 1e-6 * size
                };
                if self.strikes.iter().any(same) {
                    continue;
                }
                let ends = (
                    self.place(bodies, pair.bodies.0),
                    self.place(bodies, pair.bodies.1),
                );
                let (a, b) = (&self.bodies[ends.0].after, &self.bodies[ends.1].after);
                let closing = (a.velocity_of(point.position) - b.velocity_of(point.position))
                    .dot(contact.normal);
                if closing > rest {
                    let contact = ImpactContact {
                        point: point.position,
                        normal: contact.normal,
                        restitution: pair.material.restitution,
                        friction: pair.material.friction,
                    };
                    self.add(bodies, place, pair.bodies, contact, rest);
                }
            }
        }
    }

    /// Solves for all contacts at once; they grow in number as the shock spreads.
    pub(crate) fn solve(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        pairs: &mut Pairs,
        narrow: &mut Narrow,
    ) {
        if self
            .strikes
            .iter()
            .all(|strike| strike.contact.friction == 0.0)
        {
            return self.solve_smooth(bodies, colliders, pairs, narrow);
        }
        for shaken in &mut self.bodies {
            shaken.after = shaken.before;
        }
        for strike in &mut self.strikes {
            (strike.normal_impulse, strike.tangential_impulse) = (0.0, 0.0);
        }
        let struck = self
            .strikes
            .iter()
            .map(|strike| strike.speed)
            .fold(0.0, f64::max);
        let settled = (CONVERGED * struck).max(SETTLED * self.rest);
        for sweep in 0..SWEEPS {
            let mut change = 0.0_f64;
            for k in 0..self.strikes.len() {
                change = change.max(self.sweep(k));
            }
            let converged = change <= settled;
            // Who is reached is asked at every doubling, and at last: asking costs more than a sweep.
            let due = converged || (sweep + 1_u32).is_power_of_two();
            let grew = due && self.spread(bodies, colliders, pairs, narrow);
            if converged && !grew {
                break;
            }
        }
    }

    /// Solves for all contacts at once where none has friction.
    fn solve_smooth(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        pairs: &mut Pairs,
        narrow: &mut Narrow,
    ) {
        loop {
            let contacts: Vec<SharedContact> = self
                .strikes
                .iter()
                .map(|strike| SharedContact {
                    a: strike.ends.0,
                    b: strike.ends.1,
                    contact: strike.contact,
                })
                .collect();
            let before: Vec<ImpactBody> = self.bodies.iter().map(|shaken| shaken.before).collect();
            let found = blend(&before, &contacts);
            for (shaken, after) in self.bodies.iter_mut().zip(found.bodies) {
                shaken.after = after;
            }
            for (strike, impulse) in self.strikes.iter_mut().zip(found.normal_impulses) {
                strike.normal_impulse = impulse;
            }
            if !self.spread(bodies, colliders, pairs, narrow) {
                return;
            }
        }
    }

    /// One contact's turn; the largest change of its velocity.
    fn sweep(&mut self, k: usize) -> f64 {
        let strike = self.strikes[k];
        let (contact, response) = (&strike.contact, &strike.response);
        let u = self.opening(&strike);
        let (n, t) = (contact.normal, perp(contact.normal));
        let wanted = (strike.target - u.dot(n)) / response.k_nn;
        let normal = (strike.normal_impulse + wanted).max(0.0);
        self.push(&strike, n * (normal - strike.normal_impulse));
        let slip = self.opening(&strike).dot(t);
        let limit = contact.friction * normal;
        let tangential = (strike.tangential_impulse - slip / response.k_tt).clamp(-limit, limit);
        self.push(&strike, t * (tangential - strike.tangential_impulse));
        let strike = &mut self.strikes[k];
        let change = ((normal - strike.normal_impulse) * response.k_nn)
            .abs()
            .max(((tangential - strike.tangential_impulse) * response.k_tt).abs());
        (strike.normal_impulse, strike.tangential_impulse) = (normal, tangential);
        change
    }

    fn opening(&self, strike: &Strike) -> Vec2 {
        let (a, b) = (
            &self.bodies[strike.ends.0].after,
            &self.bodies[strike.ends.1].after,
        );
        b.velocity_of(strike.contact.point) - a.velocity_of(strike.contact.point)
    }

    fn push(&mut self, strike: &Strike, impulse: Vec2) {
        let point = strike.contact.point;
        let (a, b) = strike.ends;
        self.bodies[a].after = self.bodies[a].after.pushed(-impulse, point);
        self.bodies[b].after = self.bodies[b].after.pushed(impulse, point);
    }

    /// What pushed: one impact for both ends of a flat landing, where their impulses act together.
    pub(crate) fn impacts(&self) -> Vec<Strike> {
        let mut all: Vec<Strike> = Vec::with_capacity(self.strikes.len());
        for strike in self
            .strikes
            .iter()
            .filter(|strike| strike.normal_impulse > 0.0)
        {
            let flat = |other: &&mut Strike| {
                other.pair == strike.pair && other.contact.normal == strike.contact.normal
            };
            match all.iter_mut().find(flat) {
                Some(impact) => impact.join(strike),
                None => all.push(*strike),
            }
        }
        all
    }

    /// Bodies of a strike.
    pub(crate) fn ends(&self, strike: &Strike) -> (u32, u32) {
        (
            self.bodies[strike.ends.0].index,
            self.bodies[strike.ends.1].index,
        )
    }

    /// Energy lost, and energy put in by driven bodies, in J: impulse × mean velocities, contact by
    /// contact. All impulses act together, so the mean is that of before and after all of them.
    pub(crate) fn works(&self) -> (f64, f64) {
        let (mut loss, mut driven) = (0.0, 0.0);
        for strike in &self.strikes {
            let contact = &strike.contact;
            let impulse = contact.normal * strike.normal_impulse
                + perp(contact.normal) * strike.tangential_impulse;
            let mean = |end: usize| {
                let shaken = &self.bodies[end];
                0.5 * (shaken.before.velocity_of(contact.point)
                    + shaken.after.velocity_of(contact.point))
            };
            let (a, b) = (mean(strike.ends.0), mean(strike.ends.1));
            loss -= impulse.dot(b - a);
            if self.bodies[strike.ends.0].before.inverse_mass == 0.0 {
                driven += impulse.dot(a);
            }
            if self.bodies[strike.ends.1].before.inverse_mass == 0.0 {
                driven -= impulse.dot(b);
            }
        }
        (loss, driven)
    }

    fn place(&mut self, bodies: &Bodies, index: u32) -> usize {
        if let Some(known) = self.bodies.iter().position(|shaken| shaken.index == index) {
            return known;
        }
        let state = bodies.get(index).in_impact(self.time);
        self.bodies.push(Shaken {
            index,
            before: state,
            after: state,
        });
        self.bodies.len() - 1
    }
}
