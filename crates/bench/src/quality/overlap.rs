//! How deep shapes are in each other.

use carom_math::Vec2;
use carom_scenes::PlainScene;

use super::grid;
use super::solid::{Convex, Form, Solid, place};
use crate::engine::State;

/// The depths of all pairs that overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Overlaps {
    pairs: usize,
    sum: f64,
    deepest: f64,
}

impl Overlaps {
    /// Of shapes on different bodies, at least one of them dynamic.
    pub(super) fn of(scene: &PlainScene, states: &[State]) -> Self {
        let solids = place(scene, states);
        let mut overlaps = Self::default();
        grid::meeting(&solids, |a, b| overlaps.add(&solids[a], &solids[b]));
        overlaps
    }

    pub(super) fn add(&mut self, a: &Solid, b: &Solid) {
        if a.body == b.body || !(a.dynamic || b.dynamic) {
            return;
        }
        let separation = separation(&a.form, &b.form);
        if separation < 0.0 {
            self.pairs += 1;
            self.sum -= separation;
            self.deepest = self.deepest.max(-separation);
        }
    }

    pub(super) const fn pairs(&self) -> usize {
        self.pairs
    }

    /// In m; 0 if nothing overlaps.
    pub(super) const fn deepest(&self) -> f64 {
        self.deepest
    }

    /// In m; 0 if nothing overlaps.
    #[expect(clippy::cast_precision_loss, reason = "a count of pairs")]
    pub(super) fn mean(&self) -> f64 {
        self.sum / self.pairs.max(1) as f64
    }
}

/// Distance between two shapes along the axis that separates them best, in m; below zero they overlap by so much.
///
/// Above zero it may fall short of the distance between two polygons: their nearest points may be corners.
pub(super) fn separation(a: &Form, b: &Form) -> f64 {
    match (a, b) {
        (Form::Convex(a), Form::Convex(b)) => beyond_edges(a, b).max(beyond_edges(b, a)),
        (Form::Convex(convex), Form::Disc { centre, radius })
        | (Form::Disc { centre, radius }, Form::Convex(convex)) => {
            to_boundary(convex, *centre) - radius
        }
        (
            Form::Disc { centre, radius },
            Form::Disc {
                centre: other,
                radius: other_radius,
            },
        ) => centre.distance(*other) - (radius + other_radius),
    }
}

/// The largest over the edges of `a` of the smallest distance of a corner of `b` along the edge's normal.
fn beyond_edges(a: &Convex, b: &Convex) -> f64 {
    let edges = a.corners.iter().zip(&a.normals);
    edges
        .map(|(&corner, &normal)| {
            let distances = b.corners.iter().map(|&other| normal.dot(other - corner));
            distances.fold(f64::INFINITY, f64::min)
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Signed distance of a point to the boundary of a polygon: inside the largest edge distance, below zero.
fn to_boundary(convex: &Convex, point: Vec2) -> f64 {
    let edges = convex.corners.iter().zip(&convex.normals);
    let beyond = edges
        .map(|(&corner, &normal)| normal.dot(point - corner))
        .fold(f64::NEG_INFINITY, f64::max);
    if beyond <= 0.0 {
        return beyond;
    }
    let ends = convex.corners.iter().cycle().skip(1);
    let squares = convex
        .corners
        .iter()
        .zip(ends)
        .map(|(&from, &to)| from_segment(point, from, to).length_squared());
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// From the nearest point of a segment to a point.
fn from_segment(point: Vec2, from: Vec2, to: Vec2) -> Vec2 {
    let along = to - from;
    let share = (point - from).dot(along) / along.length_squared();
    point - (from + share.clamp(0.0, 1.0) * along)
}
