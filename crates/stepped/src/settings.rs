//! What a caller can set for all bodies.

use carom_math::{Vec2, vec2};

use crate::EngineError;
use crate::error::{check, finite, not_negative, positive};

/// The soft law of contacts.
///
/// A contact at rest sinks in by `compliance × load / (m ω²)` with ω = 2π `frequency`: overlap at rest is
/// softness, not lack of sweeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softness {
    /// Part of the compliance of a spring of that frequency. 0.3 at four sub-steps hums for ever; 1 is Box2D's overlap.
    pub compliance: f64,
    /// Frequency in Hz, at most an eighth of the sub-step's rate; twice that against what cannot be moved.
    ///
    /// Above 30 Hz a pyramid hums for ever (45 Hz: 0.8 m/s²).
    pub frequency: f64,
    /// Damping ratio. 5, 2, 1 make the pyramid hum 1.3, 3, 6 times as much.
    pub damping_ratio: f64,
    /// ω of sweeps with bias, over rows that already push. 1.0 hums.
    pub over_relaxation: f64,
    /// Fastest push-out of an overlap, in m/s.
    pub push_out: f64,
}

/// When islands fall asleep. What nothing fixed or kinematic holds does so only if it does not move at all, or is damped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sleep {
    /// A body rests while no point of it is faster, in its own extents per second.
    ///
    /// Above 0.2 slowly tipping bodies stop in the air; below 0.005 humming piles stay awake.
    pub speed: f64,
    /// It rests, too, while no point of it is faster than this, in m/s.
    pub slow: f64,
    /// How long all bodies of an island must rest, in s: for one tick at least.
    pub after: f64,
}

/// What holds for all bodies; checked by [`crate::Engine::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Acceleration of all dynamic bodies, in m/s².
    pub gravity: Vec2,
    /// Length of a tick, in s: contacts are updated once a tick.
    pub tick: f64,
    /// Sub-steps in a tick.
    pub substeps: u32,
    /// The soft law of contacts.
    pub softness: Softness,
    /// Contacts are kept while the gap is smaller, as a part of the smaller piece's extent.
    ///
    /// Half of it: a tenth sooner in a drum, up to twice the deepest overlap; twice: a tenth dearer.
    pub margin: f64,
    /// A body is rebased, and its contacts computed anew, once it moved so far, as a part of its extent.
    ///
    /// Four tolerances must stay below the margin. Less: settled heaps are computed anew for nothing; more: stale normals.
    pub tolerance: f64,
    /// When islands fall asleep; never if `None`.
    pub sleep: Option<Sleep>,
    /// Islands of up to so many bodies have no springs, and gain no energy by their contacts, for up to forty times the time. All others
    /// have none if they bear loads that sweeps cannot carry.
    pub hard_bodies: usize,
    /// The same of islands of discs that turn about their centres: one point a contact, which turns about nothing, is soon held.
    pub hard_discs: usize,
}

impl Default for Softness {
    fn default() -> Self {
        Self {
            compliance: 0.5,
            frequency: 30.0,
            damping_ratio: 10.0,
            over_relaxation: 1.5,
            push_out: 3.0,
        }
    }
}

impl Sleep {
    /// Speed up to which a body of this extent, in m, counts as at rest, in m/s.
    pub(crate) const fn least(&self, extent: f64) -> f64 {
        (self.speed * extent).max(self.slow)
    }
}

impl Default for Sleep {
    fn default() -> Self {
        Self {
            speed: 0.05,
            slow: 0.0,
            after: 0.5,
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gravity: vec2(0.0, -9.81),
            tick: 1.0 / 60.0,
            substeps: 5,
            softness: Softness::default(),
            margin: 0.06,
            tolerance: 0.005,
            sleep: Some(Sleep::default()),
            hard_bodies: 0,
            hard_discs: 0,
        }
    }
}

impl Settings {
    /// Less time, more overlap: four sub-steps of a softer law.
    #[must_use]
    pub fn fast() -> Self {
        let softness = Softness {
            compliance: 1.0,
            ..Softness::default()
        };
        Self {
            substeps: 4,
            softness,
            ..Self::default()
        }
    }

    /// Less overlap, more time: six sub-steps of a stiffer law.
    #[must_use]
    pub fn accurate() -> Self {
        let softness = Softness {
            compliance: 0.3,
            ..Softness::default()
        };
        Self {
            substeps: 6,
            softness,
            ..Self::default()
        }
    }

    /// Length of a sub-step, in s.
    #[must_use]
    pub fn substep(&self) -> f64 {
        self.tick / f64::from(self.substeps)
    }

    pub(crate) fn check(&self) -> Result<(), EngineError> {
        finite("Settings::gravity.x", self.gravity.x)?;
        finite("Settings::gravity.y", self.gravity.y)?;
        positive("Settings::tick", self.tick)?;
        let count = f64::from(self.substeps);
        let good = (1..=1_000_000).contains(&self.substeps);
        check("Settings::substeps", count, good, "from 1 to 1000000")?;
        let soft = &self.softness;
        not_negative("Softness::compliance", soft.compliance)?;
        positive("Softness::frequency", soft.frequency)?;
        positive("Softness::damping_ratio", soft.damping_ratio)?;
        let good = soft.over_relaxation > 0.0 && soft.over_relaxation < 2.0;
        let field = "Softness::over_relaxation";
        check(field, soft.over_relaxation, good, "above 0 and below 2")?;
        not_negative("Softness::push_out", soft.push_out)?;
        let good = self.margin > 0.0 && self.margin <= 1.0;
        check("Settings::margin", self.margin, good, "above 0, at most 1")?;
        let good = self.tolerance > 0.0 && self.tolerance <= 0.25 * self.margin;
        let allowed = "above 0, at most a quarter of the margin";
        check("Settings::tolerance", self.tolerance, good, allowed)?;
        if let Some(sleep) = self.sleep {
            not_negative("Sleep::speed", sleep.speed)?;
            not_negative("Sleep::slow", sleep.slow)?;
            not_negative("Sleep::after", sleep.after)?;
        }
        Ok(())
    }
}
