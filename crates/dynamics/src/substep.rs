//! A sub-step: which bodies join the engine, and how it moves them.

use carom_math::SimTime;

use crate::{BodyIx, World};

impl World {
    /// One sub-step of the engine. All bodies outside of it go by events.
    pub(crate) fn begin_substep(&mut self) {
        let time = self.clock.next();
        self.stopwatch.lap(|p| &mut p.impacts);
        self.report_waiting(time);
        self.clock.begin();
        self.report.substeps += 1;
        let before = self.report.handed_over;
        self.end_rush(time);
        self.join_exhausted(time);
        while self.settle(time) {}
        self.gather_members(time);
        while self.settle(time) {}
        self.stopwatch.lap(|p| &mut p.contacts);
        self.step_members(time);
        self.handed_over = self.report.handed_over - before;
        self.stopwatch.lap(|p| &mut p.solver);
    }

    /// Overlaps in the engine when a call ends within a sub-step.
    pub(crate) fn tell_overlaps(&mut self, time: SimTime) {
        if self.clock.is_within(time)
            && let Some(stepping) = &self.stepping
        {
            let deepest = stepping.deepest_at(self.rules(), time, self.clock.h);
            self.report.deepest_overlap = self.report.deepest_overlap.max(deepest);
        }
    }

    /// A body that fell asleep: free bodies meet it as one at rest.
    pub(crate) fn lie_down(&mut self, index: BodyIx, time: SimTime) {
        self.end_unsettled(index);
        for place in self.bodies.get(index).pairs.clone() {
            let pair = self.pairs.get_mut(place);
            let other = pair.other(index);
            let state = self.bodies.get(other);
            if state.goes_by_events() {
                self.part(place, time);
            } else if !state.is_stepped() {
                // No contact update before one of the two wakes.
                pair.lasting = false;
            }
        }
        self.show(index, time);
        self.show_engine(index);
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::ConvexPolygon;
    use carom_math::vec2;

    use crate::{BodyDef, Material, Settings, World};

    /// It turned by no number, so that the engine did not take it: it fell through the floor.
    #[test]
    fn what_was_stopped_lands_on_the_floor() {
        let mut world = World::new(Settings::default()).expect("settings");
        let mut put = |def: BodyDef, width: f64| {
            let block = ConvexPolygon::rectangle(width, 1.0).expect("a block");
            world
                .insert(def, block, Material::default())
                .expect("valid")
        };
        put(BodyDef::fixed().at(vec2(0.0, -0.5)), 10.0);
        let id = put(BodyDef::dynamic().at(vec2(0.0, 2.0)).turned(0.3), 1.0);
        world.step(0.1);
        let state = world.bodies.get_mut(id.index);
        (state.motion.spin, state.turned) = (f64::NAN, f64::NAN);
        let now = world.clock.now;
        world.bodies.stop(id.index, now);
        let told = world.set_velocity(id, vec2(0.0, -5.0), 0.0);
        assert!(told.is_ok(), "{told:?}");
        world.step(2.0);
        let body = world.body(id).expect("there");
        assert!(body.centre().y > 0.4 && body.angle().is_finite());
    }
}
