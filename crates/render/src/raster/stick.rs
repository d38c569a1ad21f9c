//! Straight lines with round ends: two sides and two half circles, with no chord in place of an arc.

use carom_math::{Vec2, vec2};

use super::cells::{Cells, Circle, greater, lesser};

impl Cells {
    /// What a round pen of radius `half` covers that is drawn from `a` to `b`, of which columns `0..=limit` are kept.
    pub(crate) fn stick(&mut self, a: Vec2, b: Vec2, half: f64, limit: f64) {
        let along = (b - a).normalize_or_zero();
        let along = if along == Vec2::ZERO { Vec2::X } else { along };
        let reach = vec2(along.y, -along.x) * half;
        // Around from inside, as circles are: down on the left, up on the right.
        self.side(a - reach, b - reach, limit);
        self.side(b + reach, a + reach, limit);
        self.cap((a, half), -along, [a - reach, a + reach], limit);
        self.cap((b, half), along, [b - reach, b + reach], limit);
    }

    /// A straight side; what of it lies left or right of the columns is moved to their border.
    fn side(&mut self, a: Vec2, b: Vec2, limit: f64) {
        let within = |x: f64| lesser(greater(x, 0.0), limit);
        let kept = |point: Vec2| vec2(within(point.x), point.y);
        if kept(a) == a && kept(b) == b {
            self.line(a, b);
            return;
        }
        // Parts of the way at which the borders are crossed, in order.
        let by = b - a;
        let at = |x: f64| lesser(greater((x - a.x) / by.x, 0.0), 1.0);
        let (first, second) = if by.x == 0.0 {
            (0.0, 1.0)
        } else {
            (at(0.0), at(limit))
        };
        let [first, second] = if first < second {
            [first, second]
        } else {
            [second, first]
        };
        let [p, q] = [first, second].map(|part| kept(a + by * part));
        for (from, to) in [(kept(a), p), (p, q), (q, kept(b))] {
            self.line(from, to);
        }
    }

    /// The half of a circle on the side of `out`, which ends at two points beside its centre.
    fn cap(&mut self, (centre, half): (Vec2, f64), out: Vec2, ends: [Vec2; 2], limit: f64) {
        let circle = Circle::new(centre, half, 1.0, limit);
        let [top, bottom] = [centre.y - half, centre.y + half];
        for side in [-1.0, 1.0] {
            // The left side of a circle begins at the end that lies left.
            let end = if side * (ends[0].x - ends[1].x) > 0.0 {
                ends[0]
            } else {
                ends[1]
            };
            let from = if out.y > 0.0 {
                end.y
            } else if out.y < 0.0 || side * out.x > 0.0 {
                top
            } else {
                continue;
            };
            let to = if out.y < 0.0 { end.y } else { bottom };
            self.rim(
                &circle,
                side,
                lesser(greater(from, top), bottom),
                lesser(greater(to, top), bottom),
            );
        }
    }
}
