//! The built-in scenes: all build, start apart, and give the same bits twice.

use carom_dynamics::{Body, BodyKind};
use carom_geometry::Outline;
use carom_math::vec2;
use carom_render::Frame;

use crate::{Built, Scene, find, list, open, plain_scene};

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
        // A sub-step of a large one is time enough to go wrong.
        let (steps, dt) = if info.large {
            (1, 1.0 / 360.0)
        } else {
            (6, 1.0 / 60.0)
        };
        for _ in 0..steps {
            built.world.step(dt);
        }
        let mut again = scene.build().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(
            again.world.state_hash(),
            start,
            "{}: same file, same bits",
            info.name
        );
        for _ in 0..steps {
            again.world.step(dt);
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
            _ => (shape_a.vertices().to_vec(), 0.0),
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
    // The large ones are looked at with the plain scenes.
    for info in list().iter().filter(|info| !info.large) {
        let mut scene = find(info.name).unwrap();
        if info.name == "sat" {
            // Its two squares overlap on purpose.
            scene
                .set("body.right square.position", "[4.2, -1.8]")
                .unwrap();
        }
        if info.name == "projectile" {
            continue; // No two bodies meet, and all start in one point.
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

/// The built-in scene of a name.
fn built(name: &str) -> Built {
    let scene = find(name).unwrap_or_else(|error| panic!("{error}"));
    scene.build().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn equal_blows_give_equal_speeds_and_the_angular_momentum_of_their_arm() {
    // Names of the rods hold the arm, rounded to centimetres: one third is meant by 0.33.
    let forces = built("forces");
    for (body, arm) in forces.world.bodies().zip([0.0, 1.0 / 3.0, 0.5, 0.75, 1.0]) {
        assert!((body.velocity() - vec2(0.0, 1.0)).length() < 1e-14);
        let angular = body.inertia() * body.angular_velocity();
        assert!(
            (angular - arm).abs() < 1e-14,
            "{angular} for an arm of {arm} m"
        );
    }
    let inertia = built("inertia");
    for (name, id) in &inertia.names {
        let body = inertia.world.body(*id).expect("it was just made");
        if body.kind() != BodyKind::Dynamic {
            continue;
        }
        assert!(
            (body.mass() - 1.0).abs() < 1e-12,
            "{name}: {} kg",
            body.mass()
        );
        assert!(
            (body.velocity() - vec2(0.0, 6.0)).length() < 1e-11,
            "{name}"
        );
        let angular = body.inertia() * body.angular_velocity();
        assert!(
            (angular - 1.5).abs() < 1e-11,
            "{name}: {angular} kg m²/s, is its centroid at its origin?"
        );
    }
}

#[test]
fn projectiles_of_one_speed_lie_on_a_circle_that_falls() {
    let mut built = built("projectile");
    for second in [1.0, 2.0] {
        built.world.step(1.0);
        let centre = vec2(0.0, -0.5 * 9.81 * second * second);
        for body in built.world.bodies() {
            let error = (body.centre() - centre).length() - 10.0 * second;
            assert!(error.abs() < 1e-12, "{error:e} m off after {second} s");
        }
    }
}

#[test]
fn the_first_frame_of_every_scene_shows_every_moving_body() {
    // Of two scenes hundreds of metres wide a part is shown: all of it would be dust.
    let in_part = ["h_mostly_sleeping", "i_mostly_empty"];
    for info in list().iter().filter(|info| !in_part.contains(&info.name)) {
        let built = built(info.name);
        let (min, max) = (built.camera.view().min, built.camera.view().max);
        for body in built.world.bodies() {
            let centre = body.centre();
            let seen = centre.cmpge(min).all() && centre.cmple(max).all();
            assert!(
                seen || body.kind() != BodyKind::Dynamic,
                "{}: {centre} is out of the picture",
                info.name
            );
        }
        assert!(
            !Frame::capture(&built.world, &built.look, &built.camera)
                .ops()
                .is_empty()
        );
    }
}

#[test]
fn plain_scenes_are_found_by_letter_and_by_size() {
    assert_eq!(find("a").unwrap().name(), "a_large_pyramid");
    assert_eq!(open("e_dilute").unwrap().name(), "e_dilute");
    let mut growing = find("grow_free_200").unwrap();
    growing.set("settings.substep", "0.01").unwrap();
    growing.set("gravity", "[0.0, -1.0]").unwrap();
    let built = growing.build().unwrap();
    assert_eq!(built.world.bodies().count(), 200);
    assert_eq!(built.world.settings().gravity, vec2(0.0, -1.0));
    assert_eq!(built.world.settings().substep, 0.01);
    assert!(built.world.settings().sleep.is_none() && built.body("grow_free_200/199").is_some());
    let error = find("e_flyng_polygons").unwrap_err().to_string();
    let hint = "did you mean \"e_flying_polygons\"?";
    assert_eq!(error, format!("e_flyng_polygons: unknown scene, {hint}"));
}

#[test]
fn a_plain_table_takes_its_scene_and_bodies_or_says_why_not() {
    let text = |rest: &str| format!("version = 1\n[plain]\nscene = {rest}\n");
    let build =
        |rest: &str| Scene::from_toml(&text(rest), "x.toml").and_then(|scene| scene.build());
    let built = build("\"case19_polygon_pairs\"\nfirst = 14\ncount = 2").unwrap();
    let published = plain_scene("case19_polygon_pairs").unwrap();
    let places = published.bodies[14..16].iter().map(|body| body.position);
    assert!(places.eq(built.world.bodies().map(|body| body.pose().position)));
    let error = |rest: &str| build(rest).map(drop).unwrap_err().to_string();
    assert_eq!(
        error("\"c_smsh\""),
        "x.toml:3:9: plain.scene: unknown plain scene, did you mean \"c_smash\"?"
    );
    assert_eq!(
        error("\"c\"\nfirst = 9601\ncount = 1"),
        "x.toml:5:9: plain.count: 9602 bodies are asked for, c_smash has 9601"
    );
    assert_eq!(
        error("\"c\"\nfirst = 9602"),
        "x.toml:4:9: plain.first: 9602 bodies are asked for, c_smash has 9601"
    );
}

#[test]
fn a_written_body_can_be_kept_awake() {
    let text =
        "version = 1\n[[body]]\nshape = { circle = 1.0 }\nasleep = true\nsleep_allowed = false\n";
    let built = Scene::from_toml(text, "x.toml").unwrap().build().unwrap();
    let awake = |body: Body<'_>| !body.is_asleep() && !body.is_sleep_allowed();
    assert!(built.world.bodies().all(awake));
}

#[test]
fn a_written_body_can_start_asleep() {
    let text = "version = 1\n[[body]]\nshape = { circle = 1.0 }\nasleep = true\n";
    let built = Scene::from_toml(text, "x.toml").unwrap().build().unwrap();
    assert!(built.world.bodies().all(|body| body.is_asleep()));
}

#[test]
fn pi_counts_its_first_four_digits() {
    let mut pi = built("pi");
    let mut impacts = 0;
    for _ in 0..180 {
        impacts += pi.world.step(1.0 / 30.0).impacts;
    }
    assert_eq!(impacts, 3141);
    let large = pi.world.body(pi.body("large").unwrap()).unwrap();
    assert!(large.velocity().x > 0.999, "it turned back");
}

#[test]
fn as_many_balls_leave_the_cradle_as_come_in() {
    let mut cradle = built("cradle");
    for _ in 0..300 {
        let report = cradle.world.step(1.0 / 30.0);
        assert!(report.is_exact());
        for (row, count) in [("one", 1), ("two", 2), ("three", 3)] {
            let speeds = (0..5).map(|k| {
                let id = cradle.body(&format!("{row} {k}")).unwrap();
                cradle.world.body(id).unwrap().velocity().abs()
            });
            let moving: Vec<_> = speeds.filter(|speed| *speed != vec2(0.0, 0.0)).collect();
            assert_eq!(moving, vec![vec2(2.0, 0.0); count], "{row}");
        }
    }
}
