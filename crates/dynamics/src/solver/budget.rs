//! What bounces may give back: no more than the contacts that bounce took in the same sub-step.
//!
//! With u⁻ and u⁺ the velocities that a row sees before and after it, and j its impulses, a sub-step changes the
//! kinetic energy of the bodies by
//!
//! ```text
//! ΔK = Σ_rows ½ j (u⁻ + u⁺) + Σ_bodies m a · h ½ (v⁻ + v⁺)
//! ```
//! exactly, whatever the sweeps did. Pull has taken m a · Δd from the potential energy on the way actually gone; what it
//! gave beyond that is owed. So rows that bounce, and hang together by bodies that move, share
//!
//! ```text
//! room = −Σ_rows ½ j (u⁻ + u⁺) − Σ_bodies m a · (h ½ (v⁻ + v⁺) − Δd)
//! ```
//! Heat of friction stays heat; where friction gave energy that is owed, too. All terms are the same for an observer who
//! moves along, so that driven bodies need no term of their own.

use carom_math::Vec2;

use super::rig::Rig;
use super::{Row, RowId};

/// A body that rows are about to stop.
#[derive(Clone, Copy, Debug)]
struct Stopped {
    slot: u32,
    /// Where it is before the sub-step, against its base.
    d: Vec2,
    turn: f64,
}

/// What groups of rows may give back.
#[derive(Clone, Debug, Default)]
pub(crate) struct Budget {
    /// In order of slots, once the sub-step is over.
    stopped: Vec<Stopped>,
    /// By place in `stopped`: one of the same group that is nearer to its first, or itself.
    group: Vec<usize>,
    /// By first of a group, in J.
    room: Vec<f64>,
}

impl Budget {
    pub(crate) fn clear(&mut self) {
        self.stopped.clear();
    }

    /// Before a sub-step: notes where the bodies of a row are.
    pub(crate) fn note(&mut self, rig: &Rig, row: &Row) {
        for slot in [row.bodies.0, row.bodies.1] {
            let line = &rig.lines[slot as usize];
            if line.inverse_mass() > 0.0 {
                let (d, turn) = (line.d(), line.turn());
                self.stopped.push(Stopped { slot, d, turn });
            }
        }
    }

    /// After the sweeps of a sub-step of `h`: what `rows` may give back, whose bodies were all noted.
    pub(crate) fn settle(&mut self, rig: &Rig, rows: impl Iterator<Item = RowId> + Clone, h: f64) {
        self.stopped.sort_unstable_by_key(|body| body.slot);
        self.stopped.dedup_by_key(|body| body.slot);
        self.group.clear();
        self.group.extend(0..self.stopped.len());
        for id in rows.clone() {
            let row = rig.row(id);
            let ends = [row.bodies.0, row.bodies.1].map(|slot| self.first_of(slot));
            if let [Some(one), Some(other)] = ends {
                self.group[one.max(other)] = one.min(other);
            }
        }
        self.room.clear();
        self.room.resize(self.stopped.len(), 0.0);
        for k in 0..self.stopped.len() {
            let first = self.first(k);
            self.room[first] -= owed_by_pull(rig, &self.stopped[k], h);
        }
        for id in rows {
            let row = rig.row(id);
            if let Some(room) = self.room_of(&row) {
                *room += taken(rig, &row, h);
            }
        }
    }

    /// What the group of a row may still give back, in J.
    pub(crate) fn room_of(&mut self, row: &Row) -> Option<&mut f64> {
        let first = self
            .first_of(row.bodies.0)
            .or_else(|| self.first_of(row.bodies.1))?;
        Some(&mut self.room[first])
    }

    fn first_of(&self, slot: u32) -> Option<usize> {
        let place = self.stopped.binary_search_by_key(&slot, |body| body.slot);
        place.ok().map(|k| self.first(k))
    }

    fn first(&self, mut k: usize) -> usize {
        while self.group[k] != k {
            k = self.group[k];
        }
        k
    }
}

/// What pull gave a body beyond its work on the way gone, in J: m a · (h ½ (v⁻ + v⁺) − Δd).
fn owed_by_pull(rig: &Rig, body: &Stopped, h: f64) -> f64 {
    let (line, pull) = (&rig.lines[body.slot as usize], rig.pull(body.slot));
    let (v, w) = rig.before(body.slot, h);
    let way = (v + line.v()) * (0.5 * h) - (line.d() - body.d);
    let turn = (w + line.w()) * (0.5 * h) - (line.turn() - body.turn);
    let linear = pull.acceleration.dot(way) / line.inverse_mass();
    // What cannot turn is not turned by a pull either.
    if line.inverse_inertia() > 0.0 {
        linear + pull.angular * turn / line.inverse_inertia()
    } else {
        linear
    }
}

/// What a row took from its bodies, but for the heat of friction, in J.
fn taken(rig: &Rig, row: &Row, h: f64) -> f64 {
    let [before, after] = [rig.seen_before(row, h), rig.seen(row)];
    let work = |j: f64, k: usize| -0.5 * j * (before[k] + after[k]);
    work(row.j[0], 0) + work(row.j[1], 1) + work(row.jt, 2).min(0.0)
}
