//! Boxes in rows, stacks and drums: scenes of lasting contacts, none of them random.

use carom_math::{Vec2, vec2};

use super::{PlainBody, PlainKind, PlainScene, PlainShape};

const GRAVITY: Vec2 = vec2(0.0, -10.0);

/// A dynamic body at rest at (x, y), of the first material.
fn resting(x: f64, y: f64) -> PlainBody {
    PlainBody::new(PlainKind::Dynamic, vec2(x, y), 0)
}

/// A fixed body at (x, y), of the first material.
fn fixed(x: f64, y: f64) -> PlainBody {
    PlainBody::new(PlainKind::Fixed, vec2(x, y), 0)
}

/// Rows of unit boxes on each other, each one box shorter than the one below.
pub(super) fn pyramid(scene: &mut PlainScene, unit: usize, rows: u32, left: f64, ground: f64) {
    for row in 0..rows {
        for column in 0..rows - row {
            let x = left + 0.5 * f64::from(row) + f64::from(column);
            let y = ground + 0.5 + f64::from(row);
            scene.place(resting(x, y), unit);
        }
    }
}

pub(super) fn large_pyramid(name: &str) -> PlainScene {
    let mut scene = PlainScene::empty(name, GRAVITY).steps(50, 300);
    scene.material(1.0, 0.6, 0.0);
    scene.add(fixed(0.0, -1.0), PlainShape::rectangle(100.0, 1.0));
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    pyramid(&mut scene, unit, 100, -49.5, 0.0);
    scene
}

pub(super) fn many_pyramids(name: &str) -> PlainScene {
    let mut scene = PlainScene::empty(name, GRAVITY).steps(30, 120);
    scene.material(1.0, 0.6, 0.0);
    let mut unit = None;
    for floor in 0..20 {
        let y = 11.0 * f64::from(floor);
        let ground = PlainShape::Segment([vec2(-110.0, y), vec2(110.0, y)]);
        scene.add(fixed(0.0, 0.0), ground);
        // The table's second shape, after the first floor.
        let unit = *unit.get_or_insert_with(|| scene.shape(PlainShape::rectangle(0.5, 0.5)));
        for i in 0..20 {
            pyramid(&mut scene, unit, 10, -109.0 + 11.0 * f64::from(i), y);
        }
    }
    scene
}

pub(super) fn smash(name: &str) -> PlainScene {
    let mut scene = PlainScene::empty(name, Vec2::ZERO).steps(75, 225);
    scene.sleeping = true;
    scene.material(8.0, 0.6, 0.0);
    let light = scene.material(1.0, 0.6, 0.0);
    let bullet = resting(-20.0, 0.0).moving(vec2(40.0, 0.0));
    scene.add(bullet, PlainShape::rectangle(4.0, 4.0));
    let small = scene.shape(PlainShape::rectangle(0.2, 0.2));
    for column in 0..120 {
        for row in 0..80 {
            let at = vec2(30.0 + 0.4 * f64::from(column), 0.4 * f64::from(row - 40));
            let mut sleeper = PlainBody::new(PlainKind::Dynamic, at, light);
            sleeper.asleep = true;
            scene.place(sleeper, small);
        }
    }
    scene
}

pub(super) fn tumbler(name: &str) -> PlainScene {
    let mut scene = PlainScene::empty(name, GRAVITY).steps(200, 300);
    scene.sleeping = true;
    scene.region = Some([vec2(-15.0, -5.0), vec2(15.0, 25.0)]);
    scene.material(1.0, 0.6, 0.0);
    let degrees = 25.0;
    let spin = degrees * core::f64::consts::PI / 180.0;
    drum(&mut scene, vec2(0.0, 10.0), 10.0, spin);
    let small = scene.shape(PlainShape::rectangle(0.125, 0.125));
    for row in 0..45 {
        for column in 0..45 {
            let (x, y) = (0.4 * f64::from(column), 0.4 * f64::from(row));
            scene.place(resting(-9.0 + x, 1.0 + y), small);
        }
    }
    scene
}

/// A square drum that turns about its centre, of half the width `half` in m.
pub(super) fn drum(scene: &mut PlainScene, centre: Vec2, half: f64, spin: f64) {
    let wall = |half: Vec2, offset: Vec2| PlainShape::Box { half, offset };
    let walls = [
        wall(vec2(0.5, half), vec2(half, 0.0)),
        wall(vec2(0.5, half), vec2(-half, 0.0)),
        wall(vec2(half, 0.5), vec2(0.0, half)),
        wall(vec2(half, 0.5), vec2(0.0, -half)),
    ];
    let mut drum = PlainBody::new(PlainKind::Kinematic, centre, 0).spinning(spin);
    drum.shapes = walls.map(|wall| scene.shape(wall)).to_vec();
    scene.bodies.push(drum);
}

pub(super) fn mostly_sleeping(name: &str) -> PlainScene {
    let mut scene = PlainScene::empty(name, GRAVITY).steps(400, 300);
    scene.sleeping = true;
    scene.material(1.0, 0.6, 0.0);
    let elastic = scene.material(1.0, 0.0, 1.0);
    scene.add(fixed(0.0, -1.0), PlainShape::rectangle(1600.0, 1.0));
    let mut court = fixed(1700.0, -1.0);
    court.material = elastic;
    scene.add(court, PlainShape::rectangle(60.0, 1.0));
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    let disc = scene.shape(PlainShape::Circle { radius: 0.5 });
    for stack in 0..1000 {
        for row in 0..10 {
            let x = -1500.0 + 3.0 * f64::from(stack);
            scene.place(resting(x, 0.5 + f64::from(row)), unit);
        }
    }
    for i in 0..20 {
        let mut ball = resting(1660.0 + 4.0 * f64::from(i), 5.0 + 0.37 * f64::from(i));
        ball.material = elastic;
        scene.place(ball, disc);
    }
    scene
}
