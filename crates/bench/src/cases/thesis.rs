//! Case 20: the thesis's scene, against the engine's own run at a fine step.

use carom_dynamics::{Body, BodyKind};
use carom_geometry::Shape;
use carom_math::Vec2;
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape, find};

use super::plan::QUICK;
use super::{Case, refined};

pub(super) const CASE: Case = Case {
    name: "20_thesis_self_convergence",
    about: "the thesis's seven polygons after their first impacts: places against the engine's own run at 7680 Hz",
    metrics: refined::METRICS,
    rates: refined::RATES,
    sweeps_substeps: false,
    quick: QUICK,
    measure: |trial| refined::measure(trial, &world(), TIME),
};

/// The places are compared here, in s, after the first impacts.
const TIME: f64 = 1.5;

/// The bodies of the built-in scene `thesis` at its start.
fn world() -> PlainScene {
    let built = find("thesis").and_then(|scene| scene.build());
    let world = built.expect("a built-in scene").world;
    let mut scene = PlainScene::empty(CASE.name, world.settings().gravity);
    for body in world.bodies() {
        add(&mut scene, &body);
    }
    scene
}

fn add(scene: &mut PlainScene, body: &Body<'_>) {
    let kind = match body.kind() {
        BodyKind::Dynamic => PlainKind::Dynamic,
        BodyKind::Kinematic => PlainKind::Kinematic,
        _ => PlainKind::Fixed,
    };
    let centre = body.pose().inverse_point(body.centre());
    let from_centre = |corners: &[Vec2]| corners.iter().map(|p| *p - centre).collect::<Vec<_>>();
    let (mut shapes, mut outline, mut material) = (Vec::new(), None, 0);
    for (shape, made_of) in body.shapes() {
        material = scene.material(made_of.density, made_of.friction, made_of.restitution);
        match shape {
            Shape::Convex(polygon) => {
                let corners = from_centre(polygon.vertices());
                shapes.push(scene.shape(PlainShape::Polygon(corners)));
            }
            Shape::Polygon(polygon) => {
                for piece in polygon.pieces() {
                    let corners = from_centre(piece.vertices());
                    shapes.push(scene.shape(PlainShape::Polygon(corners)));
                }
                scene.outlines.push(from_centre(polygon.vertices()));
                outline = Some(scene.outlines.len() - 1);
            }
            _ => unreachable!("the scene is made of polygons"),
        }
    }
    scene.bodies.push(PlainBody {
        shapes,
        outline,
        ..PlainBody::new(kind, body.centre(), material)
            .turned(body.angle())
            .moving(body.velocity())
            .spinning(body.angular_velocity())
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::horizon::dynamic_bodies;

    #[test]
    fn the_scene_has_seven_polygons_and_the_h_its_outline() {
        let scene = world();
        assert_eq!(dynamic_bodies(&scene).count(), 7);
        let outlined = scene.bodies.iter().filter(|body| body.outline.is_some());
        assert_eq!(outlined.count(), 1);
        assert_eq!(scene.outlines[0].len(), 12);
    }

    #[test]
    fn centres_of_mass_are_the_origins_of_the_bodies() {
        let scene = world();
        for body in dynamic_bodies(&scene).map(|i| &scene.bodies[i]) {
            let PlainShape::Polygon(corners) = &scene.shapes[body.shapes[0]] else {
                panic!("a polygon");
            };
            if body.outline.is_none() {
                let polygon = carom_geometry::ConvexPolygon::new(corners.clone());
                let centroid = polygon.expect("convex").area_properties().centroid;
                assert!(centroid.length() < 1e-14, "{centroid}");
            }
        }
    }
}
