//! Groups of discs after an impact in the midst of a sub-step: they are held anew for what is left of it.
//!
//! At no instant of their ways have they more energy than they began with, all together (see [`crate::groups::round`]); but they might
//! where one of them moves otherwise and the rest goes on as before. So all of the group go on from the velocities that they have
//! at that instant, with the rows of the sub-step's beginning.

use carom_math::SimTime;

use super::Row;
use super::gather::pulled;
use super::round::{Way, hold};
use super::{Groups, NOT_HERE};
use crate::StepReport;
use crate::motion::flight::fly;
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;

impl Groups {
    /// Solves for the islands of bodies that an impact has `changed`, once each; returns all with a new motion.
    pub(crate) fn go_on(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        changed: &[u32],
        time: SimTime,
        report: &mut StepReport,
    ) -> Vec<u32> {
        let h = self.until - time;
        let mut moved = Vec::new();
        if h <= 0.0 {
            return moved;
        }
        for number in self.rounds_of(changed) {
            self.leave_out_invalidated(bodies, pairs, number, changed);
            self.begin_anew(bodies, number, time, h);
            let round = &mut self.rounds[number as usize];
            round.span = h;
            let (rows, touch) = (round.rows.clone(), round.touch);
            hold(
                h,
                &mut self.bodies,
                &mut self.ways,
                &mut self.rows[rows.clone()],
                touch,
            );
            report.rows += rows.len() as u64;
            let members = self.rounds[number as usize].members.clone();
            let known: Vec<u32> = members
                .iter()
                .map(|at| self.members[*at as usize])
                .collect();
            bodies.take_back(|index| known.contains(&index), time);
            for (place, index) in members.into_iter().zip(known) {
                let place = place as usize;
                if self.bodies[place].acted {
                    self.send(bodies, place, time, h);
                } else {
                    fly(bodies, index, time, h);
                }
                self.versions[place] = bodies.version(index);
                moved.push(index);
            }
            for k in rows {
                if self.sources[k].stays(bodies, pairs) {
                    self.book(bodies, pairs, k, time, h);
                }
            }
        }
        moved
    }

    /// Groups of discs that these bodies are in, in their order.
    fn rounds_of(&self, indices: &[u32]) -> Vec<u32> {
        let place = |index: &u32| self.places.get(*index as usize).copied();
        let round = |place: u32| self.round_of.get(place as usize).copied();
        let rounds = indices.iter().filter_map(place).filter_map(round);
        let mut rounds: Vec<u32> = rounds.filter(|round| *round != NOT_HERE).collect();
        rounds.sort_unstable();
        rounds.dedup();
        rounds
    }

    /// Removes members with a motion changed by something else than this impact: closed forms, or a caller.
    ///
    /// A body that was taken out, the ground too, holds nothing any more.
    fn leave_out_invalidated(
        &mut self,
        bodies: &Bodies,
        pairs: &Pairs,
        number: u32,
        changed: &[u32],
    ) {
        let round = &mut self.rounds[number as usize];
        round.members.retain(|&place| {
            let index = self.members[place as usize];
            let raised = u32::from(changed.contains(&index));
            let known = self.versions[place as usize].wrapping_add(raised);
            let stays = bodies.version(index) == known;
            if !stays {
                self.round_of[place as usize] = NOT_HERE;
            }
            stays
        });
        let known = &self.bodies;
        let is_in = |place: u32| {
            known[place as usize].inverse_mass == 0.0 || self.round_of[place as usize] == number
        };
        for k in round.rows.clone() {
            let (a, b) = self.rows[k].bodies;
            self.sources[k].gone |= !is_in(a) || !is_in(b) || !self.sources[k].stays(bodies, pairs);
        }
    }

    /// The members as they move at `time`, pulled for `h` seconds, and the rows as they are to be held from then on.
    fn begin_anew(&mut self, bodies: &Bodies, number: u32, time: SimTime, h: f64) {
        let round = &self.rounds[number as usize];
        for &place in &round.members {
            let place = place as usize;
            let index = self.members[place];
            let state = bodies.get(index);
            let start = (state.velocity_at(time), state.spin_at(time));
            self.ways[place] = Way { start, even: None };
            let body = &mut self.bodies[place];
            (body.v, body.w) = pulled(bodies, index, time, start, h);
            body.acted = false;
        }
        let part = h / round.span;
        for k in round.rows.clone() {
            let (row, source) = (&mut self.rows[k], &self.sources[k]);
            let [a, b] = [row.bodies.0, row.bodies.1].map(|place| self.ways[place as usize].start);
            // What closes faster than rest will be struck at its instant.
            if source.gone || row.seen(a, b)[0] < -source.rest {
                (row.gap[0], row.j[0], row.jt) = (Row::OPEN, 0.0, 0.0);
            } else {
                row.gap[0] = source.closes * h;
                row.j[0] *= part;
                row.jt *= part;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::{Circle, HalfPlane};
    use carom_math::{Vec2, vec2};

    use crate::{BodyDef, Material, Mode, Settings, World};

    /// A heap of discs that rolls apart on a floor, in the midst of a sub-step that holds all of it, and a disc in it.
    fn heap_in_a_substep() -> (World, u32) {
        let mut world = World::new(Settings {
            gravity: vec2(0.0, -10.0),
            sleep: None,
            mode: Mode::Exact,
            ..Settings::default()
        })
        .expect("settings");
        let material = Material {
            restitution: 0.0,
            friction: 0.3,
            ..Material::default()
        };
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
        world
            .insert(BodyDef::fixed(), floor, material)
            .expect("valid");
        for row in 0..3 {
            for k in 0..5 - row {
                let x = 0.5 * f64::from(k) + 0.25 * f64::from(row);
                let y = 0.25 + 0.433 * f64::from(row);
                let disc = Circle::new(0.25).expect("a disc");
                world
                    .insert(BodyDef::dynamic().at(vec2(x, y)), disc, material)
                    .expect("valid");
            }
        }
        for _ in 0..2000 {
            world.step(world.clock.h / 3.0);
            let left = world.clock.next() - world.clock.now;
            let rounds = &world.groups.rounds;
            if left > 0.1 * world.clock.h
                && let Some(round) = rounds.iter().find(|round| round.members.len() > 4)
            {
                let member = world.groups.members[round.members[2] as usize];
                return (world, member);
            }
        }
        panic!("no sub-step holds the heap");
    }

    /// What an impact does to the group of a body.
    fn strike(world: &mut World, index: u32) {
        let time = world.clock.now;
        world.bodies.change(index, time, |_| {});
        let World {
            groups,
            bodies,
            pairs,
            report,
            ..
        } = world;
        groups.go_on(bodies, pairs, &[index], time, report);
    }

    #[test]
    fn a_heap_is_struck_after_a_disc_was_taken_out_of_it_within_a_sub_step() {
        let (mut world, index) = heap_in_a_substep();
        let round = world.groups.round_of[world.groups.places[index as usize] as usize];
        let members = world.groups.rounds[round as usize].members.clone();
        let taken = world.groups.members[members[1] as usize];
        let id = world.bodies.get(taken).id;
        world.remove(id).expect("it is there");
        strike(&mut world, index);
        world.step(0.5);
        assert!(world.bodies().all(|body| body.centre().is_finite()));
    }

    #[test]
    fn a_floor_that_was_taken_out_within_a_sub_step_holds_no_heap() {
        let (mut world, index) = heap_in_a_substep();
        let floor = world.bodies().next().expect("it is there").id();
        world.remove(floor).expect("it is there");
        strike(&mut world, index);
        world.step(0.5);
        let falls = world.bodies().all(|body| body.velocity().y < -1.0);
        assert!(falls, "something holds a disc");
    }
}
