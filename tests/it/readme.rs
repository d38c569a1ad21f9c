//! The README's tables are those of the committed measurements. `UPDATE=1 cargo test -p carom-tests --test it readme` writes them anew.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Rows of the accuracy table: case, metric, what a reader calls it.
const ACCURACY: [(&str, &str, &str); 6] = [
    ("01_projectile", "pos_error_m", "a throw after 1 s, m"),
    (
        "04_two_discs",
        "oblique_vel_err_rel_rms",
        "two discs strike obliquely, velocity",
    ),
    (
        "08_friction",
        "slide_dist_2s",
        "a block slides for 2 s, distance",
    ),
    (
        "12_polygon_gas",
        "energy_dev_worst",
        "elastic polygons in a box for a minute, energy",
    ),
    (
        "13_stack",
        "deepest_m",
        "a stack of twenty, deepest overlap, m",
    ),
    (
        "14_heavy_load",
        "r1000_deepest_m",
        "boxes of 1 kg under one of 1,000 kg, deepest overlap, m",
    ),
];

/// Rows of the speed table.
const SPEED: [&str; 7] = [
    "a_large_pyramid",
    "b_many_pyramids",
    "f_polygon_pile",
    "c_smash",
    "d_tumbler",
    "e_flying_polygons",
    "h_mostly_sleeping",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Rows of a table of measurements, each by the names of its columns.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(path: &str) -> Self {
        let text = std::fs::read_to_string(root().join(path)).expect("committed measurements");
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let names = cells(lines.next().expect("a head"));
        Self {
            names,
            rows: lines.map(cells).collect(),
        }
    }

    /// The number in a column of the one row with these cells.
    fn number(&self, column: &str, keys: &[(&str, &str)]) -> f64 {
        let at = |name: &str| {
            self.names
                .iter()
                .position(|known| known == name)
                .expect("a column")
        };
        let fits = |row: &&Vec<String>| keys.iter().all(|(name, value)| row[at(name)] == *value);
        let row = self.rows.iter().find(fits);
        let row = row.unwrap_or_else(|| panic!("no row with {keys:?}"));
        row[at(column)].parse().expect("a number")
    }
}

/// Two digits, as short as they can be written.
fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-2..1e3).contains(&value) {
        format!("{value:.0e}")
    } else if value >= 10.0 {
        format!("{value:.0}")
    } else if value >= 1.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.2}")
    }
}

fn accuracy() -> String {
    let table = Table::read("crates/bench/results/accuracy/accuracy.csv");
    let mut text =
        "| what, and its error | Box2D v3 (SSE2) | Rapier | **carom** |\n|---|---:|---:|---:|\n"
            .to_owned();
    for (case, metric, name) in ACCURACY {
        let of = |engine, mode| {
            let keys = [
                ("case", case),
                ("metric", metric),
                ("engine", engine),
                ("mode", mode),
                ("hz", "60"),
                ("substeps", ""),
            ];
            short(table.number("error", &keys))
        };
        let [box2d, rapier] = [("box2d-sse2", "stock"), ("rapier", "stock")].map(|(e, m)| of(e, m));
        let own = of("carom", "hybrid");
        let _ = writeln!(text, "| {name} | {box2d} | {rapier} | **{own}** |");
    }
    text
}

fn speed() -> String {
    let table = Table::read("crates/bench/results/speed/speed.csv");
    let mut text = "| scene | stepping alone | all poses read |\n|---|---:|---:|\n".to_owned();
    for scene in SPEED {
        let mut known = carom_scenes::plain_scenes().iter();
        let name = known
            .find(|info| info.name == scene)
            .expect("a scene")
            .title;
        let [alone, read] = ["false", "true"].map(|reads| {
            let of = |engine, mode| {
                let keys = [
                    ("scene", scene),
                    ("engine", engine),
                    ("mode", mode),
                    ("threads", "1"),
                    ("reads_poses", reads),
                ];
                table.number("ms_mean", &keys)
            };
            short(of("carom", "hybrid") / of("box2d-avx2", "stock"))
        });
        let _ = writeln!(text, "| {name} | {alone} | {read} |");
    }
    text
}

#[test]
fn the_tables_are_those_of_the_measurements() {
    let path = root().join("README.md");
    let readme = std::fs::read_to_string(&path)
        .expect("a README")
        .replace("\r\n", "\n");
    let mut written = readme.clone();
    for (mark, table) in [("<!-- accuracy", accuracy()), ("<!-- speed", speed())] {
        let from = written.find(mark).expect("the table's mark");
        let from = from + written[from..].find('\n').expect("a line") + 1;
        let to = from
            + written[from..]
                .find("<!-- end -->")
                .expect("the table's end");
        written.replace_range(from..to, &format!("\n{table}\n"));
    }
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &written).expect("it can be written");
    } else {
        assert!(
            readme == written,
            "README.md is not what the measurements say: UPDATE=1 cargo test -p carom-tests --test it readme"
        );
    }
}

#[test]
fn it_can_be_read_in_two_minutes() {
    let readme = std::fs::read_to_string(root().join("README.md")).expect("a README");
    let is_word = |word: &&str| word.chars().any(char::is_alphabetic);
    let words = readme.split_whitespace().filter(is_word).count();
    assert!(words <= 900, "{words} words");
    let figures = figures(&readme);
    assert!(
        figures.len() <= 60,
        "{} figures: {figures:?}",
        figures.len()
    );
}

/// What a reader takes for a number: words outside of code, comments, tags and addresses that begin with a digit.
///
/// `Box2D` and `MIT or Apache-2.0` are names, `docs/pictures/1.png` behind a link is not read.
fn figures(text: &str) -> Vec<String> {
    let text = without(text, "```", "```");
    let text = without(&text, "<!--", "-->");
    let text = without(&text, "`", "`");
    let text = without(&text, "<", ">");
    let text = without(&text, "](", ")");
    text.split(|c: char| c.is_whitespace() || "|()[]*".contains(c))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_digit()))
        .map(str::to_owned)
        .collect()
}

/// The text without what stands between two marks.
fn without(text: &str, open: &str, close: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(open) {
        kept.push_str(before);
        kept.push(' ');
        rest = after.split_once(close).map_or("", |(_, after)| after);
    }
    kept + rest
}

#[test]
fn figures_are_what_is_read_as_numbers() {
    let text = "Box2D `x = 1` **8e-15** | 0.5 |\n```rust\nlet a = 3;\n```\n[2,025 boxes](a/4.md) <a 5> MIT or Apache-2.0, (16 of 3)";
    assert_eq!(figures(text), ["8e-15", "0.5", "2,025", "16", "3"]);
}
