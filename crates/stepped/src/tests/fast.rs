//! Hard rows: few bodies, of which one is fast.

use carom_geometry::{Circle, ConvexPolygon, HalfPlane};
use carom_math::{Rot, Vec2, vec2};

use super::hard::at;
use super::{Random, without_sleep};
use crate::narrow::collide_any;
use crate::{BodyInput, BodyKind, Engine, Material, Mixed, PieceInput, Settings};

const SIDES: u32 = 8;

/// Towards the middle of side `k`.
fn towards(k: u32) -> Rot {
    Rot::from_angle(core::f64::consts::TAU * f64::from(k) / f64::from(SIDES))
}

/// A ring of eight blocks; its walls are 2 m from the centre.
fn ring(surface: Material) -> Vec<PieceInput> {
    let block = |k: u32| {
        let corners = [(2.0, -0.8), (2.5, -0.8), (2.5, 0.8), (2.0, 0.8)];
        let corners = corners.map(|(x, y)| towards(k) * vec2(x, y));
        PieceInput::new(ConvexPolygon::new(corners).unwrap()).with_material(surface)
    };
    (0..SIDES).map(block).collect()
}

/// One that spins, whatever it carries.
fn driven(engine: &mut Engine, spin: f64, surface: Material) {
    let turns = BodyInput::new(BodyKind::Kinematic).moving(Vec2::ZERO, spin);
    engine.insert(turns, &ring(surface)).unwrap();
}

/// Turning presses it outwards by 35 g: it sank into the wall by 28 mm. Carried in a corner it is not in the wall at all; thrown into
/// one at 28 m/s it is by 2.4 mm.
#[test]
fn what_a_ring_carries_that_spins_does_not_sink_into_it() {
    for spin in [-14.7, 13.0, 20.0] {
        let mut engine = Engine::new(Settings::default()).unwrap();
        let surface = Material {
            friction: 0.3,
            ..Material::default()
        };
        driven(&mut engine, spin, surface);
        let disc = Circle::new(0.4).unwrap();
        let within = BodyInput::dynamic(1.0, 0.08).at(vec2(0.5, 0.4));
        let piece = PieceInput::new(disc).with_material(surface);
        let within = engine
            .insert(within.moving(vec2(-3.0, -1.0), 0.0), &[piece])
            .unwrap();
        let (mut deepest, mut carried) = (0.0_f64, 0);
        for tick in 0..300 {
            engine.tick();
            let pose = at(&engine, within);
            let ring = Rot::from_angle(spin * f64::from(tick + 1) / 60.0);
            let outwards = |k| (ring * towards(k) * Vec2::X).dot(pose);
            let walls = (0..SIDES).map(|k| outwards(k) + 0.4 - 2.0);
            deepest = deepest.max(walls.fold(-2.0, f64::max));
            let (v, _) = engine.velocity(within).unwrap();
            carried += u32::from(v.length() > 0.9 * spin.abs() * pose.length());
        }
        assert!(carried > 100, "{spin} rad/s: carried for {carried} ticks");
        assert!(deepest < 3e-3, "{deepest} m deep at {spin} rad/s");
        assert_eq!(engine.failed_hard_solves(), 0, "{spin} rad/s");
    }
}

/// A ring and a disc in it that nothing holds. Overlaps that a sub-step made were parted by displacement: with the angular momentum
/// given back, it gained up to 2.8e-4 of its energy in a sub-step. Contacts were computed anew of what turned alone, against where the
/// disc was up to a tick ago: one seemed 0.24 m deep, was not rotated, and angular momentum was lost, 2.8e-3 of it.
#[test]
fn a_free_ring_gains_no_energy_and_keeps_its_angular_momentum() {
    let (mass, inertia) = ([5.0, 1.0], [25.0, 0.08]);
    for case in 0..12 {
        let mut engine = Engine::new(Settings {
            gravity: Vec2::ZERO,
            ..without_sleep()
        })
        .unwrap();
        let surface = Material {
            friction: [0.0, 0.3][case % 2],
            restitution: [0.0, 0.3, 0.5][case / 2 % 3],
        };
        let spin = [14.7, 20.0][case / 6];
        let turns = BodyInput::dynamic(mass[0], inertia[0]).moving(Vec2::ZERO, spin);
        let disc = PieceInput::new(Circle::new(0.4).unwrap()).with_material(surface);
        let within = BodyInput::dynamic(mass[1], inertia[1]).at(vec2(1.0, 0.3));
        let within = within.moving(vec2(3.0, 0.5), 0.0);
        let bodies = [
            engine.insert(turns, &ring(surface)).unwrap(),
            engine.insert(within, &[disc]).unwrap(),
        ];
        let motion = |engine: &Engine| {
            let of = |k: usize| {
                let (v, w) = engine.velocity(bodies[k]).unwrap();
                let energy = 0.5 * (mass[k] * v.length_squared() + inertia[k] * w * w);
                let turns = mass[k] * at(engine, bodies[k]).perp_dot(v) + inertia[k] * w;
                (energy, turns)
            };
            let (one, other) = (of(0), of(1));
            (one.0 + other.0, one.1 + other.1)
        };
        let begun = motion(&engine);
        let (mut energy, mut pressed) = (begun.0, 0);
        for substep in 0..1200 {
            engine.substep(&Mixed);
            let now = motion(&engine);
            let gain = now.0 / energy - 1.0;
            let what = || format!("case {case}, sub-step {substep}");
            assert!(gain < 1e-12, "{gain:e} of the energy gained, {}", what());
            let off = now.1 / begun.1 - 1.0;
            assert!(off.abs() < 1e-12, "{off:e} of the turning, {}", what());
            let deepest = engine.deepest_overlap();
            assert!(deepest < 5e-3, "{deepest} m deep, {}", what());
            pressed += u32::from(engine.contacts().count() > 0);
            energy = now.0;
        }
        assert!(pressed > 500, "{pressed} sub-steps in touch, case {case}");
    }
}

/// A thin wall comes once contacts were found, into the box in which nothing stood then.
#[test]
fn a_fast_body_meets_what_comes_to_stand_before_it_is_stopped() {
    let mut engine = Engine::new(without_sleep()).unwrap();
    let ball = PieceInput::new(Circle::new(0.1).unwrap());
    let mass = core::f64::consts::PI * 0.01;
    let mut body = BodyInput::dynamic(mass, 0.5 * mass * 0.01);
    body.velocity = vec2(200.0, 0.0);
    let id = engine.insert(body, &[ball]).unwrap();
    engine.find_contacts(&Mixed);
    engine.advance();
    let wall = PieceInput::new(ConvexPolygon::rectangle(0.02, 4.0).unwrap());
    let at = BodyInput::fixed().at(vec2(0.3, 0.0));
    engine.insert(at, &[wall]).unwrap();
    engine.finish(&Mixed);
    let x = engine.pose(id).unwrap().position.x;
    assert!(x < 0.2, "through the wall, to {x} m");
}

/// Contacts of a body that deviates are computed anew within a tick, where the others are then: against where the plate was as the
/// tick began the box stopped in the air below it, and carried it along.
#[test]
fn what_deviates_within_a_tick_passes_where_others_were() {
    let mut engine = Engine::new(Settings {
        gravity: Vec2::ZERO,
        ..without_sleep()
    })
    .unwrap();
    let plate = PieceInput::new(ConvexPolygon::rectangle(1.0, 0.4).unwrap());
    let flies = BodyInput::dynamic(1.0, 1.0).moving(vec2(90.0, 0.0), 0.0);
    let plate = engine.insert(flies, &[plate]).unwrap();
    let block = PieceInput::new(ConvexPolygon::rectangle(0.4, 0.4).unwrap());
    let waits = BodyInput::dynamic(1.0, 1.0).at(vec2(0.0, -0.6));
    let block = engine.insert(waits, &[block]).unwrap();
    for _ in 0..3 {
        engine.substep(&Mixed);
    }
    let gone = at(&engine, plate).x;
    assert!(gone > 0.7, "{gone}");
    let up = vec2(0.0, 100.0);
    engine.set_velocity(block, up, 0.0).unwrap();
    while !engine.is_at_tick() {
        engine.substep(&Mixed);
    }
    assert_eq!(engine.velocity(plate).unwrap().0, vec2(90.0, 0.0));
    assert_eq!(engine.velocity(block).unwrap().0, up);
    let risen = at(&engine, block).y;
    assert!(risen > 0.0, "{risen}");
    assert!(engine.deepest_overlap() < 1e-12);
}

/// Rows that rotated with bodies that were stopped are those of where these would have been: 4.4 m were reported of what lay apart.
#[test]
fn what_was_stopped_overlaps_as_its_shape_does() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..without_sleep()
    };
    for seed in 0..150 {
        let mut random = Random::new(seed);
        let substeps = [1, 2, 3, 4][random.below(4)];
        let mut engine = Engine::new(Settings {
            substeps,
            ..settings
        })
        .unwrap();
        for k in 0..4 {
            let normal = Rot::from_angle(core::f64::consts::FRAC_PI_2 * f64::from(k)) * Vec2::X;
            let wall = PieceInput::new(HalfPlane::new(normal * -4.0, normal).unwrap());
            engine.insert(BodyInput::fixed(), &[wall]).unwrap();
        }
        for at in 0..6u32 {
            let place = vec2(f64::from(at % 3), f64::from(at / 3)) * 1.6;
            let velocity = vec2(random.signed(), random.signed()) * 2000.0;
            let body = BodyInput::dynamic(1.0, 0.1).at(place);
            let body = body.moving(velocity, 700.0 * random.signed());
            engine.insert(body, &[random.piece()]).unwrap();
        }
        for _ in 0..20 {
            engine.substep(&Mixed);
            let depths = engine.graph.ids().filter_map(|id| {
                let pair = engine.graph.contacts[id].pieces;
                let [a, b] = pair.map(|number| {
                    let piece = &engine.pieces.list[number];
                    (piece, engine.bodies.pose_of(piece.body))
                });
                collide_any(a, b, 0.0).map(|found| -found.gap())
            });
            let deepest = depths.fold(0.0, f64::max);
            // What was pressed through another one is as deep as both are wide: 1.4 m at most.
            let told = -engine.least_gap;
            assert!(told < deepest + 1.4, "{told} m of {deepest}, seed {seed}");
        }
    }
}
