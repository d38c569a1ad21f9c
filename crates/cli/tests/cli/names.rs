//! Odd names: what the system takes, we take.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::{Command, Output};

use crate::names;

fn render(folder: &Path, out: &OsStr) -> Output {
    Command::new(crate::CAROM)
        .args([
            "render",
            "stack",
            "--seconds",
            "0.05",
            "--size",
            "40x30",
            "--out",
        ])
        .arg(out)
        .current_dir(folder)
        .output()
        .expect("the binary was built")
}

#[test]
fn folders_of_any_name_are_written_to() {
    let folder = tempfile::tempdir().unwrap();
    let mut tried: Vec<OsString> = ["with a space", "-dash", "ünï", "."]
        .map(OsString::from)
        .to_vec();
    if cfg!(unix) {
        tried.push("line\nbreak".into());
    }
    // Not every file system takes what is no UTF-8.
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        let odd = OsStr::from_bytes(b"\xFF\xFEodd");
        if std::fs::create_dir(folder.path().join(odd)).is_ok() {
            tried.push(odd.to_owned());
        }
    }
    for name in tried {
        // One that begins with a dash would be a flag.
        let out = Path::new(".").join(&name);
        let ran = render(folder.path(), out.as_os_str());
        assert_eq!(
            ran.status.code(),
            Some(0),
            "{name:?}: {}",
            String::from_utf8_lossy(&ran.stderr)
        );
        let there = folder.path().join(&name).join("frame_00000.png");
        assert!(there.is_file(), "{}", there.display());
    }
}

#[cfg(unix)]
#[test]
fn a_scene_name_that_is_no_text_is_refused_in_one_line() {
    use std::os::unix::ffi::OsStrExt;
    let ran = Command::new(crate::CAROM)
        .arg("render")
        .arg(OsStr::from_bytes(b"\xFFscene"))
        .output()
        .expect("the binary was built");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(2), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(
        said.starts_with("error: an argument is not UTF-8"),
        "{said}"
    );
}

#[test]
fn a_name_that_is_too_long_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["n".repeat(4000), "deep/".repeat(4000)] {
        let ran = render(folder.path(), OsStr::new(&name));
        let said = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(ran.status.code(), Some(2), "{said}");
        assert!(
            said.starts_with("error: ") && said.trim_end().lines().count() == 1,
            "{said}"
        );
        assert!(said.contains("too long"), "{said}");
    }
    assert!(names(folder.path()).is_empty(), "nothing was written");
}

/// What is written is whole before it gets its name: a device of that name was replaced by a file.
#[cfg(unix)]
#[test]
fn a_pipe_in_the_place_of_a_file_is_named_and_stays() {
    use std::os::unix::fs::FileTypeExt as _;
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.csv");
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    for command in [
        &["simulate", "bounce", "--seconds", "0", "--out"][..],
        &["simulate", "bounce", "--seconds", "0", "--json"],
        &["sweep", "bounce", "--seconds", "0", "--out"],
        &["merge", "a.csv", "--out"],
        &["render", "bounce", "--out"],
    ] {
        let ran = Command::new(crate::CAROM)
            .args(command)
            .arg("pipe.csv")
            .current_dir(folder.path())
            .output()
            .expect("the binary was built");
        let said = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(ran.status.code(), Some(2), "{command:?}: {said}");
        assert!(said.contains("pipe.csv"), "{command:?}: {said}");
        assert_eq!(names(folder.path()), ["pipe.csv"], "{command:?}");
        let about = std::fs::metadata(&pipe).unwrap();
        assert!(about.file_type().is_fifo(), "{command:?}");
    }
}
