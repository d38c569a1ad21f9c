//! `check`: what a scene costs, before anything is run or written.

use std::fs;

use crate::{carom, carom_in, names};

#[test]
fn a_scene_tells_its_bodies_vertices_pixels_and_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let text = "version = 1\nduration = 2.0\n[camera]\nsize = [100, 50]\n\
                [[body]]\nname = 'floor'\nkind = 'fixed'\nshape = { rectangle = [4, 1] }\n\
                [[body]]\nname = 'ball'\nposition = [0, 3]\nshape = { circle = 0.5 }\n";
    fs::write(folder.path().join("mine.toml"), text).unwrap();
    let ran = carom_in(folder.path(), &["check", "mine.toml"]).done();
    let line = |word: &str| {
        let found = ran.out.lines().find(|line| line.starts_with(word));
        found.unwrap_or_else(|| panic!("no {word} in\n{}", ran.out))
    };
    assert!(line("valid").ends_with("mine.toml"));
    assert!(line("bodies").ends_with("2 (1 moving)"));
    assert!(line("vertices").contains(" 5 in 2 shapes"));
    assert!(line("film").ends_with("2 s at 30 per second: 60 frames of 100 x 50 px"));
    assert!(line("pixels").ends_with(" 300000"));
    assert!(line("bytes").ends_with(" 900000 unpacked"));
    assert_eq!(names(folder.path()), ["mine.toml"]);
}

#[test]
fn what_is_wrong_gets_one_line_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let text = "version = 1\n[[body]]\nname = 'a'\nshape = { circle = -1 }\n";
    fs::write(folder.path().join("bad.toml"), text).unwrap();
    carom_in(folder.path(), &["check", "bad.toml"]).refused(&["bad.toml:4", "circle", "-1"]);
    carom_in(folder.path(), &["check", "missing.toml"]).refused(&["missing.toml", "no such file"]);
    carom(&["check", "thesis", "--set", "nn=3"]).refused(&["--set nn=3"]);
}

#[test]
fn every_built_in_scene_is_valid() {
    let ran = carom(&["list"]).done();
    for name in ["thesis", "flying-balls", "pile"] {
        assert!(ran.out.contains(name));
        carom(&["check", name]).done();
    }
}
