//! Slices drawn apart are one film when they are joined, or they are refused.

use std::fs;
use std::path::Path;

use carom_render::{Existing, OutputFolder};

use crate::{Ran, carom_in, names};

const SCENE: [&str; 8] = [
    "render",
    "flying-balls",
    "--seconds",
    "0.35",
    "--fps",
    "20",
    "--size",
    "64x48",
];

fn render(folder: &Path, more: &[&str]) -> Ran {
    carom_in(folder, &[&SCENE, more].concat())
}

fn merge(folder: &Path, more: &[&str]) -> Ran {
    carom_in(folder, &[&["merge"], more].concat())
}

/// Three slices of seven frames in `a`, `b` and `c`, and all of them in `whole`.
fn slices() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (out, slice) in [("a", "1/3"), ("b", "2/3"), ("c", "3/3")] {
        render(folder.path(), &["--out", out, "--shard", slice]).done();
    }
    render(folder.path(), &["--out", "whole"]).done();
    folder
}

#[test]
fn joined_slices_are_what_one_run_writes() {
    let folder = slices();
    let path = folder.path();
    merge(path, &["c", "a", "b", "--out", "joined"]).done();
    assert_eq!(names(&path.join("joined")), names(&path.join("whole")));
    for name in names(&path.join("whole")) {
        let read = |place: &str| fs::read(path.join(place).join(&name)).unwrap();
        assert_eq!(read("joined"), read("whole"), "{name}");
    }
    // What was joined goes on like any other run.
    let ran = render(path, &["--out", "joined", "--resume"]).done();
    assert!(ran.out.contains("0 drawn, 7 kept"), "{}", ran.out);

    merge(path, &["a", "b", "c", "--out", "joined"]).refused(&["joined", "already holds"]);
    merge(path, &["a", "b", "c", "--out", "joined", "--force"]).done();
}

#[test]
fn slices_that_do_not_fit_are_refused_by_name() {
    let folder = slices();
    let path = folder.path();
    merge(path, &["a", "c"]).refused(&["slice 2/3 is missing"]);
    merge(path, &["a", "b"]).refused(&["slice 3/3 is missing"]);
    merge(path, &["a", "b", "b", "c"]).refused(&["b and b", "slice 2/3"]);
    merge(path, &["nowhere"]).refused(&["nowhere", "no manifest"]);
    merge(path, &["a", "b", "c", "--out", "./b", "--force"]).refused(&["./b", "one of the slices"]);
    assert_eq!(names(&path.join("b")).len(), 3);

    render(path, &["--out", "other", "--shard", "2/3", "--set", "n=3"]).done();
    merge(path, &["a", "other", "c"]).refused(&["a and other", "different runs"]);
    render(path, &["--out", "half", "--shard", "2/2"]).done();
    merge(path, &["a", "b", "half"]).refused(&["b and half", "cut differently"]);
    let demo = OutputFolder::open(path.join("demo"), Existing::Refuse, "demo thesis").unwrap();
    demo.close().unwrap();
    merge(path, &["demo"]).refused(&["demo", "not written by render"]);

    fs::remove_file(path.join("b/frame_00003.png")).unwrap();
    merge(path, &["a", "b", "c"]).refused(&["b/frame_00003.png", "o such file"]);
}

#[test]
fn a_frame_that_was_changed_is_not_joined() {
    let folder = slices();
    let path = folder.path();
    fs::copy(
        path.join("a/frame_00000.png"),
        path.join("b/frame_00003.png"),
    )
    .unwrap();
    let ran = merge(path, &["a", "b", "c", "--out", "joined"]);
    assert_eq!(ran.code, Some(2));
    assert!(
        ran.err
            .contains("b/frame_00003.png is not what its manifest says"),
        "{}",
        ran.err
    );
    render(path, &["--out", "b", "--shard", "2/3", "--resume"]).done();
    merge(path, &["a", "b", "c", "--out", "joined"]).done();
}

#[test]
fn a_film_is_not_cut_into_slices() {
    let folder = tempfile::tempdir().unwrap();
    for format in ["apng", "y4m", "sheet"] {
        render(folder.path(), &["--format", format, "--shard", "1/2"]).refused(&["--shard", "png"]);
    }
    assert!(names(folder.path()).is_empty());
}
