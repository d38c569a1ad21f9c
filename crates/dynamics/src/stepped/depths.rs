//! Bodies that lie deep in each other: the rows about them are relaxed many times in a sub-step.

use crate::World;
use crate::pairs::Pair;
use crate::solver::RowId;

/// Sweeps without bias while bodies lie deep in each other.
const SWEEPS: usize = 30;

/// What the looks of a tick found of bodies deep in each other.
#[derive(Clone, Debug, Default)]
pub(super) struct Depths {
    /// Some were put there.
    buried: bool,
    /// Some sank in.
    sunk: bool,
    /// Heavy ones touch light ones.
    loaded: bool,
    /// Bodies of those that were put there, and of those that bear a load.
    bodies: Vec<u32>,
}

impl Depths {
    /// A tick begins.
    pub(super) fn clear(&mut self) {
        (self.buried, self.sunk, self.loaded) = (false, false, false);
        self.bodies.clear();
    }

    /// Takes note of a pair, that lies deep in each other or bears a load.
    pub(super) fn note(&mut self, pair: &Pair, deep: bool, loaded: bool) {
        if pair.buried || loaded {
            self.bodies.extend([pair.bodies.0, pair.bodies.1]);
        }
        self.buried |= pair.buried;
        self.sunk |= deep;
        self.loaded |= loaded;
    }

    /// Whether one sweep would leave a part of the push in the velocities: what was put deep into each other
    /// is pushed by many at once, and a light body between a heavy one and the floor gives way to both in turn.
    const fn wants_sweeps(&self) -> bool {
        self.buried || self.sunk && self.loaded
    }
}

impl World {
    /// Rows that are to be swept more often in this sub-step than the others, and how often more.
    pub(super) fn rows_in_need(&self) -> (usize, Vec<RowId>) {
        let depths = &self.pool.depths;
        if !self.moves_all() || !depths.wants_sweeps() {
            return (0, Vec::new());
        }
        let mut bodies = depths.bodies.clone();
        bodies.sort_unstable();
        bodies.dedup();
        let places = bodies
            .iter()
            .flat_map(|index| &self.bodies.get(*index).pairs);
        let contacts = places.flat_map(|place| &self.pairs.get(*place).contacts);
        (
            SWEEPS - 1,
            contacts.filter_map(|contact| contact.row).collect(),
        )
    }
}
