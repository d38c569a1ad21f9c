//! Lines to stdout that survive `| head`: a closed pipe is the end of listening, not a crash.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};

/// Prints a line; a reader that went away is no error.
pub fn line(text: Arguments<'_>) {
    // Only a closed pipe or a full disk can fail here; either way nobody reads on.
    let _ = writeln!(io::stdout().lock(), "{text}");
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
