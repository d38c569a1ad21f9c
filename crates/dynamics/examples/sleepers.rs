//! What a step costs beside sleepers, to be counted under callgrind:
//!
//! ```sh
//! cargo build -p carom-dynamics --example sleepers
//! valgrind --tool=callgrind --collect-atstart=no --toggle-collect='*measured*' target/debug/examples/sleepers 10000
//! ```
//!
//! 20 boxes slide over a floor on which others sleep; after a second of settling 120 steps are counted. The
//! count should not depend on the sleepers, but for the depth of the box tree.

use carom_dynamics::geometry::ConvexPolygon;
use carom_dynamics::math::vec2;
use carom_dynamics::{BodyDef, Material, Mode, Settings, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: u32 = std::env::args().nth(1).unwrap_or_default().parse()?;
    let mut world = World::new(Settings {
        mode: Mode::Stepped,
        ..Settings::default()
    })?;
    let smooth = Material {
        friction: 0.0,
        ..Material::default()
    };
    let floor = ConvexPolygon::rectangle(1e5, 2.0)?;
    world.insert(BodyDef::fixed().at(vec2(0.0, -1.0)), floor, smooth)?;
    for k in 0..count {
        // Towers of ten, far from where anything moves.
        let at = vec2(200.0 + 2.0 * f64::from(k / 10), 0.5 + f64::from(k % 10));
        let square = ConvexPolygon::square(1.0)?;
        world.insert(
            BodyDef::dynamic().at(at).asleep(),
            square,
            Material::default(),
        )?;
    }
    for k in 0..20 {
        let def = BodyDef::dynamic().at(vec2(-3.0 * f64::from(k), 0.5));
        world.insert(
            def.moving(vec2(1.0, 0.0)),
            ConvexPolygon::square(1.0)?,
            smooth,
        )?;
    }
    world.step(1.0);
    let mut steps = 0;
    for _ in 0..120 {
        steps += measured(&mut world);
    }
    println!("{steps} sub-steps, {} s", world.time().as_secs());
    Ok(())
}

/// A step that callgrind counts: never inlined.
#[inline(never)]
fn measured(world: &mut World) -> u64 {
    world.step(1.0 / 60.0).substeps
}
