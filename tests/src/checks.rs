//! Laws that are asked from outside: shapes, poses and velocities as a caller reads them, in arithmetic of their own.
//!
//! Nothing here calls the library's collision code or its search for pairs; of the geometry it takes corners, radii and the convex
//! pieces of concave polygons.

mod apart;
mod sums;

pub use apart::{Part, depth, parts};
pub use sums::{Closed, Moment};

use carom_dynamics::{Body, BodyId, BodyKind, StepReport, World};

/// What a closed form may leave of an overlap, in parts of the smaller size. Times of impact are right to some 1e-12 of the
/// sizes; below, rounding would be checked, and above 1e-6 a body that sinks in would pass.
const SHARP: f64 = 1e-9;

/// A broken law.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// A body is behind a half-plane, or its centre within what does not yield.
    Escape(String),
    /// Bodies overlap deeper than before the step, and the report calls the step exact.
    Missed(String),
    /// Energy came from nowhere.
    Gain(String),
    /// Momentum went nowhere.
    Momentum(String),
    /// Time goes on no more.
    Stands(String),
}

/// So many steps at one instant are too many: a body that a paddle squeezes may use up the work of some.
const MOST: usize = 16;

/// Steps in a row that ended where they began: nothing breaks another law in a world that stands still.
#[derive(Clone, Copy, Debug, Default)]
pub struct Standing(usize);

impl Standing {
    /// Counts a step of some length.
    ///
    /// # Errors
    /// If too many in a row did not go on.
    pub fn after(&mut self, world: &World, report: &StepReport) -> Result<(), Fault> {
        self.0 = if report.advanced > 0.0 { 0 } else { self.0 + 1 };
        if self.0 < MOST {
            return Ok(());
        }
        let now = world.time().as_secs();
        Err(Fault::Stands(format!("stands at {now} s: {report:?}")))
    }
}

/// All overlaps of bodies of which one moves: the pairs, and how deep in m.
#[must_use]
pub fn overlapping(world: &World) -> Vec<(BodyId, BodyId, f64)> {
    let bodies: Vec<_> = world.bodies().map(|body| (parts(&body), body)).collect();
    let mut found = Vec::new();
    for (i, (shape_a, a)) in bodies.iter().enumerate() {
        for (shape_b, b) in &bodies[i + 1..] {
            let moves = a.kind() == BodyKind::Dynamic || b.kind() == BodyKind::Dynamic;
            if moves && meets(a, b) {
                let depth = apart::deepest(shape_a, shape_b);
                if depth > 0.0 {
                    found.push((a.id(), b.id(), depth));
                }
            }
        }
    }
    found
}

/// Whether the filters let any two shapes of two bodies touch.
fn meets(a: &Body<'_>, b: &Body<'_>) -> bool {
    a.filters()
        .any(|of_a| b.filters().any(|of_b| of_a.touches(of_b)))
}

/// Whether all bodies are where a step with this report may leave them; `before` are the overlaps at its start.
///
/// # Errors
/// The first body that is not.
pub fn places(
    world: &World,
    before: &[(BodyId, BodyId, f64)],
    report: &StepReport,
) -> Result<(), Fault> {
    for (a, b, depth) in overlapping(world) {
        let (Some(one), Some(other)) = (world.body(a), world.body(b)) else {
            continue;
        };
        let size = apart::size(&one).min(apart::size(&other));
        let far = one.centre().length().max(other.centre().length());
        let rounding = 64.0 * f64::EPSILON * far;
        let known = before.iter().find(|(p, q, _)| (*p, *q) == (a, b));
        let known = known.map_or(0.0, |pair| pair.2);
        let gone = apart::is_behind(&one, &other) || apart::is_behind(&other, &one);
        // A centre behind a surface is an escape, unless the body was put so deep, or the report says how deep it is.
        if gone && depth > known.max(report.deepest_overlap) + SHARP * size + rounding {
            return Err(Fault::Escape(format!(
                "{a} and {b}: a centre is behind the surface, {depth:e} m deep of {size:e} m, {known:e} m before, and the report says {:e} m",
                report.deepest_overlap
            )));
        }
        if report.is_exact() && depth > known + SHARP * size + rounding {
            return Err(Fault::Missed(format!(
                "{a} and {b} overlap by {depth:e} m of {size:e} m, {known:e} m before, and the report says exact"
            )));
        }
    }
    Ok(())
}
