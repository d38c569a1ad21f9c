//! Fields of a CSV line.

/// A text as a field of a CSV line: quoted where it has to be (RFC 4180).
pub(crate) fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_are_quoted() {
        assert_eq!(field("left wedge"), "left wedge");
        assert_eq!(field("a, \"b\""), "\"a, \"\"b\"\"\"");
    }
}
