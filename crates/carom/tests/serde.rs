//! Materials, settings and definitions that are written and read again: the feature `serde`.

#![cfg(feature = "serde")]

use carom::{BodyDef, Filter, ImpactLaw, Material, Mode, PairMaterial, Settings, vec2};
use serde::Serialize;
use serde::de::DeserializeOwned;

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
