//! Pictures side by side: carom's painter against Cairo, tiny-skia and `vello_cpu`.
//!
//! All painters draw the same state in the same round and take turns going first; a number is the median CPU time of
//! one thread. `cargo run --profile bench -p carom-bench --no-default-features --features cairo --bin pictures` prints
//! the tables, or those that are named: `drawing`, `packing`, `frames`, `still`, `faces`. `--pictures FOLDER` writes what
//! each drew.

mod faces;
mod peers;
mod scene;
mod tables;

use std::path::Path;
use std::process::ExitCode;

use scene::Arrows;

/// The tables, in the order in which they are printed.
const TABLES: [&str; 5] = ["drawing", "packing", "frames", "still", "faces"];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, folder] = &arguments[..]
        && flag == "--pictures"
    {
        let row = [(800, 800, 200, 3)];
        tables::raster(Arrows::Strokes, &row, Some(Path::new(folder)));
        return ExitCode::SUCCESS;
    }
    if let Some(word) = arguments.iter().find(|a| !TABLES.contains(&a.as_str())) {
        let all = TABLES.join(", ");
        eprintln!("there is no table {word}: one of {all}, or --pictures FOLDER alone");
        return ExitCode::from(2);
    }
    for table in TABLES {
        if arguments.is_empty() || arguments.iter().any(|a| a == table) {
            print(table);
        }
    }
    ExitCode::SUCCESS
}

fn print(table: &str) {
    match table {
        "drawing" => {
            println!("## Drawing, arrows of three strokes\n");
            tables::raster(Arrows::Strokes, &tables::ROWS, None);
            println!("\n## Drawing, arrows of one outline\n");
            tables::raster(Arrows::Outlines, &tables::ROWS[..4], None);
        }
        "packing" => {
            println!("\n## Packing\n");
            tables::packing();
        }
        "frames" => {
            println!("\n## Whole frames\n");
            tables::frames();
        }
        "still" => {
            println!("\n## What does not move\n");
            tables::skipping();
        }
        _ => {
            println!("\n## Faces\n");
            tables::faces();
        }
    }
}
