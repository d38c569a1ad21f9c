//! Two discs that accelerate alike: their distance along a straight way, in closed form.
//!
//! Spins do not move a rim. With R the sum of the radii
//! ```text
//! |d + v t| = R        t = (d² − R²)/(r − d·v),    r = √(v² R² − (d × v)²),    the gap closes by r/R there
//! ```

use carom_math::{SimTime, cross};

use super::even::Found;
use super::search::SLACK;
use crate::lanes::{larger, smaller};
use crate::{AxisFeature, Motion};

/// Part of v² R² below which rounding has a say in r².
const GRAZES: f64 = 1e-14;

/// The first contact of discs with these radii about their centres within `horizon` seconds of `start`, which no motion
/// begins after; `None` where they graze, overlap or touch and do not part: that is not for this search to say.
pub(super) fn first_contact(
    radii: [f64; 2],
    (a, b): (&Motion, &Motion),
    (start, horizon): (SimTime, f64),
) -> Option<Found> {
    let ages = [start - a.start, start - b.start];
    let centre = a.centre + a.travel(ages[0]);
    let velocity = a.velocity + a.acceleration * ages[0];
    let d = b.centre + b.travel(ages[1]) - centre;
    let v = b.velocity + b.acceleration * ages[1] - velocity;
    let (distance, speed) = (d.length(), v.length());
    let reach = radii[0] + radii[1];
    let (gap, along) = (distance - reach, d.dot(v));
    let rounding = 6.0 * f64::EPSILON * (distance + reach);
    if gap <= rounding {
        let slack = larger(SLACK * smaller(radii[0], radii[1]), 2.0 * rounding);
        let parts = gap >= -slack && along > 1e-13 * speed * distance;
        return parts.then_some(Found::Clear);
    }
    if along >= 0.0 {
        return Some(Found::Clear);
    }
    let aside = cross(d, v);
    let fast = v.length_squared() * reach * reach;
    let square = fast - aside * aside;
    if square.abs() <= GRAZES * fast {
        return None;
    }
    if square < 0.0 {
        return Some(Found::Clear);
    }
    let root = square.sqrt();
    let time = gap * (distance + reach) / (root - along);
    if time > horizon {
        return Some(Found::Clear);
    }
    let apart = d + v * time;
    let normal = apart / apart.length();
    Some(Found::Hit {
        time,
        normal,
        point: centre
            + (velocity + a.acceleration * (0.5 * time)) * time
            + (apart - normal * radii[1]),
        feature: AxisFeature::Vertices { a: 0, b: 0 },
        gap_rate: -root / reach,
    })
}
