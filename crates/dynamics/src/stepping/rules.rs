//! Which shapes touch each other, as the engine asks.

use carom_stepped::{Material, PairRules, Surface};

use super::Stepping;
use crate::PairSearch;
use crate::broad::tree::Broad;
use crate::store::bodies::Bodies;
use crate::store::state::Collider;

/// Bodies and their shapes, and what a caller said of filters, materials and pairs of bodies.
#[derive(Clone, Copy)]
pub(crate) struct Rules<'a> {
    pub(crate) bodies: &'a Bodies,
    pub(crate) colliders: &'a [Collider],
    pub(crate) broad: &'a Broad,
}

impl Stepping {
    /// Asks anew how the contacts of a body meet.
    pub(crate) fn resurface(&mut self, index: u32, rules: Rules<'_>) {
        if let Some(id) = self.id(index) {
            let told = self.engine.resurface(id, &rules);
            debug_assert!(told.is_ok(), "{told:?}");
        }
    }
}

impl PairRules for Rules<'_> {
    fn surface(&self, tags: [u64; 2], _: [Material; 2]) -> Option<Surface> {
        let [a, b] = tags.map(|tag| &self.colliders[super::collider(tag) as usize]);
        if self.broad.search == PairSearch::None || !self.broad.may_touch(self.bodies, a, b) {
            return None;
        }
        let [one, other] = [a, b].map(|collider| self.bodies.get(collider.body).id);
        let pair = self.broad.material(one, other, a, b);
        Some(Surface {
            friction: pair.friction,
            restitution: pair.restitution,
            tangent_speed: pair.tangent_speed,
        })
    }
}
