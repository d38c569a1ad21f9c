//! `reference` on the project's own cases and on folders made for the purpose.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::xtask_in;

const SQUARE: &str = r#"{"category": "mass_properties", "cases": [{
    "id": "mass-square",
    "inputs": {"vertices": [["0.0", "0.0"], ["1.0", "0.0"], ["1.0", "1.0"], ["0.0", "1.0"]],
               "density": "2.0", "mass": "6.0"},
    "outputs": {
        "area": {"value": "1.0", "hp": "AREA"},
        "centroid": {"value": ["0.5", "0.5"], "hp": ["0.5", "0.5"]},
        "inertia_from_mass": {"value": "1.0", "hp": "1.0"},
        "bounding_radius": {"value": "0.7071067811865476"}}}]}"#;

/// Worlds of the default mode answer what those of exact mode do.
#[test]
fn what_is_listed_as_passing_passes_in_the_default_mode() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/reference");
    let list = fs::read_to_string(folder.join("passing.txt")).unwrap();
    let ran = xtask_in(
        &folder,
        &["reference", "open", "--list", "--mode", "hybrid"],
    );
    let passes: BTreeSet<&str> = lines_after(&ran.out, "pass ").collect();
    let broken: Vec<&str> = list.lines().filter(|id| !passes.contains(id)).collect();
    let why: Vec<&str> = lines_after(&ran.out, "fall short ").collect();
    assert!(broken.is_empty(), "{broken:?}\n{}", why.join("\n"));
}

/// The ids that `passing.txt` names are those that pass as asked and in all other guises.
#[test]
fn what_is_listed_as_passing_passes_and_nothing_else() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/reference");
    let list = fs::read_to_string(folder.join("passing.txt")).unwrap();
    assert!(
        list.lines().is_sorted_by(|a, b| a < b),
        "passing.txt is not sorted, or names a case twice"
    );
    let listed: BTreeSet<&str> = list.lines().collect();
    let guises: [&[&str]; 4] = [
        &[],
        &["--transform", "1"],
        &["--transform", "2"],
        &["--transform", "3"],
    ];
    let mut always: Option<BTreeSet<String>> = None;
    for guise in guises {
        let ran = xtask_in(&folder, &[&["reference", "open", "--list"], guise].concat());
        let passes: BTreeSet<&str> = lines_after(&ran.out, "pass ").collect();
        let broken: Vec<&&str> = listed.difference(&passes).collect();
        let why: Vec<&str> = lines_after(&ran.out, "fall short ")
            .filter(|line| broken.iter().any(|id| line.starts_with(&format!("{id}: "))))
            .collect();
        assert!(
            broken.is_empty(),
            "{guise:?}: {broken:?}\n{}",
            why.join("\n")
        );
        let passes: BTreeSet<String> = passes.into_iter().map(str::to_owned).collect();
        always = Some(match always {
            Some(before) => before.intersection(&passes).cloned().collect(),
            None => passes,
        });
    }
    let mut always = always.unwrap_or_default();
    always.retain(|id| !listed.contains(id.as_str()));
    assert!(
        always.is_empty(),
        "not in tests/reference/passing.txt yet: {always:?}"
    );
}

fn lines_after<'a>(text: &'a str, start: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines()
        .filter_map(move |line| line.strip_prefix(start))
}

#[test]
fn a_right_answer_passes_in_every_guise() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.json"), SQUARE.replace("AREA", "1.0")).unwrap();
    for seed in ["1", "2", "3", "4", "5"] {
        let ran = xtask_in(folder.path(), &["reference", ".", "--transform", seed]).done();
        assert!(
            ran.out.contains("mass_properties: 1 of 1 pass"),
            "{}",
            ran.out
        );
    }
    xtask_in(folder.path(), &["reference", ".", "--json", "answers.json"]).done();
    let answers = fs::read_to_string(folder.path().join("answers.json")).unwrap();
    let answers: serde_json::Value = serde_json::from_str(&answers).unwrap();
    assert_eq!(answers["engine"], "carom");
    assert_eq!(answers["cases"][0]["id"], "mass-square");
    assert_eq!(
        answers["cases"][0]["outputs"]["centroid"],
        serde_json::json!([0.5, 0.5])
    );
}

#[test]
fn a_wrong_answer_and_an_unknown_category_fall_short() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.json"),
        SQUARE.replace("AREA", "1.000000000001"),
    )
    .unwrap();
    let ran = xtask_in(folder.path(), &["reference", "."]);
    assert_eq!(ran.code, Some(1), "{}", ran.err);
    assert!(
        ran.out.contains("mass-square: area is off by 1.00e-12"),
        "{}",
        ran.out
    );

    let future = r#"{"category": "tides", "cases": [{"id": "t", "inputs": {}, "outputs": {}}]}"#;
    fs::write(folder.path().join("a.json"), future).unwrap();
    let ran = xtask_in(folder.path(), &["reference", ".", "--json", "answers.json"]);
    assert_eq!(ran.code, Some(1), "{}", ran.err);
    assert!(ran.out.contains("tides: 0 of 1 pass"), "{}", ran.out);
    let answers = fs::read_to_string(folder.path().join("answers.json")).unwrap();
    assert!(
        answers.contains("category tides is not answered yet"),
        "{answers}"
    );
}

#[test]
fn folders_that_hold_no_cases() {
    let folder = tempfile::tempdir().unwrap();
    xtask_in(folder.path(), &["reference", "missing"]).refused(&["missing"]);
    xtask_in(folder.path(), &["reference", "."]).refused(&["no reference file"]);
    fs::write(folder.path().join("broken.json"), "{\"cases\": [\n{]").unwrap();
    xtask_in(folder.path(), &["reference", "."]).refused(&["broken.json", "line 2 column 2"]);
}
