//! Hard rows: few bodies, of which one is fast.

use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Rot, Vec2, vec2};

use super::hard::at;
use crate::{BodyInput, BodyKind, Engine, Material, PieceInput, Settings};

const SIDES: u32 = 8;

/// Towards the middle of side `k`.
fn towards(k: u32) -> Rot {
    Rot::from_angle(core::f64::consts::TAU * f64::from(k) / f64::from(SIDES))
}

/// A ring of eight blocks that spins; its walls are 2 m from the centre.
fn ring(engine: &mut Engine, spin: f64, surface: Material) {
    let block = |k: u32| {
        let corners = [(2.0, -0.8), (2.5, -0.8), (2.5, 0.8), (2.0, 0.8)];
        let corners = corners.map(|(x, y)| towards(k) * vec2(x, y));
        PieceInput::new(ConvexPolygon::new(corners).unwrap()).with_material(surface)
    };
    let blocks: Vec<PieceInput> = (0..SIDES).map(block).collect();
    let turns = BodyInput::new(BodyKind::Kinematic).moving(Vec2::ZERO, spin);
    engine.insert(turns, &blocks).unwrap();
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
        ring(&mut engine, spin, surface);
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
