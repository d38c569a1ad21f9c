//! The random numbers of the harness that the peers were measured with.

use carom_math::{Vec2, cross};

use super::nearest::cos_sin;

/// SplitMix64 (Steele, Lea, Flood 2014) and the shapes drawn from it.
#[derive(Clone, Debug)]
pub(super) struct Harness {
    state: u64,
    /// Cosines and sines of corners so far.
    taken: u32,
    /// Which of them the harness's library did not round to the nearest double, in order: 1 of 760.
    misrounded: &'static [u32],
}

impl Harness {
    pub(super) const fn new(seed: u64, misrounded: &'static [u32]) -> Self {
        Self {
            state: seed,
            taken: 0,
            misrounded,
        }
    }

    /// 64 bits.
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = self.state;
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `count`, by remainder.
    pub(super) fn below(&mut self, count: u32) -> u32 {
        let rest = self.next() % u64::from(count);
        u32::try_from(rest).expect("less than a u32")
    }

    /// In 0..1, a multiple of 2^-53.
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit a float exactly")]
    fn unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.next() >> 11) as f64 * STEP
    }

    /// From `a` to below `b`.
    pub(super) fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }

    /// A vector with both components in ±`reach`.
    pub(super) fn within(&mut self, reach: f64) -> Vec2 {
        let x = self.between(-reach, reach);
        Vec2::new(x, self.between(-reach, reach))
    }

    /// A convex polygon with its corners on a circle, about its centroid.
    pub(super) fn polygon(&mut self, corners: u32, radius: f64) -> Vec<Vec2> {
        const TURN: f64 = 2.0 * core::f64::consts::PI;
        let first = self.between(0.0, TURN);
        let ring: Vec<Vec2> = (0..corners)
            .map(|i| {
                let share = f64::from(i) + self.between(-0.3, 0.3);
                self.corner(first + TURN * share / f64::from(corners), radius)
            })
            .collect();
        let centroid = area_and_centroid(&ring).1;
        ring.into_iter().map(|corner| corner - centroid).collect()
    }

    fn corner(&mut self, angle: f64, radius: f64) -> Vec2 {
        let [x, y] = cos_sin(angle).map(|(nearest, lack)| radius * self.rounded(nearest, lack));
        Vec2::new(x, y)
    }

    /// The nearest double, or the one on the other side of the true value.
    fn rounded(&mut self, nearest: f64, lack: f64) -> f64 {
        let place = self.taken;
        self.taken += 1;
        match self.misrounded {
            [first, rest @ ..] if *first == place => {
                self.misrounded = rest;
                if lack > 0.0 {
                    nearest.next_up()
                } else {
                    nearest.next_down()
                }
            }
            _ => nearest,
        }
    }
}

/// Area and centroid of a ring, by the shoelace formula as the harness evaluated it.
pub(super) fn area_and_centroid(ring: &[Vec2]) -> (f64, Vec2) {
    let (mut twice_area, mut sum) = (0.0, Vec2::ZERO);
    for (i, &a) in ring.iter().enumerate() {
        let b = ring[(i + 1) % ring.len()];
        let part = cross(a, b);
        twice_area += part;
        sum += (a + b) * part;
    }
    (twice_area / 2.0, sum / (3.0 * twice_area))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_numbers_of_seed_42_are_known() {
        let mut random = Harness::new(42, &[]);
        let first = [random.next(), random.next(), random.next()];
        assert_eq!(
            first,
            [
                13_679_457_532_755_275_413,
                2_949_826_092_126_892_291,
                5_139_283_748_462_763_858
            ]
        );
    }

    #[test]
    fn a_polygon_lies_about_its_centroid() {
        let mut random = Harness::new(1, &[]);
        for corners in 3..9 {
            let ring = random.polygon(corners, 2.0);
            let (area, centroid) = area_and_centroid(&ring);
            assert!(area > 1.0 && centroid.length() < 1e-15, "{area} {centroid}");
        }
    }
}
