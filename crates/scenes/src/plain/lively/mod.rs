//! Scenes in which much moves, of the kinds that engines are asked for. They are built by rule, no number of them was chosen by what an
//! engine does in them, and the peers of the published scenes were measured in none.

mod driven;
mod groups;
mod heaps;
mod loose;
mod small;

use carom_math::{Vec2, vec2};

use super::harness::Harness;
use super::list::{PlainInfo, info};
use super::{PlainBody, PlainKind, PlainScene, PlainShape};

const GRAVITY: Vec2 = vec2(0.0, -10.0);

static SCENES: [PlainInfo; 32] = [
    info(
        "lively_wall",
        "2,000 bricks in a wall, hit",
        "a wall of 2,000 bricks, hit by a heavy ball",
        heaps::wall,
    ),
    info(
        "lively_falling",
        "4,000 polygons and discs fall",
        "4,000 bodies fall onto a heap",
        heaps::falling,
    ),
    info(
        "lively_sizes",
        "sizes of 1 to 20 in one heap",
        "sizes of 1 to 20 in one heap",
        heaps::sizes,
    ),
    info(
        "lively_compounds",
        "1,000 stars of three triangles fall",
        "compound bodies of three triangles fall onto steps",
        heaps::compounds,
    ),
    info(
        "lively_rods",
        "1,000 long rods fall",
        "long thin rods fall into a bin",
        heaps::rods,
    ),
    info(
        "lively_pyramid",
        "820 boxes with e = 0.3, balls fall on them",
        "a pyramid of forty rows with restitution, hit by falling balls",
        heaps::pyramid,
    ),
    info(
        "lively_disc_heap",
        "4,000 discs fall",
        "discs alone: 4,000 in a bin",
        heaps::disc_heap,
    ),
    info(
        "lively_stirred",
        "three crosses stir 2,000 bodies",
        "three crosses turn in a bin of 2,000 bodies",
        driven::stirred,
    ),
    info(
        "lively_drum_mixed",
        "1,600 polygons and discs in a drum",
        "a drum of mixed bodies",
        driven::drum_mixed,
    ),
    info(
        "lively_drum_letters",
        "900 L shapes in a drum",
        "a drum of L shapes: two boxes each",
        driven::drum_letters,
    ),
    info(
        "lively_junkyard",
        "a plate pushes 2,000 bodies",
        "a plate is driven through a heap of 2,000 bodies, without end",
        driven::junkyard,
    ),
    info(
        "lively_hourglass",
        "2,000 bodies run through a funnel",
        "2,000 discs and polygons run through the neck of a funnel into a bin",
        driven::hourglass,
    ),
    info(
        "lively_explosion",
        "2,000 bodies fly apart in a box",
        "2,000 bodies fly apart from one place in a closed box",
        loose::explosion,
    ),
    info(
        "lively_bouncing",
        "2,000 balls with e = 0.7",
        "balls that bounce on each other in a bin",
        loose::bouncing,
    ),
    info(
        "lively_rack",
        "1,275 discs, struck, e = 0.9",
        "discs without gravity that lose speed when they meet: a broken rack of 1,275",
        loose::rack,
    ),
    info(
        "lively_clouds",
        "two clouds of 1,500 run into each other",
        "a cloud of 1,500 bodies without gravity runs into another",
        loose::clouds,
    ),
    info(
        "lively_pins",
        "1,500 discs fall through pins",
        "discs fall through pins",
        loose::pins,
    ),
    info(
        "lively_slopes",
        "1,500 bodies run down slopes",
        "bodies roll and slide down a stair of slopes of segments",
        loose::slopes,
    ),
    info(
        "lively_landing_stacks",
        "1,000 stacks of five land",
        "a thousand stacks of five land one after the other",
        small::landing_stacks,
    ),
    info(
        "lively_rocking",
        "1,000 boxes rock on their corners",
        "a thousand boxes rock on their corners",
        small::rocking,
    ),
    info(
        "lively_seesaws",
        "1,000 seesaws with two loads",
        "a thousand seesaws with two loads",
        small::seesaws,
    ),
    info(
        "lively_platforms",
        "100 driven platforms with five boxes",
        "a hundred platforms carry five boxes each",
        small::platforms,
    ),
    info(
        "lively_dominoes",
        "1,500 dominoes in ten rows",
        "rows of dominoes, the first of each pushed",
        small::dominoes,
    ),
    info(
        "lively_tiles",
        "500 boxes slide over tiles",
        "five hundred bodies slide over tiles without friction",
        small::tiles,
    ),
    info(
        "lively_cups",
        "200 cups, ten bodies fall into each",
        "cups into each of which ten bodies fall",
        groups::cups,
    ),
    info(
        "lively_tumblers",
        "100 frames turn, ten bodies in each",
        "a hundred frames that turn, with ten bodies in each",
        groups::tumblers,
    ),
    info(
        "lively_towers",
        "100 towers of twelve, a ball hits each",
        "a hundred towers of twelve boxes, hit by a ball each",
        groups::towers,
    ),
    info(
        "lively_cards",
        "300 houses of seven cards fall down",
        "three hundred houses of cards that fall down",
        groups::cards,
    ),
    info(
        "lively_tossed",
        "1,000 polygons roll along a floor",
        "polygons thrown along a floor, which roll",
        groups::tossed,
    ),
    info(
        "lively_spun_bars",
        "1,000 bars come down spinning",
        "bars that come down spinning at up to 40 rad/s",
        groups::spun_bars,
    ),
    info(
        "lively_bullets",
        "500 bullets hit 100 walls of ten",
        "bullets of 100 m/s that hit walls of ten bricks",
        groups::bullets,
    ),
    info(
        "lively_hills",
        "1,500 bodies fall on hills",
        "bodies that rain on hills of 400 segments",
        loose::hills,
    ),
];

/// Scenes in which much moves, in the order of their table.
///
/// # Examples
/// ```
/// use carom_scenes::{lively_scenes, plain_scene};
/// assert!(lively_scenes().iter().all(|info| plain_scene(info.name).is_some()));
/// ```
#[must_use]
pub fn lively_scenes() -> &'static [PlainInfo] {
    &SCENES
}

/// A scene of one material in which bodies may sleep.
pub(super) fn scene(name: &str, gravity: Vec2, material: [f64; 2], steps: u32) -> PlainScene {
    let mut scene = PlainScene::empty(name, gravity).steps(1, steps);
    scene.sleeping = true;
    scene.material(1.0, material[0], material[1]);
    scene
}

pub(super) fn body(kind: PlainKind, x: f64, y: f64) -> PlainBody {
    PlainBody::new(kind, vec2(x, y), 0)
}

pub(super) fn moving(at: Vec2) -> PlainBody {
    body(PlainKind::Dynamic, at.x, at.y)
}

/// Place `i` in rows of `columns`, `pitch` apart along x and y, the lowest left one at `corner`.
pub(super) fn grid(i: u32, columns: u32, pitch: [f64; 2], corner: Vec2) -> Vec2 {
    corner + Vec2::from(pitch) * vec2(f64::from(i % columns), f64::from(i / columns))
}

/// A fixed rectangle by its centre, its half extents and its angle.
pub(super) fn slab(scene: &mut PlainScene, [x, y]: [f64; 2], [w, h]: [f64; 2], angle: f64) {
    let at = body(PlainKind::Fixed, x, y).turned(angle);
    scene.add(at, PlainShape::rectangle(w, h));
}

/// Floor at y = 0 and walls at ±`inner`, `height` high.
pub(super) fn bin(scene: &mut PlainScene, inner: f64, height: f64) {
    scene.bin(inner, 1.0, height);
    scene.region = Some([vec2(-inner - 0.5, -0.5), vec2(inner + 0.5, 1e4)]);
}

/// A disc, a rectangle or a polygon about as large as a disc of `radius`.
pub(super) fn mixed(random: &mut Harness, radius: f64) -> PlainShape {
    match random.below(3) {
        0 => PlainShape::Circle { radius },
        1 => PlainShape::rectangle(
            radius * random.between(0.4, 0.7),
            radius * random.between(0.4, 0.7),
        ),
        _ => {
            let corners = 3 + random.below(6);
            PlainShape::Polygon(random.polygon(corners, radius))
        }
    }
}

/// `count` mixed bodies in rows of `columns`, `pitch` apart, the lowest left one at `corner`.
pub(super) fn mixed_rows(
    scene: &mut PlainScene,
    random: &mut Harness,
    count: u32,
    columns: u32,
    pitch: f64,
    corner: Vec2,
) {
    for i in 0..count {
        let at = grid(i, columns, [pitch; 2], corner);
        let radius = pitch * random.between(0.25, 0.45);
        let shape = mixed(random, radius);
        let angle = random.between(0.0, 6.2);
        scene.add(moving(at).turned(angle), shape);
    }
}
