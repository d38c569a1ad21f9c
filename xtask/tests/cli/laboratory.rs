//! `accuracy` and `speed`, which the laboratory's own program does.

use std::fs;

use crate::{names, xtask, xtask_in};

#[test]
fn what_does_not_exist_is_refused_with_what_does() {
    let folder = tempfile::tempdir().unwrap();
    for (args, parts) in [
        (
            &["accuracy", "--case", "perpetuum"][..],
            &["perpetuum: unknown case", "01_projectile"][..],
        ),
        (
            &["accuracy", "--engine", "bullet"],
            &["bullet: unknown engine", "box2d-sse2", "chipmunk"],
        ),
        (
            &["speed", "--scene", "z"],
            &["z: unknown scene", "a_large_pyramid", "e_dilute"],
        ),
        (&["speed", "--repeat", "0"], &["--repeat"]),
        (&["speed", "--threads", "0"], &["--threads"]),
        (
            &["accuracy", "--from", "nowhere.csv"],
            &["cannot read nowhere.csv"],
        ),
    ] {
        xtask_in(folder.path(), args).refused(parts);
    }
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn one_case_becomes_table_csv_and_json() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("o");
    let out = out.to_str().unwrap();
    let json = folder.path().join("a.json");
    let args = ["accuracy", "--quick", "--case", "1", "--out", out, "--json"];
    let ran = xtask(&[&args[..], &[json.to_str().unwrap()]].concat()).done();
    assert!(ran.out.contains("## 01_projectile"), "{}", ran.out);
    assert!(
        ran.out.contains("| pos_error_m (m) | carom | hybrid |"),
        "{}",
        ran.out
    );
    let written = names(&folder.path().join("o"));
    for file in ["accuracy.csv", "accuracy.md", "rows.jsonl"] {
        assert!(written.iter().any(|name| name == file), "{written:?}");
    }
    let json = fs::read_to_string(json).unwrap();
    assert!(json.contains("\"case\": \"01_projectile\""), "{json}");

    // What was written is drawn again without measuring.
    let again = folder.path().join("again");
    let csv = format!("{out}/accuracy.csv");
    let args = ["accuracy", "--from", &csv, "--out", again.to_str().unwrap()];
    let second = xtask(&args).done();
    let table = |text: &str| text.split("\nrows ").next().unwrap_or_default().to_owned();
    assert_eq!(table(&second.out), table(&ran.out));
    assert!(!names(&again).contains(&"rows.jsonl".to_owned()));
}

#[test]
fn a_folder_with_rows_of_another_program_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("rows.jsonl");
    fs::write(&rows, "mine\n").unwrap();
    let out = folder.path().to_str().unwrap();
    let ran = xtask(&["accuracy", "--quick", "--case", "1", "--out", out]);
    assert_eq!(ran.code, Some(2), "{}", ran.err);
    assert!(
        ran.err.contains("not written by carom-bench"),
        "{}",
        ran.err
    );
    assert_eq!(fs::read_to_string(&rows).unwrap(), "mine\n");
}
