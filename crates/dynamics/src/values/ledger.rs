//! Where the energy went.

/// The energy of a world and every way it came or went since the start, in J.
///
/// Losses are summed impact by impact and row by row, each as impulse × mean relative velocity;
/// none is the remainder of the others. So the balance is a check:
///
/// ```text
/// kinetic + potential + impacts + friction = external + forces + scheme
/// ```
/// For bodies that the engine moves, all of them in [`crate::Mode::Stepped`], `friction` is the heat of rows, `impacts` the rest of
/// what was lost in impacts that are told as events, both to first order in the sub-step, and `scheme` what the other columns do
/// not explain: for them the balance checks nothing. It has what contacts took that bore a load already: of what sixty
/// bodies lost that fell in a heap without restitution up to a tenth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct EnergyLedger {
    /// ½ m v² + ½ I ω² of all dynamic bodies now.
    pub kinetic: f64,
    /// Potential energy in gravity (zero at the origin) and fields now.
    pub potential: f64,
    /// Lost in impacts.
    pub impacts: f64,
    /// Lost to friction in lasting contacts: friction impulse × slip.
    pub friction: f64,
    /// Done by forces that the caller applied.
    pub forces: f64,
    /// Brought in by the caller (insert, remove, setters, impulses) and by moving kinematic bodies.
    pub external: f64,
    /// Added by the sub-step scheme: normal rows of lasting contacts, push-out, and what the
    /// pieces of a motion leave out. 0 while everything flies freely.
    pub scheme: f64,
}

impl EnergyLedger {
    /// Kinetic and potential energy.
    #[must_use]
    pub fn mechanical(&self) -> f64 {
        self.kinetic + self.potential
    }

    /// What the columns do not account for: rounding, if all is well.
    #[must_use]
    pub fn residual(&self) -> f64 {
        (self.mechanical() + self.impacts + self.friction)
            - (self.external + self.forces + self.scheme)
    }
}

/// Momentum of all dynamic bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum {
    /// Linear momentum, in kg·m/s.
    pub linear: carom_math::Vec2,
    /// Angular momentum about the origin, in kg·m²/s.
    pub angular: f64,
}
