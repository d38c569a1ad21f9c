//! A folder of frames through kills, full disks and strangers' files.

use super::*;
use crate::disk::fault;

#[test]
fn only_listed_files_are_replaced() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("a/b");
    let first = OutputFolder::open(&path, Existing::Refuse, "run 1").unwrap();
    first.save("chart.png", b"one").unwrap();
    first.save("frame_00000.png", b"one").unwrap();
    drop(first);
    fs::write(path.join("notes.txt"), "mine").unwrap();

    let error = OutputFolder::open(&path, Existing::Refuse, "run 2").unwrap_err();
    assert!(matches!(error, RenderError::Occupied { .. }), "{error}");

    let second = OutputFolder::open(&path, Existing::Replace, "run 2").unwrap();
    assert!(!path.join("chart.png").exists() && !path.join("frame_00000.png").exists());
    assert_eq!(fs::read_to_string(path.join("notes.txt")).unwrap(), "mine");
    let error = second.save("notes.txt", b"ours").unwrap_err();
    assert!(matches!(error, RenderError::Foreign { .. }), "{error}");
    assert_eq!(fs::read_to_string(path.join("notes.txt")).unwrap(), "mine");
}

#[test]
fn a_run_that_wrote_nothing_is_no_obstacle() {
    let root = tempfile::tempdir().unwrap();
    drop(OutputFolder::open(root.path(), Existing::Refuse, "run 1").unwrap());
    let folder = OutputFolder::open(root.path(), Existing::Refuse, "run 2").unwrap();
    folder.save("a.png", b"a").unwrap();
    drop(folder);
    let _again = OutputFolder::open(root.path(), Existing::Replace, "run 3").unwrap();
    assert!(!root.path().join("a.png").exists());
}

#[test]
fn a_film_that_was_killed_on_the_way_is_no_obstacle() {
    let root = tempfile::tempdir().unwrap();
    let names = || {
        let mut names: Vec<_> = contents(root.path())
            .into_iter()
            .map(|file| file.0)
            .collect();
        names.sort();
        names
    };
    for existing in [Existing::Refuse, Existing::Replace, Existing::Resume] {
        let folder = OutputFolder::open(root.path(), Existing::Refuse, "run").unwrap();
        let place = folder.claim("film.png").unwrap();
        drop(folder);
        // What the claimed film and the manifest are until they are whole.
        for place in [&place, &root.path().join(MANIFEST)] {
            fs::write(temporary_name(place), "torn").unwrap();
        }
        // And hidden files of other programs.
        let theirs = temporary_name(&root.path().join("notes.txt"));
        fs::write(&theirs, "mine").unwrap();
        drop(OutputFolder::open(root.path(), existing, "run").unwrap());
        fs::remove_file(&theirs).unwrap();
        assert_eq!(names(), [MANIFEST], "{existing:?}");
    }
}

#[test]
fn what_was_edited_is_not_removed() {
    let root = tempfile::tempdir().unwrap();
    run(root.path(), Existing::Refuse).unwrap();
    let whole = contents(root.path());
    let edited = root.path().join(NAMES[2]);
    for text in ["drawn over", &NAMES[0].repeat(100)] {
        fs::write(&edited, text).unwrap();
        let error = OutputFolder::open(root.path(), Existing::Replace, "run").unwrap_err();
        assert!(matches!(error, RenderError::Edited { .. }), "{error}");
        assert!(error.to_string().contains(NAMES[2]), "{error}");
        assert_eq!(fs::read_to_string(&edited).unwrap(), text);
        assert_eq!(contents(root.path()).len(), whole.len(), "nothing is gone");
    }
    // Nothing is lost with an empty file, or with one that is not there.
    fs::write(&edited, "").unwrap();
    fs::remove_file(root.path().join(NAMES[1])).unwrap();
    run(root.path(), Existing::Replace).unwrap();
    assert_eq!(contents(root.path()), whole);
}

#[test]
fn a_manifest_of_someone_else_stays() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join(MANIFEST), "apples\npears\n").unwrap();
    for existing in [Existing::Refuse, Existing::Replace, Existing::Resume] {
        let error = OutputFolder::open(root.path(), existing, "run").unwrap_err();
        assert!(matches!(error, RenderError::Foreign { .. }), "{error}");
    }
    assert_eq!(
        fs::read_to_string(root.path().join(MANIFEST)).unwrap(),
        "apples\npears\n"
    );
}

#[test]
fn a_manifest_cannot_point_outside() {
    let root = tempfile::tempdir().unwrap();
    let victim = root.path().join("victim.txt");
    fs::write(&victim, "alive").unwrap();
    let path = root.path().join("out");
    fs::create_dir(&path).unwrap();
    let text = format!(
        "carom output 2\nrun\n../victim.txt\n{}\n..\n",
        victim.display()
    );
    fs::write(path.join(MANIFEST), text).unwrap();
    let folder = OutputFolder::open(&path, Existing::Replace, "run").unwrap();
    assert_eq!(fs::read_to_string(&victim).unwrap(), "alive");
    for name in ["../x.png", "", "a/b.png", "..", "a\nb", MANIFEST] {
        let error = folder.claim(name).unwrap_err();
        assert!(matches!(error, RenderError::Name { .. }), "{error}");
    }
}

#[test]
fn two_runs_do_not_share_a_folder() {
    let root = tempfile::tempdir().unwrap();
    let first = OutputFolder::open(root.path(), Existing::Refuse, "run").unwrap();
    first.save("a.png", b"a").unwrap();
    let error = OutputFolder::open(root.path(), Existing::Replace, "run").unwrap_err();
    assert!(matches!(error, RenderError::InUse { .. }), "{error}");
    assert!(root.path().join("a.png").exists());
    drop(first);
    assert!(OutputFolder::open(root.path(), Existing::Replace, "run").is_ok());
}

#[test]
fn a_file_in_the_place_of_the_folder_is_named() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("out");
    fs::write(&path, "").unwrap();
    let error = OutputFolder::open(&path, Existing::Replace, "run").unwrap_err();
    assert!(
        error.to_string().ends_with("out is a file, not a folder"),
        "{error}"
    );
    let error = OutputFolder::open(path.join("below"), Existing::Replace, "run").unwrap_err();
    assert!(
        error.to_string().starts_with("cannot make the folder"),
        "{error}"
    );
}

#[test]
fn a_read_only_folder_is_found_before_the_first_frame() {
    let root = tempfile::tempdir().unwrap();
    let mut path = root.path().join("out");
    fs::create_dir(&path).unwrap();
    let mut rights = fs::metadata(&path).unwrap().permissions();
    rights.set_readonly(true);
    fs::set_permissions(&path, rights).unwrap();
    if fs::write(path.join("probe"), "").is_ok() {
        // The superuser writes there, but not among the objects of the Linux kernel.
        path = "/sys".into();
    }
    let error = OutputFolder::open(&path, Existing::Replace, "run").unwrap_err();
    assert!(matches!(error, RenderError::Io { .. }), "{error}");
}

/// A run of three frames and a chart.
fn run(path: &Path, existing: Existing) -> Result<(), RenderError> {
    let folder = OutputFolder::open(path, existing, "run")?;
    for name in NAMES {
        if !folder.has(name) {
            folder.save(name, name.repeat(100).as_bytes())?;
        }
    }
    folder.close()
}

const NAMES: [&str; 4] = [
    "chart.svg",
    "frame_00000.png",
    "frame_00001.png",
    "frame_00002.png",
];

fn contents(path: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = fs::read_dir(path)
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| {
            let name = entry.file_name().into_string().unwrap();
            (name, fs::read(entry.path()).unwrap())
        })
        .collect();
    files.sort();
    files
}

#[test]
fn a_disk_that_fills_up_at_any_moment_harms_nothing_and_the_run_resumes_to_equal_bytes() {
    let root = tempfile::tempdir().unwrap();
    run(&root.path().join("whole"), Existing::Refuse).unwrap();
    let whole = contents(&root.path().join("whole"));
    for existing in [Existing::Refuse, Existing::Replace] {
        for changes in 0.. {
            let path = root.path().join(format!("{existing:?} {changes}"));
            if existing == Existing::Replace {
                run(&path, Existing::Refuse).unwrap();
                fs::write(path.join("notes.txt"), "mine").unwrap();
            }
            let (outcome, refused) = fault::after(changes, || run(&path, existing));
            assert_eq!(outcome.is_err(), refused, "{changes} changes");
            if let Err(error) = outcome {
                let said = error.to_string();
                assert!(said.contains("no storage space"), "{said}");
                assert!(said.contains(path.to_str().unwrap()), "{said}");
            }
            // Whatever has its final name is whole.
            let there = if path.exists() {
                contents(&path)
            } else {
                Vec::new()
            };
            for file in &there {
                let ours = file.0 == MANIFEST || file.0 == "notes.txt";
                assert!(
                    ours || whole.contains(file),
                    "{changes} changes: {}",
                    file.0
                );
            }
            run(&path, Existing::Resume).unwrap();
            let _mine = fs::remove_file(path.join("notes.txt"));
            assert_eq!(contents(&path), whole, "{changes} changes");
            if !refused {
                assert!(changes > 10, "{changes} changes were all there is");
                break;
            }
        }
    }
}

#[test]
fn a_frame_that_was_changed_or_cut_short_is_missing() {
    let root = tempfile::tempdir().unwrap();
    run(root.path(), Existing::Refuse).unwrap();
    fs::write(root.path().join(NAMES[1]), "something else").unwrap();
    let bytes = fs::read(root.path().join(NAMES[2])).unwrap();
    fs::write(root.path().join(NAMES[2]), &bytes[..700]).unwrap();
    let folder = OutputFolder::open(root.path(), Existing::Resume, "run").unwrap();
    assert_eq!(
        NAMES.map(|name| folder.has(name)),
        [true, false, false, true]
    );
}

#[test]
fn the_manifest_tells_nothing_of_the_order_of_work() {
    let root = tempfile::tempdir().unwrap();
    let text = |name: &str, order: &[usize]| {
        let path = root.path().join(name);
        let folder = OutputFolder::open(&path, Existing::Refuse, "run").unwrap();
        for &k in order {
            folder.save(NAMES[k], NAMES[k].as_bytes()).unwrap();
        }
        folder.close().unwrap();
        fs::read_to_string(path.join(MANIFEST)).unwrap()
    };
    assert_eq!(text("a", &[0, 1, 2, 3]), text("b", &[2, 3, 0, 1]));
}
