//! From the words of serde and of the TOML parser to ours.

use crate::error::Problem;

/// The nesting limit is the parser's own, and its words are about itself; a key is not in its words, but is the text there.
pub(crate) fn syntax(message: &str, text: &str) -> Problem {
    if message.contains("recurs") {
        Problem::Syntax("nested too deep".to_owned())
    } else if message == "duplicate key" {
        Problem::Syntax(format!("{message} '{text}'"))
    } else {
        Problem::Syntax(message.replace('`', "'"))
    }
}

/// Serde speaks of Rust's types, a scene of numbers, lists and tables.
pub(crate) fn plain_words(message: &str) -> String {
    let mut words = message.replace('`', "");
    for (theirs, ours) in [
        ("invalid type: map", "found a table"),
        ("invalid type: sequence", "found a list"),
        ("invalid type: floating point", "found the number"),
        // Of integers beyond 64 bits.
        (" as i128", ""),
        (" as u128", ""),
        ("invalid type: ", "found the "),
        ("invalid value: ", "found the "),
        ("invalid length ", "found a list of "),
        ("expected f64", "expected a number"),
        ("expected a sequence", "expected a list"),
        ("expected a boolean", "expected true or false"),
        ("an array of length ", "a list of "),
        ("expected i32", "expected a whole number"),
        ("expected u64", "expected a whole number from 0 up"),
        ("expected usize", "expected a whole number from 0 up"),
        (
            "expected u32",
            "expected a whole number from 0 to 4294967295",
        ),
        ("wanted string or table", "expected a string"),
    ] {
        words = words.replace(theirs, ours);
    }
    // The name of a table is that of its field; the struct's says nothing more.
    match words.split_once("expected struct ") {
        Some((before, _)) => format!("{before}expected a table"),
        None => words,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_of_rust_are_not_told() {
        for (theirs, ours) in [
            (
                "invalid type: integer `5`, expected struct BodyTable",
                "found the integer 5, expected a table",
            ),
            (
                "invalid type: floating point `1.5`, expected i32",
                "found the number 1.5, expected a whole number",
            ),
            (
                "invalid type: boolean `true`, expected an array of length 2",
                "found the boolean true, expected a list of 2",
            ),
            (
                "invalid length 3, expected an array of length 2",
                "found a list of 3, expected a list of 2",
            ),
        ] {
            assert_eq!(plain_words(theirs), ours);
        }
    }
}
