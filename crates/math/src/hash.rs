//! A hash of state bits: the same run gives the same number everywhere.

use crate::{SimTime, Vec2};

/// FNV-1a over the bits of what is written, −0 taken as 0.
///
/// Not for hash tables: a fingerprint of a world, to compare runs, builds and machines.
#[derive(Clone, Copy, Debug)]
pub struct StateHash(u64);

impl Default for StateHash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl StateHash {
    /// Writes a number.
    pub fn write(&mut self, value: f64) {
        // −0 + 0 is +0.
        self.write_u64((value + 0.0).to_bits());
    }

    /// Writes both components.
    pub fn write_vec2(&mut self, value: Vec2) {
        self.write(value.x);
        self.write(value.y);
    }

    /// Writes an instant, with all its digits.
    pub fn write_time(&mut self, time: SimTime) {
        self.write_u64(time.units().cast_unsigned());
        self.write(time.rest());
    }

    /// Writes a whole number.
    pub fn write_u64(&mut self, value: u64) {
        for byte in value.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// The fingerprint of all that was written.
    #[must_use]
    pub const fn finish(self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_that_differ_by_less_than_an_ulp_of_their_seconds_are_two_states() {
        let late = SimTime::from_secs(10_000.0);
        let [a, b] = [late, late + 1e-15].map(|time| {
            let mut hash = StateHash::default();
            hash.write_time(time);
            hash.finish()
        });
        assert_ne!(a, b);
    }

    #[test]
    fn signed_zeros_are_one_state() {
        let (mut a, mut b, mut c) = <(StateHash, StateHash, StateHash)>::default();
        a.write(0.0);
        b.write(-0.0);
        c.write(f64::MIN_POSITIVE);
        assert_eq!(a.finish(), b.finish());
        assert_ne!(a.finish(), c.finish());
    }
}
