//! Chipmunk.

use carom_c_peers::chipmunk::{HAS_ASSERTS, HAS_THREADS, World, WorldDef, version};
use carom_math::Vec2;
use carom_scenes::PlainScene;

use crate::engine::{Body, Counters, Engine, EngineError, Mode, Setup, State};

/// Of the tuned settings, in m.
const TUNED_SLOP: f64 = 1e-3;

/// Rest before sleep, in s: the default is never, this is what the other peers take.
const SLEEP_AFTER: f64 = 0.5;

struct Chipmunk {
    world: World,
    dt: f64,
    sleeping: bool,
    poses: Vec<(Vec2, f64)>,
}

pub(super) fn open(scene: &PlainScene, setup: &Setup) -> Result<Box<dyn Engine>, EngineError> {
    let engine = || "chipmunk".to_owned();
    if setup.threads != 1 && !(setup.threads == 2 && HAS_THREADS) {
        return Err(EngineError::Threads {
            engine: engine(),
            threads: setup.threads,
        });
    }
    let refuses = |reason: String| EngineError::Settings {
        engine: engine(),
        reason,
    };
    let dt = setup.hz.recip();
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(refuses(format!("hz = {}", setup.hz)));
    }
    let slop = setup
        .slop
        .or_else(|| (setup.mode == Mode::Tuned).then_some(TUNED_SLOP));
    if let Some(slop) = slop.filter(|slop| !(*slop >= 0.0 && slop.is_finite())) {
        return Err(refuses(format!("slop = {slop}")));
    }
    let mut world = World::new(&WorldDef {
        gravity: scene.gravity,
        iterations: setup.substeps,
        slop,
        sleep_after: setup.sleeping.then_some(SLEEP_AFTER),
        threads: setup.threads,
    })
    .ok_or_else(|| refuses("no space".to_owned()))?;
    for (index, body) in scene.bodies.iter().enumerate() {
        world.add(scene, body).map_err(|reason| EngineError::Body {
            engine: engine(),
            body: index,
            reason,
        })?;
    }
    Ok(Box::new(Chipmunk {
        world,
        dt,
        sleeping: setup.sleeping,
        poses: Vec::new(),
    }))
}

impl Engine for Chipmunk {
    fn step(&mut self) {
        self.world.step(self.dt);
    }

    fn state(&self, body: usize) -> State {
        self.world.state(body).into()
    }

    fn body(&self, body: usize) -> Body {
        let [mass, inertia] = self.world.mass(body);
        Body { mass, inertia }
    }

    fn read_poses(&mut self) -> f64 {
        self.poses.clear();
        let all = (0..self.world.len()).map(|body| self.world.pose(body));
        self.poses.extend(all);
        let sum: Vec2 = self.poses.iter().map(|(position, _)| *position).sum();
        sum.x + sum.y
    }

    fn counters(&self) -> Counters {
        Counters {
            awake: self.world.awake(),
            touching: self.world.touching(),
        }
    }

    fn settings(&self) -> String {
        let sleeping = if self.sleeping {
            format!("{SLEEP_AFTER}s")
        } else {
            "off".to_owned()
        };
        let asserts = if HAS_ASSERTS {
            // Debian's package, for one.
            "on(debug-build)"
        } else {
            "off"
        };
        format!(
            "version={} asserts={asserts} iterations={} slop={:.3}m sleeping={sleeping} threads={}",
            version(),
            self.world.iterations(),
            self.world.slop(),
            self.world.threads(),
        )
    }
}
