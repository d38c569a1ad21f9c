//! Milliseconds a step, and what they bought.

use carom_scenes::{PlainKind, PlainScene, plain_scene, plain_scenes};
use serde::{Deserialize, Serialize};

use crate::clock::{CpuClock, peak_memory, program_memory};
use crate::engine::{Counters, Engine, EngineError, Mode, Setup};
use crate::engines::{EngineName, open};
use crate::job::Reading;
use crate::quality::{Quality, Snapshot, Unrest};

/// How many steps after the measured ones tell how much a scene hums.
const REST_STEPS: u32 = 30;

/// One engine on one scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SpeedJob {
    /// The engine.
    pub engine: EngineName,
    /// With which settings.
    pub mode: Mode,
    /// On how many threads.
    pub threads: u32,
    /// Whether all poses are read after each step, inside the clock.
    pub reads_poses: bool,
    /// Which scene.
    pub scene: String,
    /// Where the run ends before the scene's own steps do.
    #[serde(default)]
    pub limits: Limits,
}

/// Where a run ends before the scene's own steps do; `None`: not before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Limits {
    /// At most so many steps before the clock starts; the first step of all is one of them.
    #[serde(default)]
    pub warm_up_steps: Option<u32>,
    /// At most so many measured steps.
    #[serde(default)]
    pub measured_steps: Option<u32>,
    /// CPU time of the process for all steps, in s. The warm-up is cut at half of it, the measured steps at the whole;
    /// a step that has begun is finished.
    #[serde(default)]
    pub cpu_s: Option<u32>,
}

/// What one process measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpeedReading {
    /// Mean over the measured steps, in ms: CPU time on one thread, wall time on several.
    #[serde(with = "crate::number")]
    pub ms_mean: f64,
    /// Median over the measured steps, in ms.
    #[serde(with = "crate::number")]
    pub ms_median: f64,
    /// 99th percentile over the measured steps, in ms.
    #[serde(with = "crate::number")]
    pub ms_p99: f64,
    /// First step of all, in ms.
    #[serde(with = "crate::number")]
    pub ms_first: f64,
    /// Steps before the clock started, the first one among them.
    pub warm_up_steps: u32,
    /// Steps that were measured.
    pub measured_steps: u32,
    /// Whether the CPU time ran out before the steps were made.
    pub cut: bool,
    /// Dynamic bodies of the scene.
    pub bodies: usize,
    /// Verdict after the warm-up.
    pub before: Quality,
    /// Verdict after the last measured step.
    pub after: Quality,
    /// How much bodies are thrown about in the steps after the clock stopped: see [`Unrest`], in m/s².
    #[serde(with = "crate::number")]
    pub rms_acceleration: f64,
    /// Farthest that a dynamic body's centre moved during the measured steps, in m.
    #[serde(with = "crate::number")]
    pub drift: f64,
    /// Impacts of a body in a simulated second of the measured steps, where the engine counts them: each has two bodies.
    #[serde(default)]
    pub impact_rate: Option<f64>,
    /// In the engine's own words, after the last measured step.
    pub counters: Counters,
    /// Largest resident memory up to the last measured step, in MiB.
    pub peak_mib: Option<f64>,
    /// Largest resident memory before the scene was built, in MiB: the process's own.
    #[serde(default)]
    pub own_mib: Option<f64>,
    /// What of the peak beyond that is the program itself, in MiB: pages of it that ran for the first time. It does not
    /// grow with the scene.
    #[serde(default)]
    pub program_mib: Option<f64>,
    /// As the engine was set.
    pub settings: String,
}

/// Where the time of a step goes, as the engine's own clock tells it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageReading {
    /// Steps before the measured ones.
    pub warm_up_steps: u32,
    /// Steps that were measured.
    pub measured_steps: u32,
    /// Whether the CPU time ran out before the steps were made.
    pub cut: bool,
    /// Mean over the measured steps, in ms, by the laboratory's clock.
    pub ms_step: f64,
    /// Name and mean over the measured steps, in ms; disjoint parts of a step.
    pub stages: Vec<(String, f64)>,
}

/// Times an engine on a scene.
///
/// # Errors
/// If there is no such scene, the engine refuses it, or the time ran out before a step was measured.
pub(crate) fn run(job: &SpeedJob) -> Result<SpeedReading, EngineError> {
    let (own_mib, own_program) = (peak_memory(), program_memory());
    let mut race = Race::start(job)?;
    let ms_first = race.warm_up();
    let before = race.snapshot();
    let impacts = race.engine.impacts();
    let mut times = race.measure();
    let impacts = impacts.zip(race.engine.impacts());
    let after = race.snapshot();
    // Before the assessment: its memory is not the engine's.
    let peak_mib = peak_memory();
    let program_mib = program_memory().zip(own_program);
    let program_mib = program_mib.map(|(now, own)| now - own);
    let counters = race.engine.counters();
    let settings = race.engine.settings();
    let (warm_up_steps, measured_steps, cut) = (race.warmed, race.measured, race.cut);
    if times.is_empty() {
        return Err(race.out_of_time(ms_first));
    }

    let scene = find(&job.scene)?;
    let rms_acceleration = race.unrest(&scene);
    times.sort_by(f64::total_cmp);
    Ok(SpeedReading {
        ms_mean: mean(&times),
        ms_median: times[times.len() / 2],
        ms_p99: times[99 * times.len() / 100],
        ms_first,
        warm_up_steps,
        measured_steps,
        cut,
        bodies: dynamic(&scene),
        before: before.assess(&scene),
        after: after.assess(&scene),
        rms_acceleration,
        drift: before.drift(&after, &scene),
        impact_rate: impacts.map(|(before, after)| {
            let seconds = f64::from(measured_steps) * scene.dt;
            rate(after - before, dynamic(&scene), seconds)
        }),
        counters,
        peak_mib,
        own_mib,
        program_mib,
        settings,
    })
}

#[expect(clippy::cast_precision_loss, reason = "a count of steps")]
fn mean(times: &[f64]) -> f64 {
    times.iter().sum::<f64>() / times.len() as f64
}

#[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
fn rate(impacts: u64, bodies: usize, seconds: f64) -> f64 {
    2.0 * impacts as f64 / (bodies as f64 * seconds)
}

/// The steps of a job without assessment and without a second look at their times.
///
/// # Errors
/// If there is no such scene, or the engine refuses it.
pub(crate) fn run_bare(job: &SpeedJob) -> Result<Reading, EngineError> {
    let mut race = Race::start(job)?;
    race.warm_up();
    race.measure();
    Ok(Reading::Bare {
        warm_up_steps: race.warmed,
        measured_steps: race.measured,
    })
}

/// The mean step of a job, stage by stage.
///
/// # Errors
/// If there is no such scene, the engine refuses it or tells no stages, or the time ran out before a step was measured.
pub(crate) fn run_profile(job: &SpeedJob) -> Result<StageReading, EngineError> {
    let mut race = Race::start(job)?;
    // From here on the engine looks at its clock.
    if race.engine.profile().is_none() {
        return Err(EngineError::NoStages {
            engine: job.engine.name().to_owned(),
        });
    }
    let ms_first = race.warm_up();
    let mut sums: Vec<(String, f64)> = Vec::new();
    let mut ms = 0.0;
    while race.measured < race.planned[1] && !race.late(1.0) {
        ms += measured_step(race.engine.as_mut(), race.clock, race.reads_poses);
        race.measured += 1;
        for (index, (name, seconds)) in race.engine.profile().into_iter().flatten().enumerate() {
            match sums.get_mut(index) {
                Some((_, sum)) => *sum += seconds,
                None => sums.push((name.to_owned(), seconds)),
            }
        }
    }
    if race.measured == 0 {
        return Err(race.out_of_time(ms_first));
    }
    let steps = f64::from(race.measured);
    Ok(StageReading {
        warm_up_steps: race.warmed,
        measured_steps: race.measured,
        cut: race.cut || race.measured < race.planned[1],
        ms_step: ms / steps,
        stages: sums
            .into_iter()
            .map(|(name, seconds)| (name, 1e3 * seconds / steps))
            .collect(),
    })
}

fn find(name: &str) -> Result<PlainScene, EngineError> {
    plain_scene(name).ok_or_else(|| EngineError::Scene {
        scene: name.to_owned(),
        known: plain_scenes()
            .iter()
            .map(|info| info.name)
            .collect::<Vec<_>>()
            .join(", "),
    })
}

fn dynamic(scene: &PlainScene) -> usize {
    let bodies = scene.bodies.iter();
    bodies
        .filter(|body| body.kind == PlainKind::Dynamic)
        .count()
}

/// An engine on its way through the steps of a job. The scene itself is let go: it is not the engine's memory.
struct Race {
    engine: Box<dyn Engine>,
    name: EngineName,
    bodies: usize,
    dt: f64,
    reads_poses: bool,
    clock: CpuClock,
    budget: f64,
    planned: [u32; 2],
    warmed: u32,
    measured: u32,
    cut: bool,
    spent: CpuClock,
    started: f64,
}

impl Race {
    fn start(job: &SpeedJob) -> Result<Self, EngineError> {
        let scene = find(&job.scene)?;
        let setup = Setup {
            mode: job.mode,
            hz: scene.dt.recip(),
            substeps: None,
            threads: job.threads,
            sleeping: scene.sleeping,
            // What the other peers leave by default.
            slop: (job.mode == Mode::Stock).then_some(5e-3),
        };
        let at_most = |limit: Option<u32>, own: u32| limit.map_or(own, |limit| limit.min(own));
        let spent = CpuClock::process();
        Ok(Self {
            engine: open(job.engine, &scene, &setup)?,
            name: job.engine,
            bodies: scene.bodies.len(),
            dt: scene.dt,
            reads_poses: job.reads_poses,
            clock: if job.threads == 1 {
                CpuClock::thread()
            } else {
                CpuClock::wall()
            },
            budget: job.limits.cpu_s.map_or(f64::INFINITY, f64::from),
            planned: [
                at_most(job.limits.warm_up_steps, scene.warm_up_steps),
                at_most(job.limits.measured_steps, scene.measured_steps),
            ],
            warmed: 0,
            measured: 0,
            cut: false,
            spent,
            started: spent.seconds(),
        })
    }

    /// Whether more than a share of the time that the job may take is gone.
    fn late(&self, share: f64) -> bool {
        self.spent.seconds() - self.started > share * self.budget
    }

    /// Steps up to the state that is measured and gives the first step's time, in ms.
    fn warm_up(&mut self) -> f64 {
        let before = self.clock.seconds();
        self.engine.step();
        let first = 1e3 * (self.clock.seconds() - before);
        self.warmed = 1;
        while self.warmed < self.planned[0] {
            if self.late(0.5) {
                self.cut = true;
                break;
            }
            self.engine.step();
            self.warmed += 1;
        }
        first
    }

    /// The measured steps, each in ms.
    fn measure(&mut self) -> Vec<f64> {
        let mut times = Vec::with_capacity(self.planned[1] as usize);
        while self.measured < self.planned[1] {
            if self.late(1.0) {
                self.cut = true;
                break;
            }
            times.push(measured_step(
                self.engine.as_mut(),
                self.clock,
                self.reads_poses,
            ));
            self.measured += 1;
        }
        times
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::of(self.engine.as_ref(), self.bodies)
    }

    fn unrest(&mut self, scene: &PlainScene) -> f64 {
        let mut unrest = Unrest::new(scene, self.engine.as_ref());
        for _ in 0..REST_STEPS {
            self.engine.step();
            unrest.add(self.engine.as_ref(), self.dt);
            if self.late(1.25) {
                break;
            }
        }
        unrest.rms()
    }

    fn out_of_time(&self, ms_first: f64) -> EngineError {
        EngineError::OutOfTime {
            engine: self.name.name().to_owned(),
            steps: self.warmed,
            ms_first,
        }
    }
}

/// A step with a clock around it, in ms. Never inlined: callgrind counts what is inside of it.
#[inline(never)]
fn measured_step(engine: &mut dyn Engine, clock: CpuClock, reads_poses: bool) -> f64 {
    let before = clock.seconds();
    engine.step();
    if reads_poses {
        std::hint::black_box(engine.read_poses());
    }
    1e3 * (clock.seconds() - before)
}
