//! Ctrl-C and termination: the frame in hand is finished, the summary printed, and the exit code says which it was.

use std::process::{Command, Stdio};

use crate::names;

#[test]
fn ctrl_c_finishes_the_frame_and_prints_the_summary() {
    stopped_by("-INT", 130);
}

/// `kill` and whoever shuts a machine down ask this way.
#[test]
fn termination_finishes_the_frame_and_prints_the_summary() {
    stopped_by("-TERM", 143);
}

#[track_caller]
fn stopped_by(signal: &str, code: i32) {
    let folder = tempfile::tempdir().unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_xtask"))
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
