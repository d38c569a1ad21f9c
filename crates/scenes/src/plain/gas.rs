//! Elastic bodies in a closed box, without gravity and without friction: energy must stay.

use carom_math::{Vec2, vec2};

use super::harness::Harness;
use super::{PlainBody, PlainKind, PlainScene, PlainShape};

/// A closed box with inner faces at ±`inner`, walls 4 m thick, and one elastic material; centres
/// that get `margin` further out than that have escaped.
pub(super) fn closed_box(name: &str, inner: f64, margin: f64) -> PlainScene {
    let mut scene = PlainScene::empty(name, Vec2::ZERO);
    let corner = Vec2::splat(inner + margin);
    scene.region = Some([-corner, corner]);
    let material = scene.material(1.0, 0.0, 1.0);
    let lying = scene.shape(PlainShape::rectangle(2.0 * inner, 2.0));
    let standing = scene.shape(PlainShape::rectangle(2.0, 2.0 * inner));
    let middle = inner + 2.0;
    for (x, y, wall) in [
        (0.0, -middle, lying),
        (0.0, middle, lying),
        (-middle, 0.0, standing),
        (middle, 0.0, standing),
    ] {
        scene.place(PlainBody::new(PlainKind::Fixed, vec2(x, y), material), wall);
    }
    scene
}

pub(super) fn dense(name: &str) -> PlainScene {
    flying(name, 1.0)
}

pub(super) fn medium(name: &str) -> PlainScene {
    flying(name, 2.0)
}

pub(super) fn dilute(name: &str) -> PlainScene {
    flying(name, 4.0)
}

/// 2,000 bodies, a seventh of them discs, on a grid of 1.3 m times `spread`.
fn flying(name: &str, spread: f64) -> PlainScene {
    const MISROUNDED: &[u32] = &[
        1195, 2458, 6343, 6387, 8194, 9390, 9933, 10057, 10517, 11257, 11278, 13460, 14073, 14401,
        15130, 16434, 16875, 18110,
    ];
    let mut scene = closed_box(name, 30.0 * spread, 0.3).steps(60, 300);
    scene.sleeping = true;
    let mut random = Harness::new(42, MISROUNDED);
    for i in 0..2000 {
        let (column, row) = (f64::from(i % 45 - 22), f64::from(i / 45 - 22));
        let at = vec2(column * 1.3, row * 1.3) * spread;
        random_body(&mut scene, &mut random, at);
    }
    scene
}

/// Bodies of a gas of [`spaced_scene`].
const SPACED: u32 = 1024;

/// The bodies of scene e, about a thousand of them, on a square grid of `spacing` millimetres (1,150 to 20,000, else the
/// nearest of these) in a closed box, named `gas_spaced_1300`: the denser, the more impacts.
///
/// # Examples
/// ```
/// use carom_scenes::{plain_scene, spaced_scene};
/// let scene = spaced_scene(1300);                              // as dense as scene e
/// assert_eq!(plain_scene("gas_spaced_1300"), Some(scene));
/// ```
#[must_use]
pub fn spaced_scene(spacing: u32) -> PlainScene {
    let spacing = spacing.clamp(*SPACINGS.start(), *SPACINGS.end());
    let metres = f64::from(spacing) / 1000.0;
    let side = SPACED.isqrt();
    let half = 0.5 * f64::from(side - 1) * metres;
    let mut scene = closed_box(&format!("gas_spaced_{spacing}"), half + metres, 0.3).steps(60, 300);
    let mut random = Harness::new(42, &[]);
    for i in 0..SPACED {
        let at = vec2(f64::from(i % side), f64::from(i / side)) * metres - Vec2::splat(half);
        random_body(&mut scene, &mut random, at);
    }
    scene
}

/// Spacings of [`spaced_scene`], in mm: at 1.12 m two of its bodies overlap.
const SPACINGS: core::ops::RangeInclusive<u32> = 1150..=20_000;

/// Spacing of a name like `gas_spaced_1300`; no other spelling, and none out of range.
pub(crate) fn spacing_of(name: &str) -> Option<u32> {
    let number = name.strip_prefix("gas_spaced_")?;
    let spacing: u32 = number.parse().ok()?;
    (SPACINGS.contains(&spacing) && spacing.to_string() == number).then_some(spacing)
}

/// A disc (one in seven) or a polygon of three to eight corners.
pub(super) fn random_body(scene: &mut PlainScene, random: &mut Harness, at: Vec2) {
    let draw = random.below(7);
    let radius = random.between(0.25, 0.55);
    let shape = match draw {
        0 => PlainShape::Circle { radius },
        draw => PlainShape::Polygon(random.polygon(2 + draw, radius)),
    };
    let angle = random.between(0.0, 6.2);
    let velocity = random.within(10.0);
    let spin = random.between(-3.0, 3.0);
    let body = PlainBody::new(PlainKind::Dynamic, at, 0).turned(angle);
    scene.add(body.moving(velocity).spinning(spin), shape);
}

pub(super) fn case_12(name: &str) -> PlainScene {
    hundred(name, |random, corners, radius| {
        PlainShape::Polygon(random.polygon(corners, radius))
    })
}

/// As case 12; the number of corners is drawn and not used.
pub(super) fn case_18(name: &str) -> PlainScene {
    hundred(name, |_, _, radius| PlainShape::Circle { radius })
}

fn hundred(name: &str, shape: impl Fn(&mut Harness, u32, f64) -> PlainShape) -> PlainScene {
    let mut scene = closed_box(name, 6.0, 0.0);
    let mut random = Harness::new(7, &[867]);
    for i in 0..100 {
        let (column, row) = (f64::from(i % 10), f64::from(i / 10));
        let at = vec2(column * 1.1 - 4.95, row * 1.1 - 4.95);
        let corners = 3 + random.below(6);
        let radius = random.between(0.25, 0.4);
        let shape = shape(&mut random, corners, radius);
        let angle = random.between(0.0, 6.0);
        let velocity = random.within(3.0);
        let spin = random.between(-2.0, 2.0);
        let body = PlainBody::new(PlainKind::Dynamic, at, 0).turned(angle);
        scene.add(body.moving(velocity).spinning(spin), shape);
    }
    scene
}
