//! Random scripts over the public calls of a world, and the checks after each step. Equal seeds give equal scripts.
//!
//! ```sh
//! cargo run --release -p carom-tests --example calls -- --mode exact --first 1 --count 20000 --limit 2
//! ```

use core::sync::atomic::{AtomicBool, Ordering};

use carom_dynamics::{
    BodyDef, BodyId, BodyKind, Impulse, Material, Mode, Settings, Sleep, Softness, StepReport,
    World,
};
use carom_geometry::HalfPlane;
use carom_math::{SimTime, Vec2, vec2};

use crate::checks::{self, Closed, Fault, Moment, Standing};
use crate::draw::{self, Dice};

/// How a script ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// All laws held after each step; the hash of the state that was left.
    Passed(u64),
    /// It was told to stop.
    Stopped,
    /// What broke, in which call.
    Broke(usize, Fault),
}

/// Where a script plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Room {
    /// Four half-planes or blocks, gravity or none, some bodies fixed.
    Walled,
    /// Nothing but dynamic bodies and no gravity: momentum is kept.
    Free,
}

struct Script {
    world: World,
    dice: Dice,
    room: Room,
    ids: Vec<BodyId>,
    units: Units,
    /// What lengths are drawn by, in m.
    size: f64,
    /// The last step ended at an event.
    at_event: bool,
    /// Reports of steps and when they ended: a sub-step may have begun in any of the last tick.
    reports: Vec<(SimTime, StepReport)>,
    standing: Standing,
    /// The greatest energy so far, in J.
    greatest: f64,
}

/// Calls of a script.
const CALLS: usize = 60;

/// Plays a script; `stop` is asked before each call.
#[must_use]
pub fn play(mode: Mode, seed: u64, stop: &AtomicBool) -> End {
    let stock = Settings {
        mode,
        ..Settings::default()
    };
    let mut script = Script::new(stock, seed, Units::ONE);
    for call in 0..CALLS {
        if stop.load(Ordering::Relaxed) {
            return End::Stopped;
        }
        if let Err(fault) = script.call() {
            return End::Broke(call, fault);
        }
    }
    End::Passed(script.world.state_hash())
}

/// By what all lengths, times and densities of a script are multiplied.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// Of lengths.
    pub length: f64,
    /// Of times.
    pub time: f64,
    /// Of densities.
    pub density: f64,
}

impl Units {
    /// As they are.
    pub const ONE: Self = Self {
        length: 1.0,
        time: 1.0,
        density: 1.0,
    };

    fn speed(self) -> f64 {
        self.length / self.time
    }

    fn settings(self, stock: Settings) -> Settings {
        Settings {
            gravity: stock.gravity * (self.speed() / self.time),
            tick: stock.tick * self.time,
            substep: stock.substep * self.time,
            sleep: stock.sleep.map(|sleep| Sleep {
                speed: sleep.speed * self.speed(),
                time: sleep.time * self.time,
            }),
            contact: Softness {
                frequency: stock.contact.frequency / self.time,
                push_out: stock.contact.push_out * self.speed(),
                ..stock.contact
            },
            ..stock
        }
    }
}

/// Centres, velocities, angles and spins that a script ends with, in its units; numbers below the normal ones are 0.
#[must_use]
pub fn ends_in_units(mode: Mode, seed: u64, units: Units) -> Vec<[f64; 6]> {
    // An instant is a count of 1/64 s and a rest: where a sub-step is 1/512 s it is exact in all units.
    let stock = Settings {
        mode,
        tick: 1.0 / 64.0,
        substep: 1.0 / 512.0,
        ..Settings::default()
    };
    let mut script = Script::new(stock, seed, units);
    for _ in 0..CALLS {
        // What breaks a law breaks it in all units.
        let _ = script.call();
    }
    let bodies = script.world.bodies().map(|body| {
        let (centre, velocity) = (
            body.centre() / units.length,
            body.velocity() / units.speed(),
        );
        let (angle, spin) = (body.angle(), body.angular_velocity() * units.time);
        [centre.x, centre.y, velocity.x, velocity.y, angle, spin]
            .map(|x| if x.is_normal() { x } else { 0.0 })
    });
    bodies.collect()
}

impl Script {
    fn new(stock: Settings, seed: u64, units: Units) -> Self {
        let mut dice = Dice::new(seed);
        let room = [Room::Walled, Room::Walled, Room::Free][dice.below(3)];
        let size = if dice.chance(0.5) {
            1.0
        } else {
            dice.log(1e-3, 1e3)
        };
        let falls = room == Room::Walled && dice.chance(0.6);
        let settings = units.settings(Settings {
            gravity: if falls {
                vec2(0.0, -10.0 * size)
            } else {
                Vec2::ZERO
            },
            sleep: stock.sleep.filter(|_| dice.chance(0.7)),
            ..stock
        });
        let mut script = Self {
            world: World::new(settings).expect("valid settings"),
            dice,
            room,
            ids: Vec::new(),
            units,
            size: size * units.length,
            at_event: false,
            reports: Vec::new(),
            standing: Standing::default(),
            greatest: 0.0,
        };
        script.fill();
        script
    }

    /// Walls, and bodies in a grid so wide that none overlap.
    fn fill(&mut self) {
        let count = 1 + self.dice.below(12);
        let side = (count as f64).sqrt().ceil();
        let cell = 2.2 * self.size;
        let half = 0.5 * side * cell + self.dice.between(0.0, 2.0) * self.size;
        if self.room == Room::Walled {
            let material = self.material(1.0);
            let planes = self.dice.chance(0.5);
            for outward in [Vec2::Y, -Vec2::Y, Vec2::X, -Vec2::X] {
                let wall = if planes {
                    HalfPlane::new(-outward * half, outward)
                        .expect("a wall")
                        .into()
                } else {
                    draw::wall(outward, half, self.size)
                };
                self.world
                    .insert(BodyDef::fixed(), wall, material)
                    .expect("a wall");
            }
        }
        for k in 0..count {
            let row = (k as f64 / side).floor();
            let spot = vec2(k as f64 - row * side, row) - Vec2::splat(0.5 * (side - 1.0));
            self.insert(spot * cell);
        }
    }

    fn material(&mut self, density: f64) -> Material {
        let dice = &mut self.dice;
        Material {
            density: density * self.units.density,
            friction: [0.0, 0.5, dice.between(0.0, 1.2)][dice.below(3)],
            restitution: [0.0, 1.0, dice.between(0.0, 1.0)][dice.below(3)],
            ..Material::default()
        }
    }

    fn speed(&mut self) -> f64 {
        let fast = self.dice.chance(0.1);
        let most = if fast { 1e3 } else { 10.0 };
        self.dice.between(0.0, most) * self.size / self.units.time
    }

    fn insert(&mut self, at: Vec2) {
        let reach = self.size
            * if self.dice.chance(0.5) {
                1.0
            } else {
                self.dice.log(0.03, 1.0)
            };
        let shape = draw::shape(&mut self.dice, reach);
        let fixed = self.room == Room::Walled && self.dice.chance(0.1);
        let kind = if fixed {
            BodyKind::Fixed
        } else {
            BodyKind::Dynamic
        };
        let mut def = BodyDef::new(kind)
            .at(at)
            .turned(self.dice.between(-3.0, 3.0));
        if !fixed {
            let velocity = self.dice.inside(1.0) * self.speed();
            def = def
                .moving(velocity)
                .spinning(self.dice.between(-10.0, 10.0) / self.units.time);
        }
        // With sizes from 0.03 to 1, mass ratios go to some 1e6.
        let density = if self.dice.chance(0.5) {
            1.0
        } else {
            self.dice.log(0.03, 30.0)
        };
        let material = self.material(density);
        self.ids.push(
            self.world
                .insert(def, shape, material)
                .expect("a valid body"),
        );
    }

    fn id(&mut self) -> BodyId {
        self.ids[self.dice.below(self.ids.len())]
    }

    fn call(&mut self) -> Result<(), Fault> {
        Closed::of(&self.world).is_brought_in(&mut self.greatest)?;
        // What is removed or fixed in the midst of a sub-step or flight is where the books are thinnest.
        let often = if self.at_event { 3 } else { 1 };
        let kind = self.dice.below(16 + 2 * often);
        let id = self.id();
        match kind {
            0..12 => return self.step(),
            12 | 13 => {
                let velocity = self.dice.inside(1.0) * self.speed();
                let spin = self.dice.between(-20.0, 20.0) / self.units.time;
                // A stale id is refused.
                let _ = self.world.set_velocity(id, velocity, spin);
            }
            14 | 15 => {
                if let Some((centre, mass)) = self.place(id) {
                    let at = centre + self.dice.inside(self.size);
                    let push = self.dice.inside(1.0) * self.speed() * mass;
                    let _ = self.world.apply(id, Impulse::at(at, push));
                }
            }
            _ if kind.is_multiple_of(2) => {
                let _ = self.world.remove(id);
            }
            _ => {
                let fixed = self.room == Room::Walled && self.dice.chance(0.5);
                let kind = if fixed {
                    BodyKind::Fixed
                } else {
                    BodyKind::Dynamic
                };
                let _ = self.world.set_kind(id, kind);
            }
        }
        Ok(())
    }

    fn place(&self, id: BodyId) -> Option<(Vec2, f64)> {
        let body = self.world.body(id)?;
        body.mass()
            .is_finite()
            .then(|| (body.centre(), body.mass()))
    }

    fn step(&mut self) -> Result<(), Fault> {
        let parts = [1_u32, 1092, 16_384][self.dice.below(3)];
        let parts = if self.dice.chance(0.5) {
            u32::try_from(self.dice.below(8000)).expect("below 8000")
        } else {
            parts
        };
        let dt = f64::from(parts) / 65_536.0 * self.units.time;
        self.at_event = self.dice.chance(0.3);
        let tick = self.world.settings().tick;
        let since = self.world.time();
        self.reports.retain(|(end, _)| since - *end <= tick);
        let overlaps = checks::overlapping(&self.world);
        let (moment, energy) = (Moment::of(&self.world), Closed::of(&self.world));
        let now = if self.at_event {
            self.world.step_to_next_event(dt)
        } else {
            self.world.step(dt)
        };
        if !self.at_event && dt > 0.0 {
            self.standing.after(&self.world, &now)?;
        }
        self.reports.push((self.world.time(), now));
        let mut report = StepReport::default();
        for (_, part) in &self.reports {
            report += *part;
        }
        checks::places(&self.world, &overlaps, &report)?;
        if self.room == Room::Free {
            moment.kept(&Moment::of(&self.world), &report)?;
        }
        energy.fell(&self.world, &report)
    }
}
