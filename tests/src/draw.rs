//! Numbers and shapes drawn from a seed.

use carom_geometry::{Circle, Compound, ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Vec2, trig, vec2};

/// `SplitMix64`.
#[derive(Clone, Debug)]
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xA076_1D64_78BD_642F))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// 0 ≤ x < 1.
    fn part(&mut self) -> f64 {
        f64::from((self.next() >> 32) as u32) / 4_294_967_296.0
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next() % count as u64).expect("below a usize")
    }

    pub(crate) fn chance(&mut self, part: f64) -> bool {
        self.part() < part
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    /// Evenly over orders of magnitude.
    pub(crate) fn log(&mut self, low: f64, high: f64) -> f64 {
        trig::exp(self.between(trig::ln(low), trig::ln(high)))
    }

    /// Within a square about 0.
    pub(crate) fn inside(&mut self, half: f64) -> Vec2 {
        vec2(self.between(-half, half), self.between(-half, half))
    }
}

/// A block behind a line at `half`, as long as the box and a unit more at either end, and two units thick.
pub(crate) fn wall(outward: Vec2, half: f64, unit: f64) -> Shape {
    let along = vec2(outward.x.abs(), outward.y.abs());
    let sides = 2.0 * (half + 2.0 * unit) * (Vec2::ONE - along) + 2.0 * unit * along;
    let block = ConvexPolygon::rectangle(sides.x, sides.y).expect("a block");
    block.translated(-outward * (half + unit)).into()
}

/// Any shape that moves, within `reach` of the origin.
pub(crate) fn shape(dice: &mut Dice, reach: f64) -> Shape {
    let rectangle =
        |width: f64, height: f64| ConvexPolygon::rectangle(width, height).expect("a rectangle");
    match dice.below(7) {
        0 | 1 => Circle::new(reach).expect("a disc").into(),
        2 => rectangle(1.4 * reach, 1.4 * reach * dice.between(0.2, 1.0)).into(),
        // Thin and long.
        3 => rectangle(1.9 * reach, 1.9 * reach * dice.log(1e-3, 0.1)).into(),
        4 => ConvexPolygon::regular(3 + dice.below(7), reach)
            .expect("a polygon")
            .into(),
        5 => Polygon::star(3 + dice.below(5), reach, reach * dice.between(0.2, 0.9))
            .expect("a star")
            .into(),
        _ => {
            let disc = Circle::new(0.45 * reach).expect("a disc").into();
            let five = ConvexPolygon::regular(5, 0.45 * reach)
                .expect("a pentagon")
                .into();
            let at = |x: f64| Pose::at(vec2(x * reach, 0.0));
            let both = Compound::new([(disc, at(-0.5)), (five, at(0.5))]);
            both.expect("a compound").into()
        }
    }
}
