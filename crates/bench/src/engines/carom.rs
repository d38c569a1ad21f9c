//! carom itself.

use carom_dynamics::{BodyDef, BodyId, BodyKind, Material, Settings, Sleep, World};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Segment, Shape};
use carom_math::{Pose, Vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use crate::clock::CpuClock;
use crate::engine::{Body, Counters, Engine, EngineError, Mode, Setup, State};

struct Carom {
    world: World,
    dt: f64,
    ids: Vec<BodyId>,
    poses: Vec<Pose>,
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
    let mut ids = Vec::with_capacity(scene.bodies.len());
    for (index, body) in scene.bodies.iter().enumerate() {
        let id = insert(&mut world, scene, body).map_err(|reason| EngineError::Body {
            engine: "carom".to_owned(),
            body: index,
            reason,
        })?;
        ids.push(id);
    }
    Ok(Box::new(Carom {
        world,
        dt: setup.hz.recip(),
        ids,
        poses: Vec::new(),
    }))
}

/// A tick is a step; the default keeps carom's own number of sub-steps in it.
fn settings(scene: &PlainScene, setup: &Setup) -> Settings {
    let default = Settings::default();
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
            Mode::Stepped => carom_dynamics::Mode::Stepped,
            _ => carom_dynamics::Mode::Hybrid,
        },
        sleep: setup.sleeping.then(Sleep::default),
        ..default
    }
}

fn insert(world: &mut World, scene: &PlainScene, body: &PlainBody) -> Result<BodyId, String> {
    let kind = match body.kind {
        PlainKind::Fixed => BodyKind::Fixed,
        PlainKind::Dynamic => BodyKind::Dynamic,
        PlainKind::Kinematic => BodyKind::Kinematic,
    };
    let made_of = scene.materials[body.material];
    let material = Material {
        density: made_of.density,
        friction: made_of.friction,
        restitution: made_of.restitution,
    };
    let def = BodyDef::new(kind)
        .at(body.position)
        .turned(body.angle)
        .moving(body.velocity)
        .spinning(body.spin);
    let shapes = solids(scene, body)?.into_iter();
    world
        .insert_compound(def, shapes.map(|shape| (shape, material)).collect())
        .map_err(|error| error.to_string())
}

/// The outline where there is one, else the shapes.
fn solids(scene: &PlainScene, body: &PlainBody) -> Result<Vec<Shape>, String> {
    if let Some(outline) = body.outline {
        let polygon =
            Polygon::new(scene.outlines[outline].clone()).map_err(|error| error.to_string())?;
        return Ok(vec![polygon.into()]);
    }
    let shapes = body.shapes.iter().map(|index| solid(&scene.shapes[*index]));
    shapes.collect()
}

fn solid(shape: &PlainShape) -> Result<Shape, String> {
    match shape {
        PlainShape::Circle { radius } => Circle::new(*radius)
            .map(Shape::from)
            .map_err(|error| error.to_string()),
        PlainShape::Box { half, offset } => ConvexPolygon::rectangle(2.0 * half.x, 2.0 * half.y)
            .map(|rectangle| rectangle.translated(*offset).into())
            .map_err(|error| error.to_string()),
        PlainShape::Polygon(corners) => ConvexPolygon::new(corners.clone())
            .map(Shape::from)
            .map_err(|error| error.to_string()),
        PlainShape::Segment([a, b]) => Segment::new(*a, *b)
            .map(Shape::from)
            .map_err(|error| error.to_string()),
    }
}

impl Engine for Carom {
    fn step(&mut self) {
        let _ = self.world.step(self.dt);
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
        Body {
            mass: body.mass(),
            inertia: body.inertia(),
        }
    }

    fn read_poses(&mut self) -> f64 {
        self.poses.clear();
        self.world.poses_into(&mut self.poses);
        let sum: Vec2 = self.poses.iter().map(|pose| pose.position).sum();
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

    fn profile(&mut self) -> Option<Vec<(&'static str, f64)>> {
        self.world
            .set_stopwatch(Some(|| CpuClock::thread().seconds()));
        Some(self.world.profile().stages().to_vec())
    }

    fn settings(&self) -> String {
        let settings = self.world.settings();
        format!(
            "tick={} substep={} mode={:?}",
            settings.tick, settings.substep, settings.mode
        )
    }
}
