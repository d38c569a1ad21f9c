//! What bodies wear, and what is drawn over them.

use std::collections::BTreeMap;

use carom_dynamics::{Body, BodyId, BodyKind};

use crate::{BODY_COLOURS, Colour, Face, Overlay, Paint, Style};

/// Fill of fixed bodies: a grey that stays behind on light and dark ground.
pub const FIXED_COLOUR: Colour = Colour::hex(0x8A93A0);

/// Fill of kinematic bodies: the same, with a cast of blue.
pub const KINEMATIC_COLOUR: Colour = Colour::hex(0x6F86A6);

/// Paints, faces and overlays of a world's pictures.
///
/// A body has the paint given to it; otherwise a fixed one is grey and a moving one takes its turn in
/// the palette, which the seed shuffles.
///
/// # Examples
/// ```
/// use carom_render::{Colour, Look, Overlay, Paint};
/// let mut look = Look::seeded(7);
/// look.overlay = Overlay { velocities: Some(0.25), time: true, ..Overlay::default() };    // s of motion per arrow
/// assert_eq!(look.colour(3), Look::seeded(7).colour(3));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Shuffles the palette.
    pub seed: u64,
    /// Fills of moving bodies, in turn; empty is grey.
    pub palette: Vec<Colour>,
    /// Whether discs are shaded as balls.
    pub shaded: bool,
    /// Whether discs without a face show how they are turned, by a line to their rim.
    pub spokes: bool,
    /// The face of every moving disc that has none of its own.
    pub face: Option<Face>,
    /// What is drawn over the bodies.
    pub overlay: Overlay,
    /// The ink that suits: what the scene would be painted with.
    pub style: Style,
    /// Paints of single bodies.
    pub paints: BTreeMap<BodyId, Paint>,
    /// Faces of single bodies, drawn on their discs.
    pub faces: BTreeMap<BodyId, Face>,
}

impl Default for Look {
    fn default() -> Self {
        Self::seeded(0)
    }
}

impl Look {
    /// The default look with the palette shuffled by `seed`.
    #[must_use]
    pub fn seeded(seed: u64) -> Self {
        Self {
            seed,
            palette: BODY_COLOURS.to_vec(),
            shaded: false,
            spokes: true,
            face: None,
            overlay: Overlay::default(),
            style: Style::default(),
            paints: BTreeMap::new(),
            faces: BTreeMap::new(),
        }
    }

    /// Gives a body a paint of its own.
    pub fn set_paint(&mut self, body: BodyId, paint: Paint) {
        self.paints.insert(body, paint);
    }

    /// Gives a body a fill of its own.
    pub fn set_colour(&mut self, body: BodyId, colour: Colour) {
        let paint = self.dressed(colour);
        self.set_paint(body, paint);
    }

    /// Gives a body a face, drawn on its discs.
    pub fn set_face(&mut self, body: BodyId, face: Face) {
        self.faces.insert(body, face);
    }

    /// What a body is painted with.
    #[must_use]
    pub fn paint(&self, body: &Body<'_>) -> Paint {
        if let Some(paint) = self.paints.get(&body.id()) {
            return *paint;
        }
        match body.kind() {
            BodyKind::Fixed => Paint::flat(FIXED_COLOUR),
            BodyKind::Kinematic => Paint::flat(KINEMATIC_COLOUR),
            BodyKind::Dynamic => self.dressed(self.colour(body.id().index())),
        }
    }

    /// The face of a body's discs, if they have one.
    #[must_use]
    pub fn face(&self, body: &Body<'_>) -> Option<&Face> {
        let own = self.faces.get(&body.id());
        let common = self.face.as_ref();
        own.or_else(|| common.filter(|_| body.kind() == BodyKind::Dynamic))
    }

    /// The palette's colour for the moving body at `index`: neighbours differ, and all colours appear equally often.
    #[must_use]
    pub fn colour(&self, index: usize) -> Colour {
        let count = self.palette.len();
        if count == 0 {
            return FIXED_COLOUR;
        }
        // A seeded start and stride; a stride without a common divisor visits every colour.
        let strides: Vec<usize> = (1..count.max(2))
            .filter(|&s| divisor(s, count) == 1)
            .collect();
        let mixed = split_mix(self.seed);
        let pick = |bits: u64, below: usize| usize::try_from(bits % below as u64).unwrap_or(0);
        let stride = strides[pick(mixed >> 32, strides.len())];
        let start = pick(mixed & 0xFFFF_FFFF, count);
        let base = self.palette[(start + stride * (index % count)) % count];
        // A little lighter or darker, so that many bodies do not look alike.
        let wobble = split_mix(self.seed ^ (index as u64 + 1));
        #[expect(clippy::cast_precision_loss, reason = "16 bits")]
        let part = (wobble & 0xFFFF) as f64 / 65536.0 * 0.14;
        let towards = if wobble >> 63 == 0 {
            Colour::WHITE
        } else {
            Colour::BLACK
        };
        base.mixed(towards.with_alpha(base.alpha), part)
    }

    const fn dressed(&self, fill: Colour) -> Paint {
        Paint {
            fill,
            outline: None,
            shaded: self.shaded,
        }
    }
}

fn divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { divisor(b, a % b) }
}

/// `SplitMix64` (Steele, Lea and Flood 2014): one step of a counter, well mixed.
const fn split_mix(seed: u64) -> u64 {
    let x = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn neighbours_differ_and_every_colour_takes_its_turn(seed: u64, first in 0..1000_usize) {
            let look = Look { palette: (0..9).map(|i| Colour::rgb(28 * i, 0, 255)).collect(), ..Look::seeded(seed) };
            // The wobble moves the hue's channels by 14 % at most: 28 steps apart stay apart.
            let nearest = |i: usize| {
                let colour = look.colour(i);
                (0..9).min_by_key(|&k| {
                    let original = look.palette[k];
                    let bend = |towards: Colour, part: i32| {
                        let mixed = original.mixed(towards, f64::from(part) / 100.0);
                        mixed.red.abs_diff(colour.red).max(mixed.green.abs_diff(colour.green)).max(mixed.blue.abs_diff(colour.blue))
                    };
                    (0..15).map(|part| bend(Colour::WHITE, part).min(bend(Colour::BLACK, part))).min()
                })
            };
            let mut seen: Vec<_> = (first..first + 9).map(nearest).collect();
            seen.sort_unstable();
            seen.dedup();
            prop_assert_eq!(seen.len(), 9);
        }

        #[test]
        fn any_palette_gives_a_colour(seed: u64, count in 0..12_usize, index in 0..usize::MAX) {
            let look = Look { palette: vec![BODY_COLOURS[0]; count], ..Look::seeded(seed) };
            prop_assert_eq!(look.colour(index).alpha, 255);
        }
    }
}
