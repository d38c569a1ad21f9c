//! The plain scenes by name.

use super::grow::{growth_of, growth_scene};
use super::{PlainScene, gas, lively_scenes, pairs, piles, resting, sparse};

/// A plain scene, as a list shows it.
#[derive(Clone, Copy, Debug)]
pub struct PlainInfo {
    /// What [`plain_scene`] takes.
    pub name: &'static str,
    /// What it is called in tables and charts.
    pub title: &'static str,
    /// What it is for, in a line.
    pub about: &'static str,
    make: fn(&str) -> PlainScene,
}

impl PlainInfo {
    /// Makes the scene.
    #[must_use]
    pub fn scene(&self) -> PlainScene {
        (self.make)(self.name)
    }
}

pub(super) const fn info(
    name: &'static str,
    title: &'static str,
    about: &'static str,
    make: fn(&str) -> PlainScene,
) -> PlainInfo {
    PlainInfo {
        name,
        title,
        about,
        make,
    }
}

static SCENES: [PlainInfo; 14] = [
    info(
        "a_large_pyramid",
        "5,050 boxes in a pyramid",
        "5,050 boxes in a hundred touching rows: one island, the stiffness of resting contacts",
        resting::large_pyramid,
    ),
    info(
        "b_many_pyramids",
        "22,000 boxes in 400 pyramids",
        "22,000 boxes in 400 pyramids on twenty floors: many islands, memory traffic",
        resting::many_pyramids,
    ),
    info(
        "c_smash",
        "9,600 boxes, struck",
        "a heavy box runs into 9,600 sleepers: waking, pairs that change all the time",
        resting::smash,
    ),
    info(
        "d_tumbler",
        "2,025 boxes in a drum",
        "2,025 boxes in a drum that turns: a pile that never rests",
        resting::tumbler,
    ),
    info(
        "e_flying_polygons",
        "2,000 elastic polygons, dense",
        "2,000 elastic discs and polygons in a closed box: impacts, and energy that must stay",
        gas::dense,
    ),
    info(
        "e_medium",
        "2,000 elastic polygons, thinner",
        "the same bodies in a box twice as wide",
        gas::medium,
    ),
    info(
        "e_dilute",
        "2,000 elastic polygons, thin",
        "the same bodies in a box four times as wide",
        gas::dilute,
    ),
    info(
        "f_polygon_pile",
        "3,000 polygons piled up",
        "3,000 polygons of three to eight corners fall into a bin and settle",
        piles::polygons,
    ),
    info(
        "g_concave_pile",
        "800 concave polygons piled up",
        "800 L, U and stars fall into a bin and settle",
        piles::concave,
    ),
    info(
        "h_mostly_sleeping",
        "10,000 sleepers, 20 balls",
        "a thousand stacks of ten fall asleep while twenty discs bounce on: what sleepers cost",
        resting::mostly_sleeping,
    ),
    info(
        "i_mostly_empty",
        "10,000 falling discs",
        "10,000 discs in free fall, far apart: what a free body costs",
        sparse::mostly_empty,
    ),
    info(
        "case12_polygon_gas",
        "100 elastic polygons",
        "100 elastic polygons in a closed box: energy over a minute",
        gas::case_12,
    ),
    info(
        "case18_disc_gas",
        "100 elastic discs",
        "100 elastic discs in a closed box: energy over a minute",
        gas::case_18,
    ),
    info(
        "case19_polygon_pairs",
        "400 pairs of polygons",
        "400 pairs of polygons, each pair a world of its own: what one impact keeps",
        pairs::case_19,
    ),
];

/// The plain scenes, in the order of the tables.
#[must_use]
pub fn plain_scenes() -> &'static [PlainInfo] {
    &SCENES
}

/// The plain scene of a name, or of a letter: `a` is `a_large_pyramid`, `e` is `e_flying_polygons`;
/// or a [lively scene](super::lively_scenes): `lively_wall`; or a [growth scene](super::growth_scene) of any size: `grow_pile_2000`; or a [gas](super::spaced_scene) of any
/// density: `gas_spaced_1300`.
///
/// # Examples
/// ```
/// let scene = carom_scenes::plain_scene("a").ok_or("it is there")?;
/// assert_eq!(scene.name, "a_large_pyramid");
/// assert_eq!(scene.bodies.len(), 5051);                        // and the ground
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn plain_scene(name: &str) -> Option<PlainScene> {
    let full = full_name(name).unwrap_or(name);
    let mut known = SCENES.iter().chain(lively_scenes());
    let found = known.find(|info| info.name == full);
    found
        .map(PlainInfo::scene)
        .or_else(|| growth_of(name).map(|(kind, bodies)| growth_scene(kind, bodies)))
        .or_else(|| gas::spacing_of(name).map(gas::spaced_scene))
}

/// The name that a letter stands for.
pub(crate) fn full_name(letter: &str) -> Option<&'static str> {
    let mut names = SCENES.iter().map(|info| info.name);
    names.find(|name| {
        name.split_once('_')
            .is_some_and(|(first, _)| first == letter && first.len() == 1)
    })
}
