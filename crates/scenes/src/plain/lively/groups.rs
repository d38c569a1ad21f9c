//! Many groups of a few bodies that meet again and again.

use carom_math::{Vec2, trig, vec2};

use super::{GRAVITY, body, grid, mixed, moving, scene, slab};
use crate::plain::harness::Harness;
use crate::plain::{PlainKind, PlainScene, PlainShape};

fn on_a_floor(name: &str, material: [f64; 2], steps: u32) -> PlainScene {
    let mut scene = scene(name, GRAVITY, material, steps);
    slab(&mut scene, [0.0, -1.0], [4000.0, 1.0], 0.0);
    scene
}

/// Two hundred cups, ten bodies fall into each.
pub(super) fn cups(name: &str) -> PlainScene {
    let mut scene = on_a_floor(name, [0.5, 0.1], 240);
    let wall = scene.shape(PlainShape::rectangle(0.1, 1.5));
    let mut random = Harness::new(24, &[]);
    for i in 0..200 {
        let x = -600.0 + 6.0 * f64::from(i);
        for side in [-1.2, 1.2] {
            scene.place(body(PlainKind::Fixed, x + side, 1.5), wall);
        }
        for k in 0..10 {
            let aside = random.between(-0.1, 0.1);
            let at = grid(k, 2, [0.8, 0.7], vec2(x - 0.4 + aside, 1.0));
            let shape = mixed(&mut random, 0.3);
            scene.add(moving(at).turned(random.between(0.0, 6.0)), shape);
        }
    }
    scene
}

/// A hundred frames turn, with ten bodies in each.
pub(super) fn tumblers(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.1], 300);
    let sides = [
        (vec2(1.6, 0.1), vec2(0.0, 1.5)),
        (vec2(1.6, 0.1), vec2(0.0, -1.5)),
        (vec2(0.1, 1.6), vec2(1.5, 0.0)),
        (vec2(0.1, 1.6), vec2(-1.5, 0.0)),
    ];
    let sides = sides.map(|(half, offset)| scene.shape(PlainShape::Box { half, offset }));
    let mut random = Harness::new(25, &[]);
    for i in 0..100 {
        let at = grid(i, 10, [6.0; 2], Vec2::ZERO);
        let spin = random.between(0.5, 1.5);
        let mut frame = body(PlainKind::Kinematic, at.x, at.y).spinning(spin);
        frame.shapes = sides.to_vec();
        scene.bodies.push(frame);
        for k in 0..10 {
            let shape = mixed(&mut random, 0.25);
            scene.add(moving(grid(k, 3, [0.8, 0.6], at - 0.8)), shape);
        }
    }
    scene
}

/// A hundred towers of twelve boxes, a ball hits each.
pub(super) fn towers(name: &str) -> PlainScene {
    let mut scene = on_a_floor(name, [0.5, 0.0], 240);
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    let ball = scene.shape(PlainShape::Circle { radius: 0.5 });
    for i in 0..100 {
        let x = -1000.0 + 20.0 * f64::from(i);
        for k in 0..12 {
            scene.place(moving(vec2(x, 0.5 + f64::from(k))), unit);
        }
        let thrown = vec2(x - 4.0, 6.0 + 0.03 * f64::from(i));
        scene.place(moving(thrown).moving(vec2(12.0, 2.0)), ball);
    }
    scene
}

/// Three hundred houses of cards fall down: three pairs that lean on each other, and one across.
pub(super) fn cards(name: &str) -> PlainScene {
    let mut scene = on_a_floor(name, [0.8, 0.0], 240);
    let card = scene.shape(PlainShape::rectangle(0.02, 0.5));
    let tilt = 0.3;
    let (sin, cos) = trig::sin_cos(tilt);
    for i in 0..300 {
        let x = -900.0 + 6.0 * f64::from(i);
        for k in 0..3 {
            for side in [-1.0, 1.0] {
                let foot = x + 0.75 * f64::from(k);
                let at = vec2(
                    foot - side * (0.5 * sin + 0.03),
                    0.5 * cos + 0.02 * sin + 0.002,
                );
                scene.place(moving(at).turned(-tilt * side), card);
            }
        }
        let across = moving(vec2(x + 0.75, 1.02));
        scene.place(across.turned(core::f64::consts::FRAC_PI_2), card);
    }
    scene
}

/// A thousand polygons are thrown along a floor, and roll.
pub(super) fn tossed(name: &str) -> PlainScene {
    let mut scene = on_a_floor(name, [0.6, 0.2], 300);
    let mut random = Harness::new(21, &[]);
    for i in 0..1000 {
        let corners = 3 + random.below(6);
        let shape = PlainShape::Polygon(random.polygon(corners, 0.4));
        let at = vec2(-1500.0 + 3.0 * f64::from(i), 1.0 + random.between(0.0, 1.0));
        let along = vec2(random.between(-6.0, 6.0), 0.0);
        let thrown = moving(at).moving(along).spinning(random.between(-5.0, 5.0));
        scene.add(thrown, shape);
    }
    scene
}

/// A thousand bars come down spinning at up to 40 rad/s.
pub(super) fn spun_bars(name: &str) -> PlainScene {
    let mut scene = on_a_floor(name, [0.6, 0.3], 300);
    let bar = scene.shape(PlainShape::rectangle(0.5, 0.1));
    let mut random = Harness::new(31, &[]);
    for i in 0..1000 {
        let at = vec2(-1500.0 + 3.0 * f64::from(i), 2.0 + random.between(0.0, 2.0));
        scene.place(moving(at).spinning(random.between(-40.0, 40.0)), bar);
    }
    scene
}

/// A hundred walls of ten bricks, five bullets of 100 m/s hit each.
pub(super) fn bullets(name: &str) -> PlainScene {
    let mut scene = on_a_floor(name, [0.5, 0.1], 200);
    let brick = scene.shape(PlainShape::rectangle(0.25, 0.5));
    let ball = scene.shape(PlainShape::Circle { radius: 0.1 });
    for i in 0..100 {
        let x = -1000.0 + 20.0 * f64::from(i);
        for k in 0..10 {
            let at = vec2(x + 0.55 * f64::from(k / 5), 0.5 + f64::from(k % 5));
            scene.place(moving(at), brick);
        }
        for k in 0..5 {
            let at = vec2(x - 6.0 - 2.0 * f64::from(k), 0.6 + 0.9 * f64::from(k));
            let mut bullet = moving(at).moving(vec2(100.0, 0.5));
            bullet.bullet = true;
            scene.place(bullet, ball);
        }
    }
    scene
}
