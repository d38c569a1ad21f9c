//! How much bodies are thrown about from step to step: what an overlap does not show.

use carom_scenes::PlainScene;

use super::is_assessed;
use crate::engine::{Body, Engine, State};

/// Root mean square acceleration over dynamic bodies and steps.
///
/// For a body that changes its velocity by Δv and its spin by Δω in a step of length `dt`, the square of the
/// acceleration, averaged over the body's mass, is (|Δv|² + k² Δω²) / dt², with k² = I/m the square of its radius of
/// gyration. At rest it is 0; in free fall |g|; a pile that hums shows it however small its overlaps are.
#[derive(Clone, Debug)]
pub struct Unrest {
    assessed: Vec<Assessed>,
    sum: f64,
    count: usize,
}

#[derive(Clone, Copy, Debug)]
struct Assessed {
    body: usize,
    last: State,
    /// Square of the radius of gyration, in m².
    gyration: f64,
}

impl Unrest {
    /// Begins with the velocities that the dynamic bodies have now.
    #[must_use]
    pub fn new(scene: &PlainScene, engine: &dyn Engine) -> Self {
        let bodies = scene.bodies.iter().enumerate();
        let bodies = bodies.map(|(index, body)| (index, body, engine.state(index)));
        let assessed = bodies
            .filter(|(_, body, state)| is_assessed(body, state))
            .map(|(body, _, last)| Assessed {
                body,
                last,
                gyration: gyration(engine.body(body)),
            });
        Self {
            assessed: assessed.collect(),
            sum: 0.0,
            count: 0,
        }
    }

    /// Adds a step that the engine has just made, of length `dt` in s.
    pub fn add(&mut self, engine: &dyn Engine, dt: f64) {
        for assessed in &mut self.assessed {
            let now = engine.state(assessed.body);
            let pushed = (now.velocity - assessed.last.velocity).length_squared();
            let turned = now.spin - assessed.last.spin;
            let square = (pushed + assessed.gyration * turned * turned) / (dt * dt);
            if square.is_finite() {
                self.sum += square;
                self.count += 1;
            }
            assessed.last = now;
        }
    }

    /// In m/s²; 0 if nothing was added.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "a count of bodies times a count of steps"
    )]
    pub fn rms(&self) -> f64 {
        (self.sum / self.count.max(1) as f64).sqrt()
    }
}

fn gyration(body: Body) -> f64 {
    if body.mass > 0.0 {
        body.inertia / body.mass
    } else {
        0.0
    }
}
