//! What a scene is built to.

use carom_dynamics::{BodyId, World};
use carom_render::{Camera, FrameRate, Look, Overlay};

/// A world at its start, and how it is looked at.
#[derive(Debug)]
pub struct Built {
    /// The world, at time 0.
    pub world: World,
    /// Paints, faces, overlays, and the style that it is painted with.
    pub look: Look,
    /// Every overlay, as this scene would show it: what a caller may add to the look's own.
    pub overlays: Overlay,
    /// Where the camera stands, and the size of the picture.
    pub camera: Camera,
    /// How long the scene runs, in s.
    pub duration: f64,
    /// Frames per second.
    pub rate: FrameRate,
    /// Every body by its name, in order of insertion.
    pub names: Vec<(String, BodyId)>,
    /// Whether the scene asks for a caption with the state of the run.
    pub stats: bool,
}

impl Built {
    /// The body of a name.
    #[must_use]
    pub fn body(&self, name: &str) -> Option<BodyId> {
        let found = self.names.iter().find(|(known, _)| known == name);
        found.map(|&(_, id)| id)
    }
}
