//! Bodies that fall into a bin and settle.

use carom_math::{Vec2, vec2};

use super::harness::{Harness, area_and_centroid};
use super::nearest::cos_sin;
use super::{PlainBody, PlainKind, PlainScene, PlainShape};

/// A bin with inner faces at ±`inner` and y = 0, open above, and one material.
fn bin(name: &str, inner: f64) -> PlainScene {
    let mut scene = PlainScene::empty(name, vec2(0.0, -10.0)).steps(300, 200);
    scene.region = Some([vec2(-inner - 0.5, -0.5), vec2(inner + 0.5, 200.0)]);
    scene.material(1.0, 0.5, 0.0);
    scene.bin(inner, 2.0, 120.0);
    scene
}

/// 3,000 polygons of three to eight corners, sixty rows of fifty.
pub(super) fn polygons(name: &str) -> PlainScene {
    const MISROUNDED: &[u32] = &[
        3, 2100, 2618, 4327, 4374, 4435, 5081, 5584, 6266, 6704, 7711, 7807, 7836, 7880, 8307,
        8890, 10147, 13820, 14602, 14990, 16684, 17411, 17634, 17848, 18268, 19588, 21444, 24381,
        24946, 25175, 25629, 25876, 26007, 26133, 26297, 26811, 26975, 28353, 28926, 30503, 30566,
        30764, 31209, 31301, 32216, 32379,
    ];
    let mut scene = bin(name, 30.0);
    let mut random = Harness::new(42, MISROUNDED);
    for i in 0..3000 {
        let (column, row) = (f64::from(i % 50) - 24.5, f64::from(i / 50));
        let at = vec2(column * 1.18, 1.0 + 1.18 * row);
        let corners = 3 + random.below(6);
        let radius = random.between(0.3, 0.55);
        let shape = PlainShape::Polygon(random.polygon(corners, radius));
        let angle = random.between(0.0, 6.2);
        let body = PlainBody::new(PlainKind::Dynamic, at, 0).turned(angle);
        scene.add(body, shape);
    }
    scene
}

/// 800 concave bodies, L, U and star in turn: a ring each, and the same as convex pieces.
pub(super) fn concave(name: &str) -> PlainScene {
    let mut scene = bin(name, 20.0);
    let mut random = Harness::new(42, &[]);
    for i in 0..800 {
        let at = vec2(
            f64::from(i % 22) * 1.75 - 18.375,
            1.5 + 1.75 * f64::from(i / 22),
        );
        let angle = random.between(0.0, 6.2);
        let size = random.between(0.9, 1.3);
        let (ring, pieces) = match i % 3 {
            0 => letter_l(size),
            1 => letter_u(size),
            _ => star(size),
        };
        let centroid = common_centroid(&pieces);
        let about = |ring: Vec<Vec2>| ring.into_iter().map(|p| p - centroid).collect();
        let mut body = PlainBody::new(PlainKind::Dynamic, at, 0).turned(angle);
        body.outline = Some(scene.outlines.len());
        scene.outlines.push(about(ring));
        for piece in pieces {
            body.shapes
                .push(scene.shape(PlainShape::Polygon(about(piece))));
        }
        scene.bodies.push(body);
    }
    scene
}

/// A ring and its convex pieces, counter-clockwise.
type Cut = (Vec<Vec2>, Vec<Vec<Vec2>>);

/// Corners of a rectangle from its low and high corner.
fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Vec<Vec2> {
    vec![vec2(x0, y0), vec2(x1, y0), vec2(x1, y1), vec2(x0, y1)]
}

/// As wide and high as `size`, a third of it thick.
fn letter_l(size: f64) -> Cut {
    let (h, t) = (size / 2.0, size / 6.0);
    let ring = vec![
        vec2(-h, -h),
        vec2(h, -h),
        vec2(h, -t),
        vec2(-t, -t),
        vec2(-t, h),
        vec2(-h, h),
    ];
    (
        ring,
        vec![rectangle(-h, -h, h, -t), rectangle(-h, -t, -t, h)],
    )
}

/// As wide and high as `size`, three tenths of it thick.
fn letter_u(size: f64) -> Cut {
    let (h, t) = (size / 2.0, 0.2 * size);
    let ring = vec![
        vec2(-h, -h),
        vec2(h, -h),
        vec2(h, h),
        vec2(t, h),
        vec2(t, -t),
        vec2(-t, -t),
        vec2(-t, h),
        vec2(-h, h),
    ];
    let pieces = vec![
        rectangle(-h, -h, h, -t),
        rectangle(-h, -t, -t, h),
        rectangle(t, -t, h, h),
    ];
    (ring, pieces)
}

/// Five points `size` / 2 from the middle, cut into the inner pentagon and the five points.
fn star(size: f64) -> Cut {
    let outer = size / 2.0;
    let radii = [outer, 0.45 * outer];
    let ring: Vec<Vec2> = (0..10_u32)
        .map(|i| {
            let radius = radii[i as usize % 2];
            let angle = core::f64::consts::PI * f64::from(i) / 5.0;
            let [x, y] = cos_sin(angle).map(|(nearest, _)| radius * nearest);
            vec2(x, y)
        })
        .collect();
    let inner = ring.iter().skip(1).step_by(2).copied().collect();
    let mut pieces = vec![inner];
    pieces.extend(
        (0..10)
            .step_by(2)
            .map(|i| vec![ring[i], ring[i + 1], ring[(i + 9) % 10]]),
    );
    (ring, pieces)
}

/// The mean of the pieces' centroids, weighted by area.
fn common_centroid(pieces: &[Vec<Vec2>]) -> Vec2 {
    let (mut all, mut sum) = (0.0, Vec2::ZERO);
    for (area, centroid) in pieces.iter().map(|piece| area_and_centroid(piece)) {
        all += area;
        sum += centroid * area;
    }
    sum / all
}
