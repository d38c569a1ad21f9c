//! Islands without springs: [`crate::Settings::hard_bodies`] and [`crate::Settings::hard_discs`].

use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Vec2, vec2};

use super::{Random, floor};
use crate::{BodyInput, Engine, Material, Mixed, PairRules, PieceInput, Settings, Surface};

fn springless(hard_bodies: usize) -> Settings {
    Settings {
        sleep: None,
        hard_bodies,
        ..Settings::default()
    }
}

/// Twenty-four bodies that fall into a box of 5 m, discs or convex polygons.
fn heap(settings: Settings, discs: bool, material: Material, seed: u64) -> Engine {
    let mut engine = Engine::new(settings).unwrap();
    for (at, normal) in [
        (Vec2::ZERO, Vec2::Y),
        (vec2(-2.5, 0.0), Vec2::X),
        (vec2(2.5, 0.0), -Vec2::X),
    ] {
        let wall = HalfPlane::new(at, normal).unwrap();
        let wall = PieceInput::new(wall).with_material(material);
        engine.insert(BodyInput::fixed(), &[wall]).unwrap();
    }
    let mut random = Random::new(seed);
    for k in 0..24u32 {
        let size = 0.3 + 0.15 * random.next();
        let shape: Shape = if discs {
            Circle::new(size).unwrap().into()
        } else {
            let sides = 3 + random.below(5);
            ConvexPolygon::regular(sides, size).unwrap().into()
        };
        let area = shape.area_properties().unwrap().with_density(1.0);
        let at = vec2(f64::from(k % 4) - 1.5, 0.6 + f64::from(k / 4)) * 1.05;
        let body = BodyInput::dynamic(area.mass, area.inertia)
            .at(at)
            .moving(vec2(random.signed(), 0.0), 3.0 * random.signed());
        let piece = PieceInput::new(shape).with_material(material);
        engine.insert(body, &[piece]).unwrap();
    }
    engine
}

fn material(restitution: f64) -> Material {
    Material {
        restitution,
        friction: 0.4,
    }
}

/// With springs all of these heaps gain, up to 1e-4 of their energy in a tick.
#[test]
fn no_tick_gains_energy() {
    for (discs, restitution) in [(true, 0.0), (true, 0.7), (false, 0.0), (false, 0.5)] {
        for seed in 0..6 {
            let mut engine = heap(springless(64), discs, material(restitution), seed);
            let energy = |engine: &Engine| {
                let (kinetic, potential) = engine.energy();
                kinetic + potential
            };
            let start = energy(&engine);
            let mut before = start;
            let case = format!("discs: {discs}, e = {restitution}, seed {seed}");
            let mut deepest = 0.0_f64;
            for tick in 0..300 {
                engine.tick();
                deepest = deepest.max(engine.deepest_overlap());
                let now = energy(&engine);
                let gain = (now - before) / start;
                assert!(gain < 1e-12, "{case}: {gain:e} in tick {tick}");
                before = now;
            }
            assert!(before < 0.7 * start, "{case}: it fell");
            assert_eq!(engine.failed_hard_solves(), 0, "{case}");
            // Corners that turn dig in, and are parted.
            let most = if discs { 2e-4 } else { 5e-3 };
            assert!(deepest < most, "{case}: {deepest} m deep");
            let left = engine.deepest_overlap();
            assert!(left < 1e-4, "{case}: {left} m left");
        }
    }
}

/// Discs alone are asked for: heaps of polygons go on with springs, and one polygon among discs is enough for that.
#[test]
fn islands_of_discs_are_told_from_others() {
    let places = |settings: Settings, discs: bool, mixed: bool| -> Vec<Vec2> {
        let mut engine = heap(settings, discs, material(0.0), 3);
        if mixed {
            let body = BodyInput::dynamic(1.0, 0.1).at(vec2(0.0, 9.0));
            let square = ConvexPolygon::square(0.5).unwrap();
            engine.insert(body, &[PieceInput::new(square)]).unwrap();
        }
        for _ in 0..120 {
            engine.tick();
        }
        let all = engine.bodies();
        all.map(|id| engine.pose(id).unwrap().position).collect()
    };
    let of_discs = || Settings {
        hard_discs: 64,
        ..springless(0)
    };
    assert_eq!(
        places(of_discs(), true, false),
        places(springless(64), true, false)
    );
    assert_ne!(
        places(of_discs(), true, false),
        places(springless(0), true, false)
    );
    assert_eq!(
        places(of_discs(), false, false),
        places(springless(0), false, false)
    );
    assert_ne!(
        places(of_discs(), true, true),
        places(springless(64), true, true)
    );
}

/// What bounced within a sub-step was told with the impulse of the bounce.
#[test]
fn a_state_before_a_sub_step_is_the_one_that_was_there() {
    for hard_bodies in [0, 64] {
        let mut engine = heap(springless(hard_bodies), true, material(0.7), 1);
        engine.note_ways(true);
        let mut last: Vec<_> = engine.awake().map(|state| state.velocity).collect();
        for _ in 0..600 {
            engine.substep(&Mixed);
            for (state, last) in engine.awake().zip(&last) {
                assert_eq!(state.before, *last);
            }
            last = engine.awake().map(|state| state.velocity).collect();
        }
    }
}

/// All surfaces run at 2 m/s.
struct Belt;

impl PairRules for Belt {
    fn surface(&self, _: [u64; 2], _: [Material; 2]) -> Option<Surface> {
        Some(Surface {
            friction: 0.3,
            restitution: 0.0,
            tangent_speed: 2.0,
        })
    }
}

/// A belt that starts a disc: what it gives is what the disc gets, and the heat.
#[test]
fn a_belt_gives_motion_and_heat() {
    for hard_bodies in [0, 64] {
        let mut engine = Engine::new(springless(hard_bodies)).unwrap();
        floor(&mut engine);
        let disc = Circle::new(0.5).unwrap();
        let body = BodyInput::dynamic(1.0, 0.125).at(vec2(0.0, 0.5));
        engine.insert(body, &[PieceInput::new(disc)]).unwrap();
        let (mut kinetic, _) = engine.energy();
        assert!(kinetic.abs() <= 0.0);
        for _ in 0..30 {
            engine.tick_by(&Belt);
            (kinetic, _) = engine.energy();
        }
        let (given, heat) = (engine.belt_work(), engine.friction_heat());
        assert!(kinetic > 0.1 && heat > 0.1, "{kinetic} J, {heat} J of heat");
        let left = given - kinetic - heat;
        // Springs take the last of a slip for sticking.
        let most = if hard_bodies > 0 { 1e-10 } else { 1e-3 };
        assert!(left.abs() < most * given, "{left:e} J of {given} J");
    }
}
