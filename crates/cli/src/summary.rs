//! What a run came to: impacts, energy, momentum, and everything that was not exact.

use carom_dynamics::{BodyKind, EnergyLedger, Momentum, StepReport, World};
use serde::Serialize;

use crate::out::say;

/// Watches a run from its start.
#[derive(Clone, Copy, Debug)]
pub struct Watch {
    start: Books,
    report: StepReport,
    steps: u64,
    dropped: usize,
    largest_kinetic: f64,
}

#[derive(Clone, Copy, Debug)]
struct Books {
    energy: EnergyLedger,
    momentum: Momentum,
}

impl Books {
    fn of(world: &World) -> Self {
        Self {
            energy: world.energy(),
            momentum: world.momentum(),
        }
    }
}

impl Watch {
    /// Before the first step.
    pub fn start(world: &World) -> Self {
        let start = Books::of(world);
        Self {
            start,
            report: StepReport::default(),
            steps: 0,
            dropped: 0,
            largest_kinetic: start.energy.kinetic,
        }
    }

    /// After each step.
    pub fn saw(&mut self, world: &World, report: StepReport) {
        self.report += report;
        self.steps += 1;
        self.dropped += world.events().dropped();
        self.largest_kinetic = self.largest_kinetic.max(world.energy().kinetic);
    }

    /// After the last step.
    pub fn finish(&self, world: &World, scene: &str) -> Summary {
        let end = Books::of(world);
        let (from, to) = (&self.start.energy, &end.energy);
        // What neither impacts, friction, forces nor the caller account for.
        let drift = (to.mechanical() - from.mechanical())
            + (to.impacts - from.impacts)
            + (to.friction - from.friction)
            - (to.forces - from.forces)
            - (to.external - from.external);
        let moving = world
            .bodies()
            .filter(|body| body.kind() != BodyKind::Fixed)
            .count();
        let report = self.report;
        Summary {
            scene: scene.to_owned(),
            seconds: report.advanced,
            steps: self.steps,
            substeps: report.substeps,
            bodies: world.bodies().count(),
            moving,
            impacts: report.impacts,
            deepest_overlap: report.deepest_overlap,
            energy_start: (*from).into(),
            energy_end: (*to).into(),
            energy_drift: drift,
            energy_drift_relative: drift / self.largest_kinetic.max(f64::MIN_POSITIVE),
            energy_residual: to.residual(),
            momentum_start: self.start.momentum.into(),
            momentum_end: end.momentum.into(),
            momentum_drift: Momentum {
                linear: end.momentum.linear - self.start.momentum.linear,
                angular: end.momentum.angular - self.start.momentum.angular,
            }
            .into(),
            handed_over: report.handed_over,
            unresolved: report.unresolved,
            inaccurate: report.inaccurate,
            sunken: report.sunken,
            collapsed: report.collapsed,
            stopped: report.stopped,
            refused: report.refused.map(|why| why.to_string()),
            events_dropped: self.dropped,
            exact: report.is_exact(),
            state_hash: format!("{:016x}", world.state_hash()),
        }
    }
}

/// The end of a run in numbers; SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    pub(crate) scene: String,
    pub(crate) seconds: f64,
    pub(crate) steps: u64,
    pub(crate) substeps: u64,
    pub(crate) bodies: usize,
    pub(crate) moving: usize,
    pub(crate) impacts: u64,
    pub(crate) deepest_overlap: f64,
    pub(crate) energy_start: Ledger,
    pub(crate) energy_end: Ledger,
    pub(crate) energy_drift: f64,
    pub(crate) energy_drift_relative: f64,
    pub(crate) energy_residual: f64,
    pub(crate) momentum_start: Momenta,
    pub(crate) momentum_end: Momenta,
    pub(crate) momentum_drift: Momenta,
    pub(crate) handed_over: u64,
    pub(crate) unresolved: u64,
    pub(crate) inaccurate: u64,
    pub(crate) sunken: u64,
    pub(crate) collapsed: u64,
    pub(crate) stopped: u64,
    pub(crate) refused: Option<String>,
    pub(crate) events_dropped: usize,
    pub(crate) exact: bool,
    pub(crate) state_hash: String,
}

/// The energy ledger, in J.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Ledger {
    kinetic: f64,
    potential: f64,
    impacts: f64,
    friction: f64,
    forces: f64,
    external: f64,
    scheme: f64,
}

impl From<EnergyLedger> for Ledger {
    fn from(energy: EnergyLedger) -> Self {
        Self {
            kinetic: energy.kinetic,
            potential: energy.potential,
            impacts: energy.impacts,
            friction: energy.friction,
            forces: energy.forces,
            external: energy.external,
            scheme: energy.scheme,
        }
    }
}

/// Momenta, in kg m/s and kg m²/s.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Momenta {
    linear: [f64; 2],
    angular: f64,
}

impl From<Momentum> for Momenta {
    fn from(momentum: Momentum) -> Self {
        Self {
            linear: momentum.linear.to_array(),
            angular: momentum.angular,
        }
    }
}

impl Summary {
    /// The lines of the summary, one story each.
    pub fn lines(&self) -> Vec<String> {
        let (from, to) = (&self.energy_start, &self.energy_end);
        let mut lines = vec![
            format!(
                "bodies       {} ({} moving), {} s in {} steps and {} sub-steps",
                self.bodies,
                self.moving,
                short(self.seconds),
                self.steps,
                self.substeps
            ),
            format!("impacts      {}", self.impacts),
            format!(
                "energy (J)   kinetic {} -> {}, potential {} -> {}",
                short(from.kinetic),
                short(to.kinetic),
                short(from.potential),
                short(to.potential)
            ),
            format!(
                "             lost in impacts {}, in friction {}; done by forces {}, from outside {}, by the scheme {}",
                short(to.impacts - from.impacts),
                short(to.friction - from.friction),
                short(to.forces - from.forces),
                short(to.external - from.external),
                short(to.scheme - from.scheme)
            ),
            format!(
                "energy drift {:.2e} J, {:.2e} of the largest kinetic energy; the ledger closes to {:.1e} J",
                self.energy_drift,
                self.energy_drift_relative,
                self.energy_residual.abs()
            ),
            format!(
                "momentum     ({}, {}) -> ({}, {}) kg m/s, angular {} -> {} kg m2/s",
                short(self.momentum_start.linear[0]),
                short(self.momentum_start.linear[1]),
                short(self.momentum_end.linear[0]),
                short(self.momentum_end.linear[1]),
                short(self.momentum_start.angular),
                short(self.momentum_end.angular)
            ),
            format!(
                "             drift ({}, {}) kg m/s, {} kg m2/s: what gravity, fields and fixed bodies gave",
                short(self.momentum_drift.linear[0]),
                short(self.momentum_drift.linear[1]),
                short(self.momentum_drift.angular)
            ),
            format!("deepest      overlap {:.2e} m", self.deepest_overlap),
            self.exactness(),
        ];
        if let Some(why) = &self.refused {
            lines.push(format!("REFUSED      {why}"));
        }
        if self.events_dropped > 0 {
            lines.push(format!(
                "events       {} found no room",
                self.events_dropped
            ));
        }
        lines.push(format!("state hash   {}", self.state_hash));
        lines
    }

    /// Prints the lines to stdout.
    pub fn print(&self) {
        for line in self.lines() {
            say!("{line}");
        }
    }

    fn exactness(&self) -> String {
        let mark = if self.exact { "exact" } else { "NOT EXACT" };
        format!(
            "{mark:<12} handed over {}, unresolved {}, inaccurate {}, sunken {}, collapsed {}, stopped {}, refused {}",
            self.handed_over,
            self.unresolved,
            self.inaccurate,
            self.sunken,
            self.collapsed,
            self.stopped,
            u8::from(self.refused.is_some())
        )
    }
}

/// Four significant digits, in the shorter of the two notations.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.3e}");
    }
    let decimals = [1.0, 10.0, 100.0, 1000.0]
        .iter()
        .filter(|limit| size < **limit)
        .count();
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (-0.5, "-0.5"),
            (9.80665, "9.807"),
            (123.456, "123.5"),
            (123_456.0, "123456"),
            (0.0123, "0.0123"),
            (1.0e-9, "1.000e-9"),
            (2.5e7, "2.500e7"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}
