//! Seeded numbers that are the same on every machine.

use rand_core::Rng as _;
use rand_pcg::Pcg64Mcg;

/// A stream of numbers, told apart from others of the same seed by its own number.
#[derive(Clone, Debug)]
pub(crate) struct Random(Pcg64Mcg);

impl Random {
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        // Neighbouring seeds and streams give unrelated states (SplitMix64: Steele, Lea, Flood 2014).
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            mixed(state)
        };
        let high = next() ^ mixed(stream.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(1));
        let low = next();
        Self(Pcg64Mcg::new(u128::from(high) << 64 | u128::from(low)))
    }

    /// In 0..1, a multiple of 2^-53.
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit a float exactly")]
    pub(crate) fn unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.0.next_u64() >> 11) as f64 * STEP
    }

    /// Between two numbers, either end first; the number itself if they are equal.
    pub(crate) fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }

    /// One of `count` things, by index. The bias of the product is below count / 2^64.
    pub(crate) fn index(&mut self, count: usize) -> usize {
        let wide = u128::from(self.0.next_u64()) * count as u128;
        usize::try_from(wide >> 64).unwrap_or(0)
    }
}

/// The finaliser of SplitMix64: a bijection that spreads every bit.
fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_numbers_of_splitmix64_are_known() {
        // Seed 0: 0xe220a8397b1dcdaf is the generator's published first output.
        assert_eq!(mixed(0x9e37_79b9_7f4a_7c15), 0xe220_a839_7b1d_cdaf);
    }

    #[test]
    fn streams_differ_and_repeat() {
        let first = |seed, stream| {
            let mut random = Random::new(seed, stream);
            [random.unit(), random.unit(), random.between(-1.0, 3.0)]
        };
        assert_eq!(first(1, 2), first(1, 2));
        assert_ne!(first(1, 2), first(1, 3));
        assert_ne!(first(1, 2), first(2, 2));
    }

    #[test]
    fn numbers_fill_their_range_evenly() {
        let mut random = Random::new(7, 0);
        let n = 100_000;
        let (mut sum, mut counts) = (0.0, [0_u32; 7]);
        for _ in 0..n {
            let x = random.unit();
            assert!((0.0..1.0).contains(&x));
            sum += x;
            counts[random.index(7)] += 1;
        }
        // Five standard deviations of the mean, 1/√(12 n), and of a count.
        assert!((sum / f64::from(n) - 0.5).abs() < 5.0 / (12.0 * f64::from(n)).sqrt());
        for count in counts {
            assert!(
                (f64::from(count) - 14_286.0).abs() < 5.0 * 111.0,
                "{counts:?}"
            );
        }
    }
}
