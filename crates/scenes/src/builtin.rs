//! The scenes that come with the library: files under `scenes/`, embedded.

use std::path::Path;
use std::sync::LazyLock;

use crate::error::{Problem, SceneError, nearest};
use crate::plain::{full_name, growth_of};
use crate::{Place, Scene, plain_scenes};

/// A built-in scene, as a list shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneInfo {
    /// What [`find`] takes.
    pub name: &'static str,
    /// What is seen, in a sentence.
    pub summary: String,
    /// Whether it has thousands of bodies: too many to run it for seconds on the side.
    pub large: bool,
    /// The file.
    pub text: &'static str,
}

/// Names and files, in the order of the list.
static FILES: [(&str, &str); 32] = [
    ("thesis", include_str!("../scenes/thesis.toml")),
    ("flying-balls", include_str!("../scenes/flying-balls.toml")),
    (
        "flying-balls-newton",
        include_str!("../scenes/flying-balls-newton.toml"),
    ),
    (
        "elastic-discs",
        include_str!("../scenes/elastic-discs.toml"),
    ),
    ("stack", include_str!("../scenes/stack.toml")),
    ("pyramid", include_str!("../scenes/pyramid.toml")),
    ("pile", include_str!("../scenes/pile.toml")),
    ("bounce", include_str!("../scenes/bounce.toml")),
    ("projectile", include_str!("../scenes/projectile.toml")),
    ("slide", include_str!("../scenes/slide.toml")),
    ("inertia", include_str!("../scenes/inertia.toml")),
    ("forces", include_str!("../scenes/forces.toml")),
    ("sat", include_str!("../scenes/sat.toml")),
    ("vertex-edge", include_str!("../scenes/vertex-edge.toml")),
    (
        "infinite-mass",
        include_str!("../scenes/infinite-mass.toml"),
    ),
    ("sleepers", include_str!("../scenes/sleepers.toml")),
    ("pi", include_str!("../scenes/pi.toml")),
    ("cradle", include_str!("../scenes/cradle.toml")),
    (
        "a_large_pyramid",
        include_str!("../scenes/a_large_pyramid.toml"),
    ),
    (
        "b_many_pyramids",
        include_str!("../scenes/b_many_pyramids.toml"),
    ),
    ("c_smash", include_str!("../scenes/c_smash.toml")),
    ("d_tumbler", include_str!("../scenes/d_tumbler.toml")),
    (
        "e_flying_polygons",
        include_str!("../scenes/e_flying_polygons.toml"),
    ),
    ("e_medium", include_str!("../scenes/e_medium.toml")),
    ("e_dilute", include_str!("../scenes/e_dilute.toml")),
    (
        "f_polygon_pile",
        include_str!("../scenes/f_polygon_pile.toml"),
    ),
    (
        "g_concave_pile",
        include_str!("../scenes/g_concave_pile.toml"),
    ),
    (
        "h_mostly_sleeping",
        include_str!("../scenes/h_mostly_sleeping.toml"),
    ),
    (
        "i_mostly_empty",
        include_str!("../scenes/i_mostly_empty.toml"),
    ),
    (
        "case12_polygon_gas",
        include_str!("../scenes/case12_polygon_gas.toml"),
    ),
    (
        "case18_disc_gas",
        include_str!("../scenes/case18_disc_gas.toml"),
    ),
    (
        "case19_polygon_pairs",
        include_str!("../scenes/case19_polygon_pairs.toml"),
    ),
];

/// The built-in scenes.
#[must_use]
pub fn list() -> &'static [SceneInfo] {
    static LIST: LazyLock<Vec<SceneInfo>> = LazyLock::new(|| {
        let info = |&(name, text): &(&'static str, &'static str)| SceneInfo {
            name,
            summary: Scene::from_toml(text, name)
                .map(|scene| scene.description().to_owned())
                .unwrap_or_default(),
            large: plain_scenes().iter().any(|info| info.name == name) && !name.starts_with("case"),
            text,
        };
        FILES.iter().map(info).collect()
    });
    &LIST
}

/// The built-in scene of a name; of the scenes that compare engines, a letter will do, and growth scenes have any
/// number of bodies: `grow_pile_2000`.
///
/// # Errors
/// If there is none: the nearest name is suggested.
///
/// # Examples
/// ```
/// let stack = carom_scenes::find("stack")?;
/// assert_eq!(stack.name(), "stack");
/// let error = carom_scenes::find("stak").unwrap_err();
/// assert_eq!(error.to_string(), "stak: unknown scene, did you mean \"stack\"?");
/// # Ok::<(), carom_scenes::SceneError>(())
/// ```
pub fn find(name: &str) -> Result<Scene, SceneError> {
    let known = FILES.iter().map(|(known, _)| *known);
    let full = full_name(name).unwrap_or(name);
    match FILES.iter().find(|(known, _)| *known == full) {
        Some((name, text)) => Scene::from_toml(text, name),
        None if growth_of(name).is_some() => Scene::from_toml(&growing(name), name),
        None => Err(SceneError {
            origin: name.to_owned(),
            place: Place::File,
            field: String::new(),
            problem: Box::new(Problem::Unknown {
                what: "scene",
                nearest: nearest(name, known.clone()).map(str::to_owned),
                expected: known.map(str::to_owned).collect(),
            }),
        }),
    }
}

/// The file of a growth scene.
fn growing(name: &str) -> String {
    format!("version = 1\nduration = 2.2\n\n[plain]\nscene = \"{name}\"\n")
}

/// A scene by what a user types: a built-in name, or the path of a file.
///
/// What ends in `.toml` or has a folder in it is a path; a built-in name wins over a file of that name.
///
/// # Errors
/// As [`find`] and [`Scene::load`].
pub fn open(name_or_path: impl AsRef<Path>) -> Result<Scene, SceneError> {
    let path = name_or_path.as_ref();
    let plain = path.components().count() == 1 && path.extension().is_none();
    match path.to_str() {
        Some(name)
            if plain && (FILES.iter().any(|(known, _)| *known == name) || !path.exists()) =>
        {
            find(name)
        }
        _ => Scene::load(path),
    }
}

/// Reads a scene file: [`Scene::load`].
///
/// # Errors
/// As [`Scene::load`].
pub fn load(path: impl AsRef<Path>) -> Result<Scene, SceneError> {
    Scene::load(path)
}
