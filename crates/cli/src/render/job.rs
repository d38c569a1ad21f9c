//! A run in one line: what decides the bytes of its frames, and which of them it draws.

use std::fmt;

use crate::values::Shard;

/// What a folder's manifest says about the run that wrote it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Job {
    /// Scene, version, size, rate and look: whatever decides the bytes of a frame. The threads do not.
    pub(crate) what: String,
    /// Frames of the whole film.
    pub(crate) frames: u64,
    /// Which slice of them.
    pub(crate) shard: Shard,
}

/// `…; frames 600; slice 1/3`.
impl fmt::Display for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            what,
            frames,
            shard,
        } = self;
        write!(f, "{what}; frames {frames}; slice {shard}")
    }
}

impl Job {
    /// Reads the line back; `None` if it is that of another command.
    pub(crate) fn parse(line: &str) -> Option<Self> {
        let (rest, shard) = line.rsplit_once("; slice ")?;
        let (what, frames) = rest.rsplit_once("; frames ")?;
        Some(Self {
            what: what.to_owned(),
            frames: frames.parse().ok()?,
            shard: shard.parse().ok()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_comes_back_from_its_line() {
        let job = Job {
            what: "a; frames 3; slice 1/2 of a name".to_owned(),
            frames: 600,
            shard: "2/7".parse().unwrap(),
        };
        assert_eq!(Job::parse(&job.to_string()), Some(job));
        for line in [
            "",
            "demo thesis",
            "x; frames 3",
            "x; frames 3; slice 4/3",
            "x; frames -3; slice 1/1",
        ] {
            assert_eq!(Job::parse(line), None, "{line}");
        }
    }
}
