//! Cosine and sine of two angles at once, without a branch.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_math::Rot;
use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f64x4, u64x4};

/// Angles up to which [`sines_and_cosines`] keeps its digits, in rad: whole quarters below 2^20 times 33 bits are exact.
pub(super) const LARGEST: f64 = 1e5;

/// 1.5 · 2^52: what is added to it is rounded to a whole number, which is in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// π/2 in two pieces, the first of 33 bits (fdlibm).
const QUARTER: [u64; 2] = [0x3ff9_21fb_5440_0000, 0x3dd0_b461_1a62_6331];

/// Coefficients of fdlibm's polynomials, sine and cosine, from x³ and x⁴ on.
const SINE: [u64; 6] = [
    0xbfc5_5555_5555_5549,
    0x3f81_1111_1110_f8a6,
    0xbf2a_01a0_19c1_61d5,
    0x3ec7_1de3_57b1_fe7d,
    0xbe5a_e5e6_8a2b_9ceb,
    0x3de5_d93a_5acf_d57c,
];
const COSINE: [u64; 6] = [
    0x3fa5_5555_5555_554c,
    0xbf56_c16c_16c1_5177,
    0x3efa_01a0_19cb_1590,
    0xbe92_7e4f_809c_52ad,
    0x3e21_ee9e_bdb4_b1c4,
    0xbda8_fae9_be88_38d4,
];

#[inline(always)]
fn coefficients<S: Simd>(simd: S, k: usize) -> f64x4<S> {
    let (s, c) = (f64::from_bits(SINE[k]), f64::from_bits(COSINE[k]));
    f64x4::load_array(simd, [s, s, c, c])
}

/// Sines of both angles, then their cosines: each to 2e-16, the same bits for every width.
///
/// Whole quarter turns come off by Cody and Waite's reduction. What is left goes through fdlibm's polynomials, sines in two
/// lanes, cosines in the other two:
/// ```text
/// sin x = x + x z P(z)        cos x = 1 − z/2 + z² Q(z)        z = x²
/// ```
#[inline(always)]
pub(super) fn sines_and_cosines<S: Simd>(simd: S, [a, b]: [f64; 2]) -> [f64; 4] {
    let angle = f64x4::load_array(simd, [a, b, a, b]);
    let shifted =
        angle * f64x4::splat(simd, core::f64::consts::FRAC_2_PI) + f64x4::splat(simd, WHOLE);
    let quarters = shifted - f64x4::splat(simd, WHOLE);
    let [high, low] = QUARTER.map(f64::from_bits);
    let x = (angle - quarters * f64x4::splat(simd, high)) - quarters * f64x4::splat(simd, low);
    let z = x * x;
    let w = z * z;
    let [c0, c1, c2] = [0, 2, 4];
    let p = (coefficients(simd, c0) + coefficients(simd, c0 + 1) * z)
        + w * ((coefficients(simd, c1) + coefficients(simd, c1 + 1) * z)
            + w * (coefficients(simd, c2) + coefficients(simd, c2 + 1) * z));
    let (one, half) = (f64x4::splat(simd, 1.0), f64x4::splat(simd, 0.5));
    let of_cosine = f64x4::load_array(simd, [0.0, 0.0, 1.0, 1.0]).simd_eq(one);
    let begin = of_cosine.select(one - half * z, x);
    let factor = of_cosine.select(w, x * z);
    let straight = begin + factor * p;
    // An odd quarter swaps sine and cosine; in the third and fourth the sine is below 0, in the second and third the
    // cosine.
    let swapped = straight.slide::<2>(straight);
    let turns = shifted.to_bits();
    let [first, second] = [1, 2].map(|bit| u64x4::splat(simd, bit));
    let odd = (turns & first).simd_eq(first);
    let shift = u64x4::load_array(simd, [0, 0, 1, 1]);
    let sign = ((turns + shift) & second) << 62;
    let value = odd.select(swapped, straight);
    f64x4::from_bits(value.to_bits() ^ sign).to_array()
}

/// Two rotations, each followed by its angle in rad; not brought back to unit length.
#[inline(always)]
pub(super) fn turned<S: Simd>(simd: S, rotations: [Rot; 2], angles: [f64; 2]) -> [Rot; 2] {
    let [sa, sb, ca, cb] = sines_and_cosines(simd, angles);
    [
        Rot::from_cos_sin(ca, sa) * rotations[0],
        Rot::from_cos_sin(cb, sb) * rotations[1],
    ]
}
