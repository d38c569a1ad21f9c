//! The narrow phase agrees with `carom-collision`.

use carom_math::{Vec2, vec2};

use super::Random;
use crate::narrow::naive::{Going, collide};
use crate::narrow::{Manifold, collide_any};
use crate::pieces::Piece;
use crate::{BodyIx, PieceIx};

/// Both ends of a manifold, midway between the surfaces, as places relative to the centre of A, from its arms.
fn places(found: &Manifold) -> [Vec2; 2] {
    let n = found.normal;
    // r · n is the tangential arm, and r × n = −r · t.
    let t = vec2(-n.y, n.x);
    let height = found.tangent_a + 0.5 * found.gap().max(0.0);
    let at = |arm: f64| n * height - t * arm;
    [at(found.arm_a), at(found.arm_a + found.length)]
}

#[test]
fn outlines_that_touch_agree_with_hulls() {
    let mut random = Random::new(1);
    let (mut touching, mut ties) = (0, 0);
    for _ in 0..60_000 {
        let inputs = [random.piece(), random.piece()];
        let [a, b] = inputs
            .each_ref()
            .map(|input| Piece::of(input, BodyIx::default(), 0).next().unwrap());
        let (pose_a, pose_b) = (random.pose(0.6), random.pose(0.6));
        let posed = [(&a, pose_a), (&b, pose_b)].map(|(piece, pose)| {
            let mut pieces = crate::pieces::Pieces::default();
            let number = pieces.insert(vec![piece.clone()]);
            pieces.pose(number, pose);
            pieces
        });
        let [turned_a, turned_b] = posed.each_ref().map(|pieces| pieces.outline(PieceIx(0)));
        let going = Going {
            d: pose_b.position - pose_a.position,
            ..Going::default()
        };
        let ours = collide(turned_a, turned_b, going, Vec2::ZERO, [0.0; 3])
            .filter(|ours| ours.gap() <= 0.0);
        let theirs = collide_any((&a, pose_a), (&b, pose_b), 0.0);
        // Cores apart, roundings in touch: there the hulls' normal is that of the nearest points.
        let cores = a.rounding + b.rounding == 0.0;
        let Some(ours) = ours else {
            assert!(theirs.is_none(), "missed {theirs:?}");
            continue;
        };
        if !cores {
            continue;
        }
        touching += 1;
        let agrees = theirs.is_some_and(|theirs| {
            let same = |x: f64, y: f64| (x - y).abs() < 1e-9;
            // Only points below the limit are told by the hulls.
            let deep = |found: &Manifold| {
                let points = if found.points == 2 { 2 } else { 1 };
                let mut list: Vec<_> = (0..points).filter(|k| found.gaps[*k] <= 0.0).collect();
                list.retain(|k| found.gaps[*k] <= 0.0);
                list
            };
            let (mine, other) = (deep(&ours), deep(&theirs));
            (ours.normal - theirs.normal).length() < 1e-9
                && mine.len() == other.len()
                && mine.iter().zip(&other).all(|(i, j)| {
                    let (p, q) = (places(&ours)[*i], places(&theirs)[*j]);
                    let t = vec2(-ours.normal.y, ours.normal.x);
                    same(ours.gaps[*i], theirs.gaps[*j]) && same(p.dot(t), q.dot(t))
                })
        });
        ties += usize::from(!agrees);
    }
    assert!(touching > 10_000, "{touching}");
    assert!(ties * 1000 < touching, "{ties} of {touching} differ");
}

/// A cut through a concave body separates, and is never touched.
#[test]
fn no_cut_is_touched() {
    let (mut random, mut touching) = (Random::new(2), 0);
    for _ in 0..20_000 {
        let letter = super::wide::letter();
        let parts: Vec<_> = Piece::of(&letter, BodyIx::default(), 0).collect();
        let other = Piece::of(&random.piece(), BodyIx::default(), 0)
            .next()
            .unwrap();
        let (pose_a, pose_b) = (random.pose(0.6), random.pose(0.6));
        let posed = |piece: &Piece, pose| {
            let mut pieces = crate::pieces::Pieces::default();
            let number = pieces.insert(vec![piece.clone()]);
            pieces.pose(number, pose);
            pieces
        };
        let b = posed(&other, pose_b);
        for part in &parts {
            let a = posed(part, pose_a);
            let (turned, other) = (a.outline(PieceIx(0)), b.outline(PieceIx(0)));
            let going = Going {
                d: pose_b.position - pose_a.position,
                ..Going::default()
            };
            let Some(found) = collide(turned, other, going, Vec2::ZERO, [0.0; 3]) else {
                continue;
            };
            touching += 1;
            let sides = (0..turned.corners()).filter(|i| turned.is_cut(*i));
            for i in sides {
                let along = turned.normal(i).dot(found.normal);
                let of_other =
                    (0..other.corners()).any(|k| (other.normal(k) + found.normal).length() < 1e-9);
                assert!(
                    along < 1.0 - 1e-9 || of_other || other.corners() == 1,
                    "{found:?}"
                );
            }
        }
    }
    assert!(touching > 1000, "{touching}");
}
