//! The widest registers that a processor has.

/// Calls a function of a level of instructions and a register type, [`super::Wide`]: eight lanes with AVX-512, else four, since eight would be
/// two registers each, more than there are. Each level is compiled for its own width alone.
///
/// ```text
/// widest!(level => function(arguments))  ─►  function::<Avx512, f64x8<_>>(simd, arguments), or Avx2 or Sse2 and f64x4
/// ```
macro_rules! widest {
    ($level:expr => $function:ident($($argument:expr),* $(,)?)) => {{
        #[cfg(target_arch = "x86_64")]
        {
            use fearless_simd::Simd as _;
            let level = $level;
            if let Some(simd) = level.as_avx512() {
                simd.vectorize(
                    #[inline(always)]
                    || $function::<_, fearless_simd::f64x8<_>>(simd, $($argument),*),
                )
            } else if let Some(simd) = level.as_avx2() {
                simd.vectorize(
                    #[inline(always)]
                    || $function::<_, fearless_simd::f64x4<_>>(simd, $($argument),*),
                )
            } else {
                let simd = level.as_sse2().expect("every such processor has it");
                simd.vectorize(
                    #[inline(always)]
                    || $function::<_, fearless_simd::f64x4<_>>(simd, $($argument),*),
                )
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        fearless_simd::dispatch!(
            $level,
            simd => $function::<_, fearless_simd::f64x4<_>>(simd, $($argument),*)
        )
    }};
}

pub(crate) use widest;
