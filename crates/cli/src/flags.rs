//! The commands and their flags.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use crate::sweep::{Axis, Column};
use crate::values::{KeyValue, Seconds, Shard, parse_rate, parse_size};

// `{carom}` stands for the program that was called: see `crate::named`.

/// What can be done with a scene, and with a polygon.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw a scene: numbered PNG frames, an APNG or a Y4M film
    Render(RenderArgs),
    /// Join the slices of `render --shard` into one folder, or those of `sweep --shard` into one table, after checking them
    Merge(MergeArgs),
    /// Compute a scene without pictures: trajectories as CSV
    Simulate(SimulateArgs),
    /// Compute all combinations of settings of a scene on all cores: a row a run, as CSV
    Sweep(SweepArgs),
    /// Area, centroid, moments and principal axes of a polygon
    Inertia(InertiaArgs),
    /// The built-in scenes, a line each
    List,
    /// Whether a scene is valid, and what it costs: bodies, vertices, pixels, bytes
    Check(CheckArgs),
}

/// A scene to be drawn.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    {carom} render thesis --seconds 10 --out out/thesis\n  \
    {carom} render flying-balls --set n=50 --format apng --size 640x480\n  \
    {carom} render my-scene.toml --fps 30 --resume\n  \
    {carom} render pile --format y4m --out - | ffmpeg -i - pile.mp4\n  \
    {carom} render pile --shard 2/4      # on four machines; then: {carom} merge DIR... --out DIR\n\n\
    Overlays: velocities, centroids, contacts, impulses, flashes, boxes, groups, asleep, overlaps, trails, field,\n  \
    field-lines, restitution, gravity, time, counters, caption; all; none (what the scene asks for goes too).\n\
    Frame k shows the instant k / fps. The bytes of a frame do not depend on --threads.")]
pub struct RenderArgs {
    /// Scene file (TOML) or the name of a built-in scene (`{carom} list`)
    pub scene: String,
    /// Folder for the frames; made if it is missing; - for a Y4M film to stdout [default: out/ and the name of the scene]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Simulated seconds to draw [default: the scene's duration]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub seconds: Option<Seconds>,
    /// Frames per simulated second, 1 to 1000 [default: the scene's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_rate)]
    pub fps: Option<u32>,
    /// Size of a frame in pixels [default: the scene's camera]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<(u32, u32)>,
    /// What to write
    #[arg(long, value_enum, default_value_t = Format::Png)]
    pub format: Format,
    /// How hard pictures are packed
    #[arg(long, value_enum, default_value_t = PackingFlag::Fast)]
    pub packing: PackingFlag,
    /// What is drawn over the bodies, beside what the scene asks for; several with commas
    #[arg(
        long,
        value_enum,
        value_name = "NAME,...",
        value_delimiter = ',',
        hide_possible_values = true
    )]
    pub overlay: Vec<OverlayFlag>,
    /// Ink and ground [default: the scene's]
    #[arg(long, value_enum)]
    pub style: Option<StyleFlag>,
    /// How bodies are moved [default: the scene's]
    #[arg(long, value_enum)]
    pub mode: Option<ModeFlag>,
    /// Replaces a value of the scene: n=50, gravity=[0,-1], settings.substep=0.002, body.ball.mass=3; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<KeyValue>,
    /// Threads that draw and encode [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Keep the frames of an earlier run with the same scene and flags, draw the missing ones; a film is drawn anew
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Replace the frames that an earlier run wrote into the folder
    #[arg(long)]
    pub force: bool,
    /// Draw the I-th of N slices of the frames (I from 1), for `merge`
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
}

/// Slices to be joined.
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  \
    {carom} render thesis --shard 1/2 --out a\n  \
    {carom} render thesis --shard 2/2 --out b\n  \
    {carom} merge a b --out thesis\n\n\
    The slices are read only. What comes out is what one run would have written, bit for bit.")]
pub struct MergeArgs {
    /// The folders (or tables of a sweep) of all slices, in any order
    #[arg(required = true, value_name = "DIR|FILE.csv")]
    pub dirs: Vec<PathBuf>,
    /// Folder for all frames, or file for all rows [default: out/merged, out/merged.csv]
    #[arg(long, value_name = "DIR|FILE.csv")]
    pub out: Option<PathBuf>,
    /// Replace the frames that an earlier run wrote into the folder
    #[arg(long)]
    pub force: bool,
}

/// A scene to be computed many times.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    {carom} sweep throw.toml --set body.ball.mass=1:10:100 --report energy,impacts,body.ball.x --out sweep.csv\n  \
    {carom} sweep throw.toml --set gravity=\"[0,-9.81]\",\"[0,-1.62]\" --seeds 1000 --report energy > sweep.csv\n  \
    {carom} sweep throw.toml --seeds 10000 --report impacts --shard 3/64 --out part3.csv   # then: {carom} merge part*.csv --out all.csv\n\n\
    Columns: run (from 0), runs, what is set, seed, what is reported at the end of each run: energy, kinetic, potential (J),\n  \
    impacts, overlap (m), exact, hash, body.NAME. and x, y (m), angle (rad), vx, vy (m/s), omega (rad/s).\n\
    The bytes do not depend on --jobs. Rows are in FILE.csv.part until all are there.")]
pub struct SweepArgs {
    /// Scene file (TOML) or the name of a built-in scene (`{carom} list`)
    pub scene: String,
    /// Values of a key of the scene: from:to:count, or a list with commas; may be repeated: all combinations are run
    #[arg(long, value_name = "KEY=VALUES")]
    pub set: Vec<Axis>,
    /// Runs of each combination, with the seeds 0, 1, …
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub seeds: Option<u64>,
    /// Simulated seconds of a run [default: the scene's duration]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub seconds: Option<Seconds>,
    /// What is reported of each run; several with commas
    #[arg(
        long,
        value_name = "NAME,...",
        value_delimiter = ',',
        default_value = "energy,impacts,exact"
    )]
    pub report: Vec<Column>,
    /// How bodies are moved [default: the scene's]
    #[arg(long, value_enum)]
    pub mode: Option<ModeFlag>,
    /// File for the table, replaced if it exists; - for stdout [default: stdout]
    #[arg(long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
    /// Runs at a time [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Go on with the rows that an interrupted sweep of the same runs left in FILE.csv.part; the last one is computed anew, and compared
    #[arg(long, requires = "out", conflicts_with = "force")]
    pub resume: bool,
    /// Begin anew, whatever an interrupted sweep left
    #[arg(long)]
    pub force: bool,
    /// Do the I-th of N slices of the runs (I from 1), for `merge`
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
}

/// A scene to be computed.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    {carom} simulate thesis --seconds 10 > thesis.csv\n  \
    {carom} simulate flying-balls --seconds 60 --every 0.1 --out balls.csv --json balls.json\n\n\
    Columns: time (s), body (its name), x, y (m, centre of mass), angle (rad, unwrapped), vx, vy (m/s), omega (rad/s).\n\
    Every number has as many digits as it takes to read the same double back.")]
pub struct SimulateArgs {
    /// Scene file (TOML) or the name of a built-in scene (`{carom} list`)
    pub scene: String,
    /// Simulated seconds
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub seconds: Seconds,
    /// Seconds between two samples [default: 1/60]
    #[arg(long, value_name = "DT", allow_negative_numbers = true)]
    pub every: Option<Seconds>,
    /// How bodies are moved [default: the scene's]
    #[arg(long, value_enum)]
    pub mode: Option<ModeFlag>,
    /// File for the trajectories, replaced if it exists; - for stdout [default: stdout]
    #[arg(long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
    /// File for the summary
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Replaces a value of the scene: n=50, gravity=[0,-1], settings.substep=0.002, body.ball.mass=3; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<KeyValue>,
}

/// A polygon to be weighed.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    {carom} inertia \"0,0 2,0 2,1 0,1\" --density 3\n  \
    {carom} inertia --file outline.txt --mass 12\n\n\
    A file holds a vertex x,y (or x y) a line; `#` begins a comment.")]
pub struct InertiaArgs {
    /// The vertices in order, either way round, in m: "x,y x,y x,y"
    #[arg(
        required_unless_present = "file",
        conflicts_with = "file",
        allow_hyphen_values = true
    )]
    pub vertices: Option<String>,
    /// Mass per area, in kg/m²; 1 if neither this nor a mass is given
    #[arg(
        long,
        value_name = "D",
        conflicts_with = "mass",
        allow_negative_numbers = true
    )]
    pub density: Option<f64>,
    /// Mass of the whole polygon, in kg
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub mass: Option<f64>,
    /// Reads the vertices from a file
    #[arg(long, value_name = "F")]
    pub file: Option<PathBuf>,
}

/// A scene to be looked at.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  {carom} check my-scene.toml\n  {carom} check flying-balls --set n=50\n\n\
    A scene that is not valid gets one line with file, line, column and field, and exit code 2."
)]
pub struct CheckArgs {
    /// Scene file (TOML) or the name of a built-in scene (`{carom} list`)
    pub scene: String,
    /// Replaces a value of the scene: n=50, gravity=[0,-1], settings.substep=0.002, body.ball.mass=3; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<KeyValue>,
}

/// What `render` writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A numbered PNG file a frame
    Png,
    /// A numbered SVG file a frame
    Svg,
    /// One animated PNG, which browsers play
    Apng,
    /// One uncompressed film, which ffmpeg reads
    Y4m,
    /// Twelve frames on one picture
    Sheet,
}

/// What is drawn over, beneath and beside the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OverlayFlag {
    /// Nothing of what the scene asks for
    None,
    /// All of the following
    All,
    /// An arrow along each velocity
    Velocities,
    /// A dot at each centre of mass
    Centroids,
    /// Contact points with their normals
    Contacts,
    /// An arrow along each impulse
    Impulses,
    /// A burst at each impact
    Flashes,
    /// Bounding boxes
    Boxes,
    /// Bodies that touch each other in one colour
    Groups,
    /// Sleepers paler
    Asleep,
    /// Where bodies lie in each other, and how deep
    Overlaps,
    /// Paths of the last seconds
    Trails,
    /// The circle of a field
    Field,
    /// Lines along gravity and fields
    FieldLines,
    /// The bar of restitution
    Restitution,
    /// The arrow of gravity
    Gravity,
    /// The simulated time
    Time,
    /// Bodies, contacts, impacts, energy
    Counters,
    /// The scene's caption
    Caption,
}

/// Ink and ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StyleFlag {
    /// Dark ink on white
    Light,
    /// Light ink on a night ground
    Dark,
    /// Black ink on white, pale bodies
    Print,
}

/// How hard pictures are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PackingFlag {
    /// Twenty times faster, for a third more bytes
    Fast,
    /// As small as is reasonable
    Small,
}

/// How a world moves its bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ModeFlag {
    /// Each group of bodies the cheapest method that is right for it
    Hybrid,
    /// Closed forms; what they cannot finish marks the run as not exact
    Exact,
    /// Every moving body is sub-stepped
    Stepped,
}
