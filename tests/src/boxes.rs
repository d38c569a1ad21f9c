//! Random closed boxes: bodies of 3 mm to 2 m are thrown about between walls without a gap, and no centre may leave.
//!
//! Where centres are is all that is checked, so the check shares nothing with the library. It finds what went through a wall, by
//! whatever way; overlaps are for [`checks`](crate::checks).
//!
//! Some kinds still lose bodies, though none in a run that was called exact:
//!
//! - slivers on a zigzag, which stand on end between two segments that meet,
//! - `--plates`, where others press them through a wall,
//! - `--changes`, where the caller makes a body fixed that is pressed half through one,
//! - `--paddles`, which squeeze bodies through any wall.
//!
//! ```sh
//! cargo run --release -p carom-tests --example boxes -- --walls zigzag --count 1000
//! ```

use core::fmt;

use carom_dynamics::{BodyDef, BodyId, BodyKind, Material, Mode, Settings, StepReport, World};
use carom_geometry::{HalfPlane, Segment, Shape};
use carom_math::{Pose, SimTime, Vec2, vec2};

use crate::checks::Standing;
use crate::draw::{self, Dice};
use crate::scenes::{block, put, surface};

/// Half a side of the box, which lies about the origin, in m.
const HALF: f64 = 3.0;

/// Thickness of blocks as walls, in m: less than a body at 40 m/s moves in a step.
const THIN: f64 = 0.1;

/// Width and height of a tooth of the zigzag, in m: six of them from wall to wall.
const TOOTH: Vec2 = vec2(1.0, 0.15);

/// A centre this far outside has left, in m. Below some mm overlaps of piles would count, above [`THIN`] a block would hide it.
const OUT: f64 = 0.02;

/// Bodies are thicker than this, in m, but for slivers: those fall through valleys of a zigzag too often to tell of anything else.
const THINNEST: f64 = 1e-4;

/// Steps of a run.
const STEPS: usize = 240;

/// What a box is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walls {
    /// Four segments without thickness.
    Segments,
    /// Four blocks.
    Blocks,
    /// Four half-planes.
    HalfPlanes,
    /// Segments, those of the floor up and down.
    Zigzag,
}

impl Walls {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Segments, Self::Blocks, Self::HalfPlanes, Self::Zigzag];
}

/// What else is in a box, or happens there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extra {
    /// All bodies are plates of 1 to 20 mm.
    Plates,
    /// Bodies down to some µm thin as well.
    Slivers,
    /// The caller throws, stops, removes, makes fixed and lets go, between steps and within sub-steps.
    Changes,
    /// Two driven paddles that turn.
    Paddles,
    /// 40 m/s instead of 6.
    Fast,
    /// All give back everything, and there is no friction.
    Elastic,
    /// No gravity.
    Weightless,
    /// Steps of 0.1 to 50 ms.
    Uneven,
}

impl Extra {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Plates,
        Self::Slivers,
        Self::Changes,
        Self::Paddles,
        Self::Fast,
        Self::Elastic,
        Self::Weightless,
        Self::Uneven,
    ];
}

/// A kind of box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind<'a> {
    /// What it is made of.
    pub walls: Walls,
    /// What else there is.
    pub extras: &'a [Extra],
}

impl Kind<'_> {
    fn has(self, extra: Extra) -> bool {
        self.extras.contains(&extra)
    }

    /// Most of each coordinate of a velocity, in m/s.
    fn speed(self) -> f64 {
        if self.has(Extra::Fast) { 40.0 } else { 6.0 }
    }

    /// How low a centre may be there, in m.
    fn floor(self, x: f64) -> f64 {
        if self.walls != Walls::Zigzag {
            return -HALF;
        }
        // 0 where a tooth begins, 1 at its tip, 0 where it ends.
        let part = ((x + HALF) / TOOTH.x).rem_euclid(1.0);
        TOOTH.y * (1.0 - (2.0 * part - 1.0).abs()) - HALF
    }

    fn keeps(self, at: Vec2) -> bool {
        at.x.abs() < HALF + OUT && at.y < HALF + OUT && at.y > self.floor(at.x) - OUT
    }
}

/// What the caller does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Takes a body out.
    Remove(BodyId),
    /// Gives it a velocity and a spin.
    Throw(BodyId, Vec2, f64),
    /// Makes it fixed, or dynamic again.
    Make(BodyId, BodyKind),
    /// Steps by that many seconds, so that what follows is within a sub-step.
    Wait(f64),
}

/// A body that left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Escape {
    /// Its name.
    pub body: BodyId,
    /// Where its centre is.
    pub at: Vec2,
    /// When it was seen there.
    pub time: SimTime,
    /// Whether all reports until then called their steps exact.
    pub exact: bool,
    /// Deepest overlap that they told, in m.
    pub deepest_overlap: f64,
}

impl fmt::Display for Escape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} is at {} after {:.3} s, exact: {}, deepest overlap told {:.1e} m",
            self.body,
            self.at,
            self.time.as_secs(),
            self.exact,
            self.deepest_overlap
        )
    }
}

/// The start of a run, or a step that is over.
#[derive(Debug)]
pub struct Seen<'a> {
    /// What the caller did before the step.
    pub change: Option<Change>,
    /// What both reported.
    pub report: StepReport,
    /// The world after it.
    pub world: &'a World,
    /// Bodies that were thrown in and not removed.
    pub inside: &'a [BodyId],
}

/// Plays a run, and returns what all its steps reported.
///
/// # Errors
/// The first body that left.
///
/// # Panics
/// If the world refuses a body, a change or a step.
pub fn play(mode: Mode, kind: Kind<'_>, seed: u64) -> Result<StepReport, Escape> {
    watch(mode, kind, seed, |_| {})
}

/// As [`play`]; `look` sees the start and each step.
///
/// # Errors
/// The first body that left.
///
/// # Panics
/// If the world refuses a body, a change or a step.
pub fn watch(
    mode: Mode,
    kind: Kind<'_>,
    seed: u64,
    mut look: impl FnMut(&Seen<'_>),
) -> Result<StepReport, Escape> {
    let mut run = Run::new(mode, kind, seed);
    look(&run.seen(None, StepReport::default()));
    let mut sum = StepReport::default();
    for _ in 0..STEPS {
        let (change, report) = run.step();
        look(&run.seen(change, report));
        sum += report;
        if let Some((body, at)) = run.outside() {
            return Err(Escape {
                body,
                at,
                time: run.world.time(),
                exact: sum.is_exact(),
                deepest_overlap: sum.deepest_overlap,
            });
        }
    }
    Ok(sum)
}

struct Run<'a> {
    kind: Kind<'a>,
    dice: Dice,
    world: World,
    inside: Vec<BodyId>,
    standing: Standing,
}

impl<'a> Run<'a> {
    fn new(mode: Mode, kind: Kind<'a>, seed: u64) -> Self {
        let falls = !kind.has(Extra::Weightless);
        let settings = Settings {
            mode,
            gravity: if falls { vec2(0.0, -10.0) } else { Vec2::ZERO },
            ..Settings::default()
        };
        let mut run = Self {
            kind,
            dice: Dice::new(seed),
            world: World::new(settings).expect("valid settings"),
            inside: Vec::new(),
            standing: Standing::default(),
        };
        run.close();
        run.fill();
        run
    }

    /// Walls, and paddles of their surface.
    fn close(&mut self) {
        let (kind, dice) = (self.kind, &mut self.dice);
        let material = if kind.has(Extra::Elastic) {
            crate::elastic()
        } else {
            surface(dice.between(0.0, 0.6), dice.between(0.0, 1.0))
        };
        for wall in walls(kind.walls) {
            put(&mut self.world, BodyDef::fixed(), wall, material);
        }
        if kind.has(Extra::Paddles) {
            for x in [-1.5, 1.5] {
                let paddle = BodyDef::kinematic().at(vec2(x, -1.4));
                let paddle = paddle.spinning(dice.between(-8.0, 8.0));
                put(&mut self.world, paddle, block(2.4, 0.1), material);
            }
        }
    }

    fn fill(&mut self) {
        let count = 2 + self.dice.below(14);
        for k in 0..count {
            let shape = self.shape();
            let (place, speed) = (self.place(k), self.kind.speed());
            let def = place
                .moving(self.dice.inside(speed))
                .spinning(self.dice.between(-2.0, 2.0) * speed);
            let material = self.material();
            self.inside.push(put(&mut self.world, def, shape, material));
        }
    }

    fn shape(&mut self) -> Shape {
        let dice = &mut self.dice;
        if self.kind.has(Extra::Plates) {
            return block(dice.between(0.3, 2.0), dice.log(1e-3, 2e-2)).into();
        }
        let reach = dice.log(1.5e-3, 0.4);
        loop {
            let shape = draw::shape(dice, reach);
            let thickness = shape.aabb(Pose::IDENTITY).extents().min_element();
            if thickness > THINNEST || self.kind.has(Extra::Slivers) {
                return shape;
            }
        }
    }

    /// Where the body of that number begins: above the middle, in no other's way.
    fn place(&mut self, k: usize) -> BodyDef {
        let (dice, def) = (&mut self.dice, BodyDef::dynamic());
        if self.kind.has(Extra::Plates) {
            let at = vec2(dice.between(-1.0, 1.0), 0.1 + 0.19 * k as f64);
            def.at(at).turned(dice.between(-0.08, 0.08))
        } else {
            let at = vec2(1.1 * (k % 5) as f64 - 2.2, 0.9 * (k / 5) as f64);
            def.at(at).turned(dice.between(-3.0, 3.0))
        }
    }

    fn material(&mut self) -> Material {
        let dice = &mut self.dice;
        if self.kind.has(Extra::Elastic) {
            return crate::elastic();
        }
        let restitution = [0.0, dice.between(0.0, 1.0)][dice.below(2)];
        surface(restitution, dice.between(0.0, 1.2))
    }

    fn seen(&self, change: Option<Change>, report: StepReport) -> Seen<'_> {
        Seen {
            change,
            report,
            world: &self.world,
            inside: &self.inside,
        }
    }

    /// What the caller did, and what that and a step reported.
    fn step(&mut self) -> (Option<Change>, StepReport) {
        let changes =
            self.kind.has(Extra::Changes) && !self.inside.is_empty() && self.dice.chance(0.2);
        let change = changes.then(|| self.draw_change());
        let mut report = change.map_or_else(StepReport::default, |change| self.make(change));
        let dt = if self.kind.has(Extra::Uneven) {
            self.dice.log(1e-4, 0.05)
        } else {
            1.0 / 60.0
        };
        let step = self.world.step(dt);
        assert_eq!(step.refused, None);
        let goes_on = self.standing.after(&self.world, &step);
        goes_on.expect("time goes on");
        report += step;
        (change, report)
    }

    fn draw_change(&mut self) -> Change {
        let dice = &mut self.dice;
        let id = self.inside[dice.below(self.inside.len())];
        let speed = self.kind.speed() * dice.between(0.0, 2.5);
        match dice.below(7) {
            0 => Change::Remove(id),
            1 | 2 => Change::Throw(id, dice.inside(speed), dice.between(-speed, speed)),
            3 => Change::Throw(id, Vec2::ZERO, 0.0),
            4 => Change::Make(id, BodyKind::Fixed),
            5 => Change::Make(id, BodyKind::Dynamic),
            _ => Change::Wait(dice.between(0.0, 1.0 / 60.0)),
        }
    }

    /// Makes a change; the report of the step in it.
    fn make(&mut self, change: Change) -> StepReport {
        let world = &mut self.world;
        let done = match change {
            Change::Wait(seconds) => return world.step(seconds),
            Change::Remove(id) => {
                self.inside.retain(|known| *known != id);
                world.remove(id)
            }
            Change::Throw(id, velocity, spin) => world.set_velocity(id, velocity, spin),
            Change::Make(id, kind) => world.set_kind(id, kind),
        };
        done.expect("a body that is there");
        StepReport::default()
    }

    /// A body that left, and where its centre is.
    fn outside(&self) -> Option<(BodyId, Vec2)> {
        let bodies = self.inside.iter().filter_map(|id| self.world.body(*id));
        let mut places = bodies.map(|body| (body.id(), body.centre()));
        places.find(|(_, at)| !self.kind.keeps(*at))
    }
}

/// The box.
fn walls(walls: Walls) -> Vec<Shape> {
    let outwards = [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y];
    match walls {
        Walls::Segments => ring(&[vec2(-HALF, -HALF), vec2(HALF, -HALF)]),
        Walls::Zigzag => {
            let corner = |k: u32| vec2(0.5 * TOOTH.x * f64::from(k), TOOTH.y * f64::from(k % 2));
            let floor: Vec<Vec2> = (0..=12).map(|k| corner(k) - Vec2::splat(HALF)).collect();
            ring(&floor)
        }
        Walls::Blocks => outwards.map(|out| draw::wall(out, HALF, 0.5 * THIN)).into(),
        Walls::HalfPlanes => {
            let plane = |out: Vec2| HalfPlane::new(out * HALF, -out).expect("a wall").into();
            outwards.map(plane).into()
        }
    }
}

/// Segments along a floor and round the box.
fn ring(floor: &[Vec2]) -> Vec<Shape> {
    let corners = [floor, &[vec2(HALF, HALF), vec2(-HALF, HALF)]].concat();
    let ends = corners.iter().cycle().skip(1);
    let walls = corners.iter().zip(ends);
    walls
        .map(|(from, to)| Segment::new(*from, *to).expect("a wall").into())
        .collect()
}
