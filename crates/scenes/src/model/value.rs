//! Pairs of numbers, as they stand in a scene file.

use core::fmt;
use core::marker::PhantomData;

use carom_math::{Vec2, vec2};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};

/// `[x, y]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point(pub(crate) Vec2);

/// `[least, most]`, or one number for both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) least: f64,
    pub(crate) most: f64,
}

/// `[x0, y0, x1, y1]`: the lower left and the upper right corner, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corners {
    pub(crate) min: Vec2,
    pub(crate) max: Vec2,
}

/// `[least, most]` of a count, or one number for both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CountRange {
    pub(crate) least: u64,
    pub(crate) most: u64,
}

/// `[width, height]` in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pixels {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

/// Reads a list of exactly `N` values; serde's own arrays let further ones pass.
struct Exactly<T, const N: usize> {
    form: &'static str,
    of: PhantomData<T>,
}

impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Exactly<T, N> {
    type Value = [T; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.form)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<[T; N], A::Error> {
        let mut values = Vec::with_capacity(N);
        while let Some(value) = list.next_element()? {
            values.push(value);
        }
        values
            .try_into()
            .map_err(|values: Vec<T>| A::Error::invalid_length(values.len(), &self.form))
    }
}

fn exactly<'de, T: Deserialize<'de>, D: Deserializer<'de>, const N: usize>(
    deserializer: D,
    form: &'static str,
) -> Result<[T; N], D::Error> {
    deserializer.deserialize_seq(Exactly {
        form,
        of: PhantomData,
    })
}

impl<'de> Deserialize<'de> for Point {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [x, y] = exactly(deserializer, "[x, y]")?;
        Ok(Self(vec2(x, y)))
    }
}

impl<'de> Deserialize<'de> for Corners {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [x0, y0, x1, y1] = exactly(deserializer, "[x0, y0, x1, y1]")?;
        Ok(Self {
            min: vec2(x0, y0),
            max: vec2(x1, y1),
        })
    }
}

impl<'de> Deserialize<'de> for Pixels {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [width, height] = exactly(deserializer, "[width, height]")?;
        Ok(Self { width, height })
    }
}

impl<'de> Deserialize<'de> for Range {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [least, most] = deserializer.deserialize_any(OneOrTwo::<f64>(PhantomData))?;
        Ok(Self { least, most })
    }
}

impl<'de> Deserialize<'de> for CountRange {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [least, most] = deserializer.deserialize_any(OneOrTwo::<u64>(PhantomData))?;
        Ok(Self { least, most })
    }
}

/// Reads `x` or `[least, most]`.
struct OneOrTwo<T>(PhantomData<T>);

/// What a range may be made of.
trait End: Copy + for<'de> Deserialize<'de> {
    fn whole(value: i64) -> Option<Self>;
    fn broken(value: f64) -> Option<Self>;
}

impl End for f64 {
    #[expect(
        clippy::cast_precision_loss,
        reason = "whole numbers in a scene are small"
    )]
    fn whole(value: i64) -> Option<Self> {
        Some(value as Self)
    }
    fn broken(value: f64) -> Option<Self> {
        Some(value)
    }
}

impl End for u64 {
    fn whole(value: i64) -> Option<Self> {
        Self::try_from(value).ok()
    }
    fn broken(_: f64) -> Option<Self> {
        None
    }
}

impl<'de, T: End> Visitor<'de> for OneOrTwo<T> {
    type Value = [T; 2];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or [least, most]")
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<[T; 2], E> {
        let end = T::whole(value);
        end.map(|end| [end, end])
            .ok_or_else(|| E::invalid_value(serde::de::Unexpected::Signed(value), &self))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<[T; 2], E> {
        let end = T::broken(value);
        end.map(|end| [end, end])
            .ok_or_else(|| E::invalid_type(serde::de::Unexpected::Float(value), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<[T; 2], A::Error> {
        let pair = Exactly {
            form: "a number or [least, most]",
            of: PhantomData,
        };
        pair.visit_seq(list)
    }
}
