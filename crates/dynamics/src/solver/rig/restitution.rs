//! Rows that bounce: hidden until they are met, and opened at e times the speed of it.

use carom_math::perp;

use super::Rig;
use crate::solver::Row;
use crate::solver::lanes::RowId;

impl Rig {
    /// What a row sees of its bodies: opening speeds of both points, and the slip beyond that of the surfaces.
    pub(crate) fn seen(&self, row: &Row) -> [f64; 3] {
        let (a, b) = (
            &self.lines[row.bodies.0 as usize],
            &self.lines[row.bodies.1 as usize],
        );
        row.seen((a.v(), a.w()), (b.v(), b.w()))
    }

    /// The same at the start of the last sub-step.
    pub(crate) fn seen_before(&self, row: &Row, h: f64) -> [f64; 3] {
        row.seen(self.before(row.bodies.0, h), self.before(row.bodies.1, h))
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
    /// after the other; 0: not met. It gives back no more than `room`, in J, and takes that from it.
    /// Gives the energy that is lost, in J: impulse × mean closing speed.
    pub(crate) fn bounce(&mut self, id: RowId, e: f64, met: [f64; 2], room: &mut f64) -> f64 {
        let mut lost = 0.0;
        self.bounced.push(id);
        for (i, met) in met.into_iter().enumerate() {
            let row = self.row(id);
            if met <= 0.0 || row.j[i] <= 0.0 {
                continue;
            }
            let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
            let [ma, ia] = [3, 7].map(|k| self.lines[a].0[k]);
            let [mb, ib] = [3, 7].map(|k| self.lines[b].0[k]);
            let k = ma + mb + ia * row.a[i] * row.a[i] + ib * row.b[i] * row.b[i];
            let opening = self.seen(&row)[i];
            let j = ((e * met - opening) / k).max(-row.j[i]);
            // u j + k j²/2 at most what there is: others may have taken what restitution counts on.
            let square = opening * opening + 2.0 * k * *room;
            let highest = if square > 0.0 {
                (square.sqrt() - opening) / k
            } else {
                0.0
            };
            let j = j.min(highest.max(0.0));
            *room -= j * (opening + 0.5 * k * j);
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
        self.keep_cone(id, room);
        lost
    }

    /// Takes back what friction did beyond its cone, where less pushes than when it acted.
    fn keep_cone(&mut self, id: RowId, room: &mut f64) {
        let row = self.row(id);
        let limit = row.mu * (row.j[0] + row.j[1]);
        let jt = row.jt.clamp(-limit, limit);
        let change = jt - row.jt;
        if change.abs() > 0.0 {
            let impulse = perp(row.n) * change;
            let slip = self.seen(&row)[2] + row.belt;
            let mut k = 0.0;
            let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
            for (slot, sign, arm) in [(a, -1.0, row.at), (b, 1.0, row.bt)] {
                let line = &mut self.lines[slot];
                let (m, i) = (line.inverse_mass(), line.inverse_inertia());
                line.0[0] += sign * impulse.x * m;
                line.0[1] += sign * impulse.y * m;
                line.0[2] += sign * arm * change * i;
                k += m + arm * arm * i;
            }
            *room -= change * (slip + 0.5 * k * change);
            let (wide, lane) = self.lanes.at_mut(id);
            wide.jt[lane] = jt;
        }
    }
}
