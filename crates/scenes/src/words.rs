//! From the words of serde and of the TOML parser to ours.

use crate::error::Problem;

/// The nesting limit is the parser's own, and its words are about itself.
pub(crate) fn syntax(message: &str) -> Problem {
    if message.contains("recurs") {
        Problem::Syntax("nested too deep".to_owned())
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
        ("expected struct ", "expected a table for "),
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
    words
}
