//! A look at what the demo wrote: everything there, nothing half done, every picture readable.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use carom_render::Picture;

use crate::exit::Failure;
use crate::out::say;

/// Checks a demo folder with a folder a scene; says what is missing.
pub(super) fn check(folder: &Path) -> Result<bool, Failure> {
    let mut faults = Vec::new();
    let mut scenes = 0;
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            scenes += 1;
            look_at(&path, &mut faults)?;
        }
    }
    if scenes != crate::demo::SCENES.len() {
        faults.push(format!(
            "{scenes} scenes, expected {}",
            crate::demo::SCENES.len()
        ));
    }
    for fault in &faults {
        say!("demo: {fault}");
    }
    Ok(faults.is_empty())
}

fn look_at(folder: &Path, faults: &mut Vec<String>) -> Result<(), Failure> {
    let name = folder.display();
    let mut sizes = BTreeMap::new();
    let mut frames = 0;
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let file = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if file.starts_with('.') || file.ends_with(".tmp") || file.ends_with(".part") {
            faults.push(format!("{file} was left behind in {name}"));
        }
        if file.ends_with(".png") {
            match Picture::from_png(&fs::read(&path)?) {
                Ok(picture) if file.starts_with("frame_") => {
                    frames += 1;
                    sizes.insert(picture.size().to_string(), file.clone());
                }
                Ok(_) => {}
                Err(error) => faults.push(format!("{}: {error}", path.display())),
            }
        }
    }
    if frames == 0 || sizes.len() != 1 {
        faults.push(format!(
            "{frames} frames of {} sizes in {name}",
            sizes.len()
        ));
    }
    for file in crate::demo::FILES {
        if !folder.join(file).is_file() {
            faults.push(format!("{file} is missing in {name}"));
        }
    }
    let first = folder.join("frame_00000.png");
    let last = folder.join(format!("frame_{:05}.png", frames.max(1) - 1));
    if !first.is_file() || !last.is_file() {
        faults.push(format!(
            "the {frames} frames in {name} are not numbered from 0"
        ));
    }
    Ok(())
}
