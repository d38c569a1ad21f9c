//! What is written of a rotation, and what is read back: the feature `serde`.

use serde::{Deserialize, Serialize};

use crate::Rot;

/// How far from 1 the squares may add up to: a rotation that was turned a million times is nearer.
const DRIFT: f64 = 1e-6;

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CosSin {
    cos: f64,
    sin: f64,
}

impl From<Rot> for CosSin {
    fn from(rot: Rot) -> Self {
        Self {
            cos: rot.cos(),
            sin: rot.sin(),
        }
    }
}

impl TryFrom<CosSin> for Rot {
    type Error = String;

    fn try_from(CosSin { cos, sin }: CosSin) -> Result<Self, String> {
        let length = cos * cos + sin * sin;
        // NaN is none, too.
        if (length - 1.0).abs() <= DRIFT {
            Ok(Self::from_cos_sin(cos, sin))
        } else {
            Err(format!(
                "cos {cos:?} and sin {sin:?} are of no rotation: their squares add up to {length:?}, not to 1"
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Pose, Rot, vec2};

    #[test]
    fn a_pose_comes_back_bit_by_bit() {
        let pose = Pose::new(vec2(0.1, -3e-9), Rot::from_angle(2.0));
        let text = serde_json::to_string(&pose).unwrap();
        assert_eq!(serde_json::from_str::<Pose>(&text).unwrap(), pose, "{text}");
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        for (text, part) in [
            (r#"{"cos": 1.0, "sin": 1.0}"#, "add up to 2.0"),
            (r#"{"cos": 0.0, "sin": 0.0}"#, "add up to 0.0"),
            (
                r#"{"cos": 1.0, "sin": 0.0, "tan": 0.0}"#,
                "unknown field `tan`",
            ),
        ] {
            let error = serde_json::from_str::<Rot>(text).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }
}
