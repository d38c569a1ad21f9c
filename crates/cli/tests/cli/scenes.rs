//! Scene files that are broken: one line with file, line, column and field, exit code 2, nothing written.

use std::fs;

use crate::{carom, carom_in, names};

#[track_caller]
fn refused(text: impl AsRef<[u8]>, parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.toml"), text).unwrap();
    for args in [
        &["render", "bad.toml", "--out", "frames", "--seconds", "1"][..],
        &["simulate", "bad.toml", "--seconds", "1", "--out", "t.csv"],
    ] {
        carom_in(folder.path(), args).refused(parts);
    }
    assert_eq!(names(folder.path()), ["bad.toml"]);
}

/// A scene with one body; its table ends with these lines.
fn body(lines: &str) -> String {
    format!("version = 1\n[[body]]\nname = 'a'\n{lines}\n")
}

#[test]
fn files_that_are_no_scenes() {
    refused("", &["bad.toml", "empty"]);
    refused(b"\xff\xfe\x00\x01", &["bad.toml", "UTF-8"]);
    refused([0; 64], &["bad.toml:1:", "not valid TOML"]);
    refused(
        "version = 1\n[[body]]\nname = \"ba",
        &["bad.toml:3:11", "not valid TOML"],
    );
    refused("version = 7\n", &["bad.toml:1:11", "version", "future"]);

    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scene.toml")).unwrap();
    carom_in(folder.path(), &["render", "scene.toml"]).refused(&["scene.toml", "is a folder"]);
    carom_in(folder.path(), &["render", "missing.toml"]).refused(&["missing.toml", "no such file"]);
}

#[test]
fn unknown_words() {
    refused(
        body("masss = 3"),
        &["bad.toml:4:1", "body.masss", "did you mean \"mass\""],
    );
    refused(
        body("shape = { cirle = 1 }"),
        &["bad.toml:4:11", "body.shape.cirle", "\"circle\""],
    );
    carom(&["render", "thesiss"]).refused(&["thesiss", "thesis"]);
    carom(&["render", "flying-balls", "--set", "nn=3"]).refused(&["--set nn=3", "\"n\""]);
}

#[test]
fn values_of_the_wrong_kind() {
    refused(
        "version = 1\nduration = 'long'\n",
        &["bad.toml:2:12", "duration", "\"long\""],
    );
    refused(
        "version = 1\nduration = nan\n",
        &["bad.toml:2:12", "duration", "nan"],
    );
    refused(
        "version = 1\nduration = 1e999\n",
        &["bad.toml:2:12", "duration", "1e999"],
    );
    let twice = "version = 1\n[[body]]\nname = 'a'\nshape = { circle = 1 }\n\
                 [[body]]\nname = 'a'\nshape = { circle = 1 }\n";
    refused(twice, &["bad.toml:6:8", "body.name", "line 3"]);
}

#[test]
fn shapes_and_materials_that_cannot_be() {
    refused(
        body("shape = { circle = 0 }"),
        &["bad.toml:4", "circle", "0"],
    );
    refused(
        body("shape = { circle = -1 }"),
        &["bad.toml:4", "circle", "-1"],
    );
    refused(
        body("shape = { polygon = [[0, 0], [1, 0]] }"),
        &["bad.toml:4", "polygon", "3"],
    );
    refused(
        body("shape = { polygon = [[0, 0], [1, 1], [2, 2]] }"),
        &["bad.toml:4", "polygon", "no area"],
    );
    refused(
        body("shape = { polygon = [[0, 0], [2, 2], [2, 0], [0, 2]] }"),
        &["bad.toml:4", "edge 0", "edge 2"],
    );
    let circle = "shape = { circle = 1 }\n";
    for (material, part) in [
        ("{ density = 0 }", "density"),
        ("{ density = -1 }", "density"),
        ("{ restitution = 1.5 }", "restitution"),
        ("{ restitution = -0.1 }", "restitution"),
        ("{ friction = -1 }", "friction"),
    ] {
        refused(
            body(&format!("{circle}material = {material}")),
            &["bad.toml", part],
        );
    }
}

#[test]
fn a_mark_and_dos_lines_are_welcome() {
    let folder = tempfile::tempdir().unwrap();
    let text = "\u{feff}version = 1\r\n[[body]]\r\nname = 'ball'\r\nshape = { circle = 1 }\r\n";
    fs::write(folder.path().join("good.toml"), text).unwrap();
    let ran = carom_in(
        folder.path(),
        &["simulate", "good.toml", "--seconds", "0.1"],
    )
    .done();
    assert!(
        ran.out.starts_with("time,body,x,y,angle,vx,vy,omega\n0.0,"),
        "{}",
        ran.out
    );
}

/// A larger one passes the limits on place and speed within a second, and its energies overflow.
#[test]
fn gravity_of_more_than_1e12_is_refused() {
    let text = |gravity: &str| format!("version = 1\ngravity = [{gravity}]\n");
    refused(
        text("0, 1e308"),
        &[
            "bad.toml:2:15: gravity[1]: settings.gravity.y is ",
            "outside",
        ],
    );
    refused(
        text("-1e13, 0"),
        &["bad.toml:2:12: gravity[0]: settings.gravity.x is -10000000000000, outside"],
    );
    let folder = tempfile::tempdir().unwrap();
    let run = |set: &str| {
        let args = ["simulate", "thesis", "--seconds", "0", "--set", set];
        carom_in(folder.path(), &args)
    };
    run("fconst=[0, 1e13]").refused(&["--set fconst=[0, 1e13]: parameters.fconst[1]: "]);
    run("gravity=[0, -1e12]").done();
}

#[test]
fn a_body_with_shape_and_shapes_is_refused() {
    refused(
        body("shape = { circle = 1 }\nshapes = [{ circle = 2 }]"),
        &["bad.toml:5:10: body.shapes: both shape and shapes are given"],
    );
}

#[test]
fn huge_numbers_do_not_fill_lines() {
    for text in [
        "version = 1\n[settings]\ntick = 1e308\n",
        "version = 1\n[settings]\nsubstep = -1e-300\n",
        "version = 1\n\ngravity = [1e308, 0]\n",
        "version = 1\n[walls]\ninner = { min = [-1e308, 0], max = [1e307, 1] }\n",
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("bad.toml"), text).unwrap();
        let ran = carom_in(folder.path(), &["render", "bad.toml"]);
        let said = ran.refused(&["bad.toml:3:", "e"]).err;
        assert!(said.len() < 250, "{said}");
    }
    let ran = carom(&["inertia", "0,0 2,0 2,1 0,1", "--mass", "1e300"]).done();
    assert!(ran.out.contains("mass        1e300 kg"), "{}", ran.out);
    carom(&["inertia", "0,0 1,0 0,1", "--mass", "-1e300"]).refused(&["mass is -1e300, not"]);
    let ran = carom(&["simulate", "thesis", "--seconds", "1e300", "--every", "1"]);
    ran.refused(&["--seconds 1e300 every 1 s"]);
}

#[test]
fn a_step_of_too_many_ticks_names_the_tick_in_the_file() {
    let text = |lines: &str| format!("version = 1\n{lines}\n");
    refused(
        text("[settings]\ntick = 1e-9\nsubstep = 1e-9"),
        &[
            "bad.toml:3:8: settings.tick: ",
            "0.000000001 s is too short",
        ],
    );
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| carom_in(folder.path(), &[&["simulate", "thesis"], more].concat());
    run(&[
        "--seconds",
        "1",
        "--set",
        "delta=1e-9",
        "--set",
        "settings.substep=1e-9",
    ])
    .refused(&["--set delta=1e-9: parameters.delta: ", "is too short"]);
    let ran = run(&["--seconds", "1e200", "--every", "1e199"]);
    ran.refused(&[
        "thesis: settings.tick: ",
        "steps of 1e199 s hold more than 1e7 of it",
    ]);
}

/// A line of a megabyte is no line for reading.
#[test]
fn what_is_named_is_not_named_at_any_length() {
    let folder = tempfile::tempdir().unwrap();
    let (long, place) = ("ä".repeat(500_000), folder.path().join("long.toml"));
    for text in [
        format!("version = 1\nduration = \"{long}\""),
        format!("version = 1\n\"{long}\" = 1"),
    ] {
        fs::write(&place, text).unwrap();
        let ran = carom_in(folder.path(), &["check", "long.toml"]);
        let length = ran.err.chars().count();
        assert!(length < 2000, "{length} characters");
        ran.refused(&["long.toml:2:", "ääää", "…"]);
    }
}
