//! When, where and how two shapes in the plane touch.

mod cast;
mod contacts;
mod distance;
mod hull;
mod manifold;
mod motion;
mod outline;
mod sat;
mod toi;
mod tree;
mod vertex_edge;

pub use cast::{CastHit, cast};
pub use contacts::{PartManifold, contacts};
pub use distance::{Distance, distance, shape_distance};
pub use hull::{Convex, Hull, hulls, part, part_count};
pub use manifold::{FeatureId, Manifold, ManifoldPoint, collide, collide_within};
pub use motion::Motion;
pub use sat::{Axis, AxisFeature, Side, minimum_push, separating_axis};
pub use toi::{Impact, TimeOfImpact, earlier, time_of_impact, time_of_impact_of_parts};
pub use tree::{BoxTree, NodeId};
pub use vertex_edge::{VertexEdge, VertexEdgeKind, vertex_edge_contacts};
