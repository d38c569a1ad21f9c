//! Pipes and devices in the place of files: refused in one line, at once, where reading them would wait or never end.

#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::Ran;

/// Runs a command that gets ten seconds; one that takes longer is killed, and has no exit code.
fn soon(folder: &Path, args: &[&str]) -> Ran {
    let mut child = Command::new(crate::CAROM)
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    for _ in 0..500 {
        if child.try_wait().unwrap().is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    // One that has ended is past killing.
    let _ended = child.kill();
    let output = child.wait_with_output().unwrap();
    Ran {
        code: output.status.code(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// Puts a pipe without a writer in the place of a file.
fn pipe(place: &Path) {
    if place.exists() {
        fs::remove_file(place).unwrap();
    }
    let made = Command::new("mkfifo").arg(place).status().unwrap();
    assert!(made.success());
}

const SMALL: [&str; 8] = [
    "render",
    "thesis",
    "--seconds",
    "0.2",
    "--fps",
    "20",
    "--size",
    "80x60",
];

#[test]
fn a_scene_or_a_face_that_is_a_pipe_is_refused() {
    let root = tempfile::tempdir().unwrap();
    pipe(&root.path().join("pipe"));
    symlink("/dev/zero", root.path().join("zero.png")).unwrap();
    soon(root.path(), &["render", "./pipe"]).refused(&["pipe", "not a file"]);
    for face in ["pipe", "zero.png"] {
        let text = format!(
            "version = 1\n[[body]]\nname = 'a'\nface = '{face}'\nshape = {{ circle = 1 }}\n"
        );
        fs::write(root.path().join("face.toml"), text).unwrap();
        let ran = soon(root.path(), &["render", "face.toml", "--out", "out"]);
        ran.refused(&["face.toml:4:8: body.face: ", face, "not a file"]);
    }
}

#[test]
fn vertices_of_a_pipe_or_a_device_are_refused() {
    let root = tempfile::tempdir().unwrap();
    pipe(&root.path().join("pipe"));
    for place in ["pipe", "/dev/urandom", "/dev/zero"] {
        soon(root.path(), &["inertia", "--file", place]).refused(&[place, "not a file"]);
    }
}

#[test]
fn a_frame_or_a_manifest_that_is_a_pipe_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let with = |more: &[&str]| soon(root.path(), &[&SMALL, more].concat());
    with(&["--out", "out"]).done();
    let frame = root.path().join("out/frame_00001.png");
    pipe(&frame);
    for flag in ["--resume", "--force"] {
        with(&["--out", "out", flag]).refused(&["out/frame_00001.png", "was not written by carom"]);
    }
    assert!(frame.exists());
    pipe(&root.path().join("out/manifest.txt"));
    for flag in ["--resume", "--force"] {
        with(&["--out", "out", flag]).refused(&["out/manifest.txt", "not a file"]);
    }
}

#[test]
fn slices_with_a_frame_that_never_ends_are_refused() {
    let root = tempfile::tempdir().unwrap();
    for (out, slice) in [("a", "1/2"), ("b", "2/2")] {
        soon(
            root.path(),
            &[&SMALL[..], &["--out", out, "--shard", slice]].concat(),
        )
        .done();
    }
    let frame = root.path().join("b/frame_00003.png");
    let merge = || soon(root.path(), &["merge", "a", "b", "--out", "joined"]);
    pipe(&frame);
    merge().refused(&["b/frame_00003.png", "not a file"]);
    fs::remove_file(&frame).unwrap();
    symlink("/dev/zero", &frame).unwrap();
    merge().refused(&["b/frame_00003.png", "not a file"]);
}
