//! From a world to marks: what the camera sees at this instant.

use core::convert::Infallible;

use carom_dynamics::{Body, BodyKind, World};
use carom_geometry::{Aabb, Outline, Shape};
use carom_math::{Pose, SimTime, Vec2, vec2};

use crate::overlay::{Groups, Overlaid, unit};
use crate::standing::Resting;
use crate::{Camera, Frame, Ink, Look, Op, Overlay, Paint, RenderError, Source, Trace};

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

    /// The bodies where they were at an instant of the last step, without overlays: for frames between two steps.
    ///
    /// # Errors
    /// [`RenderError::Instant`] if the world does not know where a body was then: before its last change that takes
    /// [`Settings::history`](carom_dynamics::Settings), after the present nothing is known.
    ///
    /// # Examples
    /// ```
    /// use carom_dynamics::{BodyDef, Material, Settings, World};
    /// use carom_geometry::Circle;
    /// use carom_math::{SimTime, vec2};
    /// use carom_render::{Camera, Frame, Look, Op};
    ///
    /// let mut world = World::new(Settings { gravity: vec2(0.0, 0.0), ..Settings::default() })?;
    /// let ball = BodyDef::dynamic().moving(vec2(2.0, 0.0));                                    // m/s
    /// world.insert(ball, Circle::new(0.5)?, Material::default())?;
    /// world.step(0.5);
    /// let camera = Camera::new(vec2(0.0, 0.0), 50.0, 400, 300)?;                               // m, px/m, px
    /// let frame = Frame::capture_at(&world, SimTime::from_secs(0.25), &Look::default(), &camera)?;
    /// let Op::Disc { centre, .. } = &frame.ops()[0] else { unreachable!() };
    /// assert!((centre.x - 225.0).abs() < 1e-9);                                                // half a metre from the middle
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn capture_at(
        world: &World,
        time: SimTime,
        look: &Look,
        camera: &Camera,
    ) -> Result<Self, RenderError> {
        let mut frame = Self::new(camera.size());
        let mut sketch = Sketch::new(&mut frame, world, look, camera);
        sketch.bodies(world, |body| {
            let pose = world.pose_at(body.id(), time);
            pose.ok_or(RenderError::Instant {
                time: time.as_secs(),
            })
        })?;
        Ok(frame)
    }

    /// The same as [`Frame::capture`] with what a trace remembers of the time before: trails, fading flashes, impacts so far.
    #[must_use]
    pub fn capture_traced(world: &World, look: &Look, camera: &Camera, trace: &Trace) -> Self {
        let mut frame = Self::new(camera.size());
        frame.capture_traced_into(world, look, camera, trace);
        frame
    }

    /// The same as [`Frame::capture`] into this frame, reusing its memory: marks of bodies that rest as they did
    /// when this frame last captured them are left as they are.
    pub fn capture_into(&mut self, world: &World, look: &Look, camera: &Camera) {
        let mut trace = Trace::new(&look.overlay);
        if look.overlay.needs_trace() {
            trace.watch(world);
        }
        self.capture_traced_into(world, look, camera, &trace);
    }

    /// The same as [`Frame::capture_traced`] into this frame, reusing its memory: marks of bodies that rest as they
    /// did when this frame last captured them are left as they are.
    pub fn capture_traced_into(
        &mut self,
        world: &World,
        look: &Look,
        camera: &Camera,
        trace: &Trace,
    ) {
        let (mut resting, known) = self.stand(world, look, camera);
        if resting.is_none() {
            self.clear(camera.size());
            Overlaid::new(self, world, look, camera, trace).beneath();
        }
        let mut sketch = Sketch::new(self, world, look, camera);
        let place = |body: &Body<'_>| Ok::<Pose, Infallible>(body.pose());
        let Ok(()) = sketch.layer(world, false, known, resting.as_deref_mut(), place);
        let Ok(()) = sketch.layer(world, true, 0, None, place);
        if let Some(resting) = resting {
            self.set_resting(resting);
        }
        Overlaid::new(self, world, look, camera, trace).above();
    }
}

impl Frame {
    /// Keeps the marks of bodies that rest as they did, and removes all others; returns the bodies kept, and how many.
    /// None is kept where marks lie beneath the bodies, or show contact islands.
    fn stand(
        &mut self,
        world: &World,
        look: &Look,
        camera: &Camera,
    ) -> (Option<Box<Resting>>, usize) {
        let Overlay {
            field,
            field_lines,
            trails,
            groups,
            ..
        } = &look.overlay;
        if field.is_some() || field_lines.is_some() || trails.is_some() || *groups {
            return (None, 0);
        }
        match self.take_resting() {
            Some(mut resting) if resting.suits(look, camera) => {
                let (bodies, marks) = resting.unchanged(world);
                resting.truncate(bodies);
                self.truncate(marks);
                (Some(resting), bodies)
            }
            _ => {
                self.clear(camera.size());
                (Some(Box::new(Resting::new(look, camera))), 0)
            }
        }
    }
}

struct Sketch<'a> {
    frame: &'a mut Frame,
    look: &'a Look,
    camera: &'a Camera,
    /// Pixels that one pixel of the overlay's sizes takes.
    unit: f64,
    /// The body at hand, and where it is.
    source: Source,
    pose: Pose,
    /// Contact islands, if bodies are coloured by them.
    groups: Option<Groups>,
}

impl<'a> Sketch<'a> {
    fn new(frame: &'a mut Frame, world: &World, look: &'a Look, camera: &'a Camera) -> Self {
        Self {
            frame,
            look,
            camera,
            unit: unit(camera),
            source: Source::default(),
            pose: Pose::IDENTITY,
            groups: look.overlay.groups.then(|| Groups::of(world)),
        }
    }

    /// All bodies in view, where `place` says they are.
    fn bodies<E>(
        &mut self,
        world: &World,
        place: impl Fn(&Body<'_>) -> Result<Pose, E>,
    ) -> Result<(), E> {
        self.layer(world, false, 0, None, &place)?;
        self.layer(world, true, 0, None, &place)
    }

    /// The bodies in view that are awake or not, but for the first `known`; `resting` is told of each.
    fn layer<E>(
        &mut self,
        world: &World,
        awake: bool,
        known: usize,
        mut resting: Option<&mut Resting>,
        place: impl Fn(&Body<'_>) -> Result<Pose, E>,
    ) -> Result<(), E> {
        let view = self.camera.view().grown(REACH / self.camera.scale());
        let layer = world.bodies().filter(|body| is_awake(body) == awake);
        for body in layer.skip(known) {
            self.pose = place(&body)?;
            let boxes = body.shapes().map(|(shape, _)| shape.aabb(self.pose));
            if view.overlaps(boxes.fold(Aabb::EMPTY, Aabb::union)) {
                self.source = Source {
                    body: Some(body.id()),
                    awake,
                };
                self.body(&body);
            }
            if let Some(resting) = &mut resting {
                resting.add(&body, self.frame.ops().len());
            }
        }
        Ok(())
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
        let pose = self.pose;
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
            // There is no other at this version.
            _ => {}
        }
    }

    /// What the picture can show of the half-plane behind a line: a square with its other sides
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
        let turn = self.camera.turn(self.pose.rotation);
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

    fn points(&mut self, pose: Pose, local: &[Vec2]) -> Vec<Vec2> {
        let mut points = self.frame.points();
        let camera = self.camera;
        points.extend(local.iter().map(|&p| camera.point(pose.point(p))));
        points
    }
}

/// Whether a body may have moved by the next frame.
pub(crate) fn is_awake(body: &Body<'_>) -> bool {
    body.kind() != BodyKind::Fixed && !body.is_asleep()
}

#[cfg(test)]
#[path = "capture_tests.rs"]
mod tests;
