//! Questions answered by a look at every shape.
//!
//! What grazes a shape may be seen or not: a world computes about centres of mass, we in the frames in which shapes were drawn. So
//! an answer must lie between those for the same question a little to one side and to the other.

use carom_collision::cast;
use carom_dynamics::{Body, BodyId, World};
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, Vec2, perp};

/// How much is a little, in m.
const ASIDE: f64 = 1e-9;

/// Asks for a ray, a point, a box and a cast of `shape`, all from `from` to `to`.
pub(crate) fn ask(world: &World, from: Vec2, to: Vec2, shape: &Shape) -> Result<(), String> {
    let way = to - from;
    let Some(direction) = way.try_normalize() else {
        return Ok(());
    };
    let aside = perp(direction) * ASIDE;
    let sides = [-aside, Vec2::ZERO, aside];

    let max = way.length();
    let hit = world.cast_ray(from, way, max);
    let found = hit.map_or(f64::INFINITY, |hit| hit.distance);
    let rays = sides.map(|side| {
        first(world, |pose, shape| {
            let (origin, direction) = (
                pose.inverse_point(from + side),
                pose.inverse_vector(direction),
            );
            shape
                .cast_ray(origin, direction, max + ASIDE)
                .map(|hit| hit.distance)
        })
    });
    between(found, rays, "ray", 1e-7, max)?;
    if let Some(hit) = hit
        && ((hit.point - from).length() - hit.distance).abs() > 1e-9
    {
        return Err(format!("a ray's point is not on it: {hit:?}"));
    }

    let found = world
        .cast_shape(shape, Pose::at(from), way)
        .map_or(f64::INFINITY, |hit| hit.fraction);
    let casts = sides.map(|side| {
        first(world, |pose, other| {
            cast(shape, Pose::at(from + side), way, other, pose).map(|hit| hit.fraction)
        })
    });
    between(found, casts, "cast", 1e-7, 1.0)?;

    let corners = [Vec2::ZERO, aside, -aside, perp(aside), -perp(aside)];
    compare("point", &world.bodies_at(from), world, |body| {
        let holds = corners.map(|corner| {
            shapes(&body).any(|(pose, shape)| shape.contains(pose.inverse_point(from + corner)))
        });
        agreed(&holds)
    })?;

    let bounds = Aabb::from_points([from, to]);
    compare("box", &world.bodies_in(bounds), world, |body| {
        let holds = [-ASIDE, 0.0, ASIDE].map(|margin| {
            shapes(&body).any(|(pose, shape)| shape.aabb(pose).grown(margin).overlaps(bounds))
        });
        agreed(&holds)
    })
}

fn shapes<'w>(body: &Body<'w>) -> impl Iterator<Item = (Pose, &'w Shape)> + use<'w> {
    let pose = body.pose();
    body.shapes().map(move |(shape, _)| (pose, shape))
}

/// The least of what all shapes answer.
fn first(world: &World, answer: impl Fn(Pose, &Shape) -> Option<f64>) -> f64 {
    let all = world
        .bodies()
        .flat_map(|body| shapes(&body).collect::<Vec<_>>());
    all.filter_map(|(pose, shape)| answer(pose, shape))
        .fold(f64::INFINITY, f64::min)
}

/// Whether what was found lies between what brute force finds, to `tolerance`; what is found at the end may be missed.
fn between(found: f64, all: [f64; 3], what: &str, tolerance: f64, end: f64) -> Result<(), String> {
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let most = all.iter().copied().fold(0.0, f64::max);
    if found < least - tolerance || (found > most + tolerance && most < end - tolerance) {
        return Err(format!(
            "a {what} ends at {found}, by brute force at {all:?}"
        ));
    }
    Ok(())
}

/// What all agree about.
fn agreed(answers: &[bool]) -> Option<bool> {
    answers
        .iter()
        .all(|answer| *answer == answers[0])
        .then_some(answers[0])
}

/// Whether the bodies found are those that `holds` names; `None`: too close to call.
fn compare(
    what: &str,
    found: &[BodyId],
    world: &World,
    holds: impl Fn(Body<'_>) -> Option<bool>,
) -> Result<(), String> {
    if !found.is_sorted() {
        return Err(format!("bodies of a {what} out of order: {found:?}"));
    }
    for body in world.bodies() {
        let is_found = found.contains(&body.id());
        if holds(body).is_some_and(|holds| holds != is_found) {
            return Err(format!(
                "a {what} finds {found:?}: wrong about {}",
                body.id()
            ));
        }
    }
    Ok(())
}
