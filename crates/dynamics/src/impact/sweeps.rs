//! Projected Gauss–Seidel: bounded in time whatever the contacts, and as exact as its sweeps.

use super::rows::{Bound, Rows};

/// Sweeps before what is left stays.
const SWEEPS: usize = 300;

/// Change of a scaled speed in a sweep, as a part of the largest, at which it has converged.
const CONVERGED: f64 = 1e-12;

/// Scaled impulses that come as near to the conditions as the sweeps do.
pub(super) fn swept(rows: &Rows<'_>) -> Vec<f64> {
    let mut impulses = vec![0.0; rows.len()];
    let mut bodies = rows.bodies.to_vec();
    let start = (0..rows.len()).map(|r| rows.speed(r, &bodies).abs());
    let size = start.fold(0.0, f64::max);
    for _ in 0..SWEEPS {
        let mut change = 0.0_f64;
        for r in 0..rows.len() {
            if rows.scales[r] == 0.0 {
                continue;
            }
            let wanted = impulses[r] - rows.speed(r, &bodies);
            let limit = rows.limit(r, &impulses);
            let next = match rows.rows[r].bound {
                Bound::Push => wanted.max(0.0),
                Bound::Friction(..) | Bound::Limit(_) => wanted.clamp(-limit, limit),
            };
            let more = next - impulses[r];
            rows.rows[r].push(&mut bodies, more / rows.scales[r]);
            change = change.max(more.abs());
            impulses[r] = next;
        }
        if change <= CONVERGED * size {
            break;
        }
    }
    impulses
}
