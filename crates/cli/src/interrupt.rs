//! Ctrl-C and termination: what is in hand is finished or let go, the summary printed, then exit 128 and the signal's number.

use std::sync::atomic::{AtomicU8, Ordering};

use crate::exit::Failure;
use crate::out::tell;

/// Exit code after Ctrl-C (SIGINT, 2).
const CTRL_C: u8 = 128 + 2;

/// The exit code that was asked for; 0 if none was.
static ASKED: AtomicU8 = AtomicU8::new(0);

/// Listens for Ctrl-C and termination from now on; the second one ends the program at once.
///
/// `doing` says what happens first, in the words of the command: "finishing the frame".
///
/// # Errors
/// If the system takes no signal handler.
pub fn watch(doing: &'static str) -> Result<(), Failure> {
    listen(move |code| {
        if ASKED.swap(code, Ordering::SeqCst) != 0 {
            std::process::exit(code.into());
        }
        tell!("\ninterrupted: {doing} (once more: stop at once)");
    })
}

#[cfg(unix)]
fn listen(heard: impl Fn(u8) + Send + 'static) -> Result<(), Failure> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP])?;
    std::thread::spawn(move || {
        for signal in signals.forever() {
            heard(u8::try_from(128 + signal).unwrap_or(CTRL_C));
        }
    });
    Ok(())
}

#[cfg(not(unix))]
fn listen(heard: impl Fn(u8) + Send + 'static) -> Result<(), Failure> {
    Ok(ctrlc::set_handler(move || heard(CTRL_C))?)
}

/// Whether the user asked for the end.
#[must_use]
pub fn asked() -> bool {
    ASKED.load(Ordering::SeqCst) != 0
}

/// The exit code after a request to end: 129 for a terminal that hung up, 130 for Ctrl-C, 143 for termination.
pub(crate) fn code() -> u8 {
    match ASKED.load(Ordering::SeqCst) {
        0 => CTRL_C,
        code => code,
    }
}
