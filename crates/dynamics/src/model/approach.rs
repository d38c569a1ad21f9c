//! How two bodies move against each other at a point of contact.

use carom_math::{Vec2, cross_scalar};

use crate::impact::ImpactBody;

/// Opening speed below which a touch neither opens nor closes, as a part of the speeds it is made of.
pub(crate) const CLOSED: f64 = 1e-9;

/// What a touch does, by more than rounding; at which speed, in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Approach {
    Leaves(f64),
    Stays,
    Closes(f64),
}

/// What a point of two bodies does along the normal; `rest`: their rest speed, in m/s.
pub(crate) fn approach(
    ends: (ImpactBody, ImpactBody),
    point: Vec2,
    normal: Vec2,
    rest: f64,
) -> Approach {
    let (rate, size) = opening(ends, point, normal);
    let rounding = CLOSED * (size + rest);
    if rate > rounding {
        Approach::Leaves(rate)
    } else if rate < -rounding {
        Approach::Closes(-rate)
    } else {
        Approach::Stays
    }
}

/// Speed at which a point opens, and the sum of the speeds that it is made of, in m/s.
pub(crate) fn opening(ends: (ImpactBody, ImpactBody), point: Vec2, normal: Vec2) -> (f64, f64) {
    let (velocity, size) = relative(ends, point);
    (velocity.dot(normal), size)
}

/// Velocity of B against A at a point, and the sum of the speeds that it is made of, in m/s.
pub(crate) fn relative(ends: (ImpactBody, ImpactBody), point: Vec2) -> (Vec2, f64) {
    let of = |body: ImpactBody| {
        let turning = cross_scalar(body.spin, point - body.centre);
        (
            body.velocity + turning,
            body.velocity.length() + turning.length(),
        )
    };
    let ((v_a, size_a), (v_b, size_b)) = (of(ends.0), of(ends.1));
    (v_b - v_a, size_a + size_b)
}
