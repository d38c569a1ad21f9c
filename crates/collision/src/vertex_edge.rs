//! The thesis's own method: vertices of one polygon behind edges of the other, concave ones too.
//!
//! Source: the thesis of the project's origin, section 3.2.2, with its errors mended: a vertex is
//! inside by its winding number and not by one crossed edge, parallel is a matter of angle and not
//! of length, and where two corners are inside each other the least overlap decides. Slow (every
//! edge against every edge) and independent of the pieces that the fast paths use.

mod rings;

use carom_geometry::Polygon;
use carom_math::{Pose, Vec2, cross};

use crate::outline::Pair;
use crate::sat::Face;
use crate::{AxisFeature, Convex, Side, separating_axis};
use rings::{Place, Ring};

/// Sine of the angle up to which two edges are parallel, whatever their size: over the length of an
/// edge they part by a hundred-millionth of it.
const PARALLEL: f64 = 1e-8;

/// How two polygons meet at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexEdgeKind {
    /// A vertex of one is behind an edge of the other.
    VertexOnEdge,
    /// Two edges lie along each other.
    ParallelEdges,
    /// A corner of each is inside the other, or on it.
    VertexOnVertex,
}

/// A place where two polygons meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexEdge {
    /// How they meet.
    pub kind: VertexEdgeKind,
    /// Impact point in A's frame, in metres: the vertex, the middle between two vertices, or the
    /// middle of what two edges share.
    pub point: Vec2,
    /// Unit normal in A's frame, from A to B.
    pub normal: Vec2,
    /// How far the polygons overlap along the normal, in metres; never below 0.
    pub overlap: f64,
    /// Which polygon owns the vertex; the other one owns the edge. A, for parallel edges.
    pub owner: Side,
    /// Index of the vertex; of the start of A's edge, for parallel edges.
    pub vertex: usize,
    /// Index of the edge in the other polygon.
    pub edge: usize,
}

/// Every place where two simple polygons overlap or touch; none if they are apart.
///
/// A vertex counts where it is the deepest of its neighbourhood, against the edge through which its
/// outline came in. Two polygons that only touch are found up to rounding (2^-46 of their size).
///
/// # Examples
/// ```
/// use carom_collision::{VertexEdgeKind, vertex_edge_contacts};
/// use carom_geometry::Polygon;
/// use carom_math::{Pose, vec2};
/// let floor = Polygon::new([vec2(-4.0, -1.0), vec2(4.0, -1.0), vec2(4.0, 0.0), vec2(-4.0, 0.0)])?;
/// let arrow = Polygon::new([vec2(0.0, 0.0), vec2(1.0, 2.0), vec2(0.0, 1.0), vec2(-1.0, 2.0)])?;
/// let found = vertex_edge_contacts(&floor, &arrow, Pose::at(vec2(1.0, -0.25)));
/// assert_eq!(found.len(), 1);
/// assert_eq!(found[0].kind, VertexEdgeKind::VertexOnEdge);
/// assert_eq!((found[0].point, found[0].normal), (vec2(1.0, -0.25), vec2(0.0, 1.0)));
/// assert_eq!(found[0].overlap, 0.25);                                          // m
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn vertex_edge_contacts(a: &Polygon, b: &Polygon, b_in_a: Pose) -> Vec<VertexEdge> {
    let rings = [
        Ring::new(a.vertices().to_vec()),
        Ring::new(b.vertices().iter().map(|v| b_in_a.point(*v)).collect()),
    ];
    let scene = Scene::new(rings);
    if !scene.boxes_overlap() {
        return Vec::new();
    }
    let parallel = scene.parallel_edges();
    let mut touches = scene.vertices_behind_edges(Side::A);
    touches.extend(scene.vertices_behind_edges(Side::B));
    touches.retain(|touch| {
        !parallel
            .iter()
            .any(|edges| scene.belongs_to(*touch, *edges))
    });
    let corners = scene.corners(&mut touches);

    let mut found: Vec<VertexEdge> = parallel.iter().map(|edges| scene.along(*edges)).collect();
    found.extend(corners);
    found.extend(touches.iter().map(|touch| scene.vertex_on_edge(*touch)));
    if found.is_empty() {
        found.extend(through(a, b, b_in_a, &scene));
    }
    found
}

/// A vertex behind an edge of the other polygon.
#[derive(Clone, Copy)]
struct Touch {
    owner: Side,
    vertex: usize,
    edge: usize,
    depth: f64,
}

/// Edges of A and B that lie along each other.
#[derive(Clone, Copy)]
struct Edges {
    of: [usize; 2],
    depth: f64,
    /// Middle of what they share, on each.
    middle: [Vec2; 2],
}

/// Both outlines in A's frame.
struct Scene {
    rings: [Ring; 2],
    /// What counts as touching, in metres.
    touch: f64,
}

impl Scene {
    fn new(rings: [Ring; 2]) -> Self {
        /// Rounding of a vertex that was turned and moved, as a fraction of the polygons' size.
        const TOUCH: f64 = 1.0 / (1u64 << 46) as f64;
        let size = |ring: &Ring| ring.bounds.extents().max_element();
        let away = rings[1].bounds.centre() - rings[0].bounds.centre();
        let touch = TOUCH * (size(&rings[0]) + size(&rings[1]) + away.length());
        Self { rings, touch }
    }

    fn boxes_overlap(&self) -> bool {
        self.rings[0]
            .bounds
            .grown(self.touch)
            .overlaps(self.rings[1].bounds)
    }

    /// How far `point` is behind edge `edge` of a polygon.
    fn depth(&self, side: Side, edge: usize, point: Vec2) -> f64 {
        let ring = &self.rings[side as usize];
        ring.normals[edge].dot(ring.points[edge] - point)
    }

    /// Whether both neighbours of a vertex are no deeper behind an edge of the other polygon.
    fn is_deepest(&self, owner: Side, vertex: usize, edge: usize) -> bool {
        let (own, other) = (&self.rings[owner as usize], &self.rings[1 - owner as usize]);
        [own.previous(vertex), own.next(vertex)]
            .into_iter()
            .all(|i| {
                let way = own.points[i] - own.points[vertex];
                other.normals[edge].dot(way) >= -PARALLEL * way.length()
            })
    }

    /// Vertices of one polygon in the other, each with its edge.
    fn vertices_behind_edges(&self, owner: Side) -> Vec<Touch> {
        let (own, other) = (&self.rings[owner as usize], &self.rings[1 - owner as usize]);
        let crossings = own.crossings(other);
        let mut found = Vec::new();
        for vertex in 0..own.points.len() {
            let point = own.points[vertex];
            let edges: Vec<usize> = match other.place(point, self.touch) {
                Place::Outside => continue,
                Place::On => other.edges_at(point, self.touch),
                // Where the outline through this vertex comes in and goes out.
                Place::Inside => crossings.around(vertex).into_iter().flatten().collect(),
            };
            let best = edges
                .into_iter()
                .filter(|edge| self.is_deepest(owner, vertex, *edge))
                .map(|edge| (edge, self.depth(owner.other(), edge, point)))
                .filter(|(_, depth)| *depth >= -self.touch)
                .min_by(|p, q| p.1.total_cmp(&q.1));
            if let Some((edge, depth)) = best {
                found.push(Touch {
                    owner,
                    vertex,
                    edge,
                    depth: depth.max(0.0),
                });
            }
        }
        found
    }

    /// Pairs of edges that face each other, share a stretch, and have nothing between them but both
    /// bodies.
    fn parallel_edges(&self) -> Vec<Edges> {
        let [a, b] = &self.rings;
        let mut found = Vec::new();
        for (i, n) in a.normals.iter().enumerate() {
            for (j, m) in b.normals.iter().enumerate() {
                if n.dot(*m) < 0.0 && cross(*n, *m).abs() <= PARALLEL {
                    found.extend(self.shared_stretch([i, j]));
                }
            }
        }
        // Only the nearest edge of the other polygon is touched. Two pairs at one corner of each (a
        // box half over the corner of a box) are one place: the lesser overlap, or, of equal ones,
        // neither: then it is corner in corner.
        let nearer = |x: &Edges, y: &Edges| y.depth + self.tie(x.depth) < x.depth;
        let beats = |y: &Edges, x: &Edges| {
            let one_edge = x.of[0] == y.of[0] || x.of[1] == y.of[1];
            (one_edge && nearer(x, y)) || (self.share_corners(x, y) && !nearer(y, x))
        };
        found
            .iter()
            .filter(|x| !found.iter().any(|y| beats(y, x)))
            .copied()
            .collect()
    }

    /// Overlaps that differ by less are equal.
    fn tie(&self, depth: f64) -> f64 {
        self.touch + 1e-9 * depth.abs()
    }

    /// Whether two pairs of edges meet in a convex corner of both polygons.
    fn share_corners(&self, x: &Edges, y: &Edges) -> bool {
        (0..2).all(|k| {
            let ring = &self.rings[k];
            let corner = if ring.next(x.of[k]) == y.of[k] {
                y.of[k]
            } else if ring.next(y.of[k]) == x.of[k] {
                x.of[k]
            } else {
                return false;
            };
            ring.is_convex(corner)
        })
    }

    /// What two facing edges share, if one is behind the other with both bodies between.
    fn shared_stretch(&self, of: [usize; 2]) -> Option<Edges> {
        let [a, b] = &self.rings;
        let (from, to) = (a.points[of[0]], a.points[a.next(of[0])]);
        let length = (to - from).length();
        let along = (to - from) / length;
        let at = |p: Vec2| (p - from).dot(along);
        // B's edge runs the other way.
        let (end, start) = (b.points[of[1]], b.points[b.next(of[1])]);
        let (low, high) = (at(start).max(0.0), at(end).min(length));
        if high - low <= self.touch {
            return None;
        }
        let middle = 0.5 * (low + high);
        let share = (middle - at(start)) / (at(end) - at(start));
        let middle = [from + along * middle, start + (end - start) * share];
        let depth = a.normals[of[0]].dot(middle[0] - middle[1]);
        let both = || {
            b.place(middle[0], self.touch) == Place::Inside
                && a.place(middle[1], self.touch) == Place::Inside
        };
        (depth.abs() <= self.touch || (depth > 0.0 && both())).then_some(Edges {
            of,
            depth: depth.max(0.0),
            middle,
        })
    }

    /// Whether a vertex is the end of one of two parallel edges and behind the other one.
    fn belongs_to(&self, touch: Touch, edges: Edges) -> bool {
        let (own, other) = (touch.owner as usize, 1 - touch.owner as usize);
        let ring = &self.rings[own];
        let is_end = edges.of[own] == touch.vertex || ring.next(edges.of[own]) == touch.vertex;
        // Dropped pairs at a shared corner leave their vertices behind: these are the same place.
        let same_edge = edges.of[other] == touch.edge;
        let rings = &self.rings[other];
        let beside =
            rings.next(touch.edge) == edges.of[other] || rings.next(edges.of[other]) == touch.edge;
        is_end && (same_edge || (beside && touch.depth > edges.depth + self.touch))
    }

    /// Takes out the pairs of vertices that are behind each other's edges: corner in corner.
    fn corners(&self, touches: &mut Vec<Touch>) -> Vec<VertexEdge> {
        let mut found = Vec::new();
        let mut i = 0;
        while i < touches.len() {
            let touch = touches[i];
            let partner = touches.iter().position(|other| {
                touch.owner == Side::A
                    && other.owner == Side::B
                    && self.rings[1].ends(touch.edge).contains(&other.vertex)
                    && self.rings[0].ends(other.edge).contains(&touch.vertex)
            });
            if let Some(j) = partner {
                found.push(self.corner(touch.vertex, touches[j].vertex));
                // B's touches come after A's.
                touches.remove(j);
                touches.remove(i);
            } else {
                i += 1;
            }
        }
        found
    }

    /// Corner of A in corner of B: the least overlap of their four edges, and among equals the
    /// direction between them, so that no order of storage decides.
    fn corner(&self, of_a: usize, of_b: usize) -> VertexEdge {
        let [a, b] = &self.rings;
        let (p, q) = (a.points[of_a], b.points[of_b]);
        let behind = |owner: Side, vertex: usize, point: Vec2, edges: [usize; 2]| {
            edges.map(|edge| {
                let normal = self.rings[1 - owner as usize].normals[edge];
                Way {
                    owner,
                    vertex,
                    edge,
                    normal: if owner == Side::A { -normal } else { normal },
                    depth: self.depth(owner.other(), edge, point),
                    valid: self.is_deepest(owner, vertex, edge),
                }
            })
        };
        let all = [
            behind(Side::A, of_a, p, [b.previous(of_b), of_b]),
            behind(Side::B, of_b, q, [a.previous(of_a), of_a]),
        ];
        let ways = || all.iter().flatten();
        let any_valid = ways().any(|way| way.valid);
        let open = || ways().filter(|way| way.valid || !any_valid);
        let least = open().map(|way| way.depth).fold(f64::INFINITY, f64::min);
        let tied = || open().filter(|way| way.depth <= least + self.tie(least));
        let sum: Vec2 = tied().map(|way| way.normal).sum();
        // Four ways and none skipped: there is a first.
        let first = tied().next().unwrap_or(&all[0][0]);
        let normal = sum.try_normalize().unwrap_or(first.normal);
        VertexEdge {
            kind: VertexEdgeKind::VertexOnVertex,
            point: 0.5 * (p + q),
            normal,
            overlap: (p - q).dot(normal).max(0.0),
            owner: first.owner,
            vertex: first.vertex,
            edge: first.edge,
        }
    }

    fn along(&self, edges: Edges) -> VertexEdge {
        // The bisector of the two normals: the same for both orders of the polygons.
        let [n, m] = [0, 1].map(|k| self.rings[k].normals[edges.of[k]]);
        VertexEdge {
            kind: VertexEdgeKind::ParallelEdges,
            point: 0.5 * (edges.middle[0] + edges.middle[1]),
            normal: (n - m).try_normalize().unwrap_or(n),
            overlap: edges.depth,
            owner: Side::A,
            vertex: edges.of[0],
            edge: edges.of[1],
        }
    }

    fn vertex_on_edge(&self, touch: Touch) -> VertexEdge {
        let normal = self.rings[1 - touch.owner as usize].normals[touch.edge];
        VertexEdge {
            kind: VertexEdgeKind::VertexOnEdge,
            point: self.rings[touch.owner as usize].points[touch.vertex],
            normal: if touch.owner == Side::A {
                -normal
            } else {
                normal
            },
            overlap: touch.depth,
            owner: touch.owner,
            vertex: touch.vertex,
            edge: touch.edge,
        }
    }
}

/// One way to part two corners.
struct Way {
    owner: Side,
    vertex: usize,
    edge: usize,
    normal: Vec2,
    depth: f64,
    valid: bool,
}

/// Polygons that overlap without a vertex that came in: bars that cross, one inside the other, two
/// at one place. The deepest of their pieces' least overlaps.
fn through(a: &Polygon, b: &Polygon, b_in_a: Pose, scene: &Scene) -> Option<VertexEdge> {
    let mut best: Option<VertexEdge> = None;
    for piece_a in a.pieces() {
        for piece_b in b.pieces() {
            let (hull_a, hull_b) = (piece_a.hull(), piece_b.hull());
            let axis = separating_axis(&hull_a, &hull_b, b_in_a);
            let AxisFeature::Edge {
                owner,
                edge,
                vertex,
            } = axis.feature
            else {
                continue;
            };
            if axis.separation >= -scene.touch {
                continue;
            }
            let pair = Pair::new(&hull_a, &hull_b, b_in_a);
            let face = Face {
                separation: axis.separation,
                edge,
                vertex,
            };
            let least = if pair.allows(owner, face) {
                Some((owner, face))
            } else {
                pair.least_overlap()
            };
            let Some((owner, face)) = least else {
                continue;
            };
            if best.is_some_and(|known| known.overlap >= -face.separation) {
                continue;
            }
            let (own, other) = (&pair.hulls[owner as usize], &pair.hulls[1 - owner as usize]);
            // Where the pieces' corners are in the outlines: pieces have no corners of their own.
            let outlines = [a.vertices(), b.vertices()];
            let index = |side: Side, p: Vec2| outlines[side as usize].iter().position(|v| *v == p);
            let normal = own.normals[face.edge];
            best = Some(VertexEdge {
                kind: VertexEdgeKind::VertexOnEdge,
                point: match owner {
                    Side::A => b_in_a.point(other.vertices[face.vertex]),
                    Side::B => other.vertices[face.vertex],
                },
                normal: match owner {
                    Side::A => normal,
                    Side::B => -b_in_a.vector(normal),
                },
                overlap: -face.separation,
                owner: owner.other(),
                vertex: index(owner.other(), other.vertices[face.vertex]).unwrap_or(0),
                edge: index(owner, own.vertices[face.edge]).unwrap_or(0),
            });
        }
    }
    best
}
