//! Contact groups: what pushes what, lasting, in one sub-step.

use carom_math::SimTime;

use crate::StepReport;
use crate::apart::{Method, set_apart};
use crate::bodies::{Bodies, Booked};
use crate::flight::driven;
use crate::heavy::{Place, solve_heavy};
use crate::narrow::{RestSpeed, TOUCH, opening_speed};
use crate::pairs::{PairPoint, Pairs};
use crate::round::{Start, hold, is_round};
use crate::solver::{Law, Row, SolverBody, sweep};
use crate::state::Collider;

/// Scratch of the sub-step's solve, kept between sub-steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Groups {
    rows: Vec<Row>,
    /// Where each row came from: place of the pair, contact within it, and which points act.
    sources: Vec<Source>,
    bodies: Vec<SolverBody>,
    /// How each of them begins its way through the sub-step.
    starts: Vec<Start>,
    /// Bodies of the solver, in its order.
    members: Vec<u32>,
    /// Some pair of this sub-step is buried.
    buried: bool,
    /// Place in the solver of each body, or [`NOT_HERE`].
    places: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Source {
    pair: u32,
    contact: usize,
    /// How it is solved for; before groups are known, how it may be.
    method: Method,
    /// Gap below which they touch, in m.
    touch: f64,
}

impl Source {
    /// Where its row pushes.
    fn place(self, bodies: &Bodies, pairs: &Pairs, time: SimTime) -> Place {
        let pair = pairs.get(self.pair);
        let centre = |index: u32| bodies.get(index).motion.centre_at(time);
        let points = &pair.contacts[self.contact].points;
        Place {
            points: points.iter().map(|point| point.position).collect(),
            centres: (centre(pair.bodies.0), centre(pair.bodies.1)),
        }
    }
}

const NOT_HERE: u32 = u32::MAX;

/// Sweeps without bias while a pair is buried.
const BURIED_SWEEPS: usize = 30;

impl Groups {
    /// Solves all contacts that last from `time` on for one sub-step, and gives every body
    /// that is pushed its motion. Bodies that nothing pushes are left to flight.
    pub(crate) fn step(
        &mut self,
        law: &Law,
        bodies: &mut Bodies,
        colliders: &[Collider],
        pairs: &mut Pairs,
        time: SimTime,
        report: &mut StepReport,
    ) {
        let h = law.h();
        self.gather(bodies, colliders, pairs, time, h);
        if self.rows.is_empty() {
            return;
        }
        report.rows += self.rows.len() as u64;
        let groups = set_apart(&self.bodies, &mut self.rows, &mut self.sources, |source| {
            source.method == Method::Round
        });
        for (mut method, group) in groups {
            let (rows, sources) = (&mut self.rows[group.clone()], &mut self.sources[group]);
            match method {
                Method::Swept => {
                    // What was put deep into each other is pushed by many at once: one sweep would leave a
                    // part of the push in the velocities.
                    let sweeps = if self.buried { BURIED_SWEEPS } else { 1 };
                    sweep(law, &mut self.bodies, rows, sweeps);
                }
                Method::Round => {
                    let touch = sources.iter().map(|at| at.touch);
                    let touch = touch.fold(f64::INFINITY, f64::min);
                    hold(law, &mut self.bodies, &mut self.starts, rows, touch);
                }
                Method::AtOnce => {
                    let places = sources.iter().map(|at| at.place(bodies, pairs, time));
                    let places: Vec<Place> = places.collect();
                    if !solve_heavy(law, &mut self.bodies, rows, &places) {
                        method = Method::Swept;
                        sweep(law, &mut self.bodies, rows, BURIED_SWEEPS);
                    }
                }
            }
            for source in sources {
                source.method = method;
            }
        }
        self.scatter(bodies, pairs, time, h, report);
    }

    /// Rows of all contacts that do not bounce, and the bodies they join.
    fn gather(
        &mut self,
        bodies: &Bodies,
        colliders: &[Collider],
        pairs: &Pairs,
        time: SimTime,
        h: f64,
    ) {
        self.rows.clear();
        self.sources.clear();
        self.buried = false;
        self.bodies.clear();
        self.starts.clear();
        self.members.clear();
        self.places.clear();
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
                    || a.is_flying()
                    || b.is_flying()
                    || a.in_crowd
                    || b.in_crowd
                    // Who touches a sleeper has woken it; across a gap it is met, and woken, by an impact.
                    || a.asleep
                    || b.asleep
                {
                    continue;
                }
                self.buried |= pair.buried;
                let touch = TOUCH * a.reach.min(b.reach);
                let method = if is_round(bodies, colliders, pair) {
                    Method::Round
                } else {
                    Method::Swept
                };
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
                            // What stopped a heavy body is too much to begin with once that has gone.
                            // What a closed form says of no force may be below 0 by rounding.
                            row.j[k] = if pair.at_once {
                                0.0
                            } else {
                                point.impulse.max(0.0)
                            };
                        }
                    }
                    let limit = row.mu * (row.j[0] + row.j[1]);
                    row.jt = contact.tangent_impulse.clamp(-limit, limit);
                    row.ground = ground;
                    self.rows.push(row);
                    self.sources.push(Source {
                        pair: place,
                        contact: index,
                        method,
                        touch,
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
        let (mut v, mut w) = (state.velocity_at(time), state.spin_at(time));
        self.starts.push((v, w));
        if state.inverse_mass > 0.0 {
            let pull = state.gravity_scale() * bodies.pull.at(state.motion.centre_at(time));
            let pulls = (
                pull + state.force() * state.inverse_mass,
                state.torque() * state.inverse_inertia,
            );
            (v, w) = driven(state, (v, w), pulls, h);
        }
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

    /// Motions to the members, impulses to the pairs, friction to the ledger.
    fn scatter(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        time: SimTime,
        h: f64,
        report: &mut StepReport,
    ) {
        bodies.booked.clear();
        let members = self.members.iter().zip(&mut self.bodies);
        for ((&index, member), start) in members.zip(&self.starts) {
            if member.inverse_mass == 0.0 || !member.acted {
                continue;
            }
            report.handed_over += 1;
            // What was pushed out is a displacement, not a motion: it moves the body at once, by
            // the difference of the pushed and the relaxed velocity, and strikes nobody. The rest
            // is the trapezoid from the velocity before to the relaxed one, so that sliding is of
            // second order and the velocity has no jumps; but for some that are held without springs.
            let (pushed, turned) = (member.d - member.v * h, member.turn - member.w * h);
            let before = bodies.energy_of(index, time);
            bodies.change(index, time, |motion| {
                motion.centre += pushed;
                motion.rotation = motion.rotation.turned(turned);
                (motion.velocity, motion.spin) = *start;
                motion.acceleration = (member.v - motion.velocity) / h;
                motion.angular_acceleration = (member.w - motion.spin) / h;
            });
            let state = bodies.get_mut(index);
            state.turned += turned;
            state.member = true;
            member.d = state.motion.travel(h);
            member.turn = state.motion.turn(h);
            let after = bodies.energy_of(index, time);
            bodies.book.scheme.add(after.0 - before.0);
            bodies.book.scheme.add(after.1 - before.1);
        }
        for (row, source) in self.rows.iter().zip(&self.sources) {
            let pair = pairs.get_mut(source.pair);
            pair.at_once = source.method == Method::AtOnce;
            pair.round = source.method == Method::Round;
            let contact = &mut pair.contacts[source.contact];
            for (point, j) in contact.points.iter_mut().zip(row.j) {
                point.impulse = j;
            }
            contact.tangent_impulse = row.jt;
            if !row.acts() {
                continue;
            }
            pair.lasting = true;
            let (a, b) = (
                &self.bodies[row.bodies.0 as usize],
                &self.bodies[row.bodies.1 as usize],
            );
            // Friction × slip is heat; the pieces' own work holds it too, as the scheme's.
            let mean = |body: &SolverBody| SolverBody {
                v: body.d / h,
                w: body.turn / h,
                ..*body
            };
            let heat = -row.jt * (row.slip(&mean(a), &mean(b)) - row.belt);
            bodies.book.friction.add(heat);
            bodies.book.scheme.add(heat);
            // What runs a belt puts in what the bodies get, and the heat.
            let driven = row.driven_work(a, b) + row.jt * row.belt;
            bodies.book.external.add(driven);
            bodies.book.scheme.add(-driven);
            let ends = [(a, row.bodies.0), (b, row.bodies.1)];
            if let [Some(member), None] | [None, Some(member)] =
                ends.map(|(body, member)| (body.inverse_mass > 0.0).then_some(member))
            {
                bodies.booked.push(Booked {
                    index: self.members[member as usize],
                    until: time + h,
                    driven: driven / h,
                    heat: heat / h,
                });
            }
        }
    }

    /// Whether the solver pushed body `index` in this sub-step.
    pub(crate) fn pushed(&self, index: u32) -> bool {
        let place = self.places.get(index as usize).copied().unwrap_or(NOT_HERE);
        place != NOT_HERE && self.bodies[place as usize].acted
    }

    /// Pairs of dynamic bodies that push each other, for the groups that sleep together.
    pub(crate) fn links(&self) -> impl Iterator<Item = (u32, u32)> + use<'_> {
        self.rows.iter().filter(|row| row.acts()).map(|row| {
            let body = |place: u32| self.members[place as usize];
            (body(row.bodies.0), body(row.bodies.1))
        })
    }
}
