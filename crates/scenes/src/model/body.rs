//! Bodies and what they are made of.

use core::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor, value::MapAccessDeserializer};

use super::filter::FilterTable;
use super::shape::ShapeTable;
use super::value::Point;

/// `[[body]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyTable {
    #[serde(default)]
    pub(crate) name: Option<String>,
    #[serde(default)]
    pub(crate) kind: Kind,
    #[serde(default)]
    pub(crate) shape: Option<ShapeTable>,
    #[serde(default)]
    pub(crate) shapes: Vec<ShapeTable>,
    #[serde(default)]
    pub(crate) position: Option<Point>,
    #[serde(default)]
    pub(crate) angle: Option<f64>,
    #[serde(default)]
    pub(crate) angle_deg: Option<f64>,
    #[serde(default)]
    pub(crate) velocity: Option<Point>,
    #[serde(default)]
    pub(crate) spin: f64,
    #[serde(default)]
    pub(crate) material: MaterialChoice,
    #[serde(default)]
    pub(crate) filter: FilterTable,
    #[serde(default)]
    pub(crate) mass: Option<f64>,
    #[serde(default)]
    pub(crate) inertia: Option<f64>,
    #[serde(default)]
    pub(crate) locked_rotation: bool,
    #[serde(default = "one")]
    pub(crate) gravity_scale: f64,
    #[serde(default)]
    pub(crate) linear_damping: f64,
    #[serde(default)]
    pub(crate) angular_damping: f64,
    #[serde(default)]
    pub(crate) asleep: bool,
    #[serde(default = "yes")]
    pub(crate) sleep_allowed: bool,
    /// A push at t = 0.
    #[serde(default)]
    pub(crate) impulse: Option<ImpulseTable>,
    #[serde(default)]
    pub(crate) colour: Option<String>,
    #[serde(default)]
    pub(crate) face: Option<String>,
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    #[default]
    Dynamic,
    Fixed,
    Kinematic,
}

/// An impulse `value` (N·s) at the world's point `at` (m), both along the world's axes.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ImpulseTable {
    pub(crate) at: Point,
    pub(crate) value: Point,
}

/// Inline, or the name of one of `[materials]`.
#[derive(Clone, Debug)]
pub(crate) enum MaterialChoice {
    Inline(MaterialTable),
    Named(String),
}

impl Default for MaterialChoice {
    fn default() -> Self {
        Self::Inline(MaterialTable::default())
    }
}

/// What is not given is the engine's default.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct MaterialTable {
    pub(crate) density: Option<f64>,
    pub(crate) friction: Option<f64>,
    pub(crate) restitution: Option<f64>,
    pub(crate) tangent_speed: Option<f64>,
}

impl<'de> Deserialize<'de> for MaterialChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Choice;
        impl<'de> Visitor<'de> for Choice {
            type Value = MaterialChoice;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "the name of a material or { density, friction, restitution, tangent_speed }",
                )
            }
            fn visit_str<E: Error>(self, name: &str) -> Result<MaterialChoice, E> {
                Ok(MaterialChoice::Named(name.to_owned()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MaterialChoice, A::Error> {
                MaterialTable::deserialize(MapAccessDeserializer::new(map))
                    .map(MaterialChoice::Inline)
            }
        }
        deserializer.deserialize_any(Choice)
    }
}
