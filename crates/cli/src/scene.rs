//! Scenes by name or by file, with `--set` and `--mode` laid over them.

use carom_dynamics::World;
use carom_scenes::Scene;

use crate::exit::{Failure, fail};
use crate::flags::ModeFlag;
use crate::number::number;
use crate::values::KeyValue;

/// Opens a scene file, or a built-in scene by its name.
pub fn open(name: &str, set: &[KeyValue], mode: Option<ModeFlag>) -> Result<Scene, Failure> {
    if name.is_empty() {
        fail!("the name of the scene is empty");
    }
    let mut scene = carom_scenes::open(name)?;
    for (k, KeyValue { key, value }) in set.iter().enumerate() {
        if set[..k].iter().any(|other| other.key == *key) {
            fail!("--set {key} is given twice");
        }
        scene.set(key, value)?;
    }
    if let Some(mode) = mode {
        let name = match mode {
            ModeFlag::Hybrid => "hybrid",
            ModeFlag::Exact => "exact",
            ModeFlag::Stepped => "stepped",
        };
        scene.set("settings.mode", name)?;
    }
    Ok(scene)
}

/// Most ticks of a step that a world takes; one of more is refused when it is made, far from the scene file.
const MOST_TICKS: f64 = 1e7;

/// Refuses steps that hold too many ticks of the scene, before the first one.
pub(crate) fn check_step(scene: &Scene, world: &World, seconds: f64) -> Result<(), Failure> {
    let tick = world.settings().tick;
    if seconds <= MOST_TICKS * tick {
        return Ok(());
    }
    let (tick, seconds) = (number(tick), number(seconds));
    let reason =
        format!("{tick} s is too short: steps of {seconds} s hold more than {MOST_TICKS:e} of it");
    Err(scene.tick_error(reason).into())
}

/// 64 bits that differ where two scenes differ, in the file or in what was laid over it.
pub(crate) fn fingerprint(scene: &Scene) -> u64 {
    // FNV-1a over everything that the scene holds.
    let text = format!("{scene:?}");
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
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
    fn every_setting_changes_the_fingerprint() {
        let print = |set: &[&str], mode| {
            let set: Vec<KeyValue> = set.iter().map(|text| text.parse().unwrap()).collect();
            fingerprint(&open("thesis", &set, mode).unwrap())
        };
        let prints = [
            print(&[], None),
            print(&["gravity=[0, -1]"], None),
            print(&[], Some(ModeFlag::Stepped)),
        ];
        assert_eq!(prints[0], print(&[], None));
        assert!(prints[0] != prints[1] && prints[1] != prints[2] && prints[2] != prints[0]);
    }

    #[test]
    fn a_name_becomes_a_plain_file_name() {
        assert_eq!(file_stem("thesis"), "thesis");
        assert_eq!(file_stem("a/b/my scene.toml"), "my-scene");
        assert_eq!(file_stem("../.."), "scene");
    }
}
