//! What clap found in the arguments, as the exit codes want it.

use std::io::{self, Write as _};
use std::process::ExitCode;

use clap::error::ErrorKind;

use crate::exit::{End, Failure};
use crate::out;

/// Help goes to stdout; a wrong value, or one that is no text, gets one line, other wrong usage clap's own hints.
#[must_use]
pub fn usage(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::ValueValidation | ErrorKind::InvalidValue => {
            let text = error.render().to_string();
            // What clap says up to the first empty line: the value, the flag, and what is possible.
            let first = text.split("\n\n").next().unwrap_or_default();
            Failure::new(first.strip_prefix("error: ").unwrap_or(first)).report()
        }
        ErrorKind::InvalidUtf8 => Failure::new(
            "an argument is not UTF-8; folders and files after a flag may have any name",
        )
        .report(),
        _ => {
            let printed = error.print();
            if error.use_stderr() {
                return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
            }
            out::keep(printed.and_then(|()| io::stdout().flush()));
            End::Done.code()
        }
    }
}
