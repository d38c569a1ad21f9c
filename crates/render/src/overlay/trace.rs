//! What a picture shows of the time before it.

use std::collections::{BTreeMap, VecDeque};

use carom_dynamics::{BodyId, BodyKind, EventKind, World};
use carom_math::{SimTime, Vec2};

use super::Overlaid;
use crate::{Colour, Ink, Op, Overlay};

/// How long an impact is seen, in s.
const GLOW: f64 = 0.2;
/// Radius of a flash at age 0, in pixels of the overlay: of the weakest and of the strongest impact.
const BURST: (f64, f64) = (4.0, 22.0);
/// Speed of approach that makes half the strongest burst, in pixels of the overlay a second.
const HALF_BURST: f64 = 300.0;
/// Rays of a burst.
const RAYS: u32 = 8;
/// A trail is drawn in so many pieces, each paler than the next.
const PIECES: usize = 12;
/// Width of a trail, in pixels of the overlay.
const TRAIL: f64 = 1.4;

/// Paths and impacts of the last seconds.
///
/// It sees what it is shown: call [`Trace::watch`] after every step.
///
/// # Examples
/// ```
/// use carom_dynamics::{Settings, World};
/// use carom_render::{Camera, Frame, Look, Overlay, Trace};
/// use carom_math::Vec2;
///
/// let mut world = World::new(Settings::default())?;
/// let look = Look { overlay: Overlay { trails: Some(1.0), ..Overlay::default() }, ..Look::default() };
/// let mut trace = Trace::new(&look.overlay);
/// for _ in 0..10 {
///     world.step(1.0 / 60.0);
///     trace.watch(&world);
/// }
/// let frame = Frame::capture_traced(&world, &look, &Camera::new(Vec2::ZERO, 50.0, 400, 300)?, &trace);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// How far back paths go, in s.
    length: f64,
    /// Whether impacts are kept.
    flashes: bool,
    paths: BTreeMap<BodyId, VecDeque<(SimTime, Vec2)>>,
    impacts: VecDeque<(SimTime, Vec2, f64)>,
    count: u64,
}

impl Trace {
    /// Remembers what this overlay shows, and no more.
    #[must_use]
    pub fn new(overlay: &Overlay) -> Self {
        Self {
            length: overlay.trails.unwrap_or(0.0),
            flashes: overlay.flashes,
            ..Self::default()
        }
    }

    /// Looks at the world after a step.
    pub fn watch(&mut self, world: &World) {
        self.impacts(world);
        if self.length > 0.0 {
            self.paths(world);
        }
    }

    fn impacts(&mut self, world: &World) {
        for event in world.events() {
            if let EventKind::Impact { point, speed, .. } = event.kind {
                self.count += 1;
                if self.flashes {
                    self.impacts.push_back((event.time, point, speed));
                }
            }
        }
        self.count += world.events().dropped() as u64;
        let now = world.time();
        while let Some((time, ..)) = self.impacts.front()
            && now - *time > GLOW
        {
            self.impacts.pop_front();
        }
    }

    fn paths(&mut self, world: &World) {
        let now = world.time();
        for body in world.bodies() {
            if body.kind() == BodyKind::Fixed {
                continue;
            }
            let path = self.paths.entry(body.id()).or_default();
            path.push_back((now, body.centre()));
            while let Some((time, _)) = path.front()
                && now - *time > self.length
            {
                path.pop_front();
            }
        }
        self.paths.retain(|&id, _| world.body(id).is_some());
    }

    /// Impacts so far.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }
}

impl Overlaid<'_> {
    /// Paths that are paler the longer ago they were.
    pub(super) fn trails(&mut self) {
        if self.look.overlay.trails.is_none() {
            return;
        }
        let ground = self.look.style.background;
        for (&id, path) in &self.trace.paths {
            let Some(body) = self.world.body(id) else {
                continue;
            };
            let colour = self.look.paint(&body).fill.with_alpha(255);
            let points: Vec<Vec2> = path.iter().map(|&(_, p)| self.camera.point(p)).collect();
            let step = points.len().div_ceil(PIECES).max(1);
            let mut start = 0;
            while start + 1 < points.len() {
                let end = (start + step).min(points.len() - 1);
                #[expect(clippy::cast_precision_loss, reason = "few points")]
                let age = 1.0 - end as f64 / points.len() as f64;
                self.frame.push(Op::Line {
                    points: points[start..=end].to_vec(),
                    width: TRAIL * self.unit,
                    dash: None,
                    ink: Ink::Of(colour.mixed(ground, 0.15 + 0.85 * age)),
                });
                start = end;
            }
        }
    }

    /// A burst of rays at every impact of the last moment.
    pub(super) fn flashes(&mut self) {
        if !self.look.overlay.flashes {
            return;
        }
        let now = self.world.time();
        for &(time, point, speed) in &self.trace.impacts {
            let age = ((now - time) / GLOW).clamp(0.0, 1.0);
            let pixels = self.camera.length(speed) / self.unit;
            let part = pixels / (pixels + HALF_BURST);
            let size = (BURST.0 + (BURST.1 - BURST.0) * part) * self.unit;
            self.burst(self.camera.point(point), size, age);
        }
    }

    fn burst(&mut self, centre: Vec2, size: f64, age: f64) {
        let ink = faded(self.look.style.bar, 1.0 - age);
        // The rays fly outwards while they shrink.
        let (inner, outer) = (size * (0.35 + 0.65 * age), size * (1.0 + 0.2 * age));
        for ray in 0..RAYS {
            let turn =
                carom_math::Rot::from_degrees(22.5 + 360.0 * f64::from(ray) / f64::from(RAYS));
            let along = turn.x_axis();
            self.frame.push(Op::Line {
                points: vec![centre + inner * along, centre + outer * along],
                width: 1.6 * self.unit,
                dash: None,
                ink,
            });
        }
        self.frame.push(Op::Dot {
            centre,
            radius: 0.3 * size * (1.0 - age),
            ink,
        });
    }
}

/// A colour that lets through what lies behind it.
fn faded(colour: Colour, part: f64) -> Ink {
    Ink::Of(colour.with_alpha(crate::colour::round_u8(255.0 * part)))
}
