//! Stress cases that step a world.

use carom_dynamics::{BodyDef, BodyId, Force, Material, Settings, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Vec2, vec2};

use super::Finding;
use crate::exit::{Failure, fail};

const FRAME: f64 = 1.0 / 60.0;

/// Case 13: every flight of an elastic ball reaches the height it fell from.
pub(super) fn bounce() -> Result<Finding, Failure> {
    let (g, radius, height) = (10.0, 0.25, 1.0);
    let elastic = Material {
        friction: 0.0,
        restitution: 1.0,
        ..Material::default()
    };
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -g),
        ..Settings::default()
    })?;
    world.insert(
        BodyDef::fixed().at(vec2(0.0, -1.0)),
        ConvexPolygon::rectangle(20.0, 2.0)?,
        elastic,
    )?;
    let start = BodyDef::dynamic().at(vec2(0.0, radius + height));
    let ball = world.insert(start, Circle::new(radius)?, elastic)?;
    let (mut bounces, mut worst) = (0, 0.0_f64);
    // 2 √(2h/g) = 0.894 s a bounce: 1000 of them within 900 s.
    for _ in 0..54_000 {
        bounces += world.step(FRAME).impacts;
        let (centre, velocity) = state(&world, ball)?;
        // The apex of this flight, from its state anywhere on the way: y + v²/2g.
        let apex = centre.y - radius + velocity.y * velocity.y / (2.0 * g);
        worst = worst.max((apex - height).abs());
        if !centre.is_finite() {
            worst = f64::NAN;
        }
    }
    Ok(Finding {
        passed: worst <= 1e-9 && bounces >= 1000,
        measured: format!("{bounces} bounces, worst apex off by {worst:.2e} m"),
        wanted: "1000 bounces, within 1e-9 m",
    })
}

/// Case 16: smooth walls keep the speed, rough ones never add energy.
pub(super) fn box_of_one() -> Result<Finding, Failure> {
    let (smooth, _) = ball_in_box(0.0)?;
    let (_, rise) = ball_in_box(0.5)?;
    Ok(Finding {
        passed: smooth <= 1.0 && rise <= 1.0,
        measured: format!("speed off by {smooth:.2}, energy rises by {rise:.2} ulp an impact"),
        wanted: "both 0 to rounding: at most 1 ulp an impact",
    })
}

/// Worst change of the speed, and worst rise of the energy above its lowest value, relative, in 2⁻⁵² an impact.
fn ball_in_box(friction: f64) -> Result<(f64, f64), Failure> {
    let material = Material {
        friction,
        restitution: 1.0,
        ..Material::default()
    };
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    })?;
    for (at, width, height) in [
        (vec2(0.0, -2.0), 6.0, 1.0),
        (vec2(0.0, 2.0), 6.0, 1.0),
        (vec2(-2.5, 0.0), 1.0, 3.0),
        (vec2(2.5, 0.0), 1.0, 3.0),
    ] {
        world.insert(
            BodyDef::fixed().at(at),
            ConvexPolygon::rectangle(width, height)?,
            material,
        )?;
    }
    let velocity = vec2(3.0, 1.7);
    let start = BodyDef::dynamic().moving(velocity).spinning(2.0);
    let ball = world.insert(start, Circle::new(0.25)?, material)?;
    let (mut speed_change, mut rise) = (0.0_f64, 0.0_f64);
    let mut lowest = world.energy().kinetic;
    let mut impacts = 0;
    for _ in 0..3600 {
        impacts += world.step(FRAME).impacts;
        #[expect(clippy::cast_precision_loss, reason = "a few hundred")]
        let ulps = 1.0 / (f64::EPSILON * impacts.max(1) as f64);
        let (_, now) = state(&world, ball)?;
        let change = (now.length() / velocity.length() - 1.0).abs();
        speed_change = worse(speed_change, change * ulps);
        let energy = world.energy().kinetic;
        rise = worse(rise, (energy / lowest - 1.0) * ulps);
        lowest = lowest.min(energy);
    }
    Ok((speed_change, rise))
}

/// Case 34: ten boxes on each other stay where they are.
pub(super) fn column() -> Result<Finding, Failure> {
    let mut world = World::new(Settings {
        sleep: None,
        ..Settings::default()
    })?;
    let material = Material::default();
    world.insert(
        BodyDef::fixed().at(vec2(0.0, -0.5)),
        ConvexPolygon::rectangle(20.0, 1.0)?,
        material,
    )?;
    let mut top = None;
    for level in 0..10 {
        let place = vec2(0.0, 0.5 + f64::from(level));
        top = Some(world.insert(
            BodyDef::dynamic().at(place),
            ConvexPolygon::square(1.0)?,
            material,
        )?);
    }
    let Some(top) = top else {
        fail!("an empty column")
    };
    let (start, _) = state(&world, top)?;
    let mut worst = 0.0;
    for _ in 0..3600 {
        world.step(FRAME);
        let (now, _) = state(&world, top)?;
        worst = worse(worst, (now - start).length());
    }
    Ok(Finding::at_most(
        1e-6,
        worst,
        "m, the top",
        "at most 1e-6 m",
    ))
}

/// Case 37: discs that start at one point part, and no faster than the documented push-out.
pub(super) fn one_point() -> Result<Finding, Failure> {
    let (mut gained, mut overlap, mut finite) = (0.0_f64, 0.0_f64, true);
    for count in [2_u32, 10, 100] {
        let settings = Settings {
            gravity: Vec2::ZERO,
            ..Settings::default()
        };
        let push_out = settings.contact.push_out;
        let mut world = World::new(settings)?;
        for _ in 0..count {
            world.insert(BodyDef::dynamic(), Circle::new(0.1)?, Material::default())?;
        }
        let mass: f64 = world.bodies().map(|body| body.mass()).sum();
        world.step(0.0);
        for _ in 0..1200 {
            let report = world.step(FRAME);
            gained = worse(
                gained,
                world.energy().kinetic / (0.5 * mass * push_out * push_out),
            );
            finite &= world.bodies().all(|body| body.centre().is_finite());
            overlap = report.deepest_overlap;
        }
    }
    Ok(Finding {
        passed: finite && gained <= 1.0 && overlap <= 0.0,
        measured: format!("energy {gained:.1e} of the push-out's, last overlap {overlap:.1e} m"),
        wanted: "finite, at most 1, apart after 20 s",
    })
}

/// Case 39: what is not finite is refused by name, and the world is as it was.
pub(super) fn not_finite() -> Result<Finding, Failure> {
    let mut world = World::new(Settings::default())?;
    let disc = || Circle::new(0.5);
    let id = world.insert(BodyDef::dynamic(), disc()?, Material::default())?;
    world.step(FRAME);
    let before = world.state_hash();
    let force = world.apply_force(id, Force::central(vec2(f64::NAN, 0.0)));
    let place = world.insert(
        BodyDef::dynamic().at(vec2(0.0, f64::INFINITY)),
        disc()?,
        Material::default(),
    );
    let said = match (force, place) {
        (Err(force), Err(place)) => {
            format!("{force}; {place}").replace(", not a finite number", "")
        }
        _ => "accepted".to_owned(),
    };
    let unchanged = world.state_hash() == before && world.bodies().count() == 1;
    Ok(Finding {
        passed: said != "accepted" && unchanged,
        measured: said,
        wanted: "two errors that name the field, world unchanged",
    })
}

/// Case 40: equal input, equal bits; and the order of insertion should not matter.
pub(super) fn order() -> Result<Finding, Failure> {
    let forwards: Vec<u64> = (0..20).collect();
    let backwards: Vec<u64> = (0..20).rev().collect();
    let first = heap(&forwards)?;
    let again = heap(&forwards)?;
    let other = heap(&backwards)?;
    let worst = first
        .iter()
        .zip(&other)
        .map(|(a, b)| (*a - *b).length())
        .fold(0.0, worse);
    let twice = if first == again {
        "twice the same bits"
    } else {
        "twice DIFFERENT bits"
    };
    Ok(Finding {
        passed: first == again && first == other,
        measured: format!("{twice}; backwards off by {worst:.1e} m"),
        wanted: "the same bits in both",
    })
}

/// Centres of twenty hexagons after two seconds in a box, by tag.
fn heap(order: &[u64]) -> Result<Vec<Vec2>, Failure> {
    let mut world = World::new(Settings::default())?;
    let material = Material::default();
    for (at, width, height) in [
        (vec2(0.0, -0.5), 8.0, 1.0),
        (vec2(-3.5, 3.0), 1.0, 6.0),
        (vec2(3.5, 3.0), 1.0, 6.0),
    ] {
        world.insert(
            BodyDef::fixed().at(at),
            ConvexPolygon::rectangle(width, height)?,
            material,
        )?;
    }
    for &tag in order {
        #[expect(clippy::cast_precision_loss, reason = "below 20")]
        let (column, row) = ((tag % 4) as f64, (tag / 4) as f64);
        let place = vec2(1.3 * column - 2.0 + 0.11 * row, 0.7 + 1.1 * row);
        let hexagon = BodyDef::dynamic()
            .at(place)
            .turned(0.1 * column)
            .tagged(tag);
        world.insert(hexagon, ConvexPolygon::regular(6, 0.5)?, material)?;
    }
    for _ in 0..120 {
        world.step(FRAME);
    }
    let mut centres: Vec<(u64, Vec2)> = world
        .bodies()
        .filter(|body| body.mass().is_finite() && body.mass() > 0.0)
        .map(|body| (body.tag(), body.centre()))
        .collect();
    centres.sort_by_key(|&(tag, _)| tag);
    Ok(centres.into_iter().map(|(_, centre)| centre).collect())
}

fn state(world: &World, id: BodyId) -> Result<(Vec2, Vec2), Failure> {
    match world.body(id) {
        Some(body) => Ok((body.centre(), body.velocity())),
        None => fail!("the body is gone"),
    }
}

/// The larger one; NaN wins.
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
