//! Sums over the edges of a ring: area, centroid and second moments.
//!
//! Green's theorem turns every integral over the inside into a sum over the edges. With an edge
//! from u to v, seen from any fixed point, and k = u × v = u × (v − u):
//! ```text
//! A = Σ k/2,  A C = Σ k (u + v)/6
//! ∫ y² = Σ k (u_y² + u_y v_y + v_y²)/12,  ∫ x² alike
//! ∫ x y = Σ k (u_x (2 u_y + v_y) + v_x (u_y + 2 v_y))/24
//! ```
//! The first pass looks from the first vertex, as world coordinates cancel far from the origin. The
//! second looks from the centroid that the first found, as moments cancel when they are carried
//! there. What rounding can have lost is bounded on the way; a ring that loses too much (a sliver,
//! a fine comb) is summed again with twice the digits. If even those do not do (a needle a thousand
//! million times longer than the rest), a polygon is summed over triangles that do not overlap: then
//! nothing cancels.

use carom_math::{Sum, Vec2, cross, two_product, two_sum, vec2};

use crate::AreaProperties;
use crate::wide::Wide;

/// How much larger than the result the sum of absolute terms may be for plain doubles.
///
/// A term is right to 2⁻⁵¹ of reach × edge (difference, product and sum), so that 2⁷ of them cost
/// 2⁻⁴⁴, 6e-14. At 2⁹ the promise of 2e-13 would be gone.
const PLAIN: f64 = 128.0;

/// Below this part of reach × girth an area is all rounding, even with twice the digits.
const NOTHING: f64 = 1.0 / (1_u128 << 98) as f64;

/// How much larger than the result the sum of absolute terms may be with twice the digits: 2⁵² of
/// 2⁻¹⁰⁰ cost 2⁻⁴⁸.
const WIDE: f64 = (1_u64 << 52) as f64;

/// Area properties of any closed ring, all zero if it encloses no area. The winding does not count.
pub(crate) fn ring_moments(points: &[Vec2]) -> AreaProperties {
    let Some(&anchor) = points.first() else {
        return AreaProperties::ZERO;
    };
    moments_of(anchor, edges(points)).unwrap_or_else(|guess| guess)
}

/// Area properties of a polygon, right whatever it looks like; `pieces` are convex and make it up.
pub(crate) fn polygon_moments<'a>(
    points: &[Vec2],
    pieces: impl IntoIterator<Item = &'a [Vec2]>,
) -> AreaProperties {
    let Some(&anchor) = points.first() else {
        return AreaProperties::ZERO;
    };
    moments_of(anchor, edges(points)).unwrap_or_else(|_| {
        let fans = pieces.into_iter().flat_map(|piece| {
            let (first, rest) = piece.split_at(1);
            rest.windows(2)
                .map(move |edge| triangle([first[0], edge[0], edge[1]]))
        });
        fans.sum()
    })
}

/// A triangle, counter-clockwise: A/36 times the sum of the squares of its edges.
fn triangle([a, b, c]: [Vec2; 3]) -> AreaProperties {
    let twice = exact_cross(Offset::between(b, a), Offset::between(c, a));
    let over_each = |of: fn(Vec2) -> f64| {
        let sum = of(b - a) + of(c - b) + of(a - c);
        twice.max(0.0) * (sum / 72.0)
    };
    let (ixx, iyy) = (over_each(|e| e.y * e.y), over_each(|e| e.x * e.x));
    AreaProperties {
        area: 0.5 * twice.max(0.0),
        centroid: a + ((b - a) + (c - a)) / 3.0,
        polar: ixx + iyy,
        ixx,
        iyy,
        ixy: over_each(|e| e.x * e.y),
    }
}

/// `u × v`, rounded once, however much it cancels.
fn exact_cross(u: Offset, v: Offset) -> f64 {
    let mut terms = [0.0; 16];
    let products = [(u.x, v.y, 1.0), (u.y, v.x, -1.0)];
    let factors = products.into_iter().flat_map(|(a, b, sign)| {
        let b = b.parts();
        a.parts()
            .into_iter()
            .flat_map(move |x| b.map(|y| (sign * x, y)))
    });
    for (pair, (x, y)) in terms.chunks_exact_mut(2).zip(factors) {
        (pair[0], pair[1]) = two_product(x, y);
    }
    // Each pass sweeps what is left of the errors into the last place (Ogita, Rump, Oishi, 2005: a
    // sum as if in 2 + 6 times the digits).
    for _ in 0..6 {
        for i in 1..terms.len() {
            (terms[i], terms[i - 1]) = two_sum(terms[i], terms[i - 1]);
        }
    }
    terms.iter().sum()
}

/// Area properties of what lies on the left of several rings, outer ones and holes, all at once: a
/// hole that leaves little of its surroundings cancels no digits.
pub(crate) fn region_moments(rings: &[Vec<Vec2>]) -> AreaProperties {
    let Some(&anchor) = rings.first().and_then(|ring| ring.first()) else {
        return AreaProperties::ZERO;
    };
    let edges = rings.iter().flat_map(|ring| edges(ring));
    moments_of(anchor, edges).unwrap_or_else(|guess| {
        // What is lost may be more than there is.
        let (ixx, iyy) = (guess.ixx.max(0.0), guess.iyy.max(0.0));
        AreaProperties {
            polar: ixx + iyy,
            ixx,
            iyy,
            ..guess
        }
    })
}

/// The sums, or a guess where twice the digits are not enough.
fn moments_of(
    anchor: Vec2,
    edges: impl Iterator<Item = (Vec2, Vec2)> + Clone,
) -> Result<AreaProperties, AreaProperties> {
    plain(anchor, edges.clone()).map_or_else(|| wide(anchor, edges), Ok)
}

/// Both ends of each edge, the closing one last.
fn edges(points: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2)> + Clone {
    let ends = points.iter().skip(1).chain(points.first());
    points.iter().zip(ends).map(|(p, q)| (*p, *q))
}

/// In doubles, or `None` where they may not be enough.
fn plain(
    anchor: Vec2,
    edges: impl Iterator<Item = (Vec2, Vec2)> + Clone,
) -> Option<AreaProperties> {
    let (mut twice, mut cx, mut cy) = (Sum::ZERO, Sum::ZERO, Sum::ZERO);
    let mut size = Size::default();
    for (p, q) in edges.clone() {
        let (u, v, edge) = (p - anchor, q - anchor, q - p);
        size.add(u, edge);
        let k = cross(u, edge);
        twice.add(k);
        cx.add(k * (u.x + v.x));
        cy.add(k * (u.y + v.y));
    }
    let twice = twice.value();
    if size.reach * size.girth > PLAIN * twice.abs() || twice == 0.0 {
        return None;
    }
    let c = vec2(cx.value(), cy.value()) / (3.0 * twice);

    let [mut twice, mut cx, mut cy, mut xx, mut yy, mut xy] = [Sum::ZERO; 6];
    let mut gross = 0.0;
    for (p, q) in edges {
        let (u, v, edge) = ((p - anchor) - c, (q - anchor) - c, q - p);
        let k = cross(u, edge);
        let (x, y) = squares(u, v);
        twice.add(k);
        cx.add(k * (u.x + v.x));
        cy.add(k * (u.y + v.y));
        xx.add(k * x);
        yy.add(k * y);
        xy.add(k * (u.x * (2.0 * u.y + v.y) + v.x * (u.y + 2.0 * v.y)));
        gross += (edge.x.abs() + edge.y.abs()) * (x + y);
    }
    let [twice, cx, cy, xx, yy, xy] = [twice, cx, cy, xx, yy, xy].map(Sum::value);
    if size.reach * gross > PLAIN * (xx + yy).abs() {
        return None;
    }
    let rest = vec2(cx, cy) / (3.0 * twice);
    Some(about_centroid(anchor, c, rest, [twice, xx, yy, xy]))
}

/// With twice the digits, or a guess where they may not be enough.
fn wide(
    anchor: Vec2,
    edges: impl Iterator<Item = (Vec2, Vec2)> + Clone,
) -> Result<AreaProperties, AreaProperties> {
    let [mut twice, mut cx, mut cy] = [Wide::ZERO; 3];
    let mut size = Size::default();
    for (p, q) in edges.clone() {
        let (u, v) = (Offset::between(p, anchor), Offset::between(q, anchor));
        let edge = Offset::between(q, p);
        size.add(p - anchor, q - p);
        let k = u.cross(edge);
        twice = twice + k;
        cx = cx + k * (u.x + v.x);
        cy = cy + k * (u.y + v.y);
    }
    if twice.value().abs() <= NOTHING * size.reach * size.girth {
        return Err(AreaProperties::ZERO);
    }
    let area_is_sure = size.reach * size.girth <= WIDE * twice.value().abs();
    let mut gross = 0.0;
    let thrice = twice * 3.0;
    let c = vec2(cx.over(thrice), cy.over(thrice));

    let [mut twice, mut cx, mut cy, mut xx, mut yy, mut xy] = [Wide::ZERO; 6];
    for (p, q) in edges {
        let u = Offset::between(p, anchor).from(c);
        let v = Offset::between(q, anchor).from(c);
        let k = u.cross(Offset::between(q, p));
        let (x, y) = squares(u.value(), v.value());
        let edge = q - p;
        gross += (edge.x.abs() + edge.y.abs()) * (x + y);
        twice = twice + k;
        cx = cx + k * (u.x + v.x);
        cy = cy + k * (u.y + v.y);
        xx = xx + k * (u.x * u.x + u.x * v.x + v.x * v.x);
        yy = yy + k * (u.y * u.y + u.y * v.y + v.y * v.y);
        xy = xy + k * (u.x * (u.y * 2.0 + v.y) + v.x * (u.y + v.y * 2.0));
    }
    let thrice = twice * 3.0;
    let rest = vec2(cx.over(thrice), cy.over(thrice));
    let [twice, xx, yy, xy] = [twice, xx, yy, xy].map(Wide::value);
    let found = about_centroid(anchor, c, rest, [twice, xx, yy, xy]);
    if area_is_sure && size.reach * gross <= WIDE * (xx + yy).abs() {
        Ok(found)
    } else {
        Err(found)
    }
}

/// From sums about `anchor + c`, of which the centroid lies `rest` away (a rounding of c).
fn about_centroid(
    anchor: Vec2,
    c: Vec2,
    rest: Vec2,
    [twice, xx, yy, xy]: [f64; 4],
) -> AreaProperties {
    let sign = if twice < 0.0 { -1.0 } else { 1.0 };
    let area = 0.5 * sign * twice;
    let ixx = sign * yy / 12.0 - area * rest.y * rest.y;
    let iyy = sign * xx / 12.0 - area * rest.x * rest.x;
    AreaProperties {
        area,
        centroid: anchor + (c + rest),
        polar: ixx + iyy,
        ixx,
        iyy,
        ixy: sign * xy / 24.0 - area * rest.x * rest.y,
    }
}

/// u² + u v + v² by coordinate; never negative.
fn squares(u: Vec2, v: Vec2) -> (f64, f64) {
    let both = u * u + u * v + v * v;
    (both.x, both.y)
}

/// How large the terms of a sum can be.
#[derive(Default)]
struct Size {
    /// Largest coordinate, seen from the anchor, in m.
    reach: f64,
    /// Length of all edges, along x plus along y, in m.
    girth: f64,
}

impl Size {
    fn add(&mut self, from_anchor: Vec2, edge: Vec2) {
        self.reach = self.reach.max(from_anchor.abs().max_element());
        self.girth += edge.x.abs() + edge.y.abs();
    }
}

/// The way from one point to another, with all its digits.
#[derive(Clone, Copy)]
struct Offset {
    x: Wide,
    y: Wide,
}

impl Offset {
    fn between(p: Vec2, from: Vec2) -> Self {
        Self {
            x: Wide::difference(p.x, from.x),
            y: Wide::difference(p.y, from.y),
        }
    }

    fn from(self, c: Vec2) -> Self {
        Self {
            x: self.x - Wide::from(c.x),
            y: self.y - Wide::from(c.y),
        }
    }

    fn value(self) -> Vec2 {
        vec2(self.x.value(), self.y.value())
    }

    fn cross(self, v: Self) -> Wide {
        self.x * v.y - self.y * v.x
    }
}
