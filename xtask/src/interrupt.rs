//! Ctrl-C: the frame in hand is finished, the summary printed, then exit 130.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Failure;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Listens for Ctrl-C and termination from now on; the second one ends the program at once.
pub(crate) fn watch() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        eprintln!("\ninterrupted: finishing the frame (once more: stop at once)");
    })?;
    Ok(())
}

/// Whether the user asked for the end.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}
