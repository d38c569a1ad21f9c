//! The world: what is kept of bodies and pairs, and what each method keeps. A step moves it; `api` has what a caller makes, changes
//! and reads.

use std::collections::BTreeSet;

use carom_math::SimTime;

use crate::analytic::islands::store::Closed;
use crate::broad::tree::Broad;
use crate::events::free::FreeBodies;
use crate::stepping::{Joins, Stepping};
use crate::store::bodies::Bodies;
use crate::store::clock::Clock;
use crate::store::pairs::Pairs;
use crate::values::profile::Stopwatch;
use crate::work::Work;
use crate::{BodyIx, Events, Settings, StepReport};

/// Rigid bodies and the time that passes for them.
///
/// # Examples
/// A ball dropped from 5 m is at half g t² after half a second, whatever the steps.
/// ```
/// use carom_dynamics::{BodyDef, Material, Settings, World};
/// use carom_geometry::Circle;
/// use carom_math::vec2;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = World::new(Settings { gravity: vec2(0.0, -10.0), ..Settings::default() })?;
/// let ball = world.insert(
///     BodyDef::dynamic().at(vec2(0.0, 5.0)),
///     Circle::new(0.1)?,
///     Material::default(),
/// )?;
/// for _ in 0..30 {
///     world.step(1.0 / 60.0);
/// }
/// let height = world.body(ball).ok_or("it is there")?.centre().y;
/// assert!((height - 3.75).abs() < 1e-14);                      // 5 − 10 · 0.5² / 2 m
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) settings: Settings,
    pub(crate) clock: Clock,
    pub(crate) bodies: Bodies,
    pub(crate) pairs: Pairs,
    pub(crate) broad: Broad,
    pub(crate) closed: Closed,
    pub(crate) free: FreeBodies,
    /// Bodies that get their method before time goes on.
    pub(crate) unsettled: BTreeSet<BodyIx>,
    pub(crate) events: Events,
    pub(crate) report: StepReport,
    pub(crate) work: Work,
    /// No pose is read before this instant.
    pub(crate) unseen_until: SimTime,
    /// Bodies that the engine moves until the present sub-step ends.
    pub(crate) handed_over: u64,
    /// Bodies with a force that waits for a step or acts during this one.
    pub(crate) forced: Vec<BodyIx>,
    pub(crate) stopwatch: Stopwatch,
    /// The engine of bodies in contact.
    pub(crate) stepping: Option<Box<Stepping>>,
    /// Bodies that it moves in [`Mode::Hybrid`] and [`Mode::Exact`].
    pub(crate) joins: Joins,
}
