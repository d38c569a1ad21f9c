//! `accuracy`: run time against error, on scenes with a closed form.

mod cases;
mod chart;

use std::fmt::Write as _;

use serde::Serialize;

use crate::exit::{End, Outcome};
use crate::files;
use crate::flags::AccuracyArgs;
use crate::interrupt;
use crate::out::say;
use crate::progress::Progress;

use cases::CASES;

/// Ticks per second of the sweep.
const RATES: [u32; 4] = [60, 120, 240, 480];

/// Below this an error is rounding, and has no order, in m.
const ROUNDING: f64 = 1e-12;

/// One point of the table.
#[derive(Clone, Copy, Debug, Serialize)]
struct Row {
    case: &'static str,
    /// Ticks per simulated second.
    rate: u32,
    /// Distance from the closed form, in m.
    error_m: f64,
    /// Fastest run, in ms per simulated second.
    ms_per_second: f64,
}

pub(crate) fn run(args: &AccuracyArgs) -> Outcome {
    files::make_folder(&args.out)?;
    args.json.as_deref().map_or(Ok(()), files::prepare)?;
    interrupt::watch()?;
    if !args.quick {
        say!("there is only the quick sweep at this stage");
    }
    let total = (CASES.len() * RATES.len()) as u64;
    let mut progress = Progress::new("accuracy", total, "runs");
    let mut rows = Vec::new();
    'sweep: for case in CASES {
        for rate in RATES {
            if interrupt::asked() {
                break 'sweep;
            }
            let found = case.measure(rate)?;
            rows.push(Row {
                case: case.name,
                rate,
                error_m: found.error,
                ms_per_second: found.milliseconds,
            });
            progress.advance();
        }
    }
    progress.finish();
    print(&rows);

    let csv = args.out.join("accuracy.csv");
    carom_render::write_file(&csv, csv_of(&rows).as_bytes())?;
    say!("table        {}", csv.display());
    for path in chart::write(&args.out, &rows)? {
        say!("chart        {}", path.display());
    }
    if let Some(path) = &args.json {
        files::write_json(path, &rows)?;
        say!("json         {}", path.display());
    }
    Ok(if interrupt::asked() {
        End::Interrupted
    } else {
        End::Done
    })
}

fn print(rows: &[Row]) {
    for case in CASES {
        let of_case: Vec<&Row> = rows.iter().filter(|row| row.case == case.name).collect();
        say!("{}: {}", case.name, case.about);
        say!(
            "  {:>10} {:>12} {:>16}",
            "ticks/s",
            "error (m)",
            "ms per sim. s"
        );
        for row in &of_case {
            say!(
                "  {:>10} {:>12} {:>16.4}",
                row.rate,
                crate::summary::short(row.error_m),
                row.ms_per_second
            );
        }
        match order(&of_case) {
            Some(order) => say!("  observed order {order:.2}"),
            None => say!("  observed order: none, the error is rounding"),
        }
    }
}

/// log₂ of how the error falls when the tick is halved, over the whole sweep.
fn order(rows: &[&Row]) -> Option<f64> {
    let (first, last) = (rows.first()?, rows.last()?);
    if first.rate == last.rate || first.error_m < ROUNDING || last.error_m < ROUNDING {
        return None;
    }
    let finer = f64::from(last.rate) / f64::from(first.rate);
    Some(carom_math::trig::ln(first.error_m / last.error_m) / carom_math::trig::ln(finer))
}

fn csv_of(rows: &[Row]) -> String {
    let mut text = String::from("case,ticks_per_second,error_m,ms_per_simulated_second\n");
    for row in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{},{},{:e},{}",
            row.case, row.rate, row.error_m, row.ms_per_second
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_order_error_has_order_two() {
        let row = |rate: u32| Row {
            case: "x",
            rate,
            error_m: 3.0 / f64::from(rate * rate),
            ms_per_second: 1.0,
        };
        let rows = RATES.map(row);
        let found = order(&rows.iter().collect::<Vec<_>>()).unwrap();
        assert!((found - 2.0).abs() < 1e-12, "{found}");
        let exact = Row {
            error_m: 0.0,
            ..row(60)
        };
        assert_eq!(order(&[&exact, &row(120)]), None);
    }
}
