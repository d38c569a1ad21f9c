//! How two bodies of a pair move against each other, and what became of them since their last look.
//!
//! A look leaves a strip between the two bodies (or says by how much they overlap), and rows for all that is
//! nearer than the look's margin. Both are followed in the frame of the larger body, F: with r from its centre to
//! that of the smaller one, S, at the look, and φ, ψ what either turned since,
//!
//! ```text
//! moved    r' − R(φ) r                         what S moved by, as F sees it
//! swung    rim_S |ψ − φ|                       what its points moved by beside that, at most
//! strip    gap + n·moved − swung               n turns with F
//! others   margin − |moved| − swung            nearest that anything can be that has no row
//! ```
//! As long as the strip is wider than what both go in a sub-step nothing can happen; and rows stay those of the
//! pair as long as `|moved| + swung` is small against its size and its normals keep their directions.

use carom_math::{Vec2, perp};

use super::stand::Stand;
use crate::pairs::Glance;

/// Normals are kept in the world: a pair that turned by more, in rad, is looked at again.
const TURNED: f64 = 0.1;

/// A pair that moves against each other by so much of its smaller reach in a tick is asked in every sub-step
/// while it has rows that act: 11 m/s for boxes of 1 m.
pub(super) const QUICK: f64 = 0.25;

/// Where the larger body turned by more since a look, in rad, nobody knows what is left of the strip.
const LOST: f64 = 0.25;

/// How two bodies move against each other: the smaller one as the larger one sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Against {
    /// Of the centre of the smaller one, in m/s.
    pub(super) v: Vec2,
    /// Of its points about the centre, in m/s.
    pub(super) swing: f64,
    /// Difference of what pulls on both, in m/s².
    pub(super) pull: f64,
    pub(super) size: f64,
}

impl Against {
    #[inline]
    pub(super) fn new(both: [&Stand; 2]) -> Self {
        let (f, s) = larger_first(both);
        let (f, s) = (both[f], both[s]);
        let carried = if f.spin == 0.0 {
            Vec2::ZERO
        } else {
            perp(s.centre - f.centre) * f.spin
        };
        let pull = both[1].pull - both[0].pull;
        Self {
            v: s.v - f.v - carried,
            swing: swing(s.rim, s.spin - f.spin),
            pull: if pull == Vec2::ZERO {
                0.0
            } else {
                pull.length()
            },
            size: both[0].reach.min(both[1].reach),
        }
    }

    /// Fastest that two points of them can approach, in m/s.
    pub(super) fn speed(&self) -> f64 {
        self.v.length() + self.swing
    }

    pub(super) const fn pull(&self) -> f64 {
        self.pull
    }

    /// Whether rows found at a tick would not serve until the next. A fast turn alone does not make a pair quick: jammed
    /// columns hummed at 0.6 m/s with it.
    pub(super) fn is_quick(&self, tick: f64) -> bool {
        self.speed() * tick > QUICK * self.size
    }
}

/// How far a pull moves apart or together within some seconds, in m.
pub(super) const fn fall(pull: f64, seconds: f64) -> f64 {
    0.5 * pull * seconds * seconds
}

/// What a turn moves the rim by; a disc and what does not turn stay where they are.
#[inline]
pub(super) fn swing(rim: f64, by: f64) -> f64 {
    if by == 0.0 { 0.0 } else { rim * by.abs() }
}

/// Which of two bodies is the frame, and which is followed in it.
#[inline]
fn larger_first([a, b]: [&Stand; 2]) -> (usize, usize) {
    let second = usize::from(a.rim < b.rim);
    (second, 1 - second)
}

/// What became of a pair since its last look.
#[derive(Clone, Copy, Debug)]
pub(super) struct Since {
    /// Of the smaller one's centre, in m.
    moved: Vec2,
    /// Of its points beside that, at most, in m.
    swung: f64,
    /// From the larger to the smaller; zero if the look left none.
    pub(super) normal: Vec2,
    /// What the gaps of rows are off by for a larger one that turned, in m.
    pub(super) bent: f64,
    /// Some normal is stale.
    pub(super) stale: bool,
    /// The larger one turned too far for what is known of it to be followed.
    pub(super) lost: bool,
}

impl Since {
    #[inline]
    pub(super) fn new(glance: &Glance, both: [&Stand; 2]) -> Self {
        let (f, s) = larger_first(both);
        let apart = both[1].centre - both[0].centre;
        let sign = if f == 0 { 1.0 } else { -1.0 };
        let turns = [
            both[0].angle - glance.angles.0,
            both[1].angle - glance.angles.1,
        ];
        let turn = |k: usize| if both[k].rim > 0.0 { turns[k] } else { 0.0 };
        let (by, own) = (turn(f), turn(s));
        let (then, now) = (glance.apart * sign, apart * sign);
        let n = glance.normal * sign;
        let mut since = Self {
            moved: now - then,
            swung: swing(both[s].rim, own - by),
            normal: n,
            bent: 0.0,
            stale: by.abs() > TURNED || own.abs() > TURNED,
            lost: by.abs() > LOST,
        };
        if by != 0.0 {
            // R(φ) = 1 + φ ⟂ − φ²/2 up to |φ|³/6, of the way as of the normal.
            let half = 0.5 * by * by;
            since.moved += then * half - perp(then) * by;
            since.normal = n * (1.0 - half) + perp(n) * by;
            since.bent = half * then.length();
            let third = by.abs() * (1.0 / 3.0);
            since.swung += (since.bent + half * since.moved.length()) * third;
        }
        since
    }

    /// Of a pair that was looked at just now: nothing.
    #[inline]
    pub(super) fn a_look(glance: &Glance, both: [&Stand; 2]) -> Self {
        let sign = if larger_first(both).0 == 0 { 1.0 } else { -1.0 };
        Self {
            moved: Vec2::ZERO,
            swung: 0.0,
            normal: glance.normal * sign,
            bent: 0.0,
            stale: false,
            lost: false,
        }
    }

    /// What the smaller one's points moved by, at most, in m.
    #[inline]
    pub(super) fn went(&self) -> f64 {
        self.moved.length() + self.swung
    }

    /// What turns alone moved its points by, and gaps are off by for them, at most, in m.
    #[inline]
    pub(super) fn twisted(&self) -> f64 {
        self.swung + self.bent
    }

    /// Strip between the bodies, in m.
    #[inline]
    pub(super) fn strip(&self, gap: f64) -> f64 {
        if self.normal == Vec2::ZERO {
            gap - self.went()
        } else {
            gap + self.normal.dot(self.moved) - self.swung
        }
    }
}
