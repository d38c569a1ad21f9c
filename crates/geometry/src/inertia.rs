//! Closed forms of the moment of inertia, as the documents that the project grew from give them.
//!
//! The library itself integrates any ring ([`crate::ring_properties`]); these are its oracles, and
//! answers where lengths are given instead of points. Masses in kg, lengths in m, results in kg·m².

use carom_math::{Vec2, cross, trig};

/// A rectangle about its centre: `m (w² + h²) / 12`. Source: thesis, (3.4).
///
/// # Examples
/// ```
/// use carom_geometry::inertia;
/// assert_eq!(inertia::rectangle(6.0, 2.0, 3.0), 6.5);              // kg·m²
/// ```
#[must_use]
pub fn rectangle(mass: f64, width: f64, height: f64) -> f64 {
    mass * (width * width + height * height) / 12.0
}

/// A regular polygon about its centre: `m l² / 24 · (1 + 3 cot²(π/n))`, `side` its side length.
///
/// Source: thesis, (3.6).
///
/// # Examples
/// ```
/// use carom_geometry::inertia;
/// let square = inertia::regular(3.0, 4, 2.0);                      // n = 4: cot² = 1
/// assert!((square - inertia::rectangle(3.0, 2.0, 2.0)).abs() < 1e-15);
/// ```
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "a count of sides")]
pub fn regular(mass: f64, sides: usize, side: f64) -> f64 {
    let cot = 1.0 / trig::tan(core::f64::consts::PI / sides as f64);
    mass * side * side / 24.0 * (1.0 + 3.0 * cot * cot)
}

/// A disc about its centre: `m r² / 2`. Source: engine article.
///
/// # Examples
/// ```
/// use carom_geometry::inertia;
/// assert_eq!(inertia::circle(4.0, 0.5), 0.5);                      // kg·m²
/// ```
#[must_use]
pub fn circle(mass: f64, radius: f64) -> f64 {
    0.5 * mass * radius * radius
}

/// A right triangle about the corner between its leg along x and its hypotenuse.
///
/// The corner is at the origin, the leg `width` along x, the leg `height` upwards at its far end:
/// `ρ (h w³/4 + h³ w/12)` with `ρ = 2 m / (w h)`. Source: triangle article.
///
/// # Examples
/// ```
/// use carom_geometry::{inertia, ring_properties};
/// use carom_math::{Vec2, vec2};
/// let ring = [vec2(0.0, 0.0), vec2(3.0, 0.0), vec2(3.0, 2.0)];
/// let whole = ring_properties(&ring)?.with_mass(5.0).inertia_about(Vec2::ZERO);
/// assert!((inertia::right_triangle_about_corner(5.0, 3.0, 2.0) - whole).abs() < 1e-14);
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn right_triangle_about_corner(mass: f64, width: f64, height: f64) -> f64 {
    mass * (0.5 * width * width + height * height / 6.0)
}

/// Any triangle about its centroid, by the lengths of its sides: `m (a² + b² + c²) / 36`.
///
/// # Examples
/// ```
/// use carom_geometry::{ConvexPolygon, inertia};
/// assert_eq!(inertia::triangle(36.0, 3.0, 4.0, 5.0), 50.0);        // kg·m²
/// let right = ConvexPolygon::triangle(3.0, 4.0, std::f64::consts::FRAC_PI_2)?;
/// assert!((right.area_properties().with_mass(36.0).inertia - 50.0).abs() < 1e-13);
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn triangle(mass: f64, a: f64, b: f64, c: f64) -> f64 {
    mass * (a * a + b * b + c * c) / 36.0
}

/// Any triangle about the origin, as two right triangles with a common height.
///
/// `p4` is the foot of the height from `p3` on the line `p1 p2`. Each half is seen from `p3`,
/// where it is a right triangle of legs w and h: `ρ (w h³/4 + w³ h/12)`. Both w are signed: beyond
/// an obtuse angle one of them is taken away, and a clockwise triangle counts negative as a whole.
/// Per unit of density, in m⁴. Source: triangle article, with its errors mended.
///
/// # Examples
/// ```
/// use carom_geometry::inertia;
/// use carom_math::vec2;
/// // Obtuse at the second corner: the foot of the height lies beyond it.
/// let [p1, p2, p3] = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(5.0, 1.0)];
/// assert!((inertia::signed_right_triangles(p1, p2, p3) - 8.0 / 3.0).abs() < 1e-13);
/// assert!((inertia::signed_right_triangles(p1, p3, p2) + 8.0 / 3.0).abs() < 1e-13);
/// ```
#[must_use]
pub fn signed_right_triangles(p1: Vec2, p2: Vec2, p3: Vec2) -> f64 {
    let base = p2 - p1;
    let length = base.length();
    if length == 0.0 {
        return 0.0;
    }
    let height = cross(base, p3 - p1) / length;
    let foot = p1 + base * ((p3 - p1).dot(base) / (length * length));
    let (w1, w2) = (
        (foot - p1).dot(base) / length,
        (p2 - foot).dot(base) / length,
    );
    let half = |w: f64, corner: Vec2| {
        let mass = 0.5 * w * height;
        let about_p3 = mass * (0.5 * height * height + w * w / 6.0);
        let centre = (corner + p3 + foot) / 3.0;
        about_p3 - mass * (centre - p3).length_squared() + mass * centre.length_squared()
    };
    half(w1, p1) + half(w2, p2)
}

/// Any simple polygon about the origin, per unit of density (in m⁴), fanned from its first vertex.
///
/// Source: triangle article, "From Triangles to Polygons".
///
/// # Examples
/// ```
/// use carom_geometry::{inertia, Polygon};
/// use carom_math::vec2;
/// // Density from mass first, then the moment of an L of 4 m² and 8 kg about the origin.
/// let l = [
///     vec2(0.0, 0.0), vec2(3.0, 0.0), vec2(3.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 2.0), vec2(0.0, 2.0),
/// ];
/// let area = Polygon::new(l)?.area_properties();
/// let density = 8.0 / area.area;                                   // kg/m²
/// let moment = density * inertia::polygon_by_right_triangles(&l);
/// assert!((moment - area.with_mass(8.0).inertia_about(vec2(0.0, 0.0))).abs() < 1e-13);
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn polygon_by_right_triangles(ring: &[Vec2]) -> f64 {
    let fan = ring.windows(2).skip(1);
    fan.map(|edge| signed_right_triangles(ring[0], edge[0], edge[1]))
        .sum::<f64>()
        .abs()
}

/// Any simple polygon about `centre`: the thesis's sum (3.14) over the triangles of `centre` and
/// each edge, with signed areas.
///
/// ```text
/// I = Σ m_i/2 (|P_i P_{i+1}|²/3 + CP_i · P_i P_{i+1} + |CP_i|²),  m_i = mass · A_i / A
/// ```
/// Any `centre` will do, inside or outside; the centroid gives the moment that a free body turns
/// with. Plain sums: for thin or distant rings [`crate::ring_properties`] keeps more digits.
///
/// # Examples
/// ```
/// use carom_geometry::{Polygon, inertia};
/// use carom_math::vec2;
/// // The thesis's house, 100 m wide; the mean of its corners would be 6.7 m too high.
/// let house = [
///     vec2(0.0, 0.0), vec2(100.0, 0.0), vec2(100.0, 100.0), vec2(50.0, 150.0), vec2(0.0, 100.0),
/// ];
/// let area = Polygon::new(house)?.area_properties();
/// assert!((area.centroid - vec2(50.0, 190.0 / 3.0)).length() < 1e-13);
/// let moment = inertia::fan(12.0, area.centroid, &house);
/// assert!((moment / area.with_mass(12.0).inertia - 1.0).abs() < 1e-14);
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn fan(mass: f64, centre: Vec2, ring: &[Vec2]) -> f64 {
    let (mut area, mut moment) = (0.0, 0.0);
    for (p, q) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let (cp, edge) = (*p - centre, *q - *p);
        let part = 0.5 * cross(cp, *q - centre);
        area += part;
        let mean = edge.length_squared() / 3.0 + cp.dot(edge) + cp.length_squared();
        moment += 0.5 * part * mean;
    }
    mass * moment / area
}
