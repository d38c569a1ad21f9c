//! A crate outside of the workspace that depends on `carom-geometry` alone and prints an inertia.

use std::fs;
use std::path::Path;

use super::Scratch;
use crate::exit::Failure;
use crate::laboratory::cargo_in;
use crate::out::say;

const MAIN: &str = r#"use carom_geometry::ConvexPolygon;

fn main() {
    let rectangle = ConvexPolygon::rectangle(2.0, 1.0).expect("two positive sides");
    let mass = rectangle.area_properties().with_mass(12.0);
    println!("inertia {:.12} kg m2", mass.inertia);
}
"#;

/// m (w² + h²) / 12 of 12 kg, 2 m x 1 m.
const EXPECTED: &str = "inertia 5.000000000000 kg m2";

pub(super) fn check(root: &Path) -> Result<bool, Failure> {
    let scratch = Scratch::new("outside")?;
    let folder = scratch.path();
    fs::create_dir_all(folder.join("src"))?;
    fs::write(folder.join("src/main.rs"), MAIN)?;
    fs::write(
        folder.join("Cargo.toml"),
        manifest(&root.join("crates/geometry"))?,
    )?;
    // The same versions as the workspace, which are on this machine already.
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))?;
    // Beside our own builds, so that a second run finds everything made.
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| root.join("target").into());
    let output = cargo_in(folder)
        .args(["run", "--quiet"])
        .env("CARGO_TARGET_DIR", target)
        .stderr(std::process::Stdio::inherit())
        .output()?;
    let printed = String::from_utf8_lossy(&output.stdout);
    say!("{}", printed.trim_end());
    if output.status.success() && printed.trim_end() == EXPECTED {
        return Ok(true);
    }
    say!("expected: {EXPECTED}");
    Ok(false)
}

fn manifest(geometry: &Path) -> Result<String, Failure> {
    // A JSON string is a TOML string too: quotes and backslashes of a path are escaped alike.
    let path = serde_json::to_string(&geometry.to_string_lossy())?;
    Ok(format!(
        "[package]\nname = \"carom-outside\"\nversion = \"0.1.0\"\nedition = \"2024\"\npublish = false\n\n\
         [dependencies]\ncarom-geometry = {{ path = {path} }}\n\n[workspace]\n"
    ))
}
