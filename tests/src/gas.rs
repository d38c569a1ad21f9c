//! Gases: elastic bodies without friction in a closed box, and what an impact keeps.

use carom_dynamics::{Body, BodyDef, BodyId, EventKind, Material, Settings, StepReport, World};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Sum, Vec2, cross, vec2};

use crate::{depth, elastic};

/// Numbers from 0 to 1 by SplitMix64: the same seed, the same numbers.
pub fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
        let number = ((z ^ (z >> 31)) >> 11) as f64;
        number / (1_u64 << 53) as f64
    }
}

/// What a gas is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Molecule {
    /// Discs of different sizes.
    Disc,
    /// Rectangles, 1 : 1 to 1 : 3.
    Box,
    /// Convex polygons and stars of any outline, a half each.
    Polygon,
}

/// `side`² bodies without gravity in a box of `side` × `side` metres about the origin, no two at rest to each other.
///
/// # Panics
/// Never: all sizes are above 0.
#[must_use]
pub fn gas(molecule: Molecule, side: u32, seed: u64) -> World {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        sleep: None,
        ..Settings::default()
    })
    .expect("valid settings");
    let half = 0.5 * f64::from(side);
    for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let long = 2.0 * half + 2.0;
        let size = if x == 0.0 { (long, 1.0) } else { (1.0, long) };
        let wall = ConvexPolygon::rectangle(size.0, size.1).expect("a wall");
        let at = vec2(x, y) * (half + 0.5);
        world
            .insert(BodyDef::fixed().at(at), wall, elastic())
            .expect("valid");
    }
    let mut next = numbers(seed);
    for row in 0..side {
        for column in 0..side {
            let at = vec2(f64::from(column), f64::from(row)) + 0.5 - half;
            let shape = outline(molecule, (row + column) % 2 == 0, &mut next);
            let def = BodyDef::dynamic()
                .at(at)
                .turned(6.0 * next())
                .moving((vec2(next(), next()) - 0.5) * 4.0)
                .spinning(6.0 * (next() - 0.5))
                .tagged(u64::from(row * side + column));
            let material = Material {
                density: 0.5 + next(),
                ..elastic()
            };
            world.insert(def, shape, material).expect("valid");
        }
    }
    world
}

/// A shape within 0.42 m of the origin.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers lie in 0..1"
)]
fn outline(molecule: Molecule, star: bool, next: &mut impl FnMut() -> f64) -> Shape {
    let count = |next: &mut dyn FnMut() -> f64| 3 + (next() * 6.0) as usize;
    match molecule {
        Molecule::Disc => Circle::new(0.15 + 0.2 * next()).expect("a disc").into(),
        Molecule::Box => {
            let width = 0.25 + 0.25 * next();
            let height = width * (1.0 / 3.0 + 2.0 / 3.0 * next());
            let shape = ConvexPolygon::rectangle(width, height);
            shape.expect("a box").into()
        }
        Molecule::Polygon if star => {
            let count = count(next) + 1;
            let shape = Polygon::random_star(count, 0.12, 0.42, next);
            shape.expect("a star").into()
        }
        Molecule::Polygon => {
            let count = count(next);
            let shape = ConvexPolygon::random(count, 0.2 + 0.15 * next(), next);
            shape.expect("a polygon").into()
        }
    }
}

/// What single impacts kept, and how deep bodies ever overlapped.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    /// Impacts of two bodies, and of a body and a wall.
    pub impacts: u64,
    /// Of these, impacts of two moving bodies at their instants: not within sub-steps.
    pub collisions: u64,
    /// Sums of the errors of energy, in parts of the energy of the bodies struck, and of their squares.
    errors: [Sum; 2],
    /// Worst change of linear momentum by an impact of two moving bodies, as a part of Σ m |v|.
    pub linear: f64,
    /// Worst change of the angular momentum about the point of impact, as a part of Σ m |r| |v| + I |ω|.
    pub angular: f64,
    /// Deepest overlap of a pair that strikes, or of any pair at a sample, in parts of the smaller size.
    pub deepest: f64,
    /// Sum of all reports.
    pub report: StepReport,
}

impl Watch {
    /// Runs to the next event, at most `max` seconds, and looks at it.
    pub fn next(&mut self, world: &mut World, max: f64) {
        let before: Vec<State> = world.bodies().map(|b| State::of(&b)).collect();
        self.look(&before, world, max);
    }

    /// Runs `seconds` and looks at every impact, and at all pairs every `sample` seconds; `each` is told the
    /// time and the kinetic energy at each sample.
    ///
    /// # Panics
    /// If a body that struck is gone.
    pub fn run(
        &mut self,
        world: &mut World,
        seconds: f64,
        sample: f64,
        mut each: impl FnMut(f64, f64),
    ) {
        let start = world.time();
        let mut states: Vec<State> = world.bodies().map(|b| State::of(&b)).collect();
        let mut count = 0.0;
        while count * sample < seconds {
            count += 1.0;
            let end = start + (count * sample).min(seconds);
            while world.time() < end {
                self.look(&states, world, end - world.time());
                for event in world.events() {
                    if let EventKind::Impact { a, b, .. } = event.kind {
                        for id in [a, b] {
                            let body = world.body(id).expect("it struck");
                            let at = place(&states, id);
                            states[at] = State::of(&body);
                        }
                    }
                }
            }
            self.deepest = self.deepest.max(deepest(world));
            each(end - start, kinetic(world));
        }
    }

    fn look(&mut self, before: &[State], world: &mut World, max: f64) {
        let report = world.step_to_next_event(max);
        self.report += report;
        // Bodies that this instant struck: as a rule two.
        let mut struck: Vec<usize> = Vec::new();
        let mut about = Vec2::ZERO;
        for event in world.events() {
            let EventKind::Impact { a, b, point, .. } = event.kind else {
                continue;
            };
            self.impacts += 1;
            struck.extend([place(before, a), place(before, b)]);
            about = point;
            let (a, b) = (world.body(a), world.body(b));
            let (a, b) = (a.expect("it struck"), b.expect("it struck"));
            self.deepest = self.deepest.max(overlap(&a, &b));
        }
        if struck.is_empty() {
            return;
        }
        struck.sort_unstable();
        struck.dedup();
        let after: Vec<State> = struck
            .iter()
            .map(|&k| State::of(&world.body(before[k].id).expect("it struck")))
            .collect();
        let before: Vec<&State> = struck.iter().map(|&k| &before[k]).collect();
        let old: Sum = before.iter().map(|s| s.kinetic().value()).collect();
        let mut change = Sum::ZERO;
        for (now, then) in after.iter().zip(&before) {
            now.add_kinetic(&mut change, 1.0);
            then.add_kinetic(&mut change, -1.0);
        }
        let error = change.value() / old.value();
        self.errors[0].add(error);
        self.errors[1].add_product(error, error);
        // A sub-step of what is fast and thin loses angular momentum by continuous collision.
        if report.handed_over == 0 && after.iter().all(|s| s.mass.is_finite()) {
            self.collisions += 1;
            self.momentum(&before, &after, about);
        }
    }

    fn momentum(&mut self, before: &[&State], after: &[State], about: Vec2) {
        let mut sums = [Sum::ZERO; 3];
        let (mut linear, mut angular) = (0.0, 0.0);
        for (now, then) in after.iter().zip(before) {
            for (state, sign) in [(now, 1.0), (*then, -1.0)] {
                // Where it is at the impact, with the velocity before or after it.
                let arm = now.centre - about;
                sums[0].add_product(sign * state.mass, state.velocity.x);
                sums[1].add_product(sign * state.mass, state.velocity.y);
                sums[2].add(sign * state.mass * cross(arm, state.velocity));
                sums[2].add_product(sign * state.inertia, state.spin);
                let momentum = state.mass * state.velocity.length();
                linear += momentum;
                angular += momentum * arm.length() + state.inertia * state.spin.abs();
            }
        }
        let change = vec2(sums[0].value(), sums[1].value()).length();
        self.linear = self.linear.max(change / linear);
        self.angular = self.angular.max(sums[2].value().abs() / angular);
    }

    /// Mean of the errors of single impacts, and the standard deviation that it would have by chance.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "fewer than 2^53 impacts")]
    pub fn bias(&self) -> (f64, f64) {
        let n = self.impacts.max(1) as f64;
        let mean = self.errors[0].value() / n;
        let variance = self.errors[1].value() / n - mean * mean;
        (mean, (variance.max(0.0) / n).sqrt())
    }
}

/// What an impact may change, and where.
#[derive(Clone, Copy, Debug)]
struct State {
    id: BodyId,
    mass: f64,
    inertia: f64,
    centre: Vec2,
    velocity: Vec2,
    spin: f64,
}

impl State {
    fn of(body: &Body<'_>) -> Self {
        Self {
            id: body.id(),
            mass: body.mass(),
            inertia: body.inertia(),
            centre: body.centre(),
            velocity: body.velocity(),
            spin: body.angular_velocity(),
        }
    }

    /// Adds ½ m v² + ½ I ω², in J, to two roundings.
    fn add_kinetic(&self, sum: &mut Sum, sign: f64) {
        if self.mass.is_finite() {
            sum.add_product(sign * 0.5 * self.mass * self.velocity.x, self.velocity.x);
            sum.add_product(sign * 0.5 * self.mass * self.velocity.y, self.velocity.y);
            sum.add_product(sign * 0.5 * self.inertia * self.spin, self.spin);
        }
    }

    fn kinetic(&self) -> Sum {
        let mut sum = Sum::ZERO;
        self.add_kinetic(&mut sum, 1.0);
        sum
    }
}

fn place(states: &[State], id: BodyId) -> usize {
    let found = states.iter().position(|s| s.id == id);
    found.expect("no body comes or goes")
}

/// Kinetic energy of all bodies, in J, right to a few roundings.
#[must_use]
pub fn kinetic(world: &World) -> f64 {
    let mut sum = Sum::ZERO;
    for body in world.bodies() {
        State::of(&body).add_kinetic(&mut sum, 1.0);
    }
    sum.value()
}

/// Deepest overlap of all pairs of which one moves, in parts of the smaller size, ≥ 0.
///
/// From shapes and poses alone: it shares nothing with the world's own search.
#[must_use]
pub fn deepest(world: &World) -> f64 {
    let bodies: Vec<_> = world.bodies().map(|b| (b.aabb(), b)).collect();
    let mut deepest = 0.0_f64;
    for (i, (bounds, a)) in bodies.iter().enumerate() {
        for (other, b) in &bodies[i + 1..] {
            if bounds.overlaps(*other) && (a.mass().is_finite() || b.mass().is_finite()) {
                deepest = deepest.max(overlap(a, b));
            }
        }
    }
    deepest
}

/// Depth of the deepest overlap of two bodies' convex parts in parts of the smaller size, ≥ 0.
fn overlap(a: &Body<'_>, b: &Body<'_>) -> f64 {
    depth(a, b) / size(a).min(size(b))
}

/// Distance of the farthest point of a body's shapes from its centre of mass, in m.
#[must_use]
pub fn size(body: &Body<'_>) -> f64 {
    let reach = body
        .shapes()
        .map(|(shape, _)| shape.reach_about(body.local_centre()));
    reach.fold(0.0, f64::max)
}
