//! Coverage against exact areas, found another way: by cutting the shape to the pixel.

use carom_math::{Rot, Vec2, trig, vec2};
use proptest::prelude::*;

use crate::{Colour, Frame, Ink, Op, Picture, Size, Style};

const SIDE: u32 = 48;

fn painted(op: Op) -> Picture {
    let mut frame = Frame::new(Size::new(SIDE, SIDE).unwrap());
    frame.push(op);
    let style = Style {
        background: Colour::BLACK,
        ..Style::dark()
    };
    frame.paint(&style)
}

const WHITE: Ink = Ink::Of(Colour::WHITE);

/// The largest difference between painted and exact coverage, in 255ths.
fn worst(picture: &Picture, exact: impl Fn(Vec2) -> f64) -> f64 {
    let mut worst = 0.0_f64;
    for y in 0..SIDE {
        for x in 0..SIDE {
            let found = f64::from(picture.pixel(x, y).unwrap().red);
            let wanted = 255.0 * exact(vec2(f64::from(x), f64::from(y)));
            worst = worst.max((found - wanted).abs());
        }
    }
    worst
}

/// Area of a ring within the pixel at `corner`: cut by its four sides, then the sum over triangles.
fn ring_area(ring: &[Vec2], corner: Vec2) -> f64 {
    let mut points: Vec<Vec2> = ring.iter().map(|&p| p - corner).collect();
    let sides: [fn(Vec2) -> f64; 4] = [|p| p.x, |p| 1.0 - p.x, |p| p.y, |p| 1.0 - p.y];
    for depth in sides {
        let mut cut = Vec::new();
        for i in 0..points.len() {
            let (a, b) = (points[i], points[(i + 1) % points.len()]);
            let (da, db) = (depth(a), depth(b));
            if da >= 0.0 {
                cut.push(a);
            }
            if (da >= 0.0) != (db >= 0.0) {
                cut.push(a + (b - a) * (da / (da - db)));
            }
        }
        points = cut;
    }
    let count = points.len();
    let doubled: f64 = (0..count)
        .map(|i| points[i].perp_dot(points[(i + 1) % count]))
        .sum();
    0.5 * doubled.abs()
}

/// Area of a disc of radius r about the origin within x ≤ `x`, y ≤ `y`, by integrating over its height.
fn disc_corner(x: f64, y: f64, r: f64) -> f64 {
    let (x, y) = (x.clamp(-r, r), y.clamp(-r, r));
    // Integral of √(r² − t²): half of t √(r² − t²) + r² asin(t / r).
    let under = |t: f64| {
        let t = t.clamp(-r, r);
        0.5 * (t * (r * r - t * t).max(0.0).sqrt()
            + r * r * trig::atan2(t, (r * r - t * t).max(0.0).sqrt()))
    };
    // Where the right side is the line x instead of the arc: |t| < h.
    let h = (r * r - x * x).max(0.0).sqrt();
    let left = |a: f64, b: f64| under(b) - under(a);
    let between = |a: f64, b: f64| if b > a { left(a, b) } else { 0.0 };
    let (low, high) = ((-h).min(y), h.min(y));
    // Half-discs to the left for all heights up to y, then what lies right of the middle.
    let all_left = left(-r, y);
    if x >= 0.0 {
        let caps = between(-r, low) + between(high, y);
        all_left + caps + x * (high - low).max(0.0)
    } else {
        // Only where the arc reaches left of x.
        between(low, high) + x * (high - low).max(0.0)
    }
}

fn disc_area(centre: Vec2, r: f64, corner: Vec2) -> f64 {
    let p = corner - centre;
    let q = p + Vec2::ONE;
    disc_corner(q.x, q.y, r) - disc_corner(p.x, q.y, r) - disc_corner(q.x, p.y, r)
        + disc_corner(p.x, p.y, r)
}

fn place() -> impl Strategy<Value = Vec2> {
    (-4.0..52.0_f64, -4.0..52.0_f64).prop_map(|(x, y)| vec2(x, y))
}

/// A ring around a point with corners at any distance: simple, seldom convex.
fn star() -> impl Strategy<Value = Vec<Vec2>> {
    let arms = prop::collection::vec(0.2..1.0_f64, 3..12);
    (place(), arms, 0.0..7.0_f64, 0.3..40.0_f64).prop_map(|(centre, arms, turn, size)| {
        let step = core::f64::consts::TAU / arms.len() as f64;
        let arm = |(i, arm): (usize, f64)| {
            centre + size * arm * Rot::from_angle(turn + step * i as f64).x_axis()
        };
        arms.into_iter().enumerate().map(arm).collect()
    })
}

/// A radius from a hundredth of a pixel to a thousand kilometres of them.
fn radius() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => 0.3..4.0_f64,
        3 => 2.0..40.0_f64,
        1 => (-2.0..9.0_f64).prop_map(|e| trig::pow(10.0, e)),
    ]
}

/// A circle with its rim through the canvas.
fn circle() -> impl Strategy<Value = (Vec2, f64)> {
    (place(), radius(), 0.0..7.0_f64)
        .prop_map(|(rim, r, angle)| (rim + r * Rot::from_angle(angle).x_axis(), r))
}

/// Segments of its quadrants come together in one pixel: each lacked 1e-3 of itself, and the pixel more than one part in 255.
#[test]
fn a_disc_little_larger_than_a_pixel_covers_each_by_its_area() {
    let (centre, radius) = (
        vec2(19.218_955_532_450_15, 46.016_871_361_139_096),
        0.680_696_595_123_692_5,
    );
    let picture = painted(Op::Dot {
        centre,
        radius,
        ink: WHITE,
    });
    let error = worst(&picture, |corner| disc_area(centre, radius, corner));
    assert!(error <= 1.0, "{error} of 255");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_polygon_covers_every_pixel_by_its_area(points in star(), reversed: bool) {
        let points: Vec<Vec2> = if reversed { points.into_iter().rev().collect() } else { points };
        let picture = painted(Op::Area { points: points.clone(), ink: WHITE });
        let error = worst(&picture, |corner| ring_area(&points, corner));
        prop_assert!(error <= 1.0, "{error} of 255");
    }

    #[test]
    fn a_nearly_level_box_covers_every_pixel_by_its_area(
        centre in place(), half_x in 0.1..30.0_f64, half_y in 0.1..30.0_f64, turn in -0.03..0.03_f64, level: bool,
    ) {
        let turn = Rot::from_angle(if level { 0.0 } else { turn });
        let corners = [vec2(half_x, half_y), vec2(-half_x, half_y), vec2(-half_x, -half_y), vec2(half_x, -half_y)];
        let points: Vec<Vec2> = corners.iter().map(|&p| centre + turn * p).collect();
        let picture = painted(Op::Area { points: points.clone(), ink: WHITE });
        let error = worst(&picture, |corner| ring_area(&points, corner));
        prop_assert!(error <= 1.0, "{error} of 255");
    }

    #[test]
    fn a_disc_of_any_radius_covers_every_pixel_by_its_area((centre, radius) in circle()) {
        // The exact area is a difference of areas r²: its own rounding is 1e-16 r².
        prop_assume!(radius < 1e5);
        let picture = painted(Op::Dot { centre, radius, ink: WHITE });
        let error = worst(&picture, |corner| disc_area(centre, radius, corner));
        prop_assert!(error <= 1.0, "{error} of 255 at radius {radius}");
    }

    #[test]
    fn a_huge_disc_covers_every_pixel_as_its_tangent(near in place(), angle in 0.0..7.0_f64, magnitude in 7.0..11.5_f64) {
        // Whole numbers, so that the circle is known exactly: a centre far away, and a rim that comes near a place.
        let far = trig::pow(10.0, magnitude);
        let centre = (far * Rot::from_angle(angle).x_axis()).round();
        let radius = (near - centre).length().round();
        let picture = painted(Op::Dot { centre, radius, ink: WHITE });
        // From the origin to the rim: |c| − r = (c² − r²) / (|c| + r), with exact squares.
        let square = |x: f64| (x as i128).pow(2);
        let depth = (square(centre.x) + square(centre.y) - square(radius)) as f64 / (centre.length() + radius);
        let inwards = centre / centre.length();
        let rim = inwards * depth;
        let along = vec2(-inwards.y, inwards.x) * 200.0;
        let deep = inwards * 400.0;
        let half_plane = [rim + along, rim - along, rim - along + deep, rim + along + deep];
        let error = worst(&picture, |corner| ring_area(&half_plane, corner));
        // Over 70 px the circle leaves its tangent by 70² / 2r. Four numbers as large as the radius are rounded on the way
        // to a place on the rim: the height over the centre, half the chord (twice), and their sum.
        let (bend, rounding) = (70.0 * 70.0 / (2.0 * radius), 4.0 * 0.5 * f64::EPSILON * radius);
        prop_assert!(error <= 1.0 + 255.0 * (bend + rounding), "{error} of 255 at radius {radius}");
    }

    #[test]
    fn a_ring_covers_what_its_discs_leave((centre, radius) in circle(), width in 0.2..6.0_f64) {
        prop_assume!(radius < 1e5);
        let picture = painted(Op::Ring { centre, radius, width, ink: WHITE });
        let (inner, outer) = (radius - 0.5 * width, radius + 0.5 * width);
        let error = worst(&picture, |corner| {
            disc_area(centre, outer, corner) - if inner > 0.0 { disc_area(centre, inner, corner) } else { 0.0 }
        });
        prop_assert!(error <= 1.0, "{error} of 255");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_line_covers_every_pixel_by_its_area(
        a in place(), b in place(), width in prop_oneof![0.1..12.0_f64, 12.0..60.0_f64], level in 0..5_u8,
    ) {
        // Along an axis, to a point, or as it comes.
        let b = match level {
            0 => vec2(b.x, a.y),
            1 => vec2(a.x, b.y),
            2 => a,
            _ => b,
        };
        let picture = painted(Op::Line { points: vec![a, b], width, dash: None, ink: WHITE });
        let error = worst(&picture, |corner| stick_area(a, b, 0.5 * width, corner));
        prop_assert!(error <= 1.0, "{error} of 255");
    }
}

/// Area of a line with round ends within a pixel: its heights at many places across, each of them exact.
fn stick_area(a: Vec2, b: Vec2, half: f64, corner: Vec2) -> f64 {
    /// A root at an end is summed to this number to the power of −3/2.
    const COUNT: i32 = 8192;
    // Pixels further from the rim than their corners reach need no sum.
    let middle = corner + Vec2::splat(0.5);
    let part = (middle - a).dot(b - a) / (b - a).length_squared().max(1e-300);
    let away = (middle - a - (b - a) * part.clamp(0.0, 1.0)).length() - half;
    if away.abs() > 0.75 {
        return if away < 0.0 { 1.0 } else { 0.0 };
    }
    let along = (b - a).normalize_or_zero();
    let normal = vec2(-along.y, along.x) * half;
    let ring = [a + normal, b + normal, b - normal, a - normal];
    let columns = (0..COUNT).map(|i| {
        let x = corner.x + (f64::from(i) + 0.5) / f64::from(COUNT);
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        let mut grow = |y: f64| range = (range.0.min(y), range.1.max(y));
        for end in [a, b] {
            let chord = half * half - (x - end.x) * (x - end.x);
            if chord > 0.0 {
                grow(end.y - chord.sqrt());
                grow(end.y + chord.sqrt());
            }
        }
        for i in 0..4 {
            let (p, q) = (ring[i], ring[(i + 1) % 4]);
            if (p.x < x) != (q.x < x) {
                grow(p.y + (q.y - p.y) * (x - p.x) / (q.x - p.x));
            }
        }
        (range.1.min(corner.y + 1.0) - range.0.max(corner.y)).max(0.0)
    });
    columns.sum::<f64>() / f64::from(COUNT)
}

/// Light of a picture and its centre.
fn light(picture: &Picture) -> (f64, Vec2) {
    let mut sum = 0.0;
    let mut moment = Vec2::ZERO;
    for y in 0..SIDE {
        for x in 0..SIDE {
            let value = f64::from(picture.pixel(x, y).unwrap().red) / 255.0;
            sum += value;
            moment += value * vec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
        }
    }
    (sum, moment / sum)
}

/// 256 frames of 1/64 px each: rms error of the centre of light, frames that did not change, flicker of the light.
fn slow_motion(shape: impl Fn(Vec2) -> Op) -> (f64, usize, f64) {
    let mut before: Option<Picture> = None;
    let (mut square, mut frozen) = (0.0, 0);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for i in 0..256 {
        let at = vec2(20.3 + f64::from(i) / 64.0, 22.7);
        let picture = painted(shape(at));
        let (sum, centre) = light(&picture);
        square += (centre - at).length_squared();
        (least, most) = (least.min(sum), most.max(sum));
        frozen += usize::from(before.as_ref() == Some(&picture));
        before = Some(picture);
    }
    ((square / 256.0).sqrt(), frozen, (most - least) / most)
}

#[test]
fn slow_motion_is_seen_in_every_frame() {
    let square = |at: Vec2| {
        let turn = Rot::from_angle(0.3);
        let corners = [
            vec2(6.0, 6.0),
            vec2(-6.0, 6.0),
            vec2(-6.0, -6.0),
            vec2(6.0, -6.0),
        ];
        Op::Area {
            points: corners.iter().map(|&p| at + turn * p).collect(),
            ink: WHITE,
        }
    };
    let dot = |radius: f64| {
        move |centre: Vec2| Op::Dot {
            centre,
            radius,
            ink: WHITE,
        }
    };
    for (name, (rms, frozen, flicker)) in [
        ("square of 12 px", slow_motion(square)),
        ("disc of radius 6 px", slow_motion(dot(6.0))),
        ("disc of radius 15 px", slow_motion(dot(15.0))),
    ] {
        println!(
            "{name}: {rms:.5} px, {frozen} frozen, light within {:.4} %",
            100.0 * flicker
        );
        assert!(rms <= 0.002, "{name}: centre of light off by {rms} px");
        assert_eq!(frozen, 0, "{name}");
        assert!(flicker <= 0.001, "{name}: light within {flicker}");
    }
    let (_, frozen, _) = slow_motion(dot(1.0));
    assert_eq!(frozen, 0, "a disc of radius 1 px");
}
