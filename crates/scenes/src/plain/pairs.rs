//! Pairs of polygons that run into each other.

use carom_math::{Vec2, vec2};

use super::harness::Harness;
use super::{PlainBody, PlainKind, PlainScene, PlainShape};

/// Bodies 2k and 2k + 1 are a pair; all pairs lie at the same place, each meant for a world of its own.
pub(super) fn case_19(name: &str) -> PlainScene {
    const MISROUNDED: &[u32] = &[
        126, 785, 1078, 1657, 1919, 2228, 2744, 3590, 4252, 4595, 5163, 6092, 7098, 8125, 8220,
        8650,
    ];
    let mut scene = PlainScene::empty(name, Vec2::ZERO);
    scene.material(1.0, 0.0, 1.0);
    let mut random = Harness::new(99, MISROUNDED);
    for _ in 0..400 {
        for side in [-1.0, 1.0] {
            let corners = 3 + random.below(6);
            let radius = random.between(0.3, 0.5);
            let x = side * random.between(0.9, 1.4);
            let y = random.between(-0.2, 0.2);
            let shape = PlainShape::Polygon(random.polygon(corners, radius));
            let angle = random.between(0.0, 6.0);
            let velocity = vec2(-side * random.between(1.0, 4.0), 0.0);
            let spin = random.between(-4.0, 4.0);
            let body = PlainBody::new(PlainKind::Dynamic, vec2(x, y), 0).turned(angle);
            scene.add(body.moving(velocity).spinning(spin), shape);
        }
    }
    scene
}
