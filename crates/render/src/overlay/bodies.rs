//! Marks that belong to single bodies.

use carom_dynamics::{Body, BodyKind};
use carom_math::vec2;

use super::Overlaid;
use crate::{Ink, Op};

/// Width of a velocity arrow, in pixels of the overlay.
const ARROW: f64 = 1.8;

impl Overlaid<'_> {
    pub(super) fn bodies(&mut self) {
        let overlay = &self.look.overlay;
        if overlay.bounds || overlay.centroids || overlay.velocities.is_some() {
            for body in self.world.bodies() {
                self.body(&body);
            }
        }
    }

    fn body(&mut self, body: &Body<'_>) {
        let overlay = &self.look.overlay;
        let bounds = body.aabb();
        if overlay.bounds && bounds.is_finite() {
            let (a, b) = (self.camera.point(bounds.min), self.camera.point(bounds.max));
            self.frame.push(Op::Box {
                min: vec2(a.x, b.y),
                max: vec2(b.x, a.y),
                fill: None,
                border: Some(Ink::Muted),
                width: 1.0,
                dash: Some(4.0 * self.unit),
            });
        }
        if body.kind() == BodyKind::Fixed {
            return;
        }
        let centre = self.camera.point(body.centre());
        if overlay.centroids {
            self.frame.push(Op::Dot {
                centre,
                radius: 2.2 * self.unit,
                ink: Ink::Velocity,
            });
        }
        if let Some(seconds) = overlay.velocities {
            self.frame.push(Op::Arrow {
                from: centre,
                to: centre + self.camera.vector(body.velocity() * seconds),
                width: ARROW * self.unit,
                ink: Ink::Velocity,
            });
        }
    }
}
