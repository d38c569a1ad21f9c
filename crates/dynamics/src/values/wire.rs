//! What a world checks where it is inserted is checked where it is read, too: the feature `serde`.
//!
//! The derives (`remote = "Self"`) make functions of the same names that do not check; these call them.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{BodyDef, Material, PairMaterial, Settings};

macro_rules! checked {
    ($($name:ty),*) => {$(
        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                Self::serialize(self, serializer)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let read = Self::deserialize(deserializer)?;
                read.check().map_err(D::Error::custom)?;
                Ok(read)
            }
        }
    )*};
}

checked!(Material, PairMaterial, Settings, BodyDef);
