//! Finds Chipmunk where the feature asks for it. Debian's package has no pkg-config file, so the linker's folders are asked.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Of an assert that is compiled out with `NDEBUG`.
const ASSERT: &[u8] = b"Body's mass is NaN.";

/// The space that steps on several threads.
const HASTY: &[u8] = b"cpHastySpaceStep";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(chipmunk_asserts)");
    println!("cargo::rustc-check-cfg=cfg(chipmunk_threads)");
    if env::var_os("CARGO_FEATURE_CHIPMUNK").is_none() {
        return;
    }
    println!("cargo::rerun-if-env-changed=CHIPMUNK_LIB_DIR");
    let Some(library) = find() else {
        println!(
            "cargo::error=the feature `chipmunk` needs the library Chipmunk 7: `apt-get install libchipmunk-dev`, \
             or CHIPMUNK_LIB_DIR=the folder of a libchipmunk.a of your own"
        );
        return;
    };
    println!("cargo::rerun-if-changed={}", library.display());
    if let Some(folder) = library.parent() {
        println!("cargo::rustc-link-search=native={}", folder.display());
    }
    if library.extension().is_some_and(|e| e == "a") {
        println!("cargo::rustc-link-lib=static=chipmunk");
        println!("cargo::rustc-link-lib=pthread");
        println!("cargo::rustc-link-lib=m");
    } else {
        println!("cargo::rustc-link-lib=dylib=chipmunk");
    }
    let bytes = std::fs::read(&library).unwrap_or_default();
    let holds = |text: &[u8]| bytes.windows(text.len()).any(|window| window == text);
    if holds(ASSERT) {
        println!("cargo::rustc-cfg=chipmunk_asserts");
    }
    if holds(HASTY) {
        println!("cargo::rustc-cfg=chipmunk_threads");
    }
}

fn find() -> Option<PathBuf> {
    const NAMES: [&str; 3] = ["libchipmunk.a", "libchipmunk.so", "libchipmunk.dylib"];
    if let Some(folder) = env::var_os("CHIPMUNK_LIB_DIR") {
        let files = NAMES.map(|name| Path::new(&folder).join(name));
        return files.into_iter().find(|file| file.is_file());
    }
    NAMES.into_iter().find_map(asked)
}

/// Where the C compiler's linker would take a library from: it repeats the bare name where it knows none.
fn asked(name: &str) -> Option<PathBuf> {
    let compiler = env::var_os("CC").unwrap_or_else(|| "cc".into());
    let output = Command::new(compiler)
        .arg(format!("-print-file-name={name}"))
        .output()
        .ok()?;
    let file = PathBuf::from(String::from_utf8(output.stdout).ok()?.trim());
    file.is_absolute().then_some(file)?.canonicalize().ok()
}
