//! Lines to stdout that survive `| head`: a closed pipe is the end of listening, not a crash.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

static ASIDE: AtomicBool = AtomicBool::new(false);

/// From now on lines go to stderr: stdout is taken by what the command makes.
pub fn step_aside() {
    ASIDE.store(true, Ordering::Relaxed);
}

/// Prints a line; a reader that went away is no error.
pub fn line(text: Arguments<'_>) {
    // Only a closed pipe or a full disk can fail here; either way nobody reads on.
    let _ = if ASIDE.load(Ordering::Relaxed) {
        writeln!(io::stderr().lock(), "{text}")
    } else {
        writeln!(io::stdout().lock(), "{text}")
    };
}

/// Whether an error says that the reader of a pipe went away.
pub fn is_closed_pipe(error: &io::Error) -> bool {
    error.kind() == ErrorKind::BrokenPipe
}

/// `say!("…")`: a line to stdout.
#[macro_export]
macro_rules! say {
    ($($format:tt)*) => {
        $crate::out::line(format_args!($($format)*))
    };
}
pub use say;
