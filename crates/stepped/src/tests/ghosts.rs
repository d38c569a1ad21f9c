//! What slides over flush tiles does not feel their joints, and feels all else.

use core::f64::consts::{FRAC_PI_2, PI};

use carom_geometry::ConvexPolygon;
use carom_math::{Vec2, trig, vec2};

use super::{unit_box, with_friction};
use crate::{BodyId, BodyInput, Engine, PieceInput, Settings};

/// A box of 1 m at `speed` on `count` tiles with tops from 0 upwards, each `step` higher than the one before.
fn tiles(speed: f64, count: u32, step: f64) -> (Engine, BodyId) {
    let slider = ConvexPolygon::square(1.0).unwrap();
    on_tiles(slider, 0.5 + 2.6 * step, speed, (count, step))
}

/// The same of a polygon, with its centre of mass at `height`.
fn on_tiles(
    slider: ConvexPolygon,
    height: f64,
    speed: f64,
    (count, step): (u32, f64),
) -> (Engine, BodyId) {
    let mut engine = Engine::new(Settings::default()).unwrap();
    for k in (0..count).rev() {
        let at = vec2(f64::from(k) - 2.0, -0.5 + step * f64::from(k));
        let piece = PieceInput::new(ConvexPolygon::rectangle(1.0, 1.0).unwrap());
        let body = BodyInput::fixed().at(at);
        engine.insert(body, &[with_friction(piece, 0.0)]).unwrap();
    }
    let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, height));
    let slider = with_friction(PieceInput::new(slider), 0.0);
    let id = engine
        .insert(body.moving(vec2(speed, 0.0), 0.0), &[slider])
        .unwrap();
    (engine, id)
}

#[test]
fn a_box_keeps_its_speed_over_flush_tiles() {
    for speed in [0.1, 0.5, 5.0, 50.0, 150.0] {
        let (mut engine, id) = tiles(speed, 200, 0.0);
        let ticks = if speed > 10.0 { 70 } else { 240 };
        for _ in 0..ticks {
            engine.tick();
        }
        let (v, w) = engine.velocity(id).unwrap();
        assert!(
            (v.x - speed).abs() < 1e-6 * speed && w.abs() < 1e-6,
            "{speed} m/s became {v}, {w}"
        );
    }
}

/// The flank behind a corner that slides on the tiles slants away from the next one: rows had their points beside its side, which
/// nothing seemed to hide. A hexagon at 1 m/s was stopped by the first seam.
#[test]
fn polygons_with_flanks_keep_their_speeds_over_flush_tiles() {
    let regular = (3..=8).map(|n| {
        let corner = |k: usize| {
            let (sin, cos) = trig::sin_cos(-FRAC_PI_2 + PI * (2 * k + 1) as f64 / n as f64);
            vec2(cos, sin) * 0.5
        };
        (0..n).map(corner).collect()
    });
    let chamfered = [0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 3.0].map(|slope| {
        let (low, high) = (-0.3, 0.2 * slope - 0.3);
        [
            (-0.3, low),
            (0.3, low),
            (0.5, high),
            (0.5, high + 0.6),
            (-0.5, high + 0.6),
            (-0.5, high),
        ]
        .map(|(x, y)| vec2(x, y))
        .to_vec()
    });
    for corners in regular.chain(chamfered) {
        let corners: Vec<Vec2> = corners;
        let slider = ConvexPolygon::new(corners.clone()).unwrap();
        let height = -corners.iter().map(|corner| corner.y).fold(0.0, f64::min);
        for speed in [0.5, 1.0, 5.0, 20.0, 60.0] {
            let (mut engine, id) = on_tiles(slider.clone(), height, speed, (120, 0.0));
            for _ in 0..100 {
                engine.tick();
            }
            let (v, w) = engine.velocity(id).unwrap();
            assert!(
                (v.x - speed).abs() < 1e-6 * speed && w.abs() < 1e-3,
                "{} corners, {speed} m/s became {v}, {w}",
                corners.len()
            );
        }
    }
}

#[test]
fn a_box_is_stopped_by_a_step() {
    let (mut engine, id) = tiles(1.0, 20, 0.02);
    for _ in 0..240 {
        engine.tick();
    }
    let at = engine.pose(id).unwrap().position;
    assert!(at.x < 1.0, "it climbed to {at}");
}

/// The inner corner of tiles and a wall, the last tile, and a ditch.
#[test]
fn walls_ends_and_ditches_stay() {
    let (mut engine, id) = tiles(3.0, 10, 0.0);
    let wall = PieceInput::new(ConvexPolygon::rectangle(1.0, 4.0).unwrap());
    let wall = engine
        .insert(
            BodyInput::fixed().at(vec2(5.0, 2.0)),
            &[with_friction(wall, 0.0)],
        )
        .unwrap();
    for _ in 0..180 {
        engine.tick();
    }
    let at = engine.pose(id).unwrap().position;
    assert!(
        (at.x - 4.0).abs() < 0.01,
        "the wall is at 4.5 m, the box at {at}"
    );
    engine.remove(wall).unwrap();
    engine.set_velocity(id, vec2(3.0, 0.0), 0.0).unwrap();
    for _ in 0..180 {
        engine.tick();
    }
    let at = engine.pose(id).unwrap().position;
    assert!(
        at.x > 8.0 && at.y < -1.0,
        "it falls off the last tile, and is at {at}"
    );

    // A ditch as wide as two tiles, with walls a tile high.
    let mut engine = Engine::new(Settings::default()).unwrap();
    for (x, y) in [
        (-2.0, -0.5),
        (-1.0, -0.5),
        (0.0, -1.5),
        (1.0, -1.5),
        (2.0, -0.5),
        (3.0, -0.5),
    ] {
        let tile = with_friction(unit_box(), 0.0);
        engine
            .insert(BodyInput::fixed().at(vec2(x, y)), &[tile])
            .unwrap();
    }
    let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, -0.5));
    let small = with_friction(PieceInput::new(ConvexPolygon::square(1.0).unwrap()), 0.0);
    let id = engine
        .insert(body.moving(vec2(2.0, 0.0), 0.0), &[small])
        .unwrap();
    for _ in 0..120 {
        engine.tick();
    }
    let at = engine.pose(id).unwrap().position;
    assert!(
        (at - vec2(1.0, -0.5)).length() < 0.01,
        "it stands in the corner of the ditch, and is at {at}"
    );
}

/// Boxes side by side are as good as tiles, also where they move along together.
#[test]
fn a_box_keeps_its_speed_over_boxes_that_slide_side_by_side() {
    for speed in [0.5, 2.0, 5.0] {
        let mut engine = Engine::new(Settings::default()).unwrap();
        let floor = PieceInput::new(ConvexPolygon::rectangle(200.0, 1.0).unwrap());
        engine
            .insert(
                BodyInput::fixed().at(vec2(0.0, -0.5)),
                &[with_friction(floor, 0.0)],
            )
            .unwrap();
        let smooth = with_friction(unit_box(), 0.0);
        let along = vec2(3.0, 0.0);
        for k in 0..20 {
            let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(f64::from(k), 0.5));
            let body = body.moving(along, 0.0);
            engine.insert(body, core::slice::from_ref(&smooth)).unwrap();
        }
        let body = BodyInput::dynamic(0.01, 0.01 / 6.0).at(vec2(0.0, 1.5));
        let velocity = along + vec2(speed, 0.0);
        let id = engine
            .insert(body.moving(velocity, 0.0), &[smooth])
            .unwrap();
        for _ in 0..150 {
            engine.tick();
        }
        let (v, w) = engine.velocity(id).unwrap();
        assert!(
            (v.x - velocity.x).abs() < 0.01 * speed && w.abs() < 0.01,
            "{velocity} became {v}, {w}"
        );
    }
}
