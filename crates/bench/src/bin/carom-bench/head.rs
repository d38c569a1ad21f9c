//! What stands above every table: when, where, with what.

use std::fs;
use std::process::{Command, Stdio};

use serde::{Deserialize, Serialize};

use crate::builds::{self, CFLAGS, Executables, Profile};

/// Lines of a key and a text; the order is that of the tables.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Head {
    pub(crate) lines: Vec<(String, String)>,
}

/// Keys that decide whether rows of two runs may stand in one table.
const SAME: [&str; 3] = ["machine", "carom", "profile"];

impl Head {
    /// Of a run on this machine, now.
    pub(crate) fn of(profile: Profile, executables: &Executables) -> Self {
        let mut head = Self::default();
        head.push("date", date());
        head.push("machine", machine());
        head.push("system", system());
        head.push("carom", version());
        head.push("profile", profile.about());
        head.push("rustc", says("rustc", &["--version"]));
        for (build, engines) in &executables.engines {
            head.push("build", build.about(engines));
        }
        let peers = executables.engines.values().flatten().count() > 1;
        if peers {
            let compiler = builds::c_compiler();
            head.push(
                "C compiler",
                format!("{}, {CFLAGS}", says(&compiler, &["--version"])),
            );
            head.push("peers", peers_versions());
        }
        for (engine, reason) in &executables.left_out {
            head.push("left out", format!("{engine}: {reason}"));
        }
        head
    }

    pub(crate) fn push(&mut self, key: &str, text: impl Into<String>) {
        let text: String = text.into();
        // A head's line is a line.
        let text: Vec<&str> = text.split_whitespace().collect();
        self.lines.push((key.to_owned(), text.join(" ")));
    }

    pub(crate) fn get(&self, key: &str) -> &str {
        let found = self.lines.iter().find(|(found, _)| found == key);
        found.map_or("", |(_, text)| text)
    }

    /// The first key in which rows of the two would not be comparable.
    pub(crate) fn conflict(&self, other: &Self) -> Option<&'static str> {
        SAME.into_iter().find(|key| self.get(key) != other.get(key))
    }

    /// As a Markdown list.
    pub(crate) fn markdown(&self) -> String {
        let line = |(key, text): &(String, String)| format!("- {key}: {text}\n");
        self.lines.iter().map(line).collect()
    }

    /// As comment lines above a CSV.
    pub(crate) fn comments(&self) -> String {
        let line = |(key, text): &(String, String)| format!("# {key}: {text}\n");
        self.lines.iter().map(line).collect()
    }

    /// What the comment lines of a CSV say.
    pub(crate) fn from_comments(text: &str) -> Self {
        let comments = text.lines().map_while(|line| line.strip_prefix("# "));
        let pairs = comments.filter_map(|line| line.split_once(": "));
        Self {
            lines: pairs
                .map(|(key, text)| (key.to_owned(), text.to_owned()))
                .collect(),
        }
    }
}

/// Processor, number of cores, memory.
fn machine() -> String {
    let processors = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |text: &str, key: &str| {
        let line = text.lines().find(|line| line.starts_with(key))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let model =
        field(&processors, "model name").unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let cache =
        field(&processors, "cache size").map_or(String::new(), |size| format!(", cache {size}"));
    let memory = fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let memory = field(&memory, "MemTotal")
        .and_then(|text| text.split_whitespace().next()?.parse::<u64>().ok())
        .map_or(String::new(), |kib| {
            format!(", {} GiB", (kib + (1 << 19)) >> 20)
        });
    format!("{model}, {cores} cores{cache}{memory}")
}

fn system() -> String {
    let release = fs::read_to_string("/etc/os-release").unwrap_or_default();
    let name = release
        .lines()
        .find_map(|line| line.strip_prefix("PRETTY_NAME="))
        .map_or(std::env::consts::OS, |name| name.trim_matches('"'));
    let kernel = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    format!("{name}, kernel {}", kernel.trim())
}

/// The commit, if this is a checkout, and whether files differ from it.
fn version() -> String {
    let package = env!("CARGO_PKG_VERSION");
    let root = builds::workspace();
    let root = root.to_string_lossy();
    match says(
        "git",
        &[
            "-C",
            &root,
            "describe",
            "--always",
            "--dirty",
            "--exclude",
            "*",
        ],
    )
    .as_str()
    {
        "unknown" => package.to_owned(),
        commit => format!("{package} at {commit}"),
    }
}

/// First line of what a program prints.
fn says(program: &str, args: &[&str]) -> String {
    let mut command = Command::new(program);
    let output = command.args(args).stdin(Stdio::null()).output();
    let Some(output) = output.ok().filter(|output| output.status.success()) else {
        return "unknown".to_owned();
    };
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().next().unwrap_or("unknown").trim().to_owned()
}

/// The peers' versions by the lock file; the commit of Box2D is the one that its crate was made from.
fn peers_versions() -> String {
    let lock = fs::read_to_string(builds::workspace().join("Cargo.lock")).unwrap_or_default();
    let mut found: Vec<String> = ["boxdd-sys", "rapier2d", "rapier2d-f64"]
        .into_iter()
        .filter_map(|name| Some(format!("{name} {}", locked(&lock, name)?)))
        .collect();
    let chipmunk = says("pkg-config", &["--modversion", "chipmunk"]);
    if chipmunk != "unknown" {
        found.push(format!("chipmunk {chipmunk}"));
    }
    if found.is_empty() {
        return "unknown".to_owned();
    }
    found
        .join(", ")
        .replace("boxdd-sys 0.6.0", "boxdd-sys 0.6.0 (Box2D v3 at 56edae79)")
}

fn locked<'a>(lock: &'a str, name: &str) -> Option<&'a str> {
    let mut lines = lock.lines();
    lines.find(|line| {
        line.strip_prefix("name = ")
            .is_some_and(|found| found.trim_matches('"') == name)
    })?;
    lines
        .next()?
        .strip_prefix("version = ")
        .map(|text| text.trim_matches('"'))
}

/// Today's date and the time of day, UTC.
fn date() -> String {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::Realtime);
    let (days, second) = (now.tv_sec.div_euclid(86_400), now.tv_sec.rem_euclid(86_400));
    let (year, month, day) = civil(days);
    format!(
        "{year}-{month:02}-{day:02} {:02}:{:02} UTC",
        second / 3600,
        second / 60 % 60
    )
}

/// Year, month and day of a count of days since 1970-01-01 (Hinnant, "chrono-compatible low-level date algorithms", 2013).
const fn civil(days: i64) -> (i64, i64, i64) {
    let z = days + 719_468;
    let era = z.div_euclid(146_097);
    let day_of_era = z.rem_euclid(146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 {
        shifted + 3
    } else {
        shifted - 9
    };
    let year = year_of_era + era * 400 + (month <= 2) as i64;
    (year, month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_become_dates() {
        for (days, date) in [
            (0, (1970, 1, 1)),
            (59, (1970, 3, 1)),
            (11_016, (2000, 2, 29)),
            (20_513, (2026, 3, 1)),
            (-1, (1969, 12, 31)),
        ] {
            assert_eq!(civil(days), date, "{days}");
        }
    }

    #[test]
    fn a_head_survives_a_csv() {
        let mut head = Head::default();
        head.push("machine", "a: b,  c");
        head.push("settings carom hybrid", "tick=1");
        let text = format!("{}case,metric\nx,y\n", head.comments());
        let back = Head::from_comments(&text);
        assert_eq!(back, head);
        assert_eq!(back.get("machine"), "a: b, c");
        assert_eq!(back.conflict(&head), None);
        let mut other = head.clone();
        other.lines[0].1 = "z".to_owned();
        assert_eq!(other.conflict(&head), Some("machine"));
    }

    #[test]
    fn the_lock_file_tells_versions() {
        let lock = "[[package]]\nname = \"rapier2d-f64\"\nversion = \"0.36.1\"\n\n[[package]]\nname = \"rapier2d\"\nversion = \"0.36.2\"\n";
        assert_eq!(locked(lock, "rapier2d"), Some("0.36.2"));
        assert_eq!(locked(lock, "rapier2d-f64"), Some("0.36.1"));
        assert_eq!(locked(lock, "boxdd-sys"), None);
    }
}
