//! What a world checks where it is inserted is checked where it is read, too: the feature `serde`.
//!
//! The derives (`remote = "Self"`) make functions of the same names that do not check; these call them.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{BodyDef, Material, PairMaterial, Settings};

impl Serialize for Material {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Material {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = Self::deserialize(deserializer)?;
        read.check().map_err(D::Error::custom)?;
        Ok(read)
    }
}

impl Serialize for PairMaterial {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for PairMaterial {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = Self::deserialize(deserializer)?;
        read.check().map_err(D::Error::custom)?;
        Ok(read)
    }
}

impl Serialize for Settings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Settings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = Self::deserialize(deserializer)?;
        read.check().map_err(D::Error::custom)?;
        Ok(read)
    }
}

impl Serialize for BodyDef {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for BodyDef {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = Self::deserialize(deserializer)?;
        read.check().map_err(D::Error::custom)?;
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use carom_math::vec2;
    use serde::Serialize;
    use serde::de::DeserializeOwned;

    use crate::{BodyDef, Filter, ImpactLaw, Material, Mode, PairMaterial, Settings};

    fn comes_back<T: Serialize + DeserializeOwned + PartialEq + core::fmt::Debug>(value: &T) {
        let text = serde_json::to_string(value).unwrap();
        assert_eq!(&serde_json::from_str::<T>(&text).unwrap(), value, "{text}");
    }

    #[test]
    fn values_come_back_bit_by_bit() {
        comes_back(&Settings {
            gravity: vec2(0.1, -9.81),
            mode: Mode::Exact,
            impact_law: ImpactLaw::Poisson,
            sleep: None,
            ..Settings::default()
        });
        comes_back(&Settings::fast());
        comes_back(&Material {
            restitution: 0.1,
            ..Material::default()
        });
        comes_back(&PairMaterial::default());
        let filter = Filter {
            group: -3,
            ..Filter::default()
        };
        comes_back(
            &BodyDef::kinematic()
                .at(vec2(0.1, 0.2))
                .with_mass(3.0)
                .filtered(filter),
        );
    }

    #[test]
    fn what_is_left_out_is_the_default() {
        let ice: Material = serde_json::from_str(r#"{"friction": 0.02}"#).unwrap();
        assert_eq!(
            ice,
            Material {
                friction: 0.02,
                ..Material::default()
            }
        );
        assert_eq!(
            serde_json::from_str::<Settings>("{}").unwrap(),
            Settings::default()
        );
    }

    #[test]
    fn what_a_world_refuses_is_refused() {
        let error = |text: &str| {
            serde_json::from_str::<Material>(text)
                .unwrap_err()
                .to_string()
        };
        assert!(error(r#"{"restitution": 1.5}"#).contains("restitution"));
        assert!(error(r#"{"density": -1.0}"#).contains("density"));
        assert!(error(r#"{"frictoin": 0.1}"#).contains("unknown field `frictoin`"));
        let error = serde_json::from_str::<Settings>(r#"{"tick": 0.0}"#).unwrap_err();
        assert!(error.to_string().contains("tick"), "{error}");
        let error = serde_json::from_str::<BodyDef>(r#"{"mass": -1.0}"#).unwrap_err();
        assert!(error.to_string().contains("mass"), "{error}");
        assert!(serde_json::from_str::<PairMaterial>(r#"{"friction": -1.0}"#).is_err());
    }
}
