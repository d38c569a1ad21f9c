//! Cuts marks to the canvas in `f64`, so that the rasteriser only ever sees small, finite coordinates.
//!
//! tiny-skia 0.12 never returns from stroking a NaN and panics on fills at 1e20; nothing of that kind passes here.

use carom_math::{Rot, Vec2, vec2};

/// Coordinates and radii beyond this, in pixels, are left out: a double is right to 1e-4 px there.
pub(crate) const FAR: f64 = 1e12;

/// The rectangle that marks are cut to: the canvas and a margin for strokes and joins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    min: Vec2,
    max: Vec2,
}

impl Window {
    /// The canvas from the origin to `corner`, grown by `margin` pixels.
    pub(crate) fn new(corner: Vec2, margin: f64) -> Self {
        Self {
            min: Vec2::splat(-margin),
            max: corner + Vec2::splat(margin),
        }
    }

    /// The rectangle between two corners.
    pub(crate) const fn between(min: Vec2, max: Vec2) -> Self {
        Self { min, max }
    }

    fn centre(self) -> Vec2 {
        0.5 * (self.min + self.max)
    }

    /// Radius of the circle through its corners.
    fn reach(self) -> f64 {
        0.5 * (self.max - self.min).length()
    }

    pub(crate) fn contains(self, point: Vec2) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }

    /// The rectangle between `min` and `max`, cut; `None` if nothing of it is inside.
    pub(crate) fn rectangle(self, min: Vec2, max: Vec2) -> Option<(Vec2, Vec2)> {
        if !(is_near(min) && is_near(max)) {
            return None;
        }
        let (min, max) = (min.max(self.min), max.min(self.max));
        max.cmpgt(min).all().then_some((min, max))
    }

    /// The part of a closed ring inside, into `out`; empty if there is none or a point is not finite.
    ///
    /// Cut against one side after another (Sutherland and Hodgman 1974). A ring that leaves several times
    /// keeps seams along the window's border, which the margin hides.
    pub(crate) fn polygon(self, points: &[Vec2], out: &mut Vec<Vec2>, spare: &mut Vec<Vec2>) {
        out.clear();
        if points.len() < 3 || !points.iter().all(|&p| is_near(p)) {
            return;
        }
        out.extend_from_slice(points);
        if points.iter().all(|&p| self.contains(p)) {
            return;
        }
        // Signed depth behind each of the four sides.
        let sides: [fn(Self, Vec2) -> f64; 4] = [
            |w, p| p.x - w.min.x,
            |w, p| w.max.x - p.x,
            |w, p| p.y - w.min.y,
            |w, p| w.max.y - p.y,
        ];
        for side in sides {
            core::mem::swap(out, spare);
            out.clear();
            let Some(&last) = spare.last() else {
                return;
            };
            let mut before = (last, side(self, last));
            for &point in spare.iter() {
                let here = (point, side(self, point));
                if (here.1 >= 0.0) != (before.1 >= 0.0) {
                    // Different signs: the denominator is not zero, the part lies in 0..=1.
                    let part = before.1 / (before.1 - here.1);
                    out.push(before.0 + (here.0 - before.0) * part);
                }
                if here.1 >= 0.0 {
                    out.push(point);
                }
                before = here;
            }
        }
        // Cuts of edges that lie far out are right to rounding only: bring them to the border.
        for point in out.iter_mut() {
            *point = point.clamp(self.min, self.max);
        }
    }

    /// The part of a segment inside, as fractions of it (Liang and Barsky 1984).
    pub(crate) fn segment(self, a: Vec2, b: Vec2) -> Option<(f64, f64)> {
        if !(is_near(a) && is_near(b)) {
            return None;
        }
        let along = b - a;
        let (mut first, mut last) = (0.0, 1.0);
        let sides = [
            (-along.x, a.x - self.min.x),
            (along.x, self.max.x - a.x),
            (-along.y, a.y - self.min.y),
            (along.y, self.max.y - a.y),
        ];
        for (outwards, depth) in sides {
            if outwards == 0.0 {
                if depth < 0.0 {
                    return None;
                }
                continue;
            }
            let part = depth / outwards;
            if outwards < 0.0 {
                first = if part > first { part } else { first };
            } else {
                last = if part < last { part } else { last };
            }
        }
        (first <= last).then_some((first, last))
    }

    /// Hands over the connected parts of a polyline inside.
    pub(crate) fn polyline(
        self,
        points: &[Vec2],
        spare: &mut Vec<Vec2>,
        mut each: impl FnMut(&[Vec2]),
    ) {
        if points.iter().all(|&p| self.contains(p)) {
            if points.len() > 1 {
                each(points);
            }
            return;
        }
        spare.clear();
        for pair in points.windows(2) {
            let Some((first, last)) = self.segment(pair[0], pair[1]) else {
                hand_over(spare, &mut each);
                continue;
            };
            let along = pair[1] - pair[0];
            let at = |part: f64| (pair[0] + along * part).clamp(self.min, self.max);
            if first > 0.0 || spare.is_empty() {
                hand_over(spare, &mut each);
                spare.push(at(first));
            }
            spare.push(at(last));
            if last < 1.0 {
                hand_over(spare, &mut each);
            }
        }
        hand_over(spare, &mut each);
    }

    /// How much of a disc is inside.
    pub(crate) fn disc(self, centre: Vec2, radius: f64) -> Cover {
        if !(is_near(centre) && radius > 0.0 && radius <= FAR) {
            return Cover::None;
        }
        let distance = (centre - self.centre()).length();
        let reach = self.reach();
        if distance - radius > reach {
            Cover::None
        } else if distance + reach < radius {
            Cover::All
        } else {
            Cover::Some
        }
    }

    /// Points on the part of a circle line that can be inside, `Cover::Some` given; true if it is the whole circle.
    ///
    /// Chords stay within 1/50 px of the arc: a chord of angle s lies r s²/8 from it.
    pub(crate) fn arc(self, centre: Vec2, radius: f64, out: &mut Vec<Vec2>) -> bool {
        const CHORD: f64 = 0.02;
        out.clear();
        let to_middle = self.centre() - centre;
        let (distance, reach) = (to_middle.length(), self.reach());
        let whole = distance < 2.0 * reach;
        let (start, span) = match Rot::from_direction(to_middle) {
            // Seen from the disc's centre, the window lies within asin(reach / distance) <= 1.05 reach / distance.
            Some(middle) if !whole => {
                let half = 1.05 * reach / distance;
                (middle.turned(-half), 2.0 * half)
            }
            _ => (Rot::IDENTITY, core::f64::consts::TAU),
        };
        let step = 2.0 * (2.0 * CHORD / radius).sqrt();
        let count = (span / step).ceil().clamp(8.0, 8192.0);
        let mut i = 0.0;
        while i <= count {
            let direction = start.turned(span * i / count).x_axis();
            out.push(centre + radius * direction);
            i += 1.0;
        }
        whole
    }

    /// The whole window as a ring.
    pub(crate) fn ring(self) -> [Vec2; 4] {
        [
            self.min,
            vec2(self.max.x, self.min.y),
            self.max,
            vec2(self.min.x, self.max.y),
        ]
    }
}

/// How much of a disc lies in the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cover {
    /// Nothing, or it has no finite place or positive radius.
    None,
    /// Perhaps a part.
    Some,
    /// The window lies within the disc.
    All,
}

/// Finite, and near enough to be placed to 1e-4 px.
pub(crate) fn is_near(point: Vec2) -> bool {
    point.x.abs() <= FAR && point.y.abs() <= FAR
}

fn hand_over(points: &mut Vec<Vec2>, each: &mut impl FnMut(&[Vec2])) {
    if points.len() > 1 {
        each(points);
    }
    points.clear();
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn window() -> Window {
        Window::new(vec2(100.0, 50.0), 10.0)
    }

    fn area(ring: &[Vec2]) -> f64 {
        let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
        0.5 * pairs.map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
    }

    fn anywhere() -> impl Strategy<Value = Vec2> {
        let coordinate = prop_oneof![
            4 => -200.0..200.0_f64,
            1 => prop_oneof![Just(f64::NAN), Just(1e20), Just(-1e300), Just(1e11), Just(f64::INFINITY)],
        ];
        (coordinate.clone(), coordinate).prop_map(|(x, y)| vec2(x, y))
    }

    proptest! {
        #[test]
        fn what_passes_lies_inside(points in prop::collection::vec(anywhere(), 0..9)) {
            let (mut out, mut spare) = (Vec::new(), Vec::new());
            window().polygon(&points, &mut out, &mut spare);
            prop_assert!(out.iter().all(|&p| window().contains(p)), "{out:?}");
            let mut inside = true;
            window().polyline(&points, &mut spare, |part| {
                inside &= part.len() > 1 && part.iter().all(|&p| window().contains(p));
            });
            prop_assert!(inside);
        }

        #[test]
        fn a_cut_triangle_has_the_area_of_its_samples(
            a in (-150.0..250.0_f64, -100.0..150.0_f64),
            b in (-150.0..250.0_f64, -100.0..150.0_f64),
            c in (-150.0..250.0_f64, -100.0..150.0_f64),
        ) {
            let triangle = [a, b, c].map(|(x, y)| vec2(x, y));
            let (mut out, mut spare) = (Vec::new(), Vec::new());
            window().polygon(&triangle, &mut out, &mut spare);
            // Midpoints of a grid of 1 px: the error is at most the border's length.
            let mut count = 0.0;
            for j in 0..70_i32 {
                for i in 0..120_i32 {
                    let p = vec2(f64::from(i) - 9.5, f64::from(j) - 9.5);
                    let side = |k: usize| (triangle[(k + 1) % 3] - triangle[k]).perp_dot(p - triangle[k]);
                    let (s, t, u) = (side(0), side(1), side(2));
                    count += f64::from(u8::from((s >= 0.0) == (t >= 0.0) && (t >= 0.0) == (u >= 0.0)));
                }
            }
            prop_assert!((area(&out).abs() - count).abs() < 400.0, "{} against {count}", area(&out));
        }

        #[test]
        fn an_arc_lies_on_its_circle(x in -1e5..1e5_f64, y in -1e5..1e5_f64, near in -60.0..60.0_f64) {
            let centre = vec2(x, y);
            let radius = (centre - window().centre()).length() + near;
            prop_assume!(radius > 1.0);
            let mut points = Vec::new();
            window().arc(centre, radius, &mut points);
            prop_assert!(points.len() < 9000);
            for pair in points.windows(2) {
                let middle = 0.5 * (pair[0] + pair[1]);
                prop_assert!(((middle - centre).length() - radius).abs() < 0.021);
            }
        }
    }

    #[test]
    fn a_disc_around_the_window_covers_it() {
        let centre = window().centre();
        assert_eq!(window().disc(centre, 100.0), Cover::All);
        assert_eq!(window().disc(centre, 1e11), Cover::All);
        assert_eq!(window().disc(centre, 20.0), Cover::Some);
        assert_eq!(window().disc(vec2(1e9, 0.0), 1e9 - 30.0), Cover::Some);
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
            assert_eq!(
                window().disc(centre, radius),
                Cover::None,
                "radius {radius}"
            );
        }
        assert_eq!(window().disc(vec2(f64::NAN, 0.0), 1.0), Cover::None);
    }
}
