//! Many random closed boxes: how many lost a body, and how many of those their reports called exact.
//!
//! ```sh
//! cargo run --release -p carom-tests --example boxes -- --walls segments --plates --changes --count 1000
//! cargo run --release -p carom-tests --example boxes -- --walls zigzag --mode hybrid --first 7 --trace
//! ```

use std::error::Error;
use std::process::ExitCode;

use carom_dynamics::Mode;
use carom_tests::Runs;
use carom_tests::boxes::{Extra, Kind, Seen, Walls, watch};

const OPTIONS: &str = "--mode hybrid|exact|stepped --walls segments|blocks|half-planes|zigzag \
    --first SEED --count SEEDS --trace \
    --plates --slivers --changes --paddles --fast --elastic --weightless --uneven";

struct Options {
    runs: Runs,
    walls: Vec<Walls>,
    extras: Vec<Extra>,
    /// Print each step of the first seed, and no other.
    trace: bool,
}

fn main() -> ExitCode {
    carom_tests::exit(run())
}

fn run() -> Result<bool, Box<dyn Error>> {
    let options = Options::read()?;
    let mut sound = true;
    for walls in &options.walls {
        let kind = Kind {
            walls: *walls,
            extras: &options.extras,
        };
        for mode in options.runs.modes() {
            sound &= count(*mode, kind, &options);
        }
    }
    Ok(sound)
}

/// Plays all seeds, and prints which lost a body; whether none did.
fn count(mode: Mode, kind: Kind<'_>, options: &Options) -> bool {
    let (mut lost, mut exact) = (0, 0);
    for seed in options.runs.seeds() {
        let look = |seen: &Seen<'_>| {
            if options.trace {
                print(seen);
            }
        };
        if let Err(escape) = watch(mode, kind, seed, look) {
            lost += 1;
            exact += u64::from(escape.exact);
            println!("{mode:?} {kind:?} {seed}: {escape}");
        }
    }
    println!(
        "{mode:?} {kind:?}: {lost} of {} lost a body, {exact} of them called exact",
        options.runs.count
    );
    lost == 0
}

fn print(seen: &Seen<'_>) {
    let time = seen.world.time().as_secs();
    let bodies = seen.inside.iter().filter_map(|id| seen.world.body(*id));
    if let Some(change) = seen.change {
        println!("{change:?}");
    }
    println!(
        "{time:.4} s, exact: {}, deepest overlap told {:.1e} m",
        seen.report.is_exact(),
        seen.report.deepest_overlap
    );
    for body in bodies {
        let sleeps = if body.is_asleep() { ", asleep" } else { "" };
        println!(
            "  {} {:?} at {} turned {:.4}, {} m/s, {:.4} rad/s{sleeps}",
            body.id(),
            body.kind(),
            body.centre(),
            body.angle(),
            body.velocity(),
            body.angular_velocity()
        );
        if time == 0.0 {
            for (shape, material) in body.shapes() {
                println!("    {shape:?} {material:?}");
            }
        }
    }
}

impl Options {
    fn read() -> Result<Self, Box<dyn Error>> {
        let mut options = Self {
            runs: Runs::new(100),
            walls: Vec::new(),
            extras: Vec::new(),
            trace: false,
        };
        let mut arguments = std::env::args().skip(1);
        while let Some(name) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{name} has a value"));
            match name.as_str() {
                "--mode" | "--first" | "--count" => {
                    options.runs.set(&name, &value()?)?;
                }
                "--walls" => options.walls.push(walls(&value()?)?),
                "--trace" => options.trace = true,
                _ => options.extras.push(extra(&name)?),
            }
        }
        if options.trace {
            options.runs.count = 1;
        }
        if options.walls.is_empty() {
            options.walls = Walls::ALL.to_vec();
        }
        Ok(options)
    }
}

fn walls(name: &str) -> Result<Walls, String> {
    match name {
        "segments" => Ok(Walls::Segments),
        "blocks" => Ok(Walls::Blocks),
        "half-planes" => Ok(Walls::HalfPlanes),
        "zigzag" => Ok(Walls::Zigzag),
        _ => Err(format!("no walls '{name}': {OPTIONS}")),
    }
}

/// An option that is called as the variant is.
fn extra(option: &str) -> Result<Extra, String> {
    let named = |extra: &Extra| option == format!("--{extra:?}").to_lowercase();
    let found = Extra::ALL.into_iter().find(named);
    found.ok_or_else(|| format!("no option '{option}': {OPTIONS}"))
}
