//! What lasts from an instant on: rows of the contacts, and the bodies that they join.

use carom_math::SimTime;

use super::round::{Speed, Way};
use super::{Groups, NOT_HERE, Source, key_of};
use super::{Row, SolverBody};
use crate::model::gap::is_round;
use crate::model::narrow::{RestSpeed, TOUCH, opening_speed};
use crate::motion::flight::driven;
use crate::store::bodies::Bodies;
use crate::store::pairs::{PairPoint, Pairs};
use crate::store::state::Collider;

impl Groups {
    /// Rows of all contacts that do not bounce, and the bodies they join.
    pub(super) fn gather(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        pairs: &Pairs,
        time: SimTime,
        h: f64,
    ) {
        self.rows.clear();
        self.sources.clear();
        self.bodies.clear();
        self.ways.clear();
        for &index in &self.members {
            self.places[index as usize] = NOT_HERE;
        }
        self.members.clear();
        self.rounds.clear();
        self.round_of.clear();
        self.places.resize(bodies.places(), NOT_HERE);
        // Contacts with what cannot be moved come last: the ground has the last word.
        for ground in [false, true] {
            let mut i = 0;
            while let Some(place) = pairs.place(i) {
                i += 1;
                let pair = pairs.get(place);
                let (a, b) = (bodies.get(pair.bodies.0), bodies.get(pair.bodies.1));
                let fixed = a.inverse_mass == 0.0 || b.inverse_mass == 0.0;
                let closed = a.membership.is_closed() || b.membership.is_closed();
                if pair.contacts.is_empty()
                    || closed
                    || fixed != ground
                    || !(a.is_stepped() || b.is_stepped())
                    || a.is_free()
                    || b.is_free()
                    || a.in_engine()
                    || b.in_engine()
                    // A touch has woken the sleeper; across a gap it is met, and woken, by an impact.
                    || a.is_asleep()
                    || b.is_asleep()
                {
                    continue;
                }
                let touch = TOUCH * a.reach.min(b.reach);
                let is_round = !pair.sunk && is_round(bodies, colliders, pair);
                // What turning presses comes down within a sub-step: it rests where it touches, and not before.
                let rest = if pair.given_up || pair.buried {
                    RestSpeed::ANY
                } else {
                    RestSpeed::of(bodies, pair, h)
                };
                let (centre_a, centre_b) = (a.motion.centre_at(time), b.motion.centre_at(time));
                for (index, contact) in pair.contacts.iter().enumerate() {
                    let opening =
                        |p: &PairPoint| opening_speed(a, b, time, p.position, contact.normal);
                    // What closes faster than rest will be struck at its instant, unless it touches
                    // and is held.
                    let lasts = |p: &PairPoint| {
                        if p.separation <= touch {
                            pair.held || opening(p) >= -rest.all
                        } else {
                            opening(p) >= -rest.pulled
                        }
                    };
                    if !contact.points.iter().any(lasts) {
                        continue;
                    }
                    let ends = (
                        self.place_of(bodies, pair.bodies.0, time, h),
                        self.place_of(bodies, pair.bodies.1, time, h),
                    );
                    let arms: arrayvec::ArrayVec<_, 2> = contact
                        .points
                        .iter()
                        .map(|p| (p.position - centre_a, p.position - centre_b))
                        .collect();
                    let mut row = Row::new(ends, contact.normal, &arms, pair.material.friction);
                    row.belt = pair.material.tangent_speed;
                    for (k, point) in contact.points.iter().enumerate() {
                        if lasts(point) {
                            row.gap[k] = point.separation;
                            // What a closed form says of no force may be below 0 by rounding.
                            row.j[k] = point.impulse.max(0.0);
                        }
                    }
                    let limit = row.mu * (row.j[0] + row.j[1]);
                    row.jt = contact.tangent_impulse.clamp(-limit, limit);
                    self.rows.push(row);
                    self.sources.push(Source {
                        pair: place,
                        key: key_of(bodies, pair),
                        contact: index,
                        is_round,
                        touch,
                        rest: rest.all,
                        closes: row.gap[0].max(0.0) / h,
                        gone: false,
                    });
                }
            }
        }
    }

    fn place_of(&mut self, bodies: &Bodies, index: u32, time: SimTime, h: f64) -> u32 {
        let known = self.places[index as usize];
        if known != NOT_HERE {
            return known;
        }
        let state = bodies.get(index);
        let start = (state.velocity_at(time), state.spin_at(time));
        self.ways.push(Way { start, even: None });
        let (v, w) = pulled(bodies, index, time, start, h);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "fewer than there are bodies"
        )]
        let place = self.bodies.len() as u32;
        self.bodies.push(SolverBody {
            v,
            w,
            inverse_mass: state.inverse_mass,
            inverse_inertia: state.inverse_inertia,
            ..SolverBody::default()
        });
        self.members.push(index);
        self.places[index as usize] = place;
        place
    }
}

/// What `h` seconds without contacts leave of the velocity and spin that a body has at `time`.
pub(super) fn pulled(bodies: &Bodies, index: u32, time: SimTime, start: Speed, h: f64) -> Speed {
    let state = bodies.get(index);
    if state.inverse_mass == 0.0 {
        return start;
    }
    let pull = state.gravity_scale() * bodies.pull.at(state.motion.centre_at(time));
    let pulls = (
        pull + state.force() * state.inverse_mass,
        state.torque() * state.inverse_inertia,
    );
    driven(state, start, pulls, h)
}
