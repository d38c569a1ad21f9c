//! How a world computes.

use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor, value::MapAccessDeserializer};

/// `[settings]`: what is not given is the engine's default.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct SettingsTable {
    pub(crate) tick: Option<f64>,
    pub(crate) substep: Option<f64>,
    pub(crate) mode: Option<ModeName>,
    pub(crate) pairs: Option<PairsName>,
    pub(crate) impact_law: Option<LawName>,
    pub(crate) several: Option<SeveralName>,
    pub(crate) field_error: Option<f64>,
    pub(crate) sleep: Option<SleepChoice>,
    pub(crate) contact: ContactTable,
    pub(crate) history: Option<usize>,
    pub(crate) events: Option<usize>,
    pub(crate) threads: Option<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ModeName {
    Hybrid,
    Exact,
    Stepped,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PairsName {
    None,
    All,
    Indexed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum LawName {
    Newton,
    Poisson,
    Stronge,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum SeveralName {
    Blend,
    Newton,
    Reflections,
}

/// `sleep = true`, `false` or `{ speed, time }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SleepChoice {
    Never,
    Default,
    After(SleepTable),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct SleepTable {
    pub(crate) speed: Option<f64>,
    pub(crate) time: Option<f64>,
}

impl<'de> Deserialize<'de> for SleepChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Choice;
        impl<'de> Visitor<'de> for Choice {
            type Value = SleepChoice;
            fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str("true, false or { speed, time }")
            }
            fn visit_bool<E: Error>(self, sleeps: bool) -> Result<SleepChoice, E> {
                Ok(if sleeps {
                    SleepChoice::Default
                } else {
                    SleepChoice::Never
                })
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<SleepChoice, A::Error> {
                SleepTable::deserialize(MapAccessDeserializer::new(map)).map(SleepChoice::After)
            }
        }
        deserializer.deserialize_any(Choice)
    }
}

/// `[settings.contact]`: the soft law of lasting contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct ContactTable {
    pub(crate) frequency: Option<f64>,
    pub(crate) damping_ratio: Option<f64>,
    pub(crate) compliance: Option<f64>,
    pub(crate) over_relaxation: Option<f64>,
    pub(crate) push_out: Option<f64>,
}
