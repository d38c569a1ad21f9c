//! Small pictures of every overlay and style: see `golden_tests`.

use carom_dynamics::{BodyDef, BodyId, Material, RadialField, Settings, Softness, World};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Segment};
use carom_math::{Vec2, vec2};

use crate::golden_tests::golden;
use crate::{Camera, FieldMark, Frame, Look, Op, Overlay, Style, Trace};

fn world(gravity: Vec2) -> World {
    World::new(Settings {
        gravity,
        ..Settings::default()
    })
    .unwrap()
}

const ELASTIC: Material = Material {
    friction: 0.0,
    restitution: 1.0,
    density: 1.0,
    tangent_speed: 0.0,
};

/// Bodies at rest in various ways, at time 0: nothing depends on a solver.
fn still() -> World {
    let mut world = world(vec2(0.0, -9.81));
    let floor = ConvexPolygon::rectangle(8.0, 1.0).unwrap();
    world
        .insert(BodyDef::fixed().at(vec2(0.0, -2.5)), floor, ELASTIC)
        .unwrap();
    let disc = BodyDef::dynamic()
        .at(vec2(-2.4, 0.4))
        .moving(vec2(2.0, 3.0))
        .turned(0.6);
    world
        .insert(disc, Circle::new(0.7).unwrap(), ELASTIC)
        .unwrap();
    let dart = [
        vec2(-1.0, -0.9),
        vec2(1.0, 0.0),
        vec2(-1.0, 0.9),
        vec2(-0.4, 0.0),
    ];
    let flying = BodyDef::dynamic()
        .at(vec2(0.1, 1.0))
        .moving(vec2(-3.0, -1.0))
        .turned(0.3);
    world
        .insert(flying, Polygon::new(dart.to_vec()).unwrap(), ELASTIC)
        .unwrap();
    let sleeper = ConvexPolygon::regular(5, 0.8).unwrap();
    world
        .insert(
            BodyDef::dynamic().at(vec2(2.3, -1.2)).asleep(),
            sleeper,
            ELASTIC,
        )
        .unwrap();
    let wall = Segment::new(vec2(3.6, -2.0), vec2(3.6, 2.0)).unwrap();
    world.insert(BodyDef::kinematic(), wall, ELASTIC).unwrap();
    world
}

fn camera() -> Camera {
    Camera::new(Vec2::ZERO, 18.0, 160, 100).unwrap()
}

fn overlay(name: &str, world: &World, overlay: Overlay) {
    let look = Look {
        overlay,
        ..Look::seeded(1)
    };
    let picture = Frame::capture(world, &look, &camera()).paint(&look.style);
    golden(&format!("overlay-{name}"), &picture);
}

#[test]
fn golden_overlays_of_a_world_that_stands_still() {
    let show = |name: &str, shown: Overlay| overlay(name, &still(), shown);
    let field = RadialField::new(vec2(-0.5, 0.3), 30.0, 0.9).unwrap();
    show("none", Overlay::default());
    show(
        "velocities",
        Overlay {
            velocities: Some(0.5),
            ..Overlay::default()
        },
    );
    show(
        "centroids",
        Overlay {
            centroids: true,
            ..Overlay::default()
        },
    );
    show(
        "boxes",
        Overlay {
            bounds: true,
            ..Overlay::default()
        },
    );
    show(
        "asleep",
        Overlay {
            asleep: true,
            ..Overlay::default()
        },
    );
    show(
        "gravity",
        Overlay {
            gravity: true,
            ..Overlay::default()
        },
    );
    show(
        "time",
        Overlay {
            time: true,
            ..Overlay::default()
        },
    );
    show(
        "counters",
        Overlay {
            time: true,
            counters: true,
            ..Overlay::default()
        },
    );
    show(
        "restitution",
        Overlay {
            restitution: Some(0.7),
            ..Overlay::default()
        },
    );
    show(
        "caption",
        Overlay {
            caption: "a caption".to_owned(),
            ..Overlay::default()
        },
    );
    let mark = FieldMark {
        centre: field.centre(),
        radius: 0.9,
        label: "GM".to_owned(),
    };
    show(
        "field",
        Overlay {
            field: Some(mark),
            ..Overlay::default()
        },
    );
    show(
        "gravity-lines",
        Overlay {
            field_lines: Some(Vec::new()),
            ..Overlay::default()
        },
    );
    show(
        "field-lines",
        Overlay {
            field_lines: Some(vec![field]),
            ..Overlay::default()
        },
    );
}

/// Two discs in each other, a box in the lower one, and one body apart; looked at before anything could move.
fn overlapping() -> World {
    // Nothing is pushed apart, so that the picture says nothing of a solver.
    let contact = Softness {
        push_out: 0.0,
        ..Softness::default()
    };
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        contact,
        ..Settings::default()
    })
    .unwrap();
    let disc = Circle::new(1.0).unwrap();
    for (x, y) in [(-1.8, 0.5), (-0.5, 0.9), (2.6, 1.6)] {
        world
            .insert(BodyDef::dynamic().at(vec2(x, y)), disc, ELASTIC)
            .unwrap();
    }
    let square = ConvexPolygon::rectangle(3.0, 2.0).unwrap();
    world
        .insert(BodyDef::dynamic().at(vec2(-1.0, -1.2)), square, ELASTIC)
        .unwrap();
    let before: Vec<Vec2> = world.bodies().map(|body| body.centre()).collect();
    world.step(1.0 / 60.0);
    assert!(world.bodies().map(|body| body.centre()).eq(before));
    world
}

#[test]
fn golden_overlays_of_bodies_in_each_other() {
    overlay(
        "overlaps",
        &overlapping(),
        Overlay {
            overlaps: true,
            ..Overlay::default()
        },
    );
    overlay(
        "groups",
        &overlapping(),
        Overlay {
            groups: true,
            ..Overlay::default()
        },
    );
}

/// A disc that struck a wall after 0.12 s, and flies back; and what was seen of it.
fn struck(overlay: &Overlay, seconds: f64) -> (World, Trace, BodyId) {
    let mut world = world(Vec2::ZERO);
    let wall = ConvexPolygon::rectangle(1.0, 5.0).unwrap();
    world
        .insert(BodyDef::fixed().at(vec2(2.5, 0.0)), wall, ELASTIC)
        .unwrap();
    // 0.6 m to go at 5 m/s.
    let def = BodyDef::dynamic()
        .at(vec2(0.4, 0.2))
        .moving(vec2(5.0, -4.0));
    let disc = world
        .insert(def, Circle::new(1.0).unwrap(), ELASTIC)
        .unwrap();
    let mut trace = Trace::new(overlay);
    trace.watch(&world);
    let step = 0.05;
    let mut time = 0.0;
    while time < seconds - 1e-9 {
        world.step(step);
        time += step;
        trace.watch(&world);
    }
    (world, trace, disc)
}

#[test]
fn golden_overlays_of_an_impact() {
    let wanted = [
        (
            "contacts",
            Overlay {
                contacts: true,
                ..Overlay::default()
            },
            0.15,
        ),
        (
            "impulses",
            Overlay {
                impulses: Some(0.2),
                ..Overlay::default()
            },
            0.15,
        ),
        (
            "flashes",
            Overlay {
                flashes: true,
                ..Overlay::default()
            },
            0.2,
        ),
        (
            "flashes-later",
            Overlay {
                flashes: true,
                ..Overlay::default()
            },
            0.3,
        ),
        (
            "trails",
            Overlay {
                trails: Some(0.6),
                ..Overlay::default()
            },
            0.5,
        ),
    ];
    for (name, overlay, seconds) in wanted {
        let (world, trace, _) = struck(&overlay, seconds);
        let look = Look {
            overlay,
            ..Look::seeded(1)
        };
        let frame = Frame::capture_traced(&world, &look, &camera(), &trace);
        golden(&format!("overlay-{name}"), &frame.paint(&look.style));
    }
}

#[test]
fn golden_styles() {
    let overlay = Overlay {
        velocities: Some(0.3),
        centroids: true,
        bounds: true,
        gravity: true,
        restitution: Some(0.7),
        time: true,
        ..Overlay::default()
    };
    for (name, style) in [
        ("light", Style::light()),
        ("dark", Style::dark()),
        ("print", Style::print()),
    ] {
        let look = Look {
            overlay: overlay.clone(),
            style,
            ..Look::seeded(1)
        };
        let picture = Frame::capture(&still(), &look, &camera()).paint(&look.style);
        golden(&format!("style-{name}"), &picture);
    }
}

/// A trace forgets what is too old or gone, and counts what it saw.
#[test]
fn a_trace_holds_what_it_needs() {
    let overlay = Overlay {
        trails: Some(0.2),
        flashes: true,
        ..Overlay::default()
    };
    let (mut world, mut trace, disc) = struck(&overlay, 0.6);
    assert_eq!(trace.count(), 1);
    let marks = |world: &World, trace: &Trace| {
        let look = Look {
            overlay: overlay.clone(),
            spokes: false,
            ..Look::default()
        };
        let frame = Frame::capture_traced(world, &look, &camera(), trace);
        frame
            .ops()
            .iter()
            .filter(|op| matches!(op, Op::Line { .. }))
            .count()
    };
    // Five places of 0.2 s, and no burst: the impact was half a second ago.
    assert_eq!(marks(&world, &trace), 4);
    world.remove(disc).unwrap();
    trace.watch(&world);
    assert_eq!(marks(&world, &trace), 0);
}
