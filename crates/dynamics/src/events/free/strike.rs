//! Impacts of free bodies, with each other and with bodies that rest.

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use super::{Cause, Foreseen, low};
use crate::broad::window::first_rise;
use crate::events::resolve::{apply, price, tell_collapse};
use crate::events::shock::Shock;
use crate::impact::{ImpactBody, ImpactContact, resolve};
use crate::model::narrow::NOISE;
use crate::store::clock::whole;
use crate::store::zeno::ZenoSeries;
use crate::{BodyIx, EventKind, Ix, Mode, PairIx, PairMaterial, Two, World};

/// What the impacts of one free body may spend in a tick before the solver takes the rest, in losses of
/// relative speed.
const BUDGET: f64 = 256.0;

/// The same in [`Mode::Exact`]. A series that comes ever faster is down to rounding after 36, and a jam without end
/// has used it up within a second.
const EXACT_BUDGET: f64 = 4096.0;

/// Least that an impact with a loss spends in [`Mode::Exact`].
const EXACT_PRICE: f64 = 1.0 / 64.0;

/// Speeds of the ends of a flat landing that differ by less, as a fraction, are one: roundings of a spin.
const ALIKE: f64 = 1e-12;

/// Overlap that is looked at again, as a fraction of the smaller reach: what an impact leaves.
const SLACK: f64 = 1e-12;

/// Part of the first impact's speed at which bounces on what presses go to their limit: what presses lasts from there on, and gives
/// the impulse of all bounces that are left out, `m u (1 + e)/(1 − e)` in the sum with the last one, in as much time. So only their
/// instants are off, by this part of the series, and what friction does then by its square. With 1e-13 bodies that fall into 200 cups
/// take 1.18 times as many impacts, and 1.21 of the instructions.
const FADED: f64 = 1e-10;

/// The same where nothing presses: what the last bounces would do is left out.
const GONE: f64 = 1e-13;

impl World {
    /// Resolves an impact that was foreseen for the motions as they are.
    pub(super) fn strike_free_body(&mut self, impact: &Foreseen, time: SimTime) {
        let (a, b) = impact.bodies;
        let is_held = |index: BodyIx| {
            let state = self.bodies.get(index);
            state.is_asleep() || state.is_stepped()
        };
        if is_held(a) || is_held(b) {
            return self.strike_held(impact, time);
        }
        let material = self.material_of(impact);
        let before = self.ends_of(impact, time);
        let speed = approach_speed(impact, &before);
        let smooth = material.restitution >= 1.0 && material.friction == 0.0;
        let keeps = smooth && !self.bodies.bends(a) && !self.bodies.bends(b);
        let rounding = NOISE * self.scale(impact, &before);
        let press = if keeps && speed > rounding {
            0.0
        } else {
            low::press(&self.bodies, impact, time)
        };
        // What is pressed together gains as much as the rounding of instants hides of each bounce: it would bounce for ever.
        let slow = rounding + NOISE * SimTime::UNIT * press.max(0.0);
        if speed <= slow {
            return self.touches(impact, time, (speed, slow), -press);
        }
        let e = material.restitution;
        let lost = 1.0 - e;
        if self.outruns(impact, time, &material) {
            return;
        }
        // Bounces of one point on what presses it: 2 u⁺/a, and e times that, and so on.
        let left = if press > 0.0 && e < 1.0 {
            2.0 * e * speed / (press * (1.0 - e))
        } else {
            0.0
        };
        let series = self.count_in_series(impact, time, speed, left);
        let ends = !smooth && series.has_faded(speed, if press > 0.0 { FADED } else { GONE });
        let e = if ends { 0.0 } else { e };
        let material = PairMaterial {
            restitution: e,
            ..material
        };
        self.strike_at(impact, time, &before, material);
        // What it leaves squeezed has landed.
        let is_stepped = |index: &BodyIx| self.bodies.get(*index).is_stepped();
        if [a, b].iter().any(is_stepped) {
            return;
        }
        if !keeps && press > 0.0 && e == 0.0 {
            if ends {
                let ids = [a, b].map(|index| self.bodies.get(index).id);
                self.free.announce(series.limit(left), ids);
            }
            self.begins_to_last(impact, time);
        } else {
            if keeps || press > 0.0 {
                self.free.micro_bounce = low::micro_bounce(&self.bodies, impact, time);
            }
            self.deflect_both(impact, time);
            self.free.micro_bounce = None;
        }
        let moving = [a, b].into_iter();
        let moving = moving.filter(|index| self.bodies.get(*index).is_dynamic());
        let moving: ArrayVec<BodyIx, 2> = moving.collect();
        self.rush(&moving, lost, time);
    }

    /// How the two surfaces meet.
    pub(super) fn material_of(&self, impact: &Foreseen) -> PairMaterial {
        self.broad.material(&self.bodies, impact.colliders)
    }

    /// Whether the approach of an impact is more than rounding.
    pub(super) fn approaches(&self, impact: &Foreseen, time: SimTime) -> bool {
        let before = self.ends_of(impact, time);
        approach_speed(impact, &before) > NOISE * self.scale(impact, &before)
    }

    /// Scale of the rounding of an approach, in m/s: the speed of the bodies, or that with which their
    /// Zeno series began.
    pub(super) fn scale(&self, impact: &Foreseen, before: &[ImpactBody; 2]) -> f64 {
        let of = |index: BodyIx, body: &ImpactBody| {
            let state = self.bodies.get(index);
            pace(body, state.reach).max(state.course.series.top())
        };
        of(impact.bodies.0, &before[0]) + of(impact.bodies.1, &before[1])
    }

    /// Counts an impact in the Zeno series of its bodies.
    pub(super) fn count_in_series(
        &mut self,
        impact: &Foreseen,
        time: SimTime,
        speed: f64,
        left: f64,
    ) -> ZenoSeries {
        let mut found = ZenoSeries::default();
        for index in [impact.bodies.0, impact.bodies.1] {
            let state = self.bodies.get_mut(index);
            if state.inverse_mass > 0.0 {
                state.course.series.hit(time, speed, left);
                if state.course.series.is_one() {
                    found = state.course.series;
                }
            }
        }
        found
    }

    /// The impact itself, by the law at one point or at all that approach.
    fn strike_at(
        &mut self,
        impact: &Foreseen,
        time: SimTime,
        before: &[ImpactBody; 2],
        material: PairMaterial,
    ) {
        let struck = contacts_of(impact, before, material);
        if let [contact] = struck.as_slice()
            && material.tangent_speed == 0.0
        {
            return self.strike_once(impact, contact, before, time);
        }
        if let [first, last] = struck.as_slice()
            && material.friction == 0.0
            && let Some(point) = common_point(impact, (first, last), before)
        {
            return self.strike_once(impact, &ImpactContact { point, ..*first }, before, time);
        }
        let mut shock = Shock::new(time);
        for contact in struck {
            let at = (contact.point, contact.normal);
            shock.add(&self.bodies, PairIx::NONE, impact.bodies, at, material, 0.0);
        }
        self.strike_together(shock, time);
    }

    /// Resolves a shock of several contacts; returns the bodies with a new motion. Free bodies that it leaves squeezed land: no
    /// impulses stop them.
    pub(super) fn strike_together(&mut self, mut shock: Shock, time: SimTime) -> Vec<BodyIx> {
        shock.solve(&self.settings, &self.bodies, &mut self.pairs);
        self.work.impact(shock.operations);
        let (events, report) = (&mut self.events, &mut self.report);
        let changed = apply(&mut self.bodies, time, &shock, events, report);
        for (a, b) in shock.squeezed().map(|strike| shock.ends(strike)) {
            self.report.collapsed += 1;
            self.report_collapse((a, b), 0.0, time);
            self.land_both((a, b), time);
        }
        changed
    }

    /// They touch, and approach by rounding alone: what is pressed together lasts; what opens with
    /// an acceleration of `pull` m/s² has come to the end of ever faster impacts, or grazes.
    fn touches(&mut self, impact: &Foreseen, time: SimTime, (speed, slow): (f64, f64), pull: f64) {
        if pull < 0.0 {
            return self.begins_to_last(impact, time);
        }
        let (a, b) = impact.bodies;
        let mut ends = false;
        for index in [a, b] {
            ends |= self.bodies.get_mut(index).course.series.end();
        }
        if ends {
            self.report_collapse(impact.bodies, 0.5 * speed * speed, time);
        }
        // Another look when the approach may have gone deeper than impacts leave, or when the touch is open.
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        let slack = SLACK * one.reach.min(two.reach);
        let left = one.course.end_of_search().max(two.course.end_of_search());
        let left = (left - time).max(1e-9);
        let deeper = if speed > 0.0 { slack / speed } else { left };
        let wait = deeper.min(first_rise(slack, -speed, pull));
        let wait = wait.clamp(1e-9 * left, left);
        self.look_again(impact.bodies, impact.colliders, time + wait);
        self.seek_beside(impact, time, wait, 4.0 * slow);
    }

    /// Says that infinitely many impacts of two bodies have ended, with their energy per kg of reduced
    /// mass, in J/kg.
    pub(super) fn report_collapse(&mut self, ends: Two<BodyIx>, energy: f64, time: SimTime) {
        tell_collapse(&self.bodies, ends, energy, time, &mut self.events);
    }

    /// The impact law at one point.
    fn strike_once(
        &mut self,
        impact: &Foreseen,
        contact: &ImpactContact,
        before: &[ImpactBody; 2],
        time: SimTime,
    ) {
        let (a, b) = impact.bodies;
        let outcome = resolve(self.settings.impact_law, &before[0], &before[1], contact);
        let speed = -opening(before, contact.point, contact.normal);
        self.report.impacts += 1;
        let ids = [a, b].map(|index| self.bodies.get(index).id);
        let at = (contact.point, contact.normal);
        let impulses = (outcome.normal_impulse, outcome.tangential_impulse);
        let told = EventKind::impact(ids, at, impulses, speed);
        self.events.push(time, told);
        self.bodies.book.impacts.add(outcome.loss);
        let after = [outcome.a, outcome.b];
        let impulse = contact.normal * outcome.normal_impulse
            + carom_math::perp(contact.normal) * outcome.tangential_impulse;
        for (body, impulse) in before.iter().zip([impulse, -impulse]) {
            // What a driven body put in: it keeps its velocity whatever the impulse on it.
            if body.inverse_mass == 0.0 {
                let work = impulse.dot(body.velocity_of(contact.point));
                self.bodies.book.external.add(work);
            }
        }
        for (index, body) in [a, b].into_iter().zip(after) {
            self.bodies.end_impact(index, time, &body);
        }
    }

    /// New horizons for two bodies that struck each other.
    fn deflect_both(&mut self, impact: &Foreseen, time: SimTime) {
        let (a, b) = impact.bodies;
        self.free.struck = Some((impact.colliders, impact.feature));
        let moved = [a, b].map(|index| self.bodies.get(index).inverse_mass > 0.0);
        if moved[0] {
            let partner = moved[1].then_some(b);
            self.foresee(a, time, Cause::Deflected, partner);
        }
        if moved[1] {
            self.foresee(b, time, Cause::Deflected, None);
        }
        self.free.struck = None;
    }

    /// Counts an impact; whether one of the bodies has used up those of the present tick. One without a loss, on what is not driven,
    /// spends nothing: no stop is the limit of these.
    pub(super) fn outruns(
        &mut self,
        impact: &Foreseen,
        time: SimTime,
        material: &PairMaterial,
    ) -> bool {
        // Between what is driven and a wall impacts come ever faster though nothing is lost, and without end.
        let keeps = material.restitution >= 1.0
            && material.friction == 0.0
            && !self.ends_of(impact, time).iter().any(ImpactBody::drives);
        if keeps {
            return false;
        }
        let (price, budget) = match self.settings.mode {
            Mode::Exact => (price(material).max(EXACT_PRICE), EXACT_BUDGET),
            _ => (price(material), BUDGET),
        };
        let tick = whole(time, self.settings.tick);
        let mut spent = false;
        for index in [impact.bodies.0, impact.bodies.1] {
            // A floor is not charged for all that lands on it.
            if self.bodies.get(index).inverse_mass == 0.0 {
                continue;
            }
            let course = &mut self.bodies.get_mut(index).course;
            if course.tick != tick {
                (course.tick, course.spent) = (tick, 0.0);
            }
            course.spent += price;
            spent |= course.spent > budget;
        }
        if spent {
            self.collapse(impact, time);
        }
        spent
    }
}

/// Speed of a body's fastest point, in m/s.
pub(super) fn pace(body: &ImpactBody, reach: f64) -> f64 {
    let spin = body.spin.abs();
    let rim = if spin > 0.0 { spin * reach } else { 0.0 };
    body.velocity.length() + rim
}

/// Normal velocity of a point of contact: positive opens.
pub(super) fn opening(bodies: &[ImpactBody; 2], point: Vec2, normal: Vec2) -> f64 {
    (bodies[1].velocity_of(point) - bodies[0].velocity_of(point)).dot(normal)
}

/// Contacts of the points of an impact that approach.
pub(super) fn contacts_of(
    impact: &Foreseen,
    bodies: &[ImpactBody; 2],
    material: PairMaterial,
) -> ArrayVec<ImpactContact, 2> {
    let points = impact.points.iter();
    let struck = points.filter(|point| opening(bodies, **point, impact.normal) < 0.0);
    let contacts = struck.map(|point| material.contact(*point, impact.normal));
    contacts.collect()
}

/// Fastest approach of the points of an impact, in m/s.
pub(super) fn approach_speed(impact: &Foreseen, bodies: &[ImpactBody; 2]) -> f64 {
    let speed = |point: &Vec2| -opening(bodies, *point, impact.normal);
    impact
        .points
        .iter()
        .map(speed)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Where one impulse acts as those of a flat landing do that turns neither body against the other.
///
/// Both ends approach alike, and after an impulse at x on their line they still do: the spins it adds,
/// `(x − a)/I_A` and `(x − b)/I_B` with a and b the centres of mass along the line, cancel there.
fn common_point(
    impact: &Foreseen,
    (first, last): (&ImpactContact, &ImpactContact),
    bodies: &[ImpactBody; 2],
) -> Option<Vec2> {
    let (u, v) = (
        opening(bodies, first.point, impact.normal),
        opening(bodies, last.point, impact.normal),
    );
    if (u - v).abs() > ALIKE * u.abs() {
        return None;
    }
    let stretch = last.point - first.point;
    let along = |body: &ImpactBody| {
        let from = body.centre - first.point;
        from.dot(stretch) / stretch.length_squared() * body.inverse_inertia
    };
    let stiffness = bodies[0].inverse_inertia + bodies[1].inverse_inertia;
    let x = if stiffness > 0.0 {
        (along(&bodies[0]) + along(&bodies[1])) / stiffness
    } else {
        0.5
    };
    (0.0..=1.0).contains(&x).then(|| first.point + stretch * x)
}
