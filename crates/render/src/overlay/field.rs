//! Fields.

use carom_math::vec2;

use super::{FieldMark, Overlaid, TEXT};
use crate::{Ink, Label, Op};

impl Overlaid<'_> {
    pub(super) fn field(&mut self) {
        if let Some(mark) = &self.look.overlay.field {
            self.frame.push(Op::Ring {
                centre: self.camera.point(mark.centre),
                radius: self.camera.length(mark.radius),
                width: 3.0 * self.unit,
                ink: Ink::Field,
            });
        }
    }

    pub(super) fn field_label(&mut self) {
        let Some(FieldMark {
            centre,
            radius,
            label,
        }) = &self.look.overlay.field
        else {
            return;
        };
        if !label.is_empty() {
            let above = vec2(0.0, self.camera.length(*radius) + 8.0 * self.unit);
            let at = self.camera.point(*centre) - above;
            let text = Label::new(at, label.clone(), TEXT * self.unit, Ink::Field);
            self.frame.push(text.anchored(0.5, 0.0).with_halo());
        }
    }
}
