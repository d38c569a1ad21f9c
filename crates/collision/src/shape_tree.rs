//! Shapes where they are, and questions to all of them: no world, no time, no mass.

use carom_geometry::{Aabb, RayHit, Shape};
use carom_math::{Pose, Vec2};

use crate::{BoxTree, CastHit, Distance, NodeId, cast, shape_distance};

/// Shapes at poses, each with an id.
///
/// Of equal answers the lower id counts: what is asked is answered alike, however the shapes came
/// in or moved before.
///
/// # Examples
/// ```
/// use carom_collision::ShapeTree;
/// use carom_geometry::{Circle, ConvexPolygon};
/// use carom_math::{Pose, Vec2, vec2};
/// let mut yard = ShapeTree::new();
/// let wall = yard.insert(ConvexPolygon::rectangle(1.0, 8.0)?.into(), Pose::at(vec2(5.0, 0.0)));
/// let post = yard.insert(Circle::new(0.5)?.into(), Pose::at(vec2(2.0, 0.0)));    // m
///
/// let (hit, ray) = yard.cast_ray(Vec2::ZERO, Vec2::X, 100.0).expect("something is there");
/// assert_eq!((hit, ray.distance), (post, 1.5));
///
/// // A ball of a metre does not pass beside the post, one of 30 cm does and reaches the wall.
/// let way = vec2(8.0, 0.0);
/// let roll = |radius| -> Result<_, carom_geometry::ShapeError> {
///     let ball = Circle::new(radius)?.into();
///     Ok(yard.cast_shape(&ball, Pose::at(vec2(0.0, 1.0)), way).map(|(id, hit)| (id, hit.fraction)))
/// };
/// assert_eq!(roll(1.0)?.map(|hit| hit.0), Some(post));
/// assert_eq!(roll(0.25)?, Some((wall, 0.53125)));                                // 4.25 m of 8 m
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ShapeTree {
    tree: BoxTree,
    entries: Vec<Entry>,
    free: Vec<u32>,
}

/// A shape, or what is left of one.
#[derive(Clone, Debug)]
struct Entry {
    id: NodeId,
    shape: Shape,
    pose: Pose,
}

impl ShapeTree {
    /// No shapes.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            tree: BoxTree::new(),
            entries: Vec::new(),
            free: Vec::new(),
        }
    }

    /// How many shapes there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.tree.len()
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.tree.is_empty()
    }

    /// Puts a shape in; many at once are faster by `collect`.
    pub fn insert(&mut self, shape: Shape, pose: Pose) -> NodeId {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "no more than leaves of a tree"
        )]
        let place = self.free.pop().unwrap_or(self.entries.len() as u32);
        let id = self.tree.insert(box_of(&shape, pose), place);
        let entry = Entry { id, shape, pose };
        match self.entries.get_mut(place as usize) {
            Some(old) => *old = entry,
            None => self.entries.push(entry),
        }
        id
    }

    /// Puts a shape elsewhere; whether it is there at all.
    pub fn set_pose(&mut self, id: NodeId, pose: Pose) -> bool {
        let Some(place) = self.tree.data(id) else {
            return false;
        };
        let entry = &mut self.entries[place as usize];
        entry.pose = pose;
        self.tree.update(id, box_of(&entry.shape, pose));
        true
    }

    /// Takes a shape out; whether it was there.
    pub fn remove(&mut self, id: NodeId) -> bool {
        let place = self.tree.remove(id);
        self.free.extend(place);
        place.is_some()
    }

    /// A shape and where it is; `None` if it was removed.
    #[must_use]
    pub fn get(&self, id: NodeId) -> Option<(&Shape, Pose)> {
        let entry = self.entry(self.tree.data(id)?);
        Some((&entry.shape, entry.pose))
    }

    /// All ids, in order.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<'_> {
        self.tree.ids()
    }

    /// The first shape on a ray from `origin`, up to `max` lengths of `direction`.
    #[must_use]
    pub fn cast_ray(&self, origin: Vec2, direction: Vec2, max: f64) -> Option<(NodeId, RayHit)> {
        let mut best: Option<(NodeId, RayHit)> = None;
        self.tree.ray(origin, direction, max, |place| {
            let Entry { id, shape, pose } = self.entry(place);
            let reach = best.map_or(max, |(_, hit)| hit.distance);
            let local = (pose.inverse_point(origin), pose.inverse_vector(direction));
            if let Some(hit) = shape.cast_ray(local.0, local.1, reach)
                && best.is_none_or(|(known, b)| (hit.distance, *id) < (b.distance, known))
            {
                let hit = RayHit {
                    distance: hit.distance,
                    point: pose.point(hit.point),
                    normal: pose.vector(hit.normal),
                };
                best = Some((*id, hit));
            }
            best.map_or(f64::INFINITY, |(_, hit)| hit.distance)
        });
        best
    }

    /// The first shape that `shape` at `pose` meets on its way along `translation` (m), not turning;
    /// as [`cast`] has it.
    #[must_use]
    pub fn cast_shape(
        &self,
        shape: &Shape,
        pose: Pose,
        translation: Vec2,
    ) -> Option<(NodeId, CastHit)> {
        let mut best: Option<(NodeId, CastHit)> = None;
        self.tree
            .sweep(box_of(shape, pose), translation, 1.0, |place| {
                let target = self.entry(place);
                if let Some(hit) = cast(shape, pose, translation, &target.shape, target.pose)
                    && best.is_none_or(|(known, b)| (hit.fraction, target.id) < (b.fraction, known))
                {
                    best = Some((target.id, hit));
                }
                best.map_or(f64::INFINITY, |(_, hit)| hit.fraction)
            });
        best
    }

    /// The point of any shape nearest to `point`, within `max` (m): `point` itself inside a shape.
    ///
    /// # Examples
    /// ```
    /// use carom_collision::ShapeTree;
    /// use carom_geometry::{Circle, Shape};
    /// use carom_math::{Pose, vec2};
    /// let disc = Shape::from(Circle::new(1.0)?);
    /// let row: ShapeTree = (0..100).map(|i| (disc.clone(), Pose::at(vec2(4.0 * f64::from(i), 0.0)))).collect();
    /// let (id, point) = row.closest_point(vec2(41.0, 0.0), f64::INFINITY).expect("a shape");
    /// assert_eq!((row.ids().nth(10), point), (Some(id), vec2(41.0, 0.0)));       // on the rim
    /// assert_eq!(row.closest_point(vec2(40.0, 9.0), 7.5), None);                 // 8 m
    /// # Ok::<(), carom_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn closest_point(&self, point: Vec2, max: f64) -> Option<(NodeId, Vec2)> {
        let mut best: Option<((f64, NodeId), Vec2)> = None;
        self.tree.nearest(Aabb::new(point, point), max, |place| {
            let Entry { id, shape, pose } = self.entry(place);
            let near = pose.point(shape.closest_point(pose.inverse_point(point)));
            let order = (near.distance(point), *id);
            if order.0 <= max && best.is_none_or(|(known, _)| order < known) {
                best = Some((order, near));
            }
            best.map_or(f64::INFINITY, |((distance, _), _)| distance)
        });
        best.map(|((_, id), near)| (id, near))
    }

    /// The shape nearest to `shape` at `pose`, within `max` (m), with the shortest way to it, which
    /// is in the frame of `shape`: 0 for all that it touches.
    #[must_use]
    pub fn closest_shape(&self, shape: &Shape, pose: Pose, max: f64) -> Option<(NodeId, Distance)> {
        let mut best: Option<(NodeId, Distance)> = None;
        self.tree.nearest(box_of(shape, pose), max, |place| {
            let other = self.entry(place);
            let way = shape_distance(shape, &other.shape, other.pose.seen_from(pose));
            if way.distance <= max
                && best.is_none_or(|(known, b)| (way.distance, other.id) < (b.distance, known))
            {
                best = Some((other.id, way));
            }
            best.map_or(f64::INFINITY, |(_, way)| way.distance)
        });
        best
    }

    /// All shapes that contain `point`, rims included, in order.
    #[must_use]
    pub fn shapes_at(&self, point: Vec2) -> Vec<NodeId> {
        self.all(Aabb::new(point, point), |entry| {
            entry.shape.contains(entry.pose.inverse_point(point))
        })
    }

    /// All shapes with boxes that overlap `bounds`, in order.
    #[must_use]
    pub fn shapes_in(&self, bounds: Aabb) -> Vec<NodeId> {
        self.all(bounds, |entry| {
            entry.shape.aabb(entry.pose).overlaps(bounds)
        })
    }

    /// All shapes that touch or overlap `shape` at `pose`, in order.
    #[must_use]
    pub fn shapes_touching(&self, shape: &Shape, pose: Pose) -> Vec<NodeId> {
        self.all(box_of(shape, pose), |entry| {
            shape_distance(shape, &entry.shape, entry.pose.seen_from(pose)).distance <= 0.0
        })
    }

    fn all(&self, bounds: Aabb, matches: impl Fn(&Entry) -> bool) -> Vec<NodeId> {
        let mut found = Vec::new();
        self.tree.query(bounds, |place| {
            let entry = self.entry(place);
            if matches(entry) {
                found.push(entry.id);
            }
        });
        found.sort_unstable();
        found
    }

    fn entry(&self, place: u32) -> &Entry {
        &self.entries[place as usize]
    }
}

/// All at once.
impl FromIterator<(Shape, Pose)> for ShapeTree {
    fn from_iter<T: IntoIterator<Item = (Shape, Pose)>>(shapes: T) -> Self {
        let shapes: Vec<(Shape, Pose)> = shapes.into_iter().collect();
        let mut tree = BoxTree::new();
        let boxes = shapes.iter().map(|(shape, pose)| box_of(shape, *pose));
        let ids = tree.extend(boxes.zip(0..));
        let entries = ids.into_iter().zip(shapes);
        Self {
            tree,
            entries: entries
                .map(|(id, (shape, pose))| Entry { id, shape, pose })
                .collect(),
            free: Vec::new(),
        }
    }
}

/// The box of a shape with room for the roundings of a question.
fn box_of(shape: &Shape, pose: Pose) -> Aabb {
    let bounds = shape.aabb(pose);
    bounds.grown(roundable(bounds))
}

/// More than a few roundings of coordinates as large as those of a box, in m; sides at infinity do
/// not count.
#[must_use]
pub fn roundable(bounds: Aabb) -> f64 {
    const ROUNDINGS: f64 = 1.0 / (1u64 << 48) as f64;
    let sides = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y].map(f64::abs);
    let finite = sides.into_iter().filter(|side| side.is_finite());
    finite.fold(0.0, f64::max) * ROUNDINGS
}
