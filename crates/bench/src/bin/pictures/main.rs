//! Pictures side by side: carom's painter against Cairo, tiny-skia and `vello_cpu`.
//!
//! Everybody draws the same state in the same round and takes turns in going first; a number is the median CPU time of one
//! thread. `cargo run --profile bench -p carom-bench --no-default-features --features cairo --bin pictures` prints
//! the tables, or those that are named: `drawing`, `packing`, `frames`, `still`, `faces`. `--pictures FOLDER` writes what
//! everybody drew.

mod faces;
mod peers;
mod scene;
mod tables;

use std::path::Path;

use scene::Arrows;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let asked = |name: &str| arguments.is_empty() || arguments.iter().any(|a| a == name);
    if asked("drawing") {
        println!("## Drawing, arrows of three strokes\n");
        tables::raster(Arrows::Strokes, &tables::ROWS, None);
        println!("\n## Drawing, arrows of one outline\n");
        tables::raster(Arrows::Outlines, &tables::ROWS[..4], None);
    }
    if asked("packing") {
        println!("\n## Packing\n");
        tables::packing();
    }
    if asked("frames") {
        println!("\n## Whole frames\n");
        tables::frames();
    }
    if asked("still") {
        println!("\n## What does not move\n");
        tables::skipping();
    }
    if asked("faces") {
        println!("\n## Faces\n");
        tables::faces();
    }
    if let [flag, folder] = &arguments[..]
        && flag == "--pictures"
    {
        let row = [(800, 800, 200, 3)];
        tables::raster(Arrows::Strokes, &row, Some(Path::new(folder)));
    }
}
