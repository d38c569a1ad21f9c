//! Marks that stay from frame to frame, and need no second comparison.

use std::sync::Arc;

use carom_dynamics::{Body, BodyId, World};
use carom_geometry::Shape;
use carom_math::Pose;

use crate::{Camera, Look};

/// Which marks at the beginning of a list were there before.
///
/// Marks are only ever added at the end and taken away from there. Two versions of a list with the same token share the
/// prefix that was never truncated in between.
#[derive(Clone, Debug)]
pub(crate) struct Standing {
    /// Of one list since one instant; while it is held it cannot be taken for another's.
    token: Option<Arc<()>>,
    /// The fewest marks that the list had been cut to since then.
    least: usize,
}

impl Default for Standing {
    fn default() -> Self {
        Self::new()
    }
}

impl Standing {
    /// Nothing is known.
    pub(crate) const fn new() -> Self {
        Self {
            token: None,
            least: usize::MAX,
        }
    }

    /// An empty list that begins now.
    pub(crate) fn anew() -> Self {
        Self {
            token: Some(Arc::new(())),
            least: usize::MAX,
        }
    }

    /// The list is cut to `marks`.
    pub(crate) fn cut(&mut self, marks: usize) {
        let grown = self.least < marks && self.least < usize::MAX;
        if self.token.is_none() || grown {
            // More stands than before: what is known of it begins now.
            *self = Self::anew();
        }
        self.least = self.least.min(marks);
    }

    /// How many first marks have stood since an earlier state of a list.
    pub(crate) fn since(&self, earlier: &Self) -> usize {
        match (&self.token, &earlier.token) {
            (Some(a), Some(b)) if Arc::ptr_eq(a, b) => self.least,
            _ => 0,
        }
    }
}

/// The bodies at rest with the marks that a frame begins with, and all that these marks were made from.
#[derive(Clone, Debug)]
pub(crate) struct Resting {
    look: Look,
    camera: Camera,
    bodies: Vec<Still>,
}

/// A body at rest.
#[derive(Clone, Debug)]
struct Still {
    id: BodyId,
    kind: carom_dynamics::BodyKind,
    asleep: bool,
    pose: Pose,
    shapes: Vec<Shape>,
    /// Number of marks up to its last one.
    end: usize,
}

impl Resting {
    pub(crate) fn new(look: &Look, camera: &Camera) -> Self {
        Self {
            look: look.clone(),
            camera: *camera,
            bodies: Vec::new(),
        }
    }

    /// Whether marks made then are marks made now, of bodies that are as they were.
    pub(crate) fn suits(&self, look: &Look, camera: &Camera) -> bool {
        self.camera == *camera && self.look == *look
    }

    /// Forgets all bodies with marks beyond the first `marks`.
    pub(crate) fn keep(&mut self, marks: usize) {
        let kept = self.bodies.partition_point(|body| body.end <= marks);
        self.bodies.truncate(kept);
    }

    /// How many bodies at rest are, one after the other, those of before, and the number of their marks.
    pub(crate) fn unchanged(&self, world: &World) -> (usize, usize) {
        let now = world
            .bodies()
            .filter(|body| !crate::capture::is_awake(body));
        let pairs = self.bodies.iter().zip(now);
        let bodies = pairs.take_while(|(then, now)| then.is(now)).count();
        let marks = bodies
            .checked_sub(1)
            .map_or(0, |last| self.bodies[last].end);
        (bodies, marks)
    }

    /// Forgets all but the first so many bodies.
    pub(crate) fn truncate(&mut self, bodies: usize) {
        self.bodies.truncate(bodies);
    }

    /// Adds a body; with its marks there are `end`.
    pub(crate) fn add(&mut self, body: &Body<'_>, end: usize) {
        self.bodies.push(Still {
            id: body.id(),
            kind: body.kind(),
            asleep: body.is_asleep(),
            pose: body.pose(),
            shapes: body.shapes().map(|(shape, _)| shape.clone()).collect(),
            end,
        });
    }
}

impl Still {
    /// Whether a body looks the same under one look.
    fn is(&self, body: &Body<'_>) -> bool {
        self.id == body.id()
            && self.kind == body.kind()
            && self.asleep == body.is_asleep()
            && self.pose == body.pose()
            && self.shapes.iter().eq(body.shapes().map(|(shape, _)| shape))
    }
}

#[cfg(test)]
#[path = "standing_tests.rs"]
mod tests;
