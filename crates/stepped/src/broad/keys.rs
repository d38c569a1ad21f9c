//! The order of movers in a sweep, made from that of before.

/// Keys change places so many times each, on average, while they are put in order; what takes more is sorted anew.
const SHIFTS: usize = 8;

/// No place.
const NONE: u32 = u32::MAX;

/// A mover and its place in the sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key {
    /// Strip above the order of the left end, rounded down to f32.
    pub(super) place: u64,
    pub(super) piece: u32,
    pub(super) moved: bool,
}

/// Makes `keys` those of `fresh`, in order: from tick to tick few change places. `places` is scratch, by piece.
pub(super) fn put_in_order(keys: &mut Vec<Key>, fresh: &[Key], places: &mut Vec<u32>) {
    for (key, k) in fresh.iter().zip(0u32..) {
        let at = key.piece as usize;
        if places.len() <= at {
            places.resize(at + 1, NONE);
        }
        places[at] = k;
    }
    keys.retain_mut(|key| {
        let place = places.get_mut(key.piece as usize);
        let place = place.map_or(NONE, |place| core::mem::replace(place, NONE));
        let stays = place != NONE;
        if stays {
            *key = fresh[place as usize];
        }
        stays
    });
    if keys.len() < fresh.len() {
        let came = |key: &&Key| core::mem::replace(&mut places[key.piece as usize], NONE) != NONE;
        keys.extend(fresh.iter().filter(came));
    }
    if !insert_each(keys) {
        keys.sort_unstable();
    }
}

/// Puts keys in order that nearly are; whether that took few changes of places.
fn insert_each(keys: &mut [Key]) -> bool {
    let mut left = SHIFTS * keys.len();
    for k in 1..keys.len() {
        let key = keys[k];
        let mut at = k;
        while at > 0 && key < keys[at - 1] {
            keys[at] = keys[at - 1];
            at -= 1;
        }
        keys[at] = key;
        if k - at > left {
            return false;
        }
        left -= k - at;
    }
    true
}

impl Key {
    pub(super) const fn strip(self) -> u32 {
        (self.place >> 32) as u32
    }

    #[expect(clippy::cast_possible_truncation, reason = "the lower half")]
    pub(super) const fn left(self) -> u32 {
        self.place as u32
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
