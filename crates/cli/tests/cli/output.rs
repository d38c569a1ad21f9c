//! What `render` writes, and what it refuses to touch.

use std::fs;
use std::path::Path;

use crate::{Ran, carom_in, names};

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

fn render(folder: &Path, more: &[&str]) -> Ran {
    carom_in(folder, &[&SMALL, more].concat())
}

#[test]
fn frames_do_not_depend_on_threads_or_slices() {
    let folder = tempfile::tempdir().unwrap();
    let ran = render(folder.path(), &["--out", "one/deep", "--threads", "1"]).done();
    assert!(
        ran.out
            .starts_with("4 frames of 80 x 60 px (0.0576 MB unpacked) at 20 per second"),
        "{}",
        ran.out
    );
    render(folder.path(), &["--out", "many", "--threads", "5"]).done();
    render(folder.path(), &["--out", "slice", "--shard", "2/2"]).done();
    let frame = |place: &str, index: u32| {
        fs::read(folder.path().join(format!("{place}/frame_{index:05}.png"))).unwrap()
    };
    for index in 0..4 {
        assert_eq!(
            frame("one/deep", index),
            frame("many", index),
            "frame {index}"
        );
    }
    assert_eq!(frame("one/deep", 3), frame("slice", 3));
    let list =
        |place: &str| fs::read_to_string(folder.path().join(place).join("manifest.txt")).unwrap();
    assert_eq!(list("one/deep"), list("many"));
    let pngs = |place: &str| {
        names(&folder.path().join(place))
            .into_iter()
            .filter(|name| name.ends_with(".png"))
            .count()
    };
    assert_eq!((pngs("many"), pngs("slice")), (4, 2));
}

#[test]
fn frames_that_something_else_removes_while_others_are_drawn_are_missed() {
    let folder = tempfile::tempdir().unwrap();
    let args = "render thesis --seconds 100 --fps 60 --size 160x120 --threads 1 --out out";
    let child = std::process::Command::new(crate::CAROM)
        .args(args.split(' '))
        .current_dir(folder.path())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let place = |index: u32| folder.path().join(format!("out/frame_{index:05}.png"));
    while !place(4).exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    fs::remove_file(place(3)).unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("frame_00003.png") && said.contains("--resume"),
        "{said}"
    );
    let again = carom_in(
        folder.path(),
        &[&args.split(' ').collect::<Vec<_>>()[..], &["--resume"]].concat(),
    );
    assert!(again.done().out.contains("1 drawn, 5999 kept"));
}

#[test]
fn frames_that_are_there_are_kept_resumed_or_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    render(folder.path(), &["--out", "out"]).done();
    let second = out.join("frame_00002.png");
    let bytes = fs::read(&second).unwrap();
    fs::write(out.join("notes.txt"), "mine").unwrap();

    render(folder.path(), &["--out", "out"]).refused(&["out", "already holds"]);
    fs::remove_file(&second).unwrap();
    let ran = render(folder.path(), &["--out", "out", "--resume"]).done();
    assert!(ran.out.contains("1 drawn, 3 kept"), "{}", ran.out);
    assert_eq!(fs::read(&second).unwrap(), bytes);

    let other = ["--out", "out", "--resume", "--set", "gravity=[0, -1]"];
    render(folder.path(), &other).refused(&["out", "cannot be resumed"]);
    let ran = render(folder.path(), &["--out", "out", "--force"]).done();
    assert!(ran.out.contains("4 drawn"), "{}", ran.out);
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
}

#[test]
fn what_is_not_ours_is_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "mine").unwrap();
    render(folder.path(), &["--out", "file"]).refused(&["file", "not a folder"]);
    render(folder.path(), &["--out", "file/below"]).refused(&["file/below"]);
    assert_eq!(
        fs::read_to_string(folder.path().join("file")).unwrap(),
        "mine"
    );

    fs::create_dir(folder.path().join("photos")).unwrap();
    let photo = folder.path().join("photos/frame_00001.png");
    fs::write(&photo, "a photograph").unwrap();
    for flags in [&[][..], &["--force"], &["--resume"]] {
        render(folder.path(), &[&["--out", "photos"], flags].concat())
            .refused(&["frame_00001.png"]);
    }
    assert_eq!(fs::read_to_string(&photo).unwrap(), "a photograph");
}

#[cfg(unix)]
#[test]
fn a_read_only_folder_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let mut locked = folder.path().join("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(locked.join("probe"), "").is_ok() {
        // The superuser writes there, but not among the objects of the Linux kernel.
        locked = "/sys".into();
    }
    let out = locked.to_str().unwrap();
    render(folder.path(), &["--out", out]).refused(&[out, "ermission denied"]);
    let below = format!("{out}/below");
    // Denied, or not permitted.
    render(folder.path(), &["--out", &below]).refused(&[&below, "ermi"]);
}

#[test]
fn films_are_one_file() {
    let folder = tempfile::tempdir().unwrap();
    render(folder.path(), &["--out", "a", "--format", "apng"]).done();
    render(folder.path(), &["--out", "b", "--format", "y4m"]).done();
    let film = fs::read(folder.path().join("a/thesis.png")).unwrap();
    assert!(film.windows(4).any(|four| four == b"acTL"));
    for (format, name) in [
        ("apng", "thesis.png"),
        ("y4m", "thesis.y4m"),
        ("sheet", "thesis.png"),
    ] {
        let made = |out: &str, threads: &str| {
            let flags = [
                "--force",
                "--out",
                out,
                "--format",
                format,
                "--threads",
                threads,
            ];
            render(folder.path(), &flags).done();
            fs::read(folder.path().join(out).join(name)).unwrap()
        };
        assert!(
            made("one", "1") == made("many", "5"),
            "{format} depends on the threads"
        );
    }
    let film = fs::read(folder.path().join("b/thesis.y4m")).unwrap();
    assert!(film.starts_with(b"YUV4MPEG2 W80 H60 F20:1"));
    assert_eq!(
        names(&folder.path().join("b")),
        ["manifest.txt", "thesis.y4m"]
    );
    render(folder.path(), &["--out", "c", "--format", "sheet"]).done();
    assert!(folder.path().join("c/thesis.png").is_file());
    render(folder.path(), &["--out", "d", "--format", "svg"]).done();
    let drawing = fs::read_to_string(folder.path().join("d/frame_00003.svg")).unwrap();
    assert!(drawing.starts_with("<svg") && drawing.trim_end().ends_with("</svg>"));
}

#[test]
fn a_small_frame_is_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    render(folder.path(), &["--out", "a"]).done();
    render(folder.path(), &["--out", "b", "--packing", "small"]).done();
    for index in 0..4 {
        let read = |place: &str| {
            fs::read(folder.path().join(format!("{place}/frame_{index:05}.png"))).unwrap()
        };
        let (fast, small) = (read("a"), read("b"));
        assert!(small.len() < fast.len(), "frame {index}");
        let picture = |bytes: &[u8]| carom_render::Picture::from_png(bytes).unwrap();
        assert_eq!(picture(&small), picture(&fast), "frame {index}");
    }
}

#[test]
fn a_film_goes_down_a_pipe_and_nothing_else_does() {
    let folder = tempfile::tempdir().unwrap();
    let args = [&SMALL[..], &["--format", "y4m", "--out"]].concat();
    let output = std::process::Command::new(crate::CAROM)
        .args([&args[..], &["-"]].concat())
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success());
    carom_in(folder.path(), &[&args[..], &["a"]].concat()).done();
    assert_eq!(
        output.stdout,
        fs::read(folder.path().join("a/thesis.y4m")).unwrap()
    );
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("state hash")
    );
    assert_eq!(names(folder.path()), ["a"]);

    render(folder.path(), &["--out", "-"]).refused(&["--out -", "y4m"]);
    carom_in(folder.path(), &[&args[..], &["-", "--resume"]].concat()).refused(&["--resume"]);
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_ends_the_film_without_an_error() {
    use std::io::Read;
    use std::process::{Command, Stdio};
    let mut child = Command::new(crate::CAROM)
        .args([
            "render",
            "thesis",
            "--seconds",
            "100",
            "--format",
            "y4m",
            "--out",
            "-",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut head = [0; 10];
    child.stdout.take().unwrap().read_exact(&mut head).unwrap();
    assert_eq!(&head, b"YUV4MPEG2 ");
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("the reader went away") && !said.contains("error"),
        "{said}"
    );
}

/// Every kind of file that holds a picture, read by another program.
#[test]
fn pngcheck_finds_no_fault_in_what_is_written() {
    use std::process::Command;
    let folder = tempfile::tempdir().unwrap();
    for (out, format, packing) in [
        ("a", "png", "fast"),
        ("b", "png", "small"),
        ("c", "apng", "fast"),
        ("d", "apng", "small"),
        ("e", "sheet", "small"),
    ] {
        let flags = ["--out", out, "--format", format, "--packing", packing];
        render(folder.path(), &flags).done();
    }
    let mut pictures = Vec::new();
    for place in ["a", "b", "c", "d", "e"] {
        for name in names(&folder.path().join(place)) {
            if name.ends_with(".png") {
                let path = folder.path().join(place).join(name);
                carom_render::Picture::from_png(&fs::read(&path).unwrap()).unwrap();
                pictures.push(path);
            }
        }
    }
    assert!(pictures.len() > 10, "{} pictures", pictures.len());
    match Command::new("pngcheck").arg("-q").args(&pictures).output() {
        Ok(read) => {
            let said = String::from_utf8_lossy(&read.stdout);
            assert!(read.status.success() && said.is_empty(), "{said}");
        }
        Err(_) => println!("skipped: no pngcheck here to read the pictures a second time"),
    }
}

#[test]
fn overlays_and_styles_change_the_picture_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let last = |out: &str, more: &[&str]| {
        let ran = render(folder.path(), &[&["--out", out], more].concat()).done();
        let hash = ran.out.lines().find(|line| line.starts_with("state hash"));
        let bytes = fs::read(folder.path().join(out).join("frame_00003.png")).unwrap();
        (bytes, hash.unwrap().to_owned())
    };
    let (plain, hash) = last("plain", &["--overlay", "none"]);
    for (k, name) in [
        "velocities",
        "centroids",
        "boxes",
        "trails",
        "field-lines",
        "restitution",
        "gravity",
        "time",
        "counters",
        "groups",
        "all",
    ]
    .iter()
    .enumerate()
    {
        let (picture, found) = last(&format!("o{k}"), &["--overlay", &format!("none,{name}")]);
        assert_ne!(picture, plain, "{name}");
        assert_eq!(found, hash, "{name}");
    }
    for (k, style) in ["dark", "print"].iter().enumerate() {
        let (picture, _) = last(&format!("s{k}"), &["--overlay", "none", "--style", style]);
        assert_ne!(picture, plain, "{style}");
    }
    let other = ["--out", "plain", "--resume", "--overlay", "time"];
    render(folder.path(), &other).refused(&["plain", "cannot be resumed"]);
    let ran = render(folder.path(), &["--overlay", "velocity"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("velocities"), "{}", ran.err);
}

#[test]
fn a_second_run_into_one_folder_is_refused_while_the_first_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let about = "anything";
    let held = carom_render::OutputFolder::open(
        folder.path().join("out"),
        carom_render::Existing::Refuse,
        about,
    );
    render(folder.path(), &["--out", "out"]).refused(&["out", "in use"]);
    drop(held);
    render(folder.path(), &["--out", "out"]).done();
}
