//! What both engines trust their caller with, and answer with an abort or nonsense where it is not so.

use carom_math::Vec2;
use carom_scenes::{PlainBody, PlainKind, PlainMaterial, PlainScene, PlainShape};

/// The material and the shapes of a body, where all its numbers are finite and in range.
///
/// `largest` is the largest magnitude that the engine's numbers hold.
pub(crate) fn parts<'a>(
    scene: &'a PlainScene,
    body: &PlainBody,
    largest: f64,
) -> Result<(PlainMaterial, Vec<&'a PlainShape>), String> {
    let number = |name: &str, x: f64| {
        // A NaN is refused as well.
        if x.abs() <= largest {
            Ok(())
        } else {
            Err(format!("{name} = {x}"))
        }
    };
    let vector = |name: &str, v: Vec2| number(name, v.x).and_then(|()| number(name, v.y));

    vector("position", body.position)?;
    number("angle", body.angle)?;
    vector("velocity", body.velocity)?;
    number("spin", body.spin)?;
    let material = *scene
        .materials
        .get(body.material)
        .ok_or_else(|| format!("material {} is not in the scene", body.material))?;
    for (name, x) in [
        ("density", material.density),
        ("friction", material.friction),
        ("restitution", material.restitution),
    ] {
        number(name, x)?;
        if x < 0.0 {
            return Err(format!("{name} = {x}"));
        }
    }
    if body.kind == PlainKind::Dynamic && (material.density == 0.0 || body.shapes.is_empty()) {
        return Err("a dynamic body without mass".to_owned());
    }

    let mut shapes = Vec::with_capacity(body.shapes.len());
    for index in &body.shapes {
        let shape = scene
            .shapes
            .get(*index)
            .ok_or_else(|| format!("shape {index} is not in the scene"))?;
        match shape {
            PlainShape::Circle { radius } => number("radius", *radius)?,
            PlainShape::Box { half, offset } => {
                vector("half", *half)?;
                vector("offset", *offset)?;
                if !(half.x > 0.0 && half.y > 0.0) {
                    return Err(format!("half = {half}"));
                }
            }
            PlainShape::Polygon(corners) => {
                if !(3..=8).contains(&corners.len()) {
                    return Err(format!("{} corners", corners.len()));
                }
                corners.iter().try_for_each(|c| vector("corner", *c))?;
            }
            PlainShape::Segment(ends) => ends.iter().try_for_each(|e| vector("end", *e))?,
        }
        if let PlainShape::Circle { radius } = shape
            && *radius <= 0.0
        {
            return Err(format!("radius = {radius}"));
        }
        shapes.push(shape);
    }
    Ok((material, shapes))
}
