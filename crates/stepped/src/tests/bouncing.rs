//! Restitution.

use carom_geometry::Circle;
use carom_math::{Vec2, vec2};

use super::{floor, pyramid, unit_box, weightless};
use crate::{BodyInput, Engine, Material, PieceInput, Settings};

fn elastic(restitution: f64) -> Material {
    Material {
        friction: 0.0,
        restitution,
    }
}

fn ball(restitution: f64) -> PieceInput {
    PieceInput::new(Circle::new(0.5).unwrap()).with_material(elastic(restitution))
}

/// A ball that falls from 1 m comes back to e² m.
#[test]
fn a_ball_rebounds_as_high_as_it_should() {
    for e in [0.3, 0.5, 0.8, 1.0] {
        let mut engine = Engine::new(Settings::default()).unwrap();
        floor(&mut engine);
        let body = BodyInput::dynamic(2.0, 0.2).at(vec2(0.0, 1.5));
        let id = engine.insert(body, &[ball(e)]).unwrap();
        let (mut bounced, mut top) = (false, 0.0f64);
        for _ in 0..110 {
            engine.tick();
            engine.graph.check(&engine.bodies);
            let (y, v) = (
                engine.pose(id).unwrap().position.y,
                engine.velocity(id).unwrap().0.y,
            );
            if bounced && v < 0.0 {
                break;
            }
            bounced |= v > 0.0;
            top = if bounced { top.max(y - 0.5) } else { 0.0 };
        }
        // Seen at ticks only: up to g/8 tick² below the apex.
        assert!((top - e * e).abs() < 1e-3, "e = {e}: {top} m");
    }
}

#[test]
fn equal_balls_exchange_their_speeds() {
    let mut engine = Engine::new(weightless()).unwrap();
    let body = BodyInput::dynamic(2.0, 0.2);
    let first = body.at(vec2(-2.03, 0.0)).moving(vec2(3.0, 0.0), 0.0);
    let first = engine.insert(first, &[ball(1.0)]).unwrap();
    let second = engine.insert(body, &[ball(1.0)]).unwrap();
    for _ in 0..60 {
        engine.tick();
    }
    let speeds = [first, second].map(|id| engine.velocity(id).unwrap().0);
    assert!(speeds[0].length() < 1e-12, "{speeds:?}");
    assert!((speeds[1] - vec2(3.0, 0.0)).length() < 1e-12, "{speeds:?}");
}

/// A box that lands flat leaves flat.
#[test]
fn a_box_lands_flat_and_leaves_flat() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 1.5));
    let id = engine
        .insert(body, &[unit_box().with_material(elastic(1.0))])
        .unwrap();
    for _ in 0..200 {
        engine.tick();
        assert!(engine.velocity(id).unwrap().1.abs() < 1e-6);
    }
    let (kinetic, potential) = engine.energy();
    let energy = kinetic + potential;
    assert!((energy - 1.5 * 9.81).abs() < 1e-3 * energy, "{energy} J");
}

#[test]
fn a_pyramid_with_restitution_comes_to_rest() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let ids = pyramid(&mut engine, 6, Vec2::ZERO);
    for id in &ids {
        engine.remove(*id).unwrap();
    }
    let surface = Material {
        friction: 0.6,
        restitution: 0.3,
    };
    let mut last = None;
    for row in 0..6u32 {
        for k in 0..6 - row {
            let at = vec2(
                f64::from(k) + 0.5 * f64::from(row),
                0.51 + 1.01 * f64::from(row),
            );
            let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(at);
            last = Some(
                engine
                    .insert(body, &[unit_box().with_material(surface)])
                    .unwrap(),
            );
        }
    }
    for _ in 0..300 {
        engine.tick();
    }
    assert!(engine.is_asleep(last.unwrap()).unwrap());
    assert!((engine.pose(last.unwrap()).unwrap().position - vec2(2.5, 5.5)).length() < 0.02);
}
