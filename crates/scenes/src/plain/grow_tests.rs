//! Growth scenes: as many bodies as asked for, equally dense, apart at the start, and a pile that rests.

use carom_dynamics::{BodyKind, Mode, Settings, World};
use carom_geometry::Aabb;

use super::{
    GrowthKind, PlainKind, PlainScene, growth_scene, lively_scenes, plain_scene, plain_scenes,
};

fn world(scene: &PlainScene) -> World {
    world_with(scene, scene.settings())
}

fn world_with(scene: &PlainScene, settings: Settings) -> World {
    let mut world = World::new(settings).unwrap_or_else(|error| panic!("{error}"));
    scene
        .insert_into(&mut world)
        .unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    world
}

/// Mass per area of the box around all dynamic bodies, in kg/m².
fn density(scene: &PlainScene) -> f64 {
    let world = world(scene);
    let moving = || {
        let bodies = world.bodies();
        bodies.filter(|body| body.kind() == BodyKind::Dynamic)
    };
    let bounds = moving().fold(Aabb::EMPTY, |all, body| all.union(body.aabb()));
    let mass: f64 = moving().map(|body| body.mass()).sum();
    mass / (bounds.max - bounds.min).element_product()
}

#[test]
fn density_and_number_are_as_asked_for() {
    for kind in GrowthKind::ALL {
        let dense = density(&growth_scene(kind, 30_000));
        for bodies in [200, 1999, 2000, 8000] {
            let scene = growth_scene(kind, bodies);
            let moving = scene
                .bodies
                .iter()
                .filter(|body| body.kind == PlainKind::Dynamic);
            assert_eq!(moving.count(), bodies as usize);
            let here = density(&scene);
            // A rim of half a cell around √n cells, and at most a row of them empty.
            let tolerance = 4.0 / f64::from(bodies).sqrt();
            assert!(
                (here / dense - 1.0).abs() < tolerance,
                "{kind} of {bodies}: {here} kg/m² beside {dense}"
            );
        }
    }
}

#[test]
fn scenes_start_apart() {
    let listed = plain_scenes().iter().chain(lively_scenes());
    let published = listed.filter(|info| {
        // Every pair of case 19 lies at the same place.
        info.name != "case19_polygon_pairs"
    });
    let growing = GrowthKind::ALL.map(|kind| growth_scene(kind, 2000));
    let spaced = [1150, 5200].map(super::spaced_scene);
    let made = growing.into_iter().chain(spaced);
    for scene in published.map(super::PlainInfo::scene).chain(made) {
        // A sub-step of exact mode begins with a look at every pair; so short a call ends before anything has moved.
        let settings = Settings {
            mode: Mode::Exact,
            ..scene.settings()
        };
        let mut world = world_with(&scene, settings);
        let report = world.step(1e-13);
        // The published boxes of c touch up to rounding of 30 + 0.4 i.
        assert!(
            report.deepest_overlap <= 2e-14,
            "{}: {:e} m deep",
            scene.name,
            report.deepest_overlap
        );
    }
}

#[test]
fn a_growing_pile_stands_and_lasts() {
    let scene = growth_scene(GrowthKind::Pile, 300);
    let mut world = world(&scene);
    for _ in 0..scene.warm_up_steps + scene.measured_steps {
        world.step(scene.dt);
    }
    let lying = world.contacts().count();
    assert!(
        lying >= 300,
        "every stone lies on another: {lying} contacts"
    );
    let moving = world
        .bodies()
        .filter(|body| body.kind() == BodyKind::Dynamic);
    for (body, start) in moving.zip(scene.bodies.iter().skip(3)) {
        // The stones sink by their ten beds, and by what soft contacts give way.
        let fallen = body.centre().distance(start.position);
        assert!(fallen < 0.05, "{} moved by {fallen} m", start.position);
        assert!(body.angle().abs() < 0.05, "{} turned", start.position);
    }
}

#[test]
fn other_spellings_are_no_names() {
    for name in [
        "grow_pile_",
        "grow_pile_+7",
        "grow_pile_0",
        "grow_pile_007",
        "grow_heap_7",
        "grow_gas_1000001",
    ] {
        assert!(plain_scene(name).is_none(), "{name}");
    }
    assert_eq!(growth_scene(GrowthKind::Free, 0).bodies.len(), 1);
}
