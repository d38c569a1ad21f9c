//! Pictures side by side: carom's painter against Cairo, tiny-skia and `vello_cpu`.
//!
//! Everybody draws the same state in the same round and takes turns in going first; a number is the median CPU time of one
//! thread. `cargo run --profile bench -p carom-bench --no-default-features --features cairo --bin pictures` prints
//! the tables; with a folder as argument it also writes what everybody drew.

mod faces;
mod peers;
mod scene;
mod tables;

use std::path::PathBuf;

use scene::Arrows;

fn main() {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    println!("## Drawing, arrows of three strokes\n");
    tables::raster(Arrows::Strokes, &tables::ROWS, folder.as_deref());
    println!("\n## Drawing, arrows of one outline\n");
    tables::raster(Arrows::Outlines, &tables::ROWS[..4], None);
    println!("\n## Packing\n");
    tables::packing();
    println!("\n## Whole frames\n");
    tables::frames();
    println!("\n## What does not move\n");
    tables::skipping();
    println!("\n## Faces\n");
    tables::faces();
}
