//! Scenes in which much moves: built by rule, of the kinds that engines are asked for. No number was chosen for one of them.

use core::f64::consts::PI;

use carom_math::{Vec2, trig, vec2};

use super::harness::Harness;
use super::{PlainBody, PlainKind, PlainScene, PlainShape};

const GRAVITY: Vec2 = vec2(0.0, -10.0);

/// A scene of one material in which bodies may sleep.
fn scene(name: &str, gravity: Vec2, material: [f64; 2], steps: u32) -> PlainScene {
    let mut scene = PlainScene::empty(name, gravity).steps(1, steps);
    scene.sleeping = true;
    scene.material(1.0, material[0], material[1]);
    scene
}

fn body(kind: PlainKind, x: f64, y: f64) -> PlainBody {
    PlainBody::new(kind, vec2(x, y), 0)
}

fn moving(x: f64, y: f64) -> PlainBody {
    body(PlainKind::Dynamic, x, y)
}

/// A fixed rectangle by its centre, its half extents and its angle.
fn slab(scene: &mut PlainScene, [x, y]: [f64; 2], [w, h]: [f64; 2], angle: f64) {
    let at = body(PlainKind::Fixed, x, y).turned(angle);
    scene.add(at, PlainShape::rectangle(w, h));
}

/// Floor at y = 0 and walls at ±`inner`, `height` high.
fn bin(scene: &mut PlainScene, inner: f64, height: f64) {
    slab(scene, [0.0, -1.0], [inner + 2.0, 1.0], 0.0);
    for side in [-1.0, 1.0] {
        slab(
            scene,
            [side * (inner + 1.0), 0.5 * height],
            [1.0, 0.5 * height],
            0.0,
        );
    }
    scene.region = Some([vec2(-inner - 0.5, -0.5), vec2(inner + 0.5, 1e4)]);
}

/// A disc, a rectangle or a polygon about as large as a disc of `radius`.
fn mixed(random: &mut Harness, radius: f64) -> PlainShape {
    match random.below(3) {
        0 => PlainShape::Circle { radius },
        1 => PlainShape::rectangle(
            radius * random.between(0.5, 1.0),
            radius * random.between(0.5, 1.0),
        ),
        _ => {
            let corners = 3 + random.below(6);
            PlainShape::Polygon(random.polygon(corners, radius))
        }
    }
}

/// `count` mixed bodies in rows of `columns`, `pitch` apart, the lowest left one at `corner`.
fn crowd(
    scene: &mut PlainScene,
    random: &mut Harness,
    count: u32,
    columns: u32,
    pitch: f64,
    corner: Vec2,
) {
    for i in 0..count {
        let at = corner + pitch * vec2(f64::from(i % columns), f64::from(i / columns));
        let radius = pitch * random.between(0.25, 0.45);
        let shape = mixed(random, radius);
        let angle = random.between(0.0, 6.2);
        scene.add(moving(at.x, at.y).turned(angle), shape);
    }
}

/// 2,000 discs and polygons run through the neck of a funnel into a bin.
pub(super) fn hourglass(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.3, 0.0], 600);
    bin(&mut scene, 12.0, 60.0);
    for side in [-1.0, 1.0] {
        slab(&mut scene, [side * 7.2, 20.0], [8.5, 0.3], side * 0.7);
    }
    let mut random = Harness::new(1, &[]);
    crowd(&mut scene, &mut random, 2000, 40, 0.5, vec2(-9.75, 28.0));
    scene
}

/// A wall of 2,000 bricks, hit by a heavy ball.
pub(super) fn wall(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 300);
    slab(&mut scene, [0.0, -1.0], [200.0, 1.0], 0.0);
    let brick = scene.shape(PlainShape::rectangle(0.5, 0.25));
    for row in 0..40 {
        for column in 0..50 {
            let shift = 0.5 * f64::from(row % 2);
            scene.place(
                moving(f64::from(column) + shift, 0.25 + 0.5 * f64::from(row)),
                brick,
            );
        }
    }
    let ball = moving(-10.0, 8.0).moving(vec2(30.0, 3.0));
    scene.add(ball, PlainShape::Circle { radius: 2.0 });
    scene
}

/// 2,000 bodies fly apart from one place in a closed box.
pub(super) fn explosion(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.4, 0.2], 300);
    bin(&mut scene, 40.0, 80.0);
    slab(&mut scene, [0.0, 81.0], [42.0, 1.0], 0.0);
    let mut random = Harness::new(2, &[]);
    let first = scene.bodies.len();
    crowd(&mut scene, &mut random, 2000, 45, 0.5, vec2(-11.0, 25.0));
    for body in &mut scene.bodies[first..] {
        body.velocity = 1.5 * (body.position - vec2(0.0, 36.0));
    }
    scene
}

/// Three crosses turn in a bin of 2,000 bodies.
pub(super) fn stirred(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.4, 0.0], 400);
    bin(&mut scene, 15.0, 60.0);
    let arms = [
        PlainShape::rectangle(4.0, 0.3),
        PlainShape::rectangle(0.3, 4.0),
    ];
    let arms = arms.map(|arm| scene.shape(arm)).to_vec();
    for (i, x) in [-9.8, 0.0, 9.8].into_iter().enumerate() {
        let mut cross = body(PlainKind::Kinematic, x, 5.0).spinning([2.0, -1.5, 1.0][i]);
        cross.shapes.clone_from(&arms);
        scene.bodies.push(cross);
    }
    let mut random = Harness::new(3, &[]);
    crowd(&mut scene, &mut random, 2000, 50, 0.55, vec2(-13.5, 10.0));
    scene
}

/// 4,000 bodies fall onto a heap.
pub(super) fn falling(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.0], 240);
    bin(&mut scene, 30.0, 80.0);
    let mut random = Harness::new(4, &[]);
    crowd(&mut scene, &mut random, 4000, 80, 0.7, vec2(-28.0, 1.0));
    scene
}

/// Sizes of 1 to 20 in one heap.
pub(super) fn sizes(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.0], 400);
    bin(&mut scene, 25.0, 80.0);
    let mut random = Harness::new(5, &[]);
    for i in 0..60 {
        let at = vec2(
            -22.0 + 4.4 * f64::from(i % 11),
            5.0 + 4.4 * f64::from(i / 11),
        );
        let shape = mixed(&mut random, 2.0);
        scene.add(moving(at.x, at.y), shape);
    }
    crowd(&mut scene, &mut random, 3000, 120, 0.4, vec2(-23.8, 34.0));
    scene
}

/// A drum of mixed bodies.
pub(super) fn drum_mixed(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 400);
    drum(&mut scene, 10.0, 0.6);
    let mut random = Harness::new(6, &[]);
    crowd(&mut scene, &mut random, 1600, 40, 0.42, vec2(-8.2, -8.5));
    scene
}

/// A square drum about the origin that turns, by half its width.
fn drum(scene: &mut PlainScene, half: f64, spin: f64) {
    let wall = |half: Vec2, offset: Vec2| PlainShape::Box { half, offset };
    let walls = [
        wall(vec2(0.5, half), vec2(half, 0.0)),
        wall(vec2(0.5, half), vec2(-half, 0.0)),
        wall(vec2(half, 0.5), vec2(0.0, half)),
        wall(vec2(half, 0.5), vec2(0.0, -half)),
    ];
    let mut drum = body(PlainKind::Kinematic, 0.0, 0.0).spinning(spin);
    drum.shapes = walls.map(|wall| scene.shape(wall)).to_vec();
    scene.bodies.push(drum);
    scene.region = Some([vec2(-1.6 * half, -1.6 * half), vec2(1.6 * half, 1.6 * half)]);
}

/// A drum of L shapes: two boxes each.
pub(super) fn drum_letters(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 400);
    drum(&mut scene, 10.0, 0.6);
    let mut random = Harness::new(7, &[]);
    let offset = vec2(-0.15, 0.0);
    let parts = [
        PlainShape::Box {
            half: vec2(0.08, 0.25),
            offset,
        },
        PlainShape::Box {
            half: vec2(0.12, 0.08),
            offset: vec2(0.05, -0.17),
        },
    ];
    // About their common centroid.
    let areas = parts.clone().map(|part| match part {
        PlainShape::Box { half, offset } => (4.0 * half.x * half.y, offset),
        _ => (0.0, Vec2::ZERO),
    });
    let whole = areas[0].0 + areas[1].0;
    let centroid = (areas[0].0 * areas[0].1 + areas[1].0 * areas[1].1) / whole;
    let parts = parts.map(|part| match part {
        PlainShape::Box { half, offset } => PlainShape::Box {
            half,
            offset: offset - centroid,
        },
        other => other,
    });
    let parts = parts.map(|part| scene.shape(part)).to_vec();
    for i in 0..900 {
        let at = vec2(
            -8.4 + 0.55 * f64::from(i % 30),
            -8.4 + 0.55 * f64::from(i / 30),
        );
        let mut letter = moving(at.x, at.y).turned(random.between(0.0, 6.2));
        letter.shapes.clone_from(&parts);
        scene.bodies.push(letter);
    }
    scene
}

/// A plate is driven through a heap of 2,000 bodies, without end.
pub(super) fn junkyard(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.5, 0.0], 400);
    slab(&mut scene, [0.0, -1.0], [200.0, 1.0], 0.0);
    let pusher = body(PlainKind::Kinematic, -30.0, 4.0).moving(vec2(6.0, 0.0));
    scene.add(pusher, PlainShape::rectangle(0.5, 3.9));
    let mut random = Harness::new(8, &[]);
    crowd(&mut scene, &mut random, 2000, 80, 0.5, vec2(-20.0, 0.5));
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
        let at = vec2(
            -18.0 + 1.1 * f64::from(i % 33),
            2.0 + 1.1 * f64::from(i / 33),
        );
        let mut star = moving(at.x, at.y).turned(random.between(0.0, 6.2));
        star.shapes.clone_from(&parts);
        scene.bodies.push(star);
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
        let x = -12.5 + 0.5 * f64::from(i % 50) + random.between(-0.02, 0.02);
        scene.place(moving(x, 40.0 + 0.6 * f64::from(i / 50)), disc);
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
        let at = vec2(
            -13.0 + 2.1 * f64::from(i % 13),
            1.5 + 1.0 * f64::from(i / 13),
        );
        let angle = random.between(-0.2, 0.2);
        scene.place(moving(at.x, at.y).turned(angle), rod);
    }
    scene
}

/// Balls that bounce on each other in a bin.
pub(super) fn bouncing(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.3, 0.7], 400);
    bin(&mut scene, 25.0, 120.0);
    let mut random = Harness::new(12, &[]);
    for i in 0..2000 {
        let at = vec2(
            -24.0 + 1.2 * f64::from(i % 40),
            3.0 + 1.2 * f64::from(i / 40),
        );
        let radius = random.between(0.2, 0.5);
        let velocity = random.within(3.0);
        scene.add(
            moving(at.x, at.y).moving(velocity),
            PlainShape::Circle { radius },
        );
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
            let x = 0.7 * f64::from(row);
            scene.place(
                moving(x, 40.0 + 0.81 * (f64::from(column) - 0.5 * f64::from(row))),
                disc,
            );
        }
    }
    scene.place(moving(-30.0, 40.1).moving(vec2(60.0, 0.0)), disc);
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
    crowd(&mut scene, &mut random, 1500, 30, 0.6, vec2(-19.0, 44.0));
    scene
}

/// A thousand stacks of five land one after the other.
pub(super) fn landing_stacks(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 240);
    slab(&mut scene, [0.0, -1.0], [2000.0, 1.0], 0.0);
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    for i in 0..1000 {
        for row in 0..5 {
            let lift = 0.5 + 0.01 * f64::from(i % 200);
            scene.place(
                moving(
                    -1500.0 + 3.0 * f64::from(i),
                    lift + 0.5 + 1.02 * f64::from(row),
                ),
                unit,
            );
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
        scene.place(
            moving(-1500.0 + 3.0 * f64::from(i), height).turned(tilt),
            tall,
        );
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
        scene.place(moving(x, 1.1), plank);
        scene.place(moving(x - 1.5, 1.5), load);
        scene.place(moving(x + 1.2, 1.6 + 0.002 * f64::from(i)), load);
    }
    scene
}

/// A hundred platforms go to and fro with five boxes each: to, in this scene.
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
            scene.place(moving(0.1 * f64::from(k), y + 0.75 + f64::from(k)), unit);
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
            let mut stone = moving(0.6 * f64::from(i), y + 0.5);
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
        scene.add(
            moving(at.x, at.y).moving(vec2(speed, 0.0)),
            PlainShape::rectangle(w, h),
        );
    }
    scene
}

/// A pyramid of forty rows with restitution, hit by falling balls.
pub(super) fn lively_pyramid(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.3], 300);
    slab(&mut scene, [0.0, -1.0], [100.0, 1.0], 0.0);
    let unit = scene.shape(PlainShape::rectangle(0.5, 0.5));
    for row in 0..40 {
        for column in 0..40 - row {
            let x = -19.5 + 0.5 * f64::from(row) + f64::from(column);
            scene.place(moving(x, 0.5 + f64::from(row)), unit);
        }
    }
    let ball = scene.shape(PlainShape::Circle { radius: 0.4 });
    for i in 0..40 {
        scene.place(
            moving(-19.5 + f64::from(i), 45.0 + 2.0 * f64::from(i % 7)),
            ball,
        );
    }
    scene
}

/// Discs alone: 4,000 in a bin.
pub(super) fn disc_heap(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.4, 0.0], 400);
    bin(&mut scene, 20.0, 80.0);
    let mut random = Harness::new(15, &[]);
    for i in 0..4000 {
        let at = vec2(
            -19.0 + 0.76 * f64::from(i % 50),
            1.0 + 0.76 * f64::from(i / 50),
        );
        let radius = random.between(0.2, 0.35);
        let aside = vec2(random.between(-0.02, 0.02), 0.0);
        let at = at + aside;
        scene.add(moving(at.x, at.y), PlainShape::Circle { radius });
    }
    scene
}

/// A cloud of 3,000 bodies without gravity runs into another.
pub(super) fn clouds(name: &str) -> PlainScene {
    let mut scene = scene(name, Vec2::ZERO, [0.4, 0.1], 300);
    let mut random = Harness::new(16, &[]);
    for side in [-1.0, 1.0] {
        let first = scene.bodies.len();
        crowd(
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
