//! `simulate` and `list`.

use crate::{carom, carom_in, names};

#[test]
fn a_run_gives_the_same_bytes_and_hash_twice() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str| {
        let csv = format!("{name}.csv");
        let json = format!("{name}.json");
        let ran = carom_in(
            folder.path(),
            &[
                "simulate",
                "thesis",
                "--seconds",
                "2",
                "--out",
                &csv,
                "--json",
                &json,
            ],
        )
        .done();
        assert!(
            ran.out.contains("impacts ") && ran.out.contains("state hash"),
            "{}",
            ran.out
        );
        let read = |file: &str| std::fs::read_to_string(folder.path().join(file)).unwrap();
        (read(&csv), read(&json))
    };
    let (first, summary) = run("first");
    let (second, again) = run("second");
    assert_eq!(first, second);
    assert_eq!(summary, again);
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert!(summary["impacts"].as_u64().unwrap() > 0);
    assert_eq!(summary["state_hash"].as_str().unwrap().len(), 16);
    assert_eq!(
        names(folder.path()),
        ["first.csv", "first.json", "second.csv", "second.json"]
    );
}

#[test]
fn a_thrown_ball_is_where_the_book_says() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "version = 1\ngravity = [0, -10]\n[[body]]\nname = 'ball'\n\
                 shape = { circle = 0.1 }\nvelocity = [3, 5]\n";
    std::fs::write(folder.path().join("throw.toml"), scene).unwrap();
    let ran = carom_in(
        folder.path(),
        &[
            "simulate",
            "throw.toml",
            "--seconds",
            "1",
            "--every",
            "0.25",
        ],
    )
    .done();
    let last: Vec<f64> = ran
        .out
        .lines()
        .last()
        .unwrap()
        .split(',')
        .skip(2)
        .map(|x| x.parse().unwrap())
        .collect();
    assert_eq!(ran.out.lines().count(), 6, "{}", ran.out);
    // x = 3 t, y = 5 t − 10 t²/2, at t = 1 s.
    for (found, expected) in last.iter().zip([3.0, 0.0, 0.0, 3.0, -5.0, 0.0]) {
        assert!((found - expected).abs() < 1e-12, "{last:?}");
    }
    assert!(
        ran.err.contains("state hash"),
        "the summary goes to stderr: {}",
        ran.err
    );
}

#[test]
fn a_folder_in_the_place_of_the_table_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("t.csv")).unwrap();
    carom_in(
        folder.path(),
        &["simulate", "thesis", "--seconds", "1", "--out", "t.csv"],
    )
    .refused(&["t.csv", "directory"]);
    std::fs::write(folder.path().join("file"), "").unwrap();
    carom_in(
        folder.path(),
        &[
            "simulate",
            "thesis",
            "--seconds",
            "1",
            "--out",
            "file/t.csv",
        ],
    )
    .refused(&["cannot make the folder file"]);
    let json = [
        "simulate",
        "thesis",
        "--seconds",
        "1",
        "--out",
        "a.csv",
        "--json",
    ];
    for (place, why) in [
        ("t.csv", "directory"),
        ("file/t.json", "cannot make the folder file"),
    ] {
        carom_in(folder.path(), &[&json[..], &[place]].concat()).refused(&[why]);
    }
    assert_eq!(names(folder.path()), ["file", "t.csv"]);
}

#[test]
fn every_built_in_scene_is_listed_and_runs() {
    let listed = carom(&["list"]).done().out;
    assert!(listed.lines().count() >= 2, "{listed}");
    for line in listed.lines() {
        let name = line.split_whitespace().next().unwrap();
        carom(&["simulate", name, "--seconds", "0.05"]).done();
    }
}

#[test]
fn a_flight_past_the_core_of_a_strong_field_is_called_inaccurate() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "version = 1\n[[field]]\nkind = \"radial\"\ncentre = [0, 0]\nstrength = 1e6\ncore = 1e-9\n\
                 [[body]]\nposition = [0.001, 0]\nshape = { circle = 0.5 }\n";
    std::fs::write(folder.path().join("strong.toml"), scene).unwrap();
    let ran = carom_in(
        folder.path(),
        &["simulate", "strong.toml", "--seconds", "0.2"],
    )
    .done();
    let told = ran.err.lines().find(|line| line.starts_with("NOT EXACT"));
    let counts = told.is_some_and(|line| !line.contains("inaccurate 0"));
    assert!(counts, "{}", ran.err);
}

#[test]
fn one_file_is_not_two() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let scene = "version = 1\n[[body]]\nshape = { circle = 0.1 }\n";
    std::fs::write(place("a.toml"), scene).unwrap();
    let refused = |args: &[&str], parts: &[&str]| {
        let common = ["simulate", "a.toml", "--seconds", "0.1"];
        carom_in(folder.path(), &[&common, args].concat()).refused(parts);
    };
    // The summary took the place of the table, and either that of the scene.
    refused(
        &["--out", "b.csv", "--json", "./b.csv"],
        &["--json ./b.csv is --out, too"],
    );
    refused(&["--out", "a.toml"], &["--out a.toml is the scene, too"]);
    refused(&["--json", "a.toml"], &["--json a.toml is the scene, too"]);
    carom_in(folder.path(), &["sweep", "a.toml", "--out", "./a.toml"])
        .refused(&["--out ./a.toml is the scene, too"]);
    // Also where folders on the way are still to be made.
    refused(
        &["--out", "new/er/b.csv", "--json", "new/../new/er/b.csv"],
        &["--json new/../new/er/b.csv is --out, too"],
    );
    refused(
        &["--out", "new/../a.toml"],
        &["--out new/../a.toml is the scene, too"],
    );
    assert_eq!(names(folder.path()), ["a.toml"]);
    assert_eq!(std::fs::read_to_string(place("a.toml")).unwrap(), scene);
}

#[cfg(unix)]
#[test]
fn a_summary_that_cannot_be_written_is_told_before_the_run() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().unwrap();
    // A name that is too long is refused whatever the rights; a folder without rights is not refused where root asks.
    let long = "j".repeat(255);
    let run = |json: &str| {
        let out = ["--out", "a.csv", "--json", json];
        // So much takes hours.
        let common = ["simulate", "flying-balls", "--seconds", "1e5"];
        carom_in(folder.path(), &[&common[..], &out].concat()).refused(&[json, "cannot"]);
    };
    run(&long);
    let closed = folder.path().join("closed");
    std::fs::create_dir(&closed).unwrap();
    std::fs::set_permissions(&closed, std::fs::Permissions::from_mode(0o555)).unwrap();
    if std::fs::write(closed.join("probe"), "").is_err() {
        run("closed/a.json");
    } else {
        std::fs::remove_file(closed.join("probe")).unwrap();
    }
    assert_eq!(names(folder.path()), ["closed"]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_and_the_file_it_leads_to_is_replaced() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    std::fs::create_dir(place("big")).unwrap();
    std::fs::write(place("big/old.csv"), "old").unwrap();
    for (link, to) in [
        ("old", "big/old.csv"),
        ("new", "big/new.csv"),
        ("twice", "old"),
    ] {
        symlink(to, place(link)).unwrap();
    }
    let run = |args: &[&str]| {
        carom_in(folder.path(), args).done();
    };
    let heading = |name: &str| {
        let text = std::fs::read_to_string(place(name)).unwrap();
        text.split(',').next().unwrap().to_owned()
    };
    let simulate = ["simulate", "thesis", "--seconds", "0.1", "--out"];
    run(&[&simulate[..], &["twice"]].concat());
    assert_eq!(heading("big/old.csv"), "time");
    run(&["sweep", "thesis", "--seconds", "0", "--out", "old"]);
    assert_eq!(heading("big/old.csv"), "run");
    run(&[&simulate[..], &["new", "--json", "old"]].concat());
    assert_eq!(heading("big/new.csv"), "time");
    assert!(heading("big/old.csv").starts_with('{'));
    for link in ["old", "new", "twice"] {
        let about = std::fs::symlink_metadata(place(link)).unwrap();
        assert!(about.is_symlink(), "{link} was replaced");
    }
    assert_eq!(names(&place("big")), ["new.csv", "old.csv"]);
    // A link that leads to itself.
    symlink("loop", place("loop")).unwrap();
    carom_in(folder.path(), &[&simulate[..], &["loop"]].concat()).refused(&["loop", "no end"]);
}
