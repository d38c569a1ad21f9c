//! A world of Rapier; what differs between the precisions is in the parent: `library`, `narrow`, `widen`, `LANES`.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use super::library::prelude::{
    ColliderBuilder, PhysicsWorld, Real, RigidBody, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use super::{LANES, narrow, widen};
use crate::engine::{Body, Counters, Engine, EngineError, Mode, Setup, State};

struct Rapier {
    world: PhysicsWorld,
    /// In the scene's order.
    handles: Vec<RigidBodyHandle>,
}

pub(super) fn open(
    name: &str,
    scene: &PlainScene,
    setup: &Setup,
) -> Result<Box<dyn Engine>, EngineError> {
    let mut world = PhysicsWorld::new();
    world.gravity = vector(scene.gravity);
    set(&mut world, setup);
    set_threads(name, &mut world, setup.threads)?;
    let mut handles = Vec::with_capacity(scene.bodies.len());
    for (index, body) in scene.bodies.iter().enumerate() {
        let handle = insert(&mut world, scene, body, setup).ok_or_else(|| EngineError::Body {
            engine: name.to_owned(),
            body: index,
            reason: "its corners make no convex polygon".to_owned(),
        })?;
        handles.push(handle);
    }
    Ok(Box::new(Rapier { world, handles }))
}

/// Stock: nothing but the step. Tuned: no speed cap, and no contact is used again; see [`insert`] for the rotation cap.
fn set(world: &mut PhysicsWorld, setup: &Setup) {
    let parameters = &mut world.integration_parameters;
    parameters.dt = narrow(setup.hz.recip());
    if let Some(substeps) = setup.substeps {
        parameters.num_solver_iterations = substeps as usize;
    }
    if setup.mode == Mode::Tuned {
        parameters.normalized_max_linear_velocity = Real::MAX;
        parameters.contact_recycling = false;
    }
}

#[cfg(feature = "rapier-parallel")]
fn set_threads(name: &str, world: &mut PhysicsWorld, threads: u32) -> Result<(), EngineError> {
    world
        .physics_pipeline
        .configure_thread_pool(threads as usize)
        .map_err(|error| EngineError::Settings {
            engine: name.to_owned(),
            reason: error.to_string(),
        })
}

#[cfg(not(feature = "rapier-parallel"))]
fn set_threads(name: &str, _: &mut PhysicsWorld, threads: u32) -> Result<(), EngineError> {
    if threads == 1 {
        return Ok(());
    }
    Err(EngineError::Threads {
        engine: name.to_owned(),
        threads,
    })
}

/// `None` if one of its polygons is refused.
fn insert(
    world: &mut PhysicsWorld,
    scene: &PlainScene,
    body: &PlainBody,
    setup: &Setup,
) -> Option<RigidBodyHandle> {
    let made = match body.kind {
        PlainKind::Fixed => RigidBodyBuilder::fixed(),
        PlainKind::Dynamic => RigidBodyBuilder::dynamic(),
        PlainKind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
    };
    let made = made
        .translation(vector(body.position))
        .rotation(narrow(body.angle))
        .linvel(vector(body.velocity))
        .angvel(narrow(body.spin))
        .can_sleep(setup.sleeping)
        .sleeping(body.asleep)
        .ccd_enabled(body.bullet)
        .allow_fast_rotation(setup.mode == Mode::Tuned);
    let handle = world.insert_body(made);
    let material = scene.materials[body.material];
    for &shape in &body.shapes {
        let collider = collider(&scene.shapes[shape])?
            .density(narrow(material.density))
            .friction(narrow(material.friction))
            .restitution(narrow(material.restitution));
        world.insert_collider(collider, Some(handle));
    }
    Some(handle)
}

fn collider(shape: &PlainShape) -> Option<ColliderBuilder> {
    Some(match shape {
        PlainShape::Circle { radius } => ColliderBuilder::ball(narrow(*radius)),
        PlainShape::Box { half, offset } => {
            ColliderBuilder::cuboid(narrow(half.x), narrow(half.y)).translation(vector(*offset))
        }
        PlainShape::Polygon(corners) => {
            let corners = corners.iter().map(|&corner| vector(corner));
            ColliderBuilder::convex_polyline(corners.collect())?
        }
        PlainShape::Segment([a, b]) => ColliderBuilder::segment(vector(*a), vector(*b)),
    })
}

fn vector(v: Vec2) -> Vector {
    Vector::new(narrow(v.x), narrow(v.y))
}

impl Rapier {
    fn get(&self, body: usize) -> &RigidBody {
        &self.world.bodies[self.handles[body]]
    }
}

impl Engine for Rapier {
    fn step(&mut self) {
        self.world.step();
    }

    fn state(&self, body: usize) -> State {
        let body = self.get(body);
        // Not `center_of_mass`, which is as old as the last step's beginning.
        let centre = body.position() * body.local_center_of_mass();
        let velocity = body.linvel();
        State {
            position: vec2(widen(centre.x), widen(centre.y)),
            angle: widen(body.rotation().angle()),
            velocity: vec2(widen(velocity.x), widen(velocity.y)),
            spin: widen(body.angvel()),
        }
    }

    fn body(&self, body: usize) -> Body {
        let body = self.get(body);
        if !body.is_dynamic() {
            return Body::default();
        }
        Body {
            mass: widen(body.mass()),
            inertia: widen(body.mass_properties().local_mprops.principal_inertia()),
        }
    }

    fn read_poses(&mut self) -> f64 {
        let poses = self.world.bodies.iter().map(|(_, body)| body.position());
        let sum: Real = poses
            .map(|pose| pose.translation.x + pose.translation.y + pose.rotation.re)
            .sum();
        widen(sum)
    }

    fn counters(&self) -> Counters {
        let bodies = &self.world.bodies;
        let awake = self.world.islands.active_bodies();
        let pairs = self.world.narrow_phase.contact_pairs();
        Counters {
            awake: awake.filter(|&body| bodies[body].is_dynamic()).count(),
            touching: pairs.filter(|pair| pair.has_any_active_contact()).count(),
        }
    }

    fn settings(&self) -> String {
        let set = &self.world.integration_parameters;
        let (_, body) = self.world.bodies.iter().next().unzip();
        format!(
            "lanes={LANES} iterations={} recycling={} max_speed={:e} fast_rotation={} slop={} push_out={}",
            set.num_solver_iterations,
            set.contact_recycling,
            set.max_linear_velocity(),
            body.is_some_and(RigidBody::is_fast_rotation_allowed),
            set.allowed_linear_error(),
            set.max_corrective_velocity(),
        )
    }
}
