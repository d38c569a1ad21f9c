//! Rigid bodies in the plane: any simple polygon, exact free flight and impacts, contacts, energy, and pictures without a
//! screen.
//!
//! This is the one crate to depend on. Its root has what a simulation needs; the layers below, each a crate of its own, are
//! the modules [`math`], [`geometry`], [`collision`] and [`dynamics`], and with the features of their names `render`
//! (pictures) and `scenes` (scene files in TOML).
//!
//! Everything is `f64`, in SI units and radians; x points right, y up, counter-clockwise is positive. Equal input gives
//! equal bits. A value that exists is valid: constructors say what is wrong, and a step has no error path.
//!
//! # Examples
//! An elastic ball is back where it was dropped.
//! ```
//! use carom::{BodyDef, Circle, ConvexPolygon, Material, Settings, World, vec2};
//!
//! let mut world = World::new(Settings { gravity: vec2(0.0, -10.0), ..Settings::default() })?;   // m/s²
//! let elastic = Material { restitution: 1.0, friction: 0.0, ..Material::default() };
//! world.insert(BodyDef::fixed().at(vec2(0.0, -1.0)), ConvexPolygon::rectangle(20.0, 2.0)?, elastic)?;
//! let ball = world.insert(BodyDef::dynamic().at(vec2(0.0, 5.5)), Circle::new(0.5)?, elastic)?;  // 5 m to fall
//! for _ in 0..120 {
//!     world.step(1.0 / 60.0);                                          // 1 s down, 1 s up
//! }
//! let height = world.body(ball).expect("it stays").centre().y;
//! assert!((height - 5.5).abs() < 1e-12);                               // m
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A hexagon of any density, and what happened to it:
//! ```
//! use carom::{BodyDef, ConvexPolygon, EventKind, Material, Settings, World, vec2};
//!
//! let mut world = World::new(Settings { gravity: vec2(0.0, -9.81), ..Settings::default() })?;
//! let ground = world.insert(BodyDef::fixed(), ConvexPolygon::rectangle(20.0, 1.0)?, Material::default())?;
//! let hexagon = world.insert(
//!     BodyDef::dynamic().at(vec2(0.0, 5.0)).spinning(0.5),             // m, rad/s
//!     ConvexPolygon::regular(6, 0.5)?,                                 // sides, circumradius in m
//!     Material { friction: 0.4, restitution: 0.9, ..Material::default() },
//! )?;
//! let report = world.step(1.0);                                        // s
//! assert!(report.refused.is_none());
//! let struck = world.events().iter().any(|event| {
//!     matches!(event.kind, EventKind::Impact { a, b, .. } if [a, b] == [ground, hexagon] || [b, a] == [ground, hexagon])
//! });
//! assert!(struck);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(
    feature = "render",
    doc = r#"
A picture of it, with the feature `render`:
```
use carom::render::{Camera, Frame, Look, Style};
use carom::{BodyDef, Circle, Material, Settings, World, vec2};

let mut world = World::new(Settings::default())?;
world.insert(BodyDef::dynamic(), Circle::new(0.5)?, Material::default())?;
let camera = Camera::new(vec2(0.0, 0.0), 100.0, 320, 240)?;          // m, px/m, px
let picture = Frame::capture(&world, &Look::default(), &camera).paint(&Style::light());
assert_eq!(picture.size().to_string(), "320 x 240");
let png = picture.to_png();                                          // or picture.save_png(path)
# assert!(png.starts_with(b"\x89PNG"));
# Ok::<(), Box<dyn std::error::Error>>(())
```
"#
)]
//!
//! # Features
//! All are off by default.
//!
//! | feature | brings |
//! |---|---|
//! | `render` | the module `render`: PNG, APNG, SVG, Y4M and charts, without a screen |
//! | `scenes` | the module `scenes`: scene files and the built-in scenes; implies `render` |
//! | `parallel` | without effect: no method shares its work among threads yet |
//! | `mint` | vectors from and to those of other libraries |
//! | `serde` | shapes, poses, materials and settings can be written and read; what is read is checked by the same constructors |
//!
//! # Stability
//! Before 1.0 a minor version (0.2) may break callers and a patch version (0.1.1) does not; the changelog names each break. Enums
//! and records that will grow are `non_exhaustive`. The bits of a simulation may change with any version. The lowest
//! Rust version is 1.89; a higher one is a minor version. [`Vec2`] is `DVec2` of glam 0.34: glam is part of the public
//! interface, so a new version of glam is a minor version of carom, and [`math::glam`] is the one that fits.

pub use carom_collision as collision;
pub use carom_dynamics as dynamics;
pub use carom_geometry as geometry;
pub use carom_math as math;
#[cfg(feature = "render")]
pub use carom_render as render;
#[cfg(feature = "scenes")]
pub use carom_scenes as scenes;

pub use carom_collision::{Motion, ShapeTree};
pub use carom_dynamics::{
    Body, BodyDef, BodyError, BodyId, BodyKind, Contact, ContactMode, ContactPoint, EnergyLedger,
    Event, EventKind, Events, Field, Filter, Filtered, Force, ImpactLaw, Impulse, Material, Mode,
    Momentum, Nearest, NewtonianCentre, PairMaterial, PairSearch, RadialField, RayHit, Refusal,
    Settings, SettingsError, Several, ShapeHit, Sleep, Softness, StepProfile, StepReport,
    WORLD_LIMIT, World,
};
pub use carom_geometry::{
    Aabb, AreaProperties, Circle, Compound, ConvexPolygon, HalfPlane, MassProperties, Outline,
    Polygon, PolygonError, Region, RegionError, Segment, Shape, ShapeError,
};
pub use carom_math::{Pose, Rot, SimTime, Vec2, cross, vec2};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
