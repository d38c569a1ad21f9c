//! The only home of transcendental functions: `libm`, equal bits on every platform.
//!
//! Angles are in radians. The standard library's own versions are banned by `clippy.toml`.

/// Sine and cosine of an angle in radians.
#[must_use]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// Sines and cosines of two angles in radians, side by side; the same bits as [`sin_cos`] of each.
///
/// Up to an eighth of a turn both go through fdlibm's polynomials in two lanes, which is faster than one
/// after the other; beyond, one after the other.
#[must_use]
pub fn sin_cos_pair(angles: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    /// Largest angle that the polynomials take without reduction: the cut in fdlibm's high word.
    const EIGHTH: f64 = f64::from_bits(0x3fe9_21fb_ffff_ffff);
    let within = |x: f64| x.abs() <= EIGHTH && x != 0.0;
    if !(within(angles[0]) && within(angles[1])) {
        let [(s0, c0), (s1, c1)] = angles.map(sin_cos);
        return ([s0, s1], [c0, c1]);
    }
    small_pair(angles)
}

/// Not inlined: on its own it compiles to two lanes, within its callers to a mixture.
#[inline(never)]
fn small_pair(angles: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    (angles.map(small_sin), angles.map(small_cos))
}

/// fdlibm's `__kernel_sin`, operation by operation.
fn small_sin(x: f64) -> f64 {
    const S1: f64 = f64::from_bits(0xbfc5_5555_5555_5549);
    const S2: f64 = f64::from_bits(0x3f81_1111_1110_f8a6);
    const S3: f64 = f64::from_bits(0xbf2a_01a0_19c1_61d5);
    const S4: f64 = f64::from_bits(0x3ec7_1de3_57b1_fe7d);
    const S5: f64 = f64::from_bits(0xbe5a_e5e6_8a2b_9ceb);
    const S6: f64 = f64::from_bits(0x3de5_d93a_5acf_d57c);
    let z = x * x;
    let w = z * z;
    let r = S2 + z * (S3 + z * S4) + z * w * (S5 + z * S6);
    x + (z * x) * (S1 + z * r)
}

/// fdlibm's `__kernel_cos`, operation by operation.
fn small_cos(x: f64) -> f64 {
    const C1: f64 = f64::from_bits(0x3fa5_5555_5555_554c);
    const C2: f64 = f64::from_bits(0xbf56_c16c_16c1_5177);
    const C3: f64 = f64::from_bits(0x3efa_01a0_19cb_1590);
    const C4: f64 = f64::from_bits(0xbe92_7e4f_809c_52ad);
    const C5: f64 = f64::from_bits(0x3e21_ee9e_bdb4_b1c4);
    const C6: f64 = f64::from_bits(0xbda8_fae9_be88_38d4);
    let z = x * x;
    let w = z * z;
    let r = z * (C1 + z * (C2 + z * C3)) + w * w * (C4 + z * (C5 + z * C6));
    let half = 0.5 * z;
    let w = 1.0 - half;
    w + (((1.0 - w) - half) + z * r)
}

/// Tangent of an angle in radians.
#[must_use]
pub fn tan(angle: f64) -> f64 {
    libm::tan(angle)
}

/// Angle of the vector (x, y) against the x axis, in radians, in (−π, π].
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Arc cosine, in radians; the argument is clamped to −1..1.
#[must_use]
pub fn acos(cosine: f64) -> f64 {
    libm::acos(cosine.clamp(-1.0, 1.0))
}

/// Natural exponential.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Decimal logarithm.
#[must_use]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// `base` to the power of `exponent`.
#[must_use]
pub fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// `exp(x) − 1`, with all digits where x is small.
#[must_use]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

/// Inverse hyperbolic sine.
#[must_use]
pub fn asinh(x: f64) -> f64 {
    libm::asinh(x)
}

/// Hyperbolic sine and cosine.
#[must_use]
pub fn sinh_cosh(x: f64) -> (f64, f64) {
    (libm::sinh(x), libm::cosh(x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pair_is_single(angles: [f64; 2]) {
        let (sines, cosines) = sin_cos_pair(angles);
        for k in [0, 1] {
            let (sine, cosine) = sin_cos(angles[k]);
            let got = (sines[k].to_bits(), cosines[k].to_bits());
            assert_eq!(got, (sine.to_bits(), cosine.to_bits()), "{:e}", angles[k]);
        }
    }

    #[test]
    fn pairs_have_the_bits_of_single_angles_at_the_borders() {
        let quarter = core::f64::consts::FRAC_PI_4;
        let tiny = 1.0 / 134_217_728.0_f64;
        let near = |x: f64| [x.next_down(), x, x.next_up()];
        let all = [
            quarter,
            tiny,
            2.0_f64.sqrt() * tiny,
            0.0,
            1e-300,
            5e-324,
            f64::INFINITY,
        ];
        let border = f64::from_bits(0x3fe9_21fb_ffff_ffff);
        for x in all.into_iter().chain([border]).flat_map(near) {
            pair_is_single([x, 0.3]);
            pair_is_single([-0.7, -x]);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn pairs_have_the_bits_of_single_angles(x in -0.9..0.9_f64, y in -0.9..0.9_f64, shrink in 0..60_u32) {
            pair_is_single([x, y]);
            pair_is_single([x / (1_u64 << shrink) as f64, 8.0 * y]);
        }
    }
}
