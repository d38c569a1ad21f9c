//! Corners and faces of eight outlines, and which face separates two best.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Select, Simd};

use crate::outline::Outline;
use crate::rows::Wide;

/// Separation of what is no face: less than that of any face.
pub(super) const FACELESS: f64 = -1e200;

/// Corners of an outline a lane, and the normals of the edges from them.
#[derive(Clone, Copy)]
pub(super) struct Corners<V, const N: usize> {
    pub(super) x: [V; N],
    pub(super) y: [V; N],
    pub(super) nx: [V; N],
    pub(super) ny: [V; N],
}

/// The face that separates best.
#[derive(Clone, Copy)]
pub(super) struct Face<V> {
    pub(super) separation: V,
    /// The most that the other is before any face, at its nearest on its way.
    pub(super) stays: V,
    /// The most that the other is before any cut.
    pub(super) cut: V,
    pub(super) nx: V,
    pub(super) ny: V,
    /// Its two ends.
    pub(super) x: V,
    pub(super) y: V,
    pub(super) x_next: V,
    pub(super) y_next: V,
}

/// The corners of boxes, or of any outlines with at most N corners: 4 or 8.
#[inline(always)]
pub(super) fn corners<S: Simd, V: Wide<S>, const N: usize, const BOXES: bool>(
    simd: S,
    outlines: &[&Outline],
    [l, m]: [V; 2],
) -> Corners<V, N> {
    let zero = V::splat(simd, 0.0);
    let mut found = Corners {
        x: [zero; N],
        y: [zero; N],
        nx: [zero; N],
        ny: [zero; N],
    };
    found.x[..4].copy_from_slice(&V::columns_of(simd, outlines, 8));
    found.y[..4].copy_from_slice(&V::columns_of(simd, outlines, 12));
    let (x, y) = (&found.x, &found.y);
    let (px, py) = ((y[1] - y[0]) * l, (x[0] - x[1]) * l);
    let (qx, qy) = ((y[2] - y[1]) * m, (x[1] - x[2]) * m);
    (found.nx[0], found.nx[1], found.nx[2], found.nx[3]) = (px, qx, -px, -qx);
    (found.ny[0], found.ny[1], found.ny[2], found.ny[3]) = (py, qy, -py, -qy);
    if BOXES {
        return found;
    }
    // Among others boxes have no normals in memory: their first corner is repeated.
    let boxes = l.simd_gt(zero);
    let (mut nx, mut ny) = ([zero; N], [zero; N]);
    nx[..4].copy_from_slice(&V::columns_of(simd, outlines, 16));
    ny[..4].copy_from_slice(&V::columns_of(simd, outlines, 20));
    if N > 4 {
        found.x[4..].copy_from_slice(&V::columns_of(simd, outlines, 24));
        found.y[4..].copy_from_slice(&V::columns_of(simd, outlines, 28));
        nx[4..].copy_from_slice(&V::columns_of(simd, outlines, 32));
        ny[4..].copy_from_slice(&V::columns_of(simd, outlines, 36));
    }
    for k in 0..N {
        let its = if k < 4 { k } else { 0 };
        found.x[k] = boxes.select(found.x[its], found.x[k]);
        found.y[k] = boxes.select(found.y[its], found.y[k]);
        found.nx[k] = boxes.select(found.nx[its], nx[k]);
        found.ny[k] = boxes.select(found.ny[its], ny[k]);
    }
    found
}

/// For each edge 1 if it is a cut, else 0, from the sum of 2ⁱ.
#[inline(always)]
pub(super) fn cuts<S: Simd, V: Wide<S>, const N: usize>(simd: S, [l, m]: [V; 2]) -> [V; N] {
    let (zero, one) = (V::splat(simd, 0.0), V::splat(simd, 1.0));
    let mut left = l.simd_gt(zero).select(zero, m);
    let mut cuts = [zero; N];
    // Edges beyond the last corner count as the first one.
    for i in (0..8).rev() {
        let bit = V::splat(simd, f64::from(1u32 << i));
        let cut = left.simd_ge(bit);
        left = cut.select(left - bit, left);
        if i < N {
            cuts[i] = cut.select(one, zero);
        }
    }
    cuts
}

/// The edge of A that separates best, with the centre of B at d, going w against A. A cut is no face, but it separates: what
/// stays beyond it is met by another piece, however `near`. Nor is a face what separates against the `side` that B is on.
#[inline(always)]
pub(super) fn best<S: Simd, V: Wide<S>, const N: usize, const BOXES: bool>(
    simd: S,
    a: &Corners<V, N>,
    b: &Corners<V, N>,
    [dx, dy, wx, wy]: [V; 4],
    cuts: Option<([V; N], V)>,
    side: Option<[V; 2]>,
) -> Face<V> {
    let zero = V::splat(simd, 0.0);
    let none = V::splat(simd, f64::NEG_INFINITY);
    let mut face = Face {
        separation: none,
        stays: none,
        cut: none,
        nx: a.nx[0],
        ny: a.ny[0],
        x: a.x[0],
        y: a.y[0],
        x_next: a.x[1],
        y_next: a.y[1],
    };
    let least = nearest::<S, V, N, BOXES>(simd, a, b);
    for i in 0..N {
        let next = (i + 1) % N;
        let (nx, ny) = (a.nx[i], a.ny[i]);
        let off = nx * a.x[i] + ny * a.y[i];
        let separation = least[i] + (nx * dx + ny * dy) - off;
        let nears = (nx * wx + ny * wy).min(zero);
        let (mut stays, mut separation) = (separation + nears, separation);
        if let Some((cuts, near)) = &cuts {
            let faceless = V::splat(simd, FACELESS);
            let one = V::splat(simd, 1.0);
            face.cut = (separation + (one - cuts[i]) * faceless).max(face.cut);
            stays += cuts[i] * *near;
            separation += cuts[i] * faceless;
        }
        face.stays = stays.max(face.stays);
        if let Some([x, y]) = side {
            let is_against = (nx * x + ny * y).simd_lt(zero);
            separation = is_against.select(V::splat(simd, FACELESS), separation);
        }
        let better = separation.simd_gt(face.separation);
        face.separation = better.select(separation, face.separation);
        face.nx = better.select(nx, face.nx);
        face.ny = better.select(ny, face.ny);
        face.x = better.select(a.x[i], face.x);
        face.y = better.select(a.y[i], face.y);
        face.x_next = better.select(a.x[next], face.x_next);
        face.y_next = better.select(a.y[next], face.y_next);
    }
    face
}

/// How far the nearest corner of B is along each normal of A, from the centre of mass of B.
#[inline(always)]
fn nearest<S: Simd, V: Wide<S>, const N: usize, const BOXES: bool>(
    simd: S,
    a: &Corners<V, N>,
    b: &Corners<V, N>,
) -> [V; N] {
    let mut least = [V::splat(simd, 0.0); N];
    // Normals of a box are two and their opposites.
    let normals = if BOXES { 2 } else { N };
    for i in 0..normals {
        let mut low = a.nx[i] * b.x[0] + a.ny[i] * b.y[0];
        let mut high = low;
        for k in 1..N {
            let along = a.nx[i] * b.x[k] + a.ny[i] * b.y[k];
            low = along.min(low);
            high = along.max(high);
        }
        least[i] = low;
        if BOXES {
            least[i + 2] = -high;
        }
    }
    least
}

#[inline(always)]
pub(super) fn choose<S: Simd, V: Wide<S>>(first: V::Mask, a: &Face<V>, b: &Face<V>) -> Face<V> {
    Face {
        separation: first.select(a.separation, b.separation),
        stays: first.select(a.stays, b.stays),
        cut: first.select(a.cut, b.cut),
        nx: first.select(a.nx, b.nx),
        ny: first.select(a.ny, b.ny),
        x: first.select(a.x, b.x),
        y: first.select(a.y, b.y),
        x_next: first.select(a.x_next, b.x_next),
        y_next: first.select(a.y_next, b.y_next),
    }
}
