//! The reference in the README: every key is there, and a file with every key builds.

use crate::{Problem, Scene};

const README: &str = include_str!("../README.md");

/// A table of each kind, with an unknown key in place of `?`.
const TABLES: [&str; 23] = [
    "? = 1",
    "[settings]\n? = 1",
    "settings.sleep = { ? = 1 }",
    "[settings.contact]\n? = 1",
    "[parameters]\n? = 1",
    "[camera]\n? = 1",
    "[look]\n? = 1",
    "[materials.any]\n? = 1",
    "[plain]\n? = 1",
    "[walls]\n? = 1",
    "[[field]]\n? = 1",
    "[[body]]\n? = 1",
    "[[body]]\nshape = { ? = 1 }",
    "[[body]]\nshape = { regular = { ? = 1 } }",
    "[[body]]\nshape = { triangle = { ? = 1 } }",
    "[[body]]\nshape = { star = { ? = 1 } }",
    "[[body]]\nimpulse = { ? = 1 }",
    "[[body]]\nfilter = { ? = 1 }",
    "[[pair]]\n? = 1",
    "[[stack]]\n? = 1",
    "[[pyramid]]\n? = 1",
    "[[grid]]\n? = 1",
    "[[population]]\n? = 1",
];

/// Places where one of several words stands.
const WORDS: [&str; 8] = [
    "settings.mode = '?'",
    "settings.impact_law = '?'",
    "settings.several = '?'",
    "settings.pairs = '?'",
    "look.theme = '?'",
    "[[field]]\nkind = '?'",
    "[[body]]\nkind = '?'",
    "[[population]]\nshapes = ['?']",
];

fn known(pattern: &str) -> Vec<String> {
    let text = format!("version = 1\n{}\n", pattern.replace('?', "zzzzzzzzzzzz"));
    let error = Scene::from_toml(&text, "any").expect_err(pattern);
    match error.problem() {
        Problem::Unknown { expected, .. } => expected.clone(),
        other => panic!("{pattern}: {other}"),
    }
}

#[test]
fn every_key_is_in_the_reference() {
    let mut count = 0;
    for pattern in TABLES.into_iter().chain(WORDS) {
        for key in known(pattern) {
            let word = |c: char| !(c.is_alphanumeric() || c == '_');
            let there = README.split(word).any(|found| found == key);
            assert!(there, "`{key}` of {pattern:?} is not in the README");
            count += 1;
        }
    }
    assert!(
        count > 120,
        "{count} keys: the patterns no longer reach their tables"
    );
}

#[test]
fn a_file_with_every_kind_of_table_builds() {
    let text = include_str!("../examples/everything.toml");
    for pattern in TABLES {
        for key in known(pattern) {
            let word = |c: char| !(c.is_alphanumeric() || c == '_');
            let there = text.split(word).any(|found| found == key);
            assert!(there, "`{key}` of {pattern:?} is not in the example");
        }
    }
    let scene = Scene::from_toml(text, "everything.toml").unwrap_or_else(|error| panic!("{error}"));
    let built = scene.build().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(built.names.len(), 2 + 4 + 1 + 10 + 3 + 6 + 4 + 12);
}
