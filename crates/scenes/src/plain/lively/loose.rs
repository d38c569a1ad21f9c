//! Bodies that strike each other in the air, or in space.

use carom_math::{Vec2, trig, vec2};

use super::{GRAVITY, bin, body, grid, mixed, mixed_rows, moving, scene, slab};
use crate::plain::harness::Harness;
use crate::plain::{PlainKind, PlainScene, PlainShape};

/// 2,000 bodies fly apart from one place in a closed box.
pub(super) fn explosion(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.4, 0.2], 300);
    bin(&mut scene, 40.0, 80.0);
    slab(&mut scene, [0.0, 81.0], [42.0, 1.0], 0.0);
    let mut random = Harness::new(2, &[]);
    let first = scene.bodies.len();
    mixed_rows(&mut scene, &mut random, 2000, 45, 0.5, vec2(-11.0, 25.0));
    for body in &mut scene.bodies[first..] {
        body.velocity = 1.5 * (body.position - vec2(0.0, 36.0));
    }
    scene
}

/// Balls that bounce on each other in a bin.
pub(super) fn bouncing(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.3, 0.7], 400);
    bin(&mut scene, 25.0, 120.0);
    let mut random = Harness::new(12, &[]);
    for i in 0..2000 {
        let at = grid(i, 40, [1.2, 1.2], vec2(-24.0, 3.0));
        let radius = random.between(0.2, 0.5);
        let velocity = random.within(3.0);
        scene.add(moving(at).moving(velocity), PlainShape::Circle { radius });
    }
    scene
}

/// Discs without gravity that lose speed when they meet: a broken rack of 1,275.
pub(super) fn rack(name: &str) -> PlainScene {
    let mut scene = scene(name, Vec2::ZERO, [0.1, 0.9], 300);
    bin(&mut scene, 60.0, 80.0);
    slab(&mut scene, [0.0, 81.0], [62.0, 1.0], 0.0);
    let disc = scene.shape(PlainShape::Circle { radius: 0.4 });
    for row in 0..50 {
        for column in 0..=row {
            let y = 40.0 + 0.81 * (f64::from(column) - 0.5 * f64::from(row));
            scene.place(moving(vec2(0.7 * f64::from(row), y)), disc);
        }
    }
    scene.place(moving(vec2(-30.0, 40.1)).moving(vec2(60.0, 0.0)), disc);
    scene
}

/// A cloud of 1,500 bodies without gravity runs into another.
pub(super) fn clouds(name: &str) -> PlainScene {
    let mut scene = scene(name, Vec2::ZERO, [0.4, 0.1], 300);
    let mut random = Harness::new(16, &[]);
    for side in [-1.0, 1.0] {
        let first = scene.bodies.len();
        mixed_rows(
            &mut scene,
            &mut random,
            1500,
            30,
            0.6,
            vec2(side * 20.0 - 9.0, -15.0),
        );
        for body in &mut scene.bodies[first..] {
            body.velocity = vec2(-side * 8.0, 0.0);
        }
    }
    scene
}

/// Discs fall through pins.
pub(super) fn pins(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.1, 0.4], 600);
    bin(&mut scene, 15.0, 120.0);
    let pin = scene.shape(PlainShape::Circle { radius: 0.15 });
    for row in 0..30 {
        for column in 0..29 {
            let x = f64::from(column) - 14.0 + 0.5 * f64::from(row % 2) - 0.25;
            scene.place(body(PlainKind::Fixed, x, 8.0 + f64::from(row)), pin);
        }
    }
    let disc = scene.shape(PlainShape::Circle { radius: 0.2 });
    let mut random = Harness::new(10, &[]);
    for i in 0..1500 {
        let aside = vec2(random.between(-0.02, 0.02), 0.0);
        let at = grid(i, 50, [0.5, 0.6], vec2(-12.5, 40.0)) + aside;
        scene.place(moving(at), disc);
    }
    scene
}

/// Bodies roll and slide down a stair of slopes of segments.
pub(super) fn slopes(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.2, 0.1], 600);
    bin(&mut scene, 20.0, 120.0);
    for i in 0..6 {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        for part in 0..12 {
            let at = |k: f64| {
                let x = -20.0 + 3.0 * k;
                vec2(side * x, 42.0 - 6.0 * f64::from(i) - 0.9 * k)
            };
            let ends = [at(f64::from(part)), at(f64::from(part) + 1.0)];
            scene.add(body(PlainKind::Fixed, 0.0, 0.0), PlainShape::Segment(ends));
        }
    }
    let mut random = Harness::new(13, &[]);
    mixed_rows(&mut scene, &mut random, 1500, 30, 0.6, vec2(-19.0, 44.0));
    scene
}

/// 1,500 bodies rain on hills of 400 segments, and roll into the valleys.
pub(super) fn hills(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.4, 0.2], 300);
    let at = |k: f64| {
        let height = 3.0 * trig::sin_cos(0.1 * k).0 + 0.4 * trig::sin_cos(0.73 * k).0;
        vec2(k, height)
    };
    for k in 0..400 {
        let ends = [at(f64::from(k)), at(f64::from(k + 1))];
        scene.add(body(PlainKind::Fixed, 0.0, 0.0), PlainShape::Segment(ends));
    }
    let mut random = Harness::new(26, &[]);
    for i in 0..1500 {
        let at = grid(i, 300, [1.3, 0.9], vec2(2.0, 6.0));
        let shape = mixed(&mut random, 0.35);
        scene.add(moving(at).turned(random.between(0.0, 6.0)), shape);
    }
    scene
}
