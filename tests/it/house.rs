//! The house stands as ARCHITECTURE.md draws it: arrows between crates, and between the folders of `dynamics`, point one way.
//!
//! Read are the dependencies of every `Cargo.toml`, and in `crates/dynamics/src` every path from `crate::` on, but for tests.
//! Arrows that point back all the same are counted below. Their numbers may only fall: where one did, the table is lowered with it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Crates by where they lie. Each knows only those of rows above it.
const CRATES: [&[&str]; 12] = [
    &["crates/math"],
    &["crates/geometry"],
    &["crates/collision"],
    &["crates/impact"],
    &["crates/stepped"],
    &["crates/dynamics"],
    &["crates/render"],
    &["crates/scenes"],
    &["crates/carom", "crates/cli"],
    &["crates/bench/c-peers"],
    &["crates/bench"],
    &["tests", "xtask"],
];

/// Folders of `dynamics`. Each knows only those of rows below it. `step`: the files beside the folders.
const FOLDERS: [&[&str]; 8] = [
    &["api"],
    &["step"],
    &["events", "analytic", "stepping"],
    &["broad", "model"],
    &["motion"],
    &["store"],
    &["law"],
    &["values"],
];

/// Arrows of `dynamics` that point back or aside: from, to, and how many names of `to` are used in files of `from`.
const BACK: &[(&str, &str, usize)] = &[
    ("events", "step", 19),
    ("events", "stepping", 2),
    ("stepping", "events", 2),
    ("stepping", "step", 8),
];

/// Blocks `impl World` that lie in neither `api` nor `step`.
const METHODS: &[(&str, usize)] = &[("events", 7), ("stepping", 1)];

fn root() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().expect("the workspace").to_owned()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The row of a table that holds a name.
fn row(table: &[&[&str]], name: &str) -> Option<usize> {
    table.iter().position(|row| row.contains(&name))
}

#[test]
fn crates_know_only_those_before_them() {
    let mut paths = vec![
        "crates/bench/c-peers".to_owned(),
        "tests".into(),
        "xtask".into(),
    ];
    for entry in fs::read_dir(root().join("crates")).expect("a folder") {
        let name = entry.expect("a crate").file_name();
        paths.push(format!("crates/{}", name.to_str().expect("a plain name")));
    }
    for path in &paths {
        let rank = row(&CRATES, path).unwrap_or_else(|| panic!("{path} is in no row of CRATES"));
        for other in dependencies(&read(&root().join(path).join("Cargo.toml"))) {
            let lies = |known: &&&str| other == package(known);
            let known = CRATES.iter().flat_map(|row| row.iter()).find(lies);
            let known =
                known.unwrap_or_else(|| panic!("{path} depends on {other}, which is in no row"));
            assert!(
                row(&CRATES, known) < Some(rank),
                "{path} must not know {known}"
            );
        }
    }
}

/// What a crate is called, by where it lies.
fn package(path: &str) -> String {
    match path.rsplit('/').next() {
        Some("carom") => "carom".into(),
        Some(name) => format!("carom-{name}"),
        None => unreachable!("a split has a last part"),
    }
}

/// Crates of ours in the sections of dependencies of a `Cargo.toml`, those for tests included.
fn dependencies(manifest: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut depends = false;
    for line in manifest.lines() {
        if let Some(section) = line.strip_prefix('[') {
            depends = section.trim_end().ends_with("dependencies]");
        } else if depends && line.starts_with("carom") {
            found.extend(line.split(['.', ' ', '=']).next().map(str::to_owned));
        }
    }
    found
}

/// A file of `dynamics`, without comments and tests.
struct Source {
    /// From `src` on, `/` between its parts.
    path: String,
    folder: String,
    code: String,
}

/// All files of `dynamics` but `lib.rs` and tests.
fn sources() -> Vec<Source> {
    let src = root().join("crates/dynamics/src");
    let (mut folders, mut found) = (vec![src.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("a file").path();
            let name = path.file_name().and_then(|name| name.to_str());
            match name.expect("a plain name") {
                "lib.rs" | "tests.rs" | "naive.rs" => {}
                _ if path.is_dir() => folders.push(path),
                _ => found.push(source(&src, &path)),
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

fn source(src: &Path, path: &Path) -> Source {
    let below = path.strip_prefix(src).expect("it lies there");
    let parts: Vec<_> = below
        .iter()
        .map(|part| part.to_str().expect("a plain name"))
        .collect();
    let folder = if parts.len() > 1 { parts[0] } else { "step" };
    Source {
        path: parts.join("/"),
        folder: folder.into(),
        code: plain(&read(path)),
    }
}

/// Code without comments, up to the tests at its end.
fn plain(text: &str) -> String {
    let end = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
    let lines = text[..end].lines();
    let code = lines.map(|line| line.split("//").next().unwrap_or_default());
    code.collect::<Vec<_>>().join("\n")
}

/// All paths that begin with `crate::`, those in braces one by one, without it.
fn paths(code: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let starts = code.match_indices("crate::").map(|(at, _)| at);
    for at in starts.filter(|at| !code[..*at].ends_with("$") && !code[..*at].ends_with("pub(in ")) {
        tree("", &code[at + "crate::".len()..], &mut found);
    }
    found
}

/// The paths of a use tree that begins here, each after `before`; what is left of the code.
fn tree<'a>(before: &str, code: &'a str, found: &mut BTreeSet<String>) -> &'a str {
    let code = code.trim_start();
    if let Some(mut code) = code.strip_prefix('{') {
        loop {
            code = code.trim_start().trim_start_matches(',').trim_start();
            if let Some(code) = code.strip_prefix('}') {
                return code;
            }
            code = tree(before, code, found);
        }
    }
    let is_name = |c: char| c.is_alphanumeric() || c == '_' || c == '*';
    let (name, code) = code.split_at(code.find(|c| !is_name(c)).unwrap_or(code.len()));
    assert!(!name.is_empty(), "no path at {:?}", code.lines().next());
    let path = match (before, name) {
        ("", name) => name.to_owned(),
        (before, "self") => before.to_owned(),
        (before, name) => format!("{before}::{name}"),
    };
    // Below a type there is nothing that the arrow is about.
    match code.strip_prefix("::") {
        Some(code) if name.starts_with(char::is_lowercase) => tree(&path, code, found),
        _ => {
            found.insert(path);
            let alias = code
                .strip_prefix(" as ")
                .map(|code| code.trim_start_matches(is_name));
            alias.unwrap_or(code)
        }
    }
}

/// The folder that each name at the crate's root comes from; none where it comes from another crate.
fn names_at_the_root(lib: &str) -> BTreeMap<String, String> {
    let mut names = BTreeMap::new();
    for (at, _) in lib.match_indices(" use ") {
        let mut found = BTreeSet::new();
        tree("", &lib[at + " use ".len()..], &mut found);
        for path in found {
            let (first, _) = path.split_once("::").unwrap_or((&path, ""));
            let name = path.rsplit("::").next().expect("a split has a last part");
            names.insert(name.to_owned(), first.to_owned());
        }
    }
    names
}

/// Names that files of one folder use of another one, by both: each with its file.
fn uses() -> BTreeMap<(String, String), BTreeSet<String>> {
    let lib = plain(&read(&root().join("crates/dynamics/src/lib.rs")));
    let names = names_at_the_root(&lib);
    let sources = sources();
    let methods: BTreeMap<_, _> = sources.iter().flat_map(methods_of_the_world).collect();
    let beside = sources.iter().filter(|source| source.folder == "step");
    let beside: BTreeSet<_> = beside
        .filter_map(|source| source.path.strip_suffix(".rs"))
        .collect();
    let mut found: BTreeMap<_, BTreeSet<String>> = BTreeMap::new();
    let mut note = |source: &Source, to: &str, name: String| {
        let arrow = (source.folder.clone(), to.to_owned());
        let uses = found.entry(arrow).or_default();
        uses.insert(format!("{}: {name}", source.path));
    };
    for source in &sources {
        for path in paths(&source.code) {
            let first = path.split("::").next().expect("a split has a first part");
            let to = match names.get(first).map_or(first, String::as_str) {
                name if beside.contains(name) => "step",
                // Other crates, by their names here.
                "geometry" | "impact" | "math" => continue,
                name if name.starts_with("carom_") => continue,
                name => name,
            };
            let file = &source.path;
            assert!(
                row(&FOLDERS, to).is_some(),
                "{file}: crate::{path} comes from no row of FOLDERS"
            );
            note(source, to, path.clone());
        }
        // What a method of the world calls of the world is no path, but an arrow.
        let calls: String = blocks_of_the_world(source).map(dense).collect();
        for (method, folder) in &methods {
            if calls.contains(&format!("self.{method}(")) {
                note(source, folder, format!("World::{method}"));
            }
        }
    }
    found
}

/// A text without its blanks and ends of lines.
fn dense(text: &str) -> String {
    text.split_whitespace().collect()
}

/// The blocks `impl World` of a file.
fn blocks_of_the_world(source: &Source) -> impl Iterator<Item = &str> {
    let blocks = source.code.split("\nimpl World {\n").skip(1);
    blocks.map(|block| block.split("\n}").next().unwrap_or(block))
}

/// The methods of the world that a file has, each with the file's folder.
fn methods_of_the_world(source: &Source) -> Vec<(String, String)> {
    let lines = blocks_of_the_world(source).flat_map(str::lines);
    let heads = lines.filter(|line| line.starts_with("    ") && !line.starts_with("     "));
    let names = heads.filter_map(|line| line.split_once("fn ")?.1.split(['(', '<']).next());
    names
        .map(|name| (name.to_owned(), source.folder.clone()))
        .collect()
}

#[test]
fn folders_of_dynamics_know_only_those_below_them() {
    let mut back: BTreeMap<(String, String), BTreeSet<String>> = uses();
    back.retain(|(from, to), _| {
        let of = |name: &str| row(&FOLDERS, name).unwrap_or_else(|| panic!("{name} is in no row"));
        from != to && of(from) >= of(to)
    });
    let listed: BTreeMap<_, _> = BACK
        .iter()
        .map(|(from, to, count)| (((*from).to_owned(), (*to).to_owned()), *count))
        .collect();
    assert_eq!(listed.len(), BACK.len(), "an arrow is listed twice");
    let arrows: BTreeSet<_> = back.keys().chain(listed.keys()).collect();
    let mut wrong = String::new();
    for arrow in arrows {
        let uses = back.get(arrow).cloned().unwrap_or_default();
        let (is, may) = (uses.len(), listed.get(arrow).copied().unwrap_or(0));
        let (from, to) = arrow;
        if is > may {
            let uses: Vec<_> = uses.into_iter().collect();
            let uses = uses.join("\n    ");
            wrong +=
                &format!("{from} → {to}: {is} names, {may} listed: not one more\n    {uses}\n");
        } else if is < may {
            wrong += &format!("{from} → {to}: {is} names, {may} listed: lower the table\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn the_world_has_its_methods_in_api_and_step() {
    let mut found: BTreeMap<String, usize> = BTreeMap::new();
    for source in sources() {
        let blocks = source
            .code
            .lines()
            .filter(|line| line.starts_with("impl World "));
        let count = blocks.count();
        if count > 0 && !["api", "step"].contains(&source.folder.as_str()) {
            *found.entry(source.folder).or_default() += count;
        }
    }
    let listed: BTreeMap<String, usize> = METHODS
        .iter()
        .map(|(folder, count)| ((*folder).to_owned(), *count))
        .collect();
    assert_eq!(
        found, listed,
        "blocks by folder, and METHODS, which may only fall"
    );
}

/// A path that climbs to the root by `super` would be no arrow here.
#[test]
fn no_file_leaves_its_folder_by_super() {
    for source in sources() {
        let depth = source.path.replace("/mod.rs", "").split('/').count();
        let climbs = "super::".repeat(depth);
        assert!(
            !source.code.contains(&climbs),
            "{}: write crate:: there",
            source.path
        );
    }
}

#[test]
fn every_folder_of_dynamics_tells_its_story() {
    let map = read(&root().join("ARCHITECTURE.md"));
    let folders: BTreeSet<_> = sources().into_iter().map(|source| source.folder).collect();
    for folder in folders.iter().filter(|folder| *folder != "step") {
        assert!(
            row(&FOLDERS, folder).is_some(),
            "{folder} is in no row of FOLDERS"
        );
        assert!(
            map.contains(&format!("| `{folder}` |")),
            "{folder} is not in the code map"
        );
        let story = read(
            &root()
                .join("crates/dynamics/src")
                .join(folder)
                .join("mod.rs"),
        );
        let lines = story
            .lines()
            .take_while(|line| line.starts_with("//!"))
            .count();
        assert!(lines >= 3, "{folder}/mod.rs begins with no story");
    }
}

#[test]
fn the_reader_sees_what_is_used() {
    let code = "use crate::{World, store::{bodies::{self, Bodies}, pairs::Pair as P}, events as e};\n\
                pub(in crate::values) fn f() -> crate::model::gap::Touching { crate::Mode::Exact }";
    let seen: Vec<_> = paths(&plain(code)).into_iter().collect();
    let expected = [
        "Mode",
        "World",
        "events",
        "model::gap::Touching",
        "store::bodies",
        "store::bodies::Bodies",
        "store::pairs::Pair",
    ];
    assert_eq!(seen, expected);
    let manifest = "[package]\nname = \"carom-x\"\n[dev-dependencies]\ncarom-math.workspace = true\n\
                    [target.'cfg(unix)'.dependencies]\ncarom = { path = \"..\" }\n[features]\ncarom-no = []\n";
    let seen: Vec<_> = dependencies(manifest).into_iter().collect();
    assert_eq!(seen, ["carom", "carom-math"]);
}
