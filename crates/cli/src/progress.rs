//! How far a long run is: a bar on a terminal, a line now and then elsewhere.

use std::fmt;
use std::io::{IsTerminal, stderr};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::clock::Clock;
use crate::out::tell;

/// Seconds between two plain lines.
const PAUSE: f64 = 5.0;

/// Progress of a run with a known number of steps, on stderr.
#[derive(Debug)]
pub struct Progress {
    what: String,
    unit: &'static str,
    total: u64,
    done: u64,
    shown: Shown,
}

#[derive(Debug)]
enum Shown {
    Bar(ProgressBar),
    Lines { clock: Clock, last: f64 },
}

impl Progress {
    /// `what` is being done, `total` times `unit` ("frames").
    pub fn new(what: impl Into<String>, total: u64, unit: &'static str) -> Self {
        let what = what.into();
        let shown = if stderr().is_terminal() && !is_set("TERM", Some("dumb")) {
            Shown::Bar(bar(&what, total, unit))
        } else {
            let clock = Clock::start();
            Shown::Lines { clock, last: 0.0 }
        };
        Self {
            what,
            unit,
            total,
            done: 0,
            shown,
        }
    }

    /// One more is done.
    pub fn advance(&mut self) {
        self.done += 1;
        match &mut self.shown {
            Shown::Bar(bar) => bar.inc(1),
            Shown::Lines { clock, last } => {
                let now = clock.seconds();
                if now - *last >= PAUSE {
                    *last = now;
                    tell!(
                        "{}: {}",
                        self.what,
                        rate_line(self.done, self.total, self.unit, now)
                    );
                }
            }
        }
    }

    /// Takes the bar away; what was done is told by the summary.
    pub fn finish(self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}

fn bar(what: &str, total: u64, unit: &str) -> ProgressBar {
    let strip = if is_set("NO_COLOR", None) {
        "{bar:28}"
    } else {
        "{bar:28.cyan}"
    };
    let template = format!("{{prefix}} [{strip}] {{pos}}/{{len}} {unit}, {{rate}}, {{eta}} left");
    let style = ProgressStyle::with_template(&template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key(
            "rate",
            |state: &ProgressState, line: &mut dyn fmt::Write| {
                // A line on a terminal: nothing to do if it cannot be written.
                let _ = write!(line, "{:.1}/s", state.per_sec());
            },
        )
        .progress_chars("=> ");
    ProgressBar::new(total)
        .with_style(style)
        .with_prefix(what.to_owned())
}

/// Whether an environment variable is there and not empty, or has the given value.
fn is_set(name: &str, value: Option<&str>) -> bool {
    std::env::var_os(name).is_some_and(|found| match value {
        Some(value) => found == *value,
        None => !found.is_empty(),
    })
}

#[expect(clippy::cast_precision_loss, reason = "a count of frames for the eye")]
fn rate_line(done: u64, total: u64, unit: &str, seconds: f64) -> String {
    let rate = done as f64 / seconds;
    let left = (total - done.min(total)) as f64 / rate;
    format!("{done} of {total} {unit}, {rate:.1}/s, {left:.0} s left")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_rate_and_remaining_time() {
        assert_eq!(
            rate_line(50, 200, "frames", 10.0),
            "50 of 200 frames, 5.0/s, 30 s left"
        );
        assert_eq!(
            rate_line(5, 4, "frames", 1.0),
            "5 of 4 frames, 5.0/s, 0 s left"
        );
    }
}
