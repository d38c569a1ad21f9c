//! How a command ends: exit codes and the one line that an error gets.

use std::process::ExitCode;

use crate::number::with_short_numbers;
use crate::out::tell;

/// So many characters of a line are shown, and a quarter as many from its end.
const LONGEST: usize = 1000;

/// How a command ended that was not stopped by an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// All is done.
    Done,
    /// A check fell short of what it asks for.
    Short,
    /// Ctrl-C or termination: the frame in hand was finished, the summary printed.
    Interrupted,
}

impl End {
    /// 0, 1, or 128 and the number of the signal: 129 for a terminal that hung up, 130 for Ctrl-C, 143 for termination. 2 if a line to stdout was lost.
    pub fn code(self) -> ExitCode {
        if let Some(error) = crate::out::lost() {
            return Failure::new(format!("cannot write to stdout: {error}")).report();
        }
        match self {
            Self::Done => ExitCode::SUCCESS,
            Self::Short => ExitCode::from(1),
            Self::Interrupted => ExitCode::from(crate::interrupt::code()),
        }
    }
}

/// What stops a command: bad usage, bad input, or a file that cannot be read or written. Exit code 2.
///
/// Any error converts into it, so `?` works everywhere; it is no error type itself.
#[derive(Debug)]
pub struct Failure(String);

/// What a command gives back.
pub type Outcome = Result<End, Failure>;

impl Failure {
    /// A failure with this message.
    pub fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }

    /// The message on a line of its own, whatever an error below wrote, and without numbers of hundreds of digits.
    ///
    /// Of what is longer than any text of ours, begin and end: in between is a key, a value or a name of a megabyte.
    pub fn line(&self) -> String {
        let parts: Vec<&str> = self.0.split_whitespace().collect();
        let line = with_short_numbers(&parts.join(" "));
        let mut places = line.char_indices().map(|(place, _)| place);
        match (places.nth(LONGEST), places.nth_back(LONGEST / 4)) {
            (Some(begin), Some(end)) => format!("{} … {}", &line[..begin], &line[end..]),
            _ => line,
        }
    }

    /// Prints `error: …` to stderr and gives exit code 2.
    pub fn report(&self) -> ExitCode {
        tell!("error: {}", self.line());
        ExitCode::from(2)
    }
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// `fail!("…")` stops a command with that line.
#[macro_export]
macro_rules! fail {
    ($($format:tt)*) => {
        return Err($crate::exit::Failure::new(format!($($format)*)))
    };
}
pub use fail;
