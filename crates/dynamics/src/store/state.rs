//! What the world keeps of a body.

use std::sync::Arc;

use carom_collision::{Hull, Motion, hulls};
use carom_geometry::{Aabb, MassProperties, Shape};
use carom_math::{Pose, Rot, SimTime, StateHash, Vec2};

use super::course::Course;
use super::few::Few;
use super::mass::{mass_of, reach_of};
use super::membership::Membership;
use super::regime::Regime;
use super::slots::List;
use super::uncommon::{Lag, Uncommon};
use crate::impact::ImpactBody;
use crate::law::flight::Flight;
use crate::values::error::BodyError;
use crate::{BodyDef, BodyId, BodyIx, BodyKind, ColliderIx, Filter, Material, Mode, PairIx};
use carom_collision::NodeId;

/// All that a world keeps of one body. Nothing else stores a pose.
///
/// In the order in which flights and impacts read it: where it is and what moves it in two cache lines, what is asked next in
/// the lines that follow.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct BodyState {
    /// Where the centre of mass is at every instant from the motion's start on.
    pub(crate) motion: Motion,
    /// Fingerprint of how it began: decides which is A and which B in a pair of free bodies.
    pub(crate) rank: u64,
    pub(crate) inverse_mass: f64,
    pub(crate) inverse_inertia: f64,
    pub(crate) id: BodyId,
    pub(crate) kind: BodyKind,
    pub(crate) locked_rotation: bool,
    /// A contact island gave it its motion.
    pub(crate) member: bool,
    /// What moves it: [`Self::pass_to`] alone changes it.
    regime: Regime,
    /// Known to the engine in hybrid mode, and moved by something else.
    pub(crate) is_guest: bool,
    /// The law of a flight in a field or with damping, since anything else changed the motion.
    pub(crate) flight: Option<Arc<Flight>>,
    /// Largest distance of a point of its shapes from the centre of mass, in m.
    pub(crate) reach: f64,
    pub(crate) colliders: Few<ColliderIx>,
    /// Angle at the motion's start with all whole turns, to about 1e-10 rad: it counts turns.
    pub(crate) turned: f64,
    /// What few bodies have; none is [`Uncommon::NONE`].
    uncommon: Option<Box<Uncommon>>,
    pub(crate) mass: MassProperties,
    pub(crate) course: Course,
    pub(crate) tag: u64,
    /// The contact group in closed form that it belongs to.
    pub(crate) membership: Membership,
    /// Pairs of its colliders with others.
    pub(crate) pairs: Vec<PairIx>,
}

/// A shape of a body; what impacts ask comes first.
#[derive(Clone, Debug)]
#[repr(C)]
pub(crate) struct Collider {
    /// About the body's centre of mass: what collides.
    pub(crate) solid: Arc<Shape>,
    pub(crate) surface: Arc<Surface>,
    pub(crate) body: BodyIx,
    /// Node in the tree of boxes.
    pub(crate) node: Option<NodeId>,
    /// Box that the pairs were searched with.
    pub(crate) fat: Aabb,
    /// As the caller drew it.
    pub(crate) drawn: Arc<Shape>,
}

/// Material and filter of a shape. One for all that are alike, as far as a cheap comparison shows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Surface {
    pub(crate) material: Material,
    pub(crate) filter: Filter,
}

impl Collider {
    pub(crate) fn set_material(&mut self, material: Material) {
        Arc::make_mut(&mut self.surface).material = material;
    }

    pub(crate) fn set_filter(&mut self, filter: Filter) {
        Arc::make_mut(&mut self.surface).filter = filter;
    }
}

/// The same for equal definitions, whatever else is in the world.
fn rank_of(def: &BodyDef) -> u64 {
    let mut hash = StateHash::default();
    hash.write_vec2(def.position);
    hash.write(def.angle);
    hash.write_vec2(def.velocity);
    hash.write(def.spin);
    hash.finish()
}

impl BodyState {
    pub(crate) fn new(
        id: BodyId,
        def: &BodyDef,
        shapes: &[(Shape, Material)],
        now: SimTime,
        mode: Mode,
    ) -> Result<Self, BodyError> {
        let mass = mass_of(def, shapes)?;
        let frame = Pose::new(def.position, Rot::from_angle(def.angle));
        let (damping, gravity_scale) =
            ((def.linear_damping, def.angular_damping), def.gravity_scale);
        let is_uncommon = damping != (0.0, 0.0)
            || gravity_scale.to_bits() != 1_f64.to_bits()
            || !def.sleep_allowed;
        let mut state = Self {
            id,
            rank: rank_of(def),
            kind: def.kind,
            motion: Motion {
                start: now,
                velocity: def.velocity,
                rotation: frame.rotation,
                spin: if def.locked_rotation { 0.0 } else { def.spin },
                ..Motion::resting(frame.point(mass.centroid))
            },
            turned: def.angle,
            mass,
            inverse_mass: 0.0,
            inverse_inertia: 0.0,
            locked_rotation: def.locked_rotation,
            tag: def.tag,
            uncommon: is_uncommon.then(|| {
                Box::new(Uncommon {
                    damping,
                    gravity_scale,
                    sleep_allowed: def.sleep_allowed,
                    ..Uncommon::NONE
                })
            }),
            flight: None,
            member: false,
            regime: Regime::at_birth(def.kind, mode),
            is_guest: false,
            membership: Membership::default(),
            course: Course::default(),
            reach: reach_of(shapes, mass.centroid),
            colliders: Few::default(),
            pairs: Vec::new(),
        };
        state.set_kind(def.kind);
        Ok(state)
    }

    pub(crate) const fn regime(&self) -> Regime {
        self.regime
    }

    /// Another method moves it from now on.
    pub(crate) fn pass_to(&mut self, next: Regime) {
        self.regime.pass_to(next);
    }

    /// Which of the body's shapes a collider is, in the order of insertion.
    pub(crate) fn shape_of(&self, collider: ColliderIx) -> usize {
        self.colliders
            .iter()
            .take_while(|at| **at != collider)
            .count()
    }

    /// Force of the present step, in N.
    pub(crate) fn force(&self) -> Vec2 {
        self.uncommon().force
    }

    /// Torque of the present step, in N·m.
    pub(crate) fn torque(&self) -> f64 {
        self.uncommon().torque
    }

    /// How gravity and fields act on it, as a factor.
    pub(crate) fn gravity_scale(&self) -> f64 {
        self.uncommon().gravity_scale
    }

    /// Until when the motion of a free body stands for the law that it flies by; for ever where it is the law.
    pub(crate) fn piece(&self) -> SimTime {
        self.uncommon().piece
    }

    pub(crate) fn set_piece(&mut self, end: SimTime) {
        if self.uncommon.is_some() || end != SimTime::NEVER {
            self.uncommon_mut().piece = end;
        }
    }

    /// Of velocity and spin, in 1/s.
    pub(crate) fn damping(&self) -> (f64, f64) {
        self.uncommon().damping
    }

    pub(crate) fn uncommon(&self) -> &Uncommon {
        self.uncommon.as_deref().unwrap_or(&Uncommon::NONE)
    }

    /// What few bodies have, to be changed.
    pub(crate) fn uncommon_mut(&mut self) -> &mut Uncommon {
        self.uncommon
            .get_or_insert_with(|| Box::new(Uncommon::NONE))
    }

    /// What the velocity has beyond the motion's along its present piece.
    pub(crate) fn lag(&self) -> &Lag {
        &self.uncommon().lag
    }

    pub(crate) fn set_lag(&mut self, lag: Lag) {
        if self.uncommon.is_some() || lag != Lag::NONE {
            self.uncommon_mut().lag = lag;
        }
    }

    /// Least half width of its shapes, in m: the narrowest thing that can hold it back.
    pub(crate) fn inner(&self, colliders: &List<ColliderIx, Collider>) -> f64 {
        let solids = self.colliders.iter().map(|&at| &colliders[at].solid);
        solids
            .map(|solid| half_width(solid))
            .fold(f64::INFINITY, f64::min)
    }

    /// Changes what moves the body; a fixed one comes to rest.
    pub(crate) fn set_kind(&mut self, kind: BodyKind) {
        let moving = kind == BodyKind::Dynamic;
        self.kind = kind;
        self.inverse_mass = if moving { self.mass.mass.recip() } else { 0.0 };
        let turns = moving && !self.locked_rotation;
        self.inverse_inertia = if turns {
            self.mass.inertia.recip()
        } else {
            0.0
        };
        self.motion.acceleration = Vec2::ZERO;
        self.motion.angular_acceleration = 0.0;
        self.set_lag(Lag::NONE);
        self.flight = None;
        self.member = false;
        if kind == BodyKind::Fixed {
            self.motion.velocity = Vec2::ZERO;
            self.motion.spin = 0.0;
        }
    }

    pub(crate) fn is_dynamic(&self) -> bool {
        self.kind == BodyKind::Dynamic
    }

    /// No contact moves it now.
    pub(crate) fn rests_or_drives(&self) -> bool {
        self.is_asleep() || !self.is_dynamic()
    }

    /// It may sleep, and does not move.
    pub(crate) fn can_sleep(&self) -> bool {
        self.is_dynamic()
            && self.sleep_allowed()
            && self.motion.velocity == Vec2::ZERO
            && self.motion.spin == 0.0
    }

    /// Whether its island may fall asleep.
    pub(crate) fn sleep_allowed(&self) -> bool {
        self.uncommon().sleep_allowed
    }

    /// Whether anything slows it down by itself.
    pub(crate) fn is_damped(&self) -> bool {
        self.damping() != (0.0, 0.0)
    }

    /// The motion told from `time` on, free of its law, and the angle that it has turned by since it began, in rad: a law costs elliptic
    /// functions, or a sum of polynomials, and is asked once.
    pub(crate) fn at(&self, time: SimTime) -> (Motion, f64) {
        let mut motion = self.motion.rebased(time);
        if let Some(flight) = &self.flight {
            let angle;
            (motion.centre, motion.velocity, angle, motion.spin) = flight.all_at(time);
            motion.rotation = flight.turned_by(angle);
            motion.left_out = 0.0;
            return (motion, angle - flight.angle_at(self.motion.start).0);
        }
        let (lag, elapsed) = (self.lag(), time - self.motion.start);
        if *lag != Lag::NONE {
            motion.velocity += lag.at(elapsed);
            motion.spin += lag.spin_at(elapsed);
        }
        (motion, self.motion.turn(elapsed))
    }

    /// Angle at `time` with all whole turns, in rad.
    pub(crate) fn turned_at(&self, time: SimTime) -> f64 {
        self.turned
            + match &self.flight {
                Some(flight) => flight.angle_at(time).0 - flight.angle_at(self.motion.start).0,
                None => self.motion.turn(time - self.motion.start),
            }
    }

    /// Centre of mass at `time`, in m, by the law of its flight.
    pub(crate) fn centre_at(&self, time: SimTime) -> Vec2 {
        match &self.flight {
            Some(flight) => flight.at(time).0,
            None => self.motion.centre_at(time),
        }
    }

    /// Velocity of the centre of mass at `time`, in m/s.
    pub(crate) fn velocity_at(&self, time: SimTime) -> Vec2 {
        match &self.flight {
            Some(flight) => flight.at(time).1,
            None => self.motion.velocity_at(time) + self.lag().at(time - self.motion.start),
        }
    }

    /// Rotation at `time`, by the law of its flight.
    pub(crate) fn rotation_at(&self, time: SimTime) -> Rot {
        match &self.flight {
            Some(flight) => flight.turn_at(time).0,
            None => self.motion.rotation_at(time),
        }
    }

    /// Angular velocity at `time`, in rad/s.
    pub(crate) fn spin_at(&self, time: SimTime) -> f64 {
        match &self.flight {
            Some(flight) => flight.turn_at(time).1,
            None => self.motion.spin_at(time) + self.lag().spin_at(time - self.motion.start),
        }
    }

    /// Frame of the centre of mass at `time`, by the law of its flight.
    pub(crate) fn centre_pose(&self, time: SimTime) -> Pose {
        let Some(flight) = &self.flight else {
            return self.motion.pose_at(time);
        };
        let (centre, _, angle, _) = flight.all_at(time);
        Pose::new(centre, flight.turned_by(angle))
    }

    /// Frame of the shapes as drawn.
    pub(crate) fn pose(&self, time: SimTime) -> Pose {
        drawn_at(self.centre_pose(time), self.mass.centroid)
    }

    pub(crate) fn kinetic_energy(&self, time: SimTime) -> f64 {
        if !self.is_dynamic() {
            return 0.0;
        }
        let spin = self.spin_at(time);
        0.5 * (self.mass.mass * self.velocity_at(time).length_squared()
            + self.turning_inertia() * spin * spin)
    }

    /// Moment of inertia that a spin feels: none where the rotation is locked.
    pub(crate) fn turning_inertia(&self) -> f64 {
        if self.inverse_inertia > 0.0 {
            self.mass.inertia
        } else {
            0.0
        }
    }

    /// Whether its outline stays where it is as it turns: a disc about its centre of mass.
    pub(crate) fn turns_in_place(&self, colliders: &List<ColliderIx, Collider>) -> bool {
        let is_disc = |at: &ColliderIx| matches!(*colliders[*at].solid, Shape::Circle(_));
        self.colliders.iter().all(is_disc) && self.inner(colliders) >= self.reach
    }

    /// The body as the impact laws see it. A law of flight costs elliptic functions, or a sum of polynomials: it is asked once.
    pub(crate) fn in_impact(&self, time: SimTime) -> ImpactBody {
        let (centre, velocity, spin) = if let Some(flight) = &self.flight {
            let (centre, velocity, _, spin) = flight.all_at(time);
            (centre, velocity, spin)
        } else {
            let (centre, velocity) = (self.centre_at(time), self.velocity_at(time));
            (centre, velocity, self.spin_at(time))
        };
        ImpactBody {
            inverse_mass: self.inverse_mass,
            inverse_inertia: self.inverse_inertia,
            centre,
            velocity,
            spin,
        }
    }
}

/// About half the width of the widest part of a shape about a centre of mass, in m; at least a thousandth of its size.
fn half_width(solid: &Shape) -> f64 {
    let inner = hulls(solid).map(|hull| inner_of(&hull));
    let widest = inner.fold(0.0, f64::max);
    widest.max(1e-3 * solid.reach_about(Vec2::ZERO))
}

/// From the middle of a part's vertices to its nearest edge, in m: half its width, or less where it tapers.
pub(crate) fn inner_of(hull: &Hull<'_>) -> f64 {
    if hull.normals.is_empty() {
        return hull.radius;
    }
    #[expect(clippy::cast_precision_loss, reason = "vertices are counted exactly")]
    let middle = hull.vertices.iter().sum::<Vec2>() / hull.vertices.len() as f64;
    let edges = hull.normals.iter().zip(hull.vertices);
    edges
        .map(|(n, v)| n.dot(*v - middle))
        .fold(f64::INFINITY, f64::min)
}

/// Frame of the shapes as drawn, where the centre of mass has its frame.
pub(crate) fn drawn_at(frame: Pose, centroid: Vec2) -> Pose {
    Pose::new(frame.position - frame.rotation * centroid, frame.rotation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_fills_72_bytes() {
        assert_eq!(size_of::<Collider>(), 72);
    }

    #[test]
    fn a_body_fills_eight_lines_of_a_cache() {
        assert_eq!(size_of::<BodyState>(), 8 * 64);
    }
}
