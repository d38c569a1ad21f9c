//! Help, unknown words and wrong values of flags.

use std::io::Read;
use std::process::{Command, Stdio};

use crate::{carom, carom_in, names};

#[test]
fn help_names_every_command_and_the_program_that_was_called() {
    let ran = carom(&["--help"]).done();
    for command in [
        "render", "merge", "simulate", "sweep", "inertia", "list", "check",
    ] {
        assert!(
            ran.out.contains(&format!("\n  {command} ")),
            "{command}:\n{}",
            ran.out
        );
        let help = carom(&[command, "--help"]).done().out;
        assert!(help.contains(&format!("Usage: carom {command}")), "{help}");
        assert!(!help.contains("xtask") && !help.contains('{'), "{help}");
    }
    assert!(!ran.out.contains("xtask"), "{}", ran.out);
}

#[test]
fn the_version_says_the_features_too() {
    let ran = carom(&["--version"]).done();
    let features = if cfg!(feature = "parallel") {
        "parallel"
    } else {
        "none"
    };
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(ran.out, format!("carom {version} (features: {features})\n"));
}

#[test]
fn wrong_usage_ends_with_2_and_a_hint() {
    for args in [
        &[][..],
        &["rendre", "thesis"],
        &["render"],
        &["render", "thesis", "--colour"],
        &["simulate", "thesis"],
    ] {
        let ran = carom(args);
        assert_eq!(ran.code, Some(2), "{args:?}");
        assert!(ran.err.contains("Usage:"), "{args:?}: {}", ran.err);
        assert_eq!(ran.out, "", "{args:?}");
    }
    assert!(
        carom(&["rendre"]).err.contains("'render'"),
        "the nearest command is named"
    );
}

#[test]
fn wrong_values_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for (flags, parts) in [
        (&["--fps", "0"][..], &["--fps", "frame rate is 0"][..]),
        (&["--fps", "-5"], &["--fps", "-5"]),
        (&["--fps", "1000000000"], &["--fps", "1000000000"]),
        (&["--seconds", "nan"], &["--seconds", "finite"]),
        (&["--seconds", "-1"], &["--seconds", "below 0"]),
        (&["--seconds", "inf"], &["--seconds", "finite"]),
        (&["--seconds", "1e8"], &["frames", "1e6"]),
        (&["--size", "0x600"], &["--size", "0 x 600"]),
        (&["--size", "100000x100000"], &["--size", "limit"]),
        (&["--size", "large"], &["--size", "WxH"]),
        (&["--shard", "0/4"], &["--shard", "0 of 4"]),
        (&["--shard", "5/4"], &["--shard", "5 of 4"]),
        (&["--shard", "1/0"], &["--shard"]),
        (&["--set", "n"], &["--set", "KEY=VALUE"]),
        (&["--threads", "0"], &["--threads", "0"]),
        (&["--mode", "fast"], &["--mode", "fast"]),
        (&["--format", "gif"], &["--format", "gif"]),
    ] {
        let args = [&["render", "thesis", "--out", "frames"], flags].concat();
        carom_in(folder.path(), &args).refused(parts);
    }
    carom_in(
        folder.path(),
        &[
            "simulate",
            "thesis",
            "--seconds",
            "1",
            "--every",
            "0",
            "--out",
            "t.csv",
        ],
    )
    .refused(&["--every", "0"]);
    carom_in(
        folder.path(),
        &["simulate", "thesis", "--seconds", "1e9", "--every", "1e-9"],
    )
    .refused(&["samples"]);
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_key_that_is_set_twice_is_refused() {
    for args in [
        &["simulate", "thesis", "--seconds", "0"][..],
        &["render", "thesis", "--seconds", "0"],
        &["check", "thesis"],
    ] {
        let set = ["--set", "seed=1", "--set", "fps=9", "--set", " seed =2"];
        carom(&[args, &set].concat()).refused(&["--set seed is given twice"]);
    }
}

#[test]
fn every_exit_code_of_a_signal_is_in_the_help() {
    let ran = carom(&["--help"]).done();
    for code in ["129", "130", "143"] {
        assert!(ran.out.contains(code), "{code}: {}", ran.out);
    }
}

#[test]
fn a_dash_is_stdout_or_refused_and_never_the_name_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| carom_in(folder.path(), args);
    let simulate = ["simulate", "thesis", "--seconds", "0"];
    let table = run(&simulate).done().out;
    let ran = run(&[&simulate[..], &["--out", "-"]].concat()).done();
    assert_eq!(ran.out, table);
    assert!(ran.err.contains("state hash"), "{}", ran.err);
    run(&[&simulate[..], &["--json", "-"]].concat()).refused(&["cannot write -", "./-"]);
    run(&["sweep", "thesis", "--seconds", "0", "--out", "a.csv"]).done();
    run(&["merge", "a.csv", "--out", "-"]).refused(&["--out -", "./-"]);
    run(&["merge", "frames", "--out", "-"]).refused(&["--out -", "./-"]);
    run(&[&simulate[..], &["--out", "./-"]].concat()).done();
    assert_eq!(names(folder.path()), ["-", "a.csv"]);
}

#[test]
fn a_reader_that_leaves_is_no_crash() {
    let mut child = Command::new(crate::CAROM)
        .args(["simulate", "thesis", "--seconds", "20"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 10];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    assert_eq!(&first, b"time,body,");
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(!said.contains("panicked"), "{said}");
}
