//! `[settings]`, gravity and the parameters that stand for them.

use carom_dynamics::impact::ImpactLaw;
use carom_dynamics::{Mode, PairSearch, Settings, Several, Sleep, Softness};

use crate::model::{LawName, ModeName, PairsName, SceneFile, SeveralName, SleepChoice};

/// The engine's settings; what the file does not say is the engine's default.
pub(crate) fn settings(file: &SceneFile) -> Settings {
    let default = Settings::default();
    let table = &file.settings;
    let parameters = &file.parameters;
    let contact = &table.contact;
    let soft = Softness::default();
    let gravity = parameters.fconst.or(file.gravity);
    let pairs = parameters.collisions.or(table.pairs);
    Settings {
        gravity: gravity.map_or(default.gravity, |gravity| gravity.0),
        tick: parameters.delta.or(table.tick).unwrap_or(default.tick),
        substep: table.substep.unwrap_or(default.substep),
        mode: table.mode.map_or(default.mode, |mode| match mode {
            ModeName::Hybrid => Mode::Hybrid,
            ModeName::Exact => Mode::Exact,
            ModeName::Stepped => Mode::Stepped,
        }),
        pair_search: pairs.map_or(default.pair_search, |pairs| match pairs {
            PairsName::None => PairSearch::None,
            PairsName::All => PairSearch::AllPairs,
            PairsName::Indexed => PairSearch::Indexed,
        }),
        impact_law: table
            .impact_law
            .map_or(default.impact_law, |law| match law {
                LawName::Newton => ImpactLaw::Newton,
                LawName::Poisson => ImpactLaw::Poisson,
                LawName::Stronge => ImpactLaw::Stronge,
            }),
        several: table
            .several
            .map_or(default.several, |choice| match choice {
                SeveralName::Blend => Several::Blend,
                SeveralName::Newton => Several::NewtonLcp,
                SeveralName::Reflections => Several::Reflections,
            }),
        field_error: table.field_error.unwrap_or(default.field_error),
        contact: Softness {
            frequency: contact.frequency.unwrap_or(soft.frequency),
            damping_ratio: contact.damping_ratio.unwrap_or(soft.damping_ratio),
            compliance: contact.compliance.unwrap_or(soft.compliance),
            over_relaxation: contact.over_relaxation.unwrap_or(soft.over_relaxation),
            push_out: contact.push_out.unwrap_or(soft.push_out),
        },
        sleep: match table.sleep {
            None => default.sleep,
            Some(SleepChoice::Never) => None,
            Some(SleepChoice::Default) => Some(Sleep::default()),
            Some(SleepChoice::After(after)) => Some(Sleep {
                speed: after.speed.unwrap_or(Sleep::default().speed),
                time: after.time.unwrap_or(Sleep::default().time),
            }),
        },
        history: table.history.unwrap_or(default.history),
        events: table.events.unwrap_or(default.events),
        threads: table.threads.unwrap_or(default.threads),
        work: default.work,
    }
}
