//! Rows that bounce: hidden until they are met, and opened at e times the speed of it.

use carom_math::{Vec2, perp};

use super::Rig;
use crate::solver::Row;
use crate::solver::lanes::RowId;
use crate::solver::wide::Line;

impl Rig {
    /// Opening speeds of a row's points.
    pub(crate) fn opening(&self, row: &Row) -> [f64; 2] {
        let lines = [row.bodies.0, row.bodies.1].map(|i| &self.lines[i as usize]);
        let v = row.n.dot(lines[1].v() - lines[0].v());
        let (wa, wb) = (lines[0].w(), lines[1].w());
        [
            v + row.b[0] * wb - row.a[0] * wa,
            v + row.b[1] * wb - row.a[1] * wa,
        ]
    }

    /// Opens the gaps of a row so wide that it does not act; gives what [`Self::show`] needs.
    pub(crate) fn hide(&mut self, id: RowId) -> [f64; 2] {
        let (wide, lane) = self.lanes.at_mut(id);
        let gaps = [wide.s1[lane], wide.s2[lane]];
        (wide.s1[lane], wide.s2[lane]) = (Row::OPEN, Row::OPEN);
        gaps
    }

    pub(crate) fn show(&mut self, id: RowId, gaps: [f64; 2]) {
        let (wide, lane) = self.lanes.at_mut(id);
        [wide.s1[lane], wide.s2[lane]] = gaps;
    }

    /// Makes the points of a row that pushes open at `e` times the speeds at which they were met, one
    /// after the other; 0: not met. Gives the energy that is lost, in J: impulse × mean closing speed.
    pub(crate) fn bounce(&mut self, id: RowId, e: f64, met: [f64; 2], h: f64) -> f64 {
        let mut lost = 0.0;
        let most = self.energy_before(id, h);
        for (i, met) in met.into_iter().enumerate() {
            let row = self.row(id);
            if met <= 0.0 || row.j[i] <= 0.0 {
                continue;
            }
            let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
            let [ma, ia] = [3, 7].map(|k| self.lines[a].0[k]);
            let [mb, ib] = [3, 7].map(|k| self.lines[b].0[k]);
            let k = ma + mb + ia * row.a[i] * row.a[i] + ib * row.b[i] * row.b[i];
            let opening = self.opening(&row)[i];
            let j = ((e * met - opening) / k).max(-row.j[i]);
            // E + u j + k j²/2 at most what there was: friction may have taken what restitution counts on.
            let room = most - self.energy_of(a) - self.energy_of(b);
            let square = opening * opening + 2.0 * k * room;
            let highest = if square > 0.0 {
                (square.sqrt() - opening) / k
            } else {
                0.0
            };
            let j = j.min(highest.max(0.0));
            lost += (row.j[i] + j) * 0.5 * (1.0 - e) * met;
            let line = &mut self.lines[a].0;
            line[0] -= row.n.x * j * ma;
            line[1] -= row.n.y * j * ma;
            line[2] -= row.a[i] * j * ia;
            let line = &mut self.lines[b].0;
            line[0] += row.n.x * j * mb;
            line[1] += row.n.y * j * mb;
            line[2] += row.b[i] * j * ib;
            let (wide, lane) = self.lanes.at_mut(id);
            let column = if i == 0 { &mut wide.j1 } else { &mut wide.j2 };
            column[lane] += j;
        }
        self.keep_cone(id);
        lost
    }

    /// Takes back what friction did beyond its cone, where less pushes than when it acted.
    fn keep_cone(&mut self, id: RowId) {
        let row = self.row(id);
        let limit = row.mu * (row.j[0] + row.j[1]);
        let jt = row.jt.clamp(-limit, limit);
        let change = jt - row.jt;
        if change.abs() > 0.0 {
            let impulse = perp(row.n) * change;
            let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
            for (slot, sign, arm) in [(a, -1.0, row.at), (b, 1.0, row.bt)] {
                let line = &mut self.lines[slot];
                let (m, i) = (line.inverse_mass(), line.inverse_inertia());
                line.0[0] += sign * impulse.x * m;
                line.0[1] += sign * impulse.y * m;
                line.0[2] += sign * arm * change * i;
            }
            let (wide, lane) = self.lanes.at_mut(id);
            wide.jt[lane] = jt;
        }
    }

    /// Kinetic energy of both bodies of a row before contacts acted in this sub-step, and what the pull may
    /// have done beyond it on the way to the surface, in J.
    fn energy_before(&self, id: RowId, h: f64) -> f64 {
        let row = self.row(id);
        let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
        let [start_a, start_b] = [self.start[a], self.start[b]];
        let energy = kinetic(&self.lines[a], start_a.v(), start_a.w())
            + kinetic(&self.lines[b], start_b.v(), start_b.w());
        let pulled = (self.pull[b].v() - self.pull[a].v()).length() * h;
        let inverse_mass = self.lines[a].inverse_mass() + self.lines[b].inverse_mass();
        energy + 0.5 * pulled * pulled / inverse_mass
    }

    fn energy_of(&self, slot: usize) -> f64 {
        let line = &self.lines[slot];
        kinetic(line, line.v(), line.w())
    }
}

/// Kinetic energy of a body that moves like this, in J; 0 for what cannot be moved.
fn kinetic(line: &Line, v: Vec2, w: f64) -> f64 {
    let part = |inverse: f64, square: f64| {
        if inverse > 0.0 {
            0.5 * square / inverse
        } else {
            0.0
        }
    };
    part(line.inverse_mass(), v.length_squared()) + part(line.inverse_inertia(), w * w)
}
