//! One engine in one case: worlds with metered steps.

use carom_scenes::PlainScene;

use crate::clock::CpuClock;
use crate::engine::{Body, Counters, Engine, EngineError, Setup, State};
use crate::engines::{self, EngineName};
use crate::job::Point;

/// One step in so many is metered: reading the clock costs as much as a step of a world of one body.
const METERED: u64 = 8;

/// Builds a world: by an engine, or what a test puts in its place.
pub(super) type Opener =
    fn(EngineName, &PlainScene, &Setup) -> Result<Box<dyn Engine>, EngineError>;

/// An engine with its settings, and what its steps cost so far.
#[derive(Debug)]
pub struct Trial {
    point: Point,
    settings: String,
    meter: Meter,
    opener: Opener,
}

#[derive(Clone, Copy, Debug, Default)]
struct Meter {
    steps: u64,
    metered: u64,
    seconds: f64,
}

impl Trial {
    /// Nothing has been stepped yet.
    #[must_use]
    pub fn new(point: &Point) -> Self {
        Self::opened_by(engines::open, point)
    }

    pub(super) fn opened_by(opener: Opener, point: &Point) -> Self {
        Self {
            point: point.clone(),
            settings: String::new(),
            meter: Meter::default(),
            opener,
        }
    }

    /// The engine that runs.
    #[must_use]
    pub const fn engine(&self) -> EngineName {
        self.point.engine
    }

    /// Steps per simulated second.
    #[must_use]
    pub fn hz(&self) -> f64 {
        f64::from(self.point.hz)
    }

    /// Length of a step, in s.
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.hz().recip()
    }

    /// Builds a world; the scene's own `dt` does not count.
    ///
    /// # Errors
    /// If the engine is not built in or refuses the scene.
    pub fn open(&mut self, scene: &PlainScene) -> Result<Run<'_>, EngineError> {
        let world = self.build(scene, self.hz())?;
        if self.settings.is_empty() {
            self.settings = world.settings();
        }
        Ok(Run::new(world, self.hz(), Some(&mut self.meter)))
    }

    /// Builds a reference: a world stepped at another rate, in Hz, at no cost to the trial.
    ///
    /// # Errors
    /// If the engine is not built in or refuses the scene.
    pub fn reference(&self, scene: &PlainScene, hz: f64) -> Result<Run<'static>, EngineError> {
        Ok(Run::new(self.build(scene, hz)?, hz, None))
    }

    fn build(&self, scene: &PlainScene, hz: f64) -> Result<Box<dyn Engine>, EngineError> {
        let setup = Setup {
            mode: self.point.mode,
            hz,
            substeps: self.point.substeps,
            threads: 1,
            sleeping: scene.sleeping,
            slop: None,
        };
        (self.opener)(self.point.engine, scene, &setup)
    }

    /// As the engine was set in the first world.
    #[must_use]
    pub fn settings(&self) -> &str {
        &self.settings
    }

    /// CPU seconds inside steps per simulated second.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "counts of steps fit into 53 bits"
    )]
    pub fn cpu_per_second(&self) -> f64 {
        self.meter.seconds / self.meter.metered as f64 * self.hz()
    }
}

/// A world on its way.
pub struct Run<'a> {
    engine: Box<dyn Engine>,
    dt: f64,
    time: f64,
    meter: Option<&'a mut Meter>,
}

impl std::fmt::Debug for Run<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Run")
            .field("engine", &self.engine.settings())
            .field("time", &self.time)
            .finish_non_exhaustive()
    }
}

impl<'a> Run<'a> {
    fn new(engine: Box<dyn Engine>, hz: f64, meter: Option<&'a mut Meter>) -> Self {
        Self {
            engine,
            dt: hz.recip(),
            time: 0.0,
            meter,
        }
    }
}

impl Meter {
    fn step(&mut self, engine: &mut dyn Engine) {
        if self.steps.is_multiple_of(METERED) {
            let clock = CpuClock::thread();
            let before = clock.seconds();
            engine.step();
            self.seconds += clock.seconds() - before;
            self.metered += 1;
        } else {
            engine.step();
        }
        self.steps += 1;
    }
}

impl Run<'_> {
    /// One step.
    pub fn step(&mut self) {
        match &mut self.meter {
            Some(meter) => meter.step(self.engine.as_mut()),
            None => self.engine.step(),
        }
        self.time += self.dt;
    }

    /// Steps while the sum of `dt` is below `time`, in s.
    pub fn until(&mut self, time: f64) {
        while self.goes_on(time) {
            self.step();
        }
    }

    /// Whether the sum of `dt` is below `time`, in s.
    #[must_use]
    pub fn goes_on(&self, time: f64) -> bool {
        self.time < time - 1e-9
    }

    /// Sum of `dt`, in s.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Where a body is and how it moves.
    #[must_use]
    pub fn state(&self, body: usize) -> State {
        self.engine.state(body)
    }

    /// What a body weighs.
    #[must_use]
    pub fn body(&self, body: usize) -> Body {
        self.engine.body(body)
    }

    /// What the engine says of its last step.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.engine.counters()
    }

    /// The world, for [`assess`](crate::assess).
    #[must_use]
    pub fn engine(&self) -> &dyn Engine {
        self.engine.as_ref()
    }
}
