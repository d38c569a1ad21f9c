//! Instructions a step, counted by valgrind's callgrind: a number without noise.

use std::io;
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::job::{Job, Reading};
use crate::speed::SpeedJob;

/// The measured function, with all that it calls; see `speed.rs`, where it is never inlined.
const COUNTED: &str = "*measured_step*";

/// What was counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Instructions {
    /// Steps before the counted ones.
    pub warm_up_steps: u32,
    /// Steps that were counted.
    pub measured_steps: u32,
    /// Instructions of all counted steps.
    pub total: u64,
}

impl Instructions {
    /// Mean over the counted steps.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "shown with three or four digits"
    )]
    pub fn per_step(self) -> f64 {
        self.total as f64 / f64::from(self.measured_steps)
    }
}

/// Why nothing was counted.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CallgrindError {
    /// The tool is not there.
    #[error("valgrind cannot be started ({0}): install it to count instructions")]
    Missing(io::Error),
    /// The run did not come to its end.
    #[error("the run under valgrind failed: {0}")]
    Run(String),
    /// The tool wrote something else than expected.
    #[error("callgrind counted nothing inside {COUNTED}: {0}")]
    Nothing(String),
}

/// Runs a job's steps in `executable` (an `engine-run`) under callgrind, which takes some fifty times as long.
///
/// Several threads are counted together: callgrind runs them in turn.
///
/// # Errors
/// If valgrind is missing, the run fails, or nothing was counted.
pub fn count_instructions(
    executable: &Path,
    job: &SpeedJob,
) -> Result<Instructions, CallgrindError> {
    let folder = tempfile::tempdir().map_err(|error| CallgrindError::Run(error.to_string()))?;
    let counts = folder.path().join("callgrind.out");
    let output = command(executable, &Job::Bare(job.clone()), &counts)
        .output()
        .map_err(CallgrindError::Missing)?;
    let answer = String::from_utf8_lossy(&output.stdout);
    let (warm_up_steps, measured_steps) = match serde_json::from_str(answer.trim()) {
        Ok(Reading::Bare {
            warm_up_steps,
            measured_steps,
        }) if measured_steps > 0 => (warm_up_steps, measured_steps),
        Ok(Reading::Failed { reason }) => return Err(CallgrindError::Run(reason)),
        _ => {
            let said = String::from_utf8_lossy(&output.stderr);
            let last = said.lines().last().unwrap_or_default();
            return Err(CallgrindError::Run(last.to_owned()));
        }
    };
    let written = std::fs::read_to_string(&counts)
        .map_err(|error| CallgrindError::Nothing(error.to_string()))?;
    match total(&written) {
        Some(total) if total > 0 => Ok(Instructions {
            warm_up_steps,
            measured_steps,
            total,
        }),
        _ => Err(CallgrindError::Nothing(
            "is its name still in the executable?".to_owned(),
        )),
    }
}

fn command(executable: &Path, job: &Job, counts: &Path) -> Command {
    let mut command = Command::new("valgrind");
    command
        .arg("--tool=callgrind")
        .arg("--collect-atstart=no")
        .arg(format!("--toggle-collect={COUNTED}"))
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .arg(executable)
        .arg(serde_json::to_string(job).unwrap_or_default());
    command
}

/// The sum over all functions: `totals: N`, or `summary: N` in older versions.
fn total(written: &str) -> Option<u64> {
    let mut sums = written.lines().filter_map(|line| {
        let sum = line
            .strip_prefix("totals:")
            .or_else(|| line.strip_prefix("summary:"))?;
        sum.split_whitespace().next()?.parse().ok()
    });
    sums.next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_of_a_file_of_counts_is_read() {
        let written =
            "# callgrind format\nevents: Ir\nfn=(1) step\n12 3456\nsummary: 3400\ntotals: 3456\n";
        assert_eq!(total(written), Some(3400));
        assert_eq!(total("events: Ir\ntotals: 3456\n"), Some(3456));
        assert_eq!(total("events: Ir\n"), None);
    }

    #[test]
    fn a_missing_executable_is_said() {
        let job = serde_json::from_str(
            r#"{"engine":"carom","mode":"hybrid","threads":1,"reads_poses":false,"scene":"i"}"#,
        )
        .expect("a job");
        let error = count_instructions(Path::new("/nowhere/engine-run"), &job)
            .expect_err("there is no such file");
        assert!(matches!(
            error,
            CallgrindError::Run(_) | CallgrindError::Missing(_)
        ));
    }
}
