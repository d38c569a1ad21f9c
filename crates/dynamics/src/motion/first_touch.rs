//! When two shapes first touch of which at least one flies by a law that is no parabola.
//!
//! The law is followed by parabolas that touch it. One that leaves it by no more than `e` up to some instant tells, of
//! shapes grown by e, until when they surely do not touch. With e a part of the gap that is a step that cannot pass a
//! contact. The next parabola begins there, is shorter, and e falls with its cube: two or three lead to an instant at
//! which e is below rounding, and the last of them tells the contact itself.

use carom_collision::{
    Hull, Impact, ImpactFeature, Motion, TimeOfImpact, earlier, part, part_count, separating_axis,
    time_of_impact_from, time_of_impact_of_parts,
};
use carom_geometry::{Aabb, Shape};
use carom_math::SimTime;

use crate::law::osculating::Osculating;
use crate::store::few::Few;
use crate::store::moved::moves;
use crate::store::state::BodyState;

/// A parabola that is nearer to its law than this, as a part of the smaller reach, is the law but for rounding.
const EXACT: f64 = 1.0 / (1_u64 << 46) as f64;

/// Gap, as a part of the smaller reach, below which only such parabolas are followed. The last search begins there: from
/// much nearer it would not see which of two corners comes first.
const NEAR: f64 = 1.0 / (1_u64 << 24) as f64;

/// Part of a gap that a parabola may leave out.
const ROOM: f64 = 0.25;

/// Parabolas before a search gives up: bodies that slide along each other, nearer than rounding, for milliseconds.
const PIECES: usize = 256;

/// How far the last search goes beyond its end, as a fraction.
const BEYOND: f64 = 1e-6;

/// The parabola that touches the flight of a body at `time`.
fn near(state: &BodyState, time: SimTime) -> Osculating {
    match &state.flight {
        Some(flight) => flight.osculating(time, state.reach),
        None => Osculating::of(state.motion.rebased(time)),
    }
}

/// When two shapes first touch within `length` seconds of `time`. `last`: where they have just struck each other, if they have: a hint;
/// `way`: the box of the way of a body for some seconds.
pub(crate) fn first_touch(
    bodies: [&BodyState; 2],
    shapes: [&Shape; 2],
    (time, length): (SimTime, f64),
    way: impl Fn(&BodyState, f64) -> Aabb,
    last: Option<ImpactFeature>,
) -> TimeOfImpact {
    let [one, two] = bodies;
    if one.flight.is_none() && two.flight.is_none() {
        // A little beyond: an impact at the very end is found to its last digit, too.
        let (end, [first, second]) = (length * (1.0 + BEYOND), shapes);
        return time_of_impact_from(time, last, first, &one.motion, second, &two.motion, end);
    }
    let mut first = TimeOfImpact::Clear;
    let mut left = length;
    let [of_one, of_two] = parts_in_way(bodies, shapes, (time, length), way);
    for &i in &of_one {
        for &j in &of_two {
            let parts = [part(shapes[0], i), part(shapes[1], j)];
            let next = first_touch_of_parts(bodies, parts, time, left);
            #[expect(clippy::cast_possible_truncation, reason = "parts of a shape")]
            let next = next.of_parts((i as u32, j as u32));
            if let TimeOfImpact::Hit(impact) = &next {
                // What is flush with it is one with it.
                left = left.min(impact.time * (1.0 + BEYOND));
            }
            first = earlier(first, next);
        }
    }
    first
}

/// Parts of two shapes that may touch within `length` seconds: of a body at rest those with some outline in the box of the other
/// one's `way`.
pub(crate) fn parts_in_way(
    bodies: [&BodyState; 2],
    shapes: [&Shape; 2],
    (time, length): (SimTime, f64),
    way: impl Fn(&BodyState, f64) -> Aabb,
) -> [Few<usize>; 2] {
    [0, 1].map(|k| {
        let (body, other) = (bodies[k], bodies[1 - k]);
        let all = 0..part_count(shapes[k]);
        if all.len() == 1 || moves(body) {
            return all.collect();
        }
        let way = way(other, length * (1.0 + BEYOND));
        let pose = body.centre_pose(time);
        all.filter(|i| part(shapes[k], *i).outline_aabb(pose).overlaps(way))
            .collect()
    })
}

/// [`first_touch`] of two convex parts.
pub(crate) fn first_touch_of_parts(
    bodies: [&BodyState; 2],
    parts: [Hull<'_>; 2],
    time: SimTime,
    length: f64,
) -> TimeOfImpact {
    if bodies.iter().all(|body| body.flight.is_none()) {
        let [a, b] = bodies.map(|body| body.motion.rebased(time));
        return time_of_impact_of_parts(&parts[0], &a, &parts[1], &b, length);
    }
    let size = bodies[0].reach.min(bodies[1].reach);
    let search = Search {
        bodies,
        parts,
        size,
        time,
    };
    search.first(length)
}

/// Two convex parts, from an instant on.
struct Search<'a> {
    bodies: [&'a BodyState; 2],
    parts: [Hull<'a>; 2],
    /// The smaller reach, in m.
    size: f64,
    time: SimTime,
}

impl Search<'_> {
    fn first(&self, length: f64) -> TimeOfImpact {
        let (exact, close) = (EXACT * self.size, NEAR * self.size);
        let (mut at, mut hint) = (0.0, f64::INFINITY);
        for _ in 0..PIECES {
            let paths = self.bodies.map(|state| near(state, self.time + at));
            let gap = self.gap(&paths);
            let room = if ROOM * gap > close {
                ROOM * gap
            } else {
                exact
            };
            let mut span = (length - at).min(hint);
            let left_out = |span: f64| paths[0].left_out(span) + paths[1].left_out(span);
            let fits = |span: f64| left_out(span) <= room;
            while span > 0.0 && !fits(span) {
                span *= 0.5;
            }
            let (off, motions) = (left_out(span), paths.map(|path| path.motion));
            hint = f64::INFINITY;
            if off <= exact {
                // A little beyond: an impact at the very end is found to its last digit, too.
                let [a, b] = &motions;
                let end = span * (1.0 + BEYOND);
                match time_of_impact_of_parts(&self.parts[0], a, &self.parts[1], b, end) {
                    TimeOfImpact::Clear => at += span,
                    TimeOfImpact::Touching(impact) if at == 0.0 => {
                        return TimeOfImpact::Touching(impact);
                    }
                    TimeOfImpact::Hit(impact) | TimeOfImpact::Touching(impact) => {
                        let time = at + impact.time;
                        return TimeOfImpact::Hit(Impact { time, ..impact });
                    }
                    TimeOfImpact::Unresolved { .. } => break,
                }
            } else {
                let off = off.max(close);
                match self.of_grown(&motions, span, off) {
                    TimeOfImpact::Clear => at += span,
                    TimeOfImpact::Hit(impact) => {
                        at += impact.time;
                        // From about that far away at this speed it is no more than twice that to the contact.
                        hint = 4.0 * off / impact.gap_rate.abs();
                    }
                    TimeOfImpact::Unresolved { safe_until } => {
                        at += safe_until;
                        hint = 0.125 * span;
                    }
                    // The gap was rounded.
                    TimeOfImpact::Touching(_) => hint = 0.125 * span,
                }
            }
            if at >= length {
                return TimeOfImpact::Clear;
            }
        }
        TimeOfImpact::Unresolved { safe_until: at }
    }

    /// Largest gap along an edge's normal, in m.
    fn gap(&self, paths: &[Osculating; 2]) -> f64 {
        let [a, b] = paths
            .each_ref()
            .map(|path| path.motion.pose_at(path.motion.start));
        separating_axis(&self.parts[0], &self.parts[1], b.seen_from(a)).separation
    }

    /// The same of shapes of which one is grown by `room` metres. A cut between parts counts as outline: early is safe.
    fn of_grown(&self, motions: &[Motion; 2], span: f64, room: f64) -> TimeOfImpact {
        let mut parts = self.parts;
        for part in &mut parts {
            part.boundary = None;
        }
        let grown = usize::from(parts[0].is_half_plane());
        parts[grown].radius += room;
        time_of_impact_of_parts(&parts[0], &motions[0], &parts[1], &motions[1], span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::broad::window::ways_from;
    use crate::{BodyDef, Material, Settings, World};
    use carom_geometry::{ConvexPolygon, Polygon};
    use carom_math::vec2;

    #[test]
    fn parts_beside_the_way_of_a_body_are_not_touched() {
        let mut hills = vec![vec2(-20.0, -2.0), vec2(20.0, -2.0)];
        hills.extend((0..=40_i32).map(|k| vec2(f64::from(20 - k), f64::from(k * k % 7) / 7.0)));
        let hills = Shape::from(Polygon::new(hills).expect("hills"));
        let plank = Shape::from(ConvexPolygon::rectangle(1.2, 0.3).expect("a plank"));
        let (mut touched, mut left_out) = (0, 0);
        for k in 0..60 {
            let mut world = World::new(Settings::default()).expect("valid");
            let at = vec2(f64::from(k) / 2.0 - 15.0, 1.3);
            let moving = vec2(f64::from(k * 5 % 11) - 5.0, -f64::from(k % 4));
            let def = BodyDef::dynamic().at(at).moving(moving).spinning(3.0);
            let ids = [(BodyDef::fixed(), &hills), (def, &plank)].map(|(def, shape)| {
                let made = world.insert(def, shape.clone(), Material::default());
                made.expect("valid").index
            });
            let bodies = ids.map(|index| world.bodies.get(index));
            let shapes = bodies.map(|body| &*world.bodies.colliders[body.colliders[0]].solid);
            let (time, length) = (SimTime::ZERO, 0.4);
            let [near, _] = parts_in_way(bodies, shapes, (time, length), ways_from(time));
            for i in 0..part_count(shapes[0]) {
                let parts = [part(shapes[0], i), part(shapes[1], 0)];
                let found = first_touch_of_parts(bodies, parts, time, length);
                let clear = matches!(found, TimeOfImpact::Clear);
                assert!(clear || near.contains(&i), "part {i} from {at} on");
                touched += u32::from(!clear);
                left_out += u32::from(!near.contains(&i));
            }
        }
        assert!(touched > 30 && left_out > 600, "{touched}, {left_out}");
    }
}
