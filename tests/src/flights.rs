//! Random scenes of free flight, asked event by event by two slow twins of the search for the next impact: the times of impact of
//! all pairs from the motions that the world shows, and a world that searches all pairs.
//!
//! ```sh
//! cargo run --release -p carom-tests --example flights -- --first 1 --count 10000
//! ```

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_dynamics::{
    BodyDef, BodyId, BodyKind, EventKind, Mode, PairSearch, RadialField, Settings, World,
};
use carom_geometry::{ConvexPolygon, HalfPlane, Shape};
use carom_math::{Pose, Vec2, vec2};

use crate::draw::{self, Dice};
use crate::elastic;

/// Slower approaches are left out, in sizes of the smaller body a second: a graze.
const SLOW: f64 = 1e-6;

/// What a time of impact may be off by, in parts of itself and of the time for the smaller body's size.
const LATE: f64 = 1e-11;

/// Roundings of a body's coordinates that shift the instant of an impact, too.
const BLUR: f64 = 8.0 * f64::EPSILON;

/// Events of a scene.
const EVENTS: usize = 40;

/// Longest step, in s.
const STEP: f64 = 0.25;

/// What a scene showed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Impacts compared with those of all pairs.
    pub impacts: u64,
    /// Events until which both worlds had equal bits.
    pub events: u64,
}

/// A shape of a body about its centre of mass.
struct Solid {
    id: BodyId,
    kind: BodyKind,
    shapes: Vec<Shape>,
    motion: Motion,
    size: f64,
}

/// A pair's next impact: how many seconds from now, and what it may be off by.
struct Next {
    pair: [BodyId; 2],
    wait: f64,
    margin: f64,
}

/// Plays one scene.
///
/// # Errors
/// The first impact that the world missed, made up, or found otherwise than a search of all pairs.
pub fn play(mode: Mode, seed: u64) -> Result<Seen, String> {
    let (mut world, bends) = scene(mode, seed, PairSearch::Indexed);
    let (mut twin, _) = scene(mode, seed, PairSearch::AllPairs);
    let mut seen = Seen::default();
    for event in 0..EVENTS {
        let ahead = (!bends).then(|| ahead(&solids(&world)));
        let report = world.step_to_next_event(STEP);
        twin.step_to_next_event(STEP);
        if report.substeps > 0 {
            // A body landed: it is no free flight any more.
            break;
        }
        if world.state_hash() != twin.state_hash() {
            return Err(format!(
                "event {event}: at {:?} and with all pairs at {:?} the worlds differ",
                world.time(),
                twin.time()
            ));
        }
        seen.events += 1;
        let Some(ahead) = ahead else { continue };
        for next in &ahead {
            if next.wait + next.margin < report.advanced {
                return Err(format!(
                    "event {event}: {:?} meet after {:e} s, the world goes on for {:e} s",
                    next.pair, next.wait, report.advanced
                ));
            }
        }
        for told in world.events() {
            let EventKind::Impact { a, b, .. } = told.kind else {
                continue;
            };
            let known = ahead
                .iter()
                .find(|next| next.pair == [a, b] || next.pair == [b, a]);
            if let Some(next) = known {
                seen.impacts += 1;
                if (next.wait - report.advanced).abs() > next.margin {
                    return Err(format!(
                        "event {event}: {a} and {b} strike after {:e} s instead of {:e} s",
                        report.advanced, next.wait
                    ));
                }
            }
        }
    }
    Ok(seen)
}

/// Bodies in a grid, smaller ones by up to a factor of 1,000, a third of them fixed or driven, and in half of the scenes a plank, in any
/// order; whether they fly on other curves than parabolas.
fn scene(mode: Mode, seed: u64, pair_search: PairSearch) -> (World, bool) {
    let mut dice = Dice::new(seed);
    let bends = dice.chance(0.3);
    let gravity = if dice.chance(0.5) {
        vec2(0.0, -10.0)
    } else {
        Vec2::ZERO
    };
    let settings = Settings {
        mode,
        pair_search,
        gravity,
        sleep: None,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let side = 2 + dice.below(3);
    let half = 1.2 * side as f64;
    if dice.chance(0.5) {
        for inward in [Vec2::Y, Vec2::X, -Vec2::X] {
            let wall = HalfPlane::new(-inward * half, inward).expect("a unit normal");
            world
                .insert(BodyDef::fixed(), wall, elastic())
                .expect("a wall");
        }
    }
    if bends && dice.chance(0.5) {
        let field = RadialField::new(dice.inside(half), 30.0, 0.5).expect("a field");
        world.add_field(field);
    }
    // Beside the grid: longer than all of it, before or after the others.
    let plank = dice.chance(0.5).then(|| dice.below(side * side + 1));
    let mut places: Vec<usize> = (0..side * side).collect();
    while !places.is_empty() {
        if plank == Some(places.len()) {
            insert_plank(&mut world, &mut dice, half);
        }
        let place = places.swap_remove(dice.below(places.len()));
        let at = vec2((place % side) as f64, (place / side) as f64);
        let at = (at - Vec2::splat(0.5 * (side as f64 - 1.0))) * 2.2;
        let reach = if dice.chance(0.5) {
            1.0
        } else {
            dice.log(1e-3, 1.0)
        };
        let shape = draw::shape(&mut dice, reach);
        let mut def = [
            BodyDef::fixed(),
            BodyDef::kinematic(),
            BodyDef::dynamic(),
            BodyDef::dynamic(),
            BodyDef::dynamic(),
            BodyDef::dynamic(),
        ][dice.below(6)]
        .at(at)
        .turned(dice.between(-3.0, 3.0));
        if def.kind != BodyKind::Fixed {
            let most = if dice.chance(0.1) { 1000.0 } else { 10.0 };
            let speed = dice.between(0.0, most);
            def = def
                .moving(dice.inside(1.0) * speed)
                .spinning(dice.between(-10.0, 10.0));
        }
        if bends && dice.chance(0.5) {
            def = def.damped(dice.between(0.0, 2.0), dice.between(0.0, 2.0));
        }
        world.insert(def, shape, elastic()).expect("a valid body");
    }
    (world, bends)
}

/// A thin plank above the grid, fixed, driven or free: its circle covers all that flies, its box little.
fn insert_plank(world: &mut World, dice: &mut Dice, half: f64) {
    let kinds = [BodyDef::fixed(), BodyDef::kinematic(), BodyDef::dynamic()];
    let mut def = kinds[dice.below(3)].at(vec2(0.0, half + 1.0));
    if def.kind != BodyKind::Fixed && dice.chance(0.5) {
        def = def.moving(vec2(dice.between(-1.0, 1.0), -dice.between(0.0, 1.0)));
    }
    let length = dice.log(10.0, 100.0);
    let plank = ConvexPolygon::rectangle(length, 0.01 * length).expect("a plank");
    world.insert(def, plank, elastic()).expect("a valid body");
}

fn solids(world: &World) -> Vec<Solid> {
    let solid = |body: carom_dynamics::Body<'_>| {
        let centre = body.pose().inverse_point(body.centre());
        let about = |shape: &Shape| shape.placed(Pose::at(-centre)).expect("a shape, moved");
        Solid {
            id: body.id(),
            kind: body.kind(),
            shapes: body.shapes().map(|(shape, _)| about(shape)).collect(),
            motion: body.motion().rebased(world.time()),
            size: (body.aabb().max - body.aabb().min).min_element(),
        }
    };
    world.bodies().map(solid).collect()
}

/// The next impact of each pair that does not touch now.
fn ahead(solids: &[Solid]) -> Vec<Next> {
    let mut found = Vec::new();
    for (k, a) in solids.iter().enumerate() {
        for b in &solids[k + 1..] {
            if a.kind != BodyKind::Dynamic && b.kind != BodyKind::Dynamic {
                continue;
            }
            let mut first: Option<Next> = None;
            let mut touches = false;
            for one in &a.shapes {
                for other in &b.shapes {
                    match time_of_impact(one, &a.motion, other, &b.motion, STEP) {
                        TimeOfImpact::Hit(hit) => {
                            let size = a.size.min(b.size);
                            let rate = -hit.gap_rate;
                            touches |= rate < SLOW * size;
                            let far = a.motion.centre.abs().max(b.motion.centre.abs());
                            let blur = BLUR * far.max_element() / rate;
                            let margin = LATE * (hit.time + size / rate) + blur;
                            let next = Next {
                                pair: [a.id, b.id],
                                wait: hit.time,
                                margin,
                            };
                            if first.as_ref().is_none_or(|known| next.wait < known.wait) {
                                first = Some(next);
                            }
                        }
                        TimeOfImpact::Clear => {}
                        _ => touches = true,
                    }
                }
            }
            found.extend(first.filter(|_| !touches));
        }
    }
    found
}
