//! Colours, faces, overlays and the camera.

use std::collections::BTreeMap;
use std::path::{Component, Path};

use carom_dynamics::{BodyId, RadialField, World};
use carom_geometry::Aabb;
use carom_math::Vec2;
use carom_render::{Camera, Colour, Face, FieldMark, FrameRate, Look, Overlay, Style};

use super::plan::Planned;
use crate::document::Document;
use crate::error::{Problem, SceneError};
use crate::model::{CameraTable, SceneFile, ThemeName};
use crate::path::FieldPath;
use crate::scene::read_bytes;
use crate::{Built, Scene};

/// Length of a velocity arrow over the velocity, in s.
const VELOCITY_SCALE: f64 = 0.2;
/// Length of a trail, in s.
const TRAIL: f64 = 1.5;

pub(super) fn dress(
    scene: &Scene,
    file: &SceneFile,
    world: World,
    bodies: &[Planned],
    names: Vec<(String, BodyId)>,
) -> Result<Built, SceneError> {
    let document = &scene.document;
    let rate = FrameRate::per_second(file.fps).map_err(|error| {
        document.error(&FieldPath::root("fps"), Problem::Refused(error.to_string()))
    })?;
    let camera = camera(document, file, &world)?;
    let all = everything(file, bodies);
    let mut faces = Faces::new(scene);
    let mut look = look(&mut faces, file, all.clone())?;
    for (body, &(_, id)) in bodies.iter().zip(&names) {
        if let Some(text) = &body.colour {
            look.set_colour(id, colour(document, &body.field.key("colour"), text)?);
        }
        if let Some(name) = &body.face {
            look.set_face(id, faces.find(&body.field.key("face"), name)?);
        }
    }
    Ok(Built {
        world,
        look,
        overlays: all,
        camera,
        duration: file.duration,
        rate,
        names,
        stats: file.look.stats,
    })
}

fn look(faces: &mut Faces<'_>, file: &SceneFile, all: Overlay) -> Result<Look, SceneError> {
    let table = &file.look;
    let common = match &table.face {
        Some(name) => Some(faces.find(&face_field(file), name)?),
        None => None,
    };
    let default = Look::seeded(table.palette.unwrap_or(file.seed));
    Ok(Look {
        shaded: table.shaded,
        spokes: table.spokes.unwrap_or(default.spokes),
        face: common,
        overlay: wanted(file, all),
        style: style(&faces.scene.document, file)?,
        ..default
    })
}

/// Every overlay, as this scene would show it.
fn everything(file: &SceneFile, bodies: &[Planned]) -> Overlay {
    let scale = file.look.velocity_scale.unwrap_or(VELOCITY_SCALE);
    Overlay {
        centroids: true,
        velocities: Some(scale),
        trails: Some(TRAIL),
        contacts: true,
        impulses: Some(scale),
        flashes: true,
        groups: true,
        overlaps: true,
        bounds: true,
        asleep: true,
        gravity: true,
        time: true,
        counters: true,
        restitution: Some(restitution(file, bodies)),
        field: field_mark(file),
        field_lines: Some(fields(file)),
        caption: file.look.caption.clone(),
    }
}

/// What the scene file asks for of it.
fn wanted(file: &SceneFile, all: Overlay) -> Overlay {
    let table = &file.look;
    Overlay {
        centroids: table.centroids,
        velocities: all.velocities.filter(|_| table.velocities),
        contacts: table.contacts,
        bounds: table.boxes,
        asleep: table.asleep,
        gravity: table.gravity,
        time: table.time,
        counters: table.counters,
        restitution: all.restitution.filter(|_| table.restitution),
        field: all.field.filter(|_| table.field),
        caption: all.caption,
        ..Overlay::default()
    }
}

/// The fields that are on.
fn fields(file: &SceneFile) -> Vec<RadialField> {
    let on = file.field.iter().filter(|field| field.strength != 0.0);
    // What the world refused has ended the build before.
    on.filter_map(|field| RadialField::new(field.centre.0, field.strength, field.core).ok())
        .collect()
}

/// The bar's value: the parameter, else the largest coefficient of a surface or of a pair.
fn restitution(file: &SceneFile, bodies: &[Planned]) -> f64 {
    let surfaces = bodies.iter().flat_map(|body| &body.shapes);
    let pairs = file.pair.iter().map(|pair| pair.restitution);
    let coefficients = surfaces
        .map(|(_, surface)| surface.material.restitution)
        .chain(pairs);
    let largest = coefficients.fold(0.0, f64::max);
    file.parameters.restitution.unwrap_or(largest)
}

/// A circle around the core of the first field that is on.
fn field_mark(file: &SceneFile) -> Option<FieldMark> {
    let on = file.field.iter().find(|field| field.strength != 0.0);
    on.map(|field| FieldMark {
        centre: field.centre.0,
        radius: field.core,
        label: format!("GM = {} m^3/s^2", field.strength),
    })
}

fn face_field(file: &SceneFile) -> FieldPath {
    let table = if file.parameters.face.is_some() {
        "parameters"
    } else {
        "look"
    };
    FieldPath::root(table).key("face")
}

/// Most pixels of all faces of a scene together, each file counted once: one of the largest, or a hundred of 400 x 400.
/// A pixel takes 16 bytes and more.
const MAX_FACES: u64 = 1 << 24;

/// The faces of a scene, each read once for all that wear it.
struct Faces<'a> {
    scene: &'a Scene,
    known: BTreeMap<String, Face>,
    pixels: u64,
}

impl<'a> Faces<'a> {
    const fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            known: BTreeMap::new(),
            pixels: 0,
        }
    }

    /// `builtin`, or a PNG in the scene file's folder.
    fn find(&mut self, field: &FieldPath, name: &str) -> Result<Face, SceneError> {
        if let Some(face) = self.known.get(name) {
            return Ok(face.clone());
        }
        if name.is_empty() {
            let reason = "the name is empty: builtin, or a PNG file beside the scene";
            let problem = Problem::Refused(reason.to_owned());
            return Err(self.scene.document.error(field, problem));
        }
        let face = if name == "builtin" {
            Face::smile()
        } else {
            self.read(name).map_err(|reason| {
                let problem = Problem::Refused(format!("cannot read {name}: {reason}"));
                self.scene.document.error(field, problem)
            })?
        };
        self.known.insert(name.to_owned(), face.clone());
        Ok(face)
    }

    fn read(&mut self, name: &str) -> Result<Face, String> {
        let path = Path::new(name);
        // A scene may come from anywhere: it reads what lies beside it, and nothing else.
        let mut parts = path.components();
        if !parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
            return Err("not in the folder of the scene file".to_owned());
        }
        let path = self
            .scene
            .folder
            .as_deref()
            .unwrap_or(Path::new(""))
            .join(path);
        let bytes = read_bytes(&path).map_err(|problem| problem.to_string())?;
        let face = Face::from_png(&bytes).map_err(|error| error.to_string())?;
        self.pixels += u64::from(face.width()) * u64::from(face.height());
        if self.pixels > MAX_FACES {
            return Err(format!(
                "the faces of the scene have {} pixels with this one, over the limit of {MAX_FACES}",
                self.pixels
            ));
        }
        Ok(face)
    }
}

fn style(document: &Document, file: &SceneFile) -> Result<Style, SceneError> {
    let style = match file.look.theme {
        ThemeName::Light => Style::light(),
        ThemeName::Dark => Style::dark(),
    };
    let field = FieldPath::root("camera").key("background");
    Ok(match &file.camera.background {
        Some(text) => Style {
            background: colour(document, &field, text)?,
            ..style
        },
        None => style,
    })
}

fn colour(document: &Document, field: &FieldPath, text: &str) -> Result<Colour, SceneError> {
    text.parse::<Colour>()
        .map_err(|error| document.error(field, Problem::Refused(error.to_string())))
}

fn camera(document: &Document, file: &SceneFile, world: &World) -> Result<Camera, SceneError> {
    let table = &file.camera;
    let field = FieldPath::root("camera");
    let made = made_camera(table, file, world);
    made.map_err(|(key, reason)| document.error(&field.key(key), Problem::Refused(reason)))
}

fn made_camera(
    table: &CameraTable,
    file: &SceneFile,
    world: &World,
) -> Result<Camera, (&'static str, String)> {
    let (width, height) = (table.size.width, table.size.height);
    carom_render::Size::new(width, height).map_err(|error| ("size", error.to_string()))?;
    if let Some(fit) = table.fit {
        if table.centre.is_some() || table.height.is_some() {
            return Err(("fit", "fit is given beside centre or height".to_owned()));
        }
        return Camera::fit(Aabb::new(fit.min, fit.max), width, height)
            .map_err(|error| ("fit", error.to_string()));
    }
    match (table.centre, table.height) {
        (Some(centre), Some(metres)) => {
            Camera::new(centre.0, f64::from(height) / metres, width, height)
                .map_err(|error| ("height", error.to_string()))
        }
        (None, None) => Camera::fit(surroundings(file, world), width, height)
            .map_err(|error| ("fit", error.to_string())),
        (Some(_), None) => Err(("height", "centre is given without height".to_owned())),
        (None, Some(_)) => Err(("centre", "height is given without centre".to_owned())),
    }
}

/// What there is to see at the start: the room between the walls, else all bodies, with a margin.
fn surroundings(file: &SceneFile, world: &World) -> Aabb {
    let bodies = world.bodies().map(|body| body.aabb());
    let bounds = match &file.walls {
        Some(walls) => Aabb::new(walls.inner.min, walls.inner.max),
        // A half-plane has no end, and is seen wherever the camera looks.
        None => bodies
            .filter(|bounds| bounds.is_finite())
            .fold(Aabb::EMPTY, |all, next| all.union(next)),
    };
    if !bounds.is_finite() {
        return Aabb::new(Vec2::splat(-1.0), Vec2::splat(1.0));
    }
    bounds.grown(0.04 * bounds.extents().max_element())
}
