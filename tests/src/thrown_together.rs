//! Random worlds in which bodies are put into each other: what overlaps must be told, and come out.
//!
//! Of 2,000 worlds a mode no step that is called exact leaves more than 0.03 mm untold, of bodies that landed in the engine; others leave
//! more than 2 cm in 1 (hybrid, exact) and 4 (stepped): arms of stars slide into each other across cuts.
//!
//! ```sh
//! cargo run --release -p carom-tests --example overlaps -- --count 2000
//! ```

use carom_dynamics::{BodyDef, BodyId, BodyKind, Mode, Settings, World};
use carom_geometry::{HalfPlane, Polygon, Shape};
use carom_math::{Pose, Rot, Vec2};

use crate::checks::overlapping;
use crate::draw::{self, Dice};
use crate::scenes::{block, put, surface};

/// Half a side of the box, in m.
const HALF: f64 = 4.0;

/// Steps of a run.
const STEPS: usize = 90;

/// Two bodies that overlap by more than their step told.
#[derive(Clone, Copy, Debug)]
pub struct Untold {
    /// The step, from 0.
    pub step: usize,
    /// Both of them.
    pub bodies: (BodyId, BodyId),
    /// How deep they are, in m.
    pub depth: f64,
    /// How deep anything was told to be, in m.
    pub told: f64,
    /// The step was called exact.
    pub exact: bool,
}

/// A ring of corners at random distances, or any shape.
fn shape(dice: &mut Dice, reach: f64) -> Shape {
    if dice.chance(0.6) {
        return draw::shape(dice, reach);
    }
    loop {
        let count = 4 + dice.below(14);
        let corner = |k: usize| {
            let along = Rot::from_angle(core::f64::consts::TAU * k as f64 / count as f64) * Vec2::X;
            along * (reach * dice.between(0.2, 1.0))
        };
        if let Ok(ring) = Polygon::new((0..count).map(corner).collect::<Vec<_>>()) {
            return ring.into();
        }
    }
}

/// Plays a world, and calls `found` with all that was not told.
///
/// # Panics
/// If a body or a step is refused.
pub fn watch(mode: Mode, seed: u64, mut found: impl FnMut(Untold)) {
    let mut dice = Dice::new(seed);
    let falls = dice.chance(0.7);
    let settings = Settings {
        mode,
        gravity: if falls { Vec2::Y * -10.0 } else { Vec2::ZERO },
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let dough = surface(
        [0.0, 0.3, 0.9][dice.below(3)],
        [0.0, 0.5, 1.0][dice.below(3)],
    );
    for inward in [Vec2::X, -Vec2::X, Vec2::Y, -Vec2::Y] {
        let wall = HalfPlane::new(inward * -HALF, inward).expect("a wall");
        put(&mut world, BodyDef::fixed(), wall, dough);
    }
    let speed = [0.0, 1.0, 5.0][dice.below(3)];
    let mut ids = Vec::new();
    if dice.chance(0.3) {
        let plate = BodyDef::new(BodyKind::Kinematic)
            .at(dice.inside(2.0))
            .moving(dice.inside(0.5))
            .spinning(dice.between(-2.0, 2.0));
        ids.push(put(&mut world, plate, block(2.0, 0.2), dough));
    }
    for _ in 0..1 + dice.below(14) {
        let reach = dice.between(0.15, 0.5);
        let body = BodyDef::dynamic()
            .at(dice.inside(HALF - 0.7))
            .turned(dice.between(-3.0, 3.0))
            .moving(dice.inside(speed))
            .spinning(dice.between(-3.0, 3.0) * speed);
        let shape = shape(&mut dice, reach);
        ids.push(put(&mut world, body, shape, dough));
    }
    for step in 0..STEPS {
        if dice.chance(0.05) {
            let place = Pose::new(
                dice.inside(HALF - 0.7),
                Rot::from_angle(dice.between(-3.0, 3.0)),
            );
            let id = ids[dice.below(ids.len())];
            world.teleport(id, place).expect("it is there");
        }
        let report = world.step(1.0 / 60.0);
        assert_eq!(report.refused, None, "seed {seed}");
        for (a, b, depth) in overlapping(&world) {
            if depth > report.deepest_overlap {
                found(Untold {
                    step,
                    bodies: (a, b),
                    depth,
                    told: report.deepest_overlap,
                    exact: report.is_exact(),
                });
            }
        }
    }
}
