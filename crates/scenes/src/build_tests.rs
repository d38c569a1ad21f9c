//! What scenes are built to, and what is refused on the way.

use std::fmt::Write as _;

use carom_dynamics::{Body, BodyKind, World};
use carom_geometry::Outline;
use carom_math::{Vec2, vec2};
use proptest::prelude::*;

use crate::{Built, Scene, find, list};

fn built(text: &str) -> Built {
    let scene = Scene::from_toml(text, "good.toml").unwrap_or_else(|error| panic!("{error}"));
    scene
        .build()
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refusal(text: &str) -> String {
    let scene = Scene::from_toml(text, "bad.toml").unwrap_or_else(|error| panic!("{error}"));
    scene
        .build()
        .err()
        .map_or_else(|| panic!("accepted: {text}"), |error| error.to_string())
}

#[test]
fn every_built_in_scene_builds_and_runs() {
    for info in list() {
        let scene = find(info.name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name(), info.name);
        assert!(!info.summary.is_empty(), "{} has no description", info.name);
        assert!(
            info.text.starts_with("# "),
            "{} says first what is seen",
            info.name
        );
        assert!(
            info.text.contains("\n# Right:"),
            "{} says what is right",
            info.name
        );
        let mut built = scene.build().unwrap_or_else(|error| panic!("{error}"));
        let start = built.world.state_hash();
        for _ in 0..6 {
            built.world.step(1.0 / 60.0);
        }
        let mut again = scene.build().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(
            again.world.state_hash(),
            start,
            "{}: same file, same bits",
            info.name
        );
        for _ in 0..6 {
            again.world.step(1.0 / 60.0);
        }
        assert_eq!(
            again.world.state_hash(),
            built.world.state_hash(),
            "{}",
            info.name
        );
        for body in built.world.bodies() {
            assert!(body.centre().is_finite(), "{}", info.name);
        }
    }
}

/// How deep a corner or centre of `a` lies in `b`, at most: 0 or less if none does.
fn depth(a: &Body<'_>, b: &Body<'_>) -> f64 {
    let mut deepest = f64::NEG_INFINITY;
    for (shape_a, _) in a.shapes() {
        let (points, radius) = match shape_a.outline() {
            Outline::Circle { centre, radius } => (vec![centre], radius),
            Outline::Open(points) | Outline::Closed(points) => (points.to_vec(), 0.0),
        };
        for point in points {
            let local = b.pose().inverse_point(a.pose().point(point));
            for (shape_b, _) in b.shapes() {
                deepest = deepest.max(radius - shape_b.signed_distance(local));
            }
        }
    }
    deepest
}

#[test]
fn built_in_scenes_start_apart() {
    for info in list() {
        let mut scene = find(info.name).unwrap();
        if info.name == "sat" {
            // Its two squares overlap on purpose.
            scene
                .set("body.right square.position", "[4.2, -1.8]")
                .unwrap();
        }
        if info.name == "projectile" {
            continue; // Nobody meets anybody, and all start in one point.
        }
        let built = scene.build().unwrap();
        let name = |body: &Body<'_>| {
            let found = built.names.iter().find(|(_, id)| *id == body.id());
            found.map_or("?", |(name, _)| name.as_str())
        };
        let bodies: Vec<_> = built.world.bodies().collect();
        for (i, a) in bodies.iter().enumerate() {
            for b in &bodies[..i] {
                let moving = [a, b].iter().any(|body| body.kind() == BodyKind::Dynamic);
                if moving && a.aabb().overlaps(b.aabb()) {
                    let deep = depth(a, b).max(depth(b, a));
                    assert!(
                        deep <= 1e-9,
                        "{}: {} is {deep:e} m deep in {}",
                        info.name,
                        name(a),
                        name(b)
                    );
                }
            }
        }
    }
}

#[test]
fn every_built_in_scene_is_in_the_list() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    files.sort_unstable();
    let mut listed: Vec<&str> = list().iter().map(|info| info.name).collect();
    listed.sort_unstable();
    assert_eq!(files, listed);
}

#[test]
fn wrong_values_are_named_with_their_place() {
    let body = |rest: &str| {
        format!("version = 1\n[[body]]\nname = 'ball'\nshape = {{ circle = 1 }}\n{rest}\n")
    };
    let cases = [
        (body("mass = -1"), "bad.toml:5:8: body.mass: mass is -1, not above 0 (body \"ball\")"),
        (
            body("material = { restitution = 1.5 }"),
            "bad.toml:5:28: body.material.restitution: restitution is 1.5, outside 0..1 (body \"ball\")",
        ),
        (
            body("material = { friction = -0.5 }"),
            "bad.toml:5:25: body.material.friction: friction is -0.5, below 0 (body \"ball\")",
        ),
        (
            body("material = 'rubbr'\n[materials.rubber]\nfriction = 1"),
            "bad.toml:5:12: body.material: unknown material, did you mean \"rubber\"?",
        ),
        (
            body("material = 'rubber'\n[materials.rubber]\nrestitution = 2"),
            "bad.toml:7:15: materials.rubber.restitution: restitution is 2, outside 0..1 (body \"ball\")",
        ),
        (
            body("position = [1e13, 0]"),
            "bad.toml:5:12: body.position: position.x is 1e13, beyond the limit of 1e12 (body \"ball\")",
        ),
        (body("angle = 1\nangle_deg = 3"), "bad.toml:5:9: body.angle: both angle and angle_deg are given"),
        (body("colour = 'red'"), "bad.toml:5:10: body.colour: 'red' is no colour: write #rrggbb or #rrggbbaa"),
        (
            body("face = 'no-such-face.png'"),
            "bad.toml:5:8: body.face: cannot read no-such-face.png: no such file",
        ),
        (
            "version = 1\n[[body]]\nname = 'a'\n".to_owned(),
            "bad.toml:2:1: body.shape: missing: a body needs a shape",
        ),
        (
            "version = 1\n[[body]]\nshape = { circle = 1, square = 1 }\n".to_owned(),
            "bad.toml:3:9: body.shape: one shape has both circle and square",
        ),
        (
            "version = 1\n[[body]]\nshape = { turn = 1 }\n".to_owned(),
            "bad.toml:3:9: body.shape: missing: a shape, like circle = 0.5",
        ),
        ("version = 1\nduration = 0\n".to_owned(), "bad.toml:2:12: duration: 0 s is not above 0 and at most 1e7 s"),
        (
            "version = 1\nfps = 0\n".to_owned(),
            "bad.toml:2:7: fps: frame rate is 0 per second: it must lie in 1..=1000",
        ),
        (
            "version = 1\n[settings]\ntick = -1\n".to_owned(),
            "bad.toml:3:8: settings.tick: settings.tick is -1, not above 0",
        ),
        (
            "version = 1\n[parameters]\ndelta = 0\n".to_owned(),
            "bad.toml:3:9: parameters.delta: settings.tick is 0, not above 0",
        ),
        (
            "version = 1\n[settings]\ncontact = { over_relaxation = 3 }\n".to_owned(),
            "bad.toml:3:31: settings.contact.over_relaxation: settings.contact.over_relaxation is 3, outside 0.1..1.9",
        ),
        (
            "version = 1\n[camera]\nsize = [0, 100]\n".to_owned(),
            "bad.toml:3:8: camera.size: canvas of 0 x 100 px has no pixels",
        ),
        (
            "version = 1\n[camera]\ncentre = [0, 0]\nheight = 0\n".to_owned(),
            "bad.toml:4:10: camera.height: camera scale is inf px/m: it must be positive and finite",
        ),
        (
            "version = 1\n[parameters]\nn = 3\n".to_owned(),
            "bad.toml:3:5: parameters.n: the scene has no [[population]] that it could be about",
        ),
        (
            "version = 1\n[[field]]\nkind = 'radial'\ncentre = [0, 0]\nstrength = 3\ncore = 0\n".to_owned(),
            "bad.toml:6:8: field.core: field.core is 0, not above 0",
        ),
        (
            "version = 1\n[walls]\ninner = [1, 0, 0, 1]\n".to_owned(),
            "bad.toml:3:9: walls.inner: the room is -1 m x 1 m: [x0, y0] is the lower left corner",
        ),
        (
            "version = 1\n[[pyramid]]\nname = 'p'\nrows = 18446744073709551615\nbase = [0, 0]\nsize = [1, 1]\n".to_owned(),
            "bad.toml:4:8: pyramid.rows: 18446744073709551615 makes more than 1000000 bodies",
        ),
        (
            "version = 1\n[[population]]\nname = 'gas'\ncount = 50\nregion = [0, 0, 4, 4]\nradius = 0.5\n".to_owned(),
            "bad.toml:2:1: population: only 9 of 50 bodies of population \"gas\" fit without overlap (gave up after 5000 tries)",
        ),
        (
            "version = 1\n[[population]]\nname = 'gas'\ncount = 5\nregion = [0, 0, 4, 4]\nradius = [0.5, 0.1]\n".to_owned(),
            "bad.toml:6:10: population.radius: radii go from 0.5 to 0.1: they must rise, from above 0",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(refusal(&text), expected, "\n{text}");
    }
}

#[test]
fn broken_shapes_are_named() {
    // The reason is geometry's own; the place is ours.
    for (shape, place) in [
        ("{ circle = 0 }", "bad.toml:3:20: body.shape.circle: "),
        ("{ circle = -1 }", "bad.toml:3:20: body.shape.circle: "),
        (
            "{ rectangle = [1, 0] }",
            "bad.toml:3:23: body.shape.rectangle: ",
        ),
        (
            "{ regular = { sides = 2, radius = 1 } }",
            "bad.toml:3:21: body.shape.regular: ",
        ),
        (
            "{ regular = { sides = 1000000000, radius = 1 } }",
            "bad.toml:3:21: body.shape.regular: ",
        ),
        (
            "{ triangle = { a = 1, b = 1 } }",
            "bad.toml:3:22: body.shape.triangle: ",
        ),
        (
            "{ polygon = [[0, 0], [1, 0]] }",
            "bad.toml:3:21: body.shape.polygon: ",
        ),
        (
            "{ polygon = [[0, 0], [1, 1], [2, 2]] }",
            "bad.toml:3:21: body.shape.polygon: ",
        ),
        (
            "{ polygon = [[0, 0], [1, 1], [1, 0], [0, 1]] }",
            "bad.toml:3:21: body.shape.polygon: ",
        ),
        (
            "{ hull = [[0, 0], [1, 1]] }",
            "bad.toml:3:18: body.shape.hull: ",
        ),
        (
            "{ star = { points = 2, outer = 1, inner = 0.5 } }",
            "bad.toml:3:18: body.shape.star: ",
        ),
        (
            "{ segment = [[0, 0], [0, 0]] }",
            "bad.toml:3:21: body.shape.segment: ",
        ),
    ] {
        let error = refusal(&format!("version = 1\n[[body]]\nshape = {shape}\n"));
        assert!(
            error.starts_with(place) && error.len() > place.len(),
            "{shape}: {error}"
        );
    }
}

#[test]
fn every_shape_has_its_area() {
    let quarter = core::f64::consts::FRAC_PI_4;
    for (shape, area) in [
        ("{ circle = 0.5 }", quarter),
        ("{ circle = 0.5, offset = [3, 1] }", quarter),
        ("{ rectangle = [2, 0.5] }", 1.0),
        ("{ square = 2, turn_deg = 30 }", 4.0),
        ("{ regular = { sides = 4, radius = 1 } }", 2.0),
        ("{ triangle = { a = 3, b = 4, angle_deg = 90 } }", 6.0),
        (
            "{ triangle = { a = 3, b = 4, angle = 1.5707963267948966 }, turn = 1 }",
            6.0,
        ),
        (
            "{ polygon = [[0, 0], [0, 2], [1, 2], [1, 1], [2, 1], [2, 0]] }",
            3.0,
        ),
        ("{ hull = [[0, 0], [2, 0], [1, 0.5], [2, 2], [0, 2]] }", 4.0),
        // 10 triangles between a tip and a notch: n R r sin(pi / n).
        (
            "{ star = { points = 5, outer = 2, inner = 1 }, offset = [1, 1] }",
            10.0 * 0.587_785_252_292_473_1,
        ),
    ] {
        let built = built(&format!(
            "version = 1\n[[body]]\nname = 'it'\nshape = {shape}\n"
        ));
        let body = built.world.body(built.body("it").unwrap()).unwrap();
        assert!(
            (body.mass() - area).abs() < 1e-12,
            "{shape}: {} kg, expected {area}",
            body.mass()
        );
    }
}

#[test]
fn an_offset_moves_the_centre() {
    let built = built(
        "version = 1\n[[body]]\nname = 'it'\nposition = [1, 1]\nangle_deg = 90\nshape = { square = 1, offset = [2, 0] }\n",
    );
    let body = built.world.body(built.body("it").unwrap()).unwrap();
    assert!(
        (body.centre() - vec2(1.0, 3.0)).length() < 1e-14,
        "{}",
        body.centre()
    );
}

#[test]
fn an_impulse_acts_at_the_start() {
    let built = built(
        "version = 1\n[[body]]\nname = 'it'\nshape = { square = 2 }\nimpulse = { at = [1, 0], value = [0, 8] }\n",
    );
    let body = built.world.body(built.body("it").unwrap()).unwrap();
    assert!((body.velocity() - vec2(0.0, 2.0)).length() < 1e-14);
    assert!((body.angular_velocity() - 3.0).abs() < 1e-14);
}

#[test]
fn generators_place_what_they_say() {
    let built = built(
        "version = 1\n[[pyramid]]\nname = 'p'\nrows = 3\nbase = [0, 0]\nsize = [1, 0.5]\ngap = [0.1, 0]\n\
         [[stack]]\nname = 's'\ncount = 2\nbase = [9, 0]\nsize = [1, 1]\ngap = 0.5\n\
         [[grid]]\nname = 'g'\nkind = 'fixed'\ncolumns = 2\nrows = 2\ncorner = [20, 0]\nspacing = [2, 3]\nshape = { circle = 1 }\n\
         [walls]\ninner = [-50, -50, 50, 50]\n",
    );
    let place = |name: &str| {
        let id = built.body(name).unwrap_or_else(|| panic!("no {name}"));
        built.world.body(id).unwrap().centre()
    };
    assert_eq!(built.names.len(), 4 + 2 + 6 + 4);
    for (name, expected) in [
        ("p/0", vec2(-1.1, 0.25)),
        ("p/2", vec2(1.1, 0.25)),
        ("p/3", vec2(-0.55, 0.75)),
        ("p/5", vec2(0.0, 1.25)),
        ("s/1", vec2(9.0, 2.0)),
        ("g/1", vec2(22.0, 0.0)),
        ("g/2", vec2(20.0, 3.0)),
        ("wall/floor", vec2(0.0, -50.5)),
        ("wall/right", vec2(50.5, 0.0)),
    ] {
        assert!(
            (place(name) - expected).length() < 1e-12,
            "{name} is at {}",
            place(name)
        );
    }
}

#[test]
fn the_original_parameters_stand_for_places_in_the_file() {
    let mut balls = find("flying-balls").unwrap();
    for (key, value) in [
        ("n", "7"),
        ("radius", "0.25"),
        ("v", "3"),
        ("fconst", "[1, 2]"),
        ("delta", "0.01"),
        ("restitution", "0.25"),
    ] {
        balls.set(key, value).unwrap();
    }
    balls.set("collisions", "all").unwrap();
    let built = balls.build().unwrap();
    let settings = built.world.settings();
    assert_eq!(settings.gravity, vec2(1.0, 2.0));
    assert_eq!(settings.tick, 0.01);
    assert_eq!(settings.pair_search, carom_dynamics::PairSearch::AllPairs);
    let flying: Vec<_> = built
        .names
        .iter()
        .filter(|(name, _)| name.starts_with("balls/"))
        .collect();
    assert_eq!(flying.len(), 7);
    for (name, id) in flying {
        let body = built.world.body(*id).unwrap();
        assert!((body.velocity().length() - 3.0).abs() < 1e-12, "{name}");
        let (shape, material) = body.shapes().next().unwrap();
        assert_eq!(shape.reach_about(Vec2::ZERO), 0.25);
        assert_eq!(material.restitution, 0.25);
    }
    assert_eq!(built.body("core/0"), None, "fnewt = 0: no core");
    balls.set("fnewt", "50").unwrap();
    let built = balls.build().unwrap();
    let core = built.world.body(built.body("core/0").unwrap()).unwrap();
    assert_eq!(
        core.shapes().next().unwrap().1.restitution,
        0.5,
        "the core has its own material"
    );
}

#[test]
fn a_setting_over_the_file_is_as_good_as_in_the_file() {
    let file = |n: u32| {
        format!(
            "version = 1\nseed = 4\n[parameters]\nn = {n}\n[[population]]\nname = 'p'\ncount = 1\n\
             region = [0, 0, 40, 40]\nradius = [0.2, 1]\nshapes = ['disc', 'random', 'star']\n"
        )
    };
    let mut scene = Scene::from_toml(&file(3), "a").unwrap();
    assert_ne!(
        scene.build().unwrap().world.state_hash(),
        built(&file(40)).world.state_hash()
    );
    scene.set("n", "40").unwrap();
    assert_eq!(
        scene.build().unwrap().world.state_hash(),
        built(&file(40)).world.state_hash()
    );
    scene.set("seed", "5").unwrap();
    assert_ne!(
        scene.build().unwrap().world.state_hash(),
        built(&file(40)).world.state_hash()
    );
}

/// The bodies of a population as circles: place, and reach of the shape.
fn circles(world: &World) -> Vec<(Vec2, f64)> {
    world
        .bodies()
        .map(|body| {
            let reach = body
                .shapes()
                .map(|(shape, _)| shape.reach_about(Vec2::ZERO));
            (body.pose().position, reach.fold(0.0, f64::max))
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn populations_lie_inside_and_apart(
        seed in 0..=i64::MAX,
        count in 1_u32..60,
        least in 0.05..0.5_f64,
        more in 0.0..0.5_f64,
        shapes in prop::sample::subsequence(vec!["disc", "regular", "random", "rectangle", "star"], 1..=5),
    ) {
        let most = least + more;
        // A third of the area is taken at most.
        let side = (f64::from(count) * 3.0 * 3.2 * most * most).sqrt() + 2.0 * most;
        let mut text = String::new();
        let _ = write!(
            text,
            "version = 1\nseed = {seed}\ngravity = [0, 0]\n[[population]]\nname = 'p'\ncount = {count}\n\
             region = [-1, -2, {}, {}]\nradius = [{least}, {most}]\nspeed = [1, 2]\nshapes = {shapes:?}\n",
            side - 1.0, side - 2.0,
        );
        let scene = Scene::from_toml(&text, "p").map_err(|error| TestCaseError::fail(error.to_string()))?;
        let built = scene.build().map_err(|error| TestCaseError::fail(error.to_string()))?;
        let circles = circles(&built.world);
        prop_assert_eq!(circles.len(), count as usize);
        for (i, &(a, reach_a)) in circles.iter().enumerate() {
            prop_assert!(reach_a <= most * (1.0 + 1e-12));
            // Rounding of the corners' places on their circle.
            let inside = a - vec2(-1.0, -2.0);
            prop_assert!(inside.min_element() >= reach_a - 1e-9 && inside.max_element() <= side - reach_a + 1e-9);
            for &(b, reach_b) in &circles[..i] {
                prop_assert!(a.distance(b) >= reach_a + reach_b - 1e-12, "{a} {reach_a} {b} {reach_b}");
            }
        }
        for body in built.world.bodies() {
            prop_assert!((1.0 - 1e-12..=2.0 + 1e-12).contains(&body.velocity().length()));
        }
        let again = scene.build().map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(again.world.state_hash(), built.world.state_hash());
    }

    #[test]
    fn any_text_is_read_or_refused_on_one_line(text in "\\PC{0,80}") {
        let text = format!("version = 1\n{text}");
        if let Err(error) = Scene::from_toml(&text, "any") {
            prop_assert!(!error.to_string().contains('\n'));
            prop_assert!(error.to_string().starts_with("any"));
        }
    }

    #[test]
    fn a_cut_or_flipped_scene_never_panics(cut in 0..3000_usize, byte: u8, at in 0..3000_usize) {
        let mut bytes = list()[0].text.as_bytes().to_vec();
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(cut);
        if let Ok(text) = String::from_utf8(bytes)
            && let Err(error) = Scene::from_toml(&text, "flipped").and_then(|scene| scene.build())
        {
            prop_assert!(!error.to_string().contains('\n'), "{error}");
        }
    }
}

#[test]
fn populations_keep_clear_of_what_stands_there() {
    let text = "version = 1\n[[body]]\nname = 'bar'\nkind = 'fixed'\nangle_deg = 45\nshape = { rectangle = [20, 2] }\n\
                [[population]]\nname = 'p'\ncount = 60\nregion = [-8, -8, 8, 8]\nradius = 0.4\n";
    let built = built(text);
    let diagonal = vec2(-1.0, 1.0) / core::f64::consts::SQRT_2;
    for (place, reach) in circles(&built.world).into_iter().skip(1) {
        assert!(
            place.dot(diagonal).abs() >= 1.0 + reach - 1e-12,
            "{place} is in the bar"
        );
    }
}
