//! Laws of collision detection, and the errors of the documents the project grew from.

mod cast;
mod concave;
mod distance;
mod documents;
mod manifold;
mod sat;
mod shapes;
mod vertex_edge;
