//! Box2D v3: `f32`, through the bindings of boxdd-sys.
//!
//! The safe crate boxdd resolves every identity through tables of its own on each read; a laboratory wants the engine's
//! own cost, so it calls the engine.

use std::cell::Cell;
use std::ffi::{CStr, c_char, c_int};
use std::ptr::without_provenance_mut;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use boxdd_sys::ffi;
use carom_math::{Vec2, trig, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainMaterial, PlainScene, PlainShape};

use crate::State;
use crate::checked::parts;

/// Worlds are slots of one global array, which creating and destroying them walk without a lock.
static SLOTS: Mutex<()> = Mutex::new(());

fn slots() -> MutexGuard<'static, ()> {
    SLOTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What a world is made with. `None`: Box2D's default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldDef {
    /// Uniform acceleration, in m/s².
    pub gravity: Vec2,
    /// Approach speed below which nothing bounces, in m/s.
    pub restitution_threshold: Option<f32>,
    /// Cap of every body's speed, in m/s.
    pub maximum_speed: Option<f32>,
    /// Motion under which a touching pair's contact points are used again, in m; 0: never.
    pub recycle_distance: Option<f32>,
    /// Whether bodies may turn by more than 45° a step.
    pub fast_rotation: bool,
    /// Whether bodies may fall asleep.
    pub sleeping: bool,
    /// Threads that work, the caller's among them; more than one start Box2D's own scheduler.
    pub workers: u32,
}

/// A world, destroyed when dropped.
#[derive(Debug)]
pub struct World {
    id: ffi::b2WorldId,
    bodies: Vec<Handle>,
    fast_rotation: bool,
    sleeping: bool,
    settings: Settings,
}

#[derive(Clone, Copy, Debug)]
struct Handle {
    id: ffi::b2BodyId,
    kind: PlainKind,
}

/// What a world was made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// In m/s.
    pub restitution_threshold: f32,
    /// In m/s.
    pub maximum_speed: f32,
    /// In m.
    pub recycle_distance: f32,
    /// Frequency of the contact springs, in Hz.
    pub contact_hertz: f32,
    /// Of the contact springs.
    pub damping_ratio: f32,
    /// Fastest push-out of an overlap, in m/s.
    pub push_speed: f32,
    /// Threads that work.
    pub workers: c_int,
    /// Corners that Box2D welded into neighbours or left out as collinear, over all polygons.
    pub welded_corners: usize,
}

/// Where a body's origin came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// In the order of adding.
    pub body: usize,
    /// Of its origin, in m.
    pub position: Vec2,
    /// Cosine and sine of its angle.
    pub rotation: Vec2,
}

impl World {
    /// A world without bodies; `None` if all 128 that Box2D has room for are in use.
    #[must_use]
    pub fn new(def: &WorldDef) -> Option<Self> {
        let _slots = slots();
        // SAFETY: fills a structure from constants.
        let mut raw = unsafe { ffi::b2DefaultWorldDef() };
        raw.gravity = narrow(def.gravity);
        raw.enableSleep = def.sleeping;
        raw.workerCount = c_int::try_from(def.workers).unwrap_or(c_int::MAX);
        if let Some(threshold) = def.restitution_threshold {
            raw.restitutionThreshold = threshold;
        }
        if let Some(speed) = def.maximum_speed {
            raw.maximumLinearSpeed = speed;
        }
        // SAFETY: the definition is Box2D's own but for finite numbers, and no other thread creates a world meanwhile.
        let id = unsafe { ffi::b2CreateWorld(&raw const raw) };
        if id.index1 == 0 {
            return None;
        }
        // SAFETY: the world was made above.
        let (recycle_distance, workers) = unsafe {
            if let Some(distance) = def.recycle_distance {
                ffi::b2World_SetContactRecycleDistance(id, distance);
            }
            (
                ffi::b2World_GetContactRecycleDistance(id),
                ffi::b2World_GetWorkerCount(id),
            )
        };
        Some(Self {
            id,
            bodies: Vec::new(),
            fast_rotation: def.fast_rotation,
            sleeping: def.sleeping,
            settings: Settings {
                restitution_threshold: raw.restitutionThreshold,
                maximum_speed: raw.maximumLinearSpeed,
                recycle_distance,
                contact_hertz: raw.contactHertz,
                damping_ratio: raw.contactDampingRatio,
                push_speed: raw.contactSpeed,
                workers,
                welded_corners: 0,
            },
        })
    }

    /// Adds a body of a scene, its numbers rounded to `f32`.
    ///
    /// # Errors
    /// If a number is out of range or Box2D refuses a hull: it welds corners closer than 2 cm.
    pub fn add(&mut self, scene: &PlainScene, body: &PlainBody) -> Result<(), String> {
        let (material, shapes) = parts(scene, body, 1e15)?;
        let solids: Vec<Solid> = shapes.into_iter().map(solid).collect::<Result<_, _>>()?;

        let (sine, cosine) = trig::sin_cos(body.angle);
        // SAFETY: fills a structure from constants.
        let mut def = unsafe { ffi::b2DefaultBodyDef() };
        def.type_ = match body.kind {
            PlainKind::Fixed => ffi::b2BodyType_b2_staticBody,
            PlainKind::Kinematic => ffi::b2BodyType_b2_kinematicBody,
            PlainKind::Dynamic => ffi::b2BodyType_b2_dynamicBody,
        };
        def.position = narrow(body.position);
        let rotation = narrow(vec2(cosine, sine));
        def.rotation = ffi::b2Rot {
            c: rotation.x,
            s: rotation.y,
        };
        def.linearVelocity = narrow(body.velocity);
        def.angularVelocity = single(body.spin);
        def.isAwake = !(body.asleep && self.sleeping);
        def.isBullet = body.bullet;
        def.allowFastRotation = self.fast_rotation;
        // The order of adding, so that move events can name the body; never used as an address.
        def.userData = without_provenance_mut(self.bodies.len());
        // SAFETY: the world lives, and the definition is Box2D's own but for finite numbers and a unit rotation.
        let id = unsafe { ffi::b2CreateBody(self.id, &raw const def) };

        for solid in &solids {
            solid.attach(id, material);
            self.settings.welded_corners += solid.welded();
        }
        self.bodies.push(Handle {
            id,
            kind: body.kind,
        });
        Ok(())
    }

    /// Advances by `dt`, in s, in so many sub-steps; does nothing if either is not above zero.
    pub fn step(&mut self, dt: f32, substeps: u32) {
        let substeps = c_int::try_from(substeps).unwrap_or(c_int::MAX);
        if !(dt > 0.0 && dt.is_finite() && substeps > 0) {
            return;
        }
        // SAFETY: the world lives, and nothing else steps or reads it.
        unsafe { ffi::b2World_Step(self.id, dt, substeps) }
    }

    /// Bodies so far.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there is no body yet.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// A body's state.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn state(&self, body: usize) -> State {
        let id = self.bodies[body].id;
        // SAFETY: the body lives as long as the world, which is not stepping.
        unsafe {
            let rotation = ffi::b2Body_GetRotation(id);
            State {
                centre: wide(ffi::b2Body_GetWorldCenter(id)),
                angle: trig::atan2(f64::from(rotation.s), f64::from(rotation.c)),
                velocity: wide(ffi::b2Body_GetLinearVelocity(id)),
                spin: f64::from(ffi::b2Body_GetAngularVelocity(id)),
            }
        }
    }

    /// Mass, in kg, and inertia about the centre of mass, in kg m²; 0 for a body that is not dynamic.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn mass(&self, body: usize) -> [f64; 2] {
        let id = self.bodies[body].id;
        // SAFETY: the body lives as long as the world.
        unsafe {
            [
                f64::from(ffi::b2Body_GetMass(id)),
                f64::from(ffi::b2Body_GetRotationalInertia(id)),
            ]
        }
    }

    /// The bodies that the last step moved: those awake.
    pub fn moved(&self) -> impl Iterator<Item = Moved> + '_ {
        // SAFETY: the world lives, and its list of events stays as it is until the next step or change, which want `&mut`.
        let events = unsafe {
            let events = ffi::b2World_GetBodyEvents(self.id);
            let count = usize::try_from(events.moveCount).unwrap_or(0);
            if events.moveEvents.is_null() {
                &[]
            } else {
                std::slice::from_raw_parts(events.moveEvents, count)
            }
        };
        events.iter().map(|event| Moved {
            body: event.userData.addr(),
            position: wide(event.transform.p),
            rotation: vec2(
                f64::from(event.transform.q.c),
                f64::from(event.transform.q.s),
            ),
        })
    }

    /// Seconds that disjoint stages of the last step took, by a clock on the wall; what Box2D does between them is in none.
    #[must_use]
    pub fn stages(&self) -> [(&'static str, f64); 9] {
        // SAFETY: the world lives and is not stepping.
        let ms = unsafe { ffi::b2World_GetProfile(self.id) };
        [
            ("pairs", ms.pairs),
            ("collide", ms.collide),
            ("solver setup", ms.solverSetup),
            ("constraints", ms.constraints),
            ("transforms", ms.transforms),
            ("refit", ms.refit),
            ("bullets", ms.bullets),
            ("sleep", ms.sleepIslands),
            ("sensors", ms.sensors),
        ]
        .map(|(name, ms)| (name, 1e-3 * f64::from(ms)))
    }

    /// Dynamic bodies awake.
    #[must_use]
    pub fn awake(&self) -> usize {
        let dynamic = self.bodies.iter().filter(|b| b.kind == PlainKind::Dynamic);
        // SAFETY: the bodies live as long as the world.
        dynamic
            .filter(|body| unsafe { ffi::b2Body_IsAwake(body.id) })
            .count()
    }

    /// Touching pairs of shapes, at least one awake: what the solver's graph holds.
    #[must_use]
    pub fn touching(&self) -> usize {
        // SAFETY: the world lives.
        let counters = unsafe { ffi::b2World_GetCounters(self.id) };
        let colours = counters.colorCounts.iter();
        colours.map(|n| usize::try_from(*n).unwrap_or(0)).sum()
    }

    /// What the world was made with.
    #[must_use]
    pub const fn settings(&self) -> Settings {
        self.settings
    }
}

impl Drop for World {
    fn drop(&mut self) {
        let _slots = slots();
        // SAFETY: the world lives until here, and no other thread creates or destroys one meanwhile.
        unsafe { ffi::b2DestroyWorld(self.id) }
    }
}

/// A shape in Box2D's form.
enum Solid {
    Circle(ffi::b2Circle),
    Polygon(ffi::b2Polygon, usize),
    Segment(ffi::b2Segment),
}

fn solid(shape: &PlainShape) -> Result<Solid, String> {
    Ok(match shape {
        PlainShape::Circle { radius } => Solid::Circle(ffi::b2Circle {
            center: ffi::b2Vec2 { x: 0.0, y: 0.0 },
            radius: single(*radius),
        }),
        PlainShape::Box { half, offset } => {
            let unturned = ffi::b2Rot { c: 1.0, s: 0.0 };
            let (half, centre) = (narrow(*half), narrow(*offset));
            // SAFETY: plain arithmetic on finite numbers.
            let polygon = unsafe { ffi::b2MakeOffsetBox(half.x, half.y, centre, unturned) };
            Solid::Polygon(polygon, 4)
        }
        PlainShape::Polygon(corners) => {
            let points: Vec<_> = corners.iter().copied().map(narrow).collect();
            let count = c_int::try_from(points.len()).unwrap_or(0);
            // SAFETY: `count` points are there, at most eight.
            let hull = unsafe { ffi::b2ComputeHull(points.as_ptr(), count) };
            if hull.count < 3 {
                return Err("hull refused: corners within 2 cm are one to it".to_owned());
            }
            // SAFETY: the hull is Box2D's own and not empty.
            Solid::Polygon(
                unsafe { ffi::b2MakePolygon(&raw const hull, 0.0) },
                corners.len(),
            )
        }
        PlainShape::Segment([a, b]) => Solid::Segment(ffi::b2Segment {
            point1: narrow(*a),
            point2: narrow(*b),
        }),
    })
}

impl Solid {
    fn attach(&self, body: ffi::b2BodyId, material: PlainMaterial) {
        // SAFETY: fills a structure from constants.
        let mut def = unsafe { ffi::b2DefaultShapeDef() };
        def.density = single(material.density);
        def.material.friction = single(material.friction);
        def.material.restitution = single(material.restitution);
        let def = &raw const def;
        // SAFETY: the body was just made, the definition is Box2D's own but for finite numbers, Box2D copies the shape.
        unsafe {
            match self {
                Self::Circle(circle) => ffi::b2CreateCircleShape(body, def, circle),
                Self::Polygon(polygon, _) => ffi::b2CreatePolygonShape(body, def, polygon),
                Self::Segment(segment) => ffi::b2CreateSegmentShape(body, def, segment),
            };
        }
    }

    fn welded(&self) -> usize {
        match self {
            Self::Polygon(polygon, given) => {
                given.saturating_sub(usize::try_from(polygon.count).unwrap_or(0))
            }
            _ => 0,
        }
    }
}

/// Box2D's version and the revision that was built.
#[must_use]
pub fn version() -> String {
    // SAFETY: returns a constant.
    let version = unsafe { ffi::b2GetVersion() };
    let revision = boxdd_sys::UPSTREAM_SHA.get(..8).unwrap_or_default();
    format!(
        "{}.{}.{} at {revision}",
        version.major, version.minor, version.revision
    )
}

thread_local! {
    static PROBING: Cell<bool> = const { Cell::new(false) };
    static FIRED: Cell<bool> = const { Cell::new(false) };
}

/// Whether Box2D was compiled with its asserts, as it is where `NDEBUG` was not defined.
#[must_use]
pub fn has_asserts() -> bool {
    static ANSWER: OnceLock<bool> = OnceLock::new();
    *ANSWER.get_or_init(|| {
        let empty = ffi::b2Hull {
            points: [ffi::b2Vec2 { x: 0.0, y: 0.0 }; 8],
            count: 0,
        };
        PROBING.set(true);
        // SAFETY: a polygon of an empty hull is a square, once the assert against it has been passed over.
        unsafe {
            ffi::b2SetAssertFcn(Some(on_assert));
            ffi::b2MakePolygon(&raw const empty, 0.0);
        }
        PROBING.set(false);
        FIRED.get()
    })
}

/// Passes over the assert of [`has_asserts`]; any other is told and, by the answer 1, ends the process.
unsafe extern "C" fn on_assert(
    condition: *const c_char,
    file: *const c_char,
    line: c_int,
) -> c_int {
    if PROBING.get() {
        FIRED.set(true);
        return 0;
    }
    // SAFETY: Box2D hands in literals.
    let (condition, file) = unsafe { (CStr::from_ptr(condition), CStr::from_ptr(file)) };
    eprintln!(
        "Box2D asserts {} ({}:{line})",
        condition.to_string_lossy(),
        file.to_string_lossy()
    );
    1
}

fn narrow(v: Vec2) -> ffi::b2Vec2 {
    ffi::b2Vec2 {
        x: single(v.x),
        y: single(v.y),
    }
}

fn wide(v: ffi::b2Vec2) -> Vec2 {
    vec2(f64::from(v.x), f64::from(v.y))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "Box2D computes in f32; the number was checked to be in its range"
)]
const fn single(x: f64) -> f32 {
    x as f32
}
