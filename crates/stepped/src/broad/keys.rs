//! The order of movers in a sweep.

/// A mover and its place in the sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key {
    /// Strip above the order of the left end, rounded down to f32.
    place: u64,
    pub(super) piece: u32,
}

impl Key {
    pub(super) fn new(strip: u32, left: f64, piece: u32) -> Self {
        let place = u64::from(strip) << 32 | u64::from(ordered(left));
        Self { place, piece }
    }

    pub(super) const fn strip(self) -> u32 {
        (self.place >> 32) as u32
    }
}

/// Bits that are in the order of the numbers, rounded to f32: equal numbers may get equal bits, and none change places.
pub(super) fn ordered(x: f64) -> u32 {
    let bits = rounded(x).to_bits();
    if bits >> 31 == 0 {
        bits | 1 << 31
    } else {
        !bits
    }
}

pub(super) fn rounded(x: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is monotone")]
    let rounded = x as f32;
    rounded
}
