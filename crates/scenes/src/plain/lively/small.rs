//! Many small islands.

use carom_math::{trig, vec2};

use super::{GRAVITY, body, moving, scene, slab};
use crate::plain::harness::Harness;
use crate::plain::{PlainKind, PlainScene, PlainShape};

/// A thousand stacks of five land one after the other.
pub(super) fn landing_stacks(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 240);
    slab(&mut scene, [0.0, -1.0], [2000.0, 1.0], 0.0);
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    for i in 0..1000 {
        for row in 0..5 {
            let lift = 0.5 + 0.01 * f64::from(i % 200);
            let y = lift + 0.5 + 1.02 * f64::from(row);
            scene.place(moving(vec2(-1500.0 + 3.0 * f64::from(i), y)), unit);
        }
    }
    scene
}

/// A thousand boxes rock on their corners.
pub(super) fn rocking(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 240);
    slab(&mut scene, [0.0, -1.0], [2000.0, 1.0], 0.0);
    let tall = scene.shape(PlainShape::rectangle(0.3, 0.6));
    for i in 0..1000 {
        let tilt = 0.02 + 0.0003 * f64::from(i);
        let (sin, cos) = trig::sin_cos(tilt);
        let height = 0.3 * sin + 0.6 * cos;
        let at = vec2(-1500.0 + 3.0 * f64::from(i), height);
        scene.place(moving(at).turned(tilt), tall);
    }
    scene
}

/// A thousand seesaws with two loads.
pub(super) fn seesaws(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 240);
    slab(&mut scene, [0.0, -1.0], [4000.0, 1.0], 0.0);
    let pivot = scene.shape(PlainShape::Circle { radius: 0.5 });
    let plank = scene.shape(PlainShape::rectangle(2.0, 0.1));
    let load = scene.shape(PlainShape::rectangle(0.3, 0.3));
    for i in 0..1000 {
        let x = -2500.0 + 5.0 * f64::from(i);
        scene.place(body(PlainKind::Fixed, x, 0.5), pivot);
        scene.place(moving(vec2(x, 1.1)), plank);
        scene.place(moving(vec2(x - 1.5, 1.5)), load);
        let falls = vec2(x + 1.2, 1.6 + 0.002 * f64::from(i));
        scene.place(moving(falls), load);
    }
    scene
}

/// A hundred platforms carry five boxes each.
pub(super) fn platforms(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 300);
    let plate = scene.shape(PlainShape::rectangle(4.0, 0.25));
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    for i in 0..100 {
        let y = 6.0 * f64::from(i);
        let plate_at =
            body(PlainKind::Kinematic, 0.0, y).moving(vec2(1.0 + 0.03 * f64::from(i), 0.0));
        scene.place(plate_at, plate);
        for k in 0..5 {
            let at = vec2(0.1 * f64::from(k), y + 0.75 + f64::from(k));
            scene.place(moving(at), unit);
        }
    }
    scene
}

/// Rows of dominoes, the first of each pushed.
pub(super) fn dominoes(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.0], 400);
    let domino = scene.shape(PlainShape::rectangle(0.1, 0.5));
    for row in 0..10 {
        let y = 5.0 * f64::from(row);
        slab(&mut scene, [50.0, y - 0.5], [60.0, 0.5], 0.0);
        for i in 0..150 {
            let mut stone = moving(vec2(0.6 * f64::from(i), y + 0.5));
            if i == 0 {
                stone = stone.spinning(-2.0).moving(vec2(1.0, 0.0));
            }
            scene.place(stone, domino);
        }
    }
    scene
}

/// Five hundred bodies slide over tiles without friction.
pub(super) fn tiles(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.0, 0.0], 300);
    let tile = scene.shape(PlainShape::rectangle(0.5, 0.25));
    for row in 0..10 {
        let y = 4.0 * f64::from(row);
        for i in 0..300 {
            scene.place(body(PlainKind::Fixed, f64::from(i), y - 0.25), tile);
        }
    }
    let mut random = Harness::new(14, &[]);
    for i in 0..500 {
        let (w, h) = (random.between(0.2, 0.4), random.between(0.2, 0.4));
        let at = vec2(2.0 + 2.0 * f64::from(i % 50), 4.0 * f64::from(i / 50) + h);
        let speed = random.between(1.0, 5.0);
        let slides = moving(at).moving(vec2(speed, 0.0));
        scene.add(slides, PlainShape::rectangle(w, h));
    }
    scene
}
