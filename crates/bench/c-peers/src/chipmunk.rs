//! Chipmunk 7: `f64`.

use std::ffi::{CStr, c_int, c_void};
use std::ptr::{NonNull, null_mut};
use std::sync::Once;

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainMaterial, PlainScene, PlainShape};

use crate::State;
use crate::checked::parts;
use crate::chipmunk::sys::{Arbiter, Space, Vect};

mod sys;

/// What a world is made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldDef {
    /// Uniform acceleration, in m/s².
    pub gravity: Vec2,
    /// Solver iterations a step; `None`: Chipmunk's default.
    pub iterations: Option<u32>,
    /// Overlap that is left alone, in m; `None`: Chipmunk's default.
    pub slop: Option<f64>,
    /// How long a body must rest before it sleeps, in s; `None`: bodies never sleep.
    pub sleep_after: Option<f64>,
    /// Threads that work: 1, or 2 where [`HAS_THREADS`].
    pub threads: u32,
}

/// Whether the library was compiled with its asserts, as Debian's is.
pub const HAS_ASSERTS: bool = cfg!(chipmunk_asserts);

/// Whether the library has the space that steps on two threads.
pub const HAS_THREADS: bool = cfg!(chipmunk_threads);

/// A world, freed when dropped.
#[derive(Debug)]
pub struct World {
    space: NonNull<Space>,
    hasty: bool,
    bodies: Vec<Handle>,
    shapes: Vec<NonNull<sys::Shape>>,
    sleeps: bool,
}

#[derive(Clone, Copy, Debug)]
struct Handle {
    body: NonNull<sys::Body>,
    kind: PlainKind,
}

impl World {
    /// A world without bodies; `None` if the library has no such number of threads or no memory.
    #[must_use]
    pub fn new(def: &WorldDef) -> Option<Self> {
        static GREETING: Once = Once::new();
        GREETING.call_once(greet);
        let hasty = def.threads != 1;
        let space = NonNull::new(match def.threads {
            // SAFETY: allocates; nothing else is asked.
            1 => unsafe { sys::cpSpaceNew() },
            #[cfg(chipmunk_threads)]
            // SAFETY: as above; threads are set once, before the first step.
            2 => unsafe {
                let space = sys::cpHastySpaceNew();
                if !space.is_null() {
                    sys::cpHastySpaceSetThreads(space, 2);
                }
                space
            },
            _ => null_mut(),
        })?;
        // SAFETY: the space was made above.
        unsafe {
            let space = space.as_ptr();
            sys::cpSpaceSetGravity(space, vect(def.gravity));
            if let Some(iterations) = def.iterations {
                let iterations = c_int::try_from(iterations).unwrap_or(c_int::MAX).max(1);
                sys::cpSpaceSetIterations(space, iterations);
            }
            if let Some(slop) = def.slop {
                sys::cpSpaceSetCollisionSlop(space, slop);
            }
            if let Some(time) = def.sleep_after {
                sys::cpSpaceSetSleepTimeThreshold(space, time);
            }
        }
        Some(Self {
            space,
            hasty,
            bodies: Vec::new(),
            shapes: Vec::new(),
            sleeps: def.sleep_after.is_some_and(f64::is_finite),
        })
    }

    /// Adds a body of a scene; sets it asleep if it is to start so and bodies may sleep.
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn add(&mut self, scene: &PlainScene, body: &PlainBody) -> Result<(), String> {
        let (material, shapes) = parts(scene, body, 1e150)?;
        // SAFETY: the space lives; body and shapes are new, finite, and freed after the space.
        unsafe {
            let raw = NonNull::new(match body.kind {
                PlainKind::Fixed => sys::cpBodyNewStatic(),
                PlainKind::Kinematic => sys::cpBodyNewKinematic(),
                // The shapes bring mass and inertia.
                PlainKind::Dynamic => sys::cpBodyNew(0.0, 0.0),
            })
            .ok_or("no memory")?;
            self.bodies.push(Handle {
                body: raw,
                kind: body.kind,
            });
            sys::cpBodySetPosition(raw.as_ptr(), vect(body.position));
            sys::cpBodySetAngle(raw.as_ptr(), body.angle);
            sys::cpSpaceAddBody(self.space.as_ptr(), raw.as_ptr());
            for shape in shapes {
                self.attach(raw, body.kind, shape, material)?;
            }
            if body.kind != PlainKind::Fixed {
                sys::cpBodySetVelocity(raw.as_ptr(), vect(body.velocity));
                sys::cpBodySetAngularVelocity(raw.as_ptr(), body.spin);
            }
            if body.asleep && self.sleeps && body.kind == PlainKind::Dynamic {
                sys::cpBodySleep(raw.as_ptr());
            }
        }
        Ok(())
    }

    /// # Safety
    /// The body is of this world, the shape's numbers are finite.
    unsafe fn attach(
        &mut self,
        body: NonNull<sys::Body>,
        kind: PlainKind,
        shape: &PlainShape,
        material: PlainMaterial,
    ) -> Result<(), String> {
        let body = body.as_ptr();
        // SAFETY: as promised by the caller; Chipmunk copies the corners.
        unsafe {
            let raw = match shape {
                PlainShape::Circle { radius } => {
                    sys::cpCircleShapeNew(body, *radius, vect(Vec2::ZERO))
                }
                PlainShape::Box { half, offset } => {
                    let corners = [(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)]
                        .map(|(x, y)| vect(*offset + vec2(x * half.x, y * half.y)));
                    sys::cpPolyShapeNewRaw(body, 4, corners.as_ptr(), 0.0)
                }
                PlainShape::Polygon(corners) => {
                    let corners: Vec<Vect> = corners.iter().copied().map(vect).collect();
                    let count = c_int::try_from(corners.len()).unwrap_or(0);
                    sys::cpPolyShapeNewRaw(body, count, corners.as_ptr(), 0.0)
                }
                PlainShape::Segment([a, b]) => {
                    sys::cpSegmentShapeNew(body, vect(*a), vect(*b), 0.0)
                }
            };
            let raw = NonNull::new(raw).ok_or("no memory")?;
            self.shapes.push(raw);
            // Of a pair's numbers Chipmunk takes the product.
            sys::cpShapeSetFriction(raw.as_ptr(), material.friction.sqrt());
            sys::cpShapeSetElasticity(raw.as_ptr(), material.restitution.sqrt());
            if kind == PlainKind::Dynamic {
                sys::cpShapeSetDensity(raw.as_ptr(), material.density);
            } else {
                // Two bodies without inverse mass have no solvable contact; the library asserts that they have none.
                sys::cpShapeSetFilter(raw.as_ptr(), sys::IMMOVABLE);
            }
            sys::cpSpaceAddShape(self.space.as_ptr(), raw.as_ptr());
        }
        Ok(())
    }

    /// Advances by `dt`, in s; does nothing if it is not above zero.
    pub fn step(&mut self, dt: f64) {
        if !(dt > 0.0 && dt.is_finite()) {
            return;
        }
        let space = self.space.as_ptr();
        // SAFETY: the space lives, and is stepped by the function of its kind.
        unsafe {
            match self.hasty {
                #[cfg(chipmunk_threads)]
                true => sys::cpHastySpaceStep(space, dt),
                _ => sys::cpSpaceStep(space, dt),
            }
        }
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
        let body = self.bodies[body].body.as_ptr();
        // SAFETY: the body lives as long as the world, which is not stepping.
        unsafe {
            let centre = sys::cpBodyLocalToWorld(body, sys::cpBodyGetCenterOfGravity(body));
            State {
                centre: vector(centre),
                angle: sys::cpBodyGetAngle(body),
                velocity: vector(sys::cpBodyGetVelocity(body)),
                spin: sys::cpBodyGetAngularVelocity(body),
            }
        }
    }

    /// Position of a body's origin, in m, and its angle, in rad.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn pose(&self, body: usize) -> (Vec2, f64) {
        let body = self.bodies[body].body.as_ptr();
        // SAFETY: the body lives as long as the world.
        unsafe {
            (
                vector(sys::cpBodyGetPosition(body)),
                sys::cpBodyGetAngle(body),
            )
        }
    }

    /// Mass, in kg, and inertia about the centre of mass, in kg m²; 0 for a body that is not dynamic.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn mass(&self, body: usize) -> [f64; 2] {
        let handle = self.bodies[body];
        if handle.kind != PlainKind::Dynamic {
            return [0.0; 2];
        }
        let body = handle.body.as_ptr();
        // SAFETY: the body lives as long as the world.
        unsafe { [sys::cpBodyGetMass(body), sys::cpBodyGetMoment(body)] }
    }

    /// Dynamic bodies awake.
    #[must_use]
    pub fn awake(&self) -> usize {
        self.awake_bodies().count()
    }

    fn awake_bodies(&self) -> impl Iterator<Item = Handle> + '_ {
        let dynamic = self.bodies.iter().filter(|b| b.kind == PlainKind::Dynamic);
        // SAFETY: the bodies live as long as the world.
        let awake =
            dynamic.filter(|handle| unsafe { sys::cpBodyIsSleeping(handle.body.as_ptr()) == 0 });
        awake.copied()
    }

    /// Touching pairs of shapes, at least one awake: Chipmunk's arbiters.
    #[must_use]
    pub fn touching(&self) -> usize {
        let mut halves: usize = 0;
        for handle in self.awake_bodies() {
            // SAFETY: the body lives, the callback gets the counter that outlives the call.
            unsafe {
                sys::cpBodyEachArbiter(
                    handle.body.as_ptr(),
                    count_halves,
                    (&raw mut halves).cast::<c_void>(),
                );
            }
        }
        halves / 2
    }

    /// Overlap that is left alone, in m.
    #[must_use]
    pub fn slop(&self) -> f64 {
        // SAFETY: the space lives.
        unsafe { sys::cpSpaceGetCollisionSlop(self.space.as_ptr()) }
    }

    /// Solver iterations a step.
    #[must_use]
    pub fn iterations(&self) -> c_int {
        // SAFETY: the space lives.
        unsafe { sys::cpSpaceGetIterations(self.space.as_ptr()) }
    }

    /// Threads that work.
    #[must_use]
    pub const fn threads(&self) -> u32 {
        if self.hasty { 2 } else { 1 }
    }
}

/// Makes a first space with standard output going where errors go.
///
/// A debug build prints a greeting there, once, which is no part of an answer read from standard output.
fn greet() {
    let Ok(kept) = rustix::io::dup(rustix::stdio::stdout()) else {
        return;
    };
    if rustix::stdio::dup2_stdout(rustix::stdio::stderr()).is_err() {
        return;
    }
    // SAFETY: a space without bodies is made and freed; null asks C's library to flush all of its streams.
    unsafe {
        sys::cpSpaceFree(sys::cpSpaceNew());
        sys::fflush(null_mut());
    }
    // It was standard output a moment ago.
    let _ = rustix::stdio::dup2_stdout(kept);
}

/// A pair of two dynamic bodies is met twice, one with a wall once.
unsafe extern "C" fn count_halves(_: *mut sys::Body, arbiter: *mut Arbiter, halves: *mut c_void) {
    let (mut a, mut b) = (null_mut(), null_mut());
    // SAFETY: Chipmunk calls with an arbiter of its own and with the counter of `touching`.
    unsafe {
        sys::cpArbiterGetBodies(arbiter, &raw mut a, &raw mut b);
        let both = sys::cpBodyGetType(a) == sys::DYNAMIC && sys::cpBodyGetType(b) == sys::DYNAMIC;
        *halves.cast::<usize>() += if both { 1 } else { 2 };
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: each was made once and is freed once. The space goes first: it wakes its bodies on the way.
        unsafe {
            match self.hasty {
                #[cfg(chipmunk_threads)]
                true => sys::cpHastySpaceFree(self.space.as_ptr()),
                _ => sys::cpSpaceFree(self.space.as_ptr()),
            }
            for shape in &self.shapes {
                sys::cpShapeFree(shape.as_ptr());
            }
            for handle in &self.bodies {
                sys::cpBodyFree(handle.body.as_ptr());
            }
        }
    }
}

/// The library's version.
#[must_use]
pub fn version() -> String {
    // SAFETY: a constant string of the library.
    let version = unsafe { CStr::from_ptr(sys::cpVersionString) };
    version.to_string_lossy().into_owned()
}

const fn vect(v: Vec2) -> Vect {
    Vect { x: v.x, y: v.y }
}

const fn vector(v: Vect) -> Vec2 {
    vec2(v.x, v.y)
}
