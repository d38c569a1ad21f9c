//! How much heavier one of two bodies is, and from when on that matters.

/// A body so many times as heavy as the one that gives way to it is a load that one sweep does not carry.
pub(crate) const BEARS: f64 = 16.0;

/// How many times as heavy the heavier of two bodies is; 1 beside what cannot be moved. From their inverse masses.
pub(crate) fn mass_ratio(masses: [f64; 2]) -> f64 {
    let [light, heavy] = [masses[0].max(masses[1]), masses[0].min(masses[1])];
    if heavy > 0.0 { light / heavy } else { 1.0 }
}
