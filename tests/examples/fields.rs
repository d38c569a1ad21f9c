//! What flight in fields and with damping costs: pieces of a law alone, and gases of discs and pentagons.
//!
//! ```sh
//! cargo run --release -p carom-tests --example fields
//! ```

use std::error::Error;
use std::process::ExitCode;

use carom_dynamics::{BodyDef, RadialField, Settings, StepReport, World};
use carom_geometry::{ConvexPolygon, HalfPlane, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::elastic;
use carom_tests::gas::numbers;
use carom_tests::scenes::{disc, put};

type Failure = Box<dyn Error>;

fn still() -> Result<World, Failure> {
    Ok(World::new(Settings {
        gravity: Vec2::ZERO,
        sleep: None,
        ..Settings::default()
    })?)
}

/// Pieces of 10 s of a disc of 0.5 m that falls through the air.
fn falls(damping: f64, speed: f64) -> Result<(), Failure> {
    let mut world = World::new(Settings::default())?;
    let def = BodyDef::dynamic()
        .moving(vec2(speed, 0.0))
        .damped(damping, damping);
    let id = put(&mut world, def, disc(0.5), elastic());
    world.step(10.0);
    let pieces = world.body(id).map_or(0, |body| body.version());
    println!("falls, damped by {damping}/s, thrown at {speed} m/s: {pieces} pieces in 10 s");
    Ok(())
}

/// Pieces of one turn of the same disc about a centre.
fn turns(eccentricity: f64) -> Result<(), Failure> {
    let (strength, farthest) = (12.0_f64, 4.0);
    let mut world = still()?;
    world.add_field(RadialField::new(Vec2::ZERO, strength, 0.05)?);
    let speed = (strength * (1.0 - eccentricity) / farthest).sqrt();
    let def = BodyDef::dynamic()
        .at(vec2(farthest, 0.0))
        .moving(vec2(0.0, speed));
    let id = put(&mut world, def, disc(0.5), elastic());
    let axis = farthest / (1.0 + eccentricity);
    world.step(2.0 * core::f64::consts::PI * (axis * axis * axis / strength).sqrt());
    let pieces = world.body(id).map_or(0, |body| body.version());
    println!(
        "an ellipse of eccentricity {eccentricity}, {axis:.1} m large: {pieces} pieces a turn"
    );
    Ok(())
}

/// 10 s of 400 elastic bodies of 0.5 m, one in 16 m².
fn gas(damping: f64, strength: f64) -> Result<(), Failure> {
    let mut world = still()?;
    let half = 40.0;
    for normal in [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y] {
        let wall = HalfPlane::new(normal * -half, normal)?;
        put(&mut world, BodyDef::fixed(), wall, elastic());
    }
    if strength > 0.0 {
        world.add_field(RadialField::new(vec2(0.1, 0.2), strength, 5.0)?);
    }
    let mut next = numbers(1);
    for i in 0..400 {
        let (row, column) = (i / 20, i % 20);
        let at = (vec2(f64::from(column), f64::from(row)) + 0.5) * 4.0 - half;
        let shape: Shape = if (row + column) % 2 == 0 {
            disc(0.5).into()
        } else {
            ConvexPolygon::regular(5, 0.5)?.into()
        };
        let def = BodyDef::dynamic()
            .at(at)
            .moving((vec2(next(), next()) - 0.5) * 8.0)
            .spinning(next())
            .damped(damping, damping);
        put(&mut world, def, shape, elastic());
    }
    let mut report = StepReport::default();
    for _ in 0..600 {
        report += world.step(1.0 / 60.0);
    }
    let changes: u64 = world.bodies().map(|body| u64::from(body.version())).sum();
    println!(
        "400 bodies, damped by {damping}/s, about {strength} m³/s²: {} impacts, {} sub-steps, {changes} motions in 10 s",
        report.impacts, report.substeps
    );
    Ok(())
}

fn run() -> Result<(), Failure> {
    for (damping, speed) in [(0.1, 1.0), (0.1, 10.0), (0.5, 10.0), (1.0, 10.0)] {
        falls(damping, speed)?;
    }
    for eccentricity in [0.0, 0.5, 0.9] {
        turns(eccentricity)?;
    }
    for (damping, strength) in [
        (0.0, 0.0),
        (0.05, 0.0),
        (0.5, 0.0),
        (0.0, 50.0),
        (0.05, 50.0),
    ] {
        gas(damping, strength)?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}
