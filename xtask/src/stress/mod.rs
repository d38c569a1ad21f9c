//! `stress`: cases that broke physics engines, each with what was measured and what is asked for.
//!
//! Numbers up to 48 are those of the project's list of failure reports; from 101 on a case is a million random pairs or shapes.

mod pairs;
mod shapes;
mod worlds;

use std::panic::catch_unwind;

use crate::clock::Clock;
use crate::exit::{End, Failure, Outcome, fail};
use crate::flags::StressArgs;
use crate::interrupt;
use crate::out::say;

/// One case of the list.
#[derive(Clone, Copy, Debug)]
struct Case {
    number: u8,
    name: &'static str,
    about: &'static str,
    run: fn() -> Result<Finding, Failure>,
}

/// What a case measured.
#[derive(Debug)]
struct Finding {
    passed: bool,
    measured: String,
    wanted: &'static str,
}

impl Finding {
    /// Passes if the number is at most `limit`; NaN falls short.
    fn at_most(limit: f64, measured: f64, unit: &str, wanted: &'static str) -> Self {
        Self {
            passed: measured <= limit,
            measured: format!("{measured:.2e} {unit}").trim_end().to_owned(),
            wanted,
        }
    }
}

const CASES: [Case; 16] = [
    Case {
        number: 1,
        name: "far-polygon",
        about: "inertia of a polygon 1126 m from its origin",
        run: shapes::far_polygon,
    },
    Case {
        number: 5,
        name: "collinear",
        about: "collinear points and near-collinear fans",
        run: shapes::collinear,
    },
    Case {
        number: 7,
        name: "windings",
        about: "both windings of a polygon around its origin",
        run: shapes::windings,
    },
    Case {
        number: 13,
        name: "bounce",
        about: "elastic ball on a floor, 1000 bounces",
        run: worlds::bounce,
    },
    Case {
        number: 16,
        name: "box-of-one",
        about: "elastic ball in a box, no gravity, smooth and rough walls",
        run: worlds::box_of_one,
    },
    Case {
        number: 29,
        name: "pieces",
        about: "convex pieces of circles with 3 to 1000 corners, and slivers",
        run: shapes::pieces,
    },
    Case {
        number: 34,
        name: "column",
        about: "column of 10 boxes for 60 s, sleeping off",
        run: worlds::column,
    },
    Case {
        number: 37,
        name: "one-point",
        about: "2, 10 and 100 discs that start at one point",
        run: worlds::one_point,
    },
    Case {
        number: 39,
        name: "nan",
        about: "NaN force, infinite position from the caller",
        run: worlds::not_finite,
    },
    Case {
        number: 40,
        name: "order",
        about: "the same scene twice, and with bodies inserted backwards",
        run: worlds::order,
    },
    Case {
        number: 101,
        name: "convex-pairs",
        about: "a million convex pairs: depth, distance, witnesses, swap, exact shifts",
        run: pairs::convex_pairs,
    },
    Case {
        number: 102,
        name: "concave-pairs",
        about: "a million pairs of any shape: distance, contacts, shared area, pieces",
        run: pairs::concave_pairs,
    },
    Case {
        number: 103,
        name: "impacts",
        about: "a million times of impact against sampled time",
        run: pairs::times_of_impact,
    },
    Case {
        number: 104,
        name: "masses",
        about: "mass properties of a million rings, against whole numbers",
        run: pairs::masses,
    },
    Case {
        number: 105,
        name: "convex-pieces",
        about: "convex pieces of a million polygons: shape, area, moments",
        run: pairs::pieces,
    },
    Case {
        number: 106,
        name: "generators",
        about: "a million numbers for every generator of polygons",
        run: pairs::generators,
    },
];

pub(crate) fn run(args: &StressArgs) -> Outcome {
    let chosen = choose(args.case.as_deref())?;
    interrupt::watch("finishing the case")?;
    say!(
        "{:>3}  {:<12} {:<11} {:<52} wanted",
        "no",
        "case",
        "",
        "measured"
    );
    let (mut short, mut done) = (0, 0);
    for case in &chosen {
        if interrupt::asked() {
            say!("interrupted after {done} of {} cases", chosen.len());
            return Ok(End::Interrupted);
        }
        let clock = Clock::start();
        let finding = match catch_unwind(case.run) {
            Ok(finding) => finding?,
            Err(_) => Finding {
                passed: false,
                measured: "panicked".to_owned(),
                wanted: "no panic",
            },
        };
        let verdict = if finding.passed {
            "pass"
        } else {
            "FALLS SHORT"
        };
        say!(
            "{:>3}  {:<12} {verdict:<11} {:<52} {} ({:.1} s)",
            case.number,
            case.name,
            finding.measured,
            finding.wanted,
            clock.seconds()
        );
        done += 1;
        short += usize::from(!finding.passed);
    }
    say!("{} of {done} cases pass", done - short);
    if interrupt::asked() {
        return Ok(End::Interrupted);
    }
    Ok(if short == 0 { End::Done } else { End::Short })
}

fn choose(wanted: Option<&str>) -> Result<Vec<Case>, Failure> {
    let Some(wanted) = wanted else {
        return Ok(CASES.to_vec());
    };
    let found = CASES
        .iter()
        .find(|case| case.name == wanted || case.number.to_string() == wanted);
    match found {
        Some(case) => {
            say!("{}: {}", case.name, case.about);
            Ok(vec![*case])
        }
        None => {
            let names: Vec<String> = CASES
                .iter()
                .map(|case| format!("{} ({})", case.name, case.number))
                .collect();
            fail!("no case '{wanted}': there are {}", names.join(", "))
        }
    }
}
