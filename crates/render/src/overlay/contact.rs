//! Contacts and what acts in them.

use carom_dynamics::EventKind;
use carom_math::Vec2;

use super::Overlaid;
use crate::{Ink, Op};

/// Length of a normal, in pixels of the overlay.
const NORMAL: f64 = 20.0;

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
}
