//! The soft law over blocks.

use super::graph::Colour;
use super::law::Law;
use super::line::Line;

/// What is left of k₁₂: where no body can turn both points are one, and may share the load as they like. As its
/// determinant the matrix has 2e-12 of the product of its diagonal then.
pub(super) const REGULAR: f64 = 1.0 - 1e-12;

/// What a sweep does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pass {
    /// Overlaps are pushed out, softly.
    pub(crate) bias: bool,
    /// Friction acts, after the normals.
    pub(crate) friction: bool,
}

/// One pass over all rows, colour by colour.
pub(crate) fn sweep(pass: Pass, law: &Law, lines: &mut [Line], colours: &mut [Colour]) {
    super::plain::sweep(pass, law, lines, colours);
}
