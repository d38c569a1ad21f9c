//! A world of a reference case: built, stepped, read. No mechanics here.

use carom_dynamics::{
    Body, BodyDef, BodyId, ContactMode, EventKind, ImpactLaw, Material, Mode, Settings, World,
};
use carom_math::{Rot, SimTime, Vec2, vec2};

use super::book::Outputs;
use super::outline::Outline;
use super::symmetry::Symmetry;
use crate::random::SplitMix;

/// More impacts than this and a case is given up.
const MOST_IMPACTS: usize = 40_000_000;

/// What a step is asked for at most, in s: a world takes 1e7 ticks of 1/60 s at once.
const LONGEST: f64 = 1e5;

/// A case that a world answers.
pub(super) trait Play {
    /// The bodies at the start, and the laws for them.
    fn cast(&self) -> &Cast;

    /// Steps the world, reads it, and answers by the reference's keys.
    fn play(&self, stage: &mut Stage) -> Result<Outputs, String>;
}

/// The bodies of a case at the start, and the laws for them.
#[derive(Clone, Debug)]
pub(super) struct Cast {
    pub(super) gravity: Vec2,
    pub(super) material: Material,
    pub(super) law: ImpactLaw,
    pub(super) players: Vec<Player>,
}

/// A body as a case gives it.
#[derive(Clone, Debug)]
pub(super) struct Player {
    pub(super) outline: Outline,
    pub(super) fixed: bool,
    /// In kg; `None`: by density.
    pub(super) mass: Option<f64>,
    /// In kg·m²; `None`: by density.
    pub(super) inertia: Option<f64>,
    /// In the body's frame, in m; `None`: by density.
    pub(super) centre: Option<Vec2>,
    /// `None`: that of all.
    pub(super) friction: Option<f64>,
    /// In kg/m².
    pub(super) density: f64,
    pub(super) position: Vec2,
    /// In rad.
    pub(super) angle: f64,
    pub(super) velocity: Vec2,
    pub(super) spin: f64,
}

/// An impact, in the case's own guise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Struck {
    /// In s.
    pub(super) time: f64,
    /// The lower index first.
    pub(super) pair: (usize, usize),
    pub(super) point: Vec2,
    /// To the higher index.
    pub(super) normal: Vec2,
    /// On the higher index, in N·s.
    pub(super) normal_impulse: f64,
    /// Along the normal turned by +90 degrees.
    pub(super) tangential_impulse: f64,
}

/// A lasting contact that began to move in another way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    /// In s.
    pub(super) time: f64,
    /// The lower index first.
    pub(super) pair: (usize, usize),
    pub(super) mode: ContactMode,
}

/// A world in some guise, read in the case's own.
#[derive(Debug)]
pub(super) struct Stage {
    world: World,
    ids: Vec<BodyId>,
    symmetry: Symmetry,
    /// Cuts steps at random where the case is in a guise.
    cuts: Option<SplitMix>,
    /// Impacts not taken out yet.
    pub(super) impacts: Vec<Struck>,
    /// Modes of lasting contacts, as they began.
    pub(super) modes: Vec<Moved>,
    /// All impacts so far.
    pub(super) struck: usize,
    /// When infinitely many impacts last came to their end, in s.
    pub(super) accumulated: Option<f64>,
}

impl Player {
    /// A disc of 1 kg at rest, without spin.
    pub(super) fn disc(radius: f64, position: Vec2) -> Self {
        Self {
            outline: Outline::Circle(radius),
            fixed: false,
            mass: Some(1.0),
            inertia: None,
            centre: None,
            friction: None,
            density: 1.0,
            position,
            angle: 0.0,
            velocity: Vec2::ZERO,
            spin: 0.0,
        }
    }

    /// A block of 1 kg at rest.
    pub(super) fn block(low: Vec2, high: Vec2) -> Self {
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let corners = [-half, vec2(half.x, -half.y), half, vec2(-half.x, half.y)];
        Self {
            outline: Outline::Polygon(corners.to_vec()),
            ..Self::disc(1.0, middle)
        }
    }

    /// A block that nothing moves.
    pub(super) fn wall(low: Vec2, high: Vec2) -> Self {
        Self {
            fixed: true,
            mass: None,
            ..Self::block(low, high)
        }
    }

    /// All below y = 0.
    pub(super) fn floor() -> Self {
        Self {
            outline: Outline::Behind(Vec2::Y),
            fixed: true,
            mass: None,
            ..Self::disc(1.0, Vec2::ZERO)
        }
    }

    /// Four walls around a box, 1 m thick: left, right, floor, ceiling.
    pub(super) fn walls(low: Vec2, high: Vec2) -> [Self; 4] {
        let (a, b) = (low - Vec2::ONE, high + Vec2::ONE);
        [
            Self::wall(a, vec2(low.x, b.y)),
            Self::wall(vec2(high.x, a.y), b),
            Self::wall(a, vec2(b.x, low.y)),
            Self::wall(vec2(a.x, high.y), b),
        ]
    }

    fn transformed(&self, symmetry: &Symmetry) -> Self {
        let mut outline = self.outline.clone();
        outline.transform(symmetry);
        Self {
            outline,
            position: symmetry.point(self.position),
            angle: symmetry.turning(self.angle),
            velocity: symmetry.vector(self.velocity),
            centre: self.centre.map(|centre| symmetry.vector(centre)),
            spin: symmetry.turning(self.spin),
            ..self.clone()
        }
    }

    fn def(&self) -> BodyDef {
        let def = if self.fixed {
            BodyDef::fixed()
        } else {
            BodyDef::dynamic()
        };
        let def = def
            .at(self.position)
            .turned(self.angle)
            .moving(self.velocity)
            .spinning(self.spin);
        let def = self.mass.map_or(def, |mass| def.with_mass(mass));
        let def = self.centre.map_or(def, |centre| def.with_centre(centre));
        self.inertia
            .map_or(def, |inertia| def.with_inertia(inertia))
    }
}

impl Cast {
    /// All bodies of one material; single impacts follow the default law.
    pub(super) fn of(gravity: Vec2, restitution: f64, friction: f64, players: Vec<Player>) -> Self {
        Self {
            gravity,
            material: Material {
                restitution,
                friction,
                ..Material::default()
            },
            law: ImpactLaw::default(),
            players,
        }
    }

    /// Positions of all bodies, for the choice of a shift that stays exact.
    pub(super) fn places(&self) -> Vec<Vec2> {
        self.players.iter().map(|player| player.position).collect()
    }

    /// Raises the curtain, in a guise if one is given.
    pub(super) fn enter(
        &self,
        symmetry: &Symmetry,
        guised: bool,
        mode: Mode,
    ) -> Result<Stage, String> {
        let mut world = World::new(Settings {
            gravity: symmetry.vector(self.gravity),
            mode,
            impact_law: self.law,
            sleep: None,
            ..Settings::default()
        })
        .map_err(|error| error.to_string())?;
        let mut order: Vec<usize> = (0..self.players.len()).collect();
        if !symmetry.label.is_multiple_of(2) {
            order.reverse();
        }
        let mut ids = vec![None; order.len()];
        for index in order {
            let player = self.players[index].transformed(symmetry);
            let material = Material {
                density: player.density,
                friction: player.friction.unwrap_or(self.material.friction),
                ..self.material
            };
            let id = world.insert(player.def(), player.outline.built()?, material);
            ids[index] = Some(id.map_err(|error| format!("body {index}: {error}"))?);
        }
        Ok(Stage {
            world,
            ids: ids.into_iter().flatten().collect(),
            symmetry: *symmetry,
            cuts: guised.then(|| SplitMix::new(symmetry.label)),
            impacts: Vec::new(),
            modes: Vec::new(),
            struck: 0,
            accumulated: None,
        })
    }
}

impl Stage {
    /// Goes on to an instant, in s since the start.
    pub(super) fn until(&mut self, time: f64) -> Result<(), String> {
        let end = SimTime::from_secs(time);
        while self.advance(end)? {}
        Ok(())
    }

    /// Goes on to the instant of the next impact; `false` if there is none up to `latest`.
    pub(super) fn next_impact(&mut self, latest: f64) -> Result<bool, String> {
        let (end, seen) = (SimTime::from_secs(latest), self.struck);
        while self.struck == seen {
            if !self.advance(end)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Goes on to the instant at which a contact begins to move in one of these ways, in s; `None` if it
    /// does not up to `latest`.
    pub(super) fn until_mode(
        &mut self,
        pair: (usize, usize),
        wanted: &[ContactMode],
        latest: f64,
    ) -> Result<Option<f64>, String> {
        let end = SimTime::from_secs(latest);
        loop {
            let mut begun = self.modes.iter();
            if let Some(moved) = begun.find(|m| m.pair == pair && wanted.contains(&m.mode)) {
                return Ok(Some(moved.time));
            }
            if !self.advance(end)? {
                return Ok(None);
            }
        }
    }

    /// How a contact moves now, if it lasts.
    pub(super) fn mode(&self, pair: (usize, usize)) -> Option<ContactMode> {
        let of_pair = self.modes.iter().rev().find(|moved| moved.pair == pair);
        of_pair.map(|moved| moved.mode)
    }

    /// To the next event, the next cut or the end, whichever is first; `false` at the end.
    fn advance(&mut self, end: SimTime) -> Result<bool, String> {
        let left = end - self.world.time();
        if left <= 0.0 {
            return Ok(false);
        }
        let step = match &mut self.cuts {
            // The later, the farther apart: long waits have few cuts.
            Some(random) => left.min(random.unit() * (0.5 + 0.5 * self.world.time().as_secs())),
            None => left,
        }
        .min(LONGEST);
        let report = self.world.step_to_next_event(step);
        if let Some(refusal) = report.refused {
            return Err(refusal.to_string());
        }
        if self.world.events().dropped() > 0 {
            return Err("more events than a step can hold".to_owned());
        }
        for event in self.world.events() {
            match event.kind {
                EventKind::Impact {
                    a,
                    b,
                    point,
                    normal,
                    normal_impulse,
                    tangential_impulse,
                    ..
                } => {
                    let (a, b) = (self.index(a), self.index(b));
                    self.struck += 1;
                    let towards = self.symmetry.vector_back(normal);
                    self.impacts.push(Struck {
                        time: event.time.as_secs(),
                        pair: (a.min(b), a.max(b)),
                        point: self.symmetry.point_back(point),
                        normal: if a < b { towards } else { -towards },
                        normal_impulse,
                        tangential_impulse: self.symmetry.turning(tangential_impulse),
                    });
                }
                EventKind::Mode { a, b, mode } => {
                    let (a, b) = (self.index(a), self.index(b));
                    self.modes.push(Moved {
                        time: event.time.as_secs(),
                        pair: (a.min(b), a.max(b)),
                        mode,
                    });
                }
                EventKind::Collapse { .. } => {
                    self.accumulated = Some(event.time.as_secs());
                }
                _ => {}
            }
        }
        if self.struck > MOST_IMPACTS {
            return Err(format!("more than {MOST_IMPACTS} impacts"));
        }
        Ok(true)
    }

    fn index(&self, id: BodyId) -> usize {
        let found = self.ids.iter().position(|known| *known == id);
        found.expect("every body of the world is one of the case's")
    }

    fn body(&self, index: usize) -> Body<'_> {
        self.world.body(self.ids[index]).expect("never removed")
    }

    /// Centre of mass, in m.
    pub(super) fn centre(&self, index: usize) -> Vec2 {
        self.symmetry.point_back(self.body(index).centre())
    }

    /// Origin of the body's frame, in m.
    pub(super) fn position(&self, index: usize) -> Vec2 {
        self.symmetry.point_back(self.body(index).pose().position)
    }

    /// In m/s.
    pub(super) fn velocity(&self, index: usize) -> Vec2 {
        self.symmetry.vector_back(self.body(index).velocity())
    }

    /// In rad/s.
    pub(super) fn spin(&self, index: usize) -> f64 {
        self.symmetry.turning(self.body(index).angular_velocity())
    }

    /// Total angle, in rad.
    pub(super) fn angle(&self, index: usize) -> f64 {
        self.symmetry.turning(self.body(index).angle())
    }

    /// Cosine and sine of the angle.
    pub(super) fn rotation(&self, index: usize) -> Rot {
        let rotation = self.body(index).pose().rotation;
        if self.symmetry.mirrored {
            rotation.inverse()
        } else {
            rotation
        }
    }

    /// Kinetic and potential energy, in J.
    pub(super) fn energy(&self) -> f64 {
        self.world.energy().mechanical()
    }

    /// What friction has turned into heat, in J.
    pub(super) fn friction_heat(&self) -> f64 {
        self.world.energy().friction
    }

    /// The highest point of a centre's present flight, by bisection of its vertical velocity; `None` if it never turns.
    pub(super) fn apex(&self, index: usize) -> Option<Vec2> {
        let motion = self.body(index).motion();
        let now = self.world.time();
        let rises = |after: f64| {
            let velocity = motion.velocity_at(now + after);
            self.symmetry.vector_back(velocity).y > 0.0
        };
        let (mut low, mut high) = (0.0, 1.0);
        while rises(high) {
            high *= 2.0;
            if high > 1e6 {
                return None;
            }
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if rises(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(self.symmetry.point_back(motion.centre_at(now + low)))
    }
}
