//! The tables of README and docs/measurements.md are those of the committed measurements. `UPDATE=1 cargo test -p carom-tests --test
//! it readme` writes them anew.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Rows of the accuracy table: case, metric, what a reader calls it.
const ACCURACY: [(&str, &str, &str); 5] = [
    ("01_projectile", "pos_error_m", "a throw after 1 s, m"),
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

/// Scenes of the table of presets: piles, where overlaps tell.
const PILES: [&str; 6] = [
    "a_large_pyramid",
    "b_many_pyramids",
    "c_smash",
    "d_tumbler",
    "f_polygon_pile",
    "g_concave_pile",
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

    /// The number in a column of the one row with these cells; `None` if it was not measured.
    fn find(&self, column: &str, keys: &[(&str, &str)]) -> Option<f64> {
        let at = |name: &str| self.names.iter().position(|known| known == name);
        let fits = |row: &&Vec<String>| {
            let mut keys = keys.iter();
            keys.all(|(name, value)| at(name).is_some_and(|at| row[at] == *value))
        };
        let row = self.rows.iter().find(fits)?;
        row[at(column)?].parse().ok()
    }

    /// The same of what must be there.
    fn number(&self, column: &str, keys: &[(&str, &str)]) -> f64 {
        let found = self.find(column, keys);
        found.unwrap_or_else(|| panic!("no {column} in a row with {keys:?}"))
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

/// Times of steps.
struct Speed(Table);

/// Engine and mode.
type Run = (&'static str, &'static str);

const OWN: Run = ("carom", "hybrid");
const STEPPED: Run = ("carom", "stepped");
const BOX2D: Run = ("box2d-avx2", "stock");
const RAPIER: Run = ("rapier", "stock");

impl Speed {
    /// Of the scenes of `folder`.
    fn read(folder: &str) -> Self {
        let path = format!("crates/bench/results/{folder}/speed.csv");
        Self(Table::read(&path))
    }

    /// A column of one thread that only steps, or reads all poses as well.
    fn find(&self, column: &str, scene: &str, run: Run, reads: bool) -> Option<f64> {
        let reads = if reads { "true" } else { "false" };
        let keys = [
            ("scene", scene),
            ("engine", run.0),
            ("mode", run.1),
            ("threads", "1"),
            ("reads_poses", reads),
        ];
        self.0.find(column, &keys)
    }

    fn of(&self, column: &str, scene: &str, run: Run) -> f64 {
        let found = self.find(column, scene, run, false);
        found.unwrap_or_else(|| panic!("no {column} of {run:?} in {scene}"))
    }

    /// Times of Box2D's step.
    fn ratio(&self, scene: &str, run: Run) -> f64 {
        self.of("ms_mean", scene, run) / self.of("ms_mean", scene, BOX2D)
    }

    fn title(scene: &str) -> &'static str {
        let published = carom_scenes::plain_scenes().iter();
        published
            .chain(carom_scenes::lively_scenes())
            .find(|info| info.name == scene)
            .expect("a scene")
            .title
    }

    /// The scenes of `cargo xtask speed`.
    fn scenes() -> impl Iterator<Item = &'static str> {
        let names = carom_scenes::plain_scenes().iter().map(|info| info.name);
        names.filter(|name| !name.starts_with("case"))
    }

    /// The README's table, and how it was measured.
    fn short(&self) -> String {
        let mut text =
            "| scene | stepping alone | all poses read | first step |\n|---|---:|---:|---:|\n"
                .to_owned();
        for scene in SPEED {
            let ratio = |column, reads| {
                let [own, peer] = [OWN, BOX2D].map(|run| self.find(column, scene, run, reads));
                short(own.expect("measured") / peer.expect("measured"))
            };
            let cells = [("ms_mean", false), ("ms_mean", true), ("ms_first", false)];
            let [alone, read, first] = cells.map(|(column, reads)| ratio(column, reads));
            let name = Self::title(scene);
            let _ = writeln!(text, "| {name} | {alone} | {read} | {first} |");
        }
        let pyramid = short(self.of("ms_mean", SPEED[0], OWN));
        let _ = write!(text, "\ncarom steps the pyramid in {pyramid} ms. ");
        let both = SPEED
            .iter()
            .flat_map(|scene| [OWN, BOX2D].map(|run| (*scene, run)));
        let spreads = both.map(|(scene, run)| self.find("ms_spread", scene, run, false));
        let _ = match spreads.collect::<Option<Vec<f64>>>() {
            Some(spreads) => {
                let most = 100.0 * spreads.into_iter().fold(0.0, f64::max);
                let runs = self.of("repetitions", SPEED[0], OWN);
                write!(
                    text,
                    "Stepping alone is the median of {runs} runs, which differ by at most {most:.0} %; the rest is of one run. "
                )
            }
            None => write!(
                text,
                "Each number is of one run on a shared machine; repeated runs differ by up to a seventh, of microseconds by up to half. "
            ),
        };
        let rapier = |scene: &&str| {
            let ms = self.find("ms_mean", scene, RAPIER, false)?;
            Some(ms / self.of("ms_mean", scene, BOX2D))
        };
        let ratios: Vec<f64> = SPEED.iter().filter_map(rapier).collect();
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let most = ratios.iter().copied().fold(0.0, f64::max);
        text += &if ratios.len() == SPEED.len() {
            let (least, most) = (short(least), short(most));
            format!("Rapier takes {least} to {most} times Box2D's time, stepping alone.\n")
        } else {
            "Rapier was not timed beside them.\n".to_owned()
        };
        text
    }

    /// Times with what they bought.
    fn long(&self) -> String {
        let rapier =
            Self::scenes().any(|scene| self.find("ms_mean", scene, RAPIER, false).is_some());
        let mut text = "| scene | Box2D AVX2 | spread | first step | energy | overlap, mm | **carom** | spread | first step | energy | overlap, mm | ratio | ratio, `Mode::Stepped` |".to_owned();
        text += if rapier { " Rapier |\n" } else { "\n" };
        text += "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|";
        text += if rapier { "---:|\n" } else { "\n" };
        for scene in Self::scenes() {
            let _ = write!(text, "| {} |", Self::title(scene));
            for run in [BOX2D, OWN] {
                let spread = self.find("ms_spread", scene, run, false);
                let spread =
                    spread.map_or("–".to_owned(), |part| format!("{:.0} %", 100.0 * part));
                let _ = write!(
                    text,
                    " {} | {spread} | {} | {:.3} | {} |",
                    digits(self.of("ms_mean", scene, run), 3),
                    digits(self.of("ms_first", scene, run), 3),
                    self.of("energy_ratio", scene, run),
                    digits(1e3 * self.of("overlap_max", scene, run), 2),
                );
            }
            let [own, stepped] = [OWN, STEPPED].map(|run| digits(self.ratio(scene, run), 2));
            let _ = write!(text, " **{own}** | {stepped} |");
            if rapier {
                let ms = self.find("ms_mean", scene, RAPIER, false);
                let ms = ms.map_or("failed".to_owned(), |ms| digits(ms, 3));
                let _ = write!(text, " {ms} |");
            }
            text.push('\n');
        }
        text += "\nFirst step: of a new world, in ms. Spread: greatest less least mean of the repetitions, over their median; – of a single run.\n";
        text += if rapier {
            "Chipmunk was not timed beside them.\n"
        } else {
            "Box2D's AVX2 build is the only peer: Chipmunk and Rapier were not timed beside it.\n"
        };
        text
    }

    /// Scenes in which much moves: mean and worst step, and mean overlap, in parts of Box2D's.
    fn lively(&self) -> String {
        let mut text = "| scene | Box2D AVX2, ms | **carom** | worst step | overlap | `Mode::Stepped` | worst step | overlap |\n|---|---:|---:|---:|---:|---:|---:|---:|\n".to_owned();
        for info in carom_scenes::lively_scenes() {
            let of = |column, run| self.of(column, info.name, run);
            let ms = digits(of("ms_mean", BOX2D), 3);
            let _ = write!(text, "| {} | {ms} |", info.title);
            for run in [OWN, STEPPED] {
                for column in ["ms_mean", "ms_p99", "overlap_mean"] {
                    let (own, peer) = (of(column, run), of(column, BOX2D));
                    let part = own / peer;
                    let part = if part < 1e-3 {
                        "< 0.001".to_owned()
                    } else {
                        digits(part, 2)
                    };
                    let mark = if run == OWN && column == "ms_mean" {
                        "**"
                    } else {
                        ""
                    };
                    let _ = write!(text, " {mark}{part}{mark} |");
                }
            }
            text.push('\n');
        }
        text
    }

    /// Presets: time and mean overlap, in parts of Box2D's.
    fn presets(&self) -> String {
        let modes = [
            ("default", "hybrid"),
            ("`fast`", "fast"),
            ("`accurate`", "accurate"),
            ("`Mode::Stepped`", "stepped"),
            ("`Mode::Stepped`, `fast`", "stepped-fast"),
            ("`Mode::Stepped`, `accurate`", "stepped-accurate"),
        ];
        let mut text = "| scene |".to_owned();
        for (name, _) in modes {
            let _ = write!(text, " {name} |");
        }
        text += "\n|---|---:|---:|---:|---:|---:|---:|\n";
        for scene in PILES {
            let _ = write!(text, "| {} |", Self::title(scene));
            for (_, mode) in modes {
                let run = ("carom", mode);
                let overlap = self.of("overlap_mean", scene, run);
                let overlap = overlap / self.of("overlap_mean", scene, BOX2D);
                let time = self.ratio(scene, run);
                let _ = write!(text, " {time:.2}, {} |", digits(overlap, 2));
            }
            text.push('\n');
        }
        text
    }
}

/// So many significant digits, written out; whole numbers are not cut.
fn digits(value: f64, count: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let written = format!("{value:.*e}", count - 1);
    let (_, power) = written.split_once('e').expect("an exponent");
    let power: i64 = power.parse().expect("a whole number");
    let decimals = i64::try_from(count).expect("a few digits") - 1 - power;
    format!("{value:.*}", usize::try_from(decimals).unwrap_or(0))
}

/// A text with a table between its mark and `<!-- end -->`.
fn with_table(text: &str, mark: &str, table: &str) -> String {
    let from = text.find(mark).expect("the table's mark");
    let from = from + text[from..].find('\n').expect("a line") + 1;
    let to = from + text[from..].find("<!-- end -->").expect("the table's end");
    format!("{}\n{table}\n{}", &text[..from], &text[to..])
}

#[test]
fn the_tables_are_those_of_the_measurements() {
    let [speed, lively] = ["speed", "lively"].map(Speed::read);
    let tables = [
        ("README.md", "<!-- accuracy", accuracy()),
        ("README.md", "<!-- speed", speed.short()),
        ("docs/measurements.md", "<!-- speed", speed.long()),
        ("docs/measurements.md", "<!-- presets", speed.presets()),
        ("docs/measurements.md", "<!-- lively", lively.lively()),
    ];
    for (name, mark, table) in tables {
        let path = root().join(name);
        let text = std::fs::read_to_string(&path).expect("a page");
        let text = text.replace("\r\n", "\n");
        let written = with_table(&text, mark, &table);
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&path, &written).expect("it can be written");
        } else {
            assert!(
                text == written,
                "{name} is not what the measurements say: UPDATE=1 cargo test -p carom-tests --test it readme"
            );
        }
    }
}

#[test]
fn digits_are_as_many_as_asked_for() {
    let some = [
        (2.5196, 3),
        (14.23, 3),
        (9.996, 3),
        (0.0057334, 3),
        (262.4, 2),
        (0.0, 2),
    ];
    let written = some.map(|(value, count)| digits(value, count));
    assert_eq!(written, ["2.52", "14.2", "10.0", "0.00573", "262", "0"]);
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
