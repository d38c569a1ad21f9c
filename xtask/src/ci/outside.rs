//! Crates outside of the workspace, each of which depends on one of ours alone, as a user's does.

use std::fs;
use std::path::Path;

use super::Scratch;
use crate::exit::Failure;
use crate::laboratory::cargo_in;
use crate::out::say;

/// A crate of a user: what it depends on, what its `main` does, and what that prints.
struct Outside {
    /// The folder in `crates`.
    folder: &'static str,
    features: &'static [&'static str],
    main: &'static str,
    prints: &'static str,
}

const ALL: [Outside; 4] = [
    Outside {
        folder: "geometry",
        features: &[],
        main: r#"use carom_geometry::ConvexPolygon;

fn main() {
    let rectangle = ConvexPolygon::rectangle(2.0, 1.0).expect("two positive sides");
    let mass = rectangle.area_properties().with_mass(12.0);
    println!("inertia {:.12} kg m2", mass.inertia);
}
"#,
        // m (w² + h²) / 12 of 12 kg, 2 m x 1 m.
        prints: "inertia 5.000000000000 kg m2",
    },
    Outside {
        folder: "collision",
        features: &[],
        main: r#"use carom_collision::geometry::math::{Pose, vec2};
use carom_collision::geometry::{Circle, ConvexPolygon, Shape};
use carom_collision::shape_distance;

fn main() {
    let wall = Shape::from(ConvexPolygon::rectangle(2.0, 6.0).expect("two positive sides"));
    let ball = Shape::from(Circle::new(0.5).expect("a positive radius"));
    let apart = shape_distance(&wall, &ball, Pose::at(vec2(4.0, 1.0)));
    println!("{} m apart", apart.distance);
}
"#,
        prints: "2.5 m apart",
    },
    Outside {
        folder: "render",
        features: &[],
        main: r#"use carom_render::{Colour, Frame, Op, Paint, Picture, Size, Style, math::vec2};

fn main() {
    let mut frame = Frame::new(Size::new(64, 48).expect("a small picture"));
    let paint = Paint::flat(Colour::hex(0x3FA796));
    frame.push(Op::Disc { centre: vec2(32.0, 24.0), radius: 9.0, paint });
    let png = frame.paint(&Style::light()).to_png();
    let read = Picture::from_png(&png).expect("a picture");
    println!("{} px, {:?}", read.size(), read.pixel(32, 24) == Some(Colour::hex(0x3FA796)));
}
"#,
        prints: "64 x 48 px, true",
    },
    Outside {
        folder: "carom",
        features: &["scenes"],
        main: r#"use carom::render::{Camera, Frame, Look, Style};
use carom::{BodyDef, Circle, Material, Settings, World, vec2};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::new(Settings { gravity: vec2(0.0, -10.0), ..Settings::default() })?;
    let thrown = BodyDef::dynamic().moving(vec2(3.0, 4.0));
    let ball = world.insert(thrown, Circle::new(0.5)?, Material::default())?;
    world.step(2.0);
    let centre = world.body(ball).ok_or("it stays")?.centre();
    let camera = Camera::new(centre, 40.0, 64, 48)?;
    let picture = Frame::capture(&world, &Look::default(), &camera).paint(&Style::light());
    let scenes = carom::scenes::list().iter().any(|scene| scene.name == "thesis");
    println!("at {centre:.9}, {} px, {scenes}", picture.size());
    Ok(())
}
"#,
        prints: "at [6.000000000, -12.000000000], 64 x 48 px, true",
    },
];

pub(super) fn check(root: &Path) -> Result<bool, Failure> {
    for outside in &ALL {
        if !outside.runs(root)? {
            return Ok(false);
        }
    }
    Ok(true)
}

impl Outside {
    fn runs(&self, root: &Path) -> Result<bool, Failure> {
        let scratch = Scratch::new("outside")?;
        let folder = scratch.path();
        fs::create_dir_all(folder.join("src"))?;
        fs::write(folder.join("src/main.rs"), self.main)?;
        fs::write(folder.join("Cargo.toml"), self.manifest(root)?)?;
        // The same versions as the workspace, which are on this machine already.
        fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))?;
        // Beside our own builds, so that a second run finds everything made.
        let target = std::env::var_os("CARGO_TARGET_DIR");
        let target = target.unwrap_or_else(|| root.join("target").into());
        let output = cargo_in(folder)
            .args(["run", "--quiet"])
            .env("CARGO_TARGET_DIR", target)
            .stderr(std::process::Stdio::inherit())
            .output()?;
        let printed = String::from_utf8_lossy(&output.stdout);
        say!("{:<10} {}", self.folder, printed.trim_end());
        if output.status.success() && printed.trim_end() == self.prints {
            return Ok(true);
        }
        say!("expected   {}", self.prints);
        Ok(false)
    }

    fn manifest(&self, root: &Path) -> Result<String, Failure> {
        // JSON strings are TOML strings too: quotes and backslashes of a path are escaped alike.
        let path = root.join("crates").join(self.folder);
        let path = serde_json::to_string(&path.to_string_lossy())?;
        let features = serde_json::to_string(self.features)?;
        let name = match self.folder {
            "carom" => "carom".to_owned(),
            layer => format!("carom-{layer}"),
        };
        Ok(format!(
            "[package]\nname = \"outside-{}\"\nversion = \"0.1.0\"\nedition = \"2024\"\npublish = false\n\n\
             [dependencies]\n{name} = {{ path = {path}, features = {features} }}\n\n[workspace]\n",
            self.folder
        ))
    }
}
