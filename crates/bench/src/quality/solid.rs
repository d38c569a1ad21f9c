//! Shapes where a run has put them.

use carom_math::{Rot, Vec2};
use carom_scenes::{PlainKind, PlainScene, PlainShape};

use super::finite;
use crate::engine::State;

/// A shape of a body, in the world.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    /// Index of its body.
    pub(super) body: usize,
    pub(super) dynamic: bool,
    /// Low and high corner of its box, in m.
    pub(super) low: Vec2,
    pub(super) high: Vec2,
    pub(super) form: Form,
}

#[derive(Clone, Debug)]
pub(super) enum Form {
    Disc { centre: Vec2, radius: f64 },
    Convex(Convex),
}

/// A convex polygon, counter-clockwise.
#[derive(Clone, Debug)]
pub(super) struct Convex {
    /// Edge `i` runs from corner `i` to the next.
    pub(super) corners: Vec<Vec2>,
    /// Of the edges: unit vectors outwards.
    pub(super) normals: Vec<Vec2>,
}

/// All shapes of the bodies with a finite state; segments, which have no inside, are left out.
pub(super) fn place(scene: &PlainScene, states: &[State]) -> Vec<Solid> {
    let mut solids = Vec::new();
    for (index, (body, state)) in scene.bodies.iter().zip(states).enumerate() {
        if !finite(state) {
            continue;
        }
        let turn = Rot::from_angle(state.angle);
        for &shape in &body.shapes {
            let Some(form) = Form::placed(&scene.shapes[shape], state.position, turn) else {
                continue;
            };
            let (low, high) = form.bounds();
            solids.push(Solid {
                body: index,
                dynamic: body.kind == PlainKind::Dynamic,
                low,
                high,
                form,
            });
        }
    }
    solids
}

impl Form {
    /// `None` for a segment.
    fn placed(shape: &PlainShape, position: Vec2, turn: Rot) -> Option<Self> {
        let corners = match shape {
            PlainShape::Circle { radius } => {
                return Some(Self::Disc {
                    centre: position,
                    radius: *radius,
                });
            }
            PlainShape::Box { half, offset } => {
                let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                signs
                    .map(|(x, y)| *offset + *half * Vec2::new(x, y))
                    .to_vec()
            }
            PlainShape::Polygon(corners) => corners.clone(),
            PlainShape::Segment(_) => return None,
        };
        Some(Self::Convex(Convex::new(
            corners
                .into_iter()
                .map(|local| position + turn * local)
                .collect(),
        )))
    }

    fn bounds(&self) -> (Vec2, Vec2) {
        match self {
            Self::Disc { centre, radius } => (*centre - *radius, *centre + *radius),
            Self::Convex(convex) => {
                let first = convex.corners[0];
                convex
                    .corners
                    .iter()
                    .fold((first, first), |(low, high), &corner| {
                        (low.min(corner), high.max(corner))
                    })
            }
        }
    }
}

impl Convex {
    pub(super) fn new(corners: Vec<Vec2>) -> Self {
        let next = |i: usize| corners[(i + 1) % corners.len()];
        let normals = corners.iter().enumerate();
        let normals = normals
            .map(|(i, &corner)| {
                let edge = next(i) - corner;
                Vec2::new(edge.y, -edge.x).normalize_or_zero()
            })
            .collect();
        Self { corners, normals }
    }
}
