//! Streams that take nothing more: a line that is lost is an error, one for the eye alone is none.

#![cfg(target_os = "linux")]

use std::fs::File;
use std::process::{Command, Stdio};

/// Runs a command with a full stdout or stderr; its exit code and what it says on the other.
fn without_room(args: &[&str], out: bool) -> (Option<i32>, String) {
    let full = || Stdio::from(File::options().write(true).open("/dev/full").unwrap());
    let mut command = Command::new(crate::CAROM);
    command.args(args).stdin(Stdio::null());
    let output = if out {
        command.stdout(full()).stderr(Stdio::piped())
    } else {
        command.stdout(Stdio::piped()).stderr(full())
    }
    .output()
    .unwrap();
    let said = if out { output.stderr } else { output.stdout };
    (output.status.code(), String::from_utf8(said).unwrap())
}

#[test]
fn a_table_that_finds_no_room_is_not_done() {
    for args in [
        &["list"][..],
        &["inertia", "0,0 2,0 2,1 0,1"],
        &["--help"],
        &["render", "--help"],
    ] {
        let (code, said) = without_room(args, true);
        assert_eq!(code, Some(2), "{args:?}: {said}");
        assert_eq!(said.lines().count(), 1, "{args:?}: {said}");
        assert!(
            said.starts_with("error: cannot write to stdout: "),
            "{said}"
        );
    }
}

#[test]
fn an_error_that_finds_no_room_on_stderr_keeps_its_exit_code() {
    for args in [
        &["render", "nonex"][..],
        &["inertia", "0,0"],
        &["rendre"],
        &["render", "thesis", "--fps", "0"],
    ] {
        assert_eq!(
            without_room(args, false),
            (Some(2), String::new()),
            "{args:?}"
        );
    }
    let (code, table) = without_room(&["simulate", "thesis", "--seconds", "0"], false);
    assert_eq!(code, Some(0));
    assert!(table.starts_with("time,body,"), "{table}");
}

/// A limit on the size of a file, and a full device, for a film of more than 100 kB.
#[test]
fn a_film_that_finds_no_room_names_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let film = "render thesis --size 160x120 --seconds 0.2 --format y4m";
    for (out, place) in [
        (format!("--out {}", folder.path().display()), "thesis.y4m: "),
        ("--out - > /dev/full".to_owned(), "stdout: "),
    ] {
        // The signal of the limit would end the program.
        let line = format!("trap '' XFSZ; ulimit -f 32; exec \"$0\" {film} {out}");
        let output = Command::new("sh")
            .args(["-c", &line, crate::CAROM])
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        let error = said.lines().find(|line| line.starts_with("error: "));
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(error.is_some_and(|line| line.contains(place)), "{said}");
    }
}
