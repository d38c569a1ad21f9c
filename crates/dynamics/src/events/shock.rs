//! An impact on a body that others hold: the contacts that it runs into are resolved with it.
//!
//! From the struck contact outwards: a contact joins when the shock reaches it. As long as they are few, and
//! wherever none has friction, [several contacts at once](crate::impact::several) are solved for to
//! rounding, by the law that the settings name. In a pile, where they become many, it is Newton's
//! law for all of them at once, as one complementarity problem in velocities:
//! `v_n⁺ ≥ −e v_n⁻` and `j_n ≥ 0`, of which one holds with equality at every contact, and Coulomb's
//! cone for friction. Struck contacts have their approach to give back; contacts that lasted have
//! none and only must not close. Solved by projected Gauss–Seidel over accumulated impulses, in bounded time, and what it
//! would gain by friction is not given back (`loss`).

mod loss;

use carom_math::{SimTime, Vec2, perp};

use crate::impact::{
    Growth, ImpactBody, ImpactContact, SharedContact, Sweeper, is_driven, resolve, several,
};
use crate::model::ghost::look_at;
use crate::model::narrow::{TOUCH, rest_speed};
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
use crate::{BodyIx, PairIx, PairMaterial, Settings, Two};

/// Sweeps before the rest is left to the next look: what still closes then is struck again.
const SWEEPS: usize = 300;

/// Contacts in one shock; what it reaches beyond them is struck in its turn.
const STRIKES: usize = 64;

/// Contacts with friction that are solved for to rounding; a pile takes more, and has them swept. Against 8 the scenes
/// `c_smash`, `d_tumbler` and `f_polygon_pile` take as long in hybrid mode, `d_tumbler` in exact mode 6 to 15 % more,
/// and with 32 a fifth to a third more (2026-11-23).
const FEW: usize = 16;

/// Change of velocity in a sweep, as a fraction of the struck speed, at which it has converged.
const CONVERGED: f64 = 1e-12;

/// The same as a fraction of the slowest rest speed among the pairs: what is left then is rest, and the solver's.
/// Impacts of the scene `d_tumbler` take 185 ms a step with it and 270 ms without (100 steps, 2026-11-21).
const SETTLED: f64 = 0.01;

/// Floating-point operations of a contact's turn in a sweep.
const TURN: u64 = 64;

/// The same of a look at a pair by shape.
const LOOK: u64 = 512;

/// Part of the fastest approach from which on a contact goes on closing, and not by what the sweeps have left.
const CLOSES: f64 = 1.0 / 64.0;

/// A contact in a shock.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strike {
    pub(crate) pair: PairIx,
    pub(crate) contact: ImpactContact,
    /// Places of A and B in the shock.
    ends: (usize, usize),
    /// Normal velocity to reach, in m/s, ≥ 0.
    target: f64,
    /// Normal speed of approach before, in m/s.
    pub(crate) speed: f64,
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
    pub(crate) index: BodyIx,
    before: ImpactBody,
    pub(crate) after: ImpactBody,
}

/// All that an impact involves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shock {
    time: SimTime,
    pub(crate) strikes: Vec<Strike>,
    pub(crate) bodies: Vec<Shaken>,
    /// Pairs with contacts updated at this instant, and the speeds that count as rest there.
    looked: Vec<(PairIx, f64)>,
    /// Slowest rest speed of the pairs, in m/s.
    rest: f64,
    /// The limit of impacts that came ever faster: nothing is given back.
    collapses: bool,
    /// Bodies may be squeezed between others that do not yield: contacts may close afterwards.
    squeezed: bool,
    /// Floating-point operations so far, to a factor of a few: what the work of a call is charged for.
    pub(crate) operations: u64,
}

impl Shock {
    pub(crate) fn new(time: SimTime) -> Self {
        Self {
            time,
            rest: f64::INFINITY,
            ..Self::default()
        }
    }

    /// Takes it for the limit of impacts that come ever faster, one after the other through the same bodies: each leaves a part
    /// of the approach, all of them none. So the limit is a common stop of all that was struck on the way and touches.
    pub(crate) fn collapse(&mut self) {
        self.collapses = true;
        for strike in &mut self.strikes {
            (strike.contact.restitution, strike.target) = (0.0, 0.0);
        }
    }

    /// What a collapse stopped lasts.
    pub(crate) fn hold(&self, pairs: &mut Pairs) {
        if self.collapses {
            for strike in &self.strikes {
                pairs.get_mut(strike.pair).lasting |= strike.normal_impulse > 0.0;
            }
        }
    }

    /// Contacts of squeezed bodies that go on closing. No impulses stop them: struck again at this instant they would only
    /// drive their bodies faster.
    pub(crate) fn squeezed(&self) -> impl Iterator<Item = &Strike> {
        let fastest = self.strikes.iter().map(|strike| strike.speed);
        let least = CLOSES * fastest.fold(0.0, f64::max);
        let closes = move |strike: &&Strike| {
            let after = |end: usize| self.bodies[end].after.velocity_of(strike.contact.point);
            let opening = after(strike.ends.1) - after(strike.ends.0);
            opening.dot(strike.contact.normal) < -least
        };
        self.strikes.iter().filter(|_| self.squeezed).filter(closes)
    }

    /// Adds a contact of a pair of bodies; its approach is to be given back by its restitution
    /// where it is faster than `rest`.
    pub(crate) fn add(
        &mut self,
        bodies: &Bodies,
        pair: PairIx,
        (i, j): Two<BodyIx>,
        (point, normal): (Vec2, Vec2),
        material: PairMaterial,
        rest: f64,
    ) {
        self.rest = self.rest.min(rest);
        let contact = material.contact(point, normal);
        let run = perp(normal) * material.tangent_speed;
        let ends = (self.place(bodies, i, run), self.place(bodies, j, -run));
        let (a, b) = (&self.bodies[ends.0].before, &self.bodies[ends.1].before);
        let opening = b.velocity_of(contact.point) - a.velocity_of(contact.point);
        let speed = -opening.dot(contact.normal);
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
            normal_impulse: 0.0,
            tangential_impulse: 0.0,
        });
    }

    /// Adds every touching contact of the shaken bodies that the shock closes; whether there is one.
    pub(crate) fn spread(&mut self, bodies: &Bodies, pairs: &mut Pairs) -> bool {
        let known = self.strikes.len();
        let mut k = 0;
        while k < self.bodies.len() && self.strikes.len() < STRIKES {
            let shaken = self.bodies[k];
            k += 1;
            if shaken.after.inverse_mass == 0.0 || shaken.after == shaken.before {
                continue;
            }
            for &place in &bodies.get(shaken.index).pairs {
                self.spread_to(bodies, pairs, place);
            }
        }
        self.strikes.len() > known
    }

    fn spread_to(&mut self, bodies: &Bodies, pairs: &mut Pairs, place: PairIx) {
        let mut pair = pairs.get(place);
        // What bounces on its own will be struck in its turn; what lasts is part of this, and what collapses with it.
        let lasts = pair.lasting
            || pair.touching && pair.material.restitution == 0.0
            || self.collapses && pair.impacts > 0;
        if pair.buried || !lasts {
            return;
        }
        let looked = self.looked.iter().find(|(seen, _)| *seen == place);
        let rest = if let Some((_, rest)) = looked {
            *rest
        } else {
            pair = look_at(bodies, pairs, place, self.time);
            let rest = rest_speed(bodies, pair);
            self.operations += LOOK;
            self.looked.push((place, rest));
            rest
        };
        let [a, b] = [pair.bodies.0, pair.bodies.1].map(|index| bodies.get(index));
        let size = a.reach.min(b.reach);
        for contact in &pair.contacts {
            let points = contact.points.iter();
            for point in points.filter(|p| p.separation <= TOUCH * size) {
                let same = |strike: &Strike| {
                    strike.pair == place
                        && (strike.contact.point - point.position).length() <= 1e-6 * size
                };
                if self.strikes.iter().any(same) {
                    continue;
                }
                let ends = (
                    self.place(bodies, pair.bodies.0, Vec2::ZERO),
                    self.place(bodies, pair.bodies.1, Vec2::ZERO),
                );
                let (a, b) = (&self.bodies[ends.0].after, &self.bodies[ends.1].after);
                let closing = (a.velocity_of(point.position) - b.velocity_of(point.position))
                    .dot(contact.normal);
                if closing > rest {
                    let mut material = pair.material;
                    if self.collapses {
                        material.restitution = 0.0;
                    }
                    let at = (point.position, contact.normal);
                    self.add(bodies, place, pair.bodies, at, material, rest);
                }
            }
        }
    }

    /// Solves for all contacts at once; they grow in number as the shock spreads.
    pub(crate) fn solve(&mut self, settings: &Settings, bodies: &Bodies, pairs: &mut Pairs) {
        while self.is_few() {
            self.solve_exactly(settings);
            if !self.spread(bodies, pairs) {
                return;
            }
        }
        self.solve_swept(bodies, pairs);
    }

    fn is_few(&self) -> bool {
        let smooth = |strike: &Strike| strike.contact.friction == 0.0;
        self.strikes.len() <= FEW || self.strikes.iter().all(smooth)
    }

    fn solve_exactly(&mut self, settings: &Settings) {
        if let [strike] = self.strikes.as_mut_slice() {
            let (a, b) = strike.ends;
            let (one, two) = (self.bodies[a].before, self.bodies[b].before);
            let alone = resolve(settings.impact_law, &one, &two, &strike.contact);
            (self.bodies[a].after, self.bodies[b].after) = (alone.a, alone.b);
            (strike.normal_impulse, strike.tangential_impulse) =
                (alone.normal_impulse, alone.tangential_impulse);
            return;
        }
        let shared = |strike: &Strike| SharedContact {
            a: strike.ends.0,
            b: strike.ends.1,
            contact: strike.contact,
        };
        let contacts: Vec<SharedContact> = self.strikes.iter().map(shared).collect();
        let before: Vec<ImpactBody> = self.bodies.iter().map(|shaken| shaken.before).collect();
        let found = several(settings.impact_law, settings.several, &before, &contacts);
        self.operations += found.operations;
        self.squeezed = found.exhausted;
        for (shaken, after) in self.bodies.iter_mut().zip(found.bodies) {
            shaken.after = after;
        }
        for (strike, impulses) in self.strikes.iter_mut().zip(found.impulses) {
            (strike.normal_impulse, strike.tangential_impulse) = impulses;
        }
    }

    /// Newton's law by sweeps, from the impulses that are there on.
    ///
    /// Where bodies are squeezed between others that do not yield the impulses of the sweeps grow without end. They are
    /// begun anew there, with contacts that yield and give nothing back.
    fn solve_swept(&mut self, bodies: &Bodies, pairs: &mut Pairs) {
        let struck = self
            .strikes
            .iter()
            .map(|strike| strike.speed)
            .fold(0.0, f64::max);
        let settled = (CONVERGED * struck).max(SETTLED * self.rest);
        let mut sweep = |shock: &mut Self, by| shock.sweep(by, settled, bodies, pairs);
        let driven = is_driven(self.bodies.iter().map(|shaken| &shaken.before));
        if sweep(self, Sweeper::default()).is_steady() && driven {
            self.squeezed = true;
            self.collapse();
            self.begin_anew();
            sweep(self, Sweeper::yielding());
        } else {
            self.gain_nothing(settled);
        }
    }

    /// Sweeps until `settled` m/s are left, or for a bounded time; how the pushes grew.
    fn sweep(
        &mut self,
        mut sweeper: Sweeper,
        settled: f64,
        bodies: &Bodies,
        pairs: &mut Pairs,
    ) -> Growth {
        let mut growth = Growth::default();
        for sweep in 1..=SWEEPS {
            self.hand_over(&mut sweeper);
            let converged = sweeper.sweep() <= settled;
            self.operations += TURN * self.strikes.len() as u64;
            growth.note(sweep, SWEEPS, || sweeper.pushes());
            // Asking which contacts are reached costs more than a sweep: at every doubling, and at last.
            if !(converged || sweep.is_power_of_two() || sweep == SWEEPS) {
                continue;
            }
            self.take_over(&sweeper);
            let grew = self.spread(bodies, pairs);
            if converged && !grew {
                break;
            }
        }
        growth
    }

    /// Takes all impulses back.
    fn begin_anew(&mut self) {
        for shaken in &mut self.bodies {
            shaken.after = shaken.before;
        }
        for strike in &mut self.strikes {
            (strike.normal_impulse, strike.tangential_impulse) = (0.0, 0.0);
        }
    }

    /// Bodies and contacts not yet in the sweeps.
    fn hand_over(&self, sweeper: &mut Sweeper) {
        let (bodies, contacts) = sweeper.len();
        for shaken in &self.bodies[bodies..] {
            sweeper.add_body(&shaken.after);
        }
        for strike in &self.strikes[contacts..] {
            let (a, b) = strike.ends;
            sweeper.add_contact(
                strike.ends,
                (&self.bodies[a].before, &self.bodies[b].before),
                &strike.contact,
                strike.target,
                (strike.normal_impulse, strike.tangential_impulse),
            );
        }
    }

    fn take_over(&mut self, sweeper: &Sweeper) {
        for (k, shaken) in self.bodies.iter_mut().enumerate() {
            (shaken.after.velocity, shaken.after.spin) = sweeper.velocity(k);
        }
        for (k, strike) in self.strikes.iter_mut().enumerate() {
            (strike.normal_impulse, strike.tangential_impulse) = sweeper.impulses(k);
        }
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
    pub(crate) fn ends(&self, strike: &Strike) -> Two<BodyIx> {
        (
            self.bodies[strike.ends.0].index,
            self.bodies[strike.ends.1].index,
        )
    }

    /// Place of a body; of one that nothing moves with its surface's speed `run`, a new one.
    fn place(&mut self, bodies: &Bodies, index: BodyIx, run: Vec2) -> usize {
        let state = bodies.get(index);
        let runs = run != Vec2::ZERO && state.inverse_mass == 0.0;
        let known = self.bodies.iter().position(|shaken| shaken.index == index);
        if let Some(known) = known.filter(|_| !runs) {
            return known;
        }
        let mut before = state.in_impact(self.time);
        if runs {
            before.velocity += run;
        }
        self.bodies.push(Shaken {
            index,
            before,
            after: before,
        });
        self.bodies.len() - 1
    }
}
