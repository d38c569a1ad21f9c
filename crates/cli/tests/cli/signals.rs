//! Ctrl-C and termination: the frame in hand is finished, the summary printed, and the exit code says which it was.

use std::process::{Command, Stdio};

use crate::names;

#[test]
fn ctrl_c_finishes_the_frame_and_prints_the_summary() {
    stopped_by("-INT", 130);
}

/// `kill` and a shutdown of the machine send this signal.
#[test]
fn termination_finishes_the_frame_and_prints_the_summary() {
    stopped_by("-TERM", 143);
}

#[track_caller]
fn stopped_by(signal: &str, code: i32) {
    let folder = tempfile::tempdir().unwrap();
    let child = Command::new(crate::CAROM)
        .args([
            "render",
            "thesis",
            "--seconds",
            "1000",
            "--size",
            "80x60",
            "--out",
            "out",
        ])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let out = folder.path().join("out");
    let patience = std::time::Duration::from_millis(20);
    for _ in 0..1500 {
        if out.join("frame_00003.png").exists() {
            break;
        }
        std::thread::sleep(patience);
    }
    let stopped = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status()
        .unwrap();
    assert!(stopped.success());
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert!(
        said.contains("INTERRUPTED") && said.contains("state hash"),
        "{said}"
    );
    let frames = names(&out);
    assert!(
        frames.iter().all(|name| !name.starts_with('.')),
        "{frames:?}"
    );
}

/// A disc of 1 kg between a wall and one of 1e20 kg: some 1e10 impacts before the first frame is over.
const ENDLESS: &str = "version = 1\ngravity = [0, 0]\nsettings = { mode = 'exact' }\n\
    [[body]]\nname = 'wall'\nkind = 'fixed'\nshape = { rectangle = [1, 4] }\n\
    [[body]]\nname = 'light'\nposition = [1.2, 0]\nmass = 1.0\nshape = { circle = 0.5 }\n\
    material = { friction = 0, restitution = 1 }\n\
    [[body]]\nname = 'heavy'\nposition = [2.4, 0]\nvelocity = [-10, 0]\nmass = 1e20\nshape = { circle = 0.5 }\n\
    material = { friction = 0, restitution = 1 }\n";

#[test]
fn ctrl_c_ends_a_step_of_very_many_impacts() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pi.toml"), ENDLESS).unwrap();
    for args in [
        &[
            "render",
            "pi.toml",
            "--seconds",
            "1",
            "--fps",
            "30",
            "--size",
            "40x30",
            "--out",
            "out",
        ][..],
        &[
            "simulate",
            "pi.toml",
            "--seconds",
            "1",
            "--every",
            "0.04",
            "--out",
            "t.csv",
        ],
    ] {
        let mut child = Command::new(crate::CAROM)
            .args(args)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Long enough for the first frame or sample, and for the step after it to begin.
        let patience = std::time::Duration::from_millis(20);
        for _ in 0..100 {
            std::thread::sleep(patience);
        }
        let stopped = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status()
            .unwrap();
        assert!(stopped.success());
        // The work of a step is some seconds on a loaded machine.
        for _ in 0..3000 {
            if child.try_wait().unwrap().is_some() {
                break;
            }
            std::thread::sleep(patience);
        }
        let _ended = child.kill();
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(130), "{args:?}: {said}");
        assert!(said.contains("INTERRUPTED"), "{args:?}: {said}");
    }
}

#[test]
fn ctrl_c_that_ends_nothing_is_no_interruption() {
    let folder = tempfile::tempdir().unwrap();
    let child = Command::new(crate::CAROM)
        // A run of one step, which takes some tenths of a second.
        .args(["sweep", "flying-balls", "--set", "n=60", "--jobs", "1"])
        .args(["--seconds", "40", "--out", "a.csv"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let part = folder.path().join("a.csv.part");
    while !part.exists() && !folder.path().join("a.csv").exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    // The signal is listened for right after the table was made.
    std::thread::sleep(std::time::Duration::from_millis(20));
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success(), "the run was over too soon");
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    // The step went to its end, so its row is there, and no run is left to go on with.
    let whole = folder.path().join("a.csv").exists();
    let code = if whole { 0 } else { 130 };
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert_eq!(said.contains("--resume goes on"), !whole, "{said}");
}
