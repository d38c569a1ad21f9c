//! Bodies that were put into each other in many random worlds: which overlap by more than was told.
//!
//! ```sh
//! cargo run --release -p carom-tests --example overlaps -- --mode exact --first 1 --count 2000
//! ```

use std::error::Error;
use std::process::ExitCode;

use carom_tests::Runs;
use carom_tests::thrown_together::watch;

/// What a step called exact may leave untold, and any other one, in m.
const UNTOLD: [f64; 2] = [1e-4, 0.02];

fn main() -> ExitCode {
    carom_tests::exit(run())
}

fn run() -> Result<bool, Box<dyn Error>> {
    let mut runs = Runs::new(1_000);
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or("each option has a value")?;
        if !runs.set(&name, &value)? {
            return Err(format!("no option '{name}': --mode --first --count").into());
        }
    }
    let mut sound = true;
    for &mode in runs.modes() {
        let (mut worlds, mut most) = ([0; 2], [0.0_f64; 2]);
        for seed in runs.seeds() {
            let mut broke = [false; 2];
            watch(mode, seed, |found| {
                let (k, off) = (usize::from(!found.exact), found.depth - found.told);
                most[k] = most[k].max(off);
                if off > UNTOLD[k] {
                    println!("{mode:?} {seed}: {found:?}");
                    broke[k] = true;
                }
            });
            for k in [0, 1] {
                worlds[k] += u32::from(broke[k]);
            }
        }
        println!("{mode:?}: {} worlds", runs.count);
        for (k, steps) in ["called exact", "not exact"].into_iter().enumerate() {
            println!(
                "  steps {steps}: at most {:.1e} m untold, over {} m in {} worlds",
                most[k], UNTOLD[k], worlds[k]
            );
        }
        sound &= worlds[0] == 0;
    }
    Ok(sound)
}
