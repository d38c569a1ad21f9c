//! An output folder: locked, with a manifest that says which files in it are ours.
//!
//! A name is written into the manifest before its file appears, so whatever stands under a final name is listed, even
//! after a crash, and its checksum after it, so that what is whole is known. Only listed files are ever replaced or removed.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::disk::{self, DiskFile};
use crate::manifest::{Checksum, MANIFEST, Manifest, is_plain, line};
use crate::output::{final_name, temporary_name, write_file};
use crate::{ReadError, RenderError, open_file};

/// What to do with the outputs that a folder holds already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// Refuse the folder if one of the files that its manifest lists is there.
    #[default]
    Refuse,
    /// Remove what the manifest lists, and start anew. Files of others are never touched, and one that was changed since
    /// it was written is not removed: the folder is refused.
    Replace,
    /// Keep what the manifest lists and go on, if it was the same run. A file with bytes that do not match its checksum
    /// counts as missing.
    Resume,
}

/// A folder for outputs, locked against other runs while this value lives.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    manifest: Manifest,
    /// The manifest's file, and those it took the place of: each is a lock that another process may ask for.
    locks: Vec<DiskFile>,
}

impl Drop for State {
    fn drop(&mut self) {
        for lock in &self.locks {
            lock.release();
        }
    }
}

impl OutputFolder {
    /// Opens `path`, made if it is missing, for the run that `about` describes in one line (scene, size, rate).
    ///
    /// Everything that can be wrong with the folder is found here, before the first picture is drawn.
    ///
    /// # Errors
    /// [`RenderError::NotAFolder`], [`RenderError::Occupied`] (with [`Existing::Refuse`]), [`RenderError::Foreign`] (a
    /// manifest or a numbered frame that is not ours), [`RenderError::Edited`] (with [`Existing::Replace`]), [`RenderError::OtherRun`] (with [`Existing::Resume`]),
    /// [`RenderError::InUse`], [`RenderError::Io`] (read-only, no room).
    pub fn open(
        path: impl AsRef<Path>,
        existing: Existing,
        about: &str,
    ) -> Result<Self, RenderError> {
        let path = path.as_ref();
        if path.exists() && !path.is_dir() {
            return Err(RenderError::NotAFolder {
                path: path.to_path_buf(),
            });
        }
        disk::make_folder(path).map_err(RenderError::io("make the folder", path))?;
        let about: String = about
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        // Looked at before anything is made here, and once more under the lock.
        checked(path, existing, &about)?;
        let place = path.join(MANIFEST);
        let lock = disk::open(&place).map_err(RenderError::io("write", &place))?;
        if lock.is_taken() {
            return Err(RenderError::InUse {
                folder: path.to_path_buf(),
            });
        }
        let folder = Self {
            path: path.to_path_buf(),
            state: Mutex::new(State {
                manifest: Manifest::default(),
                locks: vec![lock],
            }),
        };
        folder.begin(existing, about)?;
        Ok(folder)
    }

    /// What is there is kept or removed, and the manifest written anew.
    fn begin(&self, existing: Existing, about: String) -> Result<(), RenderError> {
        let path = &self.path;
        let mut files = checked(path, existing, &about)?.files;
        if existing == Existing::Resume {
            for (name, sum) in &mut files {
                let place = path.join(name);
                // What may never end is not looked into; it is not ours, and stays.
                if let Err(ReadError::NotAFile) = open_file(&place) {
                    return Err(RenderError::Foreign { path: place });
                }
                sum.take_if(|sum| !sum.is_of(&place).unwrap_or(false));
            }
        } else {
            // All are looked at before the first one goes.
            for (name, sum) in &files {
                refuse_edited(&path.join(name), *sum)?;
            }
            for name in files.keys() {
                remove_ours(&path.join(name))?;
            }
        }
        remove_leftovers(path, &files)?;
        if existing != Existing::Resume {
            files.clear();
        }
        let mut state = self.state();
        state.manifest = Manifest { about, files };
        self.rewrite(&mut state)
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
        if !is_plain(name) {
            return Err(RenderError::Name {
                name: name.to_owned(),
            });
        }
        let place = self.path.join(name);
        let mut state = self.state();
        if !state.manifest.files.contains_key(name) {
            if place.exists() {
                return Err(RenderError::Foreign { path: place });
            }
            self.append(&mut state, name, None)?;
        }
        Ok(place)
    }

    /// Writes a whole file: claimed, then under a temporary name, then renamed, then marked as whole.
    ///
    /// # Errors
    /// As [`OutputFolder::claim`], and [`RenderError::Io`] from the disk; nothing half-written stays.
    pub fn save(&self, name: &str, bytes: &[u8]) -> Result<(), RenderError> {
        write_file(&self.claim(name)?, bytes)?;
        self.append(&mut self.state(), name, Some(Checksum::of(bytes)))
    }

    /// Marks a claimed file as whole, after something else wrote it.
    ///
    /// # Errors
    /// [`RenderError::Io`] if it cannot be read, or the manifest not written.
    pub fn seal(&self, name: &str) -> Result<(), RenderError> {
        let place = self.claim(name)?;
        let sum = Checksum::of_file(&place)?;
        self.append(&mut self.state(), name, Some(sum))
    }

    /// Whether a finished file of ours has this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        let state = self.state();
        matches!(state.manifest.files.get(name), Some(Some(_))) && self.path.join(name).is_file()
    }

    /// The names in the manifest, sorted.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.state().manifest.files.keys().cloned().collect()
    }

    /// Ends the run: the manifest is sorted, a line a file, whatever the order in which they were finished.
    ///
    /// A folder that is only dropped is as right, but longer.
    ///
    /// # Errors
    /// [`RenderError::Io`] from the disk; the manifest stays as it was then.
    pub fn close(self) -> Result<(), RenderError> {
        self.rewrite(&mut self.state())
    }

    /// A panic of another thread leaves the list usable: every change to it is one insertion.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// One line more, on the disk first.
    fn append(
        &self,
        state: &mut State,
        name: &str,
        sum: Option<Checksum>,
    ) -> Result<(), RenderError> {
        if let Some(file) = state.locks.last_mut() {
            file.append(&line(name, sum))
                .map_err(RenderError::io("write", &self.path.join(MANIFEST)))?;
        }
        state.manifest.files.insert(name.to_owned(), sum);
        Ok(())
    }

    /// The manifest as a new file in place of the old one, locked before it has its name.
    fn rewrite(&self, state: &mut State) -> Result<(), RenderError> {
        let place = self.path.join(MANIFEST);
        let temporary = temporary_name(&place);
        let text = state.manifest.text();
        let written = disk::create(&temporary).and_then(|mut file| {
            // No other process has the name yet.
            let _taken = file.is_taken();
            file.write_all(text.as_bytes())?;
            disk::rename(&temporary, &place)?;
            Ok(file)
        });
        if written.is_err() {
            let _gone = disk::remove(&temporary);
        }
        state
            .locks
            .push(written.map_err(RenderError::io("write", &place))?);
        Ok(())
    }
}

/// Whether `name` looks like a numbered frame.
pub(crate) fn is_frame(name: &str) -> bool {
    name.strip_prefix("frame_")
        .and_then(|rest| rest.strip_suffix(".png").or(rest.strip_suffix(".svg")))
        .is_some_and(|number| number.len() >= 5 && number.bytes().all(|b| b.is_ascii_digit()))
}

/// The manifest that is there, if the folder may be used as `existing` says.
fn checked(path: &Path, existing: Existing, about: &str) -> Result<Manifest, RenderError> {
    let manifest = Manifest::read(path)?.unwrap_or_default();
    // A run that failed before its first output is nothing to lose, and so is a listed file that never got its name.
    let there = |name: &&String| is_there(&path.join(name));
    match existing {
        Existing::Refuse => {
            if let Some(name) = manifest.files.keys().find(there) {
                return Err(occupied(path, name));
            }
        }
        Existing::Resume if !manifest.files.is_empty() && manifest.about != about => {
            return Err(RenderError::OtherRun {
                folder: path.to_path_buf(),
                found: manifest.about,
                wanted: about.to_owned(),
            });
        }
        Existing::Resume | Existing::Replace => {}
    }
    refuse_foreign_frames(path, &manifest, existing)?;
    Ok(manifest)
}

fn occupied(folder: &Path, what: &str) -> RenderError {
    RenderError::Occupied {
        folder: folder.to_path_buf(),
        what: what.to_owned(),
    }
}

fn refuse_foreign_frames(
    folder: &Path,
    ours: &Manifest,
    existing: Existing,
) -> Result<(), RenderError> {
    let entries = fs::read_dir(folder).map_err(RenderError::io("read", folder))?;
    let first = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| is_frame(name) && !ours.files.contains_key(name))
        .min();
    match (first, existing) {
        (None, _) => Ok(()),
        (Some(name), Existing::Refuse) => Err(occupied(folder, &name)),
        (Some(name), _) => Err(RenderError::Foreign {
            path: folder.join(name),
        }),
    }
}

/// Whether a file, or a link that may lead nowhere, has this name.
fn is_there(place: &Path) -> bool {
    place.symlink_metadata().is_ok()
}

/// A file that its checksum does not fit was edited, unless it is empty: that may be of a system that broke down.
fn refuse_edited(place: &Path, sum: Option<Checksum>) -> Result<(), RenderError> {
    let Some(sum) = sum.filter(|_| is_there(place)) else {
        return Ok(());
    };
    let path = place.to_path_buf();
    match open_file(place) {
        Ok((_, 0)) => Ok(()),
        Ok(_) if sum.is_of(place)? => Ok(()),
        Ok(_) => Err(RenderError::Edited { path }),
        Err(ReadError::NotAFile) => Err(RenderError::Foreign { path }),
        // A link that leads nowhere.
        Err(ReadError::Io(error)) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(RenderError::io("read", place)(error.into())),
    }
}

/// What runs that were killed left of listed files and of the manifest, under their temporary names.
fn remove_leftovers(
    folder: &Path,
    files: &BTreeMap<String, Option<Checksum>>,
) -> Result<(), RenderError> {
    for entry in fs::read_dir(folder).map_err(RenderError::io("read", folder))? {
        let entry = entry.map_err(RenderError::io("read", folder))?;
        let hidden = entry.file_name().into_string().unwrap_or_default();
        let ours =
            final_name(&hidden).is_some_and(|name| name == MANIFEST || files.contains_key(name));
        if ours && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            remove_ours(&entry.path())?;
        }
    }
    Ok(())
}

fn remove_ours(place: &Path) -> Result<(), RenderError> {
    disk::remove(place).map_err(RenderError::io("remove", place))
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
