//! Ctrl-C: what is in hand is finished or let go, the summary printed, then exit 130.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Failure;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Listens for Ctrl-C and termination from now on; the second one ends the program at once.
///
/// `doing` says what happens first: "finishing the frame".
///
/// # Errors
/// If the system lets nobody listen.
pub fn watch(doing: &'static str) -> Result<(), Failure> {
    ctrlc::set_handler(move || {
        if ASKED.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        eprintln!("\ninterrupted: {doing} (once more: stop at once)");
    })?;
    Ok(())
}

/// Whether the user asked for the end.
#[must_use]
pub fn asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}
