//! Rows of whole shapes: of bodies so deep in a concave one that pieces know no way out.
//!
//! A piece is left through its outline, never across a cut to the next piece; what overlaps it less across a cut than behind its
//! outline is that piece's. Deep in a concave body that may be so of all its pieces, or two of them push against each other. The two
//! bodies then have one row, along the shortest way out of the whole shapes, until these are apart.

use std::collections::{BTreeMap, BTreeSet};

use carom_math::Vec2;

use crate::bodies::Bodies;
use crate::narrow::{Found, Scene};
use crate::rows::{Block, Cold, Graph, lanes};
use crate::update::{Fresh, Pair, place};
use crate::{BodyIx, PairRules};

/// Cosine of the angle between the row of a piece and the way out of the whole shapes that it leads. −2, so that any row does: two L
/// shapes stay 0.20 m in each other. From 0 to 2 all pairs of concave bodies come out that are tried, and a hundred L shapes at one
/// place but for at most 0.08 m.
const LEADS: f64 = 0.5;

/// Rows of pieces lead the way out if one of them goes at least so far of it. 0: of 8,000 random rings one more stays where it was put.
const FAR: f64 = 0.5;

/// Slots of two bodies each that were put into each other and are not apart.
pub(crate) struct PutPairs {
    put: BTreeSet<[BodyIx; 2]>,
    /// Those that have a row of whole shapes.
    whole: BTreeSet<[BodyIx; 2]>,
}

impl PutPairs {
    pub(crate) fn of(graph: &Graph) -> Self {
        Self {
            put: graph.put().collect(),
            whole: graph.whole().collect(),
        }
    }

    pub(crate) fn contains(&self, bodies: &Bodies, slots: [BodyIx; 2]) -> bool {
        bodies.were_placed(slots) || self.put.contains(&slots)
    }

    /// Rows of whole shapes go on as such, and no piece of their bodies has another one; rows of pieces of concave shapes that were put
    /// deeper than a margin become such. A bit for each lane among those that `moved` that has one.
    pub(crate) fn renew(
        &mut self,
        scene: &Scene<'_>,
        (block, cold): (&Block, &mut Cold),
        moved: u8,
        found: &mut Found,
    ) -> u8 {
        let known = moved & cold.whole;
        let asked = if self.put.is_empty() {
            0
        } else {
            moved & !known
        };
        for lane in lanes(asked) {
            let (pair, bit) = (cold.pieces[lane], 1 << lane);
            let slots = scene.pieces.bodies(pair);
            if self.whole.contains(&slots) {
                found.near &= !bit;
                continue;
            }
            if !self.put.contains(&slots) {
                continue;
            }
            let is_near = found.near & bit != 0;
            let is_deep = if is_near {
                let [a, b] = block.lines(lane).map(|line| scene.bodies.lines[line].d());
                scene.is_entangled(pair, found.gap(lane, b - a))
            } else {
                scene.overlaps_across_cuts(pair)
            };
            if is_deep
                && let Some(way) = scene.way_out(pair)
                && (!is_near || !leads(found.rows.normal(lane), way.normal))
                && scene.is_entangled(pair, way.gap())
            {
                found.set(lane, &way);
                cold.whole |= bit;
                self.whole.insert(slots);
            }
        }
        for lane in lanes(known) {
            if cold.was_put(lane)
                && let Some(manifold) = scene.way_out(cold.pieces[lane])
            {
                found.set(lane, &manifold);
            } else {
                found.near &= !(1 << lane);
                cold.whole &= !(1 << lane);
            }
        }
        let whole = moved & cold.whole;
        // No ghosts: these are rows of no sides.
        found.short &= !whole;
        found.slants &= !whole;
        found.seam &= !whole;
        whole
    }

    /// Gives bodies that were put into each other one row of their whole shapes instead of all others, if some pieces of theirs, `cut`,
    /// have none though they overlap, or one of a concave shape is deeper than a margin.
    pub(crate) fn add(
        &mut self,
        scene: &Scene<'_>,
        rules: &dyn PairRules,
        mut cut: Vec<Pair>,
        fresh: &mut Vec<Fresh>,
    ) {
        let pieces = scene.pieces;
        let was_put = |pair: &Pair| self.contains(scene.bodies, pair.slots(pieces));
        let entangled = fresh.iter().filter(|fresh| {
            was_put(&fresh.pair) && scene.is_entangled(fresh.pair.pieces, fresh.manifold.gap())
        });
        cut.extend(entangled.map(|fresh| fresh.pair));
        cut.retain(|pair| {
            !self.whole.contains(&pair.slots(pieces))
                && pieces.surface(pair.pieces, rules).is_some()
        });
        cut.sort_by_cached_key(|pair| pair.pieces.map(|piece| place(scene.bodies, pieces, piece)));
        cut.dedup_by_key(|pair| pair.slots(pieces));
        let mut rows: BTreeMap<[BodyIx; 2], Vec<(Vec2, f64)>> = BTreeMap::new();
        if !cut.is_empty() {
            for fresh in fresh.iter().filter(|fresh| fresh.manifold.gap() < 0.0) {
                let of_bodies = rows.entry(fresh.pair.slots(pieces)).or_default();
                of_bodies.push((fresh.manifold.normal, fresh.manifold.gap()));
            }
        }
        let way_out = |pair: Pair| {
            let manifold = scene.way_out(pair.pieces)?;
            let known = rows.get(&pair.slots(pieces));
            let is_known = known.is_some_and(|all| {
                all.iter().all(|(n, _)| leads(*n, manifold.normal))
                    && all.iter().any(|(_, gap)| *gap < FAR * manifold.gap())
            });
            (!is_known).then_some(Fresh {
                pair,
                manifold,
                face: None,
                is_whole: true,
            })
        };
        let new: Vec<Fresh> = cut.into_iter().filter_map(way_out).collect();
        self.whole
            .extend(new.iter().map(|fresh| fresh.pair.slots(pieces)));
        fresh.retain(|fresh| !self.whole.contains(&fresh.pair.slots(pieces)));
        fresh.extend(new);
    }
}

/// Whether the row of a piece pushes along the way out of the whole shapes.
fn leads(normal: Vec2, way: Vec2) -> bool {
    normal.dot(way) > LEADS
}
