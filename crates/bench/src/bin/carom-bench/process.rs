//! One job in a process of its own: what it answers, whatever happens to it.

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use carom_bench::{Job, Reading};

use crate::clock::Clock;

/// Lets `executable` do a job; `None` if the user asked for the end meanwhile.
///
/// A process that runs longer than `limit` (in s), crashes or answers nonsense is a failed reading, never an error.
pub(crate) fn run(
    executable: &Path,
    job: &Job,
    limit: f64,
    asked: impl Fn() -> bool,
) -> Option<Reading> {
    let failed = |reason: String| Some(Reading::Failed { reason });
    let Ok(argument) = serde_json::to_string(job) else {
        return failed("the job cannot be written down".to_owned());
    };
    let spawned = Command::new(executable)
        .arg(argument)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = match spawned {
        Ok(child) => child,
        Err(error) => return failed(format!("cannot start {}: {error}", executable.display())),
    };
    let (out, err) = (listen(child.stdout.take()), listen(child.stderr.take()));
    let end = wait(&mut child, limit, &asked);
    if asked() || matches!(end, Wait::Asked) {
        return None;
    }
    let status = match end {
        Wait::Ended(status) => status,
        Wait::Late => return failed(format!("stopped after {limit} s")),
        Wait::Lost(reason) => return failed(reason),
        Wait::Asked => return None,
    };
    let (out, err) = (text(out), text(err));
    if !status.success() {
        return failed(format!("crashed: {}", last_words(status, &err)));
    }
    // A peer may print lines of its own before.
    let line = out.lines().rev().find(|line| !line.trim().is_empty());
    let line = line.unwrap_or_default();
    match serde_json::from_str(line) {
        Ok(reading) => Some(reading),
        Err(error) => {
            let seen: String = line.chars().take(60).collect();
            failed(format!("answered no reading but {seen:?}: {error}"))
        }
    }
}

enum Wait {
    Ended(ExitStatus),
    Late,
    Asked,
    Lost(String),
}

/// Looks after the process now and then; kills it when its time is over.
fn wait(child: &mut Child, limit: f64, asked: &impl Fn() -> bool) -> Wait {
    let clock = Clock::start();
    let mut pause = Duration::from_millis(1);
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Wait::Ended(status),
            Ok(None) => {}
            Err(error) => {
                stop(child);
                return Wait::Lost(format!("lost: {error}"));
            }
        }
        if asked() {
            stop(child);
            return Wait::Asked;
        }
        if clock.seconds() > limit {
            stop(child);
            return Wait::Late;
        }
        thread::sleep(pause);
        // Seldom enough not to disturb a long run, often enough for short ones.
        pause = (pause * 2).min(Duration::from_millis(50));
    }
}

fn stop(child: &mut Child) {
    // It may have ended by itself in between.
    let _ = child.kill();
    let _ = child.wait();
}

/// Reads a pipe to its end beside the waiting, so that the process never blocks on a full one.
fn listen<R: Read + Send + 'static>(pipe: Option<R>) -> JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(pipe) = pipe {
            // What was read before an error still tells something.
            let _ = pipe.take(1 << 24).read_to_end(&mut bytes);
        }
        bytes
    })
}

fn text(pipe: JoinHandle<Vec<u8>>) -> String {
    let bytes = pipe.join().unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The signal or exit code, and the line of the error output that says most.
fn last_words(status: ExitStatus, err: &str) -> String {
    let how = ended(status);
    let lines: Vec<&str> = err.lines().filter(|line| !line.trim().is_empty()).collect();
    // A Rust panic: the message stands after the line with the place.
    let panic = lines.iter().position(|line| line.contains("panicked at"));
    let line = panic
        .and_then(|at| lines.get(at + 1))
        .or(lines.last())
        .map_or("", |line| line.trim());
    if line.is_empty() {
        how
    } else {
        format!("{how}: {line}")
    }
}

#[cfg(unix)]
fn ended(status: ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt as _;
    match (status.signal(), status.code()) {
        (Some(4), _) => "illegal instruction (SIGILL)".to_owned(),
        (Some(6), _) => "aborted (SIGABRT)".to_owned(),
        (Some(9), _) => "killed (SIGKILL)".to_owned(),
        (Some(11), _) => "segmentation fault (SIGSEGV)".to_owned(),
        (Some(signal), _) => format!("signal {signal}"),
        (None, Some(code)) => format!("exit code {code}"),
        (None, None) => "no exit code".to_owned(),
    }
}

#[cfg(not(unix))]
fn ended(status: ExitStatus) -> String {
    match status.code() {
        Some(code) => format!("exit code {code}"),
        None => "no exit code".to_owned(),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::PermissionsExt as _;

    use carom_bench::{EngineName, Mode, Point};

    fn job() -> Job {
        Job::Accuracy(Point {
            engine: EngineName::Carom,
            mode: Mode::Hybrid,
            case: "01_projectile".to_owned(),
            hz: 60,
            substeps: None,
        })
    }

    /// What a shell script in the engine's place comes to.
    fn answer(script: &str, limit: f64, asked: bool) -> Option<Reading> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("engine-run");
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        run(&path, &job(), limit, || asked)
    }

    fn reason(script: &str, limit: f64) -> String {
        match answer(script, limit, false) {
            Some(Reading::Failed { reason }) => reason,
            other => panic!("{script}: {other:?}"),
        }
    }

    #[test]
    fn an_answer_is_its_last_line() {
        let script = r#"echo hello; echo '{"kind":"accuracy","values":[["pos_error_m",0.5]],"cpu_s_per_s":0.25}'"#;
        let Some(Reading::Accuracy { values, .. }) = answer(script, 60.0, false) else {
            panic!("no reading");
        };
        assert_eq!(values, [("pos_error_m".to_owned(), 0.5)]);
    }

    #[test]
    fn whatever_goes_wrong_is_a_failed_reading() {
        for (script, parts) in [
            ("kill -SEGV $$", &["crashed", "segmentation fault"][..]),
            (
                "echo body 3 is strange >&2; exit 3",
                &["exit code 3", "body 3 is strange"],
            ),
            (
                "printf \"thread 'main' panicked at x.rs:1:1:\\nno such body\\nnote: run with\\n\" >&2; exit 101",
                &["exit code 101: no such body"],
            ),
            ("echo garbage", &["answered no reading", "garbage"]),
            ("true", &["answered no reading"]),
        ] {
            let reason = reason(script, 60.0);
            for part in parts {
                assert!(reason.contains(part), "{script}: {reason}");
            }
            assert_eq!(reason.lines().count(), 1, "{reason}");
        }
        assert_eq!(reason("exec sleep 60", 0.2), "stopped after 0.2 s");
        let nowhere = run(Path::new("/nowhere/engine-run"), &job(), 1.0, || false);
        assert!(matches!(nowhere, Some(Reading::Failed { reason }) if reason.contains("/nowhere")));
    }

    #[test]
    fn the_end_that_the_user_asked_for_leaves_no_reading() {
        assert_eq!(answer("exec sleep 60", 60.0, true), None);
    }
}
