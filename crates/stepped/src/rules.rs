//! Which pieces touch each other, and how their surfaces meet.

use crate::Material;

/// How the surfaces of two pieces meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Coefficient of friction of the pair.
    pub friction: f64,
    /// Coefficient of restitution of the pair: 0 sticks, 1 returns all normal speed.
    pub restitution: f64,
    /// How fast both surfaces run, together, in m/s: a belt. Above 0 each runs counter-clockwise around its piece, as the
    /// rim of a wheel of positive spin does.
    pub tangent_speed: f64,
}

/// Asked of pieces that come near and have no contact yet, and of contacts again by [`Engine::resurface`](crate::Engine::resurface).
pub trait PairRules {
    /// How two pieces meet, by their tags and materials; `None`: they pass through each other.
    ///
    /// Nothing checks the answer: friction must be finite and at least 0, restitution in 0..=1, the speed finite. Equal questions must have
    /// equal answers, until [`Engine::resurface`](crate::Engine::resurface) asks anew.
    fn surface(&self, tags: [u64; 2], materials: [Material; 2]) -> Option<Surface>;
}

/// All pieces touch each other; friction is the root of the product, restitution the larger one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mixed;

impl PairRules for Mixed {
    fn surface(&self, _: [u64; 2], [a, b]: [Material; 2]) -> Option<Surface> {
        Some(Surface {
            friction: (a.friction * b.friction).sqrt(),
            restitution: a.restitution.max(b.restitution),
            tangent_speed: 0.0,
        })
    }
}
