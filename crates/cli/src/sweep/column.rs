//! What a sweep reports of a run: `energy`, `impacts`, `body.ball.x`, …

use std::str::FromStr;

use carom_dynamics::StepReport;
use carom_scenes::Built;

use crate::exit::{Failure, fail};
use crate::number::number;

/// A column of the table, read at the end of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    name: String,
    what: What,
}

#[derive(Clone, Debug, PartialEq)]
enum What {
    Run(OfRun),
    Body(String, OfBody),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OfRun {
    Energy,
    Kinetic,
    Potential,
    Impacts,
    Overlap,
    Exact,
    Hash,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OfBody {
    X,
    Y,
    Angle,
    Vx,
    Vy,
    Omega,
}

const OF_RUN: [(&str, OfRun); 7] = [
    ("energy", OfRun::Energy),
    ("kinetic", OfRun::Kinetic),
    ("potential", OfRun::Potential),
    ("impacts", OfRun::Impacts),
    ("overlap", OfRun::Overlap),
    ("exact", OfRun::Exact),
    ("hash", OfRun::Hash),
];

const OF_BODY: [(&str, OfBody); 6] = [
    ("x", OfBody::X),
    ("y", OfBody::Y),
    ("angle", OfBody::Angle),
    ("vx", OfBody::Vx),
    ("vy", OfBody::Vy),
    ("omega", OfBody::Omega),
];

impl FromStr for Column {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let name = text.trim();
        let of_run = OF_RUN.iter().find(|(known, _)| *known == name);
        let of_body = name
            .strip_prefix("body.")
            .and_then(|rest| rest.rsplit_once('.'))
            .and_then(|(body, last)| {
                let found = OF_BODY.iter().find(|(known, _)| *known == last)?;
                Some(What::Body(body.to_owned(), found.1))
            });
        let what = of_run.map(|(_, what)| What::Run(*what)).or(of_body);
        let what = what.ok_or_else(|| {
            let names = OF_RUN.map(|(name, _)| name).join(", ");
            let ends = OF_BODY.map(|(name, _)| name).join(", ");
            format!("not a column: {names}, or body.NAME. and one of {ends}")
        })?;
        Ok(Self {
            name: name.to_owned(),
            what,
        })
    }
}

impl Column {
    /// The column's name, as it was given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it says of a run that has ended.
    pub fn read(&self, built: &Built, report: &StepReport) -> Result<String, Failure> {
        let world = &built.world;
        let what = match &self.what {
            What::Run(what) => *what,
            What::Body(name, what) => {
                let body = built.body(name).and_then(|id| world.body(id));
                let Some(body) = body else {
                    fail!("--report {}: there is no body named '{name}'", self.name);
                };
                return Ok(number(match what {
                    OfBody::X => body.centre().x,
                    OfBody::Y => body.centre().y,
                    OfBody::Angle => body.angle(),
                    OfBody::Vx => body.velocity().x,
                    OfBody::Vy => body.velocity().y,
                    OfBody::Omega => body.angular_velocity(),
                }));
            }
        };
        Ok(match what {
            OfRun::Energy => number(world.energy().mechanical()),
            OfRun::Kinetic => number(world.energy().kinetic),
            OfRun::Potential => number(world.energy().potential),
            OfRun::Impacts => report.impacts.to_string(),
            OfRun::Overlap => number(report.deepest_overlap),
            OfRun::Exact => report.is_exact().to_string(),
            OfRun::Hash => format!("{:016x}", world.state_hash()),
        })
    }
}
