//! Small worlds with an answer in closed form.

use carom_dynamics::{BodyDef, BodyId, Material, Settings, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Rot, Vec2, vec2};

use crate::clock::Clock;
use crate::exit::{Failure, fail};

/// Gravity of all cases, in m/s².
const G: f64 = 10.0;

/// One case: a world, how long it runs, and how far its end is from the closed form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    /// Simulated seconds.
    pub(super) seconds: u32,
    build: fn(Settings) -> Result<(World, BodyId), Failure>,
    error: fn(&Run) -> f64,
}

/// The end of a run.
#[derive(Clone, Copy, Debug)]
struct Run {
    time: f64,
    centre: Vec2,
    velocity: Vec2,
}

pub(super) const CASES: [Case; 3] = [
    Case {
        name: "projectile",
        about: "a disc thrown at (3, 5) m/s: place after 1 s",
        seconds: 1,
        build: projectile,
        error: projectile_error,
    },
    Case {
        name: "bounce",
        about: "an elastic disc dropped from 1 m: height of the tenth apex",
        seconds: 9,
        build: bounce,
        error: bounce_error,
    },
    Case {
        name: "slide",
        about: "a block on an incline of 20 degrees, friction 0.2: place after 2 s",
        seconds: 2,
        build: slide,
        error: slide_error,
    },
];

/// What one run of a case gave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    /// Distance from the closed form, in m.
    pub(super) error: f64,
    /// Fastest of the runs, in ms of a thread per simulated second.
    pub(super) milliseconds: f64,
}

impl Case {
    /// Runs the case with ticks of 1 / `rate` s, as often as fits into a tenth of a second, at least three times.
    pub(super) fn measure(&self, rate: u32) -> Result<Measured, Failure> {
        let mut fastest = f64::INFINITY;
        let all = Clock::start();
        let mut runs = 0;
        loop {
            let (seconds, run) = self.run(rate)?;
            fastest = fastest.min(seconds);
            runs += 1;
            if runs >= 3 && all.seconds() > 0.1 {
                return Ok(Measured {
                    error: (self.error)(&run),
                    milliseconds: 1e3 * fastest / f64::from(self.seconds),
                });
            }
        }
    }

    fn run(&self, rate: u32) -> Result<(f64, Run), Failure> {
        let dt = f64::from(rate).recip();
        let settings = Settings {
            gravity: vec2(0.0, -G),
            tick: dt,
            substep: dt / 4.0,
            sleep: None,
            ..Settings::default()
        };
        let (mut world, id) = (self.build)(settings)?;
        let clock = Clock::start();
        for _ in 0..self.seconds * rate {
            world.step(dt);
        }
        let seconds = clock.seconds();
        let Some(body) = world.body(id) else {
            fail!("{}: the body is gone", self.name)
        };
        let run = Run {
            time: world.time().as_secs(),
            centre: body.centre(),
            velocity: body.velocity(),
        };
        Ok((seconds, run))
    }
}

/// No floor: x = 3 t, y = 5 t − g t²/2.
fn projectile(settings: Settings) -> Result<(World, BodyId), Failure> {
    let mut world = World::new(settings)?;
    let start = BodyDef::dynamic().moving(vec2(3.0, 5.0));
    let id = world.insert(start, Circle::new(0.1)?, Material::default())?;
    Ok((world, id))
}

fn projectile_error(run: &Run) -> f64 {
    let t = run.time;
    (run.centre - vec2(3.0 * t, 5.0 * t - 0.5 * G * t * t)).length()
}

/// Height of the drop, in m, and radius of the disc.
const DROP: f64 = 1.0;
const RADIUS: f64 = 0.25;

fn bounce(settings: Settings) -> Result<(World, BodyId), Failure> {
    let elastic = Material {
        friction: 0.0,
        restitution: 1.0,
        ..Material::default()
    };
    let mut world = World::new(settings)?;
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    world.insert(floor, ConvexPolygon::rectangle(20.0, 2.0)?, elastic)?;
    let start = BodyDef::dynamic().at(vec2(0.0, RADIUS + DROP));
    let id = world.insert(start, Circle::new(RADIUS)?, elastic)?;
    Ok((world, id))
}

/// The tenth apex is at 20 √(2h/g) = 8.944 s; at 9 s the disc falls from it, and y + v²/2g is its height.
fn bounce_error(run: &Run) -> f64 {
    let apex = run.centre.y - RADIUS + run.velocity.y * run.velocity.y / (2.0 * G);
    (apex - DROP).abs()
}

const FRICTION: f64 = 0.2;
const SLOPE: f64 = 20.0; // degrees
const HALF: Vec2 = vec2(0.5, 0.25);

fn slide(settings: Settings) -> Result<(World, BodyId), Failure> {
    let rough = Material {
        friction: FRICTION,
        ..Material::default()
    };
    let mut world = World::new(settings)?;
    let slope = Rot::from_degrees(SLOPE);
    let incline = BodyDef::fixed()
        .at(slope * vec2(0.0, -1.0))
        .turned(slope.angle());
    world.insert(incline, ConvexPolygon::rectangle(400.0, 2.0)?, rough)?;
    let block = ConvexPolygon::rectangle(2.0 * HALF.x, 2.0 * HALF.y)?;
    let start = BodyDef::dynamic()
        .at(slope * vec2(0.0, HALF.y))
        .turned(slope.angle());
    let id = world.insert(start, block, rough)?;
    Ok((world, id))
}

/// Down the slope: s = g (sin θ − µ cos θ) t²/2.
fn slide_error(run: &Run) -> f64 {
    let slope = Rot::from_degrees(SLOPE);
    let travel = 0.5 * G * (slope.sin() - FRICTION * slope.cos()) * run.time * run.time;
    (run.centre - slope * vec2(-travel, HALF.y)).length()
}
