//! The tables of a scene file, as they are written. What they may hold is checked when a scene is built.

mod body;
mod filter;
mod generate;
mod settings;
mod shape;
mod value;

use std::collections::BTreeMap;

use serde::Deserialize;

pub(crate) use body::{BodyTable, Kind, MaterialChoice, MaterialTable};
pub(crate) use filter::{FilterTable, PairTable};
pub(crate) use generate::{
    GridTable, PlainTable, PopulationTable, PyramidTable, RandomShape, StackTable, WallsTable,
};
pub(crate) use settings::{LawName, ModeName, PairsName, SettingsTable, SeveralName, SleepChoice};
pub(crate) use shape::ShapeTable;
pub(crate) use value::{Corners, Pixels, Point, Range};

/// The parameters of the original program, which `--set` takes without a table's name.
pub(crate) const PARAMETERS: [&str; 10] = [
    "n",
    "radius",
    "v",
    "fconst",
    "fnewt",
    "delta",
    "restitution",
    "collisions",
    "stats",
    "face",
];

/// A whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneFile {
    /// Checked before anything else is read.
    #[serde(rename = "version")]
    pub(crate) _version: u32,
    #[serde(default)]
    pub(crate) name: Option<String>,
    #[serde(default)]
    pub(crate) description: String,
    #[serde(default)]
    pub(crate) seed: u64,
    #[serde(default = "ten_seconds")]
    pub(crate) duration: f64,
    #[serde(default = "thirty")]
    pub(crate) fps: u32,
    #[serde(default)]
    pub(crate) gravity: Option<Point>,
    #[serde(default)]
    pub(crate) settings: SettingsTable,
    #[serde(default)]
    pub(crate) parameters: ParametersTable,
    #[serde(default)]
    pub(crate) camera: CameraTable,
    #[serde(default)]
    pub(crate) look: LookTable,
    #[serde(default)]
    pub(crate) materials: BTreeMap<String, MaterialTable>,
    #[serde(default)]
    pub(crate) field: Vec<FieldTable>,
    #[serde(default)]
    pub(crate) plain: Option<PlainTable>,
    #[serde(default)]
    pub(crate) walls: Option<WallsTable>,
    #[serde(default)]
    pub(crate) body: Vec<BodyTable>,
    #[serde(default)]
    pub(crate) stack: Vec<StackTable>,
    #[serde(default)]
    pub(crate) pyramid: Vec<PyramidTable>,
    #[serde(default)]
    pub(crate) grid: Vec<GridTable>,
    #[serde(default)]
    pub(crate) population: Vec<PopulationTable>,
    #[serde(default)]
    pub(crate) pair: Vec<PairTable>,
}

impl SceneFile {
    /// Every name that is given: the list that it is in, the number there, the name.
    pub(crate) fn names(&self) -> impl Iterator<Item = (&'static str, usize, &str)> {
        let bodies = self.body.iter().map(|body| body.name.as_deref());
        let bodies = bodies
            .enumerate()
            .filter_map(|(index, name)| name.map(|name| ("body", index, name)));
        let stacks = self.stack.iter().map(|stack| stack.name.as_str());
        let pyramids = self.pyramid.iter().map(|pyramid| pyramid.name.as_str());
        let grids = self.grid.iter().map(|grid| grid.name.as_str());
        let populations = self
            .population
            .iter()
            .map(|population| population.name.as_str());
        bodies
            .chain(
                stacks
                    .enumerate()
                    .map(|(index, name)| ("stack", index, name)),
            )
            .chain(
                pyramids
                    .enumerate()
                    .map(|(index, name)| ("pyramid", index, name)),
            )
            .chain(grids.enumerate().map(|(index, name)| ("grid", index, name)))
            .chain(
                populations
                    .enumerate()
                    .map(|(index, name)| ("population", index, name)),
            )
    }
}

fn ten_seconds() -> f64 {
    10.0
}

fn thirty() -> u32 {
    30
}

/// `[parameters]`: the original program's names for things that stand elsewhere in the file.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct ParametersTable {
    pub(crate) n: Option<u64>,
    pub(crate) radius: Option<Range>,
    pub(crate) v: Option<Range>,
    pub(crate) fconst: Option<Point>,
    pub(crate) fnewt: Option<f64>,
    pub(crate) delta: Option<f64>,
    pub(crate) restitution: Option<f64>,
    pub(crate) collisions: Option<PairsName>,
    pub(crate) stats: Option<bool>,
    pub(crate) face: Option<String>,
}

/// `[camera]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct CameraTable {
    pub(crate) centre: Option<Point>,
    pub(crate) height: Option<f64>,
    pub(crate) fit: Option<Corners>,
    pub(crate) size: Pixels,
    pub(crate) background: Option<String>,
}

impl Default for CameraTable {
    fn default() -> Self {
        Self {
            centre: None,
            height: None,
            fit: None,
            size: Pixels {
                width: 800,
                height: 600,
            },
            background: None,
        }
    }
}

/// `[look]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct LookTable {
    pub(crate) theme: ThemeName,
    pub(crate) palette: Option<u64>,
    pub(crate) shaded: bool,
    pub(crate) spokes: Option<bool>,
    pub(crate) face: Option<String>,
    pub(crate) centroids: bool,
    pub(crate) velocities: bool,
    pub(crate) velocity_scale: Option<f64>,
    pub(crate) contacts: bool,
    pub(crate) boxes: bool,
    pub(crate) asleep: bool,
    pub(crate) time: bool,
    pub(crate) gravity: bool,
    pub(crate) restitution: bool,
    pub(crate) field: bool,
    pub(crate) counters: bool,
    pub(crate) stats: bool,
    pub(crate) caption: String,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ThemeName {
    #[default]
    Light,
    Dark,
}

/// `[[field]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FieldTable {
    /// One kind so far; it is written so that files stay clear when there are more.
    #[serde(rename = "kind")]
    pub(crate) _kind: FieldKind,
    pub(crate) centre: Point,
    pub(crate) strength: f64,
    pub(crate) core: f64,
    /// Whether the core is a fixed disc that bodies bounce off.
    #[serde(default)]
    pub(crate) solid: bool,
    #[serde(default)]
    pub(crate) material: MaterialChoice,
    #[serde(default)]
    pub(crate) colour: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum FieldKind {
    Radial,
}
