//! Bodies that lie deep in each other, and light ones under heavy ones: the rows about them are swept many times in a sub-step.

use crate::World;
use crate::heavy::BEARS;
use crate::pairs::Pair;
use crate::solver::{HEAVY, Often};

/// Sweeps without bias while bodies lie deep in each other, and under a load of [`BEARS`].
const SWEEPS: usize = 30;

/// The same beyond a load of [`HEAVY`]: a heavy body bears on a light one, which passes on a thousandth of the momentum in each.
const LOADED: usize = 120;

/// What the looks of a tick found of bodies deep in each other.
#[derive(Clone, Debug, Default)]
pub(super) struct Depths {
    /// Some were put there.
    buried: bool,
    /// The largest ratio of masses where a light one gives way to a heavy one.
    ratio: f64,
    /// Bodies of those that were put there, and of those that bear a load.
    bodies: Vec<u32>,
}

impl Depths {
    /// A tick begins.
    pub(super) fn clear(&mut self) {
        (self.buried, self.ratio) = (false, 1.0);
        self.bodies.clear();
    }

    /// Takes note of a pair, that was put deep into each other, or of which one is so many times as heavy as the other, which
    /// gives way.
    pub(super) fn note(&mut self, pair: &Pair, ratio: f64) {
        if pair.buried || ratio > BEARS {
            self.bodies.extend([pair.bodies.0, pair.bodies.1]);
        }
        self.buried |= pair.buried;
        self.ratio = self.ratio.max(ratio);
    }

    /// How often rows are swept, with bias and without, where once would leave a part of the push in the velocities: what was
    /// put deep into each other is pushed by many at once, and a light body between a heavy one and the floor gives way to
    /// both in turn. Only of a load is the bias passed on as well: what lies in one place would be thrown apart by it.
    fn sweeps(&self) -> (usize, usize) {
        if self.ratio > HEAVY {
            (LOADED, LOADED)
        } else if self.ratio > BEARS {
            (SWEEPS, SWEEPS)
        } else if self.buried {
            (1, SWEEPS)
        } else {
            (1, 1)
        }
    }
}

impl World {
    /// Rows that are to be swept more often in this sub-step than the others.
    pub(super) fn rows_in_need(&self) -> Often {
        let depths = &self.pool.depths;
        let (solve, relax) = depths.sweeps();
        if !self.moves_all() || relax == 1 {
            return Often::default();
        }
        let mut bodies = depths.bodies.clone();
        bodies.sort_unstable();
        bodies.dedup();
        let places = bodies
            .iter()
            .flat_map(|index| &self.bodies.get(*index).pairs);
        Often {
            rows: places
                .flat_map(|place| self.pairs.rows_of(*place))
                .collect(),
            solve: solve - 1,
            relax: relax - 1,
        }
    }
}
