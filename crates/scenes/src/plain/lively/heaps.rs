//! Heaps that fall, and walls that are hit.

use core::f64::consts::PI;

use carom_math::{trig, vec2};

use super::{GRAVITY, bin, grid, mixed, mixed_rows, moving, scene, slab};
use crate::plain::harness::Harness;
use crate::plain::{PlainScene, PlainShape, resting};

/// A wall of 2,000 bricks, hit by a heavy ball.
pub(super) fn wall(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 300);
    slab(&mut scene, [0.0, -1.0], [200.0, 1.0], 0.0);
    let brick = scene.shape(PlainShape::rectangle(0.5, 0.25));
    for row in 0..40 {
        for column in 0..50 {
            let shift = 0.5 * f64::from(row % 2);
            let at = vec2(f64::from(column) + shift, 0.25 + 0.5 * f64::from(row));
            scene.place(moving(at), brick);
        }
    }
    let ball = moving(vec2(-10.0, 8.0)).moving(vec2(30.0, 3.0));
    scene.add(ball, PlainShape::Circle { radius: 2.0 });
    scene
}

/// 4,000 bodies fall onto a heap.
pub(super) fn falling(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.0], 240);
    bin(&mut scene, 30.0, 80.0);
    let mut random = Harness::new(4, &[]);
    mixed_rows(&mut scene, &mut random, 4000, 80, 0.7, vec2(-28.0, 1.0));
    scene
}

/// Sizes of 1 to 20 in one heap.
pub(super) fn sizes(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.0], 400);
    bin(&mut scene, 25.0, 80.0);
    let mut random = Harness::new(5, &[]);
    for i in 0..60 {
        let shape = mixed(&mut random, 2.0);
        scene.add(moving(grid(i, 11, [4.4, 4.4], vec2(-22.0, 5.0))), shape);
    }
    mixed_rows(&mut scene, &mut random, 3000, 120, 0.4, vec2(-23.8, 34.0));
    scene
}

/// Compound bodies of three triangles fall onto steps.
pub(super) fn compounds(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 300);
    bin(&mut scene, 20.0, 80.0);
    for i in 0..20 {
        slab(
            &mut scene,
            [-19.0 + 2.0 * f64::from(i), 0.25 * f64::from(i % 3)],
            [1.0, 0.25],
            0.0,
        );
    }
    let triangle = |turn: f64| {
        let (sin, cos) = trig::sin_cos(turn);
        let at = |x: f64, y: f64| vec2(cos * x - sin * y, sin * x + cos * y);
        PlainShape::Polygon(vec![at(0.0, 0.0), at(0.5, -0.12), at(0.5, 0.12)])
    };
    let parts = [0.0, 2.0 * PI / 3.0, 4.0 * PI / 3.0]
        .map(|turn| scene.shape(triangle(turn)))
        .to_vec();
    let mut random = Harness::new(9, &[]);
    for i in 0..1000 {
        let mut star = moving(grid(i, 33, [1.1, 1.1], vec2(-18.0, 2.0)));
        star = star.turned(random.between(0.0, 6.2));
        star.shapes.clone_from(&parts);
        scene.bodies.push(star);
    }
    scene
}

/// Long thin rods fall into a bin.
pub(super) fn rods(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.0], 300);
    bin(&mut scene, 15.0, 120.0);
    let rod = scene.shape(PlainShape::rectangle(1.0, 0.05));
    let mut random = Harness::new(11, &[]);
    for i in 0..1000 {
        let at = grid(i, 13, [2.1, 1.0], vec2(-13.0, 1.5));
        let angle = random.between(-0.2, 0.2);
        scene.place(moving(at).turned(angle), rod);
    }
    scene
}

/// A pyramid of forty rows with restitution, hit by falling balls.
pub(super) fn pyramid(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.3], 300);
    slab(&mut scene, [0.0, -1.0], [100.0, 1.0], 0.0);
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    resting::pyramid(&mut scene, unit, 40, -19.5, 0.0);
    let ball = scene.shape(PlainShape::Circle { radius: 0.4 });
    for i in 0..40 {
        let at = vec2(-19.5 + f64::from(i), 45.0 + 2.0 * f64::from(i % 7));
        scene.place(moving(at), ball);
    }
    scene
}

/// Discs alone: 4,000 in a bin.
pub(super) fn disc_heap(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.4, 0.0], 400);
    bin(&mut scene, 20.0, 80.0);
    let mut random = Harness::new(15, &[]);
    for i in 0..4000 {
        let radius = random.between(0.2, 0.35);
        // Else discs stand on each other in columns.
        let aside = vec2(random.between(-0.02, 0.02), 0.0);
        let at = grid(i, 50, [0.76, 0.76], vec2(-19.0, 1.0)) + aside;
        scene.add(moving(at), PlainShape::Circle { radius });
    }
    scene
}
