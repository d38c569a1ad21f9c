//! What is drawn over the bodies, and in which ink: the flags `--overlay` and `--style`.

use carom_render::{Overlay, Style};
use carom_scenes::Built;

use crate::flags::{OverlayFlag, StyleFlag};

/// Lays the flags over the scene's own look.
pub(super) fn dress(built: &mut Built, overlays: &[OverlayFlag], style: Option<StyleFlag>) {
    for &flag in overlays {
        add(&mut built.look.overlay, flag, &built.overlays);
    }
    if let Some(style) = style {
        built.look.style = match style {
            StyleFlag::Light => Style::light(),
            StyleFlag::Dark => Style::dark(),
            StyleFlag::Print => Style::print(),
        };
    }
}

fn add(overlay: &mut Overlay, flag: OverlayFlag, all: &Overlay) {
    match flag {
        OverlayFlag::None => *overlay = Overlay::default(),
        OverlayFlag::All => *overlay = all.clone(),
        OverlayFlag::Velocities => overlay.velocities = all.velocities,
        OverlayFlag::Centroids => overlay.centroids = true,
        OverlayFlag::Contacts => overlay.contacts = true,
        OverlayFlag::Impulses => overlay.impulses = all.impulses,
        OverlayFlag::Flashes => overlay.flashes = true,
        OverlayFlag::Boxes => overlay.bounds = true,
        OverlayFlag::Groups => overlay.groups = true,
        OverlayFlag::Asleep => overlay.asleep = true,
        OverlayFlag::Overlaps => overlay.overlaps = true,
        OverlayFlag::Trails => overlay.trails = all.trails,
        OverlayFlag::Field => overlay.field.clone_from(&all.field),
        OverlayFlag::FieldLines => overlay.field_lines.clone_from(&all.field_lines),
        OverlayFlag::Restitution => overlay.restitution = all.restitution,
        OverlayFlag::Gravity => overlay.gravity = true,
        OverlayFlag::Time => overlay.time = true,
        OverlayFlag::Counters => overlay.counters = true,
        OverlayFlag::Caption => overlay.caption.clone_from(&all.caption),
    }
}

/// The flags in one line, for the manifest.
pub(super) fn line(overlays: &[OverlayFlag], style: Option<StyleFlag>) -> String {
    let names: Vec<String> = overlays.iter().map(|flag| format!("{flag:?}")).collect();
    let style = style.map_or_else(|| "own".to_owned(), |style| format!("{style:?}"));
    format!("overlay [{}] style {style}", names.join(" "))
}
