//! What scenes are built to, and what is refused on the way.

use carom_math::{Vec2, vec2};

use crate::{Built, Scene, find};

pub(crate) fn built(text: &str) -> Built {
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
            body("material = { tangent_speed = 1e13 }"),
            "bad.toml:5:30: body.material.tangent_speed: tangent_speed is 1e13, beyond the limit of 1e12 (body \"ball\")",
        ),
        (
            body("filter = { mask = [3, 64] }"),
            "bad.toml:5:19: body.filter.mask: there is no category 64: they are 0..63",
        ),
        (
            body("[[pair]]\nbodies = ['ball', 'bal']\nfriction = 1"),
            "bad.toml:6:19: pair.bodies[1]: unknown body, did you mean \"ball\"?",
        ),
        (
            body("[[pair]]\nbodies = ['ball', 'ball']\nfriction = 1"),
            "bad.toml:6:10: pair.bodies: body 0 cannot form a pair with itself",
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
            "bad.toml:7:15: materials.rubber.restitution: restitution is 2, outside 0..1",
        ),
        (
            body("position = [1e13, 0]"),
            "bad.toml:5:12: body.position: position.x is 1e13, beyond the limit of 1e12 (body \"ball\")",
        ),
        (
            body("[materials.rubber]\nfriction = -1"),
            "bad.toml:6:12: materials.rubber.friction: friction is -1, below 0",
        ),
        (
            body("angle_deg = 1e15"),
            "bad.toml:5:13: body.angle_deg: angle_deg is 1e15, beyond the limit of 1e12 rad",
        ),
        (
            body("[[body]]\nname = 'wall'\nkind = 'fixed'\nposition = [9, 0]\nshape = { circle = 1 }\n[[pair]]\nbodies = ['ball', 'wall']\nfriction = 1\n[[pair]]\nbodies = ['wall', 'ball']\nfriction = 0"),
            "bad.toml:14:10: pair.bodies: \"wall\" and \"ball\" are already a pair: pair.bodies in line 11",
        ),
        (body("angle = 1\nangle_deg = 3"), "bad.toml:5:9: body.angle: both angle and angle_deg are given"),
        (body("colour = 'red'"), "bad.toml:5:10: body.colour: 'red' is no colour: write #rrggbb or #rrggbbaa"),
        (
            body("face = 'no-such-face.png'"),
            "bad.toml:5:8: body.face: cannot read no-such-face.png: no such file",
        ),
        (
            body("face = ''"),
            "bad.toml:5:8: body.face: the name is empty: builtin, or a PNG file beside the scene",
        ),
        (
            body("mass = 5e-324"),
            "bad.toml:5:8: body.mass: mass is 5e-324, too small for the shape: the moment of inertia is 0 (body \"ball\")",
        ),
        (
            body("inertia = 0"),
            "bad.toml:5:11: body.inertia: inertia is 0, not above 0 (body \"ball\")",
        ),
        (
            body("kind = 'fixed'\nvelocity = [0, -1.5]"),
            "bad.toml:6:12: body.velocity: [0, -1.5] on a fixed body, which does not move: kind = \"kinematic\" does",
        ),
        (
            body("kind = 'fixed'\nspin = 2"),
            "bad.toml:6:8: body.spin: 2 on a fixed body, which does not move: kind = \"kinematic\" does",
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
fn values_that_were_set_are_named_as_such() {
    let mut scene = find("flying-balls").unwrap();
    scene.set("restitution", "5").unwrap();
    assert_eq!(
        scene.build().unwrap_err().to_string(),
        "flying-balls: --set restitution=5: parameters.restitution: restitution is 5, outside 0..1 (body \"wall/left\")"
    );
    let mut scene = find("stack").unwrap();
    scene.set("camera.size", "[100000, 100000]").unwrap();
    assert_eq!(
        scene.build().unwrap_err().to_string(),
        "stack: --set camera.size=[100000, 100000]: camera.size: canvas of 100000 x 100000 px is over the limit of \
         16384 px a side and 67108864 px in all"
    );
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

#[test]
fn the_bar_shows_the_restitution_of_the_liveliest_surface_wherever_it_stands() {
    let bar = |text: &str| {
        let built = built(&format!("version = 1\n{text}"));
        built.overlays.restitution.expect("every overlay is there")
    };
    let lively = "material = { restitution = 0.8 }\n";
    let ball = "[[body]]\nname = 'a'\nshape = { circle = 1 }\n";
    for (what, text) in [
        ("a body", format!("{ball}{lively}")),
        (
            "a part of a body",
            "[[body]]\nname = 'a'\nshapes = [{ circle = 1 }, { circle = 1, material = { restitution = 0.8 } }]\n"
                .to_owned(),
        ),
        (
            "a grid",
            format!(
                "[[grid]]\nname = 'g'\ncolumns = 2\nrows = 2\ncorner = [0, 0]\nspacing = [3, 3]\nshape = {{ circle = 1 }}\n{lively}"
            ),
        ),
        (
            "a stack",
            format!("[[stack]]\nname = 's'\ncount = 2\nsize = [1, 1]\nbase = [0, 0]\n{lively}"),
        ),
        (
            "a pyramid",
            format!("[[pyramid]]\nname = 'p'\nrows = 2\nsize = [1, 1]\nbase = [0, 0]\n{lively}"),
        ),
        (
            "a pair",
            format!(
                "{ball}[[body]]\nname = 'b'\nposition = [5, 0]\nshape = {{ circle = 1 }}\n\
                 [[pair]]\nbodies = ['a', 'b']\nfriction = 0.5\nrestitution = 0.8\n"
            ),
        ),
    ] {
        assert_eq!(bar(&text), 0.8, "{what}");
        assert_eq!(bar(&format!("{text}[parameters]\nrestitution = 0.25\n")), 0.25, "{what}");
    }
    assert_eq!(bar(ball), 0.0);
}
