//! Bodies with numbers that are no longer finite.

use carom_math::Vec2;

use crate::Engine;
use crate::bodies::Bodies;

impl Engine {
    /// Stops such bodies where they were last known to be, at the end of a tick; without contacts, since impulses are no numbers either.
    pub(crate) fn stop_non_finite(&mut self) {
        for at in 2..self.bodies.lines.len() {
            if self.bodies.lines[at].is_finite() {
                continue;
            }
            let slot = self.bodies.slot_of[at];
            self.drop_contacts(slot);
            let Bodies { lines, start, .. } = &mut self.bodies;
            lines[at].set_velocity(Vec2::ZERO, 0.0);
            lines[at].clear_displacement();
            start[at].0[..3].fill(0.0);
            (self.bodies.moved[at], self.bodies.may_deviate) = (true, true);
            self.ways.forget();
            self.stopped += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_math::vec2;

    use crate::tests::{floor, unit_box};
    use crate::{BodyInput, Engine, Settings};

    /// What was no number stood in no contact for ever, and nothing said so.
    #[test]
    fn a_body_without_finite_numbers_is_put_back_and_counted() {
        let mut engine = Engine::new(Settings::default()).unwrap();
        floor(&mut engine);
        let ids = [0.5, 1.5].map(|y| {
            let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, y));
            engine.insert(body, &[unit_box()]).unwrap()
        });
        for _ in 0..3 {
            engine.tick();
        }
        engine.bodies.lines[3].0[2] = f64::NAN;
        engine.tick();
        assert!(engine.stopped_count() > 0);
        for _ in 0..60 {
            engine.tick();
            engine.graph.check(&engine.bodies);
        }
        for (id, y) in ids.into_iter().zip([0.5, 1.5]) {
            let state = engine.state(id).unwrap();
            let off = (state.pose.position - vec2(0.0, y)).length();
            assert!(off < 2e-3 && state.turned.abs() < 1e-3, "{state:?}");
        }
    }
}
