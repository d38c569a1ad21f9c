//! Plays calls on a world.

use carom_collision::shape_distance;
use carom_dynamics::{
    BodyDef, BodyError, BodyId, BodyKind, Force, Impulse, Material, Mode, PairMaterial,
    RadialField, Settings, World,
};
use carom_geometry::{HalfPlane, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use carom_tests::scenes::{block, disc};

use super::vocabulary::{
    Alteration, Call, Choice, Form, HALF, Nonsense, Piece, Place, Start, Surface,
};

/// What of the calls is meant as it is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Room {
    /// Four walls, no driven bodies, and bodies are put into free places: the walls keep all of them.
    Tidy,
    /// The same, but bodies are put into each other.
    Crammed,
    /// No walls and nothing fixed, but one body that is driven, at a time: two that do not yield crush what comes between.
    Driven,
}

/// A world and all that it was ever told of.
#[derive(Clone, Debug)]
pub(crate) struct Player {
    pub(crate) world: World,
    /// All bodies but the walls, the removed ones too.
    pub(crate) ids: Vec<BodyId>,
    room: Room,
    /// Whether a force waits for the next step.
    pub(crate) pushed: bool,
}

impl Player {
    pub(crate) fn new(mode: Mode, room: Room, start: &Start) -> Self {
        let settings = Settings {
            mode,
            gravity: if start.gravity {
                vec2(0.0, -10.0)
            } else {
                Vec2::ZERO
            },
            sleep: Settings::default().sleep.filter(|_| start.sleeps),
            history: 4096,
            ..Settings::default()
        };
        let mut player = Self {
            world: World::new(settings).expect("valid settings"),
            ids: Vec::new(),
            room,
            pushed: false,
        };
        let sides = [Vec2::Y, -Vec2::Y, Vec2::X, -Vec2::X];
        for outward in sides.into_iter().filter(|_| room != Room::Driven) {
            let wall: Shape = if start.half_planes {
                HalfPlane::new(-outward * HALF, outward)
                    .expect("a wall")
                    .into()
            } else {
                let across = vec2(outward.x.abs(), outward.y.abs());
                let size = 2.0 * (HALF + 1.0) * (Vec2::ONE - across) + across;
                block(size.x, size.y)
                    .translated(-outward * (HALF + 0.5))
                    .into()
            };
            let wall =
                player
                    .world
                    .insert(BodyDef::fixed(), wall, player.loses(start.surface).of(1.0));
            wall.expect("a wall");
        }
        for piece in &start.pieces {
            player.insert(piece).expect("a valid piece");
        }
        player
    }

    /// A surface that takes something of each blow where bodies may be clamped: between two that do not yield, what gives all of it
    /// back is struck ever faster, without end.
    fn loses(&self, surface: Surface) -> Surface {
        let most = if self.room == Room::Tidy { 1.0 } else { 0.9 };
        Surface {
            restitution: surface.restitution.min(most),
            ..surface
        }
    }

    /// What moves a body in this room.
    fn kind(&self, kind: BodyKind) -> BodyKind {
        let driven = |world: &World| {
            world
                .bodies()
                .any(|body| body.kind() == BodyKind::Kinematic)
        };
        match (self.room, kind) {
            (Room::Driven, BodyKind::Kinematic) if !driven(&self.world) => kind,
            (Room::Tidy | Room::Crammed, BodyKind::Fixed) => kind,
            _ => BodyKind::Dynamic,
        }
    }

    /// The body that a number means, if any was ever inserted.
    fn id(&self, number: usize) -> Option<BodyId> {
        let count = self.ids.len();
        (count > 0).then(|| self.ids[number % count])
    }

    /// Plays a call that the world takes, unless it is about a body and there was never any.
    pub(crate) fn play(&mut self, call: &Call) -> Result<(), BodyError> {
        match call {
            Call::Insert(piece) => return self.insert(piece),
            Call::Ask(..) | Call::Refused(_) => return Ok(()),
            Call::AddField(at, strength) => {
                self.world.add_field(RadialField::new(*at, *strength, 1.0)?);
                return Ok(());
            }
            Call::ClearFields => {
                self.world.clear_fields();
                return Ok(());
            }
            Call::SetGravity(gravity) => return self.world.set_gravity(*gravity),
            Call::SetSettings(choice) => {
                self.choose(*choice);
                return Ok(());
            }
            Call::Step(parts, _) => {
                self.pushed &= *parts == 0;
                self.world.step(seconds(*parts));
                return Ok(());
            }
            Call::StepToNextEvent(max) => {
                self.pushed &= *max <= 0.0;
                self.world.step_to_next_event(*max);
                return Ok(());
            }
            _ => {}
        }
        self.change(call)
    }

    fn choose(&mut self, choice: Choice) {
        let (calm, stock) = (Settings::calm(), Settings::default());
        let settings = Settings {
            impact_law: choice.law,
            several: choice.several,
            sleep: stock.sleep.filter(|_| choice.sleeps),
            contact: if choice.calm {
                calm.contact
            } else {
                stock.contact
            },
            history: 4096 + choice.history,
            ..*self.world.settings()
        };
        self.world.set_settings(settings).expect("valid settings");
    }

    /// A call about a body.
    fn change(&mut self, call: &Call) -> Result<(), BodyError> {
        let Some(id) = call.about().and_then(|number| self.id(number)) else {
            return Ok(());
        };
        let tidy = self.room == Room::Tidy;
        let surface = match call {
            Call::SetPairSurface(_, _, surface) => self.loses(*surface).pair(),
            _ => PairMaterial::default(),
        };
        let kind = match call {
            Call::SetKind(_, kind) => self.kind(*kind),
            _ => BodyKind::Dynamic,
        };
        let world = &mut self.world;
        match call {
            Call::Remove(_) => world.remove(id),
            Call::Teleport(_, place) => {
                if tidy && overlaps_another(world, id, Some(place.pose())) {
                    return Ok(());
                }
                world.teleport(id, place.pose())
            }
            Call::SetVelocity(_, velocity, spin) => world.set_velocity(id, *velocity, *spin),
            Call::DriveTo(_, place, dt) => match world.body(id) {
                Some(body) if body.kind() != BodyKind::Kinematic => Ok(()),
                _ => world.drive_to(id, place.pose(), *dt),
            },
            Call::SetKind(..) => world.set_kind(id, kind),
            Call::SetFilter(_, filter) => {
                if tidy && overlaps_another(world, id, None) {
                    return Ok(());
                }
                world.set_filter(id, *filter)
            }
            Call::SetShapeFilter(_, shape, filter) => match world.body(id) {
                Some(body) if *shape >= body.shapes().count() => Ok(()),
                Some(_) if tidy && overlaps_another(world, id, None) => Ok(()),
                _ => world.set_shape_filter(id, *shape, *filter),
            },
            Call::SetPairSurface(_, other, _) => match self.ids[other % self.ids.len()] {
                other if other == id && world.body(id).is_some() => Ok(()),
                other => world.set_pair_material(id, other, surface),
            },
            Call::Alter(_, what) => self.alter(id, what),
            Call::SetDamping(_, damping) => {
                let damping = taken(world, *damping);
                world.set_damping(id, damping, damping)
            }
            Call::Apply(_, arm, push) => {
                let (point, mass) = from_centre(world, id, *arm);
                world.apply(id, Impulse::at(point, *push * mass))
            }
            Call::Push(_, arm, push) => {
                let (point, mass) = from_centre(world, id, *arm);
                self.pushed |= world.body(id).is_some();
                world.apply_force(id, Force::at(point, *push * mass))
            }
            _ => Ok(()),
        }
    }

    fn alter(&mut self, id: BodyId, what: &Alteration) -> Result<(), BodyError> {
        let tidy = self.room == Room::Tidy;
        let surface = |surface: Surface| self.loses(surface).of(1.0);
        let (known, other) = (self.world.body(id), |k: usize| self.ids[k % self.ids.len()]);
        match *what {
            Alteration::Mass(factor) => {
                let Some(body) = known else {
                    return self.world.set_mass(id, 1.0, 1.0);
                };
                let [mass, inertia] = [body.mass(), body.inertia()]
                    .map(|x| if x.is_finite() { x * factor } else { factor });
                self.world.set_mass(id, mass, inertia)
            }
            Alteration::GravityScale(scale) => self.world.set_gravity_scale(id, scale),
            Alteration::LockedRotation(locked) => self.world.set_locked_rotation(id, locked),
            Alteration::Surface(new) => {
                let material = surface(new);
                self.world.set_material(id, 0, material)
            }
            // What passed through another one would lie in it afterwards.
            Alteration::Collides(..) if tidy && known.is_some() => Ok(()),
            Alteration::Collides(k, collides) => match other(k) {
                other if other == id && known.is_some() => Ok(()),
                other => self.world.set_pair_collides(id, other, collides),
            },
            Alteration::Awake => self.world.wake_up(id),
            Alteration::SleepAllowed(allowed) => self.world.set_sleep_allowed(id, allowed),
        }
    }

    fn insert(&mut self, piece: &Piece) -> Result<(), BodyError> {
        let shapes = piece.form.shapes();
        let kind = self.kind(piece.kind);
        if self.room == Room::Tidy && !is_free(&self.world, &shapes, piece.place.pose(), None) {
            return Ok(());
        }
        let still = piece.asleep;
        let damping = taken(&self.world, piece.damping);
        let def = BodyDef {
            kind,
            position: piece.place.at,
            angle: piece.place.angle,
            velocity: if still { Vec2::ZERO } else { piece.velocity },
            spin: if still { 0.0 } else { piece.spin },
            locked_rotation: piece.locked,
            linear_damping: damping,
            angular_damping: damping,
            asleep: piece.asleep,
            filter: piece.filter,
            ..BodyDef::default()
        };
        let material = self.loses(piece.surface).of(piece.density);
        let shapes = shapes.into_iter().map(|shape| (shape, material)).collect();
        self.ids.push(self.world.insert_compound(def, shapes)?);
        Ok(())
    }

    /// What a world must not take: whether it refused it. `None`: there is no body to try it on.
    pub(crate) fn is_refused(&mut self, nonsense: Nonsense) -> Option<bool> {
        use Nonsense::{
            Backwards, Damping, Drive, Impulse as Blow, Never, NoMass, NoShape, Pair, Restitution,
            Shape as Part, Tick, Velocity,
        };
        let nan = vec2(0.0, f64::NAN);
        let never = Pose::at(vec2(f64::INFINITY, 0.0));
        let id = |player: &Self, number| player.id(number);
        Some(match nonsense {
            Velocity(k) => {
                let id = id(self, k)?;
                self.world.set_velocity(id, nan, 0.0).is_err()
            }
            Nonsense::Place(k) => {
                let id = id(self, k)?;
                self.world.teleport(id, never).is_err()
            }
            Blow(k) => {
                let id = id(self, k)?;
                self.world.apply(id, Impulse::central(nan)).is_err()
            }
            Nonsense::Force(k) => {
                let id = id(self, k)?;
                self.world.apply_force(id, Force::torque(f64::NAN)).is_err()
            }
            Damping(k) => {
                let id = id(self, k)?;
                self.world.set_damping(id, -0.1, 0.0).is_err()
            }
            Drive(k) => {
                let id = id(self, k)?;
                self.world.drive_to(id, Pose::IDENTITY, 0.0).is_err()
            }
            Pair(k) => {
                let id = id(self, k)?;
                self.world
                    .set_pair_material(id, id, PairMaterial::default())
                    .is_err()
            }
            Part(k) => {
                let id = id(self, k)?;
                self.world
                    .set_shape_filter(id, 7, carom_dynamics::Filter::default())
                    .is_err()
            }
            Restitution => self.refuses(Material {
                restitution: 1.5,
                ..Material::default()
            }),
            NoShape => self
                .world
                .insert_compound(BodyDef::dynamic(), Vec::new())
                .is_err(),
            NoMass => self.refuses(Material {
                density: 0.0,
                ..Material::default()
            }),
            Backwards => self.world.step(-0.1).refused.is_some(),
            Never => self.world.step_to_next_event(f64::NAN).refused.is_some(),
            Tick => {
                let settings = Settings {
                    tick: 0.02,
                    gravity: Vec2::X,
                    ..*self.world.settings()
                };
                self.world.set_settings(settings).is_err()
            }
        })
    }

    fn refuses(&mut self, material: Material) -> bool {
        let def = BodyDef::dynamic();
        self.world.insert(def, disc(0.5), material).is_err()
    }
}

/// Time is told in parts of 2⁻¹⁶ s.
pub(crate) fn seconds(parts: u32) -> f64 {
    f64::from(parts) / 65_536.0
}

impl Call {
    pub(crate) const fn is_step(&self) -> bool {
        matches!(self, Self::Step(..) | Self::StepToNextEvent(_))
    }

    /// The number of the body that a call is about.
    pub(crate) const fn about(&self) -> Option<usize> {
        match self {
            Self::Remove(id)
            | Self::Teleport(id, _)
            | Self::SetVelocity(id, _, _)
            | Self::DriveTo(id, _, _)
            | Self::SetKind(id, _)
            | Self::SetFilter(id, _)
            | Self::SetShapeFilter(id, _, _)
            | Self::SetPairSurface(id, _, _)
            | Self::SetDamping(id, _)
            | Self::Apply(id, _, _)
            | Self::Push(id, _, _)
            | Self::Alter(id, _) => Some(*id),
            _ => None,
        }
    }
}

impl Place {
    pub(crate) fn pose(self) -> Pose {
        Pose::new(self.at, Rot::from_angle(self.angle))
    }
}

impl Surface {
    const fn of(self, density: f64) -> Material {
        Material {
            density,
            friction: self.friction,
            restitution: self.restitution,
            tangent_speed: self.belt,
        }
    }

    const fn pair(self) -> PairMaterial {
        PairMaterial {
            friction: self.friction,
            restitution: self.restitution,
            tangent_speed: self.belt,
        }
    }
}

/// A point beside a body's centre of mass, and its mass in kg; of what is not there or has none, the origin and 1 kg.
fn from_centre(world: &World, id: BodyId, arm: Vec2) -> (Vec2, f64) {
    let body = world.body(id).filter(|body| body.mass().is_finite());
    body.map_or((Vec2::ZERO, 1.0), |body| (body.centre() + arm, body.mass()))
}

/// Whether shapes at a pose are apart from all bodies but one.
fn is_free(world: &World, shapes: &[Shape], pose: Pose, but: Option<BodyId>) -> bool {
    world
        .bodies()
        .filter(|body| Some(body.id()) != but)
        .all(|body| {
            let seen = body.pose().seen_from(pose);
            body.shapes().all(|(other, _)| {
                shapes
                    .iter()
                    .all(|shape| shape_distance(shape, other, seen).distance > 0.0)
            })
        })
}

/// Whether a body overlaps or touches another one, where it is or would if it were at a pose.
fn overlaps_another(world: &World, id: BodyId, there: Option<Pose>) -> bool {
    let Some(body) = world.body(id) else {
        return false;
    };
    let shapes: Vec<Shape> = body.shapes().map(|(shape, _)| shape.clone()).collect();
    !is_free(world, &shapes, there.unwrap_or(body.pose()), Some(id))
}

/// Damping as the world takes it: stepped mode has none.
fn taken(world: &World, damping: f64) -> f64 {
    if world.settings().mode == Mode::Stepped {
        0.0
    } else {
        damping
    }
}

/// The shape of a form, as one.
pub(crate) fn whole(form: Form) -> Shape {
    form.shapes().swap_remove(0)
}
