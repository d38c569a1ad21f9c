//! Whatever numbers come in, an answer comes out, and no panic.

use carom_math::{Vec2, vec2};

mod collision;
mod impact;

/// Numbers by chance, some of them none.
struct Odd {
    state: u64,
    /// One number in so many may be none.
    one_in: usize,
}

impl Odd {
    fn new(seed: u64, one_in: usize) -> Self {
        Self {
            state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1,
            one_in,
        }
    }

    fn below(&mut self, n: usize) -> usize {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        usize::try_from(self.state >> 33).expect("31 bits") % n
    }

    fn number(&mut self) -> f64 {
        const ODD: [f64; 22] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            1e308,
            -1e308,
            5e-324,
            1e-300,
            1e12,
            -1e13,
            0.1,
            1e-30,
            1e154,
            2.0,
            -3.0,
            f64::MAX,
            f64::MIN_POSITIVE,
            0.5,
            1e6,
        ];
        const PLAIN: [f64; 8] = [0.0, 1.0, -1.0, 0.5, 2.0, -0.3, 0.1, 3.0];
        if self.below(self.one_in) == 0 {
            ODD[self.below(ODD.len())]
        } else {
            PLAIN[self.below(PLAIN.len())]
        }
    }

    fn vector(&mut self) -> Vec2 {
        vec2(self.number(), self.number())
    }
}
