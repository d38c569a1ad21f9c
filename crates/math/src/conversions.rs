//! Vectors from and to what other code has.

use crate::{Vec2, vec2};

#[test]
fn vectors_are_arrays_and_tuples() {
    let v = vec2(3.0, -4.0);
    assert_eq!((Vec2::from([3.0, -4.0]), Vec2::from((3.0, -4.0))), (v, v));
    assert_eq!(
        (v.to_array(), <(f64, f64)>::from(v)),
        ([3.0, -4.0], (3.0, -4.0))
    );
}

#[cfg(feature = "mint")]
#[test]
fn vectors_go_through_mint() {
    let other = mint::Vector2 { x: 3.0, y: -4.0 };
    assert_eq!(Vec2::from(other), vec2(3.0, -4.0));
    assert_eq!(mint::Vector2::from(vec2(3.0, -4.0)), other);
    let place = mint::Point2 { x: 1.0, y: 2.0 };
    assert_eq!(Vec2::from(place), vec2(1.0, 2.0));
}
