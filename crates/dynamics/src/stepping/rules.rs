//! Which shapes touch each other, as the engine asks.

use carom_stepped::{Material, PairRules, Surface};

use crate::PairSearch;
use crate::broad::tree::Broad;
use crate::store::bodies::Bodies;

/// Bodies and their shapes, and what a caller said of filters, materials and pairs of bodies.
#[derive(Clone, Copy)]
pub(crate) struct Rules<'a> {
    pub(crate) bodies: &'a Bodies,
    pub(crate) broad: &'a Broad,
}

impl PairRules for Rules<'_> {
    fn surface(&self, tags: [u64; 2], _: [Material; 2]) -> Option<Surface> {
        let shapes = tags.map(super::collider).into();
        if self.broad.search == PairSearch::None || !self.broad.may_touch(self.bodies, shapes) {
            return None;
        }
        let pair = self.broad.material(self.bodies, shapes);
        Some(Surface {
            friction: pair.friction,
            restitution: pair.restitution,
            tangent_speed: pair.tangent_speed,
        })
    }
}
