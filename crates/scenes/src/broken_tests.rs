//! What is printed for each broken file: line, column, field and, where there is one, the nearest known name.

use std::fs;
use std::path::PathBuf;

use crate::{Scene, SceneError};

fn error_of(text: &str) -> String {
    let read = Scene::from_toml(text, "bad.toml");
    read.err()
        .map_or_else(|| panic!("accepted: {text}"), |error| error.to_string())
}

#[test]
fn broken_texts_are_named() {
    let cases = [
        (
            "",
            "bad.toml: the file is empty: a scene starts with `version = 1`",
        ),
        (
            " \n\t\n",
            "bad.toml: the file is empty: a scene starts with `version = 1`",
        ),
        (
            "name = 'x'\n",
            "bad.toml: version: missing: write `version = 1`",
        ),
        (
            "version = 2\nwings = 3\n",
            "bad.toml:1:11: version: version 2 is from the future: this program reads version 1",
        ),
        (
            "version = 0\n",
            "bad.toml:1:11: version: there is no version 0",
        ),
        (
            "version = 1.0\n",
            "bad.toml:1:11: version: expected a whole number",
        ),
        // Truncated.
        (
            "version = 1\n[[body]]\nname = \"ba",
            "bad.toml:3:11: not valid TOML: invalid basic string, expected '\"'",
        ),
        (
            "version = 1\n[[body]\nname = 'a'\n",
            "bad.toml:2:8: not valid TOML: unclosed array table, expected ']'",
        ),
        (
            "version = 1\n[[body]]\nshape = { circle = ",
            "bad.toml:3:19: not valid TOML: unclosed inline table, expected '}'",
        ),
        (
            "version = 1\nseed = 1\nseed = 2\n",
            "bad.toml:3:1: not valid TOML: duplicate key 'seed'",
        ),
        (
            "version = 1\n[look]\ntheme = 'dark'\n[look]\n",
            "bad.toml:4:2: not valid TOML: duplicate key 'look'",
        ),
        // Unknown names.
        (
            "version = 1\n[[body]]\nname = 'a'\nmasss = 3\nshape = { circle = 1 }\n",
            "bad.toml:4:1: body.masss: unknown field, did you mean \"mass\"?",
        ),
        (
            "version = 1\n\n[[population]]\nname = 'p'\ncount = 3\n    radiuss = 1\n",
            "bad.toml:6:5: population.radiuss: unknown field, did you mean \"radius\"?",
        ),
        (
            "version = 1\n[[body]]\nshape = { cirle = 1 }\n",
            "bad.toml:3:11: body.shape.cirle: unknown shape, did you mean \"circle\"?",
        ),
        (
            "version = 1\n[[body]]\nshapes = [{ square = 1 }, { pentagram = 1 }]\n",
            "bad.toml:3:29: body.shapes[1].pentagram: unknown shape, expected one of circle, rectangle, square, regular, \
             triangle, polygon, hull, star, segment, offset, turn, turn_deg, material, filter",
        ),
        (
            "version = 1\n[settings]\nmode = 'exakt'\n",
            "bad.toml:3:8: settings.mode: unknown name, did you mean \"exact\"?",
        ),
        (
            "version = 1\nsettngs = { tick = 1 }\n",
            "bad.toml:2:1: settngs: unknown field, did you mean \"settings\"?",
        ),
        (
            "version = 1\n[parameters]\nfneft = 1\n",
            "bad.toml:3:1: parameters.fneft: unknown field, did you mean \"fnewt\"?",
        ),
        // Wrong types.
        (
            "version = 1\ngravity = 9.81\n",
            "bad.toml:2:11: gravity: found the number 9.81, expected [x, y]",
        ),
        (
            "version = 1\ngravity = [0, 9.81, 0]\n",
            "bad.toml:2:11: gravity: found a list of 3, expected [x, y]",
        ),
        (
            "version = 1\nseed = 'one'\n",
            "bad.toml:2:8: seed: found the string \"one\", expected a whole number from 0 up",
        ),
        (
            "version = 1\nseed = -1\n",
            "bad.toml:2:8: seed: found the integer -1, expected a whole number from 0 up",
        ),
        (
            "version = 1\n[body]\nname = 'a'\n",
            "bad.toml:2:1: body: found a table, expected a list",
        ),
        (
            "version = 1\n[[body]]\nshape = { polygon = [[0, 0], [1, 0], [0, '1']] }\n",
            "bad.toml:3:42: body.shape.polygon[2][1]: found the string \"1\", expected a number",
        ),
        (
            "version = 1\n[[body]]\nshape = { polygon = [[0, 0], [1], [0, 1]] }\n",
            "bad.toml:3:30: body.shape.polygon[1]: found a list of 1, expected [x, y]",
        ),
        (
            "version = 1\n[[body]]\nmaterial = 3\n",
            "bad.toml:3:12: body.material: found the integer 3, expected the name of a material or { density, friction, restitution, tangent_speed }",
        ),
        (
            "version = 1\n[[field]]\nkind = 'radial'\ncentre = [0, 0]\ncore = 1\n",
            "bad.toml:2:1: field.strength: missing: this field must be given",
        ),
        // No field is a date.
        (
            "version = 1\nname = 2020-01-01\n",
            "bad.toml:2:8: name: found the date or time 2020-01-01, which no field takes: a string needs quotes",
        ),
        (
            "version = 1\n[[body]]\nposition = [10:30:00, 1]\n",
            "bad.toml:3:13: body.position[0]: found the date or time 10:30:00, which no field takes: a string needs quotes",
        ),
        // Numbers.
        (
            "version = 1\nduration = nan\n",
            "bad.toml:2:12: duration: nan is not a finite number",
        ),
        (
            "version = 1\nduration = 1e999\n",
            "bad.toml:2:12: duration: 1e999 is not a finite number",
        ),
        (
            "version = 1\n[camera]\nsize = [100000000000000000000, 1]\n",
            "bad.toml:3:9: camera.size[0]: found the integer 100000000000000000000, expected a whole number from 0 to 4294967295",
        ),
        (
            "version = 1\ngravity = [0, -inf]\n",
            "bad.toml:2:15: gravity[1]: -inf is not a finite number",
        ),
        (
            "version = 1\n[[body]]\nshape = { polygon = [[0, 0], [nan, 0], [0, 1]] }\n",
            "bad.toml:3:31: body.shape.polygon[1][0]: nan is not a finite number",
        ),
        // Names.
        (
            "version = 1\n[[body]]\nname = 'ball'\nshape = { circle = 1 }\n[[body]]\nname = 'ball'\nshape = { circle = 1 }\n",
            "bad.toml:6:8: body.name: \"ball\" is already the name of body.name in line 3",
        ),
        (
            "version = 1\n[[body]]\nname = 'p'\nshape = { circle = 1 }\n[[population]]\nname = 'p'\ncount = 1\nradius = 1\nregion = [0, 0, 9, 9]\n",
            "bad.toml:6:8: population.name: \"p\" is already the name of body.name in line 3",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(error_of(text), expected, "\n{text}");
    }
}

#[test]
fn a_mark_and_dos_lines_are_accepted_and_counted() {
    let good = "\u{feff}version = 1\r\n[settings]\r\ntick = 0.01\r\n";
    assert_eq!(
        Scene::from_toml(good, "good").unwrap().file.settings.tick,
        Some(0.01)
    );
    let bad = "\u{feff}version = 1\r\n[settings]\r\ntick = '0.01'\r\n";
    assert_eq!(
        error_of(bad),
        "bad.toml:3:8: settings.tick: found the string \"0.01\", expected a number"
    );
    // Columns count characters, not bytes.
    assert_eq!(
        error_of("version = 1\nlook = { face = 'ünïcödé', tock = 1 }\n"),
        "bad.toml:2:28: look.tock: unknown field, expected one of theme, palette, shaded, spokes, face, centroids, \
         velocities, velocity_scale, contacts, boxes, asleep, time, gravity, restitution, field, counters, stats, caption"
    );
}

#[test]
fn minus_zero_is_zero() {
    let scene = Scene::from_toml("version = 1\ngravity = [-0.0, -0]\n", "zero").unwrap();
    let gravity = scene.file.gravity.unwrap().0;
    assert_eq!(gravity.x.to_bits(), 0);
    assert_eq!(gravity.y.to_bits(), 0);
}

#[test]
fn nesting_has_an_end() {
    let deep = format!("version = 1\nname = {}", "[".repeat(100_000));
    assert!(
        error_of(&deep).ends_with("not valid TOML: nested too deep"),
        "{}",
        error_of(&deep)
    );
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder =
            std::env::temp_dir().join(format!("carom-scenes-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

#[test]
fn broken_files_are_named() {
    let folder = Folder::new("broken");
    let error_at = |name: &str, bytes: Option<&[u8]>| {
        let path = folder.0.join(name);
        if let Some(bytes) = bytes {
            fs::write(&path, bytes).unwrap();
        }
        let text = Scene::load(&path).unwrap_err().to_string();
        text.strip_prefix(&format!("{}/", folder.0.display()))
            .unwrap_or(&text)
            .to_owned()
    };
    assert_eq!(error_at("missing.toml", None), "missing.toml: no such file");
    assert_eq!(
        error_at("empty.toml", Some(b"")),
        "empty.toml: the file is empty: a scene starts with `version = 1`"
    );
    assert_eq!(
        error_at("bytes.toml", Some(b"version = 1\n\xff\xfe\x00")),
        "bytes.toml: not UTF-8 text: byte 12 of the file is 0xff"
    );
    assert_eq!(
        error_at("zeros.toml", Some(&[0; 64])).split(": ").nth(1),
        Some("not valid TOML"),
    );
    assert_eq!(
        error_at("bad.toml", Some(b"version = 1\nduratoin = 3\n")),
        "bad.toml:2:1: duratoin: unknown field, did you mean \"duration\"?"
    );
    let large = vec![b'#'; usize::try_from(crate::MAX_BYTES).unwrap() + 1];
    assert_eq!(
        error_at("large.toml", Some(&large)),
        "large.toml: 16777217 bytes are over the limit of 16777216 bytes"
    );
    let folder_error = Scene::load(&folder.0).unwrap_err();
    assert!(
        folder_error
            .to_string()
            .ends_with(": is a folder, not a scene file"),
        "{folder_error}"
    );
}

fn set_error(key: &str, value: &str) -> SceneError {
    let text = "version = 1\nduration = 3\n[[body]]\nname = 'ball'\nshape = { circle = 1 }\n";
    let mut scene = Scene::from_toml(text, "good.toml").unwrap();
    let error = scene.set(key, value).unwrap_err();
    assert_eq!(
        scene.file.duration, 3.0,
        "an error leaves the scene as it was"
    );
    error
}

#[test]
fn wrong_settings_are_named() {
    for (key, value, expected) in [
        (
            "nn",
            "3",
            "good.toml: --set nn=3: nn: unknown field, did you mean \"n\"?",
        ),
        (
            "durations",
            "3",
            "good.toml: --set durations=3: durations: unknown field, did you mean \"duration\"?",
        ),
        (
            "n",
            "many",
            "good.toml: --set n=many: parameters.n: found the string \"many\", expected a whole number from 0 up",
        ),
        (
            "v",
            "nan",
            "good.toml: --set v=nan: parameters.v: nan is not a finite number",
        ),
        (
            "fconst",
            "[0, 1, 2]",
            "good.toml: --set fconst=[0, 1, 2]: parameters.fconst: found a list of 3, expected [x, y]",
        ),
        (
            "settings.pairs",
            "some",
            "good.toml: --set settings.pairs=some: settings.pairs: unknown name, expected one of none, all, indexed",
        ),
        (
            "body.bell.mass",
            "3",
            "good.toml: --set body.bell.mass=3: body.bell: unknown name, did you mean \"ball\"?",
        ),
        (
            "body.4.mass",
            "3",
            "good.toml: --set body.4.mass=3: body.4: there are 1 items, numbered from 0",
        ),
        (
            "body.ball.mas",
            "3",
            "good.toml: --set body.ball.mas=3: body.mas: unknown field, did you mean \"mass\"?",
        ),
        (
            "duration.x",
            "3",
            "good.toml: --set duration.x=3: duration.x: this field holds no table",
        ),
        (
            "version",
            "7",
            "good.toml: --set version=7: version: version 7 is from the future: this program reads version 1",
        ),
        ("", "7", "good.toml: --set =7: missing: a key before the ="),
    ] {
        assert_eq!(set_error(key, value).to_string(), expected);
    }
}

#[test]
fn settings_go_where_their_path_says() {
    let text = "version = 1\n[[body]]\nname = 'ball'\nshape = { circle = 1 }\n";
    let mut scene = Scene::from_toml(text, "good.toml").unwrap();
    for (key, value) in [
        ("n", "50"),
        ("parameters.v", "[1, 2]"),
        ("settings.substep", "0.002"),
        ("settings.pairs", "none"),
        ("settings.contact.push_out", "2"),
        ("body.ball.velocity", "[3, 4]"),
        ("body.0.shape.circle", "2"),
        ("body.ball.velocity.1", "5"),
        ("duration", "4"),
        ("duration", "5"),
    ] {
        scene.set(key, value).unwrap();
    }
    let file = &scene.file;
    assert_eq!(file.parameters.n, Some(50));
    assert_eq!(
        file.parameters.v.map(|v| (v.least, v.most)),
        Some((1.0, 2.0))
    );
    assert_eq!(file.settings.substep, Some(0.002));
    assert_eq!(file.settings.pairs, Some(crate::model::PairsName::None));
    assert_eq!(file.settings.contact.push_out, Some(2.0));
    assert_eq!(
        file.body[0].velocity.map(|v| (v.0.x, v.0.y)),
        Some((3.0, 5.0))
    );
    assert_eq!(
        file.body[0].shape.as_ref().and_then(|shape| shape.circle),
        Some(2.0)
    );
    assert_eq!(file.duration, 5.0);
}
