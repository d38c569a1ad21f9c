//! Scenes of any number of bodies, as dense at 200 as at 200,000: how the cost of a step grows.

use core::fmt;
use core::str::FromStr;

use carom_math::{Vec2, vec2};

use super::gas::{closed_box, random_body};
use super::harness::{Harness, area_and_centroid};
use super::{PlainBody, PlainKind, PlainScene, PlainShape};

/// Most bodies of a growth scene.
pub const MAX_GROWTH: u32 = 1_000_000;

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum GrowthKind {
    /// Ten courses of stones in a bin, at rest but for a gap of 1/4096 m: lasting contacts.
    Pile,
    /// Elastic discs and polygons in a closed box, as in scene e: impacts.
    Gas,
    /// Discs 5 m apart in free fall, as in scene i: no two meet.
    Free,
}

impl GrowthKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Pile, Self::Gas, Self::Free];

    /// As it stands in a scene's name: `pile` in `grow_pile_2000`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pile => "pile",
            Self::Gas => "gas",
            Self::Free => "free",
        }
    }
}

impl fmt::Display for GrowthKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for GrowthKind {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|kind| kind.name() == name);
        let known = || format!("{name}: unknown growth; there are pile, gas, free");
        found.ok_or_else(known)
    }
}

/// A scene of `bodies` dynamic bodies (1 to [`MAX_GROWTH`], else the nearest of these), named `grow_pile_2000`.
///
/// # Examples
/// ```
/// use carom_scenes::{GrowthKind, PlainKind, growth_scene, plain_scene};
/// let scene = growth_scene(GrowthKind::Gas, 500);
/// let moving = scene.bodies.iter().filter(|body| body.kind == PlainKind::Dynamic);
/// assert_eq!(moving.count(), 500);
/// assert_eq!(plain_scene("grow_gas_500"), Some(scene));
/// ```
#[must_use]
pub fn growth_scene(kind: GrowthKind, bodies: u32) -> PlainScene {
    let bodies = bodies.clamp(1, MAX_GROWTH);
    let name = format!("grow_{kind}_{bodies}");
    match kind {
        GrowthKind::Pile => pile(&name, bodies),
        GrowthKind::Gas => gas(&name, bodies),
        GrowthKind::Free => free(&name, bodies),
    }
}

/// Kind and number of a name like `grow_pile_2000`; no other spelling, and no number out of range.
pub(crate) fn growth_of(name: &str) -> Option<(GrowthKind, u32)> {
    let (kind, number) = name.strip_prefix("grow_")?.split_once('_')?;
    let bodies: u32 = number.parse().ok()?;
    let plain = (1..=MAX_GROWTH).contains(&bodies) && bodies.to_string() == number;
    plain.then_some((kind.parse().ok()?, bodies))
}

/// Courses of a pile.
const COURSES: u32 = 10;
/// Height of a course, in m.
const COURSE: f64 = 0.5;
/// Between stones of a course, and between courses, in m.
const JOINT: f64 = 1.0 / 128.0;
const BED: f64 = 1.0 / 4096.0;

/// A dry wall between the sides of a bin: stones of random length with slanting ends, about a metre each.
///
/// Every stone lies on one to three others, so that contacts form no regular grid, and all last from the start. The
/// last course takes the stones that remain.
fn pile(name: &str, bodies: u32) -> PlainScene {
    let mut scene = PlainScene::empty(name, vec2(0.0, -10.0)).steps(30, 100);
    scene.material(1.0, 0.6, 0.0);
    let of_course = bodies.div_ceil(COURSES);
    let half = 0.5 * f64::from(of_course);
    let high = f64::from(COURSES) * (COURSE + BED);
    scene.region = Some([vec2(-half - 0.5, -0.5), vec2(half + 0.5, high + 0.5)]);
    scene.bin(half, 0.5, high);
    let mut random = Harness::new(42, &[]);
    // Where the present joint meets the bottom and the top of its course: straight along the sides of the bin.
    let mut left = (-half, -half);
    for i in 0..bodies {
        let (course, place) = (f64::from(i / of_course), i % of_course);
        let right = if place + 1 == of_course {
            (half, half)
        } else {
            let middle = f64::from(place + 1) - half + random.between(-0.25, 0.25);
            let slant = random.between(-0.1, 0.1);
            (middle + slant, middle - slant)
        };
        let bottom = course * (COURSE + BED) + BED;
        let corners = [
            vec2(left.0 + 0.5 * JOINT, bottom),
            vec2(right.0 - 0.5 * JOINT, bottom),
            vec2(right.1 - 0.5 * JOINT, bottom + COURSE),
            vec2(left.1 + 0.5 * JOINT, bottom + COURSE),
        ];
        stone(&mut scene, &corners);
        left = if place + 1 == of_course {
            (-half, -half)
        } else {
            right
        };
    }
    scene
}

/// A resting body of these corners.
fn stone(scene: &mut PlainScene, corners: &[Vec2]) {
    // About a corner first: the shoelace of a place far out loses digits.
    let near: Vec<Vec2> = corners.iter().map(|&corner| corner - corners[0]).collect();
    let centroid = area_and_centroid(&near).1;
    let about = near.into_iter().map(|corner| corner - centroid).collect();
    let body = PlainBody::new(PlainKind::Dynamic, corners[0] + centroid, 0);
    scene.add(body, PlainShape::Polygon(about));
}

/// The bodies of scene e on a square grid of 1.3 m.
fn gas(name: &str, bodies: u32) -> PlainScene {
    let side = side_of(bodies);
    let half = 0.5 * f64::from(side - 1) * 1.3;
    let mut scene = closed_box(name, half + 1.4, 0.3).steps(30, 100);
    let mut random = Harness::new(42, &[]);
    for i in 0..bodies {
        let at = vec2(f64::from(i % side), f64::from(i / side)) * 1.3 - Vec2::splat(half);
        random_body(&mut scene, &mut random, at);
    }
    scene
}

/// Discs on a square grid of 5 m.
fn free(name: &str, bodies: u32) -> PlainScene {
    let mut scene = PlainScene::empty(name, vec2(0.0, -10.0)).steps(30, 100);
    scene.material(1.0, 0.6, 0.0);
    let disc = scene.shape(PlainShape::Circle { radius: 0.25 });
    let side = side_of(bodies);
    let half = 2.5 * f64::from(side - 1);
    let mut random = Harness::new(42, &[]);
    for i in 0..bodies {
        let at = vec2(f64::from(i % side), f64::from(i / side)) * 5.0 - Vec2::splat(half);
        let body = PlainBody::new(PlainKind::Dynamic, at, 0).moving(random.within(0.1));
        scene.place(body, disc);
    }
    scene
}

/// The least square that holds `bodies`.
fn side_of(bodies: u32) -> u32 {
    let root = bodies.isqrt();
    if root * root < bodies { root + 1 } else { root }
}
