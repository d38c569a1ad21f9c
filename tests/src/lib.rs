//! Shared helpers of the integration tests.

use core::ops::Range;
use std::error::Error;
use std::process::ExitCode;

use carom_dynamics::{BodyKind, Material, Mode, World};

pub mod boxes;
pub mod checks;
mod draw;
pub mod flights;
pub mod gas;
pub mod scenes;
pub mod scripts;
pub mod thrown_together;

use checks::depth;

/// Steps `world` at 60 Hz until `seconds` more have passed and calls `look` after every step.
///
/// # Panics
/// If the world refuses a step.
pub fn run(world: &mut World, seconds: f64, mut look: impl FnMut(&World)) {
    let end = world.time() + (seconds - 0.5 / 60.0);
    while world.time() < end {
        let report = world.step(1.0 / 60.0);
        assert_eq!(report.refused, None);
        look(world);
    }
}

/// How a program ends that plays many runs: 0 if all are sound, 1 if some are not, 2 with one line if it cannot play them.
#[must_use]
pub fn exit(all_sound: Result<bool, Box<dyn Error>>) -> ExitCode {
    match all_sound {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Which runs an example plays: `--mode`, if not all, `--first` seed and `--count` of seeds.
#[derive(Clone, Debug)]
pub struct Runs {
    modes: Vec<Mode>,
    first: u64,
    /// How many seeds.
    pub count: u64,
}

impl Runs {
    /// So many seeds from 1 on, in each mode.
    #[must_use]
    pub const fn new(count: u64) -> Self {
        Self {
            modes: Vec::new(),
            first: 1,
            count,
        }
    }

    /// Takes an option; whether it is one of these.
    ///
    /// # Errors
    /// It is, and this is no value for it.
    pub fn set(&mut self, name: &str, value: &str) -> Result<bool, Box<dyn Error>> {
        match name {
            "--mode" => self.modes.push(mode(value)?),
            "--first" => self.first = value.parse()?,
            "--count" => self.count = value.parse()?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The modes that were asked for, or all.
    #[must_use]
    pub fn modes(&self) -> &[Mode] {
        if self.modes.is_empty() {
            &[Mode::Hybrid, Mode::Exact, Mode::Stepped]
        } else {
            &self.modes
        }
    }

    /// All seeds.
    #[must_use]
    pub const fn seeds(&self) -> Range<u64> {
        self.first..self.first.saturating_add(self.count)
    }
}

/// A mode by its name.
///
/// # Errors
/// There is none of that name.
pub fn mode(name: &str) -> Result<Mode, String> {
    match name {
        "hybrid" => Ok(Mode::Hybrid),
        "exact" => Ok(Mode::Exact),
        "stepped" => Ok(Mode::Stepped),
        _ => Err(format!("no mode '{name}': hybrid, exact or stepped")),
    }
}

/// A surface without friction that gives everything back.
#[must_use]
pub fn elastic() -> Material {
    Material {
        friction: 0.0,
        restitution: 1.0,
        ..Material::default()
    }
}

/// Deepest and mean overlap of all pairs of bodies (of which one moves), in m, ≥ 0.
///
/// From shapes and poses alone, pair by pair: it shares nothing with the world's own search or with the library's collision code ([`checks`]).
#[must_use]
pub fn overlaps(world: &World) -> (f64, f64) {
    let bodies: Vec<_> = world.bodies().collect();
    let (mut deepest, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for (i, a) in bodies.iter().enumerate() {
        for b in &bodies[i + 1..] {
            let moves = a.kind() == BodyKind::Dynamic || b.kind() == BodyKind::Dynamic;
            if !moves || !a.aabb().overlaps(b.aabb()) {
                continue;
            }
            let depth = depth(a, b);
            if depth > 0.0 {
                deepest = deepest.max(depth);
                sum += depth;
                count += 1.0;
            }
        }
    }
    (deepest, if count > 0.0 { sum / count } else { 0.0 })
}

/// The example of the project's README, held by a test.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct ReadmeDocTests;

/// The programs of the project's guide.
#[cfg(doctest)]
#[doc = include_str!("../../docs/guide.md")]
struct GuideDocTests;
