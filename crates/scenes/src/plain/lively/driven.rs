//! What is stirred, turned, pushed, or runs through a neck.

use carom_math::{Vec2, vec2};

use super::{GRAVITY, bin, body, grid, mixed_rows, moving, scene, slab};
use crate::plain::harness::Harness;
use crate::plain::resting::drum;
use crate::plain::{PlainKind, PlainScene, PlainShape};

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
    mixed_rows(&mut scene, &mut random, 2000, 50, 0.55, vec2(-13.5, 10.0));
    scene
}

/// A drum of mixed bodies.
pub(super) fn drum_mixed(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 400);
    drum(&mut scene, Vec2::ZERO, 10.0, 0.6);
    scene.region = Some([Vec2::splat(-16.0), Vec2::splat(16.0)]);
    let mut random = Harness::new(6, &[]);
    mixed_rows(&mut scene, &mut random, 1600, 40, 0.42, vec2(-8.2, -8.5));
    scene
}

/// A drum of L shapes: two boxes each.
pub(super) fn drum_letters(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.6, 0.0], 400);
    drum(&mut scene, Vec2::ZERO, 10.0, 0.6);
    scene.region = Some([Vec2::splat(-16.0), Vec2::splat(16.0)]);
    let mut random = Harness::new(7, &[]);
    let parts = [
        (vec2(0.07, 0.23), vec2(-0.14, 0.0)),
        (vec2(0.11, 0.07), vec2(0.04, -0.16)),
    ];
    // About their common centroid.
    let areas = parts.map(|(half, _)| 4.0 * half.x * half.y);
    let centroid = (areas[0] * parts[0].1 + areas[1] * parts[1].1) / (areas[0] + areas[1]);
    let parts = parts.map(|(half, offset)| {
        let offset = offset - centroid;
        scene.shape(PlainShape::Box { half, offset })
    });
    for i in 0..900 {
        let mut letter = moving(grid(i, 30, [0.62, 0.62], vec2(-9.0, -9.0)));
        letter = letter.turned(random.between(0.0, 6.2));
        letter.shapes = parts.to_vec();
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
    mixed_rows(&mut scene, &mut random, 2000, 80, 0.5, vec2(-20.0, 0.5));
    scene
}

/// 2,000 discs and polygons run through the neck of a funnel into a bin.
pub(super) fn hourglass(name: &str) -> PlainScene {
    let mut scene = scene(name, GRAVITY, [0.3, 0.0], 600);
    bin(&mut scene, 12.0, 60.0);
    for side in [-1.0, 1.0] {
        slab(&mut scene, [side * 7.2, 20.0], [8.5, 0.3], side * 0.7);
    }
    let mut random = Harness::new(1, &[]);
    mixed_rows(&mut scene, &mut random, 2000, 40, 0.5, vec2(-9.75, 28.0));
    scene
}
