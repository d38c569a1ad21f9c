//! Numbers as the tables write them.

use serde::{Serialize as _, Serializer};

/// What stands for a number that is none: the run blew up.
pub(crate) const NOT_FINITE: &str = "not finite";

/// Three significant digits, in the shorter of the two notations; an en dash where there is none.
pub(crate) fn number(value: Option<f64>) -> String {
    let Some(value) = value else {
        return "–".to_owned();
    };
    let size = value.abs();
    if !size.is_finite() {
        return NOT_FINITE.to_owned();
    }
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.1e}");
    }
    let decimals = [1.0, 10.0, 100.0]
        .iter()
        .filter(|limit| size < **limit)
        .count();
    let decimals = if size < 0.1 { decimals + 1 } else { decimals };
    let decimals = if size < 0.01 { decimals + 1 } else { decimals };
    format!("{value:.decimals$}")
}

/// Two digits and a power of ten, as errors are compared; 0 is exactly 0.
pub(crate) fn error(value: Option<f64>) -> String {
    match value {
        None => "–".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(value) if !value.is_finite() => NOT_FINITE.to_owned(),
        Some(value) => format!("{value:.1e}"),
    }
}

/// A ratio near 1.
pub(crate) fn ratio(value: Option<f64>) -> String {
    match value {
        None => "–".to_owned(),
        Some(value) if !value.is_finite() => NOT_FINITE.to_owned(),
        Some(value) => format!("{value:.4}"),
    }
}

/// For CSV and JSON, which has no such numbers: `NaN`, `inf` and `-inf` as words.
#[expect(
    clippy::ref_option,
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands a reference to the field"
)]
pub(crate) fn word_if_not_finite<S: Serializer>(
    value: &Option<f64>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match value {
        Some(value) if !value.is_finite() => serializer.collect_str(value),
        value => value.serialize(serializer),
    }
}

/// A cell without what would end it.
pub(crate) fn cell(text: &str) -> String {
    text.replace('|', "/").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (Some(0.0), "0"),
            (Some(1.0), "1.00"),
            (Some(12.34), "12.3"),
            (Some(123.4), "123"),
            (Some(0.1234), "0.123"),
            (Some(0.01234), "0.0123"),
            (Some(0.001_234), "0.00123"),
            (Some(0.000_123), "1.2e-4"),
            (Some(-2.5), "-2.50"),
            (Some(1e6), "1.0e6"),
            (None, "–"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(error(Some(0.0123)), "1.2e-2");
        assert_eq!(error(Some(0.0)), "0");
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(Some) {
            assert_eq!([number(value), error(value), ratio(value)], [NOT_FINITE; 3]);
        }
    }
}
