//! What many small islands cost that live at once, and what they gain:
//!
//! ```sh
//! cargo run --release -p carom-bench --example islands -- hybrid            # every scene
//! cargo run --release -p carom-bench --example islands -- stepped rock 1000
//! ```
//!
//! Four simulated seconds in steps of 1/60 s: CPU time of the first step, the mean, the median and the worst of the others in
//! ms, the deepest overlap in m, and by how much the energy rose at most within a step, as a part of the kinetic energy that the
//! scene had at most (`-` where the caller drives it all the time).

use carom_bench::CpuClock;
use carom_dynamics::{BodyDef, BodyId, Material, Mode, Settings, World};
use carom_geometry::{ConvexPolygon, HalfPlane};
use carom_math::{Vec2, trig, vec2};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

const SCENES: [&str; 8] = [
    "rock",
    "kicks",
    "stacks",
    "seesaws",
    "platforms",
    "tiles",
    "dominoes",
    "beside",
];

fn main() -> Outcome<()> {
    let mut args = std::env::args().skip(1);
    let mode = match args.next().as_deref() {
        Some("exact") => Mode::Exact,
        Some("stepped") => Mode::Stepped,
        _ => Mode::Hybrid,
    };
    let chosen = args.next().filter(|name| name != "all");
    let count = args.next().map_or(Ok(1000), |count| count.parse())?;
    println!("scene | first | mean | median | worst | overlap | energy rose");
    for name in SCENES {
        if chosen.as_deref().is_none_or(|chosen| chosen == name) {
            measure(name, mode, count)?;
        }
    }
    Ok(())
}

fn measure(name: &str, mode: Mode, count: u32) -> Outcome<()> {
    let mut scene = Scene::new(name, mode, count)?;
    let clock = CpuClock::thread();
    let mut times = Vec::new();
    let (mut deepest, mut rise, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for step in 0..240 {
        let start = clock.seconds();
        scene.drive(step)?;
        let driven = clock.seconds() - start;
        let before = scene.world.energy().mechanical();
        let start = clock.seconds();
        let report = scene.world.step(1.0 / 60.0);
        times.push(1e3 * (driven + clock.seconds() - start));
        let energy = scene.world.energy();
        rise = rise.max(energy.mechanical() - before);
        most = most.max(energy.kinetic);
        deepest = deepest.max(report.deepest_overlap);
    }
    let first = times.remove(0);
    times.sort_by(f64::total_cmp);
    let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    let rise = if matches!(name, "platforms" | "beside") {
        "-".to_owned()
    } else {
        format!("{:.1e}", rise / most)
    };
    println!("{name} | {first:.2} | {mean:.2} | {median:.3} | {worst:.2} | {deepest:.1e} | {rise}");
    Ok(())
}

/// A world, and the bodies that the caller drives in it.
struct Scene {
    name: String,
    world: World,
    driven: Vec<BodyId>,
}

impl Scene {
    fn new(name: &str, mode: Mode, count: u32) -> Outcome<Self> {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let mut scene = Self {
            name: name.to_owned(),
            world: World::new(settings)?,
            driven: Vec::new(),
        };
        if name != "tiles" {
            let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y)?;
            scene.world.insert(BodyDef::fixed(), floor, wood())?;
        }
        if name == "beside" {
            scene.stir()?;
        }
        for k in 0..count {
            let x = 12.0 * f64::from(k);
            let part = (0.618_033_988_7 * f64::from(k)).fract();
            match name {
                "rock" | "kicks" => {
                    let id = scene.block(BodyDef::dynamic().at(vec2(x, 1.0)), 1.0, 2.0)?;
                    scene.driven.push(id);
                }
                // A stack of three, of 300 by default.
                "stacks" if k % 10 < 3 => {
                    for level in 0..3 {
                        let at = vec2(x, 0.5 + f64::from(level));
                        let id = scene.block(BodyDef::dynamic().at(at), 1.0, 1.0)?;
                        if level == 2 {
                            scene.driven.push(id);
                        }
                    }
                }
                "seesaws" => {
                    scene.block(BodyDef::fixed().at(vec2(x, 0.5)), 0.2, 1.0)?;
                    scene.block(BodyDef::dynamic().at(vec2(x, 1.1)), 4.0, 0.2)?;
                    scene.block(BodyDef::dynamic().at(vec2(x - 1.5, 1.5)), 0.6, 0.6)?;
                    let falls = BodyDef::dynamic().at(vec2(x + 1.5, 2.5 + part));
                    scene.block(falls, 0.6, 0.6)?;
                }
                "platforms" if k % 10 == 0 => {
                    let id = scene.block(BodyDef::kinematic().at(vec2(x, 3.0)), 6.0, 0.4)?;
                    scene.driven.push(id);
                    for place in 0..5 {
                        let at = vec2(x + 1.1 * f64::from(place) - 2.2, 3.5);
                        scene.block(BodyDef::dynamic().at(at), 0.6, 0.6)?;
                    }
                }
                // 5,000 tiles of 1 m, and a box on every fifth fifth.
                "tiles" => {
                    for place in 0..5 {
                        let at = vec2(5.0 * f64::from(k) + f64::from(place), -0.5);
                        scene.block(BodyDef::fixed().at(at), 1.0, 1.0)?;
                    }
                    if k % 5 == 0 {
                        let slides = BodyDef::dynamic().at(vec2(5.0 * f64::from(k), 0.25));
                        scene.block(slides.moving(vec2(3.0, 0.0)), 0.5, 0.5)?;
                    }
                }
                // 100,000 blocks by default that do nothing.
                "beside" => {
                    for place in 0..100 {
                        let at = vec2(100.0 + 3.0 * (100.0 * f64::from(k) + f64::from(place)), 0.5);
                        scene.block(BodyDef::fixed().at(at), 1.0, 1.0)?;
                    }
                }
                "dominoes" => {
                    let def = BodyDef::dynamic().at(vec2(0.6 * f64::from(k), 1.0));
                    let def = if k == 0 { def.spinning(-1.5) } else { def };
                    scene.block(def, 0.2, 2.0)?;
                }
                _ => {}
            }
        }
        Ok(scene)
    }

    /// Twenty boxes between two walls that a blade stirs.
    fn stir(&mut self) -> Outcome<()> {
        let blade = BodyDef::kinematic().at(vec2(0.0, 3.0)).spinning(2.0);
        self.block(blade, 6.0, 0.4)?;
        for x in [-4.0, 4.0] {
            self.block(BodyDef::fixed().at(vec2(x, 50.0)), 0.5, 100.0)?;
        }
        for k in 0..20 {
            let at = vec2(f64::from(k % 5) - 2.0, 4.0 + f64::from(k / 5));
            self.block(BodyDef::dynamic().at(at), 0.6, 0.6)?;
        }
        Ok(())
    }

    fn block(&mut self, def: BodyDef, width: f64, height: f64) -> Outcome<BodyId> {
        let material = if self.name == "tiles" {
            Material {
                friction: 0.0,
                ..wood()
            }
        } else {
            wood()
        };
        let block = ConvexPolygon::rectangle(width, height)?;
        Ok(self.world.insert(def, block, material)?)
    }

    /// What the caller does before a step.
    fn drive(&mut self, step: u32) -> Outcome<()> {
        let second = step.is_multiple_of(60).then_some(step / 60);
        match self.name.as_str() {
            "rock" if step == 0 => self.kick(1.0)?,
            "kicks" => {
                if let Some(second) = second {
                    self.kick(if second.is_multiple_of(2) { 1.0 } else { -1.0 })?;
                }
            }
            "stacks" => {
                let id = self.driven[step as usize % self.driven.len()];
                self.world.set_velocity(id, vec2(0.1, 0.0), 0.0)?;
            }
            "platforms" => {
                let phase = f64::from(step) / 60.0;
                for &id in &self.driven {
                    let (sin, cos) = trig::sin_cos(phase);
                    let velocity = vec2(sin, 0.5 * cos);
                    self.world.set_velocity(id, velocity, 0.0)?;
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn kick(&mut self, spin: f64) -> Outcome<()> {
        for &id in &self.driven {
            self.world.set_velocity(id, vec2(0.0, 0.0), spin)?;
        }
        Ok(())
    }
}

fn wood() -> Material {
    Material {
        friction: 0.6,
        ..Material::default()
    }
}
