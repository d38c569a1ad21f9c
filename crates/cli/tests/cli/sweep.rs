//! `sweep`: all combinations, the same bytes however they are cut, and a table that an interrupted run goes on with.

use std::fs;
use std::path::Path;

use crate::{carom_in, names};

const THROW: &str = "version = 1\nduration = 0.5\ngravity = [0, -10]\n\
    [[body]]\nname = 'ball'\nshape = { circle = 0.1 }\nvelocity = [1, 5]\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("throw.toml"), THROW).unwrap();
    folder
}

/// A sweep of 24 runs with these further arguments.
fn sweep(folder: &Path, more: &[&str]) -> crate::ran::Ran {
    let common = [
        "sweep",
        "throw.toml",
        "--set",
        "body.ball.mass=1:4:4",
        "--set",
        "gravity=[0,-10],[0,0]",
        "--seeds",
        "3",
        "--report",
        "body.ball.y,energy,exact",
    ];
    carom_in(folder, &[&common[..], more].concat())
}

#[test]
fn a_row_has_what_was_set_and_what_came_of_it() {
    let folder = folder();
    let ran = sweep(folder.path(), &[]).done();
    let rows: Vec<&str> = ran.out.lines().collect();
    assert_eq!(rows.len(), 25);
    assert_eq!(
        rows[0],
        "run,runs,body.ball.mass,gravity,seed,body.ball.y,energy,exact"
    );
    // 5 · 0.5 − 10 · 0.5²/2 m, and ½ m v² with v² = 26 of the throw.
    assert_eq!(rows[1], "0,24,1,\"[0,-10]\",0,1.25,13,true");
    assert_eq!(rows[5], "4,24,1,\"[0,0]\",1,2.5,13,true");
    assert!(rows[24].starts_with("23,24,4,\"[0,0]\",2,2.5,52,"));
}

#[test]
fn jobs_shards_and_interruptions_change_no_byte() {
    let folder = folder();
    let place = |name: &str| folder.path().join(name);
    sweep(folder.path(), &["--out", "one.csv", "--jobs", "1"]).done();
    let whole = fs::read(place("one.csv")).unwrap();
    sweep(folder.path(), &["--out", "many.csv", "--jobs", "5"]).done();
    assert_eq!(fs::read(place("many.csv")).unwrap(), whole);
    for slice in ["1/3", "2/3", "3/3"] {
        let name = format!("slice{}.csv", &slice[..1]);
        sweep(folder.path(), &["--out", &name, "--shard", slice]).done();
    }
    let merge = ["merge", "slice3.csv", "slice1.csv", "slice2.csv", "--out"];
    carom_in(folder.path(), &[&merge[..], &["all.csv"]].concat()).done();
    assert_eq!(fs::read(place("all.csv")).unwrap(), whole);
    // A kill leaves whole rows and perhaps a part of one.
    for kept in [100, 333, whole.len()] {
        fs::write(place("cut.csv.part"), &whole[..kept]).unwrap();
        sweep(folder.path(), &["--out", "cut.csv"]).refused(&["cut.csv.part", "--resume"]);
        sweep(folder.path(), &["--out", "cut.csv", "--resume"]).done();
        assert_eq!(fs::read(place("cut.csv")).unwrap(), whole);
    }
    let left = ["all.csv", "cut.csv", "many.csv", "one.csv"];
    let slices = ["slice1.csv", "slice2.csv", "slice3.csv", "throw.toml"];
    assert_eq!(names(folder.path()), [left, slices].concat());
}

#[test]
fn what_is_wrong_gets_one_line() {
    let folder = folder();
    let refused = |args: &[&str], parts: &[&str]| {
        carom_in(folder.path(), &[&["sweep", "throw.toml"], args].concat()).refused(parts);
    };
    refused(&["--report", "energie"], &["energie", "body.NAME."]);
    refused(&["--report", "body.bal.x"], &["bal"]);
    refused(&["--set", "body.ball.mass=0:1:3"], &["body.ball.mass=0"]);
    refused(&["--set", "n=1:2:x"], &["\"x\""]);
    refused(&["--set", "a=1:2:900000", "--seeds", "900000"], &["runs"]);
    refused(
        &["--seeds", "2", "--shard", "3/3", "--seconds", "-1"],
        &["below 0"],
    );
    let twice = ["--set", "body.ball.mass=1,2", "--set", "body.ball.mass=3"];
    refused(&twice, &["--set body.ball.mass is given twice"]);
    refused(&["--set", "seed=1,2", "--seeds", "2"], &["seed", "--seeds"]);
    refused(
        &["--report", "energy,exact,energy"],
        &["--report energy is given twice"],
    );
    refused(&["--set", "n=-1e308:1e308:3"], &["-1e308:1e308:3", "wider"]);
    fs::write(folder.path().join("other.csv"), "a,b\n1,2\n").unwrap();
    let merge = ["merge", "other.csv", "--out", "x.csv"];
    carom_in(folder.path(), &merge).refused(&["other.csv", "no table"]);
    // What has no end, or waits for ever, is not opened.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero.csv")).unwrap();
        let merge = ["merge", "zero.csv", "--out", "x.csv"];
        carom_in(folder.path(), &merge).refused(&["zero.csv"]);
        fs::remove_file(folder.path().join("zero.csv")).unwrap();
    }
    assert_eq!(names(folder.path()), ["other.csv", "throw.toml"]);
}

#[test]
fn later_values_are_checked_before_the_first_run() {
    let folder = folder();
    for (set, wrong) in [
        ("body.ball.mass=1,2,-1", "body.ball.mass=-1"),
        ("gravity=[0,-10],down", "gravity=down"),
        ("body.ball.kind=dynamic,fixd", "body.ball.kind=fixd"),
    ] {
        for more in [
            &[][..],
            &["--out", "a.csv"],
            &["--seeds", "9", "--shard", "3/3"],
        ] {
            // Combined with another one, so that it is the value of no first run.
            let args = [
                &["sweep", "throw.toml", "--set", set, "--set", "fps=30,60"][..],
                more,
            ];
            carom_in(folder.path(), &args.concat()).refused(&[wrong]);
        }
    }
    // A body that only some of the runs have.
    let args = [
        "sweep",
        "throw.toml",
        "--set",
        "body.ball.name=ball,disc",
        "--report",
        "body.ball.x",
    ];
    carom_in(folder.path(), &args).refused(&["body.ball.x", "no body"]);
    assert_eq!(names(folder.path()), ["throw.toml"]);
    // Another slice has it.
    let args = [
        "sweep",
        "throw.toml",
        "--set",
        "body.ball.mass=1,-1",
        "--shard",
        "1/2",
    ];
    carom_in(folder.path(), &args).done();
}

#[test]
fn a_table_to_a_dash_goes_to_stdout() {
    let folder = folder();
    let table = sweep(folder.path(), &[]).done().out;
    assert_eq!(sweep(folder.path(), &["--out", "-"]).done().out, table);
    for flag in ["--resume", "--force"] {
        sweep(folder.path(), &["--out", "-", flag]).refused(&["--out -", "--resume"]);
    }
    assert_eq!(names(folder.path()), ["throw.toml"]);
}

/// Sweeps for minutes, lets `change` act on the table once it has a row, and expects the sweep to end.
#[cfg(unix)]
#[track_caller]
fn changed_under_a_sweep(change: impl FnOnce(&Path)) {
    use std::process::{Command, Stdio};
    let folder = folder();
    let part = folder.path().join("a.csv.part");
    let child = Command::new(crate::CAROM)
        .args(["sweep", "throw.toml", "--seeds", "900000", "--jobs", "1"])
        .args(["--out", "a.csv"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    while fs::metadata(&part).map_or(0, |about| about.len()) < 100 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    change(&part);
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    let error = said.lines().find(|line| line.starts_with("error: "));
    let named = error.is_some_and(|line| line.contains("a.csv.part was removed or changed"));
    assert!(named, "{said}");
    assert!(!folder.path().join("a.csv").exists());
}

#[cfg(unix)]
#[test]
fn a_table_that_something_else_removes_or_changes_ends_its_sweep() {
    changed_under_a_sweep(|part| fs::remove_file(part).unwrap());
    changed_under_a_sweep(|part| fs::write(part, "").unwrap());
    changed_under_a_sweep(|part| {
        fs::remove_file(part).unwrap();
        fs::create_dir(part).unwrap();
    });
    changed_under_a_sweep(|part| {
        let other = part.with_file_name("other");
        fs::write(&other, "mine").unwrap();
        fs::rename(other, part).unwrap();
    });
}

#[cfg(unix)]
#[test]
fn what_is_no_file_in_the_place_of_a_table_is_refused_at_once() {
    use std::process::Command;
    let folder = folder();
    let part = folder.path().join("a.csv.part");
    for (make, kind) in [("mkfifo", "a pipe"), ("mkdir", "a directory")] {
        let made = Command::new(make).arg(&part).status().unwrap();
        assert!(made.success());
        for flag in ["--resume", "--force"] {
            sweep(folder.path(), &["--out", "a.csv", flag]).refused(&["a.csv.part", kind]);
        }
        let removed = Command::new("rm").arg("-r").arg(&part).status().unwrap();
        assert!(removed.success());
    }
}

#[test]
fn rows_of_another_sweep_are_not_gone_on_with() {
    let folder = folder();
    let place = |name: &str| folder.path().join(name);
    sweep(folder.path(), &["--out", "one.csv"]).done();
    let whole = fs::read_to_string(place("one.csv")).unwrap();
    let ten: String = whole.split_inclusive('\n').take(10).collect();
    let refused = |part: &str, more: &[&str]| {
        fs::write(place("cut.csv.part"), part).unwrap();
        let args = [&["--out", "cut.csv", "--resume"][..], more].concat();
        sweep(folder.path(), &args).refused(&["cut.csv.part", "another sweep", "--force"]);
        assert_eq!(fs::read_to_string(place("cut.csv.part")).unwrap(), part);
    };
    // Other values, another number of them, other rows, more of them.
    refused(&ten.replace("\n8,24,2,", "\n8,24,3,"), &[]);
    refused(&ten, &["--set", "body.ball.spin=1,2"]);
    refused(&ten, &["--shard", "2/2"]);
    refused(&ten.replace("\n4,", "\n40,"), &[]);
    refused(&(whole.clone() + "24,24,"), &["--shard", "1/2"]);
    // What is in no row.
    refused(&ten, &["--seconds", "0.25"]);
    fs::write(place("throw.toml"), THROW.replace("[1, 5]", "[1, 6]")).unwrap();
    refused(&ten, &[]);
    fs::write(place("throw.toml"), THROW).unwrap();
    sweep(folder.path(), &["--out", "cut.csv", "--resume"]).done();
    assert_eq!(fs::read_to_string(place("cut.csv")).unwrap(), whole);
}

#[test]
fn a_table_in_use_is_refused_to_a_second_sweep() {
    let folder = folder();
    let part = folder.path().join("a.csv.part");
    let heading = "run,runs,body.ball.mass,gravity,seed,body.ball.y,energy,exact\n";
    fs::write(&part, heading).unwrap();
    let held = fs::File::open(&part).unwrap();
    held.try_lock().unwrap();
    for flag in ["--resume", "--force"] {
        sweep(folder.path(), &["--out", "a.csv", flag]).refused(&["a.csv.part", "in use"]);
        assert_eq!(fs::read_to_string(&part).unwrap(), heading);
    }
    // Not dropped: a process that another test just started may still share the lock.
    held.unlock().unwrap();
    for flag in ["--resume", "--force"] {
        sweep(folder.path(), &["--out", "a.csv", flag]).done();
        fs::rename(folder.path().join("a.csv"), &part).unwrap();
    }
}

#[test]
fn a_table_is_not_joined_into_a_slice() {
    let folder = folder();
    for (name, slice) in [("a.csv", "1/2"), ("b.csv", "2/2")] {
        sweep(folder.path(), &["--out", name, "--shard", slice]).done();
    }
    let slice = fs::read(folder.path().join("a.csv")).unwrap();
    for out in ["a.csv", "./b.csv"] {
        let merge = ["merge", "a.csv", "b.csv", "--out", out];
        carom_in(folder.path(), &merge).refused(&[out, "one of the slices"]);
    }
    assert_eq!(fs::read(folder.path().join("a.csv")).unwrap(), slice);
}
