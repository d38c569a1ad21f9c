//! A slow twin of the mass properties: whole numbers of any length, so that nothing is rounded but
//! the answer.

use carom_math::{Pose, Rot, Vec2, vec2};
use num_bigint::BigInt;
use proptest::prelude::*;

use super::anything::points;
use super::random_laws::numbers;
use super::strategies::ring;
use crate::{AreaProperties, ConvexPolygon, Polygon, Region, ring_properties};

/// The promise of [`ring_properties`].
const PROMISE: f64 = 2e-13;

/// `x · 2^power`, exact; `power` is at least that of the last bit of x.
fn whole(x: f64, power: i32) -> BigInt {
    let bits = x.to_bits();
    let field = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)).cast_signed();
    let (digits, exponent) = if field == 0 {
        (fraction, -1074)
    } else {
        (fraction | 1 << 52, field - 1075)
    };
    let digits = if x < 0.0 { -digits } else { digits };
    if digits == 0 {
        return BigInt::ZERO;
    }
    let shift = exponent + power;
    if shift >= 0 {
        BigInt::from(digits) << shift
    } else {
        let zeros = digits.trailing_zeros().cast_signed();
        assert!(zeros >= -shift, "{x} has bits below 2^-{power}");
        BigInt::from(digits >> -shift)
    }
}

/// The power of two that makes `x` a whole number.
fn power_of(x: f64) -> i32 {
    let exponent = ((x.to_bits() >> 52) & 0x7ff) as i32;
    let digits = (x.to_bits() & ((1 << 52) - 1)) | 1 << 52;
    if x == 0.0 {
        0
    } else {
        1075 - exponent.max(1) - digits.trailing_zeros().cast_signed()
    }
}

/// `n / d · 2^power`, right to a few 2⁻⁶⁴.
fn ratio(n: &BigInt, d: &BigInt, power: i32) -> f64 {
    let bits = |x: &BigInt| i32::try_from(x.bits()).expect("numbers of a few thousand bits");
    if *n == BigInt::ZERO {
        return 0.0;
    }
    // A quotient of 80 bits or so.
    let up = (80 - bits(n) + bits(d)).max(0);
    let quotient: BigInt = (n << up) / d;
    let drop = (bits(&quotient) - 80).max(0);
    let digits = i128::try_from(&quotient >> drop).expect("80 bits") as f64;
    let mut value = digits;
    let mut left = power + drop - up;
    while left != 0 {
        let step = left.clamp(-1000, 1000);
        value *= carom_math::trig::pow(2.0, f64::from(step));
        left -= step;
    }
    value
}

/// Area properties of what closed rings wind around, each value rounded once or twice; `None` if that
/// is nothing.
fn exact(rings: &[&[Vec2]]) -> Option<AreaProperties> {
    let all = || rings.iter().flat_map(|ring| ring.iter());
    let power = all()
        .flat_map(|p| [power_of(p.x), power_of(p.y)])
        .max()?
        .max(0);
    let [mut twice, mut cx, mut cy, mut xx, mut yy, mut xy] = [const { BigInt::ZERO }; 6];
    for ring in rings {
        let points: Vec<(BigInt, BigInt)> = ring
            .iter()
            .map(|p| (whole(p.x, power), whole(p.y, power)))
            .collect();
        for ((x, y), (u, v)) in points.iter().zip(points.iter().cycle().skip(1)) {
            let k = x * v - y * u;
            cx += &k * (x + u);
            cy += &k * (y + v);
            xx += &k * (x * x + x * u + u * u);
            yy += &k * (y * y + y * v + v * v);
            xy += &k * (x * (2 * y + v) + u * (y + 2 * v));
            twice += k;
        }
    }
    if twice == BigInt::ZERO {
        return None;
    }
    if twice < BigInt::ZERO {
        for sum in [&mut twice, &mut cx, &mut cy, &mut xx, &mut yy, &mut xy] {
            *sum = -&*sum;
        }
    }
    // About the centroid: ∫ x² − A C_x² = Σxx/12 − Σcx²/(18 Σk), and so on.
    let second = |sum: &BigInt, a: &BigInt, b: &BigInt| 3 * sum * &twice - 2 * a * b;
    let (iyy, ixx) = (second(&xx, &cx, &cx), second(&yy, &cy, &cy));
    let ixy: BigInt = 3 * &xy * &twice - 4 * &cx * &cy;
    let moment = |n: &BigInt, parts: i32| ratio(n, &(parts * &twice), -4 * power);
    let place = |sum: &BigInt| ratio(sum, &(3 * &twice), -power);
    Some(AreaProperties {
        area: ratio(&twice, &BigInt::from(2), -2 * power),
        centroid: vec2(place(&cx), place(&cy)),
        polar: moment(&(&ixx + &iyy), 36),
        ixx: moment(&ixx, 36),
        iyy: moment(&iyy, 36),
        ixy: moment(&ixy, 72),
    })
}

/// Whether area and moment are more than 1e-15 of what they could be.
fn is_promised(ring: &[Vec2], right: &AreaProperties) -> bool {
    let reach = ring.iter().map(|p| p.distance(ring[0])).fold(0.0, f64::max);
    let ends = ring.iter().zip(ring.iter().cycle().skip(1));
    let girth: f64 = ends.map(|(p, q)| p.distance(*q)).sum();
    right.area > 1e-15 * reach * girth && right.polar > 1e-15 * reach * reach * reach * girth
}

fn check(found: &AreaProperties, rings: &[&[Vec2]]) -> Result<(), TestCaseError> {
    let Some(right) = exact(rings) else {
        return Err(TestCaseError::reject("no area"));
    };
    let close = |name: &str, found: f64, right: f64, scale: f64| {
        let error = (found - right).abs() / scale;
        prop_assert!(
            error <= PROMISE,
            "{} {:e} instead of {:e}: off by {:e}",
            name,
            found,
            right,
            error
        );
        Ok(())
    };
    close("area", found.area, right.area, right.area)?;
    close("polar", found.polar, right.polar, right.polar)?;
    close("ixx", found.ixx, right.ixx, right.polar)?;
    close("iyy", found.iyy, right.iyy, right.polar)?;
    close("ixy", found.ixy, right.ixy, right.polar)?;
    let size = rings[0]
        .iter()
        .map(|p| p.distance(rings[0][0]))
        .fold(0.0, f64::max);
    let ulp = f64::EPSILON * right.centroid.abs().max_element();
    let apart = (found.centroid - right.centroid).abs().max_element();
    prop_assert!(
        apart <= PROMISE * size + ulp,
        "centroid {} instead of {}",
        found.centroid,
        right.centroid
    );
    Ok(())
}

proptest! {
    #[test]
    fn mass_properties_are_right_to_the_promise(
        ring in ring(), angle in -4.0..4.0_f64, x in -1e8..1e8_f64, y in -1e8..1e8_f64, far in 0..3_usize,
    ) {
        // Where they are, turned, or turned and far away: whatever doubles that gives are the input.
        let pose = [
            Pose::IDENTITY,
            Pose::new(Vec2::ZERO, Rot::from_angle(angle)),
            Pose::new(vec2(x, y), Rot::from_angle(angle)),
        ][far];
        let ring: Vec<Vec2> = ring.iter().map(|p| pose.point(*p)).collect();
        // Slivers that rounding folds may enclose nothing, or as good as nothing.
        if let Ok(found) = ring_properties(&ring)
            && exact(&[&ring]).is_some_and(|right| is_promised(&ring, &right))
        {
            check(&found, &[&ring])?;
        }
    }

    #[test]
    fn slivers_far_away_are_right_to_the_promise(
        seed in any::<u64>(), count in 3..40_usize, thin in 1..=24_u32, slope in -8..=8_i32,
        x in -100_000_000..=100_000_000_i32, y in -100_000_000..=100_000_000_i32,
    ) {
        // On a grid of 2⁻²⁶ m, where everything up to 2²⁶ m away is a double: pressed to as little as
        // two steps, sheared, moved; all of that exactly.
        let grid = 1.0 / (1_u64 << 26) as f64;
        let flat = 1.0 / (1_u64 << thin) as f64;
        let rock = Polygon::random_star(count, 0.1, 1.0, &mut numbers(seed)).expect("simple");
        let ring: Vec<Vec2> = rock
            .vertices()
            .iter()
            .map(|p| vec2((p.x / grid).round() * grid, (p.y * flat / grid).round() * grid))
            .map(|p| vec2(p.x, p.y + 0.125 * f64::from(slope) * p.x))
            .map(|p| (p / grid).round() * grid + vec2(f64::from(x), f64::from(y)) * 0.5)
            .collect();
        if let Ok(found) = ring_properties(&ring) {
            check(&found, &[&ring])?;
        }
    }

    #[test]
    fn polygons_of_any_points_are_right_to_the_promise(ring in points(8)) {
        // Needles far longer than the rest, where twice the digits are not enough.
        let Ok(polygon) = Polygon::new(ring) else { return Ok(()) };
        // Below that, squares of small numbers are lost.
        if exact(&[polygon.vertices()]).is_some_and(|right| right.polar > 1e-200) {
            check(&polygon.area_properties(), &[polygon.vertices()])?;
            if let Ok(convex) = ConvexPolygon::new(polygon.vertices()) {
                check(&convex.area_properties(), &[polygon.vertices()])?;
            }
        }
    }

    #[test]
    fn regions_are_right_to_the_promise(
        seed in any::<u64>(), count in 4..60_usize, left in 1e-12..0.5_f64, x in -1e8..1e8_f64,
    ) {
        // A hole that leaves little of its surroundings.
        let rock = Polygon::random_star(count, 0.5, 1.0, &mut numbers(seed)).expect("simple");
        let scaled = |part: f64| rock.vertices().iter().map(|p| *p * part + vec2(x, 0.0)).collect::<Vec<Vec2>>();
        if let Ok(region) = Region::new(scaled(1.0), [scaled(1.0 - left)]) {
            let rings = [region.outer(), &region.holes()[0]];
            check(&region.area_properties(), &rings)?;
        }
    }
}

#[test]
fn the_twin_meets_closed_forms() {
    let square = [
        vec2(0.0, 0.0),
        vec2(2.0, 0.0),
        vec2(2.0, 2.0),
        vec2(0.0, 2.0),
    ];
    let far = square.map(|p| p + vec2(1e8, -1e8));
    let found = exact(&[&far]).expect("an area");
    assert_eq!(
        found,
        AreaProperties {
            area: 4.0,
            centroid: vec2(1e8 + 1.0, 1.0 - 1e8),
            polar: 8.0 / 3.0,
            ixx: 4.0 / 3.0,
            iyy: 4.0 / 3.0,
            ixy: 0.0,
        }
    );
    // A right triangle of legs 3 and 4: ixy = −A b h / 36.
    let triangle = [vec2(0.0, 0.0), vec2(3.0, 0.0), vec2(0.0, 4.0)];
    let found = exact(&[&triangle]).expect("an area");
    assert_eq!((found.ixx, found.iyy, found.ixy), (16.0 / 3.0, 3.0, -2.0));
    let tiny = triangle.map(|p| p * 1e-30);
    let found = exact(&[&tiny]).expect("an area");
    assert!((found.area / 6e-60 - 1.0).abs() < 1e-15);
}
