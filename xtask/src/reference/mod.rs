//! `reference`: every case of a folder, answered by the library and checked.

mod book;
mod bounds;
mod check;
mod decimal;
mod first_contact;
mod flight;
mod friction;
mod gas;
mod horizon;
mod impact;
mod line;
mod mass;
mod outline;
mod simultaneous;
mod stage;
mod symmetry;
mod tableau;

use std::hint::black_box;

use carom_cli::ModeFlag;
use carom_dynamics::Mode;
use carom_math::Vec2;

use crate::clock::Clock;
use crate::exit::{End, Outcome};
use crate::files::Json;
use crate::flags::ReferenceArgs;
use crate::out::say;

use book::{Answer, Case, Outputs, Results};
use first_contact::FirstContactCase;
use flight::FlightCase;
use friction::FrictionCase;
use gas::GasCase;
use impact::ImpactCase;
use line::LineCase;
use mass::MassCase;
use simultaneous::SimultaneousCase;
use stage::Play;
use symmetry::Symmetry;
use tableau::SceneCase;

/// Faults that are listed for a category before the rest is only counted.
const LISTED: usize = 10;

/// How cases are asked: in a guise, and worlds in a mode.
#[derive(Clone, Copy, Debug)]
struct Asked {
    seed: Option<u64>,
    mode: Mode,
}

pub(crate) fn run(args: &ReferenceArgs) -> Outcome {
    let json = args.json.as_deref().map(Json::create).transpose()?;
    let books = book::read_folder(&args.dir)?;
    let asked = Asked {
        seed: args.transform,
        mode: match args.mode {
            ModeFlag::Exact => Mode::Exact,
            ModeFlag::Hybrid => Mode::Hybrid,
            ModeFlag::Stepped => Mode::Stepped,
        },
    };
    let mut answers = Vec::new();
    let (mut passed, mut total) = (0, 0);
    for book in &books {
        let mut tally = Tally::default();
        for case in &book.cases {
            let answer = answer(&book.category, case, asked);
            let verdict = check::check(&book.category, case, &answer);
            if args.list {
                list(case, &verdict);
            }
            tally.count(case, &answer, &verdict);
            answers.push(answer);
        }
        tally.print(&book.category, book.cases.len(), args.list);
        passed += tally.passed;
        total += book.cases.len();
    }
    say!("{passed} of {total} reference cases pass");
    if let (Some(json), Some(path)) = (json, &args.json) {
        let results = Results {
            engine: "carom",
            cases: answers,
        };
        json.finish(&results)?;
        say!("answers in {}", path.display());
    }
    Ok(if passed == total {
        End::Done
    } else {
        End::Short
    })
}

/// `pass ID`, or `fall short ID: why`.
fn list(case: &Case, verdict: &check::Verdict) {
    match verdict.faults.as_slice() {
        [] => say!("pass {}", case.id),
        faults => say!("fall short {}: {}", case.id, faults.join("; ")),
    }
}

fn answer(category: &str, case: &Case, asked: Asked) -> Answer {
    let (found, error) = match solve(category, case, asked) {
        Ok(found) => (Some(found), None),
        Err(error) => (None, Some(error)),
    };
    let (seconds, outputs) = found.unzip();
    Answer {
        id: case.id.clone(),
        seconds,
        outputs,
        error,
    }
}

/// The answer and the seconds that it took.
fn solve(category: &str, case: &Case, asked: Asked) -> Result<(f64, Outputs), String> {
    let seed = asked.seed;
    match category {
        "mass_properties" => mass_properties(case, seed),
        "impacts" => impacts(case, seed),
        "simultaneous" => simultaneous(case, seed),
        "time_of_impact" => first_contact(case, seed),
        "flight_bounce" => played(case, asked, &FlightCase::read(&case.inputs)?),
        "friction" => friction(case, asked),
        "billiards" => played(case, asked, &GasCase::read_billiard(&case.inputs)?),
        "disc_gas" => played(case, asked, &GasCase::read_gas(case)?),
        "chains" => played(case, asked, &LineCase::read_chain(&case.inputs)?),
        "galperin" => played(case, asked, &LineCase::read_galperin(&case.inputs)?),
        "scenes" => played(case, asked, &SceneCase::read(&case.inputs)?),
        _ => Err(format!("category {category} is not answered yet")),
    }
}

/// A world built, stepped and read, with the time that all of it took.
fn played(case: &Case, asked: Asked, question: &impl Play) -> Result<(f64, Outputs), String> {
    let seed = asked.seed;
    let cast = question.cast();
    let mut symmetry = guise(seed, case, &cast.places());
    if cast.gravity != Vec2::ZERO {
        // The potential energy of the answer counts from the case's own origin.
        symmetry.shift = Vec2::ZERO;
    }
    let clock = Clock::start();
    let mut stage = cast.enter(&symmetry, seed.is_some(), asked.mode)?;
    let outputs = question.play(&mut stage)?;
    Ok((clock.seconds(), outputs))
}

/// Where a case asks about several worlds, each is played.
fn friction(case: &Case, asked: Asked) -> Result<(f64, Outputs), String> {
    let mut seconds = 0.0;
    let mut outputs = Outputs::new();
    for question in FrictionCase::read(&case.inputs)? {
        let (spent, mut found) = played(case, asked, &question)?;
        seconds += spent;
        outputs.append(&mut found);
    }
    Ok((seconds, outputs))
}

fn mass_properties(case: &Case, seed: Option<u64>) -> Result<(f64, Outputs), String> {
    let question = MassCase::read(&case.inputs)?;
    let places = question.places().to_vec();
    let (question, symmetry) = guised(seed, case, &places, question, MassCase::transformed);
    let (seconds, found) = timed(|| question.answer());
    Ok((seconds, question.outputs(&found?, &symmetry)))
}

fn impacts(case: &Case, seed: Option<u64>) -> Result<(f64, Outputs), String> {
    let question = ImpactCase::read(&case.inputs)?;
    let places = question.places();
    let (question, symmetry) = guised(seed, case, &places, question, ImpactCase::transformed);
    let (seconds, found) = timed(|| question.answer());
    Ok((seconds, ImpactCase::outputs(&found?, &symmetry)))
}

fn simultaneous(case: &Case, seed: Option<u64>) -> Result<(f64, Outputs), String> {
    let question = SimultaneousCase::read(&case.inputs)?;
    let places = question.places();
    let (question, symmetry) = guised(seed, case, &places, question, SimultaneousCase::transformed);
    let (seconds, found) = timed(|| question.answer());
    Ok((seconds, question.outputs(&found, &symmetry)))
}

fn first_contact(case: &Case, seed: Option<u64>) -> Result<(f64, Outputs), String> {
    let question = FirstContactCase::read(&case.inputs)?;
    let places = question.places();
    let (question, symmetry) = guised(seed, case, &places, question, FirstContactCase::transformed);
    let pair = question.built()?;
    let (seconds, found) = timed(|| pair.answer());
    Ok((seconds, FirstContactCase::outputs(&found, &symmetry)?))
}

/// A question in the guise that the seed gives it; without a seed as it is.
fn guised<Q>(
    seed: Option<u64>,
    case: &Case,
    places: &[Vec2],
    question: Q,
    transformed: impl Fn(Q, &Symmetry) -> Q,
) -> (Q, Symmetry) {
    let symmetry = guise(seed, case, places);
    let question = if seed.is_some() {
        transformed(question, &symmetry)
    } else {
        question
    };
    (question, symmetry)
}

fn guise(seed: Option<u64>, case: &Case, places: &[Vec2]) -> Symmetry {
    seed.map_or(Symmetry::NONE, |seed| {
        Symmetry::choose(seed, &case.id, places)
    })
}

fn timed<T>(ask: impl Fn() -> T) -> (f64, T) {
    let clock = Clock::start();
    let found = black_box(ask());
    (clock.seconds(), found)
}

/// What a category came to.
#[derive(Debug, Default)]
struct Tally {
    passed: usize,
    worst: f64,
    seconds: f64,
    faults: Vec<String>,
    unanswered: Option<String>,
}

impl Tally {
    fn count(&mut self, case: &Case, answer: &Answer, verdict: &check::Verdict) {
        self.seconds += answer.seconds.unwrap_or(0.0);
        if verdict.faults.is_empty() {
            self.passed += 1;
            self.worst = self.worst.max(verdict.worst);
        } else if let Some(error) = &answer.error
            && error.ends_with("is not answered yet")
        {
            self.unanswered = Some(error.clone());
        } else {
            self.faults
                .push(format!("{}: {}", case.id, verdict.faults.join("; ")));
        }
    }

    /// The line of the category, after its first faults unless these were `listed` already.
    fn print(&self, category: &str, count: usize, listed: bool) {
        let shown = if listed { 0 } else { LISTED };
        for fault in self.faults.iter().take(shown) {
            say!("  {fault}");
        }
        if self.faults.len() > LISTED && !listed {
            say!("  … and {} more", self.faults.len() - LISTED);
        }
        match &self.unanswered {
            Some(_) => say!(
                "{category}: {} of {count} pass (not answered yet)",
                self.passed
            ),
            None => say!(
                "{category}: {} of {count} pass, worst error {:.1e} of its bound, {:.1e} s",
                self.passed,
                self.worst,
                self.seconds
            ),
        }
    }
}
