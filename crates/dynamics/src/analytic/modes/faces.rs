//! Contact rows in velocities scaled by √m, where mass drops out of every formula.
//!
//! ```text
//! a_n = n·(a_B − a_A) + (r_B × n) α_B − (r_A × n) α_A        t alike;    x = (√m a, √m a, √I α) for each body
//! ```

use arrayvec::ArrayVec;
use carom_math::{Vec2, cross, perp, vec2};

use super::balance::Balance;
use super::{BodyMove, CLOSED, NotMine, STILL, Touch};
use crate::impact::ImpactBody;
use crate::impact::dense::dot;
use crate::impact::project::Basis;
use crate::model::approach::relative;

/// A row counts as dependent on others if less than this part of its length is its own.
const DEPENDENT: f64 = 1e-10;

/// A row of unit length, and the length that it had, in 1/√kg.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Of its two bodies, in the order of the list.
    pub(super) places: [usize; 2],
    /// Their numbers; all others are 0.
    pub(super) unit: [f64; 6],
    pub(super) length: f64,
    /// What velocities alone add to its rate: 0 where the row does not turn.
    pub(super) bend: f64,
}

/// The rows of one touch.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub(super) normals: ArrayVec<Row, 2>,
    pub(super) tangent: Row,
    pub(super) friction: f64,
}

/// All rows of a group, and what it would do without them.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    pub(super) list: Vec<Face>,
    /// Scaled accelerations without contacts.
    pub(super) free: Vec<f64>,
}

impl Faces {
    pub(super) fn new(bodies: &[ImpactBody], pulls: &[(Vec2, f64)], touches: &[Touch]) -> Self {
        let list = touches.iter().map(|touch| Face {
            normals: touch
                .points
                .iter()
                .map(|&point| Row::new(bodies, touch.bodies, point, touch.normal))
                .collect(),
            tangent: Row::new(bodies, touch.bodies, touch.points[0], perp(touch.normal)),
            friction: touch.friction,
        });
        Self {
            list: list.collect(),
            free: scaled(bodies, pulls.iter().copied()),
        }
    }

    /// Motions from scaled accelerations; what the closed rows stop is exactly still.
    pub(super) fn moves(
        &self,
        bodies: &[ImpactBody],
        found: &Balance,
        slips: &[f64],
    ) -> Vec<BodyMove> {
        let stops = self.stops(found, |i| found.reactions[i].sticks);
        // They differ only where a slip begins.
        let mut rubbing = self.list.iter().zip(slips).zip(&found.reactions);
        let begins = rubbing.any(|((face, slip), reaction)| {
            face.friction > 0.0 && *slip == 0.0 && !reaction.sticks
        });
        let begins = begins.then(|| self.stops(found, |i| slips[i] == 0.0));
        // What closed rows and held friction do is what they stop, so only slipping friction is summed.
        let mut accelerations = self.free.clone();
        for (face, reaction) in self.list.iter().zip(&found.reactions) {
            if !reaction.sticks && reaction.tangential != 0.0 {
                let pull = reaction.tangential * face.tangent.length;
                face.tangent.add_to(&mut accelerations, pull);
            }
        }
        stops.apply(&mut accelerations);
        let velocities = if bodies.iter().any(ImpactBody::drives) {
            None
        } else {
            let mut velocities = scaled(bodies, velocities_of(bodies));
            begins.as_ref().unwrap_or(&stops).apply(&mut velocities);
            Some(velocities)
        };
        let one = |(k, body): (usize, &ImpactBody)| {
            let (acceleration, angular_acceleration) = unscaled(&accelerations, k, body);
            let (velocity, spin) = match &velocities {
                Some(all) if body.inverse_mass > 0.0 => {
                    let (velocity, spin) = unscaled(all, k, body);
                    // What nothing stops keeps its bits.
                    (
                        kept(body.velocity, velocity),
                        if body.inverse_inertia > 0.0 {
                            kept_one(body.spin, spin)
                        } else {
                            body.spin
                        },
                    )
                }
                _ => (body.velocity, body.spin),
            };
            BodyMove {
                velocity,
                spin,
                acceleration,
                angular_acceleration,
            }
        };
        bodies.iter().enumerate().map(one).collect()
    }

    /// What closed points stop, and friction of the faces that it holds.
    fn stops(&self, found: &Balance, holds: impl Fn(usize) -> bool) -> Stops {
        let all = || self.list.iter().zip(&found.reactions);
        let normals = all().flat_map(|(face, reaction)| {
            let both = face.normals.iter().zip(reaction.closed);
            both.filter_map(|(row, closed)| closed.then_some(*row))
        });
        let tangents = all().enumerate().filter_map(|(i, (face, reaction))| {
            let rubs = face.friction > 0.0 && reaction.closed.contains(&true);
            (rubs && holds(i)).then_some(face.tangent)
        });
        Stops::of(normals.chain(tangents), self.free.len())
    }
}

/// The given numbers where scaling there and back changed nothing but the last bits.
fn kept(given: Vec2, found: Vec2) -> Vec2 {
    vec2(kept_one(given.x, found.x), kept_one(given.y, found.y))
}

fn kept_one(given: f64, found: f64) -> f64 {
    if (given - found).abs() <= 4.0 * f64::EPSILON * given.abs() {
        given
    } else {
        found
    }
}

impl Row {
    fn new(bodies: &[ImpactBody], ends: (usize, usize), point: Vec2, along: Vec2) -> Self {
        let mut ends = [(ends.0, -1.0), (ends.1, 1.0)];
        ends.sort_unstable_by_key(|(place, _)| *place);
        let mut unit = [0.0; 6];
        for (to, (place, sign)) in unit.chunks_exact_mut(3).zip(ends) {
            let body = &bodies[place];
            let (m, i) = (body.inverse_mass.sqrt(), body.inverse_inertia.sqrt());
            to[0] = sign * along.x * m;
            to[1] = sign * along.y * m;
            to[2] = sign * cross(point - body.centre, along) * i;
        }
        let length = dot(&unit, &unit).sqrt();
        if length > 0.0 {
            unit = unit.map(|x| x / length);
        }
        Self {
            places: ends.map(|(place, _)| place),
            unit,
            length,
            bend: 0.0,
        }
    }

    /// Its numbers, and where they stand in a state.
    fn numbers(&self) -> impl Iterator<Item = (usize, f64)> {
        (0..6).map(|k| (3 * self.places[k / 3] + k % 3, self.unit[k]))
    }

    pub(super) fn rate(&self, state: &[f64]) -> f64 {
        self.numbers().map(|(k, x)| x * state[k]).sum()
    }

    pub(super) fn add_to(&self, state: &mut [f64], factor: f64) {
        for (k, x) in self.numbers() {
            state[k] += factor * x;
        }
    }

    /// [`Self::rate`] of accelerations, with what velocities add.
    pub(super) fn growth(&self, state: &[f64]) -> f64 {
        self.rate(state) + self.bend
    }
}

/// Scaled numbers of all bodies; those of infinite mass have none.
fn scaled(bodies: &[ImpactBody], numbers: impl Iterator<Item = (Vec2, f64)>) -> Vec<f64> {
    let mut state = Vec::with_capacity(3 * bodies.len());
    for (body, (linear, angular)) in bodies.iter().zip(numbers) {
        let over = |x: f64, inverse: f64| {
            if inverse > 0.0 {
                x / inverse.sqrt()
            } else {
                0.0
            }
        };
        state.push(over(linear.x, body.inverse_mass));
        state.push(over(linear.y, body.inverse_mass));
        state.push(over(angular, body.inverse_inertia));
    }
    state
}

pub(super) fn velocities_of(bodies: &[ImpactBody]) -> impl Iterator<Item = (Vec2, f64)> {
    bodies.iter().map(|body| (body.velocity, body.spin))
}

/// Numbers of the k-th body, from scaled ones of all.
fn unscaled(state: &[f64], k: usize, body: &ImpactBody) -> (Vec2, f64) {
    let (m, i) = (body.inverse_mass.sqrt(), body.inverse_inertia.sqrt());
    let linear = vec2(state[3 * k] * m, state[3 * k + 1] * m);
    (linear, state[3 * k + 2] * i)
}

/// Velocities and spins with which no point of any touch opens or closes, nor slips where it `sticks`: the nearest, by energy.
pub(super) fn held(
    bodies: &[ImpactBody],
    touches: &[&Touch],
    sticks: impl Fn(&Touch) -> bool,
) -> Vec<(Vec2, f64)> {
    let rows = touches.iter().flat_map(|touch| {
        let row = |point: &Vec2, along| Row::new(bodies, touch.bodies, *point, along);
        let normals = touch
            .points
            .iter()
            .map(move |point| row(point, touch.normal));
        let held = touch.points.iter().take(usize::from(sticks(touch)));
        normals.chain(held.map(move |point| row(point, perp(touch.normal))))
    });
    let mut state = scaled(bodies, velocities_of(bodies));
    Stops::of(rows, state.len()).apply(&mut state);
    let all = bodies.iter().enumerate();
    all.map(|(k, body)| unscaled(&state, k, body)).collect()
}

/// Rows that are held at 0.
struct Stops {
    basis: Basis,
    /// Of each coordinate: whether the rows say all of it; `None` where they have no part in it.
    determined: Vec<Option<bool>>,
}

impl Stops {
    fn of(rows: impl Iterator<Item = Row>, size: usize) -> Self {
        let whole = rows.map(|row| {
            let mut whole = vec![0.0; size];
            row.add_to(&mut whole, 1.0);
            whole
        });
        let basis = Basis::independent(whole, DEPENDENT);
        let determined = (0..size).map(|k| basis.touches(k).then(|| basis.determines(k)));
        Self {
            determined: determined.collect(),
            basis,
        }
    }

    /// Takes out what the rows stop; a coordinate that nothing is left of is exactly 0, and so is one with less than
    /// the rounding of a rounding.
    fn apply(&self, state: &mut [f64]) {
        let size = state.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let none = f64::EPSILON * f64::EPSILON * size;
        self.basis.reduce(state);
        for (rest, determined) in state.iter_mut().zip(&self.determined) {
            if determined.is_some_and(|determined| determined || rest.abs() <= none) {
                *rest = 0.0;
            }
        }
    }
}

/// Slip of each touch, exactly 0 where it is no more than rounding.
///
/// # Errors
/// If a touch opens or closes.
pub(super) fn slips(
    bodies: &[ImpactBody],
    touches: &[Touch],
    speed: f64,
) -> Result<Vec<f64>, NotMine> {
    let mut slips = Vec::with_capacity(touches.len());
    for touch in touches {
        let mut least = f64::INFINITY;
        let mut slip = 0.0;
        for &point in &touch.points {
            let (velocity, scale) = between(bodies, touch, point, speed);
            if velocity.dot(touch.normal).abs() > CLOSED * scale {
                return Err(NotMine::Approaches);
            }
            let along = velocity.dot(perp(touch.normal));
            if along.abs() < least {
                least = along.abs();
                slip = still(along, scale);
            }
        }
        slips.push(slip);
    }
    Ok(slips)
}

/// Slip of a touch at a point, exactly 0 where it is no more than rounding.
pub(super) fn slip(bodies: &[ImpactBody], touch: &Touch, point: Vec2, speed: f64) -> f64 {
    let (velocity, scale) = between(bodies, touch, point, speed);
    still(velocity.dot(perp(touch.normal)), scale)
}

fn still(along: f64, scale: f64) -> f64 {
    if along.abs() <= STILL * scale {
        0.0
    } else {
        along
    }
}

/// Velocity of B against A at a point, and what its roundings are measured by, in m/s.
fn between(bodies: &[ImpactBody], touch: &Touch, point: Vec2, speed: f64) -> (Vec2, f64) {
    let (a, b) = touch.bodies;
    let (velocity, scale) = relative((bodies[a], bodies[b]), point);
    (velocity, scale + speed)
}
