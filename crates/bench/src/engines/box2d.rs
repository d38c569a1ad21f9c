//! Box2D v3.

use carom_c_peers::box2d::{World, WorldDef, has_asserts, version};
use carom_scenes::PlainScene;

use crate::engine::{Body, Counters, Engine, EngineError, Mode, Setup, State};
use crate::engines::EngineName;

/// Box2D's own advice, and what its samples run with.
const SUBSTEPS: u32 = 4;

/// A speed that nothing reaches, with a square that an `f32` holds.
const UNCAPPED: f32 = 1e18;

struct Box2d {
    world: World,
    name: EngineName,
    mode: Mode,
    dt: f32,
    substeps: u32,
    sleeping: bool,
    /// Position and rotation of each body's origin.
    poses: Vec<[f64; 4]>,
}

pub(super) fn open(
    name: EngineName,
    scene: &PlainScene,
    setup: &Setup,
) -> Result<Box<dyn Engine>, EngineError> {
    let tuned = setup.mode == Mode::Tuned;
    let refuses = |reason: &str| EngineError::Settings {
        engine: name.name().to_owned(),
        reason: reason.to_owned(),
    };
    if setup.threads == 0 {
        return Err(EngineError::Threads {
            engine: name.name().to_owned(),
            threads: 0,
        });
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the engine's time is an f32"
    )]
    let dt = setup.hz.recip() as f32;
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(refuses(&format!("hz = {}", setup.hz)));
    }
    let mut world = World::new(&WorldDef {
        gravity: scene.gravity,
        restitution_threshold: tuned.then_some(0.0),
        maximum_speed: tuned.then_some(UNCAPPED),
        recycle_distance: tuned.then_some(0.0),
        fast_rotation: tuned,
        sleeping: setup.sleeping,
        workers: setup.threads,
    })
    .ok_or_else(|| refuses("no room for another world"))?;
    for (index, body) in scene.bodies.iter().enumerate() {
        world.add(scene, body).map_err(|reason| EngineError::Body {
            engine: name.name().to_owned(),
            body: index,
            reason,
        })?;
    }
    Ok(Box::new(Box2d {
        poses: vec![[0.0; 4]; world.len()],
        world,
        name,
        mode: setup.mode,
        dt,
        substeps: setup.substeps.unwrap_or(SUBSTEPS),
        sleeping: setup.sleeping,
    }))
}

impl Engine for Box2d {
    fn step(&mut self) {
        self.world.step(self.dt, self.substeps);
    }

    fn state(&self, body: usize) -> State {
        self.world.state(body).into()
    }

    fn body(&self, body: usize) -> Body {
        let [mass, inertia] = self.world.mass(body);
        Body { mass, inertia }
    }

    /// By the step's list of moves, which names the bodies awake: what rests stays where the caller has it.
    fn read_poses(&mut self) -> f64 {
        let mut sum = 0.0;
        for moved in self.world.moved() {
            let (p, q) = (moved.position, moved.rotation);
            self.poses[moved.body] = [p.x, p.y, q.x, q.y];
            sum += p.x + p.y;
        }
        sum
    }

    fn counters(&self) -> Counters {
        Counters {
            awake: self.world.awake(),
            touching: self.world.touching(),
        }
    }

    /// Box2D's own clock is one on the wall.
    fn profile(&mut self) -> Option<Vec<(&'static str, f64)>> {
        Some(self.world.stages().to_vec())
    }

    fn settings(&self) -> String {
        let s = self.world.settings();
        let lanes = if self.name == EngineName::Box2dAvx2 {
            8
        } else {
            4
        };
        let on = |x: bool| if x { "on" } else { "off" };
        let tuned = self.mode == Mode::Tuned;
        let speed = if tuned {
            "off".to_owned()
        } else {
            format!("{}m/s", s.maximum_speed)
        };
        format!(
            "version={} lanes={lanes} asserts={} substeps={} contact={}Hz damping={} push={}m/s \
             restitution_threshold={}m/s speed_cap={speed} rotation_cap={} recycling={:.3}m sleeping={} workers={} \
             welded_corners={}",
            version().replace(' ', "-"),
            on(has_asserts()),
            self.substeps,
            s.contact_hertz,
            s.damping_ratio,
            s.push_speed,
            s.restitution_threshold,
            on(!tuned),
            s.recycle_distance,
            on(self.sleeping),
            s.workers,
            s.welded_corners,
        )
    }
}
