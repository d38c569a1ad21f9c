//! What stands is what it was: frames that keep marks are frames made anew.

use carom_dynamics::{BodyDef, BodyKind, Material, Settings};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Rot, Vec2, vec2};
use proptest::prelude::*;

use super::*;
use crate::{Colour, Frame, Ink, Op, Painter, Picture, Size, Source, Style};

/// What is done to a list by hand.
#[derive(Clone, Debug)]
enum Act {
    Push(f64, bool),
    Truncate(usize),
    Clear,
    /// Goes on with a clone.
    Clone,
    Paint,
}

fn act() -> impl Strategy<Value = Act> {
    prop_oneof![
        4 => (0.0..60.0_f64, any::<bool>()).prop_map(|(x, awake)| Act::Push(x, awake)),
        2 => (0..8_usize).prop_map(Act::Truncate),
        1 => Just(Act::Clear),
        1 => Just(Act::Clone),
        4 => Just(Act::Paint),
    ]
}

proptest! {
    #[test]
    fn lists_that_are_cut_and_go_on_are_painted_as_in_full(acts in prop::collection::vec(act(), 1..60)) {
        let size = Size::new(64, 40).unwrap();
        let mut frame = Frame::new(size);
        // Others of the same beginning, which are painted in between.
        let mut clones = vec![Frame::new(size)];
        let mut painter = Painter::new(Style::light()).checking();
        let mut picture = Picture::new(size, Colour::WHITE);
        for act in acts {
            match act {
                Act::Push(x, awake) => {
                    let source = Source { body: None, awake };
                    frame.push_from(source, Op::Dot { centre: vec2(x, 0.6 * x), radius: 6.0, ink: Ink::Text });
                }
                Act::Truncate(marks) => frame.truncate(marks),
                Act::Clear => frame.clear(size),
                Act::Clone => {
                    let clone = frame.clone();
                    clones.push(core::mem::replace(&mut frame, clone));
                }
                Act::Paint => {
                    painter.paint(&frame, &mut picture);
                    let last = clones.last_mut().unwrap();
                    core::mem::swap(last, &mut frame);
                    painter.paint(&frame, &mut picture);
                    core::mem::swap(clones.last_mut().unwrap(), &mut frame);
                    painter.paint(&frame, &mut picture);
                }
            }
        }
        prop_assert_eq!(painter.differing(), 0);
    }

    #[test]
    fn a_frame_that_captures_again_is_one_that_captures_anew(
        acts in prop::collection::vec((0..12_u8, 0..24_usize, 0.0..1.0_f64), 1..24),
    ) {
        let mut worlds = [pile(), pile()];
        let mut at = 0;
        let mut look = Look::default();
        let mut camera = Camera::new(vec2(0.0, 3.0), 12.0, 120, 90).unwrap();
        let mut frame = Frame::new(camera.size());
        let mut painter = Painter::new(Style::light()).checking();
        let mut picture = Picture::new(camera.size(), Colour::WHITE);
        for (what, which, x) in acts {
            let world = &mut worlds[at];
            let ids: Vec<BodyId> = world.bodies().map(|body| body.id()).collect();
            let id = ids[which % ids.len()];
            let place = Pose::new(vec2(8.0 * x - 4.0, 1.0 + 5.0 * x), Rot::from_angle(x));
            match what {
                0 => world.teleport(id, place).unwrap(),
                1 if ids.len() > 4 => world.remove(id).unwrap(),
                2 => {
                    let def = BodyDef::dynamic().at(place.position).asleep();
                    let side = 0.3 + x;
                    world.insert(def, ConvexPolygon::square(side).unwrap(), Material::default()).unwrap();
                }
                3 => world.set_velocity(id, vec2(x, 1.0), x).unwrap(),
                4 => world.set_kind(id, BodyKind::Fixed).unwrap(),
                5 => look.seed += 1,
                6 => look.overlay.asleep = !look.overlay.asleep,
                7 => camera = camera.looking_at(vec2(x, 3.0)).unwrap(),
                8 => look.overlay.groups = !look.overlay.groups,
                // Another world, in which the same ids may be other bodies; or a clone that goes its own way.
                9 => at = 1 - at,
                10 => worlds[1 - at] = worlds[at].clone(),
                _ => {
                    world.step(0.3 * x);
                }
            }
            frame.capture_into(&worlds[at], &look, &camera);
            prop_assert!(frame == Frame::capture(&worlds[at], &look, &camera));
            painter.paint(&frame, &mut picture);
        }
        prop_assert_eq!(painter.differing(), 0);
    }
}

/// A floor, boxes asleep and a ball above them.
fn pile() -> World {
    let mut world = World::new(Settings::default()).unwrap();
    let floor = ConvexPolygon::rectangle(12.0, 1.0).unwrap();
    let material = Material::default();
    world
        .insert(BodyDef::fixed().at(vec2(0.0, -0.5)), floor, material)
        .unwrap();
    for k in 0..6 {
        let def = BodyDef::dynamic()
            .at(vec2(1.5 * f64::from(k) - 4.0, 0.5))
            .asleep();
        let square = ConvexPolygon::square(1.0).unwrap();
        world.insert(def, square, material).unwrap();
    }
    let ball = BodyDef::dynamic().at(vec2(0.3, 4.0));
    world
        .insert(ball, Circle::new(0.5).unwrap(), material)
        .unwrap();
    world
}

#[test]
fn marks_of_resting_bodies_are_not_compared() {
    let mut world = pile();
    let (look, camera) = (
        Look::default(),
        Camera::new(Vec2::ZERO, 12.0, 120, 90).unwrap(),
    );
    let mut frame = Frame::capture(&world, &look, &camera);
    let before = frame.snapshot();
    world.step(0.05);
    frame.capture_into(&world, &look, &camera);
    // The floor and six boxes.
    assert_eq!(frame.common(&before), 7);
    let before = frame.snapshot();
    let third = world.bodies().nth(3).map(|body| body.id()).unwrap();
    world.teleport(third, Pose::at(vec2(0.0, 7.0))).unwrap();
    frame.capture_into(&world, &look, &camera);
    assert_eq!(frame.common(&before), 3);
    // Another list of the same marks is known nothing of.
    assert_eq!(frame.clone().common(&frame), 0);
}
