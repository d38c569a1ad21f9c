//! What of a world gets into a frame, and where.

use super::*;
use crate::{Colour, Face, FieldMark, Overlay, Style};
use carom_dynamics::{BodyDef, Material, Settings};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Polygon, Segment};

fn world() -> World {
    let mut world = World::new(Settings::default()).unwrap();
    let material = Material {
        density: 1.0,
        ..Material::default()
    };
    let floor = ConvexPolygon::rectangle(20.0, 1.0).unwrap();
    world
        .insert(BodyDef::fixed().at(vec2(0.0, -0.5)), floor, material)
        .unwrap();
    let arrow = [
        vec2(0.0, 0.0),
        vec2(-1.0, 1.0),
        vec2(2.0, 0.0),
        vec2(-1.0, -1.0),
    ];
    let concave = Polygon::new(arrow.to_vec()).unwrap();
    world
        .insert(
            BodyDef::dynamic()
                .at(vec2(-4.0, 3.0))
                .moving(vec2(2.0, 1.0)),
            concave,
            material,
        )
        .unwrap();
    let disc = BodyDef::dynamic().at(vec2(3.0, 2.0)).turned(0.5);
    world
        .insert(disc, Circle::new(1.0).unwrap(), material)
        .unwrap();
    let wall = Segment::new(vec2(-8.0, 0.0), vec2(-8.0, 6.0)).unwrap();
    world.insert(BodyDef::fixed(), wall, material).unwrap();
    world
}

fn camera() -> Camera {
    Camera::new(vec2(0.0, 2.0), 30.0, 600, 400).unwrap()
}

fn kinds(frame: &Frame) -> [usize; 4] {
    let count = |test: fn(&Op) -> bool| frame.ops().iter().filter(|op| test(op)).count();
    [
        count(|op| matches!(op, Op::Polygon { .. })),
        count(|op| matches!(op, Op::Disc { .. })),
        count(|op| matches!(op, Op::Line { .. })),
        count(|op| matches!(op, Op::Face { .. })),
    ]
}

#[test]
fn every_shape_has_its_mark() {
    let look = Look::default();
    // Two polygons, a disc, and two lines: the segment and the disc's spoke.
    assert_eq!(
        kinds(&Frame::capture(&world(), &look, &camera())),
        [2, 1, 2, 0]
    );
    let look = Look {
        face: Some(Face::smile()),
        ..Look::default()
    };
    assert_eq!(
        kinds(&Frame::capture(&world(), &look, &camera())),
        [2, 1, 1, 1]
    );
}

#[test]
fn what_the_camera_does_not_see_is_left_out() {
    let near = camera();
    let far = near.looking_at(vec2(1e6, 1e6)).unwrap();
    let look = Look::default();
    assert!(Frame::capture(&world(), &look, &far).ops().is_empty());
    // Left of x = 3 m − 1 m − 10 m nothing of the disc is seen.
    let left = near.looking_at(vec2(-8.5, 2.0)).unwrap();
    assert_eq!(kinds(&Frame::capture(&world(), &look, &left))[1], 0);
}

#[test]
fn a_half_plane_fills_the_picture_up_to_its_line() {
    let mut world = World::new(Settings::default()).unwrap();
    let slope = HalfPlane::new(vec2(1e6, 0.0), Vec2::Y).unwrap();
    world
        .insert(BodyDef::fixed(), slope, Material::default())
        .unwrap();
    let frame = Frame::capture(&world, &Look::default(), &camera());
    let [Op::Polygon { points, .. }] = frame.ops() else {
        panic!("one polygon: {:?}", frame.ops());
    };
    let (low, high) = (
        points.iter().copied().reduce(Vec2::min),
        points.iter().copied().reduce(Vec2::max),
    );
    let (low, high) = (low.unwrap(), high.unwrap());
    // Its line is at y = 0 m, 2 m below the middle; all other sides lie outside.
    assert!((low.y - 260.0).abs() < 1e-9, "{points:?}");
    assert!(
        low.x < 0.0 && high.x > 600.0 && high.y > 400.0,
        "{points:?}"
    );
}

#[test]
fn a_polygon_is_where_the_camera_says() {
    let frame = Frame::capture(&world(), &Look::default(), &camera());
    let Some(Op::Polygon { points, .. }) = frame.ops().first() else {
        panic!("the floor comes first: {:?}", frame.ops());
    };
    let lowest = points.iter().fold(0.0_f64, |y, p| y.max(p.y));
    let highest = points.iter().fold(f64::INFINITY, |y, p| y.min(p.y));
    // The floor's top is at y = 0 m, 2 m below the middle; its lower side 1 m below that.
    assert!(
        (highest - 260.0).abs() < 1e-9 && (lowest - 290.0).abs() < 1e-9,
        "{points:?}"
    );
}

#[test]
fn overlays_add_marks_and_change_no_body() {
    let plain = Look::default();
    let overlay = Overlay {
        centroids: true,
        velocities: Some(0.5),
        contacts: true,
        bounds: true,
        asleep: false,
        gravity: true,
        time: true,
        restitution: Some(0.9),
        field: Some(FieldMark {
            centre: vec2(0.0, 3.0),
            radius: 2.0,
            label: "core".to_owned(),
        }),
        caption: "a scene".to_owned(),
        ..Overlay::default()
    };
    let rich = Look {
        overlay,
        ..Look::default()
    };
    let before = Frame::capture(&world(), &plain, &camera());
    let after = Frame::capture(&world(), &rich, &camera());
    assert!(before.ops().iter().all(|op| after.ops().contains(op)));
    let texts: Vec<&str> = after
        .ops()
        .iter()
        .filter_map(|op| match op {
            Op::Label(label) => Some(label.text.as_str()),
            _ => None,
        })
        .collect();
    assert_eq!(
        texts,
        ["core", "t = 0.00 s", "a scene", "g = 9.81 m/s²", "e = 0.90"]
    );
    // The arrow of 2 m/s to the right and 1 m/s up, half a second long, at 30 px/m.
    let arrow = after.ops().iter().find_map(|op| match op {
        Op::Arrow {
            from,
            to,
            ink: Ink::Velocity,
            ..
        } => Some(*to - *from),
        _ => None,
    });
    assert!((arrow.unwrap() - vec2(30.0, -15.0)).length() < 1e-9);
}

#[test]
fn a_frame_used_again_is_the_same_frame() {
    let mut frame = Frame::capture(&world(), &Look::seeded(3), &camera());
    let first = frame.paint(&Style::dark());
    frame.capture_into(&world(), &Look::seeded(3), &camera());
    assert_eq!(frame.paint(&Style::dark()), first);
}

#[test]
fn a_paint_given_to_a_body_is_used() {
    let world = world();
    let disc = world.bodies().nth(2).unwrap().id();
    let mut look = Look::default();
    look.set_colour(disc, Colour::rgb(1, 2, 3));
    let picture = Frame::capture(&world, &look, &camera()).paint(&Style::light());
    // (3, 2) m is 90 px right of the middle; the spoke goes up from there.
    assert_eq!(picture.pixel(385, 210), Some(Colour::rgb(1, 2, 3)));
}
