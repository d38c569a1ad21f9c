//! Contacts and what acts in them.

use carom_dynamics::{BodyId, BodyKind, EventKind};
use carom_math::{Vec2, vec2};

use super::Overlaid;
use crate::{Ink, Op};

/// Length of a normal, in pixels of the overlay.
const NORMAL: f64 = 20.0;
/// Width of an impulse's arrow, in pixels of the overlay.
const ARROW: f64 = 2.4;
/// How long a lasting contact pushes for its arrow, in s.
const PUSH: f64 = 0.1;

impl Overlaid<'_> {
    pub(super) fn contacts(&mut self) {
        if !self.look.overlay.contacts {
            return;
        }
        // What lasts, and what was struck during the last step.
        for contact in self.world.contacts() {
            for point in &contact.points {
                self.contact(point.position, contact.normal);
            }
        }
        for event in self.world.events() {
            if let EventKind::Impact { point, normal, .. } = event.kind {
                self.contact(point, normal);
            }
        }
    }

    fn contact(&mut self, point: Vec2, normal: Vec2) {
        let at = self.camera.point(point);
        let normal = self.camera.vector(normal).normalize_or_zero();
        self.frame.push(Op::Arrow {
            from: at,
            to: at + normal * NORMAL * self.unit,
            width: 1.5 * self.unit,
            ink: Ink::Contact,
        });
        self.frame.push(Op::Dot {
            centre: at,
            radius: 2.8 * self.unit,
            ink: Ink::Contact,
        });
    }

    /// Arrows along the impulses on the lighter body of a pair, on B of equals, each as long as the way that they
    /// would send it.
    pub(super) fn impulses(&mut self) {
        let Some(seconds) = self.look.overlay.impulses else {
            return;
        };
        let substep = self.world.settings().substep;
        for contact in self.world.contacts() {
            // What a sub-step gives, for as long as the arrow counts.
            let scale = seconds * PUSH / substep;
            #[expect(clippy::cast_precision_loss, reason = "one or two points")]
            let share = contact.tangent_impulse / contact.points.len().max(1) as f64;
            for point in &contact.points {
                let impulse = along(contact.normal, point.normal_impulse, share);
                self.impulse(point.position, impulse * scale, (contact.a, contact.b));
            }
        }
        for event in self.world.events() {
            if let EventKind::Impact {
                a,
                b,
                point,
                normal,
                normal_impulse,
                tangential_impulse,
                ..
            } = event.kind
            {
                let impulse = along(normal, normal_impulse, tangential_impulse);
                self.impulse(point, impulse * seconds, (a, b));
            }
        }
    }

    /// One arrow, from an impulse on B times a time, in N·s².
    fn impulse(&mut self, point: Vec2, impulse: Vec2, (a, b): (BodyId, BodyId)) {
        let masses = [a, b].map(|id| {
            let body = self.world.body(id);
            body.filter(|body| body.kind() == BodyKind::Dynamic)
                .map_or(f64::INFINITY, |body| body.mass())
        });
        let (lighter, impulse) = if masses[0] < masses[1] {
            (masses[0], -impulse)
        } else {
            (masses[1], impulse)
        };
        let from = self.camera.point(point);
        self.frame.push(Op::Arrow {
            from,
            to: from + self.camera.vector(impulse / lighter),
            width: ARROW * self.unit,
            ink: Ink::Bar,
        });
    }
}

/// An impulse from its two parts: along the normal, and along the normal turned by +90 degrees.
fn along(normal: Vec2, normal_part: f64, tangent_part: f64) -> Vec2 {
    normal * normal_part + vec2(-normal.y, normal.x) * tangent_part
}
