//! Restitution: what a face gives back of the speed at which it was met.
//!
//! A row stops a body at its surface by the end of a sub-step. Where the pair bounces, the opening
//! speed is then set to e times the speed at which the surface was reached: that of the start of the
//! sub-step, and what the pull added along the gap.

use crate::solver::{Budget, Rig, Row, RowId};

/// Rows of pairs that bounce.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bounces {
    /// Restitution by row; 0 for rows that do not bounce.
    restitution: Vec<f64>,
    /// In the order in which they came; `None` where one went.
    rows: Vec<Option<RowId>>,
    /// Where a row that bounces stands in `rows`, by row.
    at: Vec<u32>,
    gone: usize,
    /// What bounces cost, in J.
    cost: f64,
    /// Rows that are about to be met in this sub-step: closing speeds of both points at the surface.
    armed: Vec<(RowId, [f64; 2])>,
    /// Rows that are met later: hidden in this sub-step, so that nothing brakes them early.
    hidden: Vec<(RowId, [f64; 2])>,
    budget: Budget,
}

impl Bounces {
    pub(crate) fn note(&mut self, id: RowId, e: f64) {
        let at = id.0 as usize;
        if self.restitution.len() <= at {
            self.restitution.resize(at + 1, 0.0);
            self.at.resize(at + 1, 0);
        }
        self.restitution[at] = e;
        if e > 0.0 {
            #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 rows")]
            let end = self.rows.len() as u32;
            self.at[at] = end;
            self.rows.push(Some(id));
        }
    }

    pub(crate) fn forget(&mut self, id: RowId) {
        if core::mem::take(&mut self.restitution[id.0 as usize]) > 0.0 {
            self.rows[self.at[id.0 as usize] as usize] = None;
            self.gone += 1;
            if 2 * self.gone > self.rows.len() {
                self.close_up();
            }
        }
    }

    /// Closes the holes; the order stays.
    fn close_up(&mut self) {
        self.gone = 0;
        self.rows.retain(Option::is_some);
        for (place, row) in (0u32..).zip(&self.rows) {
            if let Some(row) = row {
                self.at[row.0 as usize] = place;
            }
        }
    }

    /// Before a sub-step: which rows will be met faster than rest.
    pub(crate) fn arm(&mut self, rig: &mut Rig, h: f64) {
        self.armed.clear();
        self.hidden.clear();
        self.budget.clear();
        for &id in self.rows.iter().flatten() {
            let row = rig.row(id);
            let (a, b) = (row.bodies.0, row.bodies.1);
            let pull = rig.pull(b).acceleration - rig.pull(a).acceleration;
            let along = row.n.dot(pull);
            let rest = 2.0 * h * pull.length();
            let opening = rig.seen(&row);
            let (mut met, mut later, mut held) = ([0.0; 2], false, false);
            for i in 0..2 {
                let (gap, speed) = (row.gap[i].max(0.0), -opening[i]);
                // A face of one point has no second.
                if gap > 0.5 * Row::OPEN {
                    continue;
                }
                let within = row.gap[i] <= 0.0 || gap <= (speed - along * h) * h;
                if speed <= rest {
                    held |= within;
                } else if !within {
                    later = true;
                } else {
                    met[i] = (speed * speed - 2.0 * along * gap).max(0.0).sqrt();
                }
            }
            if met[0] > 0.0 || met[1] > 0.0 {
                self.budget.note(rig, &row);
                self.armed.push((id, met));
            } else if later && !held {
                self.hidden.push((id, rig.hide(id)));
            }
        }
    }

    /// Whether no row bounces, whatever it meets.
    pub(crate) const fn is_idle(&self) -> bool {
        self.rows.len() == self.gone
    }

    /// Whether somebody is met, or hidden, in this sub-step.
    pub(crate) const fn owe(&self) -> bool {
        !(self.armed.is_empty() && self.hidden.is_empty())
    }

    /// After a sub-step: the opening speeds that are owed.
    pub(crate) fn pay(&mut self, rig: &mut Rig, h: f64) {
        for (id, gaps) in self.hidden.drain(..) {
            rig.show(id, gaps);
        }
        self.budget
            .settle(rig, self.armed.iter().map(|(id, _)| *id), h);
        for &(id, met) in &self.armed {
            let e = self.restitution[id.0 as usize];
            if let Some(room) = self.budget.room_of(&rig.row(id)) {
                self.cost += rig.bounce(id, e, met, room);
            }
        }
    }

    /// What bounces have cost so far, in J.
    pub(crate) const fn cost(&self) -> f64 {
        self.cost
    }
}
