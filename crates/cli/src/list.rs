//! `list`: the built-in scenes, a line each.

use crate::exit::{End, Outcome};
use crate::out::say;

pub(crate) fn run() -> Outcome {
    let scenes = carom_scenes::list();
    let width = scenes
        .iter()
        .map(|scene| scene.name.len())
        .max()
        .unwrap_or(0);
    for scene in scenes {
        say!("{:<width$}  {}", scene.name, scene.summary);
    }
    Ok(End::Done)
}
