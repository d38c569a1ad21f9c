//! Many random scenes of free flight, the world against a search of all pairs, event by event.
//!
//! ```sh
//! cargo run --release -p carom-tests --example flights -- --first 1 --count 10000
//! ```

use std::error::Error;
use std::process::ExitCode;

use carom_dynamics::Mode;
use carom_tests::flights::play;

fn main() -> ExitCode {
    carom_tests::exit(run())
}

fn run() -> Result<bool, Box<dyn Error>> {
    let (mut first, mut count) = (1_u64, 1000_u64);
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or("each option has a value")?;
        match name.as_str() {
            "--first" => first = value.parse()?,
            "--count" => count = value.parse()?,
            _ => return Err(format!("no option '{name}': --first --count").into()),
        }
    }
    let mut sound = true;
    for mode in [Mode::Exact, Mode::Hybrid] {
        let (mut wrong, mut impacts, mut events) = (0, 0, 0);
        for seed in first..first.saturating_add(count) {
            match play(mode, seed) {
                Ok(seen) => {
                    impacts += seen.impacts;
                    events += seen.events;
                }
                Err(told) => {
                    wrong += 1;
                    println!("{mode:?} {seed}: {told}");
                }
            }
        }
        println!(
            "{mode:?}: {wrong} of {count} scenes differ; {impacts} impacts, {events} events compared"
        );
        sound &= wrong == 0;
    }
    Ok(sound)
}
