//! Bodies in, bodies out, what the caller changes and reads. No mechanics here.

use std::collections::BTreeSet;
use std::sync::Arc;

use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, SimTime, StateHash, Sum, Vec2, cross};

use crate::analytic::islands::store::Closed;
use crate::broad::tree::Broad;
use crate::events::free::FreeBodies;
use crate::stepping::{Joins, Stepping};
use crate::store::bodies::Bodies;
use crate::store::clock::Clock;
use crate::store::pairs::Pairs;
use crate::store::state::{BodyState, Collider, Surface};
use crate::values::profile::Stopwatch;
use crate::work::Work;
use crate::{
    Body, BodyDef, BodyError, BodyId, BodyIx, BodyKind, ColliderIx, Contact, EnergyLedger, Events,
    Filter, Ix, Material, Mode, Momentum, PairIx, Settings, SettingsError, StepProfile, StepReport,
    World,
};

/// So many of the shapes that came last are looked through for one that is alike.
const LATEST: usize = 8;

impl World {
    /// An empty world.
    ///
    /// # Errors
    /// If a setting is not finite or out of its range.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.check()?;
        Ok(Self {
            clock: Clock::new(settings.h()),
            bodies: Bodies::new(&settings),
            pairs: Pairs::default(),
            broad: Broad::new(settings.pair_search),
            closed: Closed::default(),
            free: FreeBodies::under(settings.gravity),
            unsettled: BTreeSet::new(),
            events: Events::new(settings.events),
            report: StepReport::default(),
            work: Work::default(),
            unseen_until: SimTime::ZERO,
            handed_over: 0,
            forced: Vec::new(),
            stopwatch: Stopwatch::default(),
            stepping: Some(Stepping::of(&settings)?),
            joins: Joins::default(),
            settings,
        })
    }

    /// What the world was told at its start, or [since](Self::set_settings).
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Times the stages of every following step by this clock, in s; `None`: no longer.
    pub const fn set_stopwatch(&mut self, clock: Option<fn() -> f64>) {
        self.stopwatch.clock = clock;
    }

    /// Where the time of the last step went: all 0 without a [stopwatch](Self::set_stopwatch).
    #[must_use]
    pub const fn profile(&self) -> StepProfile {
        self.stopwatch.profile
    }

    /// Simulated time.
    #[must_use]
    pub const fn time(&self) -> SimTime {
        self.clock.now
    }

    /// Makes room for `bodies` more bodies of one shape each. This saves memory: room that grows with every body is up
    /// to twice as large as it need be, and leaves holes.
    pub fn reserve(&mut self, bodies: usize) {
        self.bodies.reserve(bodies);
        self.free.reserve(bodies);
    }

    /// Inserts a body of one shape.
    ///
    /// # Errors
    /// If a number is not finite or out of its range, or a moving body has no mass.
    pub fn insert(
        &mut self,
        def: BodyDef,
        shape: impl Into<Shape>,
        material: Material,
    ) -> Result<BodyId, BodyError> {
        self.insert_compound(def, vec![(shape.into(), material)])
    }

    /// Inserts a body of several shapes, each with its own material; their frame is one.
    ///
    /// # Errors
    /// As [`Self::insert`], and if there is no shape.
    pub fn insert_compound(
        &mut self,
        def: BodyDef,
        shapes: Vec<(Shape, Material)>,
    ) -> Result<BodyId, BodyError> {
        def.check()?;
        check_shapes(&shapes)?;
        let id = self.bodies.next_id()?;
        let now = self.clock.now;
        let state = BodyState::new(id, &def, &shapes, now, self.settings.mode)?;
        let sleeps = def.asleep && self.settings.sleep.is_some() && state.can_sleep();
        let centroid = state.mass.centroid;
        self.bodies.insert(state);
        if sleeps {
            self.bodies.fall_asleep(id.index);
        }
        self.closed.reset_budget(id.index);
        self.add_shapes(id.index, shapes, def.filter, centroid);
        let brought = self.bodies.energy_of(id.index, now);
        self.bodies.book.external.add(brought);
        if self.settings.mode == Mode::Stepped {
            // It enters the engine with the next sub-step.
            self.show_engine(id.index);
        } else if sleeps {
            // No flight, and nothing to predict: it only has to be found.
            self.refit(id.index, now, self.clock.h, true);
            self.show(id.index, now);
            self.show_engine(id.index);
        } else {
            self.arrive(id.index);
            self.unsettle_on(id.index, now);
        }
        self.bodies.check_regime(id.index, self.settings.mode);
        Ok(id)
    }

    /// Takes a body out.
    ///
    /// # Errors
    /// If it is not there.
    pub fn remove(&mut self, id: BodyId) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        let now = self.clock.now;
        // A pile that wakes joins the engine, and the body with it: it leaves once all are awake.
        self.wake_around(index, now);
        self.leave(index, now);
        self.bodies.change(index, now, |_| {});
        let taken = self.bodies.energy_of(index, now);
        self.bodies.book.external.add(-taken);
        let mut around = Vec::new();
        for place in self.bodies.get(index).pairs.clone() {
            around.push(self.pairs.get(place).other(index));
            self.part(place, now);
        }
        self.free.vanish(&mut self.bodies, index);
        self.end_unsettled(index);
        self.broad.forget(&mut self.bodies, index);
        self.free_shapes(index);
        self.forced.retain(|i| *i != index);
        self.broad
            .overrides
            .retain(|(a, b), _| *a != id && *b != id);
        self.broad.excluded.retain(|(a, b)| *a != id && *b != id);
        self.bodies.remove(index);
        self.drop_unheld(&around, now);
        Ok(())
    }

    /// A body, read at the world's time; `None` if it is not there.
    #[must_use]
    pub fn body(&self, id: BodyId) -> Option<Body<'_>> {
        let index = self.bodies.find(id).ok()?;
        Some(self.view(self.bodies.get(index)))
    }

    /// All bodies, in order of their places.
    pub fn bodies(&self) -> impl Iterator<Item = Body<'_>> {
        self.bodies.iter().map(|state| self.view(state))
    }

    /// All pairs that touch, as of the last sub-step, in order of their shapes; of what moves without sub-steps, as of now.
    pub fn contacts(&self) -> impl Iterator<Item = Contact> + use<'_> {
        self.contacts_in(self.pairs.in_order(), None)
    }

    /// What a body touches: [`Self::contacts`] of one body, in order of the shapes; empty if it is not there.
    pub fn contacts_of(&self, id: BodyId) -> impl Iterator<Item = Contact> + use<'_> {
        let index = self.bodies.find(id).ok();
        index.into_iter().flat_map(|index| {
            let places = self.bodies.get(index).pairs.iter().copied();
            self.contacts_in(self.pairs.by_colliders(places), Some(index))
        })
    }

    /// Contacts of pairs in these places, and those that the engine has: all, or those of a body.
    fn contacts_in(
        &self,
        mut places: Vec<PairIx>,
        of: Option<BodyIx>,
    ) -> impl Iterator<Item = Contact> + use<'_> {
        places.retain(|place| self.pairs.get(*place).told);
        let stepped = self.stepping.iter();
        let stepped = stepped.flat_map(move |stepping| stepping.contacts(&self.bodies, of));
        let touching = places.into_iter();
        let touching = touching.flat_map(|place| self.contacts_at(place));
        touching.chain(stepped)
    }

    fn contacts_at(&self, place: PairIx) -> Vec<Contact> {
        let pair = self.pairs.get(place);
        let now = (self.closed).pair_at(&self.bodies, pair, place, self.clock.now);
        let pair = now.as_ref().unwrap_or(pair);
        Contact::of(&self.bodies, pair).collect()
    }

    /// Frame of a body's shapes at `time`; `None` if it was not there or the log does not reach.
    ///
    /// Without [`Settings::history`] only instants since the body's last change are known.
    #[must_use]
    pub fn pose_at(&self, id: BodyId, time: SimTime) -> Option<Pose> {
        let state = self.bodies.get(self.bodies.find(id).ok()?);
        if time > self.clock.now {
            return None;
        }
        if time >= state.motion.start {
            return Some(state.pose(time));
        }
        self.bodies.history.pose_at(id.index, time)
    }

    /// Frames of all bodies in the order of [`Self::bodies`]; `poses` is cleared first.
    pub fn poses_into(&self, poses: &mut Vec<Pose>) {
        poses.clear();
        poses.extend(self.bodies.iter().map(|state| state.pose(self.clock.now)));
    }

    /// Box around all bodies, in m; empty if there are none, without end beside a half-plane.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bodies()
            .fold(Aabb::EMPTY, |all, body| all.union(body.aabb()))
    }

    /// Box around all bodies without a half-plane, in m: what a camera can show. Empty if there are none.
    #[must_use]
    pub fn finite_bounds(&self) -> Aabb {
        self.bodies()
            .map(|body| body.aabb())
            .filter(|bounds| bounds.is_finite())
            .fold(Aabb::EMPTY, Aabb::union)
    }

    /// Where the energy is and where it went.
    #[must_use]
    pub fn energy(&self) -> EnergyLedger {
        let mut ledger = self.bodies.ledger(self.clock.now);
        if self.settings.mode == Mode::Stepped {
            if let Some(stepping) = &self.stepping {
                ledger.impacts += stepping.engine.impact_losses();
                ledger.friction += stepping.engine.friction_heat();
                ledger.external += self.joins.driven.value() + stepping.engine.belt_work();
            }
            // What all other rows and push-outs did is what the energies tell.
            ledger.scheme += ledger.residual();
            return ledger;
        }
        self.book_members(&mut ledger);
        let (heat, driven) = self.closed.unbooked(self.clock.now);
        ledger.friction += heat;
        ledger.external += driven;
        ledger.scheme += heat - driven;
        ledger
    }

    /// Momentum of all dynamic bodies.
    #[must_use]
    pub fn momentum(&self) -> Momentum {
        let mut sums = [Sum::ZERO; 3];
        for body in self
            .bodies()
            .filter(|body| body.kind() == BodyKind::Dynamic)
        {
            let linear = body.mass() * body.velocity();
            let turning = body.state.turning_inertia() * body.angular_velocity();
            sums[0].add(linear.x);
            sums[1].add(linear.y);
            sums[2].add(cross(body.centre(), linear) + turning);
        }
        Momentum {
            linear: Vec2::new(sums[0].value(), sums[1].value()),
            angular: sums[2].value(),
        }
    }

    /// What happened during the last step.
    #[must_use]
    pub const fn events(&self) -> &Events {
        &self.events
    }

    /// Fingerprint of time and all bodies' states: equal runs have equal numbers.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        let mut hash = StateHash::default();
        hash.write_time(self.clock.now);
        for body in self.bodies() {
            let id = body.id();
            hash.write_u64(u64::from(id.index.number()) << 32 | u64::from(id.generation));
            hash.write_vec2(body.centre());
            hash.write_vec2(body.state.rotation_at(self.clock.now).x_axis());
            hash.write_vec2(body.velocity());
            hash.write(body.angular_velocity());
        }
        hash.finish()
    }

    pub(crate) fn view<'w>(&'w self, state: &'w BodyState) -> Body<'w> {
        Body {
            state,
            colliders: &self.bodies.colliders,
            version: self.bodies.version(state.id.index),
            now: self.clock.now,
        }
    }

    /// Gives the places of a body's shapes to those that come next.
    pub(crate) fn free_shapes(&mut self, index: BodyIx) {
        let freed = self.bodies.get(index).colliders.clone();
        self.bodies.free_colliders.extend(&freed);
    }

    /// Gives a body its shapes.
    pub(crate) fn add_shapes(
        &mut self,
        index: BodyIx,
        shapes: Vec<(Shape, Material)>,
        filter: Filter,
        centroid: Vec2,
    ) {
        let add = |(shape, material)| {
            self.add_collider(index, shape, Surface { material, filter }, centroid)
        };
        let colliders = shapes.into_iter().map(add).collect();
        self.bodies.get_mut(index).colliders = colliders;
    }

    /// Puts a shape of a body among all shapes, and returns its place there.
    fn add_collider(
        &mut self,
        body: BodyIx,
        shape: Shape,
        surface: Surface,
        centroid: Vec2,
    ) -> ColliderIx {
        let (drawn, solid) = self.shape_like(shape, centroid);
        let alike = self.latest().find(|known| *known.surface == surface);
        let surface = match alike {
            Some(known) => Arc::clone(&known.surface),
            None => Arc::new(surface),
        };
        let collider = Collider {
            body,
            drawn,
            solid,
            surface,
            node: None,
            fat: Aabb::EMPTY,
        };
        if let Some(at) = self.bodies.free_colliders.pop() {
            self.bodies.colliders[at] = collider;
            at
        } else {
            self.bodies.colliders.push(collider)
        }
    }

    /// A shape as it is drawn, and about a centre of mass: those of another one that is alike, if one came shortly before.
    fn shape_like(&self, shape: Shape, centroid: Vec2) -> (Arc<Shape>, Arc<Shape>) {
        let mut latest = self.latest().filter(|known| *known.drawn == shape);
        // The centre of mass of the other one may be elsewhere.
        let alike = latest.find(|known| {
            let moved = shape.vertices().iter().map(|v| *v + -centroid);
            moved.eq(known.solid.vertices().iter().copied())
        });
        if let Some(known) = alike {
            return (Arc::clone(&known.drawn), Arc::clone(&known.solid));
        }
        let drawn = Arc::new(shape);
        // A shape drawn about its centre is its own solid.
        let solid = if centroid == Vec2::ZERO {
            Arc::clone(&drawn)
        } else {
            Arc::new(drawn.translated(-centroid))
        };
        (drawn, solid)
    }

    /// The shapes that came last: many bodies are alike.
    fn latest(&self) -> impl Iterator<Item = &Collider> {
        self.bodies.colliders.iter().rev().take(LATEST)
    }
}

/// Whether a body may have these shapes, as far as each tells alone.
pub(crate) fn check_shapes(shapes: &[(Shape, Material)]) -> Result<(), BodyError> {
    if shapes.is_empty() {
        return Err(BodyError::NoShape);
    }
    shapes.iter().try_for_each(|(_, material)| material.check())
}
