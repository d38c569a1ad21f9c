//! carom itself.

use carom_dynamics::{BodyId, BodyKind, Settings, Sleep, World};
use carom_math::{Pose, Vec2};
use carom_scenes::PlainScene;

use crate::clock::CpuClock;
use crate::engine::{Body, Counters, Engine, EngineError, Mode, Setup, State};

struct Carom {
    world: World,
    dt: f64,
    ids: Vec<BodyId>,
    /// Where all bodies are, by their index in the world.
    poses: Vec<Pose>,
    impacts: u64,
}

pub(super) fn open(scene: &PlainScene, setup: &Setup) -> Result<Box<dyn Engine>, EngineError> {
    if setup.threads != 1 {
        return Err(EngineError::Threads {
            engine: "carom".to_owned(),
            threads: setup.threads,
        });
    }
    let mut world = World::new(settings(scene, setup)).map_err(|error| EngineError::Settings {
        engine: "carom".to_owned(),
        reason: error.to_string(),
    })?;
    let inserted = scene.insert_into(&mut world);
    let ids = inserted.map_err(|error| EngineError::Body {
        engine: "carom".to_owned(),
        body: error.body,
        reason: error.reason,
    })?;
    let mut poses = Vec::new();
    world.poses_into(&mut poses);
    Ok(Box::new(Carom {
        world,
        dt: setup.hz.recip(),
        ids,
        poses,
        impacts: 0,
    }))
}

/// A tick is a step; the default keeps carom's own number of sub-steps in it.
fn settings(scene: &PlainScene, setup: &Setup) -> Settings {
    let default = match setup.mode {
        Mode::Fast | Mode::SteppedFast => Settings::fast(),
        Mode::Accurate | Mode::SteppedAccurate => Settings::accurate(),
        _ => Settings::default(),
    };
    let tick = setup.hz.recip();
    let substeps = setup
        .substeps
        .map_or(default.tick / default.substep, f64::from);
    Settings {
        gravity: scene.gravity,
        tick,
        substep: tick / substeps,
        mode: match setup.mode {
            Mode::Exact => carom_dynamics::Mode::Exact,
            Mode::Stepped | Mode::SteppedFast | Mode::SteppedAccurate => {
                carom_dynamics::Mode::Stepped
            }
            _ => carom_dynamics::Mode::Hybrid,
        },
        sleep: setup.sleeping.then(Sleep::default),
        ..default
    }
}

impl Engine for Carom {
    fn step(&mut self) {
        self.impacts += self.world.step(self.dt).impacts;
    }

    fn state(&self, body: usize) -> State {
        let body = self.world.body(self.ids[body]).expect("never removed");
        State {
            position: body.centre(),
            angle: body.angle(),
            velocity: body.velocity(),
            spin: body.angular_velocity(),
        }
    }

    fn body(&self, body: usize) -> Body {
        let body = self.world.body(self.ids[body]).expect("never removed");
        // Infinite where nothing can move it.
        let given = |x: f64| if x.is_finite() { x } else { 0.0 };
        Body {
            mass: given(body.mass()),
            inertia: given(body.inertia()),
        }
    }

    /// By the step's list of what moved: all else stays where the caller has it.
    fn read_poses(&mut self) -> f64 {
        let mut sum = Vec2::ZERO;
        for body in self.world.moved() {
            let pose = body.pose();
            self.poses[body.id().index()] = pose;
            sum += pose.position;
        }
        sum.x + sum.y
    }

    fn counters(&self) -> Counters {
        let awake = self.world.bodies();
        Counters {
            awake: awake
                .filter(|body| body.kind() == BodyKind::Dynamic && !body.is_asleep())
                .count(),
            touching: self.world.contacts().count(),
        }
    }

    fn impacts(&self) -> Option<u64> {
        Some(self.impacts)
    }

    fn profile(&mut self) -> Option<Vec<(&'static str, f64)>> {
        self.world
            .set_stopwatch(Some(|| CpuClock::thread().seconds()));
        Some(self.world.profile().stages().to_vec())
    }

    fn settings(&self) -> String {
        let settings = self.world.settings();
        format!(
            "tick={} substep={} mode={:?} contact={}Hz",
            settings.tick,
            settings.substep,
            settings.mode,
            settings.contact.frequency.min(0.125 / settings.substep)
        )
    }
}
