//! Words that the code gave up for those of the field: none comes back, in a file's name, an identifier or a comment.

use std::path::Path;
use std::process::Command;

use crate::exit::Failure;
use crate::out::say;

/// The words, in all their forms, and after a `=` the field's.
const LIST: &str = ".ci/retired-words";

/// Whether no source has a retired word.
pub(super) fn check(root: &Path) -> Result<bool, Failure> {
    let list = std::fs::read_to_string(root.join(LIST))?;
    let retired: Vec<(&str, &str)> = list
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split_once('='))
        .flat_map(|(old, new)| old.split_whitespace().map(move |word| (word, new.trim())))
        .collect();
    let output = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard"])
        .arg("*.rs")
        .current_dir(root)
        .output()?;
    if !output.status.success() {
        let why = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(Failure::new(why));
    }
    let mut found = 0;
    for file in String::from_utf8_lossy(&output.stdout).lines() {
        // A file that is deleted and not yet committed is still listed.
        let Ok(text) = std::fs::read_to_string(root.join(file)) else {
            continue;
        };
        for (number, line) in (0..).zip([file].into_iter().chain(text.lines())) {
            for word in parts(line) {
                let word = word.to_lowercase();
                if let Some((_, new)) = retired.iter().find(|(old, _)| *old == word) {
                    say!("{file}:{number}: {word}, which {LIST} replaces by: {new}");
                    found += 1;
                }
            }
        }
    }
    Ok(found == 0)
}

/// The words of a line: of identifiers each part, whatever its case.
fn parts(line: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let between = |c: char| !c.is_ascii_alphabetic();
    for run in line.split(between).filter(|run| !run.is_empty()) {
        let bytes = run.as_bytes();
        let mut start = 0;
        for at in 1..bytes.len() {
            let upper = bytes[at].is_ascii_uppercase();
            let after_lower = bytes[at - 1].is_ascii_lowercase();
            let before_lower = bytes.get(at + 1).is_some_and(u8::is_ascii_lowercase);
            if upper && (after_lower || before_lower) {
                parts.push(&run[start..at]);
                start = at;
            }
        }
        parts.push(&run[start..]);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn identifiers_have_parts_in_every_case() {
        let line = "fn is_free(FreeBody, FREE_BODIES, XBody)";
        let found = [
            "fn", "is", "free", "Free", "Body", "FREE", "BODIES", "X", "Body",
        ];
        assert_eq!(parts(line), found);
    }
}
