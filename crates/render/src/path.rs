//! From points to tiny-skia's paths: rings, circles, dashes.

use carom_math::{Rot, Vec2};
use tiny_skia::PathBuilder;

use crate::camera::narrow;

/// Shortest dash, in pixels: whatever is shorter, or no number, is one of it.
const SHORTEST_DASH: f64 = 1.0;

/// A dash as it is drawn, in pixels.
pub(crate) const fn usable_dash(dash: f64) -> f64 {
    if dash > SHORTEST_DASH {
        dash
    } else {
        SHORTEST_DASH
    }
}

/// Hands over the dashes of a line: `dash` drawn, `dash` left out, from its start.
fn dashes(points: &[Vec2], dash: f64, mut each: impl FnMut(&[Vec2])) {
    let dash = usable_dash(dash);
    let (mut drawn, mut left) = (true, dash);
    let mut piece: Vec<Vec2> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let length = (pair[1] - pair[0]).length();
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let point = pair[0].lerp(pair[1], done / length);
            if drawn {
                piece.push(point);
                each(&piece);
            }
            piece.clear();
            piece.push(point);
            (drawn, left) = (!drawn, dash);
        }
        left -= length - done;
        piece.push(pair[1]);
        if !drawn {
            piece.clear();
        }
    }
    if drawn && piece.len() > 1 {
        each(&piece);
    }
}

pub(crate) fn push_dashes(builder: &mut PathBuilder, points: &[Vec2], dash: f64) {
    dashes(points, dash, |piece| push(builder, piece, false));
}

pub(crate) fn push(builder: &mut PathBuilder, points: &[Vec2], closed: bool) {
    for (i, point) in points.iter().enumerate() {
        let (x, y) = (narrow(point.x), narrow(point.y));
        if i == 0 {
            builder.move_to(x, y);
        } else {
            builder.line_to(x, y);
        }
    }
    if closed && !points.is_empty() {
        builder.close();
    }
}

/// A circle as a polygon of the same area, within 1/40 px of it on either side.
///
/// tiny-skia's own circles come out 0.08 px too small at a radius of 26 px. A corner every angle s lies r s²/8
/// outside the middle of its chord; the area of n corners at radius R is n R² sin(2π/n) / 2.
pub(crate) fn push_circle(builder: &mut PathBuilder, centre: Vec2, radius: f64, reversed: bool) {
    const SAGITTA: f64 = 0.05;
    let sides = (core::f64::consts::PI * (radius / (2.0 * SAGITTA)).sqrt())
        .ceil()
        .clamp(8.0, 1024.0);
    let angle = core::f64::consts::TAU / sides;
    let step = Rot::from_angle(if reversed { -angle } else { angle });
    let reach = radius * (angle / step.sin().abs()).sqrt();
    let mut direction = Rot::IDENTITY;
    let mut side = 0.0;
    while side < sides {
        let (x, y) = (
            centre.x + reach * direction.cos(),
            centre.y + reach * direction.sin(),
        );
        if side == 0.0 {
            builder.move_to(narrow(x), narrow(y));
        } else {
            builder.line_to(narrow(x), narrow(y));
        }
        direction = step * direction;
        side += 1.0;
    }
    builder.close();
}
