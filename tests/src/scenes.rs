//! Small worlds that many tests begin with.

use carom_dynamics::{BodyDef, BodyId, Material, Mode, Settings, World};
use carom_geometry::{Circle, Compound, ConvexPolygon, HalfPlane, Polygon, Segment, Shape};
use carom_math::{Pose, Vec2, trig, vec2};

use crate::gas::numbers;

/// A built-in scene, as it is.
///
/// # Panics
/// If there is none of that name.
#[must_use]
pub fn built(name: &str) -> World {
    carom_scenes::find(name)
        .and_then(|scene| scene.build())
        .expect("a built-in scene builds")
        .world
}

/// A built-in scene in stepped mode.
///
/// # Panics
/// If there is none of that name.
#[must_use]
pub fn built_stepped(name: &str) -> World {
    let mut scene = carom_scenes::find(name).expect("a built-in scene");
    scene.set("settings.mode", "stepped").expect("a mode");
    scene.build().expect("a built-in scene builds").world
}

/// An empty world in stepped mode.
///
/// # Panics
/// If a setting is out of its range.
#[must_use]
pub fn stepped(settings: Settings) -> World {
    World::new(Settings {
        mode: Mode::Stepped,
        ..settings
    })
    .expect("valid settings")
}

/// An empty world in exact mode, with the settings as they come.
///
/// # Panics
/// Never.
#[must_use]
pub fn exact() -> World {
    World::new(Settings {
        mode: Mode::Exact,
        ..Settings::default()
    })
    .expect("valid settings")
}

/// A fixed floor of 40 m with its top at y = 0.
pub fn floor(world: &mut World, material: Material) -> BodyId {
    let def = BodyDef::fixed().at(vec2(0.0, -1.0));
    put(world, def, block(40.0, 2.0), material)
}

/// A world with a fixed floor of 6 m at y = 0 that has no thickness.
///
/// # Panics
/// If a setting is out of its range.
#[must_use]
pub fn on_a_segment(mode: Mode, material: Material) -> World {
    let mut world = World::new(Settings {
        mode,
        ..Settings::default()
    })
    .expect("valid settings");
    let floor = Segment::new(vec2(-3.0, 0.0), vec2(3.0, 0.0)).expect("a segment");
    put(&mut world, BodyDef::fixed(), floor, material);
    world
}

/// A box of 1 m.
pub fn boxed(world: &mut World, at: Vec2, material: Material) -> BodyId {
    put(world, BodyDef::dynamic().at(at), block(1.0, 1.0), material)
}

/// Boxes of 1 m on each other, from the ground up.
pub fn column(world: &mut World, count: u32, material: Material) -> Vec<BodyId> {
    let heights = (0..count).map(|k| 0.5 + f64::from(k));
    heights
        .map(|y| boxed(world, vec2(0.0, y), material))
        .collect()
}

/// A body.
///
/// # Panics
/// If the world refuses it.
pub fn put(world: &mut World, def: BodyDef, shape: impl Into<Shape>, material: Material) -> BodyId {
    world.insert(def, shape, material).expect("a valid body")
}

/// A world in which everything falls at 10 m/s², within half-planes: a box of half sides `half` (m) about the origin.
///
/// # Panics
/// If `half` is not finite.
#[must_use]
pub fn walled(mode: Mode, half: Vec2, material: Material) -> World {
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -10.0),
        mode,
        ..Settings::default()
    })
    .expect("valid settings");
    for outward in [Vec2::Y, -Vec2::Y, Vec2::X, -Vec2::X] {
        let wall = HalfPlane::new(-outward * half, outward).expect("a wall");
        put(&mut world, BodyDef::fixed(), wall, material);
    }
    world
}

/// How far the deepest corner or rim of what is bounded is outside the walls of [`walled`], in m; 0 if nothing is.
#[must_use]
pub fn outside(world: &World, half: Vec2) -> f64 {
    let mut deepest = 0.0;
    for body in world.bodies() {
        let pose = body.pose();
        for (shape, _) in body.shapes().filter(|(shape, _)| shape.is_bounded()) {
            let rim = match shape {
                Shape::Circle(disc) => disc.radius(),
                _ => 0.0,
            };
            for vertex in shape.vertices() {
                let over = pose.point(*vertex).abs() - half;
                deepest = f64::max(deepest, over.max_element() + rim);
            }
        }
    }
    deepest
}

/// A surface by its restitution and friction.
#[must_use]
pub fn surface(restitution: f64, friction: f64) -> Material {
    Material {
        friction,
        restitution,
        ..Material::default()
    }
}

/// A rectangle about its centre.
///
/// # Panics
/// If a side is not above 0.
#[must_use]
pub fn block(width: f64, height: f64) -> ConvexPolygon {
    ConvexPolygon::rectangle(width, height).expect("a rectangle")
}

/// A disc about its centre.
///
/// # Panics
/// If the radius is not above 0.
#[must_use]
pub fn disc(radius: f64) -> Circle {
    Circle::new(radius).expect("a disc")
}

/// A C about its centre: walls around a hollow of 3 m, with a gap of 1 m.
///
/// # Panics
/// Never.
#[must_use]
pub fn hollow() -> Polygon {
    let corners = [
        (-2.0, -2.0),
        (2.0, -2.0),
        (2.0, 2.0),
        (0.5, 2.0),
        (0.5, 1.5),
        (1.5, 1.5),
        (1.5, -1.5),
        (-1.5, -1.5),
        (-1.5, 1.5),
        (-0.5, 1.5),
        (-0.5, 2.0),
        (-2.0, 2.0),
    ];
    Polygon::new(corners.map(|(x, y)| vec2(x, y)).to_vec()).expect("a C")
}

/// A ring of eight pieces about its centre, 0.5 m thick; its corners are at 2 m within.
///
/// # Panics
/// Never.
#[must_use]
pub fn octagon() -> Shape {
    let corner = |k: u32, radius: f64| {
        let (sin, cos) = trig::sin_cos(core::f64::consts::TAU * f64::from(k % 8) / 8.0);
        vec2(cos, sin) * radius
    };
    let piece = |k: u32| {
        let corners = [(k, 2.0), (k, 2.5), (k + 1, 2.5), (k + 1, 2.0)];
        let corners = corners.map(|(k, radius)| corner(k, radius)).to_vec();
        let piece = ConvexPolygon::new(corners).expect("a piece of a ring");
        (Shape::from(piece), Pose::IDENTITY)
    };
    Compound::new((0..8).map(piece)).expect("a ring").into()
}

/// Two dozen bodies of many masses, frictions and restitutions that fall between walls on a floor with bumps; `shape` draws
/// theirs from numbers in 0..1.
///
/// # Panics
/// Never.
pub fn heap(world: &mut World, seed: u64, shape: fn(&mut dyn FnMut() -> f64) -> Shape) {
    let mut next = numbers(seed);
    let rough = surface(0.5 * next(), next());
    for (at, size) in [
        (vec2(0.0, -0.5), vec2(8.0, 1.0)),
        (vec2(-3.5, 4.0), vec2(1.0, 10.0)),
        (vec2(3.5, 4.0), vec2(1.0, 10.0)),
    ] {
        let def = BodyDef::fixed().at(at);
        put(world, def, block(size.x, size.y), rough);
    }
    for k in 0..4 {
        let def = BodyDef::fixed().at(vec2(1.6 * f64::from(k) - 2.4, 0.4 * next()));
        put(world, def, disc(0.3 + 0.3 * next()), rough);
    }
    for k in 0..24_u32 {
        let at = vec2(
            1.2 * f64::from(k % 5) - 2.4 + 0.2 * next(),
            1.8 + 1.1 * f64::from(k / 5),
        );
        let def = BodyDef::dynamic()
            .at(at)
            .moving(vec2(2.0 * next() - 1.0, -2.0 * next()))
            .spinning(6.0 * next() - 3.0);
        let material = surface(0.9 * next(), 1.2 * next());
        put(world, def, shape(&mut next), material);
    }
}

/// A disc of 0.25 to 0.5 m.
///
/// # Panics
/// Never.
pub fn any_disc(next: &mut dyn FnMut() -> f64) -> Shape {
    disc(0.25 + 0.25 * next()).into()
}

/// A disc, a block, an arrow or a kite, as wide as that.
///
/// # Panics
/// Never.
pub fn any_shape(next: &mut dyn FnMut() -> f64) -> Shape {
    let corners =
        |list: &[(f64, f64)]| -> Vec<Vec2> { list.iter().map(|(x, y)| vec2(*x, *y)).collect() };
    let kind = 4.0 * next();
    if kind < 1.0 {
        any_disc(next)
    } else if kind < 2.0 {
        block(0.4 + 0.5 * next(), 0.3 + 0.6 * next()).into()
    } else if kind < 3.0 {
        let arrow = [
            (0.35, -0.3),
            (0.35, 0.3),
            (0.0, 0.05),
            (-0.35, 0.3),
            (-0.35, -0.3),
        ];
        Polygon::new(corners(&arrow)).expect("an arrow").into()
    } else {
        let kite = [(0.4, 0.0), (0.1, 0.35), (-0.4, 0.2), (-0.2, -0.4)];
        ConvexPolygon::new(corners(&kite)).expect("a kite").into()
    }
}
