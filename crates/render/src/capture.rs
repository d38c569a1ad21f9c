//! From a world to marks: what the camera sees at this instant.

use carom_dynamics::{Body, BodyKind, EventKind, World};
use carom_geometry::{Outline, Shape};
use carom_math::{Pose, Vec2, vec2};

use crate::{Camera, FieldMark, Frame, Ink, Label, Look, Op, Paint};

/// Pixels that a mark reaches beyond its body's box: half an outline and some.
const REACH: f64 = 4.0;
/// Discs smaller than this, in pixels, have no spoke.
const SMALLEST_SPOKE: f64 = 3.0;
/// How much paler a body asleep is.
const PALE: f64 = 0.45;

/// Sizes of the overlay on a picture whose shorter side is 600 px; others in proportion, within limits.
const TEXT: f64 = 10.0;
const EDGE: f64 = 18.0;
const ARROW: f64 = 1.8;
const NORMAL: f64 = 20.0;
const BAR: (f64, f64) = (120.0, 9.0);
const GRAVITY: f64 = 40.0;

impl Frame {
    /// The world at its present time, as `camera` sees it and `look` shows it.
    ///
    /// Bodies outside the picture are left out. The world is only read.
    ///
    /// # Examples
    /// ```
    /// use carom_dynamics::{BodyDef, Material, Settings, World};
    /// use carom_geometry::Circle;
    /// use carom_math::vec2;
    /// use carom_render::{Camera, Colour, Frame, Look, Style};
    ///
    /// let mut world = World::new(Settings::default())?;
    /// let ball = world.insert(BodyDef::dynamic().at(vec2(1.0, 2.0)), Circle::new(0.5)?, Material::default())?;
    /// let mut look = Look::default();
    /// look.set_colour(ball, Colour::rgb(200, 30, 30));
    /// let camera = Camera::new(vec2(0.0, 0.0), 50.0, 400, 300)?;         // m, px/m, px
    /// let picture = Frame::capture(&world, &look, &camera).paint(&Style::light());
    /// // (1, 2) m is 50 px to the right of the middle and 100 px above it.
    /// assert_eq!(picture.pixel(245, 55), Some(Colour::rgb(200, 30, 30)));
    /// assert_eq!(picture.pixel(200, 150), Some(Colour::WHITE));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn capture(world: &World, look: &Look, camera: &Camera) -> Self {
        let mut frame = Self::new(camera.size());
        frame.capture_into(world, look, camera);
        frame
    }

    /// The same into this frame, whose memory is used again.
    pub fn capture_into(&mut self, world: &World, look: &Look, camera: &Camera) {
        self.clear(camera.size());
        let size = camera.size().corner();
        let mut sketch = Sketch {
            frame: self,
            look,
            camera,
            unit: (size.min_element() / 600.0).clamp(0.7, 3.0),
        };
        sketch.field();
        sketch.bodies(world);
        sketch.contacts(world);
        sketch.field_label();
        sketch.corners(world);
    }
}

struct Sketch<'a> {
    frame: &'a mut Frame,
    look: &'a Look,
    camera: &'a Camera,
    /// Pixels that one pixel of the overlay's sizes takes.
    unit: f64,
}

impl Sketch<'_> {
    fn bodies(&mut self, world: &World) {
        let view = self.camera.view().grown(REACH / self.camera.scale());
        for body in world.bodies() {
            if view.overlaps(body.aabb()) {
                self.body(&body);
            }
        }
        let overlay = &self.look.overlay;
        if !(overlay.bounds || overlay.centroids || overlay.velocities.is_some()) {
            return;
        }
        for body in world.bodies() {
            self.body_overlay(&body);
        }
    }

    fn body(&mut self, body: &Body<'_>) {
        let mut paint = self.look.paint(body);
        if self.look.overlay.asleep && body.is_asleep() {
            let ground = self.look.style.background.with_alpha(paint.fill.alpha);
            paint.fill = paint.fill.mixed(ground, PALE);
        }
        for (shape, _) in body.shapes() {
            self.shape(body, shape, paint);
        }
    }

    fn shape(&mut self, body: &Body<'_>, shape: &Shape, paint: Paint) {
        let pose = body.pose();
        match shape.outline() {
            Outline::Circle { centre, radius } => {
                let centre = self.camera.point(pose.point(centre));
                self.disc(body, centre, self.camera.length(radius), paint);
            }
            Outline::Open(points) => {
                let points = self.points(pose, points);
                self.frame.push(Op::Line {
                    points,
                    width: 2.5 * self.unit,
                    dash: None,
                    ink: Ink::Of(paint.fill),
                });
            }
            Outline::Closed(points) => {
                let points = self.points(pose, points);
                self.frame.push(Op::Polygon { points, paint });
            }
            Outline::Rings(rings) => {
                let rings = rings.iter().map(|ring| self.points(pose, ring)).collect();
                self.frame.push(Op::Region { rings, paint });
            }
            Outline::HalfPlane { point, normal } => {
                let points = self.behind(pose.point(point), pose.vector(normal));
                self.frame.push(Op::Polygon { points, paint });
            }
            Outline::Parts(parts) => {
                for part in parts {
                    self.shape(body, part, paint);
                }
            }
        }
    }

    /// What the picture can show of the half-plane behind a line: a square whose other sides lie
    /// outside of it.
    fn behind(&self, point: Vec2, normal: Vec2) -> Vec<Vec2> {
        let view = self.camera.view();
        let reach = 2.0 * view.extents().length();
        let height = normal.dot(view.centre() - point);
        // The foot of the picture's centre on the line, or a line of the same look outside of it.
        let foot = view.centre() - normal * height.clamp(-reach, reach);
        let along = vec2(normal.y, -normal.x) * reach;
        let deep = normal * (2.0 * reach);
        [
            foot + along,
            foot - along,
            foot - along - deep,
            foot + along - deep,
        ]
        .map(|p| self.camera.point(p))
        .to_vec()
    }

    fn disc(&mut self, body: &Body<'_>, centre: Vec2, radius: f64, paint: Paint) {
        self.frame.push(Op::Disc {
            centre,
            radius,
            paint,
        });
        let turn = self.camera.turn(body.pose().rotation);
        if let Some(face) = self.look.face(body) {
            self.frame.push(Op::Face {
                centre,
                radius: radius - 0.5,
                turn,
                face: face.clone(),
            });
        } else if self.look.spokes && radius >= SMALLEST_SPOKE {
            self.frame.push(Op::Line {
                points: vec![centre, centre + radius * turn.x_axis()],
                width: 1.25,
                dash: None,
                ink: paint.outline.map_or(Ink::Outline(paint.fill), Ink::Of),
            });
        }
    }

    fn points(&self, pose: Pose, local: &[Vec2]) -> Vec<Vec2> {
        let place = |&p: &Vec2| self.camera.point(pose.point(p));
        local.iter().map(place).collect()
    }

    fn body_overlay(&mut self, body: &Body<'_>) {
        let overlay = &self.look.overlay;
        let bounds = body.aabb();
        if overlay.bounds && bounds.is_finite() {
            let (a, b) = (self.camera.point(bounds.min), self.camera.point(bounds.max));
            self.frame.push(Op::Box {
                min: vec2(a.x, b.y),
                max: vec2(b.x, a.y),
                fill: None,
                border: Some(Ink::Muted),
                width: 1.0,
                dash: Some(4.0 * self.unit),
            });
        }
        if body.kind() == BodyKind::Fixed {
            return;
        }
        let centre = self.camera.point(body.centre());
        if overlay.centroids {
            self.frame.push(Op::Dot {
                centre,
                radius: 2.2 * self.unit,
                ink: Ink::Velocity,
            });
        }
        if let Some(seconds) = overlay.velocities {
            self.frame.push(Op::Arrow {
                from: centre,
                to: centre + self.camera.vector(body.velocity() * seconds),
                width: ARROW * self.unit,
                ink: Ink::Velocity,
            });
        }
    }

    fn contacts(&mut self, world: &World) {
        if !self.look.overlay.contacts {
            return;
        }
        // What lasts, and what was struck during the last step.
        for contact in world.contacts() {
            for point in &contact.points {
                self.contact(point.position, contact.normal);
            }
        }
        for event in world.events() {
            if let EventKind::Impact { point, normal, .. } = event.kind {
                self.contact(point, normal);
            }
        }
    }

    fn contact(&mut self, point: Vec2, normal: Vec2) {
        let at = self.camera.point(point);
        let normal = self.camera.vector(normal).normalize_or_zero();
        self.frame.push(Op::Arrow {
            from: at,
            to: at + normal * NORMAL * self.unit,
            width: 1.5 * self.unit,
            ink: Ink::Contact,
        });
        self.frame.push(Op::Dot {
            centre: at,
            radius: 2.8 * self.unit,
            ink: Ink::Contact,
        });
    }

    fn field(&mut self) {
        if let Some(mark) = &self.look.overlay.field {
            self.frame.push(Op::Ring {
                centre: self.camera.point(mark.centre),
                radius: self.camera.length(mark.radius),
                width: 3.0 * self.unit,
                ink: Ink::Field,
            });
        }
    }

    fn field_label(&mut self) {
        let Some(FieldMark {
            centre,
            radius,
            label,
        }) = &self.look.overlay.field
        else {
            return;
        };
        if !label.is_empty() {
            let above = vec2(0.0, self.camera.length(*radius) + 8.0 * self.unit);
            let at = self.camera.point(*centre) - above;
            let text = Label::new(at, label.clone(), TEXT * self.unit, Ink::Field);
            self.frame.push(text.anchored(0.5, 0.0).with_halo());
        }
    }

    /// Time, gravity, restitution and caption, one in each corner.
    fn corners(&mut self, world: &World) {
        let size = self.camera.size().corner();
        let (edge, height) = (EDGE * self.unit, TEXT * self.unit);
        let overlay = &self.look.overlay;
        let text = |at: Vec2, text: String, x: f64, y: f64| {
            Label::new(at, text, height, Ink::Text)
                .anchored(x, y)
                .with_halo()
        };
        if overlay.time {
            let time = format!("t = {:.2} s", world.time().as_secs());
            self.frame.push(text(vec2(edge, edge), time, 0.0, 1.0));
        }
        if !overlay.caption.is_empty() {
            let caption = overlay.caption.clone();
            self.frame
                .push(text(size - Vec2::splat(edge), caption, 1.0, 0.0));
        }
        let gravity = world.settings().gravity;
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

#[cfg(test)]
#[path = "capture_tests.rs"]
mod tests;
