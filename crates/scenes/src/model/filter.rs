//! Collision filters in a scene file.

use serde::Deserialize;

/// `filter = { categories = [1], mask = [0, 2], group = -1 }`: categories are numbers, 0..63.
///
/// What is not given is the engine's default: category 0, which touches everything, and no group.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct FilterTable {
    pub(crate) categories: Option<Vec<u8>>,
    pub(crate) mask: Option<Vec<u8>>,
    pub(crate) group: i32,
}

/// `[[pair]]`: how two bodies meet, instead of what their materials say together.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PairTable {
    /// The names of both.
    pub(crate) bodies: [String; 2],
    pub(crate) friction: f64,
    #[serde(default)]
    pub(crate) restitution: f64,
    #[serde(default)]
    pub(crate) tangent_speed: f64,
}
