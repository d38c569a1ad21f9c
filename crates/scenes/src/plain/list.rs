//! The plain scenes by name.

use super::grow::{growth_of, growth_scene};
use super::{PlainScene, gas, lively, pairs, piles, resting, sparse};

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

const fn info(
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

static SCENES: [PlainInfo; 38] = [
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
        "lively_hourglass",
        "hourglass",
        "2,000 discs and polygons run through the neck of a funnel into a bin.",
        lively::hourglass,
    ),
    info(
        "lively_wall",
        "wall",
        "A wall of 2,000 bricks, hit by a heavy ball.",
        lively::wall,
    ),
    info(
        "lively_explosion",
        "explosion",
        "2,000 bodies fly apart from one place in a closed box.",
        lively::explosion,
    ),
    info(
        "lively_stirred",
        "stirred",
        "Three crosses turn in a bin of 2,000 bodies.",
        lively::stirred,
    ),
    info(
        "lively_falling",
        "falling",
        "4,000 bodies fall onto a heap.",
        lively::falling,
    ),
    info(
        "lively_sizes",
        "sizes",
        "Sizes of 1 to 20 in one heap.",
        lively::sizes,
    ),
    info(
        "lively_drum_mixed",
        "drum_mixed",
        "A drum of mixed bodies.",
        lively::drum_mixed,
    ),
    info(
        "lively_drum_letters",
        "drum_letters",
        "A drum of L shapes: two boxes each.",
        lively::drum_letters,
    ),
    info(
        "lively_junkyard",
        "junkyard",
        "A plate is driven through a heap of 2,000 bodies, without end.",
        lively::junkyard,
    ),
    info(
        "lively_compounds",
        "compounds",
        "Compound bodies of three triangles fall onto steps.",
        lively::compounds,
    ),
    info(
        "lively_pins",
        "pins",
        "Discs fall through pins.",
        lively::pins,
    ),
    info(
        "lively_rods",
        "rods",
        "Long thin rods fall into a bin.",
        lively::rods,
    ),
    info(
        "lively_bouncing",
        "bouncing",
        "Balls that bounce on each other in a bin.",
        lively::bouncing,
    ),
    info(
        "lively_rack",
        "rack",
        "Discs without gravity that lose speed when they meet: a broken rack of 1,275.",
        lively::rack,
    ),
    info(
        "lively_slopes",
        "slopes",
        "Bodies roll and slide down a stair of slopes of segments.",
        lively::slopes,
    ),
    info(
        "lively_landing_stacks",
        "landing_stacks",
        "A thousand stacks of five land one after the other.",
        lively::landing_stacks,
    ),
    info(
        "lively_rocking",
        "rocking",
        "A thousand boxes rock on their corners.",
        lively::rocking,
    ),
    info(
        "lively_seesaws",
        "seesaws",
        "A thousand seesaws with two loads.",
        lively::seesaws,
    ),
    info(
        "lively_platforms",
        "platforms",
        "A hundred platforms go to and fro with five boxes each: to, in this scene.",
        lively::platforms,
    ),
    info(
        "lively_dominoes",
        "dominoes",
        "Rows of dominoes, the first of each pushed.",
        lively::dominoes,
    ),
    info(
        "lively_tiles",
        "tiles",
        "Five hundred bodies slide over tiles without friction.",
        lively::tiles,
    ),
    info(
        "lively_lively_pyramid",
        "lively_pyramid",
        "A pyramid of forty rows with restitution, hit by falling balls.",
        lively::lively_pyramid,
    ),
    info(
        "lively_disc_heap",
        "disc_heap",
        "Discs alone: 4,000 in a bin.",
        lively::disc_heap,
    ),
    info(
        "lively_clouds",
        "clouds",
        "A cloud of 3,000 bodies without gravity runs into another.",
        lively::clouds,
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
/// or a [growth scene](super::growth_scene) of any size: `grow_pile_2000`; or a [gas](super::spaced_scene) of any
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
    let found = SCENES.iter().find(|info| info.name == full);
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
