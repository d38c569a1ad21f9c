//! One body that turns about a corner that holds: its path, and what ends it, in closed form.
//!
//! With δ the angle turned by since the start, r = ρ (cos φ, sin φ) the arm seen from the pull g, and φ = φ₀ + δ:
//!
//! ```text
//! φ′² = c + 2 k cos φ        F = m (a − g)
//! F_r = −m (ρ c + (2 k ρ + |g|) cos φ)        F_t = m (|g| − k ρ) sin φ        along r, and along r turned by +90°
//! ```
//!
//! So the forces of a contact, and the gaps of all corners, are trigonometric polynomials of δ: their first zeros are found without
//! asking when.

use std::sync::Arc;

use carom_math::{Rot, SimTime, Vec2, cross, perp, trig};

use super::equations::Equations;
use super::joint::{End, Joint};
use super::roots::{self, Limit, NOTHING};
use super::wave::{Course, Wave};
use super::{Contact, Tangent};
use crate::law::path::{Path, Place, Swing};
use crate::law::pendulum::Pendulum;

/// One body on one corner, at an instant.
struct Pivot<'a> {
    equations: &'a Equations,
    places: &'a [Place],
    /// The body that turns.
    body: usize,
    /// The point that is closed.
    contact: usize,
    point: usize,
    joint: &'a Joint,
    /// Where it is, in m, and the unit normal from A to B.
    at: Vec2,
    normal: Vec2,
}

/// What must stay above 0.
struct Margin {
    wave: Wave,
    /// What counts as 0.
    nothing: f64,
    limit: Limit,
    /// Of the gap of a corner: the edge under it turns, not the corner.
    edge_turns: bool,
}

/// Path and end of a body that turns about one corner that holds; `None` where more than one moves, slides, or is held.
///
/// `size`: a length in m that roundings are measured by.
pub(super) fn swing(
    equations: &Equations,
    places: &[Place],
    reaches: &[f64],
    start: SimTime,
    size: f64,
) -> Option<(Arc<dyn Path>, roots::End)> {
    let pivot = Pivot::of(equations, places, reaches)?;
    let pendulum = pivot.pendulum()?;
    let margins = pivot.margins(&pendulum, size)?;
    let (end, bounds) = pivot.first(&margins, &pendulum);
    let length = match end {
        roots::End::After(after, _) => after,
        _ => pendulum.period(),
    };
    let swing = Swing {
        start,
        length,
        places: places.to_vec(),
        body: pivot.body,
        pivot: pivot.at,
        pendulum,
        bounds,
    };
    Some((Arc::new(swing), end))
}

impl<'a> Pivot<'a> {
    fn of(equations: &'a Equations, places: &'a [Place], reaches: &[f64]) -> Option<Self> {
        let mut movers = (0..places.len()).filter(|&k| reaches[k] > 0.0);
        let body = movers.next()?;
        let stays = |k: usize| places[k].velocity == Vec2::ZERO && places[k].spin == 0.0;
        if movers.next().is_some()
            || equations.bodies[body].inverse_inertia == 0.0
            || equations.pulls[body].1 != 0.0
            || !(0..places.len()).all(|k| k == body || stays(k))
        {
            return None;
        }
        let all = equations.contacts.iter().zip(&equations.holds).enumerate();
        let mut closed = all.flat_map(|(contact, (of, hold))| {
            let points = (0..of.joints.len()).filter(|&point| hold.closed[point]);
            points.map(move |point| (contact, point, hold.rub))
        });
        let (contact, point, rub) = closed.next()?;
        let joint = &equations.contacts[contact].joints[point];
        let is_corner = matches!(joint, Joint::Line { radius: 0.0, .. });
        if closed.next().is_some() || rub != Tangent::Holds || !is_corner {
            return None;
        }
        let (a, b) = equations.contacts[contact].bodies;
        let seen = joint.seen(&places[a], &places[b]);
        Some(Self {
            equations,
            places,
            body,
            contact,
            point,
            joint,
            at: seen.point,
            normal: seen.normal,
        })
    }

    /// From the pivot to the centre of mass.
    fn arm(&self) -> Vec2 {
        self.places[self.body].centre - self.at
    }

    fn pendulum(&self) -> Option<Pendulum> {
        let (arm, of) = (self.arm(), &self.equations.bodies[self.body]);
        let square = arm.length_squared() + of.inverse_mass / of.inverse_inertia;
        let (pull, _) = self.equations.pulls[self.body];
        let angle = trig::atan2(cross(pull, arm), pull.dot(arm));
        let k = pull.length() * arm.length() / square;
        Pendulum::new(k, angle, self.places[self.body].spin)
    }

    /// Whether the edge of a joint is the body's own.
    fn has_edge(&self, contact: &Contact, owner: End) -> bool {
        let (a, b) = contact.bodies;
        self.body == owner.first(a, b).0
    }

    /// All that must stay above 0; `None` where a gap is no polynomial.
    fn margins(&self, pendulum: &Pendulum, size: f64) -> Option<Vec<Margin>> {
        let Joint::Line { owner, beside, .. } = self.joint else {
            return None;
        };
        let contact = self.contact;
        let of = &self.equations.contacts[contact];
        let away = if of.bodies.1 == self.body {
            self.normal
        } else {
            -self.normal
        };
        let turns = self.has_edge(of, *owner);
        let [normal, tangential] =
            [away, perp(away)].map(|along| self.force_along(along, turns, pendulum));
        let of_force = |wave: Wave, limit: Limit| Margin {
            wave,
            nothing: NOTHING * normal.size(),
            limit,
            edge_turns: false,
        };
        let point = self.point;
        let mut list = Vec::with_capacity(8);
        list.push(of_force(normal, Limit::Press { contact, point }));
        for sign in [-1.0, 1.0] {
            let grip = normal * of.friction + tangential * sign;
            list.push(of_force(grip, Limit::Grip { contact, sign }));
        }
        for corner in beside {
            list.push(self.gap(contact, self.joint, *corner, size)?);
        }
        for (contact, hold) in self.equations.holds.iter().enumerate() {
            let joints = &self.equations.contacts[contact].joints;
            for (point, joint) in joints.iter().enumerate() {
                if !hold.closed[point] && !hold.over[point] {
                    let Joint::Line { tip, .. } = joint else {
                        return None;
                    };
                    list.push(self.gap(contact, joint, *tip, size)?);
                }
            }
        }
        Some(list)
    }

    /// Force on the body along a direction that stays, or that turns with it, in N.
    fn force_along(&self, along: Vec2, turns: bool, pendulum: &Pendulum) -> Wave {
        let (arm, of) = (self.arm(), &self.equations.bodies[self.body]);
        let (length, g) = (arm.length(), self.equations.pulls[self.body].0.length());
        let (angle, k) = pendulum.start();
        let (sin, cos) = trig::sin_cos(angle);
        let mass = of.inverse_mass.recip();
        // cos φ and sin φ for φ = φ₀ + δ.
        let (cosine, sine) = (Wave::new(0.0, cos, -sin), Wave::new(0.0, sin, cos));
        let still = Wave::new(-length * pendulum.constant(), 0.0, 0.0);
        let radial = (still + cosine * -(2.0 * k * length + g)) * mass;
        let across = sine * (mass * (g - k * length));
        let r = arm / length;
        let (x, y) = (along.dot(r), along.dot(perp(r)));
        if turns {
            radial * x + across * y
        } else {
            radial.product(Wave::new(0.0, x, y)) + across.product(Wave::new(0.0, y, -x))
        }
    }

    /// Gap between the edge of a joint and a corner of its other body.
    fn gap(&self, contact: usize, joint: &Joint, corner: Vec2, size: f64) -> Option<Margin> {
        let Joint::Line {
            owner,
            normal,
            height,
            radius: 0.0,
            ..
        } = joint
        else {
            return None;
        };
        let of = &self.equations.contacts[contact];
        let (a, b) = (&self.places[of.bodies.0], &self.places[of.bodies.1]);
        let (own, other) = owner.first(a, b);
        let (n, at) = (own.rotation * *normal, other.point(corner));
        let way = at - self.at;
        let edge_turns = self.has_edge(of, *owner);
        let cos = n.dot(way);
        let sin = if edge_turns {
            perp(n).dot(way)
        } else {
            n.dot(perp(way))
        };
        let now = n.dot(at - own.centre) - height;
        let normal = owner.first(n, -n).0;
        Some(Margin {
            wave: Wave::new(now - cos, cos, sin),
            nothing: NOTHING * size,
            limit: Limit::Corner {
                contact,
                normal,
                at,
            },
            edge_turns,
        })
    }

    /// The first margin to fall to 0, and bounds on the motion until then.
    fn first(&self, margins: &[Margin], pendulum: &Pendulum) -> (roots::End, [f64; 3]) {
        let legs = pendulum.legs();
        let mut began = vec![true; margins.len()];
        for (leg, &(from, to)) in legs.iter().enumerate() {
            let mut found: Option<(f64, &Margin)> = None;
            for (margin, began) in margins.iter().zip(&mut began) {
                let to = found.map_or(to, |(angle, _)| angle);
                match margin.wave.first_zero((from, to), margin.nothing, *began) {
                    Course::Stays { began: still } => *began = still,
                    Course::Falls => {
                        return (roots::End::Never(margin.limit), pendulum.bounds(0.0, 0));
                    }
                    Course::Zero(x) => {
                        let way = 1.0_f64.copysign(to - from);
                        found = Some((from + way * x, margin));
                    }
                }
            }
            if let Some((angle, margin)) = found {
                let after = pendulum.time_at(angle, leg);
                let end = roots::End::After(after, self.limit_after(margin, angle));
                return (end, pendulum.bounds(angle, leg));
            }
        }
        let far = legs[1].1;
        (roots::End::Open, pendulum.bounds(far, 1))
    }

    /// What a margin belongs to, where the body has turned by `angle`.
    fn limit_after(&self, margin: &Margin, angle: f64) -> Limit {
        let turn = Rot::from_angle(angle);
        match margin.limit {
            Limit::Corner {
                contact,
                normal,
                at,
            } => {
                let (normal, at) = if margin.edge_turns {
                    (turn * normal, at)
                } else {
                    (normal, self.at + turn * (at - self.at))
                };
                Limit::Corner {
                    contact,
                    normal,
                    at,
                }
            }
            other => other,
        }
    }
}
