//! Many random scripts, checked after each step: how many broke which law, and their seeds.
//!
//! ```sh
//! cargo run --release -p carom-tests --example calls -- --mode exact --first 1 --count 20000 --limit 2
//! ```

use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use carom_dynamics::Mode;
use carom_tests::Runs;
use carom_tests::checks::Fault;
use carom_tests::scripts::{End, play};

const CLASSES: [&str; 7] = [
    "over the time limit",
    "escapes",
    "missed, and called exact",
    "gains of energy",
    "losses of momentum",
    "standstills",
    "panics",
];

fn main() -> ExitCode {
    carom_tests::exit(run())
}

fn run() -> Result<bool, Box<dyn Error>> {
    let (mut runs, mut limit) = (Runs::new(100), 2.0_f64);
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or("each option has a value")?;
        match name.as_str() {
            "--limit" => limit = value.parse()?,
            _ if runs.set(&name, &value)? => {}
            _ => return Err(format!("no option '{name}': --mode --first --count --limit").into()),
        }
    }
    let limit = Duration::try_from_secs_f64(limit)?;
    let mut sound = true;
    for &mode in runs.modes() {
        let (mut passed, mut broken) = (0, [const { Vec::new() }; CLASSES.len()]);
        for seed in runs.seeds() {
            match first_fault(mode, seed, limit) {
                None => passed += 1,
                Some((class, told)) => {
                    println!("{mode:?} {seed}: {told}");
                    broken[class].push(seed);
                }
            }
        }
        println!("{mode:?}: {passed} of {} passed", runs.count);
        for (class, seeds) in CLASSES.iter().zip(&broken) {
            println!("  {} {class} {seeds:?}", seeds.len());
        }
        sound &= broken.iter().all(Vec::is_empty);
    }
    Ok(sound)
}

/// Plays a script on a thread of its own; `None`: it passed. One that does not end is left to itself.
fn first_fault(mode: Mode, seed: u64, limit: Duration) -> Option<(usize, String)> {
    let (tell, hear) = channel();
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    std::thread::spawn(move || {
        let _ = tell.send(play(mode, seed, &asked));
    });
    match hear.recv_timeout(limit) {
        Ok(End::Passed(_)) => None,
        Ok(End::Broke(call, fault)) => {
            let class = match fault {
                Fault::Escape(_) => 1,
                Fault::Missed(_) => 2,
                Fault::Gain(_) => 3,
                Fault::Momentum(_) => 4,
                Fault::Stands(_) => 5,
            };
            Some((class, format!("call {call}: {fault:?}")))
        }
        Ok(End::Stopped) => Some((0, "stopped".to_owned())),
        Err(RecvTimeoutError::Disconnected) => Some((6, "it panicked".to_owned())),
        Err(RecvTimeoutError::Timeout) => {
            // Between two calls it listens.
            stop.store(true, Ordering::Relaxed);
            let ended = hear.recv_timeout(4 * limit).is_ok();
            let within = if ended { "" } else { ", in one call" };
            Some((0, format!("over the time limit{within}")))
        }
    }
}
