//! A run that is killed at any moment, or finds the disk full, leaves nothing torn and goes on to equal bytes.

#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use carom_render::Picture;

use crate::{carom_in, names};

const SCENE: [&str; 8] = [
    "render",
    "thesis",
    "--seconds",
    "1",
    "--fps",
    "60",
    "--size",
    "160x120",
];

fn run(folder: &Path, more: &[&str]) {
    carom_in(folder, &[&SCENE, more].concat()).done();
}

/// Every name of a frame is that of a whole picture, and every film is whole.
fn nothing_torn(folder: &Path) {
    for name in names(folder) {
        if name.starts_with('.') || name == "manifest.txt" {
            continue;
        }
        let bytes = fs::read(folder.join(&name)).unwrap();
        if let Err(error) = Picture::from_png(&bytes) {
            panic!("{name}: {error}");
        }
    }
}

fn same(a: &Path, b: &Path) {
    assert_eq!(names(a), names(b));
    for name in names(a) {
        assert_eq!(
            fs::read(a.join(&name)).unwrap(),
            fs::read(b.join(&name)).unwrap(),
            "{name}"
        );
    }
}

/// Kills a run after so many microseconds; `false` if it was done before.
fn killed(folder: &Path, args: &[&str], micros: u64) -> bool {
    let mut child = Command::new(crate::CAROM)
        .args([&SCENE, args].concat())
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_micros(micros));
    child.kill().unwrap();
    !child.wait().unwrap().success()
}

#[test]
fn a_run_killed_again_and_again_ends_with_equal_bytes() {
    let root = tempfile::tempdir().unwrap();
    run(root.path(), &["--out", "whole"]);
    let out = root.path().join("out");
    // Moments without a pattern: multiples of the golden ratio in a second that shrinks to what a run takes.
    let (mut moment, mut within, mut kills) = (0_u64, 400_000_u64, 0);
    for _ in 0..40 {
        moment = (moment + 618_034) % 1_000_000;
        let resume: &[&str] = &["--out", "out", "--resume", "--threads", "3"];
        if killed(root.path(), resume, moment * within / 1_000_000) {
            kills += 1;
        } else {
            within = within * 3 / 4;
            fs::remove_dir_all(&out).unwrap();
        }
        if out.exists() {
            nothing_torn(&out);
        }
    }
    assert!(kills >= 10, "{kills} of 40 runs were killed");
    run(root.path(), &["--out", "out", "--resume"]);
    same(&out, &root.path().join("whole"));
}

#[test]
fn a_film_killed_on_the_way_is_no_film() {
    let root = tempfile::tempdir().unwrap();
    let whole = root.path().join("whole");
    for (k, format) in ["apng", "y4m", "apng", "y4m"].iter().enumerate() {
        let name = format!("{format}{k}");
        let args: [&str; 5] = ["--out", &name, "--format", format, "--resume"];
        let folder = root.path().join(&name);
        if !killed(root.path(), &args, 20_000 * (k as u64 + 1)) || !folder.exists() {
            continue;
        }
        run(
            root.path(),
            &["--out", "whole", "--format", format, "--force"],
        );
        // A fast machine may have written all of it, and be killed before it ends.
        let film = |name: &&String| !name.starts_with('.') && *name != "manifest.txt";
        for film in names(&folder).iter().filter(film) {
            let bytes = |folder: &Path| fs::read(folder.join(film)).unwrap();
            assert!(bytes(&folder) == bytes(&whole), "{film} is torn");
        }
        run(root.path(), &args);
        same(&folder, &whole);
    }
}

/// A real full disk, or what comes nearest to it: no file may grow over a few kilobytes.
#[test]
fn a_frame_that_finds_no_room_is_named_and_the_run_resumes() {
    let root = tempfile::tempdir().unwrap();
    run(root.path(), &["--out", "whole"]);
    let mut sizes: Vec<u64> = (0..60)
        .map(|k| {
            fs::metadata(root.path().join(format!("whole/frame_{k:05}.png")))
                .unwrap()
                .len()
        })
        .collect();
    sizes.sort_unstable();
    // Blocks of 512 bytes, so that some frames fit and some do not.
    let room = sizes[30] / 512;
    let output = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f \"$1\"; shift; exec \"$@\"",
            "sh",
        ])
        .arg(room.to_string())
        .arg(crate::CAROM)
        .args([&SCENE[..], &["--out", "out"]].concat())
        .current_dir(root.path())
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("cannot write out/frame_") && said.contains("too large"),
        "{said}"
    );
    let out = root.path().join("out");
    nothing_torn(&out);
    let left = names(&out);
    assert!(left.iter().all(|name| !name.starts_with('.')), "{left:?}");
    run(root.path(), &["--out", "out", "--resume"]);
    same(&out, &root.path().join("whole"));
}
