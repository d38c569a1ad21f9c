//! Eight pairs at once are what they are one by one.

use carom_geometry::Polygon;
use carom_math::{Vec2, vec2};

use super::{Random, levels};
use crate::narrow::{Eight, Found, Manifold, Scene, collide_eight, naive};
use crate::rows::LANES;
use crate::{Engine, LineIx, PieceInput, PieceIx, Settings};

/// Bodies of all kinds of outlines close together, a tick old: away from their base poses.
fn random_bodies(seed: u64, spread: f64) -> Engine {
    let mut random = Random::new(seed);
    let mut engine = Engine::new(Settings::default()).unwrap();
    for _ in 0..40 {
        let piece: PieceInput = random.piece();
        let body = random.body(&piece, spread);
        let concave = random.signed() < -0.5;
        let piece = if concave { letter() } else { piece };
        engine.insert(body, &[piece]).unwrap();
    }
    engine.tick();
    engine
}

/// An L, which has pieces with cuts.
pub(super) fn letter() -> PieceInput {
    PieceInput::new(Polygon::new(letter_ring()).unwrap())
}

fn letter_ring() -> [Vec2; 6] {
    let corners = [(-2, -2), (2, -2), (2, -1), (-1, -1), (-1, 2), (-2, 2)];
    corners.map(|(x, y)| vec2(f64::from(x), f64::from(y)) * 0.25)
}

/// All pairs of pieces of two bodies.
fn pairs(scene: &Scene<'_>) -> Vec<[PieceIx; 2]> {
    let owner = |piece: PieceIx| scene.pieces.list[piece].body;
    let count = scene.pieces.list.len().try_into().unwrap();
    let of = |b: u32| (0..b).map(move |a| [a, b].map(PieceIx));
    let all = (0..count).flat_map(of);
    all.filter(|[a, b]| owner(*a) != owner(*b)).collect()
}

fn eight<'a>(scene: &Scene<'a>, pairs: &[[PieceIx; 2]]) -> Eight<'a> {
    let mut eight = Eight::new(scene.pieces, [[LineIx::EMPTY; LANES]; 2]);
    for (lane, pair) in pairs.iter().enumerate() {
        assert!(eight.set(scene.pieces, lane, *pair));
        let body = |piece: PieceIx| scene.pieces.list[piece].body;
        let line = |piece: PieceIx| scene.bodies.records[body(piece)].line;
        (eight.lines[0][lane], eight.lines[1][lane]) = (line(pair[0]), line(pair[1]));
        eight.least[lane] = scene.seen(pair.map(line));
    }
    eight
}

fn found(scene: &Scene<'_>, eight: &Eight<'_>) -> Found {
    let mut found = Found::NONE;
    collide_eight(scene, 1.0, eight, &mut found);
    found
}

fn agree(ours: Option<&Manifold>, theirs: Option<&Manifold>) -> bool {
    let (Some(ours), Some(theirs)) = (ours, theirs) else {
        return ours.is_none() && theirs.is_none();
    };
    let same = |x: f64, y: f64| (x - y).abs() < 1e-9;
    ours.points == theirs.points
        && (ours.normal - theirs.normal).length() < 1e-9
        && same(ours.arm_a, theirs.arm_a)
        && same(ours.arm_b, theirs.arm_b)
        && same(ours.length, theirs.length)
        && same(ours.tangent_a, theirs.tangent_a)
        && same(ours.tangent_b, theirs.tangent_b)
        && same(ours.gaps[0], theirs.gaps[0])
        && same(ours.gaps[1], theirs.gaps[1])
}

#[test]
fn eight_at_once_agree_with_one_by_one() {
    let (mut near, mut ties) = (0, 0);
    for seed in 0..60u32 {
        let spread = [0.3, 1.0, 3.0][seed as usize % 3];
        let engine = random_bodies(u64::from(seed), spread);
        let scene = engine.scene();
        for pairs in pairs(&scene).chunks(LANES) {
            let eight = eight(&scene, pairs);
            let found = found(&scene, &eight);
            for (lane, pair) in pairs.iter().enumerate() {
                let ours = (found.near >> lane & 1 == 1).then(|| found.manifold(lane));
                let theirs = naive::contact_on(&scene, Vec2::ZERO, *pair, 1.0);
                near += usize::from(theirs.is_some());
                ties += usize::from(!agree(ours.as_ref(), theirs.as_ref()));
            }
        }
    }
    assert!(near > 10_000, "{near}");
    assert!(ties * 1000 <= near, "{ties} of {near} differ");
}

#[test]
fn a_pair_that_stays_on_a_side_agrees_with_its_slow_twin() {
    let (mut turned, mut ties) = (0, 0);
    let mut random = Random::new(3);
    for seed in 0..20u32 {
        let engine = random_bodies(u64::from(seed), [0.3, 1.0][seed as usize % 2]);
        let scene = engine.scene();
        for pair in pairs(&scene) {
            let side = vec2(random.signed(), random.signed());
            let ours = scene.contact_on(side, pair, 1.0);
            let theirs = naive::contact_on(&scene, side, pair, 1.0);
            turned += usize::from(!agree(ours.as_ref(), scene.contact(pair, 1.0).as_ref()));
            ties += usize::from(!agree(ours.as_ref(), theirs.as_ref()));
        }
    }
    assert!(turned > 1000, "{turned}");
    assert!(ties * 100 <= turned, "{ties} of {turned} differ");
}

#[test]
fn all_widths_find_the_same_bits() {
    let bits = |found: &Found| {
        let near = (0..LANES).filter(|lane| found.near >> lane & 1 == 1);
        let manifolds: Vec<_> = near
            .map(|lane| format!("{:?}", found.manifold(lane)))
            .collect();
        ([found.near, found.short, found.seam, found.of_b], manifolds)
    };
    for seed in 0..6 {
        let engine = random_bodies(seed, 1.0);
        let scene = engine.scene();
        for pairs in pairs(&scene).chunks(LANES) {
            let eight = eight(&scene, pairs);
            let first = found(&scene, &eight);
            for level in levels() {
                let found = found(&Scene { level, ..scene }, &eight);
                assert_eq!(bits(&first), bits(&found), "{level:?}");
            }
        }
    }
}

/// What repeats an edge is one as little as the edge itself, and how many corners the others in a register have decides nothing: cuts that
/// come first in their pieces were faces.
#[test]
fn a_pair_has_the_bits_that_it_has_alone_whatever_its_first_edge_is() {
    let ring = letter_ring();
    for first in 0..ring.len() {
        let mut engine = Engine::new(Settings::default()).unwrap();
        let mut ring = ring;
        ring.rotate_left(first);
        let mut random = Random::new(7);
        for k in 0..60 {
            let any = random.piece();
            let body = random.body(&any, 1.0);
            let letter = PieceInput::new(Polygon::new(ring).unwrap());
            engine
                .insert(body, &[if k % 3 == 0 { any } else { letter }])
                .unwrap();
        }
        engine.pose_boxes();
        let scene = engine.scene();
        let (mut near, mut ties) = (0, 0);
        for pairs in pairs(&scene).chunks(LANES) {
            let all = found(&scene, &eight(&scene, pairs));
            for (lane, pair) in pairs.iter().enumerate() {
                let alone = found(&scene, &eight(&scene, &[*pair]));
                let ours = (all.near >> lane & 1 == 1).then(|| all.manifold(lane));
                let its = (alone.near & 1 == 1).then(|| alone.manifold(0));
                assert_eq!(format!("{ours:?}"), format!("{its:?}"), "{pair:?}");
                let theirs = naive::contact_on(&scene, Vec2::ZERO, *pair, 1.0);
                near += usize::from(theirs.is_some());
                ties += usize::from(!agree(ours.as_ref(), theirs.as_ref()));
            }
        }
        assert!(ties * 1000 <= near, "{ties} of {near} differ, from {first}");
    }
}
