//! Analytic islands that turn about their contacts: they begin a path, go on along it, and leave it.

use std::sync::Arc;

use carom_math::SimTime;

use crate::analytic::islands::kept;
use crate::analytic::islands::store::Group;
use crate::analytic::islands::tips::{is_too_large, path_of};
use crate::analytic::modes::NotMine;
use crate::analytic::touching::Gathered;
use crate::{BodyIx, IslandIx, Mode, World};

/// Sub-steps within which what a landing opens comes back, if it counts as closed. With 1 boxes that rock take 1.2 of the time.
const BACK: f64 = 4.0;

/// Times the rest speed above which a corner that comes down so soon was not opened by that landing: the far end of a capsule that falls
/// flat follows its near end at once. The corner of a body on another one is pulled by up to 1.5 g.
const SLOW: f64 = 2.0;

impl World {
    /// Moves a group along the path that its contacts leave it; `landed`: a corner came down just now.
    ///
    /// A corner that is back within [`BACK`] sub-steps rests, as a bounce does that is over in these (`rest_speed`): with e = 0
    /// a box rocks in a series without end. In [`Mode::Exact`] the series goes on.
    pub(crate) fn tip_over(
        &mut self,
        gathered: &Gathered,
        time: SimTime,
        speed: f64,
        landed: bool,
    ) -> Result<(), NotMine> {
        if is_too_large(gathered, self.settings.mode) {
            return Err(NotMine::Turns);
        }
        self.land_touching(gathered, time);
        let gathered = &*gathered.with_corners_once();
        let tip = path_of(&self.bodies, &self.pairs, gathered, (time, speed))?;
        let is_slow = || {
            tip.landing_speed()
                .is_some_and(|speed| speed < SLOW * gathered.rest)
        };
        if landed
            && self.settings.mode == Mode::Hybrid
            && tip.after < BACK * self.clock.h
            && is_slow()
        {
            return Err(NotMine::Returns);
        }
        let (moves, touches) = tip.moves_after(0.0).ok_or(NotMine::Unsolved)?;
        let group = Group {
            since: time,
            touches: kept(gathered, &moves, &touches),
            members: Vec::new(),
            speed,
            sleeps: false,
            until: Some(time + tip.after),
            tip: Some(Arc::new(tip)),
        };
        self.begin_group(gathered, &moves, group);
        Ok(())
    }

    /// A group that turns goes on with the next stretch of its path; whether it does.
    pub(crate) fn continue_path(&mut self, place: IslandIx, time: SimTime) -> bool {
        let Some(group) = self.closed.get(place) else {
            return false;
        };
        let stands = |&(index, version): &(BodyIx, u32)| self.bodies.version(index) == version;
        let Some(tip) = &group.tip else {
            return false;
        };
        if !group.members.iter().all(stands) {
            return false;
        }
        let Some(next) = tip.next(group.speed) else {
            return false;
        };
        // The modes take roundings out of the velocities.
        let (mut lost, mut fastest) = (0.0, group.speed);
        for (&(index, _), slot) in group.members.iter().zip(tip.movers()) {
            let (_, velocity, _, spin) = next.path.body_after(slot, 0.0);
            let state = self.bodies.get(index);
            let linear = state.mass.mass * velocity.length_squared();
            let angular = state.turning_inertia() * spin * spin;
            lost += state.kinetic_energy(time) - 0.5 * (linear + angular);
            fastest = fastest.max(velocity.length()).max(spin.abs() * state.reach);
        }
        let (moves_analytically, heat) = (
            group.moves_analytically(&self.bodies),
            group.works(time - group.since).0,
        );
        let members = group.indices();
        if self.stalls(&members, time) {
            return false;
        }
        self.report.modes_solved += 1;
        self.bodies.book.friction.add(heat);
        self.bodies.book.scheme.add(heat);
        self.bodies.book.impacts.add(lost);
        let change = time + next.after;
        if let Some(group) = self.closed.get_mut(place) {
            (group.since, group.speed) = (time, fastest);
            group.tip = Some(Arc::new(next));
        }
        self.closed.changes_at(place, change);
        if moves_analytically {
            self.begin_next_pieces(place, time);
        }
        true
    }
}
