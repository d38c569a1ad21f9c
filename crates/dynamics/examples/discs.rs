//! What sub-steps make of groups of discs, in exact mode:
//!
//! ```sh
//! cargo run --release -p carom-dynamics --example discs
//! time cargo run --release -p carom-dynamics --example discs -- heaps 0.5
//! ```
//!
//! A disc on a belt, and six that roll off a large one, each against the same with sub-steps of 1/61,440 s; boxes full of sixty
//! balls. With `heaps` and a restitution nothing but 60 heaps of ten balls that fall and come to rest, to be timed.

use carom_dynamics::geometry::{Circle, ConvexPolygon, HalfPlane};
use carom_dynamics::math::{Vec2, trig, vec2};
use carom_dynamics::{BodyDef, BodyId, Material, Mode, Settings, World};

type Failure = Box<dyn std::error::Error>;
type Scene = fn(&mut World) -> Result<Vec<BodyId>, Failure>;

/// Seconds of a tick.
const TICK: f64 = 1.0 / 60.0;

fn main() -> Result<(), Failure> {
    let mut args = std::env::args().skip(1);
    if args.next().as_deref() == Some("heaps") {
        return heaps(args.next().unwrap_or_default().parse()?);
    }
    println!("scene | sub-step | farthest off, m | energy from the scheme, J");
    let scenes: [(&str, Scene, u32); 2] = [("belt", belt, 30), ("hill", hill, 48)];
    for (name, scene, ticks) in scenes {
        let (right, _) = run(scene, ticks, 1024.0)?;
        for parts in [4.0, 6.0, 12.0, 48.0] {
            let (places, scheme) = run(scene, ticks, parts)?;
            let off = places.iter().zip(&right).map(|(a, b)| (*a - *b).length());
            let off = off.fold(0.0, f64::max);
            println!("{name} | 1/{} s | {off:.1e} | {scheme:.1e}", 60.0 * parts);
        }
    }
    println!("box | deepest overlap at rest, m | most gained in a tick, of the energy");
    for seed in 1..=8 {
        full_box(seed)?;
    }
    Ok(())
}

fn world(substep: f64) -> Result<World, Failure> {
    Ok(World::new(Settings {
        mode: Mode::Exact,
        sleep: None,
        substep,
        ..Settings::default()
    })?)
}

fn surface(restitution: f64) -> Material {
    Material {
        restitution,
        friction: 0.3,
        ..Material::default()
    }
}

/// Where the bodies of a scene are after so many ticks of so many sub-steps, and what the scheme added.
fn run(scene: Scene, ticks: u32, parts: f64) -> Result<(Vec<Vec2>, f64), Failure> {
    let mut world = world(TICK / parts)?;
    let ids = scene(&mut world)?;
    for _ in 0..ticks {
        world.step(TICK);
    }
    let place = |id: &BodyId| world.body(*id).expect("never removed").centre();
    Ok((ids.iter().map(place).collect(), world.energy().scheme))
}

fn belt(world: &mut World) -> Result<Vec<BodyId>, Failure> {
    let belt = Material {
        tangent_speed: 2.0,
        ..surface(0.0)
    };
    let bed = ConvexPolygon::rectangle(80.0, 1.0)?;
    world.insert(BodyDef::fixed().at(vec2(0.0, -0.5)), bed, belt)?;
    let def = BodyDef::dynamic().at(vec2(0.0, 0.5));
    Ok(vec![world.insert(def, Circle::new(0.5)?, surface(0.0))?])
}

/// Six discs side by side on a disc of 5 m, which touch each other.
fn hill(world: &mut World) -> Result<Vec<BodyId>, Failure> {
    world.insert(BodyDef::fixed(), Circle::new(5.0)?, surface(0.0))?;
    let apart = trig::acos(119.0 / 121.0); // 2 asin(0.5/5.5)
    let mut ids = Vec::new();
    for k in 0..6 {
        let (sin, cos) = trig::sin_cos(0.1 + apart * f64::from(k));
        let def = BodyDef::dynamic().at(vec2(5.5 * sin, 5.5 * cos));
        ids.push(world.insert(def, Circle::new(0.5)?, surface(0.0))?);
    }
    Ok(ids)
}

/// Half-planes: a floor, and walls at ±`half` (m).
fn walls(world: &mut World, half: f64, material: Material) -> Result<(), Failure> {
    for (point, up) in [
        (Vec2::ZERO, Vec2::Y),
        (vec2(-half, 0.0), Vec2::X),
        (vec2(half, 0.0), -Vec2::X),
    ] {
        world.insert(BodyDef::fixed(), HalfPlane::new(point, up)?, material)?;
    }
    Ok(())
}

fn full_box(seed: u32) -> Result<(), Failure> {
    let mut world = world(TICK / 6.0)?;
    let lively = surface(0.7);
    walls(&mut world, 3.0, lively)?;
    let mut balls = Vec::new();
    for k in 0..60 {
        let mix = |by: f64| (by * f64::from(k + 60 * seed)).fract();
        let at = vec2(
            f64::from(k % 6) - 2.5 + 0.18 * (mix(0.618) - 0.5),
            0.6 + f64::from(k / 6),
        );
        let radius = 0.3 + 0.1 * mix(0.414);
        let id = world.insert(BodyDef::dynamic().at(at), Circle::new(radius)?, lively)?;
        balls.push((id, radius));
    }
    let start = world.energy().mechanical();
    let (mut before, mut worst) = (start, 0.0_f64);
    for _ in 0..600 {
        world.step(TICK);
        let now = world.energy().mechanical();
        worst = worst.max((now - before) / start);
        before = now;
    }
    println!("{seed} | {:.1e} | {worst:.1e}", deepest(&world, &balls));
    Ok(())
}

fn deepest(world: &World, balls: &[(BodyId, f64)]) -> f64 {
    let place = |id: BodyId| world.body(id).expect("never removed").centre();
    let mut deepest = 0.0_f64;
    for (i, (a, r_a)) in balls.iter().enumerate() {
        for (b, r_b) in &balls[i + 1..] {
            deepest = deepest.max(r_a + r_b - (place(*b) - place(*a)).length());
        }
    }
    deepest
}

fn heaps(restitution: f64) -> Result<(), Failure> {
    let mut world = world(TICK / 6.0)?;
    let material = surface(restitution);
    for heap in 0..60 {
        let middle = 12.0 * f64::from(heap);
        for (x, y, w, h) in [
            (0.0, -0.5, 8.0, 1.0),
            (-3.0, 1.0, 1.0, 3.0),
            (3.0, 1.0, 1.0, 3.0),
        ] {
            let def = BodyDef::fixed().at(vec2(middle + x, y));
            world.insert(def, ConvexPolygon::rectangle(w, h)?, material)?;
        }
        for (row, count) in (0_u32..).zip([4_u32, 3, 2, 1]) {
            for k in 0..count {
                let off = 0.003 * f64::from(row) + 0.0001 * f64::from(heap);
                let x = 1.02 * (f64::from(k) - 0.5 * f64::from(count - 1)) + off;
                let at = vec2(middle + x, 0.6 + 0.95 * f64::from(row));
                world.insert(BodyDef::dynamic().at(at), Circle::new(0.45)?, material)?;
            }
        }
    }
    for _ in 0..180 {
        world.step(TICK);
    }
    println!("energy at rest: {:.6} J", world.energy().mechanical());
    Ok(())
}
