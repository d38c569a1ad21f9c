//! Which pairs may meet: boxes around motions, kept in a tree.

use std::collections::{BTreeMap, BTreeSet};

use carom_collision::{BoxTree, Motion, roundable};
use carom_geometry::Aabb;
use carom_math::{SimTime, Vec2};

use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, Pairs};
use crate::store::state::Collider;
use crate::{BodyId, BodyIx, BodyKind, ColliderIx, Ix, PairIx, PairMaterial, PairSearch, Two};

/// Boxes are stretched along the motion over this many sub-steps, so that a body that keeps its
/// course is looked for again only now and then. Wider boxes find more pairs in vain.
pub(crate) const LOOK_AHEAD: f64 = 8.0;

/// Boxes are padded by this fraction of the body's reach, so that a body that jitters stays inside.
pub(crate) const PADDING: f64 = 0.05;

/// Finds the free bodies with boxes that overlap one, and writes them into a list.
pub(crate) type Overlapping<'a> = dyn Fn(&Bodies, Aabb, &mut Vec<BodyIx>) + 'a;

/// Everything a search for pairs reads and writes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Broad {
    pub(crate) search: PairSearch,
    pub(crate) tree: BoxTree,
    pub(crate) overrides: BTreeMap<(BodyId, BodyId), PairMaterial>,
    /// Pairs of bodies, in order, that do not collide whatever their filters say.
    pub(crate) excluded: BTreeSet<(BodyId, BodyId)>,
    /// What the last search found, shapes and free bodies: kept for its memory.
    near: Vec<ColliderIx>,
    free: Vec<BodyIx>,
    /// What was a pair with a shape before a search, in order: kept for its memory.
    known: Vec<ColliderIx>,
}

impl Broad {
    pub(crate) fn new(search: PairSearch) -> Self {
        Self {
            search,
            ..Self::default()
        }
    }

    /// Brings the boxes of a body up to date for its motion between `time` and `time + h`, and
    /// finds the partners it did not have.
    pub(crate) fn refit(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        index: BodyIx,
        time: SimTime,
        h: f64,
        free: Option<&Overlapping<'_>>,
    ) {
        for slot in 0..bodies.get(index).colliders.len() {
            let body = bodies.get(index);
            let at = body.colliders[slot];
            let swept = swept_box(&bodies.colliders[at], &body.motion, time, h);
            let collider = &bodies.colliders[at];
            if collider.node.is_some() && collider.fat.contains(swept) {
                continue;
            }
            let ahead = swept_box(collider, &body.motion, time, h * LOOK_AHEAD);
            // No padding for a fixed body: every body in its box is tested against it.
            let padding = if body.kind != BodyKind::Fixed && body.reach.is_finite() {
                PADDING * body.reach
            } else {
                0.0
            };
            let fat = swept.union(ahead).grown(padding);
            self.put(bodies, at, fat);
            self.meet(bodies, pairs, at, free);
        }
    }

    /// Takes the boxes of a body out of the trees.
    pub(crate) fn forget(&mut self, bodies: &mut Bodies, index: BodyIx) {
        for &at in &bodies.get(index).colliders.clone() {
            if let Some(node) = bodies.colliders[at].node.take() {
                self.tree.remove(node);
            }
        }
    }

    /// Gives a collider a new box.
    pub(crate) fn put(&mut self, bodies: &mut Bodies, at: ColliderIx, fat: Aabb) {
        let collider = &mut bodies.colliders[at];
        collider.fat = fat;
        // The tree is asked where a body is at instants in between, too.
        let kept = fat.grown(roundable(fat));
        if let Some(node) = collider.node {
            self.tree.update(node, kept);
        } else {
            collider.node = Some(self.tree.insert(kept, at.number()));
        }
    }

    /// Boxes of a free body that is too large for the grid, over its motion up to its horizon.
    pub(crate) fn follow(
        &mut self,
        bodies: &mut Bodies,
        index: BodyIx,
        time: SimTime,
        seconds: f64,
    ) {
        let motion = bodies.get(index).motion;
        for &at in &bodies.get(index).colliders.clone() {
            let fat = swept_box(&bodies.colliders[at], &motion, time, seconds);
            self.put(bodies, at, fat);
        }
    }

    /// Calls `found` with each collider of the tree that may be in `bounds`.
    pub(crate) fn query(&self, bounds: Aabb, mut found: impl FnMut(ColliderIx)) {
        self.tree.query(bounds, |at| found(ColliderIx::new(at)));
    }

    /// Colliders in the trees with boxes that overlap `bounds`, in order.
    pub(crate) fn in_tree(&self, bodies: &Bodies, bounds: Aabb) -> Vec<ColliderIx> {
        let mut near = Vec::new();
        self.search_tree(bodies, bounds, &mut near);
        near
    }

    /// [`Self::in_tree`], in the memory of an earlier search.
    pub(crate) fn search_tree(&self, bodies: &Bodies, bounds: Aabb, near: &mut Vec<ColliderIx>) {
        near.clear();
        match self.search {
            PairSearch::None => {}
            PairSearch::AllPairs => {
                let all = bodies.colliders.each();
                near.extend(all.filter(|(_, c)| c.node.is_some()).map(|(at, _)| at));
            }
            PairSearch::Indexed => {
                // The boxes of the tree are rounded: a shape counts by its own.
                self.query(bounds, |at| {
                    if bodies.colliders[at].fat.overlaps(bounds) {
                        near.push(at);
                    }
                });
                near.sort_unstable();
            }
        }
    }

    /// New pairs of a collider with a new box.
    pub(crate) fn meet(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        at: ColliderIx,
        free: Option<&Overlapping<'_>>,
    ) {
        let bounds = bodies.colliders[at].fat;
        let mut near = core::mem::take(&mut self.near);
        near.clear();
        match self.search {
            PairSearch::None => {}
            PairSearch::AllPairs => {
                let there = |c: &Collider| c.node.is_some() || bodies.get(c.body).goes_by_events();
                let all = bodies.colliders.each();
                near.extend(all.filter(|(_, c)| there(c)).map(|(at, _)| at));
            }
            PairSearch::Indexed => {
                self.query(bounds, |other| near.push(other));
                if let Some(free) = free {
                    free(bodies, bounds, &mut self.free);
                    let shapes = |body: &BodyIx| &bodies.get(*body).colliders;
                    near.extend(self.free.iter().flat_map(shapes));
                }
            }
        }
        near.sort_unstable();
        near.dedup();
        near.retain(|&other| {
            let theirs = bodies.colliders[other].fat;
            self.search == PairSearch::AllPairs || theirs.overlaps(bounds)
        });
        self.pair_with(bodies, pairs, at, &near);
        self.near = near;
    }

    /// The pairs of a shape with these, of those that are none yet and may be one.
    pub(crate) fn pair_with(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        at: ColliderIx,
        near: &[ColliderIx],
    ) {
        // Read once, not for each of what is near: of bodies at one place each has all others in its list.
        let mut known = core::mem::take(&mut self.known);
        known.clear();
        let list = &bodies.get(bodies.colliders[at].body).pairs;
        known.extend(list.iter().filter_map(|&p| pairs.partner(p, at)));
        known.sort_unstable();
        for &other in near {
            if known.binary_search(&other).is_err() {
                self.insert_pair(bodies, pairs, (at, other));
            }
        }
        self.known = known;
    }

    /// Two shapes that are no pair yet, if they may be one.
    fn insert_pair(&self, bodies: &mut Bodies, pairs: &mut Pairs, (one, two): Two<ColliderIx>) {
        let key = |i: ColliderIx| (bodies.colliders[i].body, i);
        let (first, second) = if key(one) < key(two) {
            (one, two)
        } else {
            (two, one)
        };
        let ends = (key(first).0, key(second).0);
        if ends.0 == ends.1 {
            return;
        }
        let (a, b) = bodies.both(ends);
        // Impacts of a free body with free bodies, and with bodies at rest, are events of the calendar queue.
        if a.goes_by_events() && !b.is_stepped() || b.goes_by_events() && !a.is_stepped() {
            return;
        }
        if a.kind != BodyKind::Dynamic && b.kind != BodyKind::Dynamic {
            return;
        }
        if !self.may_touch(bodies, (first, second)) {
            return;
        }
        let material = self.material(bodies, (first, second));
        let place = pairs.insert(Pair {
            colliders: (first, second),
            bodies: ends,
            material,
            fresh: true,
            ..Pair::default()
        });
        bodies.get_mut(ends.0).pairs.push(place);
        bodies.get_mut(ends.1).pairs.push(place);
    }

    /// Whether filters and the caller let two shapes touch.
    pub(crate) fn may_touch(&self, bodies: &Bodies, shapes: Two<ColliderIx>) -> bool {
        let [one, other] = [shapes.0, shapes.1].map(|at| bodies.colliders[at].surface.filter);
        one.touches(other)
            && (self.excluded.is_empty() || !self.excluded.contains(&ids_of(bodies, shapes)))
    }

    /// How the surfaces of two shapes meet.
    pub(crate) fn material(&self, bodies: &Bodies, shapes: Two<ColliderIx>) -> PairMaterial {
        let given = self.overrides.get(&ids_of(bodies, shapes)).copied();
        let of = |at: ColliderIx| &bodies.colliders[at].surface.material;
        given.unwrap_or_else(|| of(shapes.0).against(of(shapes.1)))
    }

    /// Whether the boxes that a pair of shapes was found with still overlap.
    pub(crate) fn keeps(&self, bodies: &Bodies, (one, two): Two<ColliderIx>) -> bool {
        let [one, two] = [one, two].map(|at| bodies.colliders[at].fat);
        self.search == PairSearch::AllPairs || one.overlaps(two)
    }
}

/// The bodies of two shapes, in order.
fn ids_of(bodies: &Bodies, (one, other): Two<ColliderIx>) -> (BodyId, BodyId) {
    let [a, b] = [one, other].map(|at| bodies.get(bodies.colliders[at].body).id);
    (a.min(b), a.max(b))
}

/// Takes a pair out of the store and out of its bodies' lists.
pub(crate) fn part(bodies: &mut Bodies, pairs: &mut Pairs, place: PairIx) -> Option<Pair> {
    let pair = pairs.remove(place)?;
    for index in [pair.bodies.0, pair.bodies.1] {
        let known = &mut bodies.get_mut(index).pairs;
        if let Some(at) = known.iter().position(|p| *p == place) {
            known.remove(at);
        }
    }
    Some(pair)
}

/// Box of a collider over its motion between `time` and `time + h`.
///
/// Of a body that turns, the box of the whole circle about its centre; of one that does not, the
/// boxes at both ends and the turning point of the parabola: |a| h²/8 beyond the chord.
pub(crate) fn swept_box(collider: &Collider, motion: &Motion, time: SimTime, h: f64) -> Aabb {
    let end = time + h;
    let boxed = |at: SimTime| collider.solid.aabb(motion.pose_at(at));
    if !collider.solid.is_bounded() {
        // On a body that never moves.
        return boxed(time);
    }
    // At most, there and back: a spin that reverses turns more than is left at the end.
    let turn = h * motion.spin_at(time).abs().max(motion.spin_at(end).abs());
    let bulge = motion.acceleration.length() * h * h * 0.125;
    // A point at distance r leaves its chord by r (ω² + |α|) h²/8 at most, and is never 2 r from it.
    let reach = collider.solid.reach_about(Vec2::ZERO);
    let wound = motion.angular_acceleration.abs() * h * h;
    let arc = reach * (0.125 * (turn * turn + wound)).min(2.0);
    // Never less than a sub-step of rounding: a body at rest has a box with an inside.
    boxed(time)
        .union(boxed(end))
        .grown(bulge + arc + 1e-9 * reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Material;
    use crate::store::state::Surface;
    use carom_geometry::{ConvexPolygon, Shape};
    use std::sync::Arc;

    #[test]
    fn a_turn_that_reverses_is_in_the_box() {
        let plank = Arc::new(Shape::from(
            ConvexPolygon::rectangle(4.0, 0.5).expect("a plank"),
        ));
        let collider = Collider {
            body: BodyIx::NONE,
            drawn: Arc::clone(&plank),
            solid: Arc::clone(&plank),
            surface: Arc::new(Surface {
                material: Material::default(),
                filter: crate::Filter::default(),
            }),
            node: None,
            fat: Aabb::EMPTY,
        };
        // Half a radian there and back: at both ends of the second nothing has turned.
        let motion = Motion {
            spin: 2.0,
            angular_acceleration: -4.0,
            ..Motion::resting(Vec2::ZERO)
        };
        let bounds = swept_box(&collider, &motion, SimTime::ZERO, 1.0);
        for part in 0..=100 {
            let there = motion.pose_at(SimTime::from_secs(0.01 * f64::from(part)));
            assert!(
                bounds.contains(plank.aabb(there)),
                "after {part} of 100 parts"
            );
        }
    }
}
