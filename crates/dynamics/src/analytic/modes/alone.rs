//! When a body that slides alone begins to tip: a root of a quadratic.
//!
//! It touches only what is at rest, with parallel edges on one side and one friction µ. With n the unit normal towards it, t = perp(n)
//! and s the sign of its slip, the force at the point x t + y n from its centre is N n − s µ N t, and its moment −N (x + s µ y). So the
//! body goes on without turning while there are N ≥ 0 with
//!
//! ```text
//! Σ N = P,   Σ N e = P c,   e = x + s µ y        P presses it; P c is the moment of all that is no contact
//! ```
//!
//! which is while c lies between the least e and the greatest. Seen from its centre a touch reaches from max(f₀, g₀ − d) to
//! min(f₁, g₁ − d) once the body has gone by d, f its own edge and g the other one where they are now. As d grows the greatest e falls
//! below c at d = max (g₁ + s µ y − c) over the touches with f₁ + s µ y ≥ c; the least one rises above it likewise as d falls.
//!
//! Beyond that by δ the last point bears alone: α = P δ / (I + m x c), to first order.

use carom_math::{Vec2, perp};

use super::balance::Tangent;
use super::change::{Load, SAME, Slide, falls_to_zero, stretch};
use super::{BodyMove, Feature, Touch};
use crate::impact::ImpactBody;

/// Unit normals that differ by no more bear as one: another direction would be another acceleration.
const PARALLEL: f64 = SAME;

/// How far a body that slides alone goes until it moves otherwise, in m: along the tangent of its touches, and against it.
pub(super) fn ways(load: &Load<'_>) -> Option<[f64; 2]> {
    let alone = Alone::of(load)?;
    Some([alone.way(1.0)?, alone.way(-1.0)?])
}

/// The first instant before `end` at which what slides alone moves otherwise.
pub(super) fn tips(load: &Load<'_>, ways: [f64; 2], end: f64) -> Option<f64> {
    let slide = Slide::of(&load.touches[0], load.moves);
    let [along, against] = ways;
    let along = falls_to_zero(along, -slide.speed, -slide.rate);
    let against = falls_to_zero(against, slide.speed, slide.rate);
    let earlier = |first: f64, after: f64| if after < first { after } else { first };
    let first = along.into_iter().chain(against).fold(end, earlier);
    (first < end).then_some(first)
}

/// A body that slides alone, and what bears it.
struct Alone<'a> {
    touches: &'a [Touch],
    /// Its place in the list of bodies.
    at: usize,
    body: ImpactBody,
    /// n.
    normal: Vec2,
    friction: f64,
    /// s.
    sign: f64,
    /// P, in N.
    press: f64,
    /// c, in m.
    arm: f64,
    /// The largest scaled acceleration: what others are compared with.
    size: f64,
}

impl<'a> Alone<'a> {
    fn of(load: &Load<'a>) -> Option<Self> {
        let (bodies, touches, moves) = (load.bodies, load.touches, load.moves);
        let mut moving = (0..bodies.len()).filter(|at| bodies[*at].inverse_mass > 0.0);
        let (Some(at), None) = (moving.next(), moving.next()) else {
            return None;
        };
        let (body, moved, (pull, twist)) = (bodies[at], moves[at], load.pulls[at]);
        let rests =
            |(other, moved): (usize, &BodyMove)| other == at || *moved == BodyMove::default();
        let turns = moved.spin != 0.0 || moved.angular_acceleration != 0.0;
        let (normal, friction) = (up(&touches[0], at), touches[0].friction);
        let alike = |touch: &Touch| {
            (up(touch, at) - normal).length() <= PARALLEL
                && (touch.friction - friction).abs() <= SAME * friction
        };
        let press = -pull.dot(normal) / body.inverse_mass;
        let bears = body.inverse_inertia > 0.0 && press > 0.0;
        if !moves.iter().enumerate().all(rests) || turns || !touches.iter().all(alike) || !bears {
            return None;
        }
        let sign = match load.tangents[0] {
            Tangent::Slides(sign) => sign,
            Tangent::Holds | Tangent::Smooth => Slide::of(&touches[0], moves).rate.signum(),
        };
        let (mass, inertia) = (body.inverse_mass.recip(), body.inverse_inertia.recip());
        // Where (µ y)² < 4 I/m no point presses itself away, wherever it is (Painlevé).
        let tall = |touch: &Touch| friction * (touch.points[0] - body.centre).dot(normal);
        if !touches
            .iter()
            .all(|touch| tall(touch) * tall(touch) < 4.0 * inertia / mass)
        {
            return None;
        }
        let scaled = [
            mass.sqrt() * pull.x,
            mass.sqrt() * pull.y,
            inertia.sqrt() * twist,
        ];
        let larger = |most: f64, x: &f64| if x.abs() > most { x.abs() } else { most };
        Some(Self {
            touches,
            at,
            body,
            normal,
            friction,
            sign,
            press,
            arm: inertia * twist / press,
            size: load.found.state.iter().chain(&scaled).fold(0.0, larger),
        })
    }

    /// How far the body goes along t, or against it (`side` −1, and x, s and c are mirrored), until the acceleration is another one;
    /// `None` if nothing bears it there now.
    fn way(&self, side: f64) -> Option<f64> {
        let t = side * perp(self.normal);
        let (lean, arm) = (side * self.sign * self.friction, side * self.arm);
        let mut last: Option<(f64, f64)> = None;
        for touch in self.touches {
            let first = touch.points[0] - self.body.centre;
            let (foot, ground) = if touch.bodies.1 == self.at {
                (touch.features.1, touch.features.0)
            } else {
                (touch.features.0, touch.features.1)
            };
            // Features go along the touch's own tangent.
            let is_along = perp(touch.normal).dot(t) > 0.0;
            let end = |feature: Feature| {
                let [low, high] = stretch(feature);
                first.dot(t) + if is_along { high } else { -low }
            };
            let leans = lean * first.dot(self.normal);
            let way = end(ground) + leans - arm;
            if end(foot) + leans >= arm && last.is_none_or(|(known, _)| way > known) {
                last = Some((way, arm - leans));
            }
        }
        last.filter(|(way, _)| *way >= 0.0)
            .map(|(way, x)| way + self.beyond(x, arm))
    }

    /// How far the load has to lie beyond a point at x for the acceleration to differ by more than [`SAME`], in m.
    fn beyond(&self, x: f64, arm: f64) -> f64 {
        let (mass, inertia) = (
            self.body.inverse_mass.recip(),
            self.body.inverse_inertia.recip(),
        );
        // α, and what it does to the centre: a_n = α x, a_t = µ a_n.
        let grip = if self.friction > 1.0 {
            self.friction
        } else {
            1.0
        };
        let (turn, shift) = (inertia.sqrt(), mass.sqrt() * grip * x.abs());
        let most = if turn > shift { turn } else { shift };
        2.0 * SAME * self.size * (inertia + mass * x * arm).abs() / (self.press * most)
    }
}

/// The normal of a touch towards a body.
fn up(touch: &Touch, body: usize) -> Vec2 {
    if touch.bodies.1 == body {
        touch.normal
    } else {
        -touch.normal
    }
}

#[cfg(test)]
mod tests {
    use carom_math::{Vec2, vec2};
    use proptest::prelude::*;

    use super::super::balance::{Balance, balance};
    use super::super::faces::{self, Faces};
    use super::super::tests::flat;
    use super::super::{slip_rate, tangents};
    use super::*;
    use crate::impact::project;

    /// Bodies, their accelerations by all that is no contact, and touches.
    type Group = (Vec<ImpactBody>, Vec<(Vec2, f64)>, Vec<Touch>);

    /// How a group moves, as the load that shifts on it sees that, and its slips.
    struct Found {
        bodies: Vec<ImpactBody>,
        pulls: Vec<(Vec2, f64)>,
        touches: Vec<Touch>,
        moves: Vec<BodyMove>,
        found: Balance,
        tangents: Vec<Tangent>,
        slips: Vec<f64>,
    }

    impl Found {
        fn of((bodies, pulls, touches): Group) -> Option<Self> {
            let faces = Faces::new(&bodies, &pulls, &touches);
            let speed = bodies.iter().map(|body| body.velocity.length());
            let slips = faces::slips(&bodies, &touches, speed.sum()).expect("it slides");
            let tangents = tangents(&touches, &slips);
            let found = balance(&faces, &tangents).ok()?;
            let moves = faces.moves(&bodies, &found, &slips);
            Some(Self {
                bodies,
                pulls,
                touches,
                moves,
                found,
                tangents,
                slips,
            })
        }

        fn load(&self) -> Load<'_> {
            Load {
                bodies: &self.bodies,
                pulls: &self.pulls,
                touches: &self.touches,
                moves: &self.moves,
                found: &self.found,
                slips: &self.slips,
                tangents: &self.tangents,
            }
        }

        /// How long the touches and the slip last.
        fn lasts(&self) -> f64 {
            let touches = self.touches.iter();
            let ends = touches
                .clone()
                .filter_map(|touch| Slide::of(touch, &self.moves).ends());
            let stops = touches.zip(&self.slips).filter_map(|(touch, slip)| {
                let after = -slip / slip_rate(&self.bodies, touch, &self.moves);
                (touch.friction > 0.0 && after > 0.0).then_some(after)
            });
            ends.chain(stops).fold(f64::INFINITY, f64::min)
        }
    }

    /// A box 1 m wide slides on two floors at rest, at these heights and up to and from these ends.
    fn slider(speed: f64, pull: Vec2, ends: [f64; 2], step: f64, friction: f64) -> Group {
        let ground = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
        let slides = ImpactBody {
            inverse_mass: 1.0,
            inverse_inertia: 3.0,
            centre: vec2(0.0, 1.0),
            velocity: vec2(speed, 0.0),
            spin: 0.0,
        };
        let pulls = vec![(Vec2::ZERO, 0.0), (Vec2::ZERO, 0.0), (pull, 0.0)];
        let touches = vec![
            flat((0, 2), 0.0, [-9.0, ends[0]], [-0.5, 0.0], friction),
            flat((1, 2), step, [ends[1], 9.0], [0.0, 0.5], friction),
        ];
        (vec![ground, ground, slides], pulls, touches)
    }

    /// The first instant from which on no forces leave these accelerations, by the nearest point of the cone of all forces.
    fn first_unborne(load: &Load<'_>, looks: impl IntoIterator<Item = f64>) -> Option<f64> {
        let is_borne = |after: f64| {
            let faces = load.faces_at(after);
            let mut edges = Vec::new();
            for (face, tangent) in faces.list.iter().zip(load.tangents) {
                let sign = match tangent {
                    Tangent::Slides(sign) => *sign,
                    _ => 0.0,
                };
                for normal in &face.normals {
                    let lean = -sign * face.friction * face.tangent.length / normal.length;
                    let mut edge = vec![0.0; faces.free.len()];
                    normal.add_to(&mut edge, 1.0);
                    face.tangent.add_to(&mut edge, lean);
                    edges.push(edge);
                }
            }
            let missing = faces.free.iter().zip(&load.found.state);
            let missing: Vec<f64> = missing.map(|(free, state)| free - state).collect();
            let size = faces
                .free
                .iter()
                .fold(0.0, |most: f64, x| most.max(x.abs()));
            project::balance(&edges, &missing, 1e-15 * size).1 <= SAME * size
        };
        let mut good = 0.0;
        for mut bad in looks {
            if is_borne(bad) {
                good = bad;
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (good + bad);
                if is_borne(middle) {
                    good = middle;
                } else {
                    bad = middle;
                }
            }
            return Some(bad);
        }
        None
    }

    proptest! {
        #[test]
        fn what_slides_alone_tips_where_many_looks_see_it(
            speed in -3.0..3.0,
            pull in (-3.0..3.0, -12.0..-1.0),
            ends in (-0.4..0.5, -0.5..0.4),
            step in -0.3..0.3,
            friction in prop_oneof![Just(0.0), 0.0..0.6],
            end in 0.01..1.0,
        ) {
            let ends = [ends.0, ends.1];
            let found = Found::of(slider(speed, vec2(pull.0, pull.1), ends, step, friction));
            prop_assume!(found.is_some());
            let found = found.expect("asked for");
            let load = found.load();
            let ways = ways(&load);
            prop_assume!(ways.is_some());
            let end = f64::min(end, found.lasts());
            let root = tips(&load, ways.expect("asked for"), end);
            let looks = (1..=256).map(|k| end * f64::from(k) / 256.0);
            let many = first_unborne(&load, looks.clone());
            if friction > 0.0 {
                // Without, both feet end below the centre: a tie, which a basis sees as another motion.
                let others = load.first_other_motion(looks);
                prop_assert_eq!(others.is_some(), many.is_some());
            }
            match (root, many) {
                (Some(root), Some(many)) => prop_assert!((root - many).abs() <= 1e-9, "{root} {many}"),
                (root, many) => prop_assert_eq!(root, many),
            }
        }
    }

    /// Both feet end below the centre, so that a single point bears it between two others that are as good: a basis of two
    /// such points 0.2 mm apart turned the box by rounding, and its mode ended there.
    #[test]
    fn a_load_on_the_joint_of_two_feet_is_borne() {
        let pull = vec2(-0.823_836_376_140_415_9, -8.056_734_199_016_036);
        let ends = [0.290_516_726_532_582_37, -0.467_506_478_650_294_54];
        let group = slider(
            -2.260_205_196_760_810_3,
            pull,
            ends,
            -0.282_528_339_525_673_7,
            0.0,
        );
        let found = Found::of(group).expect("it slides");
        let load = found.load();
        let ways = ways(&load).expect("it slides alone");
        assert_eq!(tips(&load, ways, found.lasts()), None);
    }

    /// Whichever way a box goes, and on whichever side of the touch it is, it tips where its centre passes the end of the floor.
    #[test]
    fn a_box_tips_where_its_centre_passes_the_end_of_a_floor() {
        for (side, swapped) in [(1.0, false), (-1.0, false), (1.0, true), (-1.0, true)] {
            let ends = if side > 0.0 { [-9.0, 0.3] } else { [-0.3, 9.0] };
            let mut touch = flat((0, 2), 0.0, ends, [-0.5, 0.5], 0.0);
            if swapped {
                let Touch {
                    bodies, features, ..
                } = touch.clone();
                let mirrored = |feature: Feature| {
                    let [low, high] = stretch(feature);
                    Feature::Edge {
                        low: -high,
                        high: -low,
                    }
                };
                touch.bodies = (bodies.1, bodies.0);
                touch.features = (mirrored(features.1), mirrored(features.0));
                touch.normal = -touch.normal;
            }
            let (bodies, pulls, _) = slider(2.0 * side, vec2(0.0, -10.0), ends, 0.0, 0.0);
            let found = Found::of((bodies, pulls, vec![touch])).expect("it slides");
            let load = found.load();
            let ways = ways(&load).expect("it slides alone");
            let after = tips(&load, ways, found.lasts()).expect("it tips");
            assert!((after - 0.15).abs() < 1e-11, "{after} s, {side} {swapped}");
        }
    }
}
