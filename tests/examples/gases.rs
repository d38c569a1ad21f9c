//! Elastic gases for thousands of seconds: what is left of their energy, and how single impacts round.
//!
//! ```sh
//! cargo run --release -p carom-tests --example gases -- docs/pictures/exact_energy.png [SECONDS]
//! ```

use std::error::Error;
use std::process::ExitCode;

use carom_math::vec2;
use carom_render::{Chart, Series, Size, Style};
use carom_tests::gas::{Molecule, Watch, gas, kinetic};

fn main() -> ExitCode {
    if let Err(error) = run() {
        eprintln!("error: {error}");
        return ExitCode::from(2);
    }
    ExitCode::SUCCESS
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("usage: gases CHART [SECONDS]")?;
    let seconds = arguments.next().unwrap_or_else(|| "10000".to_owned());
    let seconds: f64 = seconds
        .parse()
        .map_err(|_| format!("'{seconds}' is not a number of seconds"))?;
    let mut chart = Chart::new("What elastic gases lose")
        .subtitled("worst error of the energy so far, single impacts rounded once; a gas in a box, no friction")
        .x("time (s)")
        .y("|E / E(0) − 1|")
        .log_x()
        .log_y();
    println!(
        "gas | impacts | energy, worst | bias of one impact | by chance | momentum | turning | overlap"
    );
    for (name, molecule, side) in [
        ("16 discs", Molecule::Disc, 4),
        ("16 boxes", Molecule::Box, 4),
        ("100 polygons", Molecule::Polygon, 10),
    ] {
        let mut world = gas(molecule, side, 7);
        let start = kinetic(&world);
        let (mut worst, mut shown, mut line) = (0.0_f64, 0.0, Vec::new());
        let mut watch = Watch::default();
        watch.run(&mut world, seconds, 0.5, |time, energy| {
            worst = worst.max((energy / start - 1.0).abs());
            // 40 points a decade are enough, and a logarithm has no place for 0.
            if time >= 1.06 * shown && worst > 0.0 {
                shown = time;
                line.push(vec2(time, worst));
            }
        });
        let (mean, chance) = watch.bias();
        println!(
            "{name} | {} | {worst:.1e} | {mean:.1e} | {chance:.1e} | {:.1e} | {:.1e} | {:.1e}",
            watch.impacts, watch.linear, watch.angular, watch.deepest
        );
        if !watch.report.is_exact() {
            println!("{name}: not exact, {:?}", watch.report);
        }
        chart = chart.with(Series::line(name, line));
    }
    let picture = chart.paint(Size::new(640, 400)?, &Style::light());
    picture.save_small_png(&file)?;
    Ok(())
}
