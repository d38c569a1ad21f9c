//! An output folder and the manifest that says which files in it are ours.
//!
//! A name is written into the manifest before its file appears, so whatever stands under a final name is listed, even
//! after a crash. Only listed files are ever replaced or removed.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::RenderError;
use crate::output::{temporary_name, write_file};

/// Name of the manifest inside an output folder.
pub const MANIFEST: &str = "manifest.txt";

/// First line of a manifest; the run's own description follows in the second.
const HEADING: &str = "carom output 1";

/// What to do with the outputs that a folder holds already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// Refuse the folder.
    #[default]
    Refuse,
    /// Remove what the manifest lists, and start anew. Files of others are never touched.
    Replace,
    /// Keep what the manifest lists and go on, if it was the same run.
    Resume,
}

/// A folder for outputs, locked against other runs while this value lives.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    state: Mutex<Manifest>,
}

#[derive(Debug)]
struct Manifest {
    file: File,
    names: BTreeSet<String>,
}

impl OutputFolder {
    /// Opens `path`, made if it is missing, for the run that `about` describes in one line (scene, size, rate).
    ///
    /// Everything that can be wrong with the folder is found here, before the first picture is drawn.
    ///
    /// # Errors
    /// [`RenderError::NotAFolder`], [`RenderError::Occupied`] (with [`Existing::Refuse`]), [`RenderError::Foreign`] (a
    /// manifest or a numbered frame that is not ours), [`RenderError::OtherRun`] (with [`Existing::Resume`]),
    /// [`RenderError::InUse`], [`RenderError::Io`] (read-only, no room).
    pub fn open(
        path: impl AsRef<Path>,
        existing: Existing,
        about: &str,
    ) -> Result<Self, RenderError> {
        let path = path.as_ref();
        if path.is_file() {
            return Err(RenderError::NotAFolder {
                path: path.to_path_buf(),
            });
        }
        fs::create_dir_all(path).map_err(RenderError::io("make the folder", path))?;
        let about: String = about
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let place = path.join(MANIFEST);
        let old = read_manifest(&place)?;
        let names = match (&old, existing) {
            (None, _) => BTreeSet::new(),
            (Some((_, names)), Existing::Replace | Existing::Resume) => names.clone(),
            // A run that failed before its first output is nothing to lose.
            (Some((_, names)), Existing::Refuse) => match names.first() {
                Some(name) => return Err(occupied(path, name)),
                None => BTreeSet::new(),
            },
        };
        refuse_foreign_frames(path, &names, existing)?;
        if let (Some((found, _)), Existing::Resume) = (&old, existing)
            && *found != about
        {
            return Err(RenderError::OtherRun {
                folder: path.to_path_buf(),
                found: found.clone(),
                wanted: about,
            });
        }

        // Opened without being emptied: until the lock is ours, it may be another run's.
        let mut file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(&place)
            .map_err(RenderError::io("write", &place))?;
        // A file system without locks is no reason to refuse.
        if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            return Err(RenderError::InUse {
                folder: path.to_path_buf(),
            });
        }
        let keep = existing == Existing::Resume;
        if !keep {
            for name in &names {
                remove_ours(&path.join(name))?;
                // What a run that was killed left of it.
                remove_ours(&temporary_name(&path.join(name)))?;
            }
        }
        let names = if keep { names } else { BTreeSet::new() };
        let text = manifest_text(&about, &names);
        file.set_len(0)
            .and_then(|()| file.seek(SeekFrom::Start(0)))
            .and_then(|_| file.write_all(text.as_bytes()))
            .map_err(RenderError::io("write", &place))?;
        Ok(Self {
            path: path.to_path_buf(),
            state: Mutex::new(Manifest { file, names }),
        })
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Lists `name` in the manifest and returns its path: call it before the file is written.
    ///
    /// # Errors
    /// [`RenderError::Name`] unless it is a plain file name of printable characters, [`RenderError::Foreign`] if a file
    /// stands there that is not ours, [`RenderError::Io`] if the manifest cannot be written.
    pub fn claim(&self, name: &str) -> Result<PathBuf, RenderError> {
        let plain = Path::new(name).file_name() == Some(OsStr::new(name));
        if !plain || name.chars().any(char::is_control) || name == MANIFEST {
            return Err(RenderError::Name {
                name: name.to_owned(),
            });
        }
        let place = self.path.join(name);
        let mut manifest = self.manifest();
        if manifest.names.contains(name) {
            return Ok(place);
        }
        if place.exists() {
            return Err(RenderError::Foreign { path: place });
        }
        let line = format!("{name}\n");
        manifest
            .file
            .write_all(line.as_bytes())
            .map_err(RenderError::io("write", &self.path.join(MANIFEST)))?;
        manifest.names.insert(name.to_owned());
        Ok(place)
    }

    /// Writes a whole file: claimed, then under a temporary name, then renamed.
    ///
    /// # Errors
    /// As [`OutputFolder::claim`], and [`RenderError::Io`] from the disk; nothing half-written stays.
    pub fn save(&self, name: &str, bytes: &[u8]) -> Result<(), RenderError> {
        write_file(&self.claim(name)?, bytes)
    }

    /// Whether a finished file of ours has this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.manifest().names.contains(name) && self.path.join(name).is_file()
    }

    /// The names in the manifest, sorted.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.manifest().names.iter().cloned().collect()
    }

    /// A panic of another thread leaves the list usable: every change to it is one insertion.
    fn manifest(&self) -> MutexGuard<'_, Manifest> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Whether `name` looks like a numbered frame.
pub(crate) fn is_frame(name: &str) -> bool {
    name.strip_prefix("frame_")
        .and_then(|rest| rest.strip_suffix(".png"))
        .is_some_and(|number| number.len() >= 5 && number.bytes().all(|b| b.is_ascii_digit()))
}

fn occupied(folder: &Path, what: &str) -> RenderError {
    RenderError::Occupied {
        folder: folder.to_path_buf(),
        what: what.to_owned(),
    }
}

/// The run's description and the names of a manifest, or `None` if there is none.
fn read_manifest(place: &Path) -> Result<Option<(String, BTreeSet<String>)>, RenderError> {
    let mut text = String::new();
    match File::open(place) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(RenderError::io("read", place)(error)),
        Ok(mut file) => {
            if file.read_to_string(&mut text).is_err() {
                text.clear();
            }
        }
    }
    let mut lines = text.lines();
    if lines.next() != Some(HEADING) {
        return Err(RenderError::Foreign {
            path: place.to_path_buf(),
        });
    }
    let about = lines.next().unwrap_or_default().to_owned();
    // A manifest is no licence to remove files elsewhere.
    let names = lines
        .filter(|name| Path::new(name).file_name() == Some(OsStr::new(name)) && *name != MANIFEST)
        .map(str::to_owned)
        .collect();
    Ok(Some((about, names)))
}

fn manifest_text(about: &str, names: &BTreeSet<String>) -> String {
    let mut text = format!("{HEADING}\n{about}\n");
    for name in names {
        text.push_str(name);
        text.push('\n');
    }
    text
}

fn refuse_foreign_frames(
    folder: &Path,
    ours: &BTreeSet<String>,
    existing: Existing,
) -> Result<(), RenderError> {
    let entries = fs::read_dir(folder).map_err(RenderError::io("read", folder))?;
    let mut frames: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| is_frame(name) && !ours.contains(name))
        .collect();
    frames.sort();
    match (frames.first(), existing) {
        (None, _) => Ok(()),
        (Some(name), Existing::Refuse) => Err(occupied(folder, name)),
        (Some(name), _) => Err(RenderError::Foreign {
            path: folder.join(name),
        }),
    }
}

fn remove_ours(place: &Path) -> Result<(), RenderError> {
    match fs::remove_file(place) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(RenderError::io("remove", place)(error))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        fs::write(root.path().join(".a.png.part"), "torn").unwrap();
        drop(folder);
        let _again = OutputFolder::open(root.path(), Existing::Replace, "run 3").unwrap();
        assert!(!root.path().join(".a.png.part").exists());
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
        let text = format!("{HEADING}\nrun\n../victim.txt\n{}\n..\n", victim.display());
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
        let path = root.path().join("out");
        fs::create_dir(&path).unwrap();
        let mut rights = fs::metadata(&path).unwrap().permissions();
        rights.set_readonly(true);
        fs::set_permissions(&path, rights).unwrap();
        if fs::write(path.join("probe"), "").is_ok() {
            return; // the superuser writes anywhere
        }
        let error = OutputFolder::open(&path, Existing::Replace, "run").unwrap_err();
        assert!(matches!(error, RenderError::Io { .. }), "{error}");
    }
}
