//! Which bodies touch each other.

use std::collections::BTreeMap;

use carom_dynamics::{BodyId, BodyKind, World};

use crate::{Colour, Style};

/// How much paler a body without contacts is.
const PALE: f64 = 0.75;

/// Islands: bodies joined by persistent contacts; fixed and kinematic ones join none.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    /// For each body that touches another its group's number, in order of each group's first body.
    numbers: BTreeMap<BodyId, usize>,
}

impl Groups {
    pub(crate) fn of(world: &World) -> Self {
        let moves = |id| {
            world
                .body(id)
                .is_some_and(|body| body.kind() == BodyKind::Dynamic)
        };
        let mut parents = BTreeMap::new();
        for contact in world.contacts() {
            if moves(contact.a) && moves(contact.b) {
                let (a, b) = (root(&parents, contact.a), root(&parents, contact.b));
                // The earlier body stands for both.
                parents.insert(a.max(b), a.min(b));
                parents.entry(a.min(b)).or_insert(a.min(b));
            }
        }
        let mut order = BTreeMap::new();
        let numbers = parents
            .keys()
            .map(|&id| {
                let next = order.len();
                let number = *order.entry(root(&parents, id)).or_insert(next);
                (id, number)
            })
            .collect();
        Self { numbers }
    }

    /// The colour of a body's group, or its own made pale.
    pub(crate) fn colour(&self, id: BodyId, own: Colour, style: &Style) -> Colour {
        match self.numbers.get(&id) {
            Some(number) => style.series[number % style.series.len()].with_alpha(own.alpha),
            None => own.mixed(style.background.with_alpha(own.alpha), PALE),
        }
    }
}

fn root(parents: &BTreeMap<BodyId, BodyId>, mut id: BodyId) -> BodyId {
    while let Some(&parent) = parents.get(&id)
        && parent != id
    {
        id = parent;
    }
    id
}
