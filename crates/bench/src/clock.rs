//! The clocks of the laboratory: CPU time and memory of one process.

use rustix::time::{ClockId, clock_gettime};

/// A stretch of CPU time of one thread, or of the whole process.
#[derive(Clone, Copy, Debug)]
pub struct CpuClock {
    id: ClockId,
}

impl CpuClock {
    /// The calling thread's CPU time.
    #[must_use]
    pub const fn thread() -> Self {
        Self {
            id: ClockId::ThreadCPUTime,
        }
    }

    /// The CPU time of all threads of this process.
    #[must_use]
    pub const fn process() -> Self {
        Self {
            id: ClockId::ProcessCPUTime,
        }
    }

    /// Time as a clock on the wall tells it: for runs on several threads.
    #[must_use]
    pub const fn wall() -> Self {
        Self {
            id: ClockId::Monotonic,
        }
    }

    /// Seconds since some instant.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "seconds since boot fit into 53 bits"
    )]
    pub fn seconds(self) -> f64 {
        let now = clock_gettime(self.id);
        now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
    }
}

/// Largest resident memory of this process so far, in MiB; `None` where the system does not say.
#[must_use]
pub fn peak_memory() -> Option<f64> {
    memory("VmHWM:")
}

/// Resident pages of files, in MiB: of the program itself and its libraries, as far as they have run; `None` where the
/// system does not say.
#[must_use]
pub(crate) fn program_memory() -> Option<f64> {
    memory("RssFile:")
}

fn memory(name: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(name))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}
