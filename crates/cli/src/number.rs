//! Numbers for reading: with an exponent where their digits would fill lines.

/// From here on, and below its reciprocal, a number is written with an exponent.
const LARGE: f64 = 1e15;

/// Digits, sign and point of a number that a line bears: the largest count has 20, a double to its last digit 24.
const LONG: usize = 24;

/// A number as `{}` writes it, beyond 1e±15 as `{:e}` does.
///
/// # Examples
/// ```
/// use carom_cli::number::number;
/// assert_eq!(number(0.5), "0.5");
/// assert_eq!(number(-1e308), "-1e308");
/// ```
#[must_use]
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1.0 / LARGE..LARGE).contains(&size) || !size.is_finite() {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// The text with its overlong numbers, which errors of every crate may hold, as [`number`] writes them.
pub(crate) fn with_short_numbers(text: &str) -> String {
    // A range is two numbers.
    let sides: Vec<String> = text.split("..").map(shortened).collect();
    sides.join("..")
}

fn shortened(text: &str) -> String {
    let mut short = String::with_capacity(text.len());
    for word in text.split_inclusive([' ', ',', '(', ')', '[', ']', '=', ';', '"', '\'', ':']) {
        let digits = word.trim_end_matches(|c: char| !c.is_ascii_digit());
        let rest = &word[digits.len()..];
        // A hash, or a part of a path.
        let goes_on = rest.starts_with(|c: char| c.is_alphanumeric() || c == '/');
        match digits.parse::<f64>() {
            Ok(value) if digits.len() > LONG && is_plain(digits) && !goes_on => {
                short.push_str(&number(value));
                short.push_str(rest);
            }
            _ => short.push_str(word),
        }
    }
    short
}

fn is_plain(digits: &str) -> bool {
    let digits = digits.strip_prefix('-').unwrap_or(digits);
    digits.bytes().all(|b| b.is_ascii_digit() || b == b'.')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_overlong_numbers_change() {
        for text in [
            "settings.tick is 0, not above 0",
            "18446744073709551615 bodies are over the limit of 1000000",
            "0.12345678901234568 m and -0.00012345678901234568",
            "state hash 0123456789012345678901234567890a",
            "a/12345678901234567890123456789/b.toml:3:1",
        ] {
            assert_eq!(with_short_numbers(text), text);
        }
        let huge = format!("[{0}] is {0}, -{0}..{1}:", 1e308, 1e-300);
        assert_eq!(
            with_short_numbers(&huge),
            "[1e308] is 1e308, -1e308..1e-300:"
        );
    }
}
