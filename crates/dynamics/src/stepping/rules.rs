//! Which shapes touch each other, as the engine asks.

use carom_stepped::{Material, PairRules, Surface};

use crate::broad::tree::Broad;
use crate::store::bodies::Bodies;
use crate::store::state::Collider;
use crate::{PairSearch, World};

/// What a caller said of filters, materials and pairs of bodies.
pub(super) struct Rules<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) colliders: &'a [Collider],
    pub(super) broad: &'a Broad,
    pub(super) search: PairSearch,
}

impl World {
    /// Asks anew how the contacts of a body meet, in the engine.
    pub(crate) fn resurface(&mut self, index: u32) {
        let Some(mut stepping) = self.stepping.take() else {
            return;
        };
        if let Some(id) = stepping.id(index) {
            let told = stepping.engine.resurface(id, &self.rules());
            debug_assert!(told.is_ok(), "{told:?}");
        }
        self.stepping = Some(stepping);
    }

    pub(super) fn rules(&self) -> Rules<'_> {
        Rules {
            bodies: &self.bodies,
            colliders: &self.colliders,
            broad: &self.broad,
            search: self.settings.pair_search,
        }
    }
}

impl PairRules for Rules<'_> {
    fn surface(&self, tags: [u64; 2], _: [Material; 2]) -> Option<Surface> {
        let [a, b] = tags.map(|tag| &self.colliders[super::collider(tag) as usize]);
        if self.search == PairSearch::None || !self.broad.may_touch(self.bodies, a, b) {
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
