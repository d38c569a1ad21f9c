//! What `demo` writes, and what it refuses to touch.

use std::fs;

use carom_render::Picture;

use crate::{names, xtask_in};

#[test]
fn the_demo_writes_what_it_says_and_replaces_only_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let ran = xtask_in(folder.path(), &["demo", "--quick", "--out", "demo"]).done();
    for word in [
        "bodies",
        "impacts",
        "energy drift",
        "momentum",
        "deepest",
        "handed over",
        "unresolved",
        "collapsed",
        "refused",
        "physics",
        "drawing",
        "state hash",
        "film.png",
    ] {
        assert_eq!(
            ran.out.matches(word).count().min(2),
            2,
            "'{word}' in\n{}",
            ran.out
        );
    }
    let thesis = folder.path().join("demo/thesis");
    for file in [
        "film.png",
        "sheet.png",
        "energy.png",
        "energy.svg",
        "frame_00000.png",
    ] {
        assert!(thesis.join(file).is_file(), "{file}");
    }
    for name in names(&thesis).iter().filter(|name| name.ends_with(".png")) {
        let bytes = fs::read(thesis.join(name)).unwrap();
        Picture::from_png(&bytes).unwrap();
    }
    fs::write(thesis.join("notes.txt"), "mine").unwrap();
    let before = names(&thesis);
    xtask_in(folder.path(), &["demo", "--quick", "--out", "demo"]).done();
    assert_eq!(names(&thesis), before);
}
