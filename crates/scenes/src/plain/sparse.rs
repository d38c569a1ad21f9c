//! Bodies that never meet.

use carom_math::vec2;

use super::harness::Harness;
use super::{PlainBody, PlainKind, PlainScene, PlainShape};

pub(super) fn mostly_empty(name: &str) -> PlainScene {
    let mut scene = PlainScene::empty(name, vec2(0.0, -10.0)).steps(30, 300);
    scene.material(1.0, 0.6, 0.0);
    let disc = scene.shape(PlainShape::Circle { radius: 0.25 });
    let mut random = Harness::new(42, &[]);
    for column in 0..100 {
        for row in 0..100 {
            let at = vec2(-250.0 + 5.0 * f64::from(column), 5.0 * f64::from(row));
            let body = PlainBody::new(PlainKind::Dynamic, at, 0).moving(random.within(0.1));
            scene.place(body, disc);
        }
    }
    scene
}
