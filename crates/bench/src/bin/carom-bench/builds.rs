//! The executables that run engines: which can be built here, and where they are.
//!
//! Two builds of an engine for different instruction sets cannot share a program, so each has features, flags and a target
//! folder of its own, `target/laboratory/NAME`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use carom_bench::EngineName;

use crate::exit::{Failure, fail};

/// Flags of the peers' C compiler: `boxdd-sys` itself would leave Box2D's assertions on.
pub(crate) const CFLAGS: &str = "-O2 -DNDEBUG";

/// One executable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Build {
    /// carom, no peer.
    Carom,
    /// Peers with the instructions that every x86-64 has.
    Sse2,
    /// Peers with eight lanes.
    Avx2,
    /// Peers on several threads.
    Parallel,
    /// Rapier with eight lanes on several threads; Box2D needs no build of its own for that.
    Avx2Parallel,
}

/// How much the compiler does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Profile {
    /// Builds in seconds.
    Dev,
    /// Fat LTO, one codegen unit.
    Bench,
}

impl Profile {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Dev => "dev",
            Self::Bench => "bench",
        }
    }

    const fn folder(self) -> &'static str {
        match self {
            Self::Dev => "debug",
            Self::Bench => "release",
        }
    }

    /// For the head of a table.
    pub(crate) const fn about(self) -> &'static str {
        match self {
            Self::Dev => "dev: optimised at level 2, no LTO; not for comparing speed",
            Self::Bench => "bench: release, fat LTO, one codegen unit",
        }
    }
}

impl Build {
    /// The build that has an engine.
    pub(crate) const fn of(engine: EngineName, threads: u32) -> Self {
        match engine {
            EngineName::Carom => Self::Carom,
            EngineName::Rapier8 if threads > 1 => Self::Avx2Parallel,
            EngineName::Box2dAvx2 | EngineName::Rapier8 => Self::Avx2,
            _ if threads > 1 => Self::Parallel,
            _ => Self::Sse2,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Carom => "carom",
            Self::Sse2 => "sse2",
            Self::Avx2 => "avx2",
            Self::Parallel => "parallel",
            Self::Avx2Parallel => "avx2-parallel",
        }
    }

    /// Flags of the Rust compiler, besides the user's.
    const fn rustflags(self) -> &'static str {
        match self {
            Self::Avx2 | Self::Avx2Parallel => "-Ctarget-cpu=x86-64-v3",
            _ => "",
        }
    }

    /// In a line, for the head of a table.
    pub(crate) fn about(self, engines: &[EngineName]) -> String {
        let names: Vec<&str> = engines.iter().map(|engine| engine.name()).collect();
        let flags = match self.rustflags() {
            "" => "x86-64 as it is".to_owned(),
            flags => flags.to_owned(),
        };
        format!("{} ({flags})", names.join(", "))
    }
}

/// The feature that an engine is behind; carom has none.
const fn feature(engine: EngineName) -> Option<&'static str> {
    match engine {
        EngineName::Carom => None,
        EngineName::Box2dSse2 => Some("box2d"),
        EngineName::Box2dAvx2 => Some("box2d-avx2"),
        EngineName::Rapier => Some("rapier"),
        EngineName::Rapier8 => Some("rapier-8"),
        EngineName::RapierF64 => Some("rapier-f64"),
        EngineName::Chipmunk => Some("chipmunk"),
    }
}

/// What this machine has, as far as a peer needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    pub(crate) c_compiler: bool,
    pub(crate) chipmunk: bool,
    pub(crate) avx2: bool,
}

impl Probe {
    pub(crate) fn machine() -> Self {
        Self {
            c_compiler: answers(&c_compiler(), &["--version"]),
            chipmunk: answers("pkg-config", &["--exists", "chipmunk"])
                || Path::new("/usr/include/chipmunk/chipmunk.h").is_file(),
            avx2: has_avx2(),
        }
    }

    /// Why an engine cannot be built or run here, and what would help.
    pub(crate) fn objection(self, engine: EngineName) -> Option<&'static str> {
        let box2d = matches!(engine, EngineName::Box2dSse2 | EngineName::Box2dAvx2);
        let wide = matches!(engine, EngineName::Box2dAvx2 | EngineName::Rapier8);
        if box2d && !self.c_compiler {
            Some("needs a C compiler (apt install gcc)")
        } else if wide && !self.avx2 {
            Some("needs a processor with AVX2")
        } else if engine == EngineName::Chipmunk && !self.chipmunk {
            Some("needs Chipmunk's library and headers (apt install libchipmunk-dev)")
        } else {
            None
        }
    }
}

pub(crate) fn c_compiler() -> String {
    std::env::var("CC").unwrap_or_else(|_| "cc".to_owned())
}

pub(crate) fn answers(program: &str, args: &[&str]) -> bool {
    let mut command = Command::new(program);
    command
        .args(args)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}

#[cfg(not(target_arch = "x86_64"))]
fn has_avx2() -> bool {
    false
}

/// Where the executables are, and which engines were left out.
#[derive(Debug, Default)]
pub(crate) struct Executables {
    paths: BTreeMap<Build, PathBuf>,
    /// Engines without an executable, each with the reason.
    pub(crate) left_out: Vec<(EngineName, String)>,
    /// Engines of each build.
    pub(crate) engines: BTreeMap<Build, Vec<EngineName>>,
}

impl Executables {
    pub(crate) fn path(&self, engine: EngineName, threads: u32) -> Option<&Path> {
        let build = Build::of(engine, threads);
        let has = self.engines.get(&build)?.contains(&engine);
        has.then(|| self.paths.get(&build).map(PathBuf::as_path))?
    }

    /// Builds what these engines need on these numbers of threads.
    pub(crate) fn build(
        engines: &[EngineName],
        threads: &[u32],
        profile: Profile,
        probe: Probe,
    ) -> Result<Self, Failure> {
        let mut built = Self::default();
        let mut wanted: BTreeMap<Build, Vec<EngineName>> = BTreeMap::new();
        for engine in engines {
            if let Some(why) = probe.objection(*engine) {
                built.left_out.push((*engine, why.to_owned()));
                continue;
            }
            for threads in threads {
                let of_build = wanted.entry(Build::of(*engine, *threads)).or_default();
                if !of_build.contains(engine) {
                    of_build.push(*engine);
                }
            }
        }
        for (build, engines) in wanted {
            eprintln!("building {}", build.about(&engines));
            match cargo(build, &engines, profile) {
                Ok(path) => {
                    built.paths.insert(build, path);
                    built.engines.insert(build, engines);
                }
                // Without carom there is nothing to compare, without a network every peer fails alike.
                Err(Broken { offline, line }) if offline || build == Build::Carom => {
                    fail!("{line}")
                }
                Err(Broken { line, .. }) => {
                    let reason = |engine| (engine, format!("does not build: {line}"));
                    built.left_out.extend(engines.into_iter().map(reason));
                }
            }
        }
        Ok(built)
    }
}

/// Why cargo failed.
struct Broken {
    offline: bool,
    line: String,
}

fn cargo(build: Build, engines: &[EngineName], profile: Profile) -> Result<PathBuf, Broken> {
    let root = workspace();
    let broken = |line: String| Broken {
        offline: false,
        line,
    };
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command
        .args([
            "build",
            "--quiet",
            "--package",
            "carom-bench",
            "--bin",
            "engine-run",
        ])
        .args(["--profile", profile.name()])
        .arg("--manifest-path")
        .arg(root.join("Cargo.toml"));
    // For development carom shares the folder of the driver: there is little left to build.
    let folder = if build == Build::Carom && profile == Profile::Dev {
        target
    } else {
        let mut features: Vec<&str> = engines.iter().copied().filter_map(feature).collect();
        if matches!(build, Build::Parallel | Build::Avx2Parallel) {
            features.push("rapier-parallel");
        }
        command.args(["--no-default-features", "--features", &features.join(",")]);
        target.join("laboratory").join(build.name())
    };
    command.arg("--target-dir").arg(&folder);
    command.env("CFLAGS", CFLAGS);
    let users = std::env::var("RUSTFLAGS").unwrap_or_default();
    if !build.rustflags().is_empty() {
        command.env_remove("CARGO_ENCODED_RUSTFLAGS");
        command.env("RUSTFLAGS", format!("{users} {}", build.rustflags()).trim());
    }
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|error| broken(format!("cannot start cargo: {error}")))?;
    if output.status.success() {
        let file = format!("engine-run{}", std::env::consts::EXE_SUFFIX);
        return Ok(folder.join(profile.folder()).join(file));
    }
    Err(explain(&String::from_utf8_lossy(&output.stderr)))
}

/// The line of cargo's complaint that says most.
fn explain(stderr: &str) -> Broken {
    const OFFLINE: [&str; 6] = [
        "failed to download",
        "Could not resolve host",
        "Couldn't resolve host",
        "spurious network error",
        "failed to query replaced source",
        "--offline was specified",
    ];
    let offline = OFFLINE.iter().any(|sign| stderr.contains(sign));
    let first = stderr
        .lines()
        .find(|line| line.starts_with("error"))
        .unwrap_or("cargo failed without a word");
    let line = first
        .trim_start_matches("error")
        .trim_start_matches(':')
        .trim();
    let line = if offline {
        format!("the peers' crates cannot be downloaded: {line} (without --peers carom runs alone)")
    } else {
        line.to_owned()
    };
    Broken { offline, line }
}

/// The folder of the workspace: two above this package.
pub(crate) fn workspace() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().nth(2).unwrap_or(package).to_path_buf()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_named_with_its_cure() {
        let bare = Probe {
            c_compiler: false,
            chipmunk: false,
            avx2: false,
        };
        assert_eq!(bare.objection(EngineName::Carom), None);
        assert_eq!(bare.objection(EngineName::Rapier), None);
        for (engine, part) in [
            (EngineName::Box2dSse2, "C compiler"),
            (EngineName::Box2dAvx2, "C compiler"),
            (EngineName::Rapier8, "AVX2"),
            (EngineName::Chipmunk, "libchipmunk-dev"),
        ] {
            let why = bare.objection(engine).unwrap();
            assert!(why.contains(part), "{engine}: {why}");
        }
        let full = Probe {
            c_compiler: true,
            chipmunk: true,
            avx2: true,
        };
        for engine in EngineName::ALL {
            assert_eq!(full.objection(engine), None, "{engine}");
        }
    }

    #[test]
    fn instruction_sets_do_not_share_an_executable() {
        use EngineName::{Box2dAvx2, Box2dSse2, Carom, Rapier, Rapier8};
        assert_ne!(Build::of(Box2dSse2, 1), Build::of(Box2dAvx2, 1));
        assert_ne!(Build::of(Rapier, 1), Build::of(Rapier8, 1));
        assert_ne!(Build::of(Rapier, 1), Build::of(Rapier, 2));
        assert_ne!(Build::of(Rapier, 2), Build::of(Rapier8, 2));
        assert_ne!(Build::of(Rapier8, 1), Build::of(Rapier8, 2));
        assert_eq!(Build::of(Box2dAvx2, 1), Build::of(Box2dAvx2, 2));
        assert_eq!(Build::of(Carom, 1), Build::of(Carom, 2));
    }

    #[test]
    fn cargos_complaint_becomes_one_line() {
        let offline =
            explain("error: failed to download from `https://x`\n\nCaused by:\n  no route\n");
        assert!(offline.offline && offline.line.contains("without --peers"));
        let broken = explain("warning: x\nerror: linking failed\nerror: two\n");
        assert!(!broken.offline);
        assert_eq!(broken.line, "linking failed");
        assert_eq!(explain("").line, "cargo failed without a word");
    }
}
