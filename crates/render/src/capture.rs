//! From a world to marks: what the camera sees at this instant.

use carom_dynamics::{Body, BodyKind, World};
use carom_geometry::{Outline, Shape};
use carom_math::{Pose, Vec2, vec2};

use crate::overlay::{Groups, Overlaid, unit};
use crate::{Camera, Frame, Ink, Look, Op, Paint, Source, Trace};

/// Pixels that a mark reaches beyond its body's box: half an outline and some.
const REACH: f64 = 4.0;
/// Discs smaller than this, in pixels, have no spoke.
const SMALLEST_SPOKE: f64 = 3.0;
/// How much paler a body asleep is.
const PALE: f64 = 0.45;

impl Frame {
    /// The world at its present time, as `camera` sees it and `look` shows it.
    ///
    /// Bodies outside the picture are left out. What is fixed or asleep lies below what moves: it can be painted once
    /// and kept ([`Painter`](crate::Painter)). The world is only read.
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

    /// The same with what a trace remembers of the time before: trails, fading flashes, impacts so far.
    #[must_use]
    pub fn capture_traced(world: &World, look: &Look, camera: &Camera, trace: &Trace) -> Self {
        let mut frame = Self::new(camera.size());
        frame.capture_traced_into(world, look, camera, trace);
        frame
    }

    /// The same as [`Frame::capture`] into this frame, whose memory is used again.
    pub fn capture_into(&mut self, world: &World, look: &Look, camera: &Camera) {
        let mut trace = Trace::new(&look.overlay);
        if look.overlay.needs_trace() {
            trace.watch(world);
        }
        self.capture_traced_into(world, look, camera, &trace);
    }

    /// The same as [`Frame::capture_traced`] into this frame, whose memory is used again.
    pub fn capture_traced_into(
        &mut self,
        world: &World,
        look: &Look,
        camera: &Camera,
        trace: &Trace,
    ) {
        self.clear(camera.size());
        Overlaid::new(self, world, look, camera, trace).beneath();
        let mut sketch = Sketch {
            frame: self,
            look,
            camera,
            unit: unit(camera),
            source: Source::default(),
            groups: look.overlay.groups.then(|| Groups::of(world)),
        };
        sketch.bodies(world);
        Overlaid::new(self, world, look, camera, trace).above();
    }
}

struct Sketch<'a> {
    frame: &'a mut Frame,
    look: &'a Look,
    camera: &'a Camera,
    /// Pixels that one pixel of the overlay's sizes takes.
    unit: f64,
    /// The body at hand.
    source: Source,
    /// Who touches whom, if bodies are coloured by it.
    groups: Option<Groups>,
}

impl Sketch<'_> {
    fn bodies(&mut self, world: &World) {
        let view = self.camera.view().grown(REACH / self.camera.scale());
        for awake in [false, true] {
            let layer = world.bodies().filter(|body| is_awake(body) == awake);
            for body in layer {
                if view.overlaps(body.aabb()) {
                    self.source = Source {
                        body: Some(body.id()),
                        awake,
                    };
                    self.body(&body);
                }
            }
        }
    }

    fn body(&mut self, body: &Body<'_>) {
        let mut paint = self.look.paint(body);
        if let (Some(groups), BodyKind::Dynamic) = (&self.groups, body.kind()) {
            paint.fill = groups.colour(body.id(), paint.fill, &self.look.style);
        }
        paint.fill = self.look.style.body(paint.fill);
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
                self.frame.push_from(
                    self.source,
                    Op::Line {
                        points,
                        width: 2.5 * self.unit,
                        dash: None,
                        ink: Ink::Of(paint.fill),
                    },
                );
            }
            Outline::Closed(points) => {
                let points = self.points(pose, points);
                self.frame
                    .push_from(self.source, Op::Polygon { points, paint });
            }
            Outline::Rings(rings) => {
                let rings = rings.iter().map(|ring| self.points(pose, ring)).collect();
                self.frame
                    .push_from(self.source, Op::Region { rings, paint });
            }
            Outline::HalfPlane { point, normal } => {
                let points = self.behind(pose.point(point), pose.vector(normal));
                self.frame
                    .push_from(self.source, Op::Polygon { points, paint });
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
        self.frame.push_from(
            self.source,
            Op::Disc {
                centre,
                radius,
                paint,
            },
        );
        let turn = self.camera.turn(body.pose().rotation);
        if let Some(face) = self.look.face(body) {
            self.frame.push_from(
                self.source,
                Op::Face {
                    centre,
                    radius: radius - 0.5,
                    turn,
                    face: face.clone(),
                },
            );
        } else if self.look.spokes && radius >= SMALLEST_SPOKE {
            self.frame.push_from(
                self.source,
                Op::Line {
                    points: vec![centre, centre + radius * turn.x_axis()],
                    width: 1.25,
                    dash: None,
                    ink: paint.outline.map_or(Ink::Outline(paint.fill), Ink::Of),
                },
            );
        }
    }

    fn points(&self, pose: Pose, local: &[Vec2]) -> Vec<Vec2> {
        let place = |&p: &Vec2| self.camera.point(pose.point(p));
        local.iter().map(place).collect()
    }
}

/// Whether a body may have moved by the next frame.
fn is_awake(body: &Body<'_>) -> bool {
    body.kind() != BodyKind::Fixed && !body.is_asleep()
}

#[cfg(test)]
#[path = "capture_tests.rs"]
mod tests;
