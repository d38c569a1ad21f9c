//! Numbers of a reading in JSON, which knows none that are not finite: those are the words `"NaN"`, `"inf"`, `"-inf"`.
//!
//! A run that blew up is a result; its numbers must neither vanish nor make the rest of the line unreadable.
#![expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands a reference to the field"
)]

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One number, as it is written and read.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() {
            serializer.serialize_f64(self.0)
        } else {
            // `NaN`, whatever its sign and payload.
            serializer.collect_str(&self.0)
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Finite(f64),
            Word(Word),
        }
        #[derive(Deserialize)]
        enum Word {
            #[serde(rename = "NaN")]
            Nan,
            #[serde(rename = "inf")]
            Inf,
            #[serde(rename = "-inf")]
            MinusInf,
        }
        Ok(Self(match Written::deserialize(deserializer)? {
            Written::Finite(number) => number,
            Written::Word(Word::Nan) => f64::NAN,
            Written::Word(Word::Inf) => f64::INFINITY,
            Written::Word(Word::MinusInf) => f64::NEG_INFINITY,
        }))
    }
}

/// Writes a field.
pub(crate) fn serialize<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    Number(*number).serialize(serializer)
}

/// Reads a field.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Number::deserialize(deserializer).map(|number| number.0)
}

/// For the values of a case.
pub(crate) mod named {
    use serde::{Deserialize, Deserializer, Serializer};

    use super::Number;

    pub(crate) fn serialize<S: Serializer>(
        values: &[(String, f64)],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(values.iter().map(|(name, value)| (name, Number(*value))))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<(String, f64)>, D::Error> {
        let values: Vec<(String, Number)> = Vec::deserialize(deserializer)?;
        Ok(values
            .into_iter()
            .map(|(name, value)| (name, value.0))
            .collect())
    }
}

/// For a pair.
pub(crate) mod pair {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::Number;

    pub(crate) fn serialize<S: Serializer>(
        pair: &[f64; 2],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        pair.map(Number).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<[f64; 2], D::Error> {
        <[Number; 2]>::deserialize(deserializer).map(|pair| pair.map(|number| number.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_comes_back() {
        for number in [
            0.0,
            -0.0,
            0.1,
            5e-324,
            f64::MAX,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            -f64::NAN,
        ] {
            let text = serde_json::to_string(&Number(number)).expect("writes");
            let Number(back) = serde_json::from_str(&text).expect("reads");
            let same = back.to_bits() == number.to_bits() || back.is_nan() && number.is_nan();
            assert!(same, "{number} as {text} is {back}");
        }
        for text in ["null", "\"nan\"", "\"1.0\"", "true"] {
            assert!(serde_json::from_str::<Number>(text).is_err(), "{text}");
        }
    }
}
