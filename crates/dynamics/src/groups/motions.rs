//! What becomes of what was solved for: motions to the members, impulses to the pairs, friction to the ledger.

use carom_math::SimTime;

use super::Groups;
use super::SolverBody;
use crate::store::bodies::{Bodies, Booked};
use crate::store::pairs::Pairs;
use crate::store::uncommon::Lag;

impl Groups {
    /// Has the body at a place of the solver go its way from `time` on, for `h` seconds.
    ///
    /// What was pushed out is a displacement, not a motion: it moves the body at once, by the difference of the pushed and
    /// the relaxed velocity, and strikes nothing. The rest is the trapezoid from the velocity before to the relaxed
    /// one, so that sliding is of second order and the velocity has no jumps; but for some held without springs.
    pub(super) fn send(&mut self, bodies: &mut Bodies, place: usize, time: SimTime, h: f64) {
        let index = self.members[place];
        let (member, way) = (&mut self.bodies[place], self.ways[place]);
        let end = (member.v, member.w);
        let (pushed, turned) = (member.d - member.v * h, member.turn - member.w * h);
        let before = bodies.energy_of(index, time);
        bodies.change(index, time, |motion| {
            motion.centre += pushed;
            motion.rotation = motion.rotation.turned(turned);
            let (from, to) = way.even.map_or((way.start, end), |even| (even, even));
            (motion.velocity, motion.spin) = from;
            motion.acceleration = (to.0 - from.0) / h;
            motion.angular_acceleration = (to.1 - from.1) / h;
        });
        let state = bodies.get_mut(index);
        state.turned += turned;
        state.member = true;
        if let Some(even) = way.even {
            state.set_lag(Lag::of_even(even, way.start, end, h));
        }
        member.d = state.motion.travel(h);
        member.turn = state.motion.turn(h);
        let after = bodies.energy_of(index, time);
        bodies.book.scheme.add(after.0 - before.0);
        bodies.book.scheme.add(after.1 - before.1);
    }

    /// What row `k` does within `h` seconds from `time` on.
    pub(super) fn book(
        &self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        k: usize,
        time: SimTime,
        h: f64,
    ) {
        let (row, source) = (&self.rows[k], &self.sources[k]);
        let pair = pairs.get_mut(source.pair);
        pair.round = source.is_round;
        // A contact update since the sub-step began may have found the pair apart.
        if let Some(contact) = pair.contacts.get_mut(source.contact) {
            // The next sub-step begins with what a whole one asks for.
            let whole = self.h / h;
            for (point, j) in contact.points.iter_mut().zip(row.j) {
                point.impulse = j * whole;
            }
            contact.tangent_impulse = row.jt * whole;
        }
        if !row.acts() {
            return;
        }
        pair.lasting = true;
        let ends = [row.bodies.0, row.bodies.1];
        let [a, b] = ends.map(|place| &self.bodies[place as usize]);
        // Friction × slip is heat; the pieces' own work holds it too, as the scheme's.
        let mean = |body: &SolverBody| SolverBody {
            v: body.d / h,
            w: body.turn / h,
            ..*body
        };
        let heat = -row.jt * (row.slip(&mean(a), &mean(b)) - row.belt);
        bodies.book.friction.add(heat);
        bodies.book.scheme.add(heat);
        // What runs a belt puts in what the bodies get, and the heat.
        let driven = row.driven_work(a, b) + row.jt * row.belt;
        bodies.book.external.add(driven);
        bodies.book.scheme.add(-driven);
        let moves = |place: &u32| self.bodies[*place as usize].inverse_mass > 0.0;
        let mut moving = ends.into_iter().filter(moves);
        // A group that goes on after an impact is booked anew, all of it.
        if let (Some(place), other) = (moving.next(), moving.next())
            && (pair.round || other.is_none())
        {
            bodies.booked.push(Booked {
                index: self.members[place as usize],
                until: time + h,
                driven: driven / h,
                heat: heat / h,
            });
        }
    }
}
