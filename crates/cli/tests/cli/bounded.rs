//! Small scene files that ask for more than a machine has: one line, at once, in two gigabytes of address space.

use std::fs;
use std::path::Path;
use std::process::Command;

use carom_render::{Colour, Picture, Size};

use crate::ran::{Ran, names};

/// `carom check scene.toml`, with no more than 2 GB.
fn check(folder: &Path, scene: &str) -> Ran {
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 2000000; exec \"$@\"", "sh"])
        .args([crate::CAROM, "check", "scene.toml"])
        .current_dir(folder)
        .output()
        .unwrap();
    Ran {
        code: output.status.code(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn face(folder: &Path, name: &str, side: u32, colour: Colour) {
    let picture = Picture::new(Size::new(side, side).unwrap(), colour);
    fs::write(folder.join(name), picture.to_png()).unwrap();
}

/// A ball for each face.
fn wearing<'a>(faces: impl Iterator<Item = &'a str>) -> String {
    let balls = faces.enumerate().map(|(k, face)| {
        format!(
            "[[body]]\nname = '{k}'\nposition = [{}, 0]\nshape = {{ circle = 1 }}\nface = '{face}'\n",
            3 * k
        )
    });
    "version = 1\n".to_owned() + &balls.collect::<String>()
}

#[test]
fn a_face_of_the_largest_size_is_read_once_for_all_that_wear_it() {
    let root = tempfile::tempdir().unwrap();
    face(root.path(), "large.png", 4096, Colour::BLACK);
    let all = wearing(std::iter::repeat_n("large.png", 100));
    let ran = check(root.path(), &all).done();
    assert!(ran.out.contains("100 (100 moving)"), "{}", ran.out);

    face(root.path(), "small.png", 8, Colour::BLACK);
    let two = wearing(["large.png", "small.png"].into_iter());
    check(root.path(), &two).refused(&[
        "scene.toml:11:8: body.face: ",
        "small.png",
        "16777280 pixels with this one, over the limit of 16777216",
    ]);
}

#[test]
fn a_face_outside_of_the_scene_s_folder_is_not_opened() {
    let root = tempfile::tempdir().unwrap();
    let inner = root.path().join("scenes");
    fs::create_dir_all(inner.join("faces")).unwrap();
    face(root.path(), "outer.png", 8, Colour::BLACK);
    face(&inner, "faces/inner.png", 8, Colour::BLACK);
    let outer = root.path().join("outer.png");
    for name in [
        "../outer.png",
        "faces/../../outer.png",
        outer.to_str().unwrap(),
    ] {
        let ran = check(&inner, &wearing([name].into_iter()));
        ran.refused(&[
            "scene.toml:6:8: body.face: cannot read ",
            "not in the folder of the scene file",
        ]);
    }
    check(&inner, &wearing(["faces/inner.png"].into_iter())).done();
}

#[test]
fn bodies_times_vertices_are_bounded_before_anything_is_made() {
    let root = tempfile::tempdir().unwrap();
    let star = "{ star = { points = 5000, outer = 1.0, inner = 0.5 } }";
    let scene = format!(
        "version = 1\n[[grid]]\nname = 'g'\nshape = {star}\ncorner = [0, 0]\ncolumns = 1000\nrows = 1000\nspacing = [3, 3]\n"
    );
    check(root.path(), &scene).refused(&[
        "scene.toml:2:",
        "grid",
        "10000000000 vertices",
        "over the limit of 4194304",
    ]);
    assert_eq!(names(root.path()), ["scene.toml"]);
}
