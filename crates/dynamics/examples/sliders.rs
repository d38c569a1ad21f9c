//! How many sub-steps bodies need that slide or roll on a plane:
//!
//! ```sh
//! cargo run --release -p carom-dynamics --example sliders -- 1000
//! ```
//!
//! Blocks that slide to a stop, each at its own instant; balls that roll for as long; both of them; balls that roll into
//! each other. Ten simulated seconds in steps of 1/60 s.

use carom_dynamics::geometry::{Circle, ConvexPolygon, HalfPlane};
use carom_dynamics::math::{Vec2, vec2};
use carom_dynamics::{BodyDef, Material, Settings, World};

/// Friction of all surfaces.
const FRICTION: f64 = 0.3;

#[derive(Clone, Copy, Debug)]
enum Kind {
    Slide,
    Roll,
    Both,
    Meet,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: u32 = std::env::args().nth(1).unwrap_or_default().parse()?;
    println!("scene | sub-steps | impacts | searches");
    for kind in [Kind::Slide, Kind::Roll, Kind::Both, Kind::Meet] {
        let mut world = scene(kind, count)?;
        let (mut substeps, mut impacts, mut pairs) = (0, 0, 0);
        for _ in 0..600 {
            let report = world.step(1.0 / 60.0);
            substeps += report.substeps;
            impacts += report.impacts;
            pairs += report.pairs;
        }
        println!("{kind:?} | {substeps} | {impacts} | {pairs}");
    }
    Ok(())
}

fn scene(kind: Kind, count: u32) -> Result<World, Box<dyn std::error::Error>> {
    let mut world = World::new(Settings::default())?;
    let rough = Material {
        restitution: 0.5,
        friction: FRICTION,
        ..Material::default()
    };
    let plane = HalfPlane::new(Vec2::ZERO, Vec2::Y)?;
    world.insert(BodyDef::fixed(), plane, rough)?;
    for k in 0..count {
        let part = f64::from(k) / f64::from(count);
        let speed = match kind {
            Kind::Meet => 4.0 * (0.618 * f64::from(k)).fract() - 2.0,
            _ => 1.0 + 9.0 * part,
        };
        let gap = if matches!(kind, Kind::Meet) {
            4.0
        } else {
            40.0
        };
        let def = BodyDef::dynamic()
            .at(vec2(gap * f64::from(k), 0.5))
            .moving(vec2(speed, 0.0));
        let slides = match kind {
            Kind::Slide => true,
            Kind::Both => k % 2 == 0,
            Kind::Roll | Kind::Meet => false,
        };
        if slides {
            world.insert(def, ConvexPolygon::square(1.0)?, rough)?;
        } else {
            world.insert(def.spinning(-speed / 0.5), Circle::new(0.5)?, rough)?;
        }
    }
    Ok(world)
}
