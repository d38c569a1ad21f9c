//! Where the energy of a run went, over time.

use carom_dynamics::EnergyLedger;
use carom_math::vec2;
use carom_render::{Chart, OutputFolder, Series, Size, Style};

use crate::exit::Failure;

/// Writes the chart as PNG and as SVG, under these names.
pub(super) fn save(
    folder: &OutputFolder,
    scene: &str,
    energy: &[(f64, EnergyLedger)],
    [png, svg]: [&str; 2],
) -> Result<(), Failure> {
    let chart = chart(scene, energy);
    let (size, style) = (Size::new(900, 520)?, Style::light());
    folder.save(png, &chart.paint(size, &style).to_png())?;
    folder.save(svg, chart.frame(size).to_svg(&style).as_bytes())?;
    Ok(())
}

fn chart(scene: &str, energy: &[(f64, EnergyLedger)]) -> Chart {
    // Potential energy has no zero of its own: its lowest value in this run.
    let lowest = energy
        .iter()
        .map(|(_, e)| e.potential)
        .fold(f64::INFINITY, f64::min);
    let line = |name: &str, value: &dyn Fn(&EnergyLedger) -> f64| {
        Series::line(
            name,
            energy
                .iter()
                .map(|(time, e)| vec2(*time, value(e)))
                .collect(),
        )
    };
    let sum = |e: &EnergyLedger| e.mechanical() - lowest + e.impacts + e.friction;
    Chart::new(format!("{scene}: where the energy is"))
        .subtitled("level where nothing is invented: the sum changes only by what the scheme adds")
        .x("time (s)")
        .y("energy (J)")
        .with(line("kinetic", &|e| e.kinetic))
        .with(line("potential", &|e| e.potential - lowest))
        .with(line("lost in impacts", &|e| e.impacts))
        .with(line("lost in friction", &|e| e.friction))
        .with(line("sum", &sum).dashed(6.0))
}
