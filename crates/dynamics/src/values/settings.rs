//! How a world computes.

use carom_math::{Vec2, vec2};

use super::error::{SettingsError, WORLD_LIMIT};
use crate::impact::{ImpactLaw, Several};

/// All that a world can be told before it starts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(remote = "Self", default, deny_unknown_fields)
)]
pub struct Settings {
    /// Uniform acceleration of every dynamic body, in m/s²; each component up to [`crate::WORLD_LIMIT`].
    pub gravity: Vec2,
    /// Longest stretch between two looks at the whole world, in s.
    pub tick: f64,
    /// Longest sub-step of bodies in lasting contact, in s; a tick holds a whole number of them.
    ///
    /// Resting contacts sink in with its square (see [`Softness::compliance`]): the top of a
    /// stack of ten 1 m boxes by 9.6 mm at 1/240 s, 4.3 mm at 1/360 s, 2.4 mm at 1/480 s.
    pub substep: f64,
    /// Which bodies are sub-stepped.
    pub mode: Mode,
    /// How pairs that may meet are found.
    pub pair_search: PairSearch,
    /// Which law single impacts follow.
    pub impact_law: ImpactLaw,
    /// How contacts at one instant share an impact.
    pub several: Several,
    /// What the path of a body in a field may leave out, in m for each second of its flight. About a
    /// single Newtonian centre without uniform gravity paths are conics, and leave out nothing.
    pub field_error: f64,
    /// The soft law of lasting contacts.
    pub contact: Softness,
    /// When groups at rest fall asleep; `None`: never.
    pub sleep: Option<Sleep>,
    /// Most work in a tick, for each thousand bodies or fewer: events (impacts, ends of searches, changes of contact mode,
    /// sub-steps; a piece of a law counts as 16, an impact of several contacts as one for each thousand of its floating-point
    /// operations) and pairs looked at by shape. A [step](crate::World::step) that needs more stops
    /// early between two events, and says so; the next one goes on.
    pub work: u64,
    /// How many replaced motions are kept for [`crate::World::pose_at`]; 0 keeps none.
    pub history: usize,
    /// How many events of a step are kept; the buffer says what it left out.
    pub events: usize,
    /// How many threads a step may use, 1 to 1024: their number changes no bit. No method shares its work among threads yet, and none
    /// are started.
    pub threads: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gravity: vec2(0.0, -9.81),
            tick: 1.0 / 60.0,
            substep: 1.0 / 360.0,
            mode: Mode::default(),
            pair_search: PairSearch::default(),
            impact_law: ImpactLaw::default(),
            several: Several::default(),
            field_error: 1e-12,
            contact: Softness::default(),
            sleep: Some(Sleep::default()),
            work: 100_000,
            history: 0,
            events: 4096,
            threads: 1,
        }
    }
}

impl Settings {
    /// Piles at rest to within less: contacts a little softer than the sub-step allows.
    #[must_use]
    pub fn calm() -> Self {
        Self {
            contact: Softness {
                frequency: 30.0,
                ..Softness::default()
            },
            ..Self::default()
        }
    }

    /// Sub-steps of 1/480 s: contacts sink in 9/16 as deep as by default, at up to 4/3 of the time.
    #[must_use]
    pub fn accurate() -> Self {
        Self {
            substep: 1.0 / 480.0,
            ..Self::default()
        }
    }

    /// Sub-steps of 1/240 s, and contacts soft enough to lie still with so few: four times as deep as the
    /// default's. Pyramids take 0.8 of its time, heaps of convex polygons 0.9, of concave ones as much, of long rods, which go on
    /// humming, twice as much.
    /// A pyramid of 5,050 boxes sinks in by 10 mm, and hums 0.4 times as much. Of 9,600 boxes that are struck some
    /// overlap by 64 mm, 1.4 mm by default.
    #[must_use]
    pub fn fast() -> Self {
        Self {
            substep: 1.0 / 240.0,
            contact: Softness {
                frequency: 22.0,
                ..Softness::default()
            },
            ..Self::default()
        }
    }
}

/// Which method a world may use.
///
/// In hybrid and exact mode impacts are found at their exact instants; the report of a run in
/// [`Mode::Exact`] says how many groups had to be sub-stepped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum Mode {
    /// Each island the cheapest method that is right for it. Large islands, and many bodies with impacts in fast
    /// succession, are moved by a solver of their own in sub-steps; what strikes them joins them.
    #[default]
    Hybrid,
    /// Closed forms wherever there are some, however often islands change; what they cannot finish is sub-stepped as in hybrid mode,
    /// but small heaps of discs without gain of energy, and marks the run as not exact. So does a body that
    /// spends more than 4,096 losses of relative speed in impacts within a tick; elastic ones without friction spend
    /// nothing.
    Exact,
    /// Every moving body is sub-stepped in one solver, without an event queue: contacts stay from step to
    /// step, a pair that keeps its relative pose costs no look. Impacts are as sharp as a sub-step,
    /// but a body too fast for that is stopped at its time of impact.
    Stepped,
}

/// How pairs that may meet are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum PairSearch {
    /// A tree of boxes.
    #[default]
    Indexed,
    /// Every body against every other: the slow twin.
    AllPairs,
    /// No pairs: no body meets another.
    None,
}

/// The soft law of lasting contacts that are sub-stepped: a damped spring that is solved implicitly. Up to 64 discs have none in
/// [`Mode::Exact`].
///
/// At rest a contact sinks in by `compliance · load / (m ω²)` with ω = 2π `frequency` and m the
/// pair's reduced mass; a fixed partner doubles the frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Softness {
    /// Natural frequency of push-out, in Hz; held below 1/8 of the sub-step rate.
    pub frequency: f64,
    /// Damping ratio of push-out. Below 10 piles hum.
    pub damping_ratio: f64,
    /// Factor on the compliance that the frequency implies. Below 0.3 piles chatter.
    pub compliance: f64,
    /// Over-relaxation of the sweeps that push overlaps out, 0.1..=1.9; below 1 it is under-relaxation. Those that
    /// relax have none: friction acts at once by what pushes, and jammed columns would hum. Sweeps that are repeated have
    /// 0.6 of what it differs from 1 by in both.
    pub over_relaxation: f64,
    /// Fastest push-out of an overlap, in m/s.
    pub push_out: f64,
}

impl Default for Softness {
    fn default() -> Self {
        Self {
            frequency: 1e6,
            damping_ratio: 10.0,
            compliance: 0.3,
            over_relaxation: 1.5,
            push_out: 3.0,
        }
    }
}

/// When groups at rest fall asleep. What nothing fixed or kinematic holds does so only if it does not move at all, or is damped.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Sleep {
    /// Speed of the fastest point of a body below which it counts as at rest, in m/s.
    pub speed: f64,
    /// How long a whole group must be at rest, in s: for one sub-step at least, or one tick of the engine.
    pub time: f64,
}

impl Default for Sleep {
    fn default() -> Self {
        Self {
            speed: 0.01,
            time: 0.5,
        }
    }
}

impl Settings {
    pub(crate) fn check(&self) -> Result<(), SettingsError> {
        range("gravity.x", self.gravity.x, -WORLD_LIMIT, WORLD_LIMIT)?;
        range("gravity.y", self.gravity.y, -WORLD_LIMIT, WORLD_LIMIT)?;
        range("tick", self.tick, 1e-9, 1e6)?;
        range("substep", self.substep, 1e-9, 1e6)?;
        // A tick of more sub-steps than this is a typing error, not a wish.
        range("tick / substep", self.tick / self.substep, 0.0, 1e6)?;
        range("field_error", self.field_error, 1e-15, 1e3)?;
        #[expect(clippy::cast_precision_loss, reason = "only their size counts")]
        let (work, threads) = (self.work as f64, self.threads as f64);
        range("work", work, 1.0, f64::MAX)?;
        range("threads", threads, 1.0, 1024.0)?;
        let contact = &self.contact;
        range("contact.frequency", contact.frequency, 1e-9, 1e9)?;
        range("contact.damping_ratio", contact.damping_ratio, 1e-9, 1e9)?;
        range("contact.over_relaxation", contact.over_relaxation, 0.1, 1.9)?;
        range("contact.push_out", contact.push_out, 0.0, 1e12)?;
        range("contact.compliance", contact.compliance, 0.0, 1e9)?;
        if let Some(sleep) = &self.sleep {
            range("sleep.speed", sleep.speed, 0.0, 1e12)?;
            range("sleep.time", sleep.time, 0.0, 1e12)?;
        }
        Ok(())
    }

    /// Names of the fields that differ and are fixed for the life of a world: the grid of sub-steps, the method and the pair search are
    /// built into it.
    pub(crate) fn fixed_in(&self, others: &Self) -> Vec<&'static str> {
        let differ = [
            ("tick", self.tick.to_bits() != others.tick.to_bits()),
            (
                "substep",
                self.substep.to_bits() != others.substep.to_bits(),
            ),
            ("mode", self.mode != others.mode),
            ("pair_search", self.pair_search != others.pair_search),
        ];
        let differ = differ.iter().filter(|(_, differs)| *differs);
        differ.map(|(field, _)| *field).collect()
    }

    /// Whether bodies would move otherwise under others; what is kept and counted aside.
    pub(crate) fn moves_as(&self, others: &Self) -> bool {
        let others = Self {
            work: self.work,
            history: self.history,
            events: self.events,
            threads: self.threads,
            ..*others
        };
        *self == others
    }

    /// How many sub-steps a tick holds.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked to lie in 1..1e6"
    )]
    pub(crate) fn substeps_per_tick(&self) -> u32 {
        // 1/60 over 1/240 may come out a rounding above 4.
        let count = (self.tick / self.substep * (1.0 - 1e-12)).ceil();
        count.max(1.0) as u32
    }

    /// Length of a sub-step, in s.
    pub(crate) fn h(&self) -> f64 {
        self.tick / f64::from(self.substeps_per_tick())
    }
}

fn range(field: &'static str, value: f64, low: f64, high: f64) -> Result<(), SettingsError> {
    if !value.is_finite() {
        return Err(SettingsError::NotFinite { field, value });
    }
    if value <= 0.0 && low > 0.0 {
        return Err(SettingsError::NotPositive { field, value });
    }
    if !(low..=high).contains(&value) {
        return Err(SettingsError::OutOfRange {
            field,
            value,
            low,
            high,
        });
    }
    Ok(())
}
