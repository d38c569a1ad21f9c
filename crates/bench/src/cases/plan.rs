//! At which rates, in which modes and with how many sub-steps a case is run.

use super::Case;
use crate::engine::Mode;
use crate::engines::EngineName;
use crate::job::Point;

/// Steps per simulated second of a full run.
pub const RATES: &[u32] = &[30, 60, 120, 240, 480, 960, 1920, 3840];

/// Of a quick run.
pub(super) const QUICK: &[u32] = &[60, 240];

/// The rate at which sub-steps are swept.
const SWEPT_AT: u32 = 60;

/// Rates at which carom's exact mode is looked at.
const BESIDE: [u32; 3] = [60, 240, 960];

/// The points of an engine's curves in a case: each mode over the rates, then sub-steps at 60 Hz.
///
/// Peers' sub-steps are swept with tuned settings only, carom's in its default and its stepped mode. Its exact mode is
/// looked at at three rates: where it does the same as the default the table shows it. A quick run has the engine's first mode
/// and the case's quick rates alone.
#[must_use]
pub fn points(case: &Case, engine: EngineName, quick: bool) -> Vec<Point> {
    let modes = engine.modes();
    let (modes, rates) = if quick {
        (&modes[..1], case.quick)
    } else {
        (modes, case.rates)
    };
    let point = |mode, hz, substeps| Point {
        engine,
        mode,
        case: case.name.to_owned(),
        hz,
        substeps,
    };
    // The curves go through every number of sub-steps: presets are points on them.
    let modes = modes.iter().copied().filter(|mode| !mode.is_preset());
    let beside = |mode: Mode| mode == Mode::Exact;
    let mut points: Vec<Point> = modes
        .clone()
        .flat_map(|mode| {
            let rates = rates
                .iter()
                .filter(move |hz| !beside(mode) || BESIDE.contains(hz));
            rates.map(move |&hz| point(mode, hz, None))
        })
        .collect();
    if case.sweeps_substeps && !quick {
        let swept: &[u32] = match engine {
            EngineName::Carom => &[1, 2, 4, 8, 16, 32, 64],
            _ => &[1, 2, 8, 16, 32, 64],
        };
        for mode in modes.filter(|mode| *mode != Mode::Stock && !beside(*mode)) {
            points.extend(swept.iter().map(|&n| point(mode, SWEPT_AT, Some(n))));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::CASES;

    fn case(number: &str) -> &'static Case {
        let found = CASES.iter().find(|case| case.name.starts_with(number));
        found.expect("a case of that number")
    }

    #[test]
    fn a_peer_has_two_curves_over_the_rates_and_one_over_sub_steps() {
        let points = points(case("01"), EngineName::Rapier, false);
        assert_eq!(points.len(), 2 * 8 + 6);
        let swept = points.iter().filter(|point| point.substeps.is_some());
        assert!(swept.clone().all(|p| p.hz == 60 && p.mode == Mode::Tuned));
        assert_eq!(swept.count(), 6);
    }

    #[test]
    fn carom_sweeps_its_default_and_stepped_mode_and_looks_at_its_exact_one() {
        let points = points(case("01"), EngineName::Carom, false);
        assert_eq!(points.len(), 2 * (8 + 7) + 3);
    }

    #[test]
    fn a_quick_run_has_one_mode_and_the_quick_rates() {
        for case in CASES {
            let points = points(case, EngineName::Carom, true);
            assert_eq!(points.len(), case.quick.len(), "{}", case.name);
            assert!(case.quick.iter().all(|hz| case.rates.contains(hz)));
        }
    }
}
