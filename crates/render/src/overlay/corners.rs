//! What stands in the corners of the picture.

use carom_dynamics::{Body, BodyKind, World};
use carom_math::{Vec2, vec2};

use super::{Overlaid, TEXT};
use crate::{Ink, Label, Op};

/// Room to the edges of the picture, length and height of the bar and length of the arrow, in pixels of the overlay.
const EDGE: f64 = 18.0;
const BAR: (f64, f64) = (120.0, 9.0);
const GRAVITY: f64 = 40.0;

/// Bodies, contacts, impacts and energy, a line each.
fn counters(world: &World, impacts: u64) -> [String; 4] {
    let moving = || world.bodies().filter(|body| body.kind() != BodyKind::Fixed);
    let asleep = moving().filter(Body::is_asleep).count();
    let energy = world.energy();
    [
        format!("bodies {}, {asleep} asleep", moving().count()),
        format!("contacts {}", world.contacts().count()),
        format!("impacts {impacts}"),
        format!(
            "energy {} J, kinetic {} J",
            number(energy.mechanical()),
            number(energy.kinetic)
        ),
    ]
}

/// Four digits at most before a power of ten is needed.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (0.01..1e5).contains(&size) => format!("{value:.2}"),
        _ => format!("{value:.2e}"),
    }
}

impl Overlaid<'_> {
    /// Time, gravity, restitution and caption, one in each corner.
    pub(super) fn corners(&mut self) {
        let size = self.camera.size().corner();
        let (edge, height) = (EDGE * self.unit, TEXT * self.unit);
        let overlay = &self.look.overlay;
        let text = |at: Vec2, text: String, x: f64, y: f64| {
            Label::new(at, text, height, Ink::Text)
                .anchored(x, y)
                .with_halo()
        };
        if overlay.time {
            let time = format!("t = {:.2} s", self.world.time().as_secs());
            self.frame.push(text(vec2(edge, edge), time, 0.0, 1.0));
        }
        if overlay.counters {
            let first = edge + if overlay.time { 1.9 * height } else { 0.0 };
            for (k, line) in (0..).zip(counters(self.world, self.trace.count())) {
                let at = vec2(edge, first + 1.7 * height * f64::from(k));
                self.frame.push(text(at, line, 0.0, 1.0));
            }
        }
        if !overlay.caption.is_empty() {
            let caption = overlay.caption.clone();
            self.frame
                .push(text(size - Vec2::splat(edge), caption, 1.0, 0.0));
        }
        let gravity = self.world.settings().gravity;
        if overlay.gravity && gravity != Vec2::ZERO {
            let long = GRAVITY * self.unit;
            let middle = vec2(size.x - edge - 0.5 * long, edge + 0.5 * long);
            let along = 0.5 * long * self.camera.vector(gravity).normalize_or_zero();
            self.frame.push(Op::Arrow {
                from: middle - along,
                to: middle + along,
                width: 2.5 * self.unit,
                ink: Ink::Field,
            });
            let value = format!("g = {:.2} m/s²", gravity.length());
            let left = middle - vec2(0.5 * long + 4.0 * self.unit, 0.0);
            self.frame.push(text(left, value, 1.0, 0.5));
        }
        if let Some(restitution) = overlay.restitution {
            let bar = vec2(BAR.0, BAR.1) * self.unit;
            let min = vec2(edge, size.y - edge - bar.y);
            let filled = vec2(bar.x * restitution.clamp(0.0, 1.0), bar.y);
            for (max, ink) in [(min + bar, Ink::Grid), (min + filled, Ink::Bar)] {
                self.frame.push(Op::Box {
                    min,
                    max,
                    fill: Some(ink),
                    border: None,
                    width: 0.0,
                    dash: None,
                });
            }
            self.frame.push(Op::Box {
                min,
                max: min + bar,
                fill: None,
                border: Some(Ink::Muted),
                width: 1.0,
                dash: None,
            });
            let value = format!("e = {restitution:.2}");
            let right = min + vec2(bar.x + 8.0 * self.unit, 0.5 * bar.y);
            self.frame.push(text(right, value, 0.0, 0.5));
        }
    }
}
