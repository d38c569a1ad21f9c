//! Impacts as callers see them.

use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Vec2, vec2};

use super::{floor, pyramid, weightless, without_sleep};
use crate::{BodyInput, Engine, Impact, Material, Mixed, PieceInput, Settings};

/// Impacts of so many ticks, and when each surface was met, in s.
fn impacts(engine: &mut Engine, ticks: u32) -> Vec<(f64, Impact)> {
    engine.note_impacts(true);
    let h = engine.settings().tick / f64::from(engine.settings().substeps);
    let (mut told, mut now, mut found) = (Vec::new(), 0.0, Vec::new());
    for _ in 0..ticks * engine.settings().substeps {
        engine.substep(&Mixed);
        now += h;
        engine.impacts(&mut found);
        told.extend(found.drain(..).map(|impact| (now - impact.since, impact)));
    }
    told
}

fn surface(restitution: f64, friction: f64) -> Material {
    Material {
        friction,
        restitution,
    }
}

/// A body of 2 kg that falls from 1 m, and what the floor tells of its first impact: speed, time, impulse, place.
#[test]
fn a_landing_is_told_with_its_speed_and_impulse() {
    let shapes = [
        PieceInput::new(Circle::new(0.5).unwrap()),
        PieceInput::new(ConvexPolygon::square(1.0).unwrap()),
    ];
    for shape in shapes {
        for e in [0.0, 0.1, 0.3, 0.5, 0.8, 1.0] {
            for height in [0.1, 1.0, 1.013, 30.0] {
                // A rebound no higher than a sub-step's fall is not resolved.
                if e > 0.0 && e * e * height < 0.005 {
                    continue;
                }
                let mut engine = Engine::new(without_sleep()).unwrap();
                floor(&mut engine);
                let body = BodyInput::dynamic(2.0, 0.2).at(vec2(0.3, 0.5 + height));
                let piece = shape.clone().with_material(surface(e, 0.5));
                engine.insert(body, &[piece]).unwrap();
                let g = 9.81;
                let (speed, time) = ((2.0 * g * height).sqrt(), (2.0 * height / g).sqrt());
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "few"
                )]
                let ticks = (60.0 * time) as u32 + 3;
                let told = impacts(&mut engine, ticks);
                let what = format!("e = {e}, {height} m: {told:?}");
                let (when, impact) = &told[0];
                // A fast landing may shake off a hundredth.
                assert!(
                    told[1..]
                        .iter()
                        .all(|(_, other)| other.speed < 0.01 * speed),
                    "{what}"
                );
                let h = engine.settings().substep();
                assert!((impact.speed - speed).abs() < g * h, "{what}");
                assert!((when - time).abs() < h, "{what}");
                // It turns back up to a sub-step's way above the floor, with the energy that it has there.
                let high = e * e * speed * speed - 2.0 * g * speed * h;
                let early = e * speed - high.max(0.0).sqrt();
                let (impulse, near) = (2.0 * (1.0 + e) * speed, 2.0 * (2.0 * g * h + early));
                assert!((impact.normal_impulse - impulse).abs() < near, "{what}");
                assert!(impact.tangential_impulse.abs() < 1e-9, "{what}");
                // The floor was inserted first.
                assert!((impact.normal - Vec2::Y).length() < 1e-12, "{what}");
                assert!(
                    (impact.place - vec2(0.3, 0.0)).length() < speed * h,
                    "{what}"
                );
            }
        }
    }
}

#[test]
fn what_rests_tells_of_no_impact() {
    let mut engine = Engine::new(without_sleep()).unwrap();
    floor(&mut engine);
    pyramid(&mut engine, 10, Vec2::ZERO);
    assert_eq!(impacts(&mut engine, 300), []);
}

/// A ball of 1 kg at 3 m/s strikes the first of five that touch: each pair tells of one impact, or none.
#[test]
fn a_blow_through_a_row_is_told_pair_by_pair() {
    let mut engine = Engine::new(weightless()).unwrap();
    let ball = [PieceInput::new(Circle::new(0.5).unwrap()).with_material(surface(0.0, 0.0))];
    let body = BodyInput::dynamic(1.0, 0.125);
    let first = body.at(vec2(-1.5, 0.0)).moving(vec2(3.0, 0.0), 0.0);
    engine.insert(first, &ball).unwrap();
    for k in 0..5 {
        engine
            .insert(body.at(vec2(f64::from(k), 0.0)), &ball)
            .unwrap();
    }
    let told = impacts(&mut engine, 30);
    assert!(!told.is_empty() && told.len() <= 5, "{told:?}");
    let (when, impact) = &told[0];
    assert!((impact.speed - 3.0).abs() < 1e-9, "{impact:?}");
    assert!((when - 0.5 / 3.0).abs() < 1e-3, "{when} s");
    // What the first ball lost at once; it loses more while the blow goes on.
    let left = engine.velocity(impact.bodies[0]).unwrap().0.x;
    let impulse = impact.normal_impulse;
    assert!(1.4 < impulse && impulse < 3.0 - left, "{impact:?} {left}");
}

/// Friction of a landing that slides: µ times the normal impulse.
#[test]
fn a_landing_aslant_tells_of_friction() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let body = BodyInput::dynamic(1.0, 1e3).at(vec2(0.0, 1.0));
    let piece = PieceInput::new(Circle::new(0.5).unwrap()).with_material(surface(0.0, 0.2));
    engine
        .insert(body.moving(vec2(8.0, 0.0), 0.0), &[piece])
        .unwrap();
    let told = impacts(&mut engine, 30);
    assert_eq!(told.len(), 1, "{told:?}");
    let impact = &told[0].1;
    // Along the normal turned by +90°, which is against x.
    let friction = (0.6f64 * 0.2).sqrt() * impact.normal_impulse;
    assert!(
        (impact.tangential_impulse - friction).abs() < 0.02 * friction,
        "{impact:?}"
    );
}
