//! The part of `chipmunk.h` that is used, by hand: version 7, `cpFloat` a double, and only what is a function there.

use std::ffi::{c_char, c_int, c_uint, c_void};
use std::marker::{PhantomData, PhantomPinned};

/// What only Chipmunk looks into; neither `Send` nor `Sync`.
type Opaque = PhantomData<(*mut u8, PhantomPinned)>;

#[repr(C)]
pub(super) struct Space {
    _bytes: [u8; 0],
    _opaque: Opaque,
}

#[repr(C)]
pub(super) struct Body {
    _bytes: [u8; 0],
    _opaque: Opaque,
}

#[repr(C)]
pub(super) struct Shape {
    _bytes: [u8; 0],
    _opaque: Opaque,
}

#[repr(C)]
pub(super) struct Arbiter {
    _bytes: [u8; 0],
    _opaque: Opaque,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub(super) struct Vect {
    pub(super) x: f64,
    pub(super) y: f64,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub(super) struct ShapeFilter {
    group: usize,
    categories: c_uint,
    mask: c_uint,
}

/// `CP_BODY_TYPE_DYNAMIC`.
pub(super) const DYNAMIC: c_int = 0;

/// Meets all but its own kind.
pub(super) const IMMOVABLE: ShapeFilter = ShapeFilter {
    group: 0,
    categories: 1,
    mask: !1,
};

pub(super) type ArbiterIterator = unsafe extern "C" fn(*mut Body, *mut Arbiter, *mut c_void);

unsafe extern "C" {
    pub(super) static cpVersionString: *const c_char;

    pub(super) fn fflush(stream: *mut c_void) -> c_int;

    pub(super) fn cpSpaceNew() -> *mut Space;
    pub(super) fn cpSpaceFree(space: *mut Space);
    pub(super) fn cpSpaceStep(space: *mut Space, dt: f64);
    pub(super) fn cpSpaceSetGravity(space: *mut Space, gravity: Vect);
    pub(super) fn cpSpaceSetIterations(space: *mut Space, iterations: c_int);
    pub(super) fn cpSpaceGetIterations(space: *const Space) -> c_int;
    pub(super) fn cpSpaceSetCollisionSlop(space: *mut Space, slop: f64);
    pub(super) fn cpSpaceGetCollisionSlop(space: *const Space) -> f64;
    pub(super) fn cpSpaceSetSleepTimeThreshold(space: *mut Space, time: f64);
    pub(super) fn cpSpaceAddBody(space: *mut Space, body: *mut Body) -> *mut Body;
    pub(super) fn cpSpaceAddShape(space: *mut Space, shape: *mut Shape) -> *mut Shape;

    pub(super) fn cpBodyNew(mass: f64, moment: f64) -> *mut Body;
    pub(super) fn cpBodyNewStatic() -> *mut Body;
    pub(super) fn cpBodyNewKinematic() -> *mut Body;
    pub(super) fn cpBodyFree(body: *mut Body);
    pub(super) fn cpBodySleep(body: *mut Body);
    pub(super) fn cpBodyIsSleeping(body: *const Body) -> u8;
    pub(super) fn cpBodyGetType(body: *mut Body) -> c_int;
    pub(super) fn cpBodySetPosition(body: *mut Body, position: Vect);
    pub(super) fn cpBodyGetPosition(body: *const Body) -> Vect;
    pub(super) fn cpBodySetAngle(body: *mut Body, angle: f64);
    pub(super) fn cpBodyGetAngle(body: *const Body) -> f64;
    pub(super) fn cpBodySetVelocity(body: *mut Body, velocity: Vect);
    pub(super) fn cpBodyGetVelocity(body: *const Body) -> Vect;
    pub(super) fn cpBodySetAngularVelocity(body: *mut Body, spin: f64);
    pub(super) fn cpBodyGetAngularVelocity(body: *const Body) -> f64;
    pub(super) fn cpBodyGetMass(body: *const Body) -> f64;
    pub(super) fn cpBodyGetMoment(body: *const Body) -> f64;
    pub(super) fn cpBodyGetCenterOfGravity(body: *const Body) -> Vect;
    pub(super) fn cpBodyLocalToWorld(body: *const Body, point: Vect) -> Vect;
    pub(super) fn cpBodyEachArbiter(body: *mut Body, visit: ArbiterIterator, data: *mut c_void);
    pub(super) fn cpArbiterGetBodies(arbiter: *const Arbiter, a: *mut *mut Body, b: *mut *mut Body);

    pub(super) fn cpCircleShapeNew(body: *mut Body, radius: f64, offset: Vect) -> *mut Shape;
    pub(super) fn cpSegmentShapeNew(body: *mut Body, a: Vect, b: Vect, radius: f64) -> *mut Shape;
    pub(super) fn cpPolyShapeNewRaw(
        body: *mut Body,
        count: c_int,
        corners: *const Vect,
        radius: f64,
    ) -> *mut Shape;
    pub(super) fn cpShapeFree(shape: *mut Shape);
    pub(super) fn cpShapeSetFriction(shape: *mut Shape, friction: f64);
    pub(super) fn cpShapeSetElasticity(shape: *mut Shape, elasticity: f64);
    pub(super) fn cpShapeSetDensity(shape: *mut Shape, density: f64);
    pub(super) fn cpShapeSetFilter(shape: *mut Shape, filter: ShapeFilter);
}

#[cfg(chipmunk_threads)]
unsafe extern "C" {
    pub(super) fn cpHastySpaceNew() -> *mut Space;
    pub(super) fn cpHastySpaceFree(space: *mut Space);
    pub(super) fn cpHastySpaceSetThreads(space: *mut Space, threads: std::ffi::c_ulong);
    pub(super) fn cpHastySpaceStep(space: *mut Space, dt: f64);
}
