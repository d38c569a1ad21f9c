//! Eight halves of lines as columns, and columns as halves: numbers change places, and nothing else.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Simd, SimdBase, SimdCombine, SimdSplit, f64x4, f64x8};

use super::wide::LANES;

/// Four columns of eight rows of four numbers.
#[inline(always)]
pub(super) fn columns<S: Simd>(simd: S, rows: [&[f64]; LANES]) -> [f64x8<S>; 4] {
    let [l0, l1, l2, l3, l4, l5, l6, l7] = rows;
    #[cfg(target_arch = "x86_64")]
    if let Some(avx512) = simd.level().as_avx512() {
        use fearless_simd::SimdInto;
        let turned = avx512::columns(
            avx512,
            pair(simd, l0, l2).into(),
            pair(simd, l1, l3).into(),
            pair(simd, l4, l6).into(),
            pair(simd, l5, l7).into(),
        );
        let [x, y, z, w] = turned;
        return [
            x.simd_into(simd),
            y.simd_into(simd),
            z.simd_into(simd),
            w.simd_into(simd),
        ];
    }
    // Two rounds that part even places from odd ones.
    let (ab, cd) = (pair(simd, l0, l1), pair(simd, l2, l3));
    let (ef, gh) = (pair(simd, l4, l5), pair(simd, l6, l7));
    let (even0, odd0) = (ab.unzip_low(cd), ab.unzip_high(cd));
    let (even1, odd1) = (ef.unzip_low(gh), ef.unzip_high(gh));
    [
        even0.unzip_low(even1),
        odd0.unzip_low(odd1),
        even0.unzip_high(even1),
        odd0.unzip_high(odd1),
    ]
}

#[inline(always)]
fn pair<S: Simd>(simd: S, low: &[f64], high: &[f64]) -> f64x8<S> {
    f64x4::from_slice(simd, low).combine(f64x4::from_slice(simd, high))
}

/// Eight rows of four columns.
#[inline(always)]
pub(super) fn rows<S: Simd>([x, y, z, w]: [f64x8<S>; 4]) -> [f64x4<S>; LANES] {
    let (low, high) = (x.zip_low(z), x.zip_high(z));
    let (low2, high2) = (y.zip_low(w), y.zip_high(w));
    let (l0, l1) = low.zip_low(low2).split();
    let (l2, l3) = low.zip_high(low2).split();
    let (l4, l5) = high.zip_low(high2).split();
    let (l6, l7) = high.zip_high(high2).split();
    [l0, l1, l2, l3, l4, l5, l6, l7]
}

#[cfg(target_arch = "x86_64")]
mod avx512 {
    use core::arch::x86_64::{
        __m512d, _mm512_shuffle_f64x2, _mm512_unpackhi_pd, _mm512_unpacklo_pd,
    };

    fearless_simd::kernel!(
        /// Columns of the rows (0, 2), (1, 3), (4, 6), (5, 7): what lies side by side is parted first, so that no table of
        /// places must be read or copied.
        #[inline(always)]
        pub(super) fn columns(
            avx512: Avx512,
            p: __m512d,
            q: __m512d,
            r: __m512d,
            s: __m512d,
        ) -> [__m512d; 4] {
            let (even0, odd0) = (_mm512_unpacklo_pd(p, q), _mm512_unpackhi_pd(p, q));
            let (even1, odd1) = (_mm512_unpacklo_pd(r, s), _mm512_unpackhi_pd(r, s));
            [
                _mm512_shuffle_f64x2::<0b10_00_10_00>(even0, even1),
                _mm512_shuffle_f64x2::<0b10_00_10_00>(odd0, odd1),
                _mm512_shuffle_f64x2::<0b11_01_11_01>(even0, even1),
                _mm512_shuffle_f64x2::<0b11_01_11_01>(odd0, odd1),
            ]
        }
    );
}
