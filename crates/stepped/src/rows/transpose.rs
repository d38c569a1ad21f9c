//! Rows of four numbers as columns, and columns as rows: numbers change places, and nothing else.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use crate::LineIx;
use fearless_simd::{
    ExtractToken, Simd, SimdBase, SimdCombine, SimdFloat, SimdMask, SimdSplit, f64x4, f64x8,
};

/// What lies in memory as whole rows of four numbers.
pub(crate) trait Numbers {
    /// All of them.
    fn numbers(&self) -> &[f64];
}

/// The same, to write to.
pub(crate) trait NumbersMut: Numbers {
    /// The first four.
    fn first(&mut self) -> &mut [f64; 4];
}

/// A register of as many lanes as the processor likes best: four but with AVX-512. A block is swept in one or two goes.
pub(crate) trait Wide<S: Simd>: SimdFloat<S, Element = f64> {
    /// Lanes in a register.
    const LANES: usize;

    /// Four columns of the rows that begin at number `from` of each.
    fn columns<L: Numbers>(simd: S, list: &[L], at: &[LineIx], from: usize) -> [Self; 4];

    /// The same of these.
    fn columns_of<L: Numbers>(simd: S, of: &[&L], from: usize) -> [Self; 4];

    /// Writes four columns back to the first rows.
    fn write<L: NumbersMut>(list: &mut [L], at: &[LineIx], columns: [Self; 4]);
}

/// Whether a lane of a mask is set.
#[inline(always)]
pub(crate) fn any<S: Simd, M: SimdMask<S>>(mask: M) -> bool {
    mask.to_bitmask() != 0
}

impl<S: Simd> Wide<S> for f64x4<S> {
    const LANES: usize = 4;

    #[inline(always)]
    fn columns<L: Numbers>(simd: S, list: &[L], at: &[LineIx], from: usize) -> [Self; 4] {
        let at: &[LineIx; 4] = at.first_chunk().expect("four lanes");
        let (l0, l1) = (&list[at[0].at()], &list[at[1].at()]);
        let (l2, l3) = (&list[at[2].at()], &list[at[3].at()]);
        Self::columns_of(simd, &[l0, l1, l2, l3], from)
    }

    #[inline(always)]
    fn columns_of<L: Numbers>(simd: S, of: &[&L], from: usize) -> [Self; 4] {
        let of: &[&L; 4] = of.first_chunk().expect("four lanes");
        let l0 = Self::from_slice(simd, &of[0].numbers()[from..from + 4]);
        let l1 = Self::from_slice(simd, &of[1].numbers()[from..from + 4]);
        let l2 = Self::from_slice(simd, &of[2].numbers()[from..from + 4]);
        let l3 = Self::from_slice(simd, &of[3].numbers()[from..from + 4]);
        turned(simd, [l0, l1, l2, l3])
    }

    #[inline(always)]
    fn write<L: NumbersMut>(list: &mut [L], at: &[LineIx], columns: [Self; 4]) {
        let at: &[LineIx; 4] = at.first_chunk().expect("four lanes");
        let [l0, l1, l2, l3] = turned(columns[0].token(), columns);
        l0.store_slice(list[at[0].at()].first());
        l1.store_slice(list[at[1].at()].first());
        l2.store_slice(list[at[2].at()].first());
        l3.store_slice(list[at[3].at()].first());
    }
}

impl<S: Simd> Wide<S> for f64x8<S> {
    const LANES: usize = 8;

    #[inline(always)]
    fn columns<L: Numbers>(simd: S, list: &[L], at: &[LineIx], from: usize) -> [Self; 4] {
        let low = <f64x4<S> as Wide<S>>::columns(simd, list, &at[..4], from);
        let high = <f64x4<S> as Wide<S>>::columns(simd, list, &at[4..], from);
        let ([x, y, z, w], [p, q, r, s]) = (low, high);
        [x.combine(p), y.combine(q), z.combine(r), w.combine(s)]
    }

    #[inline(always)]
    fn columns_of<L: Numbers>(simd: S, of: &[&L], from: usize) -> [Self; 4] {
        let low = <f64x4<S> as Wide<S>>::columns_of(simd, &of[..4], from);
        let high = <f64x4<S> as Wide<S>>::columns_of(simd, &of[4..], from);
        let ([x, y, z, w], [p, q, r, s]) = (low, high);
        [x.combine(p), y.combine(q), z.combine(r), w.combine(s)]
    }

    #[inline(always)]
    fn write<L: NumbersMut>(list: &mut [L], at: &[LineIx], [x, y, z, w]: [Self; 4]) {
        let ((x, p), (y, q), (z, r), (w, s)) = (x.split(), y.split(), z.split(), w.split());
        f64x4::write(list, &at[..4], [x, y, z, w]);
        f64x4::write(list, &at[4..], [p, q, r, s]);
    }
}

/// Four columns as rows.
#[inline(always)]
pub(crate) fn rows_of<S: Simd>(columns: [f64x4<S>; 4]) -> [f64x4<S>; 4] {
    turned(columns[0].token(), columns)
}

/// Rows as columns.
#[inline(always)]
fn turned<S: Simd>(simd: S, [l0, l1, l2, l3]: [f64x4<S>; 4]) -> [f64x4<S>; 4] {
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = simd.level().as_avx2() {
        use fearless_simd::SimdInto;
        let [x, y, z, w] = avx2::turned(avx2, l0.into(), l1.into(), l2.into(), l3.into());
        return [
            x.simd_into(simd),
            y.simd_into(simd),
            z.simd_into(simd),
            w.simd_into(simd),
        ];
    }
    let _ = simd;
    let (a, b) = (l0.zip_low(l2), l1.zip_low(l3));
    let (c, d) = (l0.zip_high(l2), l1.zip_high(l3));
    [a.zip_low(b), a.zip_high(b), c.zip_low(d), c.zip_high(d)]
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use core::arch::x86_64::{
        __m256d, _mm256_permute2f128_pd, _mm256_unpackhi_pd, _mm256_unpacklo_pd,
    };

    fearless_simd::kernel!(
        /// Eight shuffles: pairs within halves, then halves.
        #[inline(always)]
        pub(super) fn turned(
            avx2: Avx2,
            p: __m256d,
            q: __m256d,
            r: __m256d,
            s: __m256d,
        ) -> [__m256d; 4] {
            let (a, b) = (_mm256_unpacklo_pd(p, q), _mm256_unpackhi_pd(p, q));
            let (c, d) = (_mm256_unpacklo_pd(r, s), _mm256_unpackhi_pd(r, s));
            [
                _mm256_permute2f128_pd::<0x20>(a, c),
                _mm256_permute2f128_pd::<0x20>(b, d),
                _mm256_permute2f128_pd::<0x31>(a, c),
                _mm256_permute2f128_pd::<0x31>(b, d),
            ]
        }
    );
}
