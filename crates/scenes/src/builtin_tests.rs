//! The built-in scenes: all build, start apart, and give the same bits twice.

use carom_dynamics::{Body, BodyKind};
use carom_geometry::Outline;

use crate::{find, list};

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
