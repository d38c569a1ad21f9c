//! `inertia`, and the wrong shapes of the bad-input list.

use crate::{carom, carom_in};

#[test]
fn a_rectangle_has_the_inertia_of_the_book() {
    let ran = carom(&["inertia", "0,0 2,0 2,1 0,1", "--mass", "12"]).done();
    // m (w² + h²) / 12.
    for line in [
        "area        2 m²",
        "centroid    (1, 0.5) m",
        "mass        12 kg",
        "inertia     5 kg m²",
    ] {
        assert!(ran.out.contains(line), "no '{line}' in\n{}", ran.out);
    }
    let clockwise = carom(&["inertia", "0,0 0,1 2,1 2,0", "--mass", "12"]).done();
    assert_eq!(clockwise.out, ran.out);
}

#[test]
fn a_file_may_have_a_mark_dos_lines_and_comments() {
    let folder = tempfile::tempdir().unwrap();
    let text = "\u{feff}# a square\r\n0, 0\r\n1 0\r\n\r\n1,1 # corner\r\n0,1\r\n";
    std::fs::write(folder.path().join("square.txt"), text).unwrap();
    let ran = carom_in(
        folder.path(),
        &["inertia", "--file", "square.txt", "--density", "3"],
    )
    .done();
    assert!(ran.out.contains("mass        3 kg"), "{}", ran.out);
}

#[test]
fn wrong_outlines_are_refused_by_name() {
    for (vertices, parts) in [
        ("", &["3", "vertices", "0"][..]),
        ("0,0 1,0", &["3", "vertices", "2"]),
        ("0,0 1,0 0,0 1,0", &["vertices"]),
        ("0,0 1,1 2,2 5,5", &["no area"]),
        (
            "0,0 2,2 2,0 0,2",
            &["intersects itself", "edge 0", "edge 2"],
        ),
        ("0,0 NaN,0 1,1", &["vertex 1", "NaN"]),
        ("0,0 1,0 1,inf", &["vertex 2", "inf"]),
        ("0,0 1e999,0 1,1", &["vertex 1", "inf"]),
        ("0,0 1e300,0 1,1", &["vertex 1", "1e300"]),
        ("0,0 1,0 1;1", &["vertex 2", "'1'", "x,y"]),
        ("0,0 1,0 1,one", &["vertex 2", "y", "'one'"]),
    ] {
        carom(&["inertia", vertices]).refused(parts);
    }
}

#[test]
fn wrong_masses_are_refused_by_name() {
    let square = "0,0 1,0 1,1 0,1";
    carom(&["inertia", square, "--density", "0"]).refused(&["density is 0"]);
    carom(&["inertia", square, "--density", "-1"]).refused(&["density is -1"]);
    carom(&["inertia", square, "--mass", "nan"]).refused(&["mass is NaN"]);
    carom(&["inertia", square, "--mass", "heavy"]).refused(&["--mass", "heavy"]);
    carom(&["inertia", "--file", "no-such-file.txt"]).refused(&["no-such-file.txt"]);
}

#[test]
fn the_page_shows_what_is_printed() {
    let page = include_str!("../../README.md");
    let (_, rest) = page.split_once("```sh\n$ carom ").unwrap();
    let (shown, _) = rest.split_once("```").unwrap();
    let (_, lines) = shown.split_once('\n').unwrap();
    let ran = carom(&["inertia", "0,0 2,0 2,1 0,1", "--density", "3"]).done();
    assert_eq!(ran.out, lines);
}
