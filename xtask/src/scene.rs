//! Scenes by name or by file, with `--set` and `--mode` laid over them.

use carom_scenes::{Built, Scene};

use crate::exit::Failure;
use crate::flags::ModeFlag;
use crate::values::KeyValue;

/// Opens a scene file, or a built-in scene by its name.
pub(crate) fn open(name: &str, set: &[KeyValue]) -> Result<Scene, Failure> {
    let mut scene = carom_scenes::open(name)?;
    for KeyValue { key, value } in set {
        scene.set(key, value)?;
    }
    Ok(scene)
}

/// Builds the world, its look and its camera.
pub(crate) fn build(scene: &Scene, mode: Option<ModeFlag>) -> Result<Built, Failure> {
    let mut scene = scene.clone();
    if let Some(mode) = mode {
        let name = match mode {
            ModeFlag::Hybrid => "hybrid",
            ModeFlag::Exact => "exact",
            ModeFlag::Stepped => "stepped",
        };
        scene.set("settings.mode", name)?;
    }
    Ok(scene.build()?)
}

/// A name fit for a file: letters, digits, `-` and `_`; the last part of a path, without its ending.
pub(crate) fn file_stem(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = last.strip_suffix(".toml").unwrap_or(last);
    let plain: String = stem
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '_' {
                c
            } else {
                '-'
            }
        })
        .collect();
    if plain.trim_matches('-').is_empty() {
        "scene".to_owned()
    } else {
        plain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_becomes_a_plain_file_name() {
        assert_eq!(file_stem("thesis"), "thesis");
        assert_eq!(file_stem("a/b/my scene.toml"), "my-scene");
        assert_eq!(file_stem("../.."), "scene");
    }
}
