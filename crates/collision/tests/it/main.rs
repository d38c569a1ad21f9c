//! Laws of collision detection, and the errors of the documents the project grew from.

#![allow(clippy::float_cmp, reason = "tests compare exact results")]

mod cast;
mod compounds;
mod concave;
mod distance;
mod documents;
mod impacts;
mod large;
mod manifold;
mod overlap;
mod sat;
mod shape_tree;
mod shapes;
mod vertex_edge;
mod walls;
mod way_out;
