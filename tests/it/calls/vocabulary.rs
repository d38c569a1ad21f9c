//! What a caller says to a world, and how it is drawn.
//!
//! All within ordinary ranges: bodies of 0.2 to 2 m, densities from 1 to 20 kg/m², velocities given of up to 14 m/s and
//! 10 rad/s, steps of up to a quarter of a second, most of which end within a sub-step.

use carom_dynamics::{BodyKind, Filter, ImpactLaw, Several};
use carom_geometry::{Compound, Polygon, Shape};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::scenes::{block, disc};
use proptest::prelude::*;

/// Half of the side of the container, in m.
pub(crate) const HALF: f64 = 4.0;

/// What a world is told at its start.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    pub(crate) gravity: bool,
    pub(crate) sleeps: bool,
    /// Whether the walls are four half-planes, or four blocks as thick as a body.
    pub(crate) half_planes: bool,
    pub(crate) surface: Surface,
    pub(crate) pieces: Vec<Piece>,
}

/// A body before it is inserted.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) form: Form,
    pub(crate) kind: BodyKind,
    pub(crate) place: Place,
    pub(crate) velocity: Vec2,
    pub(crate) spin: f64,
    pub(crate) density: f64,
    pub(crate) surface: Surface,
    pub(crate) locked: bool,
    pub(crate) asleep: bool,
    /// In 1/s; stepped mode refuses it.
    pub(crate) damping: f64,
    pub(crate) filter: Filter,
}

/// Where a body is put.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) at: Vec2,
    pub(crate) angle: f64,
}

/// How a surface rubs, bounces and runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    pub(crate) friction: f64,
    pub(crate) restitution: f64,
    pub(crate) belt: f64,
}

/// The outline of a body; sizes in m.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    Disc(f64),
    Block(f64, f64),
    Star(f64),
    /// An L of two blocks that are one shape.
    Angle(f64),
    /// Two discs that are two shapes.
    Dumbbell(f64),
}

impl Form {
    pub(crate) fn shapes(self) -> Vec<Shape> {
        match self {
            Self::Disc(radius) => vec![disc(radius).into()],
            Self::Block(width, height) => vec![block(width, height).into()],
            Self::Star(size) => {
                vec![Polygon::star(5, size, 0.5 * size).expect("a star").into()]
            }
            Self::Angle(size) => {
                let leg = |w, h, at| (block(w * size, h * size).into(), Pose::at(at * size));
                let legs = [
                    leg(1.0, 0.3, vec2(0.5, 0.15)),
                    leg(0.3, 0.7, vec2(0.15, 0.65)),
                ];
                vec![Compound::new(legs).expect("an L").into()]
            }
            Self::Dumbbell(size) => {
                let end = |x: f64| disc(0.4 * size).translated(vec2(x * size, 0.0)).into();
                vec![end(-0.5), end(0.5)]
            }
        }
    }
}

/// A call of the public interface. Bodies are meant by their number among all that were ever inserted, so that some of them
/// are gone.
#[derive(Clone, Debug)]
pub(crate) enum Call {
    Insert(Box<Piece>),
    Remove(usize),
    Teleport(usize, Place),
    SetVelocity(usize, Vec2, f64),
    DriveTo(usize, Place, f64),
    SetKind(usize, BodyKind),
    SetFilter(usize, Filter),
    SetShapeFilter(usize, usize, Filter),
    SetPairSurface(usize, usize, Surface),
    SetDamping(usize, f64),
    /// What is pushed where, from the centre in m, by how many m/s of its mass.
    Apply(usize, Vec2, Vec2),
    /// The same by how many m/s² of its mass.
    Push(usize, Vec2, Vec2),
    /// What else a body was inserted with.
    Alter(usize, Alteration),
    AddField(Vec2, f64),
    ClearFields,
    SetGravity(Vec2),
    SetSettings(Choice),
    /// In parts of 2⁻¹⁶ s, so that sums of steps are exact; and where to cut it in two.
    Step(u32, Option<u32>),
    StepToNextEvent(f64),
    /// From where to where a ray, a box and a shape are asked for.
    Ask(Vec2, Vec2, Form),
    Refused(Nonsense),
}

/// What is changed of a body beside where and how it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Alteration {
    /// By this factor.
    Mass(f64),
    GravityScale(f64),
    LockedRotation(bool),
    Surface(Surface),
    /// With which other body.
    Collides(usize, bool),
    Awake,
    SleepAllowed(bool),
}

/// What is chosen anew of the settings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(crate) law: ImpactLaw,
    pub(crate) several: Several,
    pub(crate) sleeps: bool,
    /// Whether contacts are as soft as those of the preset `calm`.
    pub(crate) calm: bool,
    /// How many motions are kept, beside those that are needed.
    pub(crate) history: usize,
}

/// What is refused.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Nonsense {
    Velocity(usize),
    Place(usize),
    Impulse(usize),
    Force(usize),
    Damping(usize),
    Drive(usize),
    Pair(usize),
    Shape(usize),
    Restitution,
    NoShape,
    NoMass,
    Backwards,
    Never,
    Tick,
}

fn pair(half: f64) -> impl Strategy<Value = Vec2> {
    (-half..half, -half..half).prop_map(Vec2::from)
}

/// Half of them on a coarse grid, upright, so that they touch, stack and meet at equal instants.
fn place() -> impl Strategy<Value = Place> {
    let grid = (-6..=6_i8, -6..=6_i8).prop_map(|(x, y)| Place {
        at: vec2(f64::from(x), f64::from(y)) * 0.5,
        angle: 0.0,
    });
    let anywhere = (pair(3.4), -3.2..3.2_f64).prop_map(|(at, angle)| Place { at, angle });
    prop_oneof![grid, anywhere]
}

fn surface() -> impl Strategy<Value = Surface> {
    (
        prop_oneof![Just(0.0), Just(0.5), 0.0..1.2_f64],
        prop_oneof![3 => Just(0.0), 1 => Just(1.0), 3 => 0.0..1.0_f64],
        prop_oneof![8 => Just(0.0), 1 => -2.0..2.0_f64],
    )
        .prop_map(|(friction, restitution, belt)| Surface {
            friction,
            restitution,
            belt,
        })
}

fn form() -> impl Strategy<Value = Form> {
    prop_oneof![
        (0.1..0.7_f64).prop_map(Form::Disc),
        Just(Form::Disc(0.25)),
        Just(Form::Block(1.0, 0.5)),
        (0.2..1.4_f64, 0.2..1.4_f64).prop_map(|(w, h)| Form::Block(w, h)),
        (0.2..0.8_f64).prop_map(Form::Star),
        (0.4..1.2_f64).prop_map(Form::Angle),
        (0.3..0.9_f64).prop_map(Form::Dumbbell),
    ]
}

fn filter() -> impl Strategy<Value = Filter> {
    let any = (1..4_u64, 1..4_u64, -1..=1_i32).prop_map(|(categories, mask, group)| Filter {
        categories,
        // Walls are of the first category.
        mask: mask | 1,
        group,
    });
    prop_oneof![3 => Just(Filter::default()), 1 => any]
}

fn kind() -> impl Strategy<Value = BodyKind> {
    prop_oneof![
        6 => Just(BodyKind::Dynamic),
        1 => Just(BodyKind::Fixed),
        1 => Just(BodyKind::Kinematic),
    ]
}

fn velocity() -> impl Strategy<Value = Vec2> {
    prop_oneof![Just(Vec2::ZERO), pair(3.0), pair(10.0)]
}

fn spin() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), -10.0..10.0_f64]
}

fn piece() -> impl Strategy<Value = Piece> {
    let rarely = || prop_oneof![6 => Just(false), 1 => Just(true)];
    (
        (form(), kind(), place(), velocity(), spin()),
        (1.0..20.0_f64, surface(), rarely(), rarely(), filter()),
        prop_oneof![8 => Just(0.0), 1 => 0.05..1.0_f64],
    )
        .prop_map(
            |(
                (form, kind, place, velocity, spin),
                (density, surface, locked, asleep, filter),
                damping,
            )| Piece {
                form,
                kind,
                place,
                velocity,
                spin,
                density,
                surface,
                locked,
                asleep,
                damping,
                filter,
            },
        )
}

pub(crate) fn start() -> impl Strategy<Value = Start> {
    let mostly = || prop_oneof![3 => Just(true), 1 => Just(false)];
    (
        mostly(),
        mostly(),
        any::<bool>(),
        surface(),
        prop::collection::vec(piece(), 0..14),
    )
        .prop_map(|(gravity, sleeps, half_planes, surface, pieces)| Start {
            gravity,
            sleeps,
            half_planes,
            surface,
            pieces,
        })
}

fn step() -> impl Strategy<Value = Call> {
    let length = prop_oneof![Just(1024), 1..2048_u32, 1..16_384_u32];
    (length, prop::option::of(1..16_384_u32))
        .prop_map(|(length, cut)| Call::Step(length, cut.map(|cut| cut % length)))
}

fn nonsense() -> impl Strategy<Value = Nonsense> {
    let of = || 0..32_usize;
    prop_oneof![
        of().prop_map(Nonsense::Velocity),
        of().prop_map(Nonsense::Place),
        of().prop_map(Nonsense::Impulse),
        of().prop_map(Nonsense::Force),
        of().prop_map(Nonsense::Damping),
        of().prop_map(Nonsense::Drive),
        of().prop_map(Nonsense::Pair),
        of().prop_map(Nonsense::Shape),
        Just(Nonsense::Restitution),
        Just(Nonsense::NoShape),
        Just(Nonsense::NoMass),
        Just(Nonsense::Backwards),
        Just(Nonsense::Never),
        Just(Nonsense::Tick),
    ]
}

fn alteration() -> impl Strategy<Value = Alteration> {
    prop_oneof![
        (0.1..10.0_f64).prop_map(Alteration::Mass),
        prop_oneof![Just(0.0), Just(1.0), -1.0..2.0_f64].prop_map(Alteration::GravityScale),
        any::<bool>().prop_map(Alteration::LockedRotation),
        surface().prop_map(Alteration::Surface),
        (0..32_usize, any::<bool>()).prop_map(|(other, on)| Alteration::Collides(other, on)),
        Just(Alteration::Awake),
        any::<bool>().prop_map(Alteration::SleepAllowed),
    ]
}

fn choice() -> impl Strategy<Value = Choice> {
    let laws = vec![ImpactLaw::Stronge, ImpactLaw::Poisson, ImpactLaw::Newton];
    // `NewtonLcp` may gain energy.
    let several = vec![Several::Blend, Several::Reflections];
    (
        prop::sample::select(laws),
        prop::sample::select(several),
        any::<bool>(),
        any::<bool>(),
        0..64_usize,
    )
        .prop_map(|(law, several, sleeps, calm, history)| Choice {
            law,
            several,
            sleeps,
            calm,
            history,
        })
}

fn call() -> impl Strategy<Value = Call> {
    let of = || 0..32_usize;
    prop_oneof![
        12 => step(),
        2 => (0.0..0.3_f64).prop_map(Call::StepToNextEvent),
        2 => piece().prop_map(|piece| Call::Insert(Box::new(piece))),
        1 => of().prop_map(Call::Remove),
        1 => (of(), place()).prop_map(|(id, place)| Call::Teleport(id, place)),
        1 => (of(), velocity(), spin()).prop_map(|(id, v, spin)| Call::SetVelocity(id, v, spin)),
        1 => (of(), place(), 0.3..2.0_f64).prop_map(|(id, place, dt)| Call::DriveTo(id, place, dt)),
        1 => (of(), kind()).prop_map(|(id, kind)| Call::SetKind(id, kind)),
        1 => (of(), filter()).prop_map(|(id, filter)| Call::SetFilter(id, filter)),
        1 => (of(), 0..3_usize, filter()).prop_map(|(id, k, filter)| Call::SetShapeFilter(id, k, filter)),
        1 => (of(), of(), surface()).prop_map(|(a, b, surface)| Call::SetPairSurface(a, b, surface)),
        1 => (of(), prop_oneof![Just(0.0), 0.0..1.0_f64]).prop_map(|(id, c)| Call::SetDamping(id, c)),
        1 => (of(), pair(0.3), pair(4.0)).prop_map(|(id, arm, push)| Call::Apply(id, arm, push)),
        1 => (of(), pair(0.3), pair(20.0)).prop_map(|(id, arm, push)| Call::Push(id, arm, push)),
        1 => (pair(5.0), -30.0..30.0_f64).prop_map(|(at, strength)| Call::AddField(at, strength)),
        2 => (of(), alteration()).prop_map(|(id, what)| Call::Alter(id, what)),
        1 => Just(Call::ClearFields),
        1 => prop_oneof![Just(Vec2::ZERO), pair(10.0)].prop_map(Call::SetGravity),
        1 => choice().prop_map(Call::SetSettings),
        3 => (pair(6.0), pair(6.0), form()).prop_map(|(from, to, form)| Call::Ask(from, to, form)),
        1 => nonsense().prop_map(Call::Refused),
    ]
}

pub(crate) fn calls() -> impl Strategy<Value = Vec<Call>> {
    prop::collection::vec(call(), 1..60)
}
