//! Small scene files that ask for more than a machine has: one line, at once, in two gigabytes of address space.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use carom_render::{Colour, Picture, Size};

use crate::ran::{Ran, names};

/// Runs `carom` with no more than 2 GB.
fn limited(folder: &Path, args: &[&str]) -> Ran {
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 2000000; exec \"$@\"", "sh", crate::CAROM])
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap();
    Ran {
        code: output.status.code(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// `carom check scene.toml`, with no more than 2 GB.
fn check(folder: &Path, scene: &str) -> Ran {
    fs::write(folder.join("scene.toml"), scene).unwrap();
    limited(folder, &["check", "scene.toml"])
}

/// A million stars of 10,000 corners.
fn stars() -> String {
    let star = "{ star = { points = 5000, outer = 1.0, inner = 0.5 } }";
    format!(
        "version = 1\n[[grid]]\nname = 'g'\nshape = {star}\ncorner = [0, 0]\ncolumns = 1000\nrows = 1000\nspacing = [3, 3]\n"
    )
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
    check(root.path(), &stars()).refused(&[
        "scene.toml:2:",
        "grid",
        "10000000000 vertices",
        "over the limit of 4194304",
    ]);
    assert_eq!(names(root.path()), ["scene.toml"]);
}

#[test]
fn two_populations_of_a_hundred_thousand_are_placed() {
    let root = tempfile::tempdir().unwrap();
    let population = |name: &str, side: u32| {
        format!(
            "[[population]]\nname = '{name}'\ncount = 100000\nregion = [0, 0, {side}, {side}]\nradius = 0.5\n"
        )
    };
    let two = |side| {
        format!(
            "version = 1\n{}{}",
            population("p", side),
            population("q", side)
        )
    };
    let ran = check(root.path(), &two(1000)).done();
    assert!(ran.out.contains("200000 (200000 moving)"), "{}", ran.out);
    // Where they find no room the search ends.
    check(root.path(), &two(100)).refused(&[
        "scene.toml:2:1: population: only ",
        " of 100000 bodies of population \"p\" fit",
    ]);
}

#[test]
fn pairs_are_found_by_name_at_once() {
    let root = tempfile::tempdir().unwrap();
    let count = 20_000;
    let mut scene = "version = 1\n".to_owned();
    for k in 0..count {
        let _ = writeln!(
            scene,
            "[[body]]\nname = 'b{k}'\nposition = [{}, 0]\nshape = {{ circle = 1 }}",
            3 * k
        );
    }
    for k in 1..count {
        let _ = writeln!(
            scene,
            "[[pair]]\nbodies = ['b{}', 'b{k}']\nfriction = 0.1",
            k - 1
        );
    }
    let ran = check(root.path(), &scene).done();
    assert!(ran.out.contains("20000 (20000 moving)"), "{}", ran.out);
    scene.push_str("[[pair]]\nbodies = ['b0', 'c']\nfriction = 0.1\n");
    check(root.path(), &scene).refused(&["scene.toml:140000:17: pair.bodies[1]: unknown body"]);
}

#[test]
fn an_outline_of_very_many_teeth_is_read() {
    let root = tempfile::tempdir().unwrap();
    let mut points = String::new();
    for k in 0..50_000 {
        let _ = write!(points, "[{}, {}], ", k % 2 * 100, f64::from(k) * 1e-3);
    }
    let scene = format!(
        "version = 1\n[[body]]\nname = 'comb'\nshape = {{ polygon = [{points}[-1, 50], [-1, 0]] }}\n"
    );
    let ran = check(root.path(), &scene).done();
    assert!(ran.out.contains("50002 in 1 shapes"), "{}", ran.out);
}

/// Frames of an earlier run; what is refused, whatever it is, leaves them as they were.
#[test]
fn what_asks_for_too_much_takes_nothing_of_what_is_there() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path();
    let small = ["--seconds", "0.1", "--fps", "20", "--size", "80x60"];
    let earlier = [&["render", "thesis", "--out", "out"], &small[..]].concat();
    limited(folder, &earlier).done();
    let all = || {
        let there = names(&folder.join("out")).into_iter();
        let read = |name: String| (fs::read(folder.join("out").join(&name)).unwrap(), name);
        there.map(read).collect::<Vec<_>>()
    };
    let before = all();
    assert!(before.len() > 2, "two frames and a manifest");

    face(folder, "large.png", 4096, Colour::BLACK);
    face(folder, "small.png", 8, Colour::BLACK);
    fs::write(
        folder.join("faces.toml"),
        wearing(["large.png", "small.png"].into_iter()),
    )
    .unwrap();
    fs::write(folder.join("stars.toml"), stars()).unwrap();
    fs::write(
        folder.join("dense.toml"),
        "version = 1\n[[population]]\nname = 'p'\ncount = 100000\nregion = [0, 0, 9, 9]\nradius = 0.5\n",
    )
    .unwrap();
    let film = |more: &[&'static str]| [&["thesis"], more].concat();
    for (args, part) in [
        (vec!["faces.toml"], "body.face"),
        (vec!["stars.toml"], "vertices"),
        (vec!["dense.toml"], "population"),
        (
            film(&["--seconds", "14400", "--fps", "60", "--size", "1920x1080"]),
            "1920 x 1080 px are 1791590400000 pixels, over the limit of 1000000000000",
        ),
        (
            film(&["--format", "sheet", "--size", "16384x4096"]),
            "--format sheet of 12 frames of 16384 x 4096 px: canvas of ",
        ),
    ] {
        for flag in ["--force", "--resume"] {
            let all = [&["render"], &args[..], &["--out", "out", flag]].concat();
            limited(folder, &all).refused(&[part]);
        }
    }
    assert!(all() == before, "what was there is there");
}

#[test]
fn threads_share_what_pictures_may_take() {
    let root = tempfile::tempdir().unwrap();
    let args = ["render", "thesis", "--seconds", "0.05", "--fps", "100"];
    let large = ["--size", "8192x4096", "--threads", "1024", "--out", "out"];
    limited(root.path(), &[&args[..], &large].concat()).done();
    assert_eq!(names(&root.path().join("out")).len(), 6);
}

#[test]
fn samples_times_bodies_are_bounded() {
    let root = tempfile::tempdir().unwrap();
    let args = ["simulate", "flying-balls", "--seconds", "1e6"];
    let fine = ["--every", "0.001", "--out", "t.csv"];
    limited(root.path(), &[&args[..], &fine].concat()).refused(&["rows, more than 1e10"]);
    assert!(names(root.path()).is_empty());
}

#[test]
fn a_film_that_is_too_large_is_told_by_check_too() {
    let root = tempfile::tempdir().unwrap();
    let scene = "version = 1\nduration = 1e4\n[camera]\nsize = [8192, 8192]\n";
    check(root.path(), scene).refused(&[
        "10000 s at 30 per second of 8192 x 8192 px are 20132659200000 pixels",
        "over the limit of 1000000000000",
    ]);
}
